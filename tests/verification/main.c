// bough-verify STUDY: one study of the verification, with the exit codes of bough.
#include "apps/bough/cli/command.h"
#include "tests/verification/verification.h"

static bough_status verify(bough_arena *arena, const void *given) {
    const bough_options *options = given;
    bough_errors errors = {.arena = arena};
    bough_verification verification;
    bough_status status = bough_verification_read(arena, options->operand, &errors, &verification);
    bough_errors_report(&errors, &status);
    if (!bough_is_ok(&status)) return status;
    bough_verification_options how = {.folder = bough_out_folder(arena, options),
                                      .threads = options->threads,
                                      .quiet = options->quiet,
                                      .stop = bough_stop_requested,
                                      .stream = stdout};
    bough_stop_listen();
    status = bough_verification_perform(arena, &verification, &how);
    if (bough_is_ok(&status)) printf("out: %s\n", how.folder);
    return status;
}

static const bough_option rows[] = {BOUGH_OPTION_OUT, BOUGH_OPTION_THREADS, BOUGH_OPTION_QUIET, {0}};

static const bough_command command = {
    .name = "verify",
    .summary = "runs a study of bough's own verification: verify, blade-models",
    .operands = "STUDY",
    .option = rows,
    .size = sizeof(bough_options),
    .run = verify,
};

int main(int argc, char **argv) {
    bough_options *options = NULL;
    bough_arena *arena = bough_arena_create();
    bough_status status = arena ? bough_options_read(arena, argc, argv, &command, &options)
                                : bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (bough_is_ok(&status) && options->help) {
        fputs("usage: bough-verify", stdout);
        bough_options_usage(&command, stdout);
        printf("\n%s\n", command.summary);
        bough_options_help(&command, stdout);
    } else if (bough_is_ok(&status)) {
        status = command.run(arena, options);
    }
    bough_arena_destroy(arena);
    if (!bough_is_ok(&status) && status.message[0]) {
        fprintf(stderr, "bough-verify: %s\n", status.message);
    }
    return bough_exit_code(status.code);
}

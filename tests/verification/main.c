// bough-verify STUDY: one study of the verification, with the exit codes of bough.
#include "apps/bough/cli/open.h"
#include "apps/bough/cli/stop.h"
#include "tests/verification/verification.h"

static const bough_syntax syntax = {BOUGH_OPERAND_REQUIRED, "STUDY",
                                    BOUGH_OPTION_OUT | BOUGH_OPTION_THREADS | BOUGH_OPTION_QUIET};

static bough_status verify(bough_arena *arena, const bough_options *options) {
    bough_errors errors = {.arena = arena};
    bough_verification verification;
    bough_status status =
        bough_verification_read(arena, options->operand, &errors, &verification);
    if (errors.n > 0 && status.code == BOUGH_INVALID) {
        bough_errors_print(&errors, stderr);
        status.message[0] = '\0';
    }
    if (!bough_is_ok(&status)) return status;
    bough_verification_options how = {.folder = bough_out_folder(arena, options),
                                      .threads = options->threads,
                                      .quiet = options->quiet,
                                      .stop = bough_stop_requested,
                                      .stream = stdout};
    if (!how.folder) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_stop_listen();
    status = bough_verification_perform(arena, &verification, &how);
    if (bough_is_ok(&status)) printf("out: %s\n", how.folder);
    return status;
}

int main(int argc, char **argv) {
    bough_options options = {0};
    bough_arena *arena = bough_arena_create();
    bough_status status = arena ? bough_options_read(arena, argc, argv, &syntax, &options)
                                : bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (bough_is_ok(&status) && options.help) {
        fputs("usage: bough-verify", stdout);
        bough_options_usage(&syntax, stdout);
        fputs("\nruns a study of bough's own verification: verify, two-mass, added-mass, blade-models\n",
              stdout);
        bough_options_help(&syntax, stdout);
    } else if (bough_is_ok(&status)) {
        status = verify(arena, &options);
    }
    bough_arena_destroy(arena);
    if (!bough_is_ok(&status) && status.message[0]) {
        fprintf(stderr, "bough-verify: %s\n", status.message);
    }
    return bough_exit_code(status.code);
}

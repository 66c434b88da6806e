// bough: flexible multibody dynamics on the command line.
#include "apps/bough/cli/command.h"
#include "apps/bough/config/schema.h"
#include "core/base/linalg.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

enum { MOST_WORDS = 32 };

const bough_command *const bough_commands[] = {
    &bough_command_run,    &bough_command_check,
    &bough_command_static, &bough_command_modes,
    &bough_command_study,  &bough_command_tune,
    &bough_command_wind,   &bough_command_report,
    &bough_command_diff,   &bough_command_new,
    &bough_command_import, &bough_command_export,
    &bough_command_help,   NULL,
};

const bough_command *bough_command_find(const char *name) {
    for (const bough_command *const *c = bough_commands; *c; c++) {
        if (strcmp((*c)->name, name) == 0) return *c;
    }
    return NULL;
}

bough_status bough_unknown_word(const char *what, const char *word, const char *const *more) {
    const char *known[MOST_WORDS];
    char list[160] = "";
    int n = 0;
    for (const bough_command *const *c = bough_commands; *c && n < MOST_WORDS; c++) known[n++] = (*c)->name;
    for (; more && *more && n < MOST_WORDS; more++) known[n++] = *more;
    for (int i = 0; i < n; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i == 0 ? "" : ", ", known[i]);
    }
    return bough_fail(BOUGH_INVALID, "unknown %s '%.80s'%s; known: %s", what, word,
                      bough_suggest(word, known, n).text, list);
}

// self: the arguments, from the command on, ended by NULL
static bough_status call(bough_arena *arena, void *self) {
    char **argv = self;
    int argc = 1;
    while (argv[argc]) argc++;
    if (strcmp(argv[0], "--version") == 0 && argc == 1) {
        printf("bough " BOUGH_VERSION "\n");
        return bough_ok();
    }
    bool help = strcmp(argv[0], "--help") == 0 || strcmp(argv[0], "-h") == 0;
    const bough_command *command = help ? &bough_command_help : bough_command_find(argv[0]);
    if (!command) return bough_unknown_word("command", argv[0], NULL);
    bough_options *options;
    BOUGH_TRY(bough_options_read(arena, argc, argv, command, &options));
    if (options->help) {
        bough_help_command(command, stdout);
        return bough_ok();
    }
    if (strcmp(command->operands, "SCENE") == 0) BOUGH_TRY(bough_find_scene(arena, options));
    return command->run(arena, options);
}

static bough_status end_output(bough_status status) {
    errno = 0;
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    if (written || !bough_is_ok(&status)) return status;
    return bough_fail(BOUGH_IO, "cannot write to the standard output: %s",
                      errno ? strerror(errno) : "an earlier write failed");
}

// OpenBLAS starts threads, which are never used here and spin at first, unless the environment forbids it. If
// the library is linked statically, this is called before its own initialisation.
__attribute__((constructor(101))) static void quiet_threads(void) { setenv("OPENBLAS_NUM_THREADS", "1", 0); }

// Opens /dev/null for closed standard streams: otherwise a file of results could get the number of a stream
// and receive what is printed.
static void open_streams(void) {
    int file = 0;
    while (file >= 0 && file <= STDERR_FILENO) file = open("/dev/null", O_RDWR);
    if (file > STDERR_FILENO) close(file);
}

int main(int argc, char **argv) {
    open_streams();
    bough_c_locale(); // a controller's library may set the user's
    bough_linalg_choose_kernels();
    signal(SIGXFSZ, SIG_IGN); // a file at its limit is then a write that fails, which is reported
    if (argc < 2) {
        bough_help_overview(stderr);
        return bough_exit_code(BOUGH_INVALID);
    }
    bough_status status = end_output(bough_arena_use(call, argv + 1));
    if (!bough_is_ok(&status) && status.message[0]) {
        const char *kind = status.code == BOUGH_INTERRUPTED ? "" : "error: ";
        fprintf(stderr, "bough: %s%s\n", kind, status.message);
    }
    return bough_exit_code(status.code);
}

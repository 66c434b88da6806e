// bough: flexible multibody dynamics on the command line.
#include "apps/bough/cli/verb.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const bough_verb bough_verbs[] = {
    {"run",
     {BOUGH_OPERAND_REQUIRED, "SCENE",
      BOUGH_OPTION_SET | BOUGH_OPTION_OUT | BOUGH_OPTION_THREADS | BOUGH_OPTION_CHECKPOINT |
          BOUGH_OPTION_RESUME | BOUGH_OPTION_QUIET},
     "simulates a scene and writes its results",
     bough_verb_run},
    {"check",
     {BOUGH_OPERAND_REQUIRED, "SCENE", BOUGH_OPTION_SET},
     "shows what a scene builds; nothing is run or written",
     bough_verb_check},
    {"static",
     {BOUGH_OPERAND_REQUIRED, "SCENE", BOUGH_OPTION_SET | BOUGH_OPTION_OUT | BOUGH_OPTION_PATH},
     "computes the equilibrium of rods and joints under gravity, loads and air",
     bough_verb_static},
    {"modes",
     {BOUGH_OPERAND_REQUIRED, "SCENE", BOUGH_OPTION_SET | BOUGH_OPTION_OUT | BOUGH_OPTION_SWEEP},
     "computes frequencies, damping and shapes of the whole scene or of each rod, at rest or "
     "rotating",
     bough_verb_modes},
    {"study",
     {BOUGH_OPERAND_REQUIRED, "STUDY",
      BOUGH_OPTION_OUT | BOUGH_OPTION_THREADS | BOUGH_OPTION_PART | BOUGH_OPTION_CASE | BOUGH_OPTION_QUIET},
     "runs a scene for a grid of settings and compares cost and error",
     bough_verb_study},
    {"wind",
     {BOUGH_OPERAND_REQUIRED, "SCENE", BOUGH_OPTION_SET | BOUGH_OPTION_OUT},
     "writes the turbulence of a scene for other programs: wind.bts",
     bough_verb_wind},
    {"report",
     {BOUGH_OPERAND_SOME, "DIR", 0},
     "makes one page of the results of a run or a study, or of several runs side by side: "
     "DIR/report.html",
     bough_verb_report},
    {"import",
     {BOUGH_OPERAND_TWO, "KIND FILE",
      BOUGH_OPTION_OUT | BOUGH_OPTION_WIND | BOUGH_OPTION_CONTROLLER | BOUGH_OPTION_CLAMP_BASE |
          BOUGH_OPTION_HUB_MASS | BOUGH_OPTION_NACELLE_MASS},
     "converts 'openfast MAIN.fst' or 'windio TURBINE.yaml' to a scene and lists what it took",
     bough_verb_import},
    {"export",
     {BOUGH_OPERAND_TWO, "KIND SCENE", BOUGH_OPTION_SET | BOUGH_OPTION_OUT},
     "writes a scene as 'fmu', a model for co-simulation by other programs (FMI 3.0)",
     bough_verb_export},
    {"help",
     {BOUGH_OPERAND_OPTIONAL, "TOPIC", BOUGH_OPTION_JSON},
     "explains a command, the keys of scenes and studies, the channels or the coupling schemes",
     bough_verb_help},
    {"--help", {BOUGH_OPERAND_OPTIONAL, "TOPIC", BOUGH_OPTION_JSON}, "the same", bough_verb_help},
    {"-h", {BOUGH_OPERAND_OPTIONAL, "TOPIC", BOUGH_OPTION_JSON}, "the same", bough_verb_help},
    {"--version", {BOUGH_OPERAND_NONE, NULL, 0}, "prints the version", bough_verb_version},
    {0},
};

// self: the arguments, from the command on, ended by NULL
static bough_status call(bough_arena *arena, void *self) {
    char **argv = self;
    int argc = 1;
    while (argv[argc]) argc++;
    const bough_verb *verb = bough_verb_find(argv[0]);
    if (!verb) return bough_verb_unknown("command", argv[0], NULL);
    bough_options options;
    bough_status status = bough_options_read(arena, argc, argv, &verb->syntax, &options);
    if (!bough_is_ok(&status)) return status;
    if (!options.help) return verb->run(arena, &options);
    bough_help_verb(verb, stdout);
    return status;
}

static bough_status end_output(bough_status status) {
    errno = 0;
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    if (written || !bough_is_ok(&status)) return status;
    return bough_fail(BOUGH_IO, "cannot write to the standard output: %s",
                      errno ? strerror(errno) : "an earlier write failed");
}

// OpenBLAS starts threads that we never use and that spin at first, unless the environment forbids it
// before main begins; so where the user has not, the program does and starts itself once more. Not where
// OpenMP has bound this thread to a place already: the program started would know of no other place.
static void quiet_threads(char **argv) {
    static const char *const bound[] = {"OMP_PLACES", "OMP_PROC_BIND", "GOMP_CPU_AFFINITY"};
    for (size_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        if (getenv(bound[i])) return;
    }
    if (getenv("OPENBLAS_NUM_THREADS") || setenv("OPENBLAS_NUM_THREADS", "1", 1) != 0) return;
    execv("/proc/self/exe", argv);
}

// Opens /dev/null on closed standard streams: a file of results that took the number of one would receive
// what is printed.
static void open_streams(void) {
    int file = 0;
    while (file >= 0 && file <= STDERR_FILENO) file = open("/dev/null", O_RDWR);
    if (file > STDERR_FILENO) close(file);
}

int main(int argc, char **argv) {
    open_streams();
    quiet_threads(argv);
    signal(SIGXFSZ, SIG_IGN); // a file at its limit is a write that fails, and is told
    if (argc < 2) {
        bough_help_overview(stderr);
        return bough_exit_code(BOUGH_INVALID);
    }
    bough_status status = end_output(bough_arena_use(call, argv + 1));
    if (!bough_is_ok(&status) && status.message[0]) {
        const char *grade = status.code == BOUGH_INTERRUPTED ? "" : "error: ";
        fprintf(stderr, "bough: %s%s\n", grade, status.message);
    }
    return bough_exit_code(status.code);
}

#include "apps/bough/import/trial.h"

#include "apps/bough/model/error_shares.h"
#include "apps/bough/model/run.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static bough_status take_steps(bough_arena *arena, bough_scene *scene, int steps, double bound) {
    bough_run run;
    bough_error_shares shares = {0};
    char warning[BOUGH_ERROR_WARNING];
    bough_scene_simulation *x = &scene->simulation;
    x->threads = 1;
    x->duration = fmin(x->duration, steps * x->macro_step);
    x->output.from = 0;
    bough_status status = bough_run_create(arena, scene, &run);
    while (bough_is_ok(&status) && !bough_run_done(&run)) {
        status = bough_run_step(&run);
        if (bough_companion_parted(run.companion)) return bough_error_parted(run.companion);
    }
    if (!bough_is_ok(&status)) return status;
    if (bough_error_exceeds(run.companion, bound))
        status = bough_error_shares_find(arena, run.companion, HUGE_VAL, NULL, &shares);
    return bough_is_ok(&status) ? bough_error_judge(run.companion, &shares, bound, warning) : status;
}

static bool calls_library(const bough_scene *scene) {
    return scene->control.node && scene->control.kind == BOUGH_SCENE_BLADED;
}

// Of a process that ended without a result: by a signal, or because the library ended it.
static bough_status crash_of(const bough_scene *scene, int end) {
    const char *signal = WIFSIGNALED(end) ? strsignal(WTERMSIG(end)) : "the program ends";
    if (!calls_library(scene)) return bough_fail(BOUGH_INVALID, "the first steps crash: %s", signal);
    return bough_fail(BOUGH_INVALID,
                      "the controller's library '%.200s' crashes in its first calls: %s; --controller FILE "
                      "takes another",
                      scene->control.library, signal);
}

// What a library prints belongs to no import.
static void silence(void) {
    int null = open("/dev/null", O_RDWR);
    if (null < 0) return;
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
}

bough_status bough_import_trial(bough_arena *arena, bough_scene *scene, int steps, double bound) {
    int ends[2], end = 0;
    bough_status status;
    if (pipe(ends) != 0) return bough_fail(BOUGH_IO, "cannot start a trial: %s", strerror(errno));
    pid_t child = fork();
    if (child == 0) {
        silence();
        status = take_steps(arena, scene, steps, bound);
        bool whole = write(ends[1], &status, sizeof status) == (ssize_t)sizeof status;
        _exit(whole ? 0 : 1);
    }
    close(ends[1]);
    ssize_t got = child > 0 ? read(ends[0], &status, sizeof status) : 0;
    close(ends[0]);
    if (child < 0) return bough_fail(BOUGH_IO, "cannot start a trial: %s", strerror(errno));
    while (waitpid(child, &end, 0) < 0 && errno == EINTR) continue;
    return got == (ssize_t)sizeof status ? status : crash_of(scene, end);
}

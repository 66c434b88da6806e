// bough study: many runs of one scene, compared.
#include "apps/bough/cases/perform.h"

#include "apps/bough/cli/command.h"
#include "apps/bough/results/folder.h"

typedef struct part {
    int k, n; // the k-th, from 1, of n; n 0: all
} part;

typedef struct study_options {
    bough_options common;
    part part;
    const char *only; // load case; NULL: all
} study_options;

static bough_status read_part(const char *name, const char *text, void *field) {
    part *p = field;
    char rest;
    if (sscanf(text, "%d/%d%c", &p->k, &p->n, &rest) == 2 && p->k >= 1 && p->k <= p->n) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects K/N such as 1/4, got '%.80s'", name, text);
}

static const bough_option rows[] = {
    BOUGH_OPTION_OUT,
    BOUGH_OPTION_THREADS,
    {"part", "K/N", "of a study (stability, sweep, load-set) only the K-th of N shares of its runs",
     read_part, offsetof(study_options, part)},
    {"case", "NAME", "of a load set only the load case of that name", bough_option_text,
     offsetof(study_options, only)},
    BOUGH_OPTION_QUIET,
    {0},
};

static bough_status perform(bough_arena *arena, const void *given) {
    const study_options *own = given;
    const bough_options *options = &own->common;
    bough_errors errors = {.arena = arena};
    bough_study *study;
    bough_status status = bough_study_read(arena, options->operand, options->threads, &errors, &study);
    bough_errors_tell(&errors, &status);
    if (!bough_is_ok(&status)) return status;
    bough_study_options how = {.folder = bough_out_folder(arena, options),
                               .part = own->part.k,
                               .parts = own->part.n,
                               .only = own->only,
                               .quiet = options->quiet,
                               .stop = bough_stop_requested,
                               .stream = stdout};
    if (!(own->part.n > 0) && study->is.compared) { // parts and load sets share a folder
        BOUGH_TRY(bough_folder_make(how.folder));
        BOUGH_TRY(bough_lock_folder(arena, how.folder));
        bough_folder_clean(how.folder);
    }
    bough_stop_listen();
    status = bough_study_perform(arena, study, &how);
    if (bough_is_ok(&status)) printf("out: %s\n", how.folder);
    return status;
}

const bough_command bough_command_study = {
    .name = "study",
    .summary = "runs a scene for a grid of settings and compares cost and error",
    .operands = "STUDY",
    .option = rows,
    .size = sizeof(study_options),
    .run = perform,
};

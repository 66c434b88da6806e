// bough study: many runs of scenes, compared or with statistics.
#include "apps/bough/cases/perform.h"

#include "apps/bough/cli/command.h"
#include "apps/bough/results/folder.h"

typedef struct study_options {
    bough_options common;
    bough_study_options how;
} study_options;

static bough_status read_part(const bough_option *row, const char *text, void *field) {
    bough_study_options *how = field;
    char rest;
    bool read = sscanf(text, "%d/%d%c", &how->part, &how->parts, &rest) == 2;
    if (read && how->part >= 1 && how->part <= how->parts) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects K/N such as 1/4, got '%.80s'", row->name, text);
}

static const bough_option rows[] = {
    BOUGH_OPTION_OUT,
    {"threads", "N",
     "1 to 64: of stability, sweep and load-set simultaneous runs, otherwise threads of each run",
     bough_option_threads, .offset = offsetof(bough_options, threads)},
    {"part", "K/N", "only part K of N of the runs (stability, sweep, load-set)", read_part,
     .offset = offsetof(study_options, how)},
    {"case", "NAME", "only the load case of this name (load-set)", bough_option_text,
     .offset = offsetof(study_options, how.only)},
    BOUGH_OPTION_QUIET,
    {0},
};

static bough_status perform(bough_arena *arena, const void *given) {
    const study_options *own = given;
    const bough_options *options = &own->common;
    bough_errors errors = {.arena = arena};
    bough_study *study;
    bough_status status = bough_study_read(arena, options->operand, options->threads, &errors, &study);
    bough_errors_report(&errors, &status);
    if (!bough_is_ok(&status)) return status;
    bough_study_options how = own->how;
    how.folder = bough_out_folder(arena, options);
    how.quiet = options->quiet;
    how.stop = bough_stop_requested;
    how.stream = stdout;
    if (how.parts == 0 && study->is.compared) { // parts and processes of a load set share a folder
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

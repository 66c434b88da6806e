#include "apps/study/study_perform.h"

#include "apps/output/folder.h"
#include "apps/study/load_set_perform.h"
#include "apps/study/study_plot.h"
#include "apps/study/study_stability.h"
#include "apps/study/study_store.h"
#include "apps/study/study_timing.h"

// -- work-precision -------------------------------------------------------------------------------

typedef struct work {
    const bough_study *study;
    const bough_study_options *options;
    bough_study_results results;
    bough_study_store store;
    bough_study_series reference, series;
    bough_study_drive drive;
} work;

static int count_missing(const work *w) {
    int n = 0;
    for (int i = 0; i < w->study->n_cell; i++)
        n += !w->results.result[i].done;
    return n;
}

// Tables of an earlier state must not stand beside new cells.
static bough_status remove_results(const char *folder) {
    bough_status status = bough_folder_remove(folder, "table.txt");
    if (bough_is_ok(&status)) status = bough_folder_remove(folder, "table.csv");
    return bough_is_ok(&status) ? bough_folder_remove(folder, "plot.svg") : status;
}

static bough_status start(bough_arena *arena, work *w) {
    const bough_study *s = w->study;
    w->results.result = bough_arena_take(arena, (size_t)s->n_cell * sizeof *w->results.result);
    w->reference = bough_study_series_take(arena, s);
    w->series = bough_study_series_take(arena, s);
    w->drive.stop = w->options->stop;
    w->drive.progress = bough_progress_start(0, s->duration, w->options->quiet);
    bough_status status = bough_folder_make(w->options->folder);
    if (bough_is_ok(&status)) status = remove_results(w->options->folder);
    if (!bough_is_ok(&status)) return status;
    return bough_study_store_open(arena, w->options->folder, "cells.csv", s, &w->results.reference,
                                  w->results.result, &w->store);
}

static bough_status run_reference(work *w) {
    const bough_study_cell *cell = w->study->reference_cell;
    bough_study_result result;
    w->drive.progress.label = "reference";
    bough_status status = bough_study_run(w->study, cell, 1, &w->drive, &w->reference, &result);
    if (!bough_is_ok(&status)) return status;
    if (!bough_is_ok(&result.outcome)) {
        return bough_fail(BOUGH_FAILED, "the reference failed: %.340s", result.outcome.message);
    }
    if (w->results.reference.done) return status;
    bough_study_compare(w->study, &w->reference, &w->reference, result.error);
    w->results.reference = result;
    return bough_study_store_add(&w->store, cell, &result);
}

static bough_status run_cell(work *w, int i) {
    const bough_study_cell *cell = &w->study->cell[i];
    bough_study_result *result = &w->results.result[i];
    char label[96];
    snprintf(label, sizeof label, "run %d of %d: %.50s", i + 1, w->study->n_cell, cell->settings);
    w->drive.progress.label = label;
    bough_status status =
        bough_study_run(w->study, cell, w->study->repeat, &w->drive, &w->series, result);
    if (!bough_is_ok(&status)) return status;
    if (bough_is_ok(&result->outcome)) {
        bough_study_compare(w->study, &w->series, &w->reference, result->error);
    }
    return bough_study_store_add(&w->store, cell, result);
}

// One after the other, so that they do not disturb each other's times. The reference is needed as
// long as a cell is missing.
static bough_status run_missing(work *w) {
    bough_status status = bough_ok();
    if (count_missing(w) > 0 || !w->results.reference.done) status = run_reference(w);
    for (int i = 0; i < w->study->n_cell && bough_is_ok(&status); i++) {
        if (!w->results.result[i].done) status = run_cell(w, i);
    }
    bough_progress_clear(&w->drive.progress);
    if (status.code != BOUGH_INTERRUPTED) return status;
    int left = count_missing(w), n = w->study->n_cell;
    return bough_fail(BOUGH_INTERRUPTED,
                      "interrupted after %d of %d runs, which are kept in %.150s; the same command "
                      "goes on from there",
                      n - left, n, w->options->folder);
}

static bough_status work_precision(bough_arena *arena, const bough_study *study,
                                   const bough_study_options *options) {
    work w = {.study = study, .options = options, .results = {.study = study}};
    bough_status status = start(arena, &w);
    if (bough_is_ok(&status)) status = run_missing(&w);
    bough_study_store_close(&w.store);
    if (bough_is_ok(&status)) status = bough_study_write_tables(&w.results, options->folder);
    if (bough_is_ok(&status)) status = bough_study_plot(&w.results, options->folder);
    if (bough_is_ok(&status)) bough_study_print(&w.results, options->stream);
    return status;
}

// -- kinds ----------------------------------------------------------------------------------------

typedef bough_status perform_function(bough_arena *arena, const bough_study *study,
                                      const bough_study_options *options);

static perform_function *const kinds[] = {[BOUGH_STUDY_WORK_PRECISION] = work_precision,
                                          [BOUGH_STUDY_SWEEP] = bough_load_set_perform,
                                          [BOUGH_STUDY_LOAD_SET] = bough_load_set_perform,
                                          [BOUGH_STUDY_TIMING] = bough_timing_perform,
                                          [BOUGH_STUDY_STABILITY] = bough_stability_perform};

bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options) {
    bool shared = study->kind >= BOUGH_STUDY_STABILITY;
    if (options->parts > 0 && !shared) {
        return bough_fail(BOUGH_INVALID,
                          "only studies of kind stability, sweep and load-set run in parts");
    }
    if (options->only && study->kind != BOUGH_STUDY_LOAD_SET) {
        return bough_fail(BOUGH_INVALID, "only a load set has load cases to choose by --case");
    }
    return kinds[study->kind](arena, study, options);
}

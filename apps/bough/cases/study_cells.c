#include "apps/bough/cases/study_cells.h"

#include "apps/bough/cases/store.h"
#include "apps/bough/cases/study_batch.h"
#include "apps/bough/results/folder.h"

typedef struct work {
    bough_study_results *results;
    bough_batch batch; // a piece is a group: a reference with its cells
    bool parallel;
} work;

// -- results in files -----------------------------------------------------------------------------

static bough_status read_results(const char *folder, bough_study_results *x) {
    const bough_study *s = x->study;
    bough_status status = bough_ok();
    for (int i = 0; i < s->n_reference && bough_is_ok(&status); i++)
        status = bough_store_read(folder, s, &s->reference_case[i], &x->reference[i]);
    for (int i = 0; i < s->n_case && bough_is_ok(&status); i++)
        status = bough_store_read(folder, s, &s->cases[i], &x->result[i]);
    return status;
}

static bough_status keep(const work *w, const bough_case *cell, const bough_case_result *result) {
    return bough_store_write(w->batch.options->folder, w->results->study, cell, result);
}

// -- runs -----------------------------------------------------------------------------------------

// Runs it again where its result is there but not its series.
static bough_status run_reference(work *w, int group, bough_study_drive *drive, bough_study_series *series) {
    const bough_study *s = w->results->study;
    const bough_case *cell = &s->reference_case[group];
    bough_case_result *kept = &w->results->reference[group], r;
    drive->progress.label = "reference";
    bough_status status = bough_case_run(s, cell, 1, drive, series, &r);
    if (!bough_is_ok(&status)) return status;
    if (bough_is_ok(&r.outcome)) {
        bough_study_compare(s, series, series, r.error);
    } else if (!w->parallel) {
        return bough_fail(BOUGH_FAILED, "the reference failed: %.340s", r.outcome.message);
    }
    if (kept->done) return status;
    *kept = r;
    return keep(w, cell, kept);
}

static bough_status run_cell(work *w, int i, bough_study_drive *drive, const bough_study_series *reference,
                             bough_study_series *series) {
    const bough_study *s = w->results->study;
    const bough_case *cell = &s->cases[i];
    bough_case_result *r = &w->results->result[i];
    char label[96];
    snprintf(label, sizeof label, "run %d of %d: %.50s", i + 1, s->n_case, cell->settings);
    drive->progress.label = label;
    bough_status status = bough_case_run(s, cell, s->repeat, drive, series, r);
    if (!bough_is_ok(&status)) return status;
    bool both = bough_is_ok(&r->outcome) && bough_is_ok(&w->results->reference[cell->reference].outcome);
    if (both) bough_study_compare(s, series, reference, r->error);
    status = keep(w, cell, r);
    bough_batch_enter(&w->batch);
    bough_batch_leave(&w->batch);
    return status;
}

static bool is_mine(const bough_study_options *o, int group) {
    return o->parts == 0 || group % o->parts == o->part - 1;
}

// Of one group; −1: of all.
static int count_missing(const bough_study_results *x, int group) {
    int n = 0;
    for (int i = 0; i < x->study->n_case; i++)
        n += (group < 0 || x->study->cases[i].reference == group) && !x->result[i].done;
    return n;
}

int bough_study_missing(const bough_study_results *x) { return count_missing(x, -1); }

// One after the other, so that they do not disturb each other's times. The reference is needed as long as a
// cell is missing.
static bough_status run_group(bough_arena *arena, void *self, int group) {
    work *w = self;
    const bough_study *s = w->results->study;
    const bough_study_options *o = w->batch.options;
    bool needed =
        count_missing(w->results, group) > 0 || (!w->parallel && !w->results->reference[group].done);
    if (!is_mine(o, group) || !needed) return bough_ok();
    bough_study_drive drive = {.stop = o->stop,
                               .progress = bough_progress_start(0, s->duration, o->quiet || w->parallel)};
    bough_study_series reference = bough_study_series_take(arena, s);
    bough_study_series series = bough_study_series_take(arena, s);
    bough_status status = run_reference(w, group, &drive, &reference);
    for (int i = 0; i < s->n_case && bough_is_ok(&status); i++) {
        if (s->cases[i].reference == group && !w->results->result[i].done)
            status = run_cell(w, i, &drive, &reference, &series);
    }
    bough_progress_clear(&drive.progress);
    return status;
}

// Tables of an earlier state must not stand beside new results.
static bough_status remove_tables(const char *folder) {
    static const char *const names[] = {"table.txt", "table.csv", "plot.svg"};
    bough_status status = bough_ok();
    for (int i = 0; i < 3 && bough_is_ok(&status); i++) status = bough_folder_remove(folder, names[i]);
    return status;
}

bough_status bough_study_cells(bough_arena *arena, const bough_study *study,
                               const bough_study_options *options, bough_study_results *results) {
    *results = (bough_study_results){
        .study = study,
        .reference = bough_arena_take(arena, (size_t)study->n_reference * sizeof *results->reference),
        .result = bough_arena_take(arena, (size_t)study->n_case * sizeof *results->result)};
    bool parallel = study->is.parallel;
    work w = {.results = results, .parallel = parallel};
    bough_status status = bough_store_open(options->folder);
    if (bough_is_ok(&status)) status = remove_tables(options->folder);
    if (bough_is_ok(&status)) status = read_results(options->folder, results);
    if (!bough_is_ok(&status)) return status;
    w.batch = (bough_batch){
        options,   "runs", study->n_reference, .counts = parallel && !options->quiet, .perform = run_group,
        .self = &w};
    for (int g = 0; g < study->n_reference; g++)
        w.batch.to_do += is_mine(options, g) ? count_missing(results, g) : 0;
    status = bough_batch_run(arena, &w.batch, parallel ? study->threads : 1);
    results->ran = w.batch.done;
    return status;
}

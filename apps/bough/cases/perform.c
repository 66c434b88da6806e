// Performs the runs of a study, several at a time, until all are done or one of them ends the study.
#include "apps/bough/cases/perform.h"

#include <pthread.h>

typedef struct work {
    bough_study_results results;
    bough_status (*perform)(bough_arena *arena, struct work *w, int piece); // each in its own arena
    const char *what;                                                       // the runs' name, "cases"
    int n, to_do; // pieces of work, and runs in them
    int *piece;   // (n) numbers of cases; of compared runs numbers of references, each with its cases
    bool counts;  // prints the number of finished runs on the terminal
    double simulated, cpu; // [s]
    int claims, threads;
    bough_status worst;
    bough_pool *pool;
    bough_boxes *boxes;    // of statistics
    pthread_mutex_t mutex; // guards `worst` and the counts
} work;

// -- pieces ---------------------------------------------------------------------------------------

typedef struct task {
    work *work;
    int piece;
} task;

static bough_status perform_in(bough_arena *arena, void *self) {
    const task *t = self;
    return t->work->perform(arena, t->work, t->piece);
}

static void perform(void *self, int i) {
    work *w = self;
    task t = {w, w->piece[i]};
    pthread_mutex_lock(&w->mutex);
    bool goes_on = bough_is_ok(&w->worst);
    pthread_mutex_unlock(&w->mutex);
    if (!goes_on) return;
    bough_status status = bough_arena_use(perform_in, &t);
    pthread_mutex_lock(&w->mutex);
    if (bough_is_ok(&w->worst)) w->worst = status;
    pthread_mutex_unlock(&w->mutex);
}

static void perform_pieces(void *self) {
    work *w = self;
    bough_pool_run(w->pool, w->n, perform, w);
}

static void count_run(work *w, int number, const bough_case_result *r) {
    const bough_study *s = w->results.study;
    pthread_mutex_lock(&w->mutex);
    w->results.ran++;
    w->simulated += r->time;
    w->cpu += r->cpu;
    if (!s->is.compared && !bough_is_ok(&r->outcome)) {
        w->results.failed++;
        bough_case_failed(s, number, r->outcome.message, stderr);
    }
    if (w->counts) fprintf(stderr, "\r%d of %d %s", w->results.ran, w->to_do, w->what);
    pthread_mutex_unlock(&w->mutex);
}

// Compared runs run one at a time, so that they do not disturb each other's times, except those of kind
// stability.
static int threads_of(const work *w) {
    const bough_study *s = w->results.study;
    if (!s->is.parallel || w->n < 1) return 1;
    int threads = s->threads > 0 ? s->threads : bough_pool_default(0);
    return threads < w->n ? threads : w->n;
}

static bough_status perform_all(bough_arena *arena, work *w) {
    w->threads = threads_of(w);
    w->pool = bough_pool_create(arena, w->threads);
    w->worst = bough_ok();
    pthread_mutex_init(&w->mutex, NULL);
    bough_pool_region(w->pool, perform_pieces, w);
    pthread_mutex_destroy(&w->mutex);
    if (w->counts && w->results.ran > 0) fputc('\n', stderr);
    if (w->worst.code != BOUGH_INTERRUPTED) return w->worst;
    return bough_fail(BOUGH_INTERRUPTED,
                      "interrupted after %d of %d %s, which are kept in %.150s; the same command "
                      "goes on from there",
                      w->results.ran, w->to_do, w->what, w->results.options->folder);
}

static bool is_mine(const bough_study_options *o, int piece) {
    return o->parts == 0 || piece % o->parts == o->part - 1;
}

// Older tables must not stay beside new results.
static bough_status remove_tables(const char *folder) {
    static const char *const names[] = {"table.txt",  "table.csv",  "plot.svg",
                                        "cases.csv",  "costs.csv",  "equivalent.csv",
                                        "ranges.csv", "levels.csv", "extremes.csv"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        BOUGH_TRY(bough_folder_remove(folder, names[i]));
    return bough_ok();
}

// -- compared runs --------------------------------------------------------------------------------

static bough_status read_results(bough_study_results *x) {
    const bough_study *s = x->study;
    const char *folder = x->options->folder;
    for (int i = 0; i < s->n_reference; i++)
        BOUGH_TRY(bough_store_read(folder, s, &s->reference_case[i], &x->reference[i]));
    for (int i = 0; i < s->n_case; i++) BOUGH_TRY(bough_store_read(folder, s, &s->cases[i], &x->result[i]));
    return bough_ok();
}

// Runs the reference, also if its result is stored, since its series is not.
static bough_status run_reference(work *w, int group, bough_study_drive *drive, bough_study_series *series) {
    const bough_study *s = w->results.study;
    const bough_case *cell = &s->reference_case[group];
    bough_case_result *kept = &w->results.reference[group], r = {0};
    drive->progress.label = "reference";
    BOUGH_TRY(bough_case_run(s, cell, 1, drive, series, &r));
    if (bough_is_ok(&r.outcome)) {
        bough_study_compare(s, series, series, r.error);
    } else if (!s->is.parallel) {
        return bough_fail(BOUGH_FAILED, "the reference failed: %.340s", r.outcome.message);
    }
    if (kept->done) return bough_ok();
    *kept = r;
    return bough_store_write(w->results.options->folder, s, cell, kept);
}

static bough_status run_cell(work *w, int i, bough_study_drive *drive, const bough_study_series *reference,
                             bough_study_series *series) {
    const bough_study *s = w->results.study;
    const bough_case *cell = &s->cases[i];
    bough_case_result *r = &w->results.result[i];
    char label[96];
    snprintf(label, sizeof label, "run %d of %d: %.50s", i + 1, s->n_case, cell->settings);
    drive->progress.label = label;
    BOUGH_TRY(bough_case_run(s, cell, s->repeat, drive, series, r));
    bool both = bough_is_ok(&r->outcome) && bough_is_ok(&w->results.reference[cell->reference].outcome);
    if (both) bough_study_compare(s, series, reference, r->error);
    bough_status status = bough_store_write(w->results.options->folder, s, cell, r);
    count_run(w, i, r);
    return status;
}

int bough_study_missing(const bough_study_results *x, int group) {
    const bough_study *s = x->study;
    int n = 0;
    for (int i = 0; i < s->n_case; i++) {
        if (group >= 0 && s->cases[i].reference != group) continue;
        n += x->result ? !x->result[i].done : !bough_store_has(x->options->folder, s, &s->cases[i]);
    }
    return n;
}

static bough_status run_group(bough_arena *arena, work *w, int group) {
    const bough_study *s = w->results.study;
    const bough_study_options *o = w->results.options;
    bough_study_drive drive = {.stop = o->stop,
                               .progress = bough_progress_start(0, s->duration, o->quiet || s->is.parallel)};
    bough_study_series reference = bough_study_series_take(arena, s);
    bough_study_series series = bough_study_series_take(arena, s);
    bough_status status = run_reference(w, group, &drive, &reference);
    for (int i = 0; i < s->n_case && bough_is_ok(&status); i++) {
        if (s->cases[i].reference == group && !w->results.result[i].done)
            status = run_cell(w, i, &drive, &reference, &series);
    }
    bough_progress_clear(&drive.progress);
    return status;
}

// A reference is run also as long as one of its cells is missing. Groups of kind stability run in parallel,
// each run on one thread, and cells of a failed reference have no errors; otherwise a failed reference ends
// the study.
static bough_status run_groups(bough_arena *arena, work *w) {
    bough_study_results *x = &w->results;
    const bough_study *s = x->study;
    x->reference = bough_arena_take(arena, (size_t)s->n_reference * sizeof *x->reference);
    x->result = bough_arena_take(arena, (size_t)s->n_case * sizeof *x->result);
    w->piece = bough_arena_take(arena, (size_t)s->n_reference * sizeof *w->piece);
    BOUGH_TRY(remove_tables(x->options->folder));
    BOUGH_TRY(read_results(x));
    for (int g = 0; g < s->n_reference; g++) {
        int missing = bough_study_missing(x, g);
        bool needed = missing > 0 || !x->reference[g].done;
        if (!needed || !is_mine(x->options, g)) continue;
        w->piece[w->n++] = g;
        w->to_do += missing;
    }
    w->perform = run_group;
    w->what = "runs";
    w->counts = s->is.parallel && !x->options->quiet;
    return perform_all(arena, w);
}

// -- statistics -----------------------------------------------------------------------------------

static bough_status run_case(bough_arena *arena, work *w, int number) {
    const bough_study *s = w->results.study;
    const bough_study_options *o = w->results.options;
    char name[48], folder[BOUGH_PATH_MAX];
    bough_case_result result = bough_case_take(arena, s);
    bough_study_drive drive = {.stop = o->stop, .folder = s->series ? folder : NULL, .boxes = w->boxes};
    snprintf(name, sizeof name, "cases/%06d", number + 1);
    BOUGH_TRY(bough_folder_path(o->folder, name, folder));
    BOUGH_TRY(bough_case_run(s, &s->cases[number], 1, &drive, NULL, &result));
    BOUGH_TRY(bough_store_write(o->folder, s, &s->cases[number], &result));
    count_run(w, number, &result);
    return bough_ok();
}

// Another process may have run it since the list was made.
static bough_status claim_case(bough_arena *arena, work *w, int number) {
    const bough_study *s = w->results.study;
    bough_status status = bough_ok();
    if (!bough_claim(w->claims, number)) return status;
    if (!bough_store_has(w->results.options->folder, s, &s->cases[number]))
        status = run_case(arena, w, number);
    bough_claim_drop(w->claims, number);
    return status;
}

static bough_status check_name(bough_arena *arena, const bough_study *s, const char *only) {
    const char **names = bough_arena_take(arena, (size_t)s->n_group * sizeof *names);
    for (int i = 0; i < s->n_group; i++) {
        names[i] = s->group[i].name;
        if (!only || strcmp(names[i], only) == 0) return bough_ok();
    }
    return bough_fail(BOUGH_INVALID, "%s has no load case '%.80s'%s", s->file, only,
                      bough_suggest(only, names, s->n_group).text);
}

// Lists the cases to run, those with the same turbulence one after the other.
static void list_cases(bough_arena *arena, work *w) {
    const bough_study *s = w->results.study;
    const bough_study_options *o = w->results.options;
    w->piece = bough_arena_take(arena, (size_t)s->n_case * sizeof *w->piece);
    for (int first = 0; first < s->n_case; first++) {
        for (int i = s->cases[first].follows ? -1 : first; i >= 0; i = s->cases[i].next) {
            bool wanted = !o->only || strcmp(o->only, s->group[s->cases[i].group].name) == 0;
            if (wanted && is_mine(o, i) && !bough_store_has(o->folder, s, &s->cases[i])) w->piece[w->n++] = i;
        }
    }
    w->to_do = w->n;
}

static bough_status run_cases(bough_arena *arena, work *w) {
    const bough_study_options *o = w->results.options;
    BOUGH_TRY(bough_claims_open(arena, o->folder, &w->claims));
    list_cases(arena, w);
    if (w->n > 0) BOUGH_TRY(remove_tables(o->folder));
    w->boxes = bough_boxes_create(arena, threads_of(w));
    w->perform = claim_case;
    w->what = "cases";
    w->counts = !o->quiet;
    double began = bough_wall_clock();
    bough_status status = perform_all(arena, w);
    if (w->results.ran > 0) {
        fprintf(o->stream,
                "ran %d case%s, %.4g simulated hours in %.4g s on %d thread%s: %.4g simulated hours per "
                "core hour\n",
                w->results.ran, w->results.ran == 1 ? "" : "s", w->simulated / 3600,
                bough_wall_clock() - began, w->threads, w->threads == 1 ? "" : "s", w->simulated / w->cpu);
    }
    return status;
}

// -- kinds ----------------------------------------------------------------------------------------

// By bough_study_kind. Runs of a kind without `run` are not stored.
static const struct {
    bough_status (*run)(bough_arena *arena, work *w);
    bough_study_conclude *conclude;
} kinds[] = {
    [BOUGH_STUDY_WORK_PRECISION] = {run_groups, bough_precision_conclude},
    [BOUGH_STUDY_TIMING] = {NULL, bough_timing_conclude},
    [BOUGH_STUDY_STABILITY] = {run_groups, bough_stability_conclude},
    [BOUGH_STUDY_SWEEP] = {run_cases, bough_statistics_conclude},
    [BOUGH_STUDY_LOAD_SET] = {run_cases, bough_statistics_conclude},
};

bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options) {
    if (options->parts > 0 && !study->is.parallel) {
        return bough_fail(BOUGH_INVALID, "only studies of kind stability, sweep and load-set run in parts");
    }
    if (options->only && !study->is.weighted) {
        return bough_fail(BOUGH_INVALID, "only a load set has load cases to choose by --case");
    }
    work w = {.results = {.study = study, .options = options}};
    BOUGH_TRY(check_name(arena, study, options->only));
    if (kinds[study->kind].run) {
        BOUGH_TRY(bough_store_open(options->folder));
        BOUGH_TRY(kinds[study->kind].run(arena, &w));
    }
    return kinds[study->kind].conclude(arena, &w.results);
}

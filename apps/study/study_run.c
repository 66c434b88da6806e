#include "apps/study/study_run.h"

#include "apps/scene/fingerprint.h"
#include "apps/simulation/error_probe.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_REPEAT = 99 };

typedef struct run {
    const bough_study *study;
    bough_study_drive *drive;
    bough_simulation *simulation;
    bough_channels channels;
    int *column;   // (n_channel) of the study's channels among the simulation's
    double *value; // (channels.count) scratch
    bough_study_series *series;
    bough_error_probe probe;
    double *gathered, *zero; // (n_channel) scratch
    double *estimate;        // (n_measure)
    bough_status outcome;
} run;

// Runs side by side have one thread each.
static double cpu_clock(const bough_study *study) {
    struct timespec now;
    bool own = study->kind == BOUGH_STUDY_STABILITY;
    clock_gettime(own ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// -- sampling -------------------------------------------------------------------------------------

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study) {
    bough_study_series series = {.n_row = (int)(study->duration / study->interval + 1e-6) + 1,
                                 .n_channel = study->n_channel};
    series.value = bough_arena_doubles(arena, (size_t)series.n_row * (size_t)series.n_channel);
    return series;
}

static void sample_when_due(run *r) {
    const bough_master *m = r->simulation->master;
    bough_study_series *s = r->series;
    double due = s->filled * r->study->interval;
    if (s->filled == s->n_row || m->time < due - 1e-6 * m->macro_step) return;
    bough_simulation_update(r->simulation);
    bough_channels_sample(&r->channels, m->time, r->value);
    double *row = s->value + (size_t)s->filled * (size_t)s->n_channel;
    for (int i = 0; i < s->n_channel; i++)
        row[i] = r->value[r->column[i]];
    s->filled++;
}

// -- norms ----------------------------------------------------------------------------------------

// The larger of the two; a NaN wins and stays.
static double larger(double a, double b) { return isnan(b) || b > a ? b : a; }

// Of n components in one row.
static double difference(const double *a, const double *b, int n, int norm) {
    double sum = 0, largest = 0;
    for (int i = 0; i < n; i++) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
        largest = larger(largest, fabs(a[i] - b[i]));
    }
    return norm == BOUGH_STUDY_EUCLID ? sqrt(sum) : largest;
}

// -- the run's own estimate -----------------------------------------------------------------------

// A channel that does not follow from the states has none.
static void gather_estimate(run *r) {
    for (int i = 0; i < r->study->n_channel; i++) {
        bool known = r->column[i] < r->simulation->n_motion_channel;
        r->gathered[i] = known ? r->probe.difference[r->column[i]] : (double)NAN;
    }
}

static void update_estimates(run *r, double *estimate) {
    if (!bough_error_probe_update(&r->probe)) return;
    gather_estimate(r);
    int first = 0;
    for (int i = 0; i < r->study->n_measure; i++) {
        const bough_study_measure *m = &r->study->measure[i];
        double worst = 0;
        for (int k = 0; k < m->channels.n; first += m->channels.item[k++].n) {
            worst = larger(worst, difference(r->gathered + first, r->zero, m->channels.item[k].n,
                                             m->norm));
        }
        estimate[i] = larger(estimate[i], m->scale * worst);
    }
}

// -- one run --------------------------------------------------------------------------------------

static void show_progress(bough_study_drive *drive, const bough_master *m) {
    double now = drive->progress.visible ? bough_wall_clock() : 0;
    if (!drive->progress.visible || now - drive->progress.shown < 0.1) return;
    drive->progress.shown = now;
    fprintf(stderr, "\r%-50.50s %8.2f of %.6g s", drive->label, m->time, m->duration);
    fflush(stderr);
}

static bough_status step(run *r) {
    bough_master *m = r->simulation->master;
    if (r->drive->stop && r->drive->stop()) return bough_fail(BOUGH_INTERRUPTED, "interrupted");
    bough_status status = bough_step(m);
    update_estimates(r, r->estimate);
    if (bough_is_ok(&status)) sample_when_due(r);
    show_progress(r->drive, m);
    return status;
}

static void step_all(void *self) {
    run *r = self;
    r->outcome = bough_ok();
    sample_when_due(r);
    while (bough_is_ok(&r->outcome) && !bough_master_done(r->simulation->master)) {
        r->outcome = step(r);
    }
}

static bough_status find_channels(bough_arena *arena, run *r) {
    const bough_study *s = r->study;
    r->channels = bough_channels_start(arena);
    bough_status status = bough_simulation_channels(r->simulation, &r->channels);
    if (!bough_is_ok(&status)) return status;
    r->column = bough_arena_take(arena, (size_t)s->n_channel * sizeof *r->column);
    r->value = bough_arena_doubles(arena, (size_t)r->channels.count);
    r->gathered = bough_arena_doubles(arena, (size_t)s->n_channel);
    r->zero = bough_arena_doubles(arena, (size_t)s->n_channel);
    if (bough_arena_exhausted(arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int i = 0; i < s->n_channel; i++) {
        r->column[i] = bough_channels_find(&r->channels, s->channel[i]);
        if (r->column[i] < 0) {
            return bough_fail(BOUGH_INVALID, "this run has no channel '%.80s'", s->channel[i]);
        }
    }
    return bough_error_probe_create(arena, r->simulation, &r->channels, &r->probe);
}

// Every cell was read when the study began: an error now is none of the cell, nor may a changed scene
// be compared with runs of the old one.
static bough_status read_scene(bough_arena *arena, const bough_study *study,
                               const bough_study_cell *cell, bough_scene **scene) {
    bough_errors errors = {.arena = arena};
    bough_status status =
        bough_scene_read(arena, study->scene, cell->set, cell->n_set, &errors, scene);
    if (study->scene_sum == 0 || (!bough_is_ok(&status) && status.code != BOUGH_INVALID)) {
        return status;
    }
    uint64_t sum = BOUGH_FINGERPRINT_START;
    bough_mix_file(&sum, study->scene);
    if (bough_is_ok(&status) && sum == study->scene_sum) return status;
    return bough_fail(BOUGH_IO,
                      "the scene '%.150s' or a file of it has changed or is gone since the study "
                      "began%s%.100s; runs so far are kept", study->scene,
                      errors.n > 0 ? ": " : "", errors.n > 0 ? errors.item[0].text : "");
}

static bough_status build(bough_arena *arena, const bough_study_cell *cell, run *r) {
    bough_scene *scene;
    bough_status status = read_scene(arena, r->study, cell, &scene);
    if (!bough_is_ok(&status)) return status;
    if (r->study->kind == BOUGH_STUDY_STABILITY) scene->simulation.threads = 1;
    else if (r->study->threads > 0) scene->simulation.threads = r->study->threads;
    status = bough_simulation_build(arena, scene, &r->simulation);
    if (bough_is_ok(&status)) status = find_channels(arena, r);
    return status;
}

static bough_status run_in(bough_arena *arena, const bough_study_cell *cell, run *r,
                           bough_study_result *result) {
    bough_status status = build(arena, cell, r);
    if (!bough_is_ok(&status)) return status;
    const bough_master *m = r->simulation->master;
    r->series->filled = 0;
    double wall = bough_wall_clock(), cpu = cpu_clock(r->study);
    for (int i = 0; i < r->study->n_measure; i++) result->estimate[i] = m->estimate ? 0 : (double)NAN;
    r->estimate = result->estimate;
    bough_pool_region(r->simulation->pool, step_all, r);
    result->cpu = cpu_clock(r->study) - cpu;
    result->wall = bough_wall_clock() - wall;
    result->time = m->time;
    result->warned = m->verdict[0] != '\0';
    result->coupling = bough_monitor_report(m->monitor, m->coupling);
    assert(!bough_is_ok(&r->outcome) || r->series->filled == r->series->n_row);
    return r->outcome;
}

// -- repeats --------------------------------------------------------------------------------------

static int compare_numbers(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int n) {
    qsort(values, (size_t)n, sizeof *values, compare_numbers);
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// A run that fails says something about its settings; these outcomes do not.
static bool ends_study(bough_code code) {
    return code == BOUGH_INTERRUPTED || code == BOUGH_OUT_OF_MEMORY || code == BOUGH_IO;
}

bough_status bough_study_run(const bough_study *study, const bough_study_cell *cell, int repeat,
                             bough_study_drive *drive, bough_study_series *series,
                             bough_study_result *result) {
    double wall[MAX_REPEAT] = {0}, cpu[MAX_REPEAT] = {0};
    int n = 0;
    assert(repeat >= 1 && repeat <= MAX_REPEAT);
    *result = (bough_study_result){.outcome = bough_ok()};
    while (n < repeat && bough_is_ok(&result->outcome)) {
        bough_arena *arena = bough_arena_create();
        if (!arena) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
        run r = {.study = study, .drive = drive, .series = series};
        result->outcome = run_in(arena, cell, &r, result);
        bough_arena_destroy(arena);
        wall[n] = result->wall;
        cpu[n] = result->cpu;
        n++;
    }
    if (ends_study(result->outcome.code)) return result->outcome;
    // The times of a failed repeat are its own: they belong to the time it reached.
    bool good = bough_is_ok(&result->outcome);
    result->wall = good ? median(wall, n) : wall[n - 1];
    result->cpu = good ? median(cpu, n) : cpu[n - 1];
    for (int i = 0; i < study->n_measure; i++)
        result->error[i] = (double)NAN;
    result->done = true;
    return bough_ok();
}

// -- differences ----------------------------------------------------------------------------------

// Of n components from `first`, over all rows.
static double largest_difference(const bough_study_series *a, const bough_study_series *b,
                                 int first, int n, int norm) {
    double largest = 0;
    for (int i = 0; i < a->n_row; i++) {
        size_t at = (size_t)i * (size_t)a->n_channel + (size_t)first;
        largest = larger(largest, difference(a->value + at, b->value + at, n, norm));
    }
    return largest;
}

void bough_study_compare(const bough_study *study, const bough_study_series *series,
                         const bough_study_series *reference, double *error) {
    assert(series->filled == series->n_row && reference->filled == series->n_row);
    int first = 0;
    for (int i = 0; i < study->n_measure; i++) {
        const bough_study_measure *m = &study->measure[i];
        error[i] = 0;
        for (int k = 0; k < m->channels.n; k++) {
            int n = m->channels.item[k].n;
            error[i] = larger(error[i], largest_difference(series, reference, first, n, m->norm));
            first += n;
        }
        error[i] *= m->scale;
    }
}

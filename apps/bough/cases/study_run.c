#include "apps/bough/cases/study_run.h"

#include "apps/bough/model/run.h"
#include "apps/bough/results/recorder.h"
#include "apps/bough/scene/fingerprint.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct cell_run {
    const bough_study *study;
    const bough_study_cell *cell;
    bough_study_drive *drive;
    bough_study_result *result;
    bough_run run;
    int *column; // (n_channel) of the study's channels among the run's
    bough_study_series *series;
    bough_recorder *recorder; // of all channels; NULL: none
    double *gathered, *zero;  // (n_channel) scratch
} cell_run;

// -- sampling -------------------------------------------------------------------------------------

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study) {
    bough_study_series series = {.n_row = (int)(study->duration / study->interval + 1e-6) + 1,
                                 .n_channel = study->n_channel};
    series.value = bough_arena_doubles(arena, (size_t)series.n_row * (size_t)series.n_channel);
    return series;
}

static bough_status sample(void *self, double t) {
    cell_run *r = self;
    bough_study_series *s = r->series;
    assert(s->filled < s->n_row);
    bough_status status = bough_ok();
    if (r->recorder) status = bough_recorder_sample(r->recorder, t);
    if (!r->recorder) bough_channels_sample(&r->run.channels, t, r->run.value);
    const double *value = r->recorder ? bough_recorder_values(r->recorder) : r->run.value;
    double *row = s->value + (size_t)s->filled++ * (size_t)s->n_channel;
    for (int i = 0; i < s->n_channel; i++) row[i] = value[r->column[i]];
    return status;
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

// Of each measure: the norm of the largest errors of its channels, which may have been at different times.
static void gather_estimates(cell_run *r, double *estimate) {
    const bough_companion *c = r->run.companion;
    for (int i = 0; i < r->study->n_channel; i++) {
        bool known = bough_companion_knows(c, r->column[i]);
        r->gathered[i] = known ? c->error[r->column[i]] : (double)NAN;
    }
    int first = 0;
    for (int i = 0; i < r->study->n_measure; i++) {
        const bough_study_measure *m = &r->study->measure[i];
        estimate[i] = 0;
        for (int k = 0; k < m->channels.n; first += m->channels.item[k++].n) {
            double norm = difference(r->gathered + first, r->zero, m->channels.item[k].n, m->norm);
            estimate[i] = larger(estimate[i], m->scale * norm);
        }
    }
}

// -- one run --------------------------------------------------------------------------------------

bough_status bough_study_columns(bough_arena *arena, const bough_channels *channels, int n,
                                 const char *const *name, int **column) {
    int *found = *column = bough_arena_take(arena, (size_t)n * sizeof *found);
    for (int i = 0; i < n; i++) {
        found[i] = bough_channels_find(channels, name[i]);
        if (found[i] < 0) return bough_fail(BOUGH_INVALID, "this run has no channel '%.80s'", name[i]);
    }
    return bough_ok();
}

static bough_status changed(const char *scene, const char *why) {
    return bough_fail(BOUGH_IO,
                      "the scene '%.150s' or a file of it has changed or is gone since the study "
                      "began%s%.100s; runs so far are kept",
                      scene, why[0] ? ": " : "", why);
}

bough_status bough_study_read_scene(bough_arena *arena, const bough_study_source *from, bough_scene **scene) {
    bough_errors errors = {.arena = arena};
    bough_status status = bough_scene_read(arena, from->scene, from->set, from->n_set, &errors, scene);
    if (from->files == 0 || status.code != BOUGH_INVALID) return status;
    return changed(from->scene, errors.n > 0 ? errors.item[0].text : "");
}

bough_status bough_study_same_files(bough_arena *arena, const bough_scene *scene, uint64_t files) {
    uint64_t now = BOUGH_FINGERPRINT_START;
    if (files == 0) return bough_ok();
    bough_mix_scene(&now, &(bough_file_sums){.arena = arena}, scene);
    return now == files ? bough_ok() : changed(scene->file, "");
}

static bool is_reference(const bough_study *s, const bough_study_cell *cell) {
    return cell >= s->reference_cell && cell < s->reference_cell + s->n_reference;
}

static bough_status build(bough_arena *arena, const bough_study_cell *cell, cell_run *r) {
    bough_scene *scene;
    bough_study_source source = {r->study->scene, cell->n_set, cell->set, cell->files};
    bough_status status = bough_study_read_scene(arena, &source, &scene);
    if (!bough_is_ok(&status)) return status;
    if (r->study->kind == BOUGH_STUDY_STABILITY)
        scene->simulation.threads = 1;
    else if (r->study->threads > 0)
        scene->simulation.threads = r->study->threads;
    if (is_reference(r->study, cell)) scene->simulation.error_estimate = BOUGH_SCENE_NO_ESTIMATE;
    bough_status built = bough_run_create(arena, scene, &r->run);
    status = bough_study_same_files(arena, scene, cell->files);
    if (!bough_is_ok(&status) || !bough_is_ok(&built)) return bough_is_ok(&status) ? built : status;
    const bough_study *s = r->study;
    r->gathered = bough_arena_doubles(arena, (size_t)s->n_channel);
    r->zero = bough_arena_doubles(arena, (size_t)s->n_channel);
    status = bough_study_columns(arena, &r->run.channels, s->n_channel, s->channel, &r->column);
    bough_recorder_def def = {
        .folder = r->drive->folder, .title = cell->settings, .channels = &r->run.channels};
    if (!def.folder || !bough_is_ok(&status)) return status;
    return bough_recorder_open(arena, &def, &r->recorder);
}

static bough_status run_in(bough_arena *arena, void *self) {
    cell_run *r = self;
    bough_study_drive *drive = r->drive;
    bough_study_result *result = r->result;
    bough_status status = build(arena, r->cell, r);
    if (!bough_is_ok(&status)) return status;
    bough_run *run = &r->run;
    const bough_master *m = run->simulation->master;
    r->series->filled = 0;
    bough_run_record_at(run, (bough_run_record){r->study->interval, .sample = sample, .self = r});
    run->beside = r->study->kind == BOUGH_STUDY_STABILITY; // these have one thread each
    run->stop = drive->stop;
    run->progress = &drive->progress;
    bough_run_all(run);
    gather_estimates(r, result->estimate);
    result->cpu = run->cpu_s;
    result->wall = run->wall_s;
    result->time = m->time;
    result->warned = m->verdict[0] != '\0';
    result->coupling = bough_monitor_report(m->monitor, m->coupling);
    assert(!bough_is_ok(&run->outcome) || r->series->filled == r->series->n_row);
    if (r->recorder) status = bough_recorder_finish(r->recorder, &run->outcome);
    return bough_is_ok(&run->outcome) ? status : run->outcome;
}

// -- repeats --------------------------------------------------------------------------------------

static int compare_numbers(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bough_spread bough_spread_of(const double *values, int n) {
    double sorted[BOUGH_STUDY_REPEATS];
    memcpy(sorted, values, (size_t)n * sizeof *values);
    qsort(sorted, (size_t)n, sizeof *sorted, compare_numbers);
    return (bough_spread){0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted[n / 4], sorted[n - 1 - n / 4]};
}

bool bough_study_ends(bough_code code) {
    return code == BOUGH_INTERRUPTED || code == BOUGH_OUT_OF_MEMORY || code == BOUGH_IO;
}

bough_status bough_study_run(const bough_study *study, const bough_study_cell *cell, int repeat,
                             bough_study_drive *drive, bough_study_series *series,
                             bough_study_result *result) {
    double wall[BOUGH_STUDY_REPEATS] = {0}, cpu[BOUGH_STUDY_REPEATS] = {0};
    int n = 0;
    assert(repeat >= 1 && repeat <= BOUGH_STUDY_REPEATS);
    *result = (bough_study_result){.outcome = bough_ok()};
    while (n < repeat && bough_is_ok(&result->outcome)) {
        cell_run r = {study, cell, drive, result, .series = series};
        result->outcome = bough_arena_use(run_in, &r);
        wall[n] = result->wall;
        cpu[n] = result->cpu;
        n++;
    }
    if (bough_study_ends(result->outcome.code)) return result->outcome;
    // The times of a failed repeat are its own: they belong to the time it reached.
    bool good = bough_is_ok(&result->outcome);
    result->wall = good ? bough_spread_of(wall, n).median : wall[n - 1];
    result->cpu = good ? bough_spread_of(cpu, n).median : cpu[n - 1];
    for (int i = 0; i < study->n_measure; i++) result->error[i] = (double)NAN;
    result->done = true;
    return bough_ok();
}

// -- differences ----------------------------------------------------------------------------------

// Of n components from `first`, over all rows.
static double largest_difference(const bough_study_series *a, const bough_study_series *b, int first, int n,
                                 int norm) {
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

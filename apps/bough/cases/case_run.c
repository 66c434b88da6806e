#include "apps/bough/cases/case_run.h"

#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/run.h"
#include "apps/bough/model/validity.h"
#include "apps/bough/scene/scene_files.h"

typedef struct case_run {
    const bough_study *study;
    const bough_case *chosen;
    bough_study_drive *drive;
    bough_study_series *series; // NULL: counts
    bough_case_result *result;
    const bough_wind_box *box; // lent; NULL: none
    bough_run run;
    int *column;              // (n_channel) of the study's channels among the run's
    bough_recorder *recorder; // of all channels; NULL: none
    double *value;            // (n_channel) of the study's channels
    bough_counts pair[2];     // of the run and of its companion at their common times
} case_run;

bough_case_result bough_case_take(bough_arena *arena, const bough_study *study) {
    bough_case_result result = {.outcome = bough_ok()};
    bough_counts_take(arena, study->n_channel, study->n_slope, study->slope, &result.counts);
    result.load_error = bough_arena_take(arena, (size_t)study->n_channel * sizeof *result.load_error);
    return result;
}

// -- sampling -------------------------------------------------------------------------------------

static void choose(const case_run *r, const double *value, double *chosen) {
    for (int i = 0; i < r->study->n_channel; i++) chosen[i] = value[r->column[i]];
}

static void count(case_run *r, bough_counts *counts, double t, const double *value) {
    choose(r, value, r->value);
    bough_counts_add(counts, t, r->value);
}

static void count_all(case_run *r, double t, const double *value) {
    const bough_companion *c = r->run.companion;
    count(r, &r->result->counts, t, value);
    if (!r->study->is.weighted || !bough_companion_compares(c)) return;
    count(r, &r->pair[0], t, c->value);
    count(r, &r->pair[1], t, c->coarser.value);
}

static bough_status sample(void *self, double t) {
    case_run *r = self;
    bough_study_series *s = r->series;
    BOUGH_TRY(r->recorder ? bough_recorder_sample(r->recorder, t) : bough_ok());
    const double *value = r->recorder ? bough_recorder_values(r->recorder) : bough_run_values(&r->run);
    if (s) {
        assert(s->filled < s->n_row);
        choose(r, value, s->value + (size_t)s->filled++ * (size_t)s->n_channel);
    } else if (t >= r->study->from - 1e-6 * r->run.simulation->master->macro_step) {
        count_all(r, t, value);
    }
    return bough_ok();
}

// Estimate of each measure: norm of the largest errors of its channels, although at different times.
static void gather_estimates(case_run *r) {
    const bough_companion *c = r->run.companion;
    for (int i = 0; i < r->study->n_channel; i++) {
        bool known = bough_companion_knows(c, r->column[i]);
        r->value[i] = known ? c->error[r->column[i]] : (double)NAN;
    }
    bough_study_norms(r->study, r->value, r->result->estimate);
}

// -- errors of loads ------------------------------------------------------------------------------

static bough_load_error error_of(const bough_channel_counts *run, const bough_channel_counts *other,
                                 double share) {
    bough_load_error e = {.least = share * fabs(run->statistics.least - other->statistics.least),
                          .most = share * fabs(run->statistics.most - other->statistics.most)};
    for (int k = 0; k < run->rainflow.n_slope; k++) {
        double slope = run->rainflow.slope[k];
        double load = bough_equivalent_load(run->rainflow.damage[k], slope, 1);
        double others = bough_equivalent_load(other->rainflow.damage[k], slope, 1);
        e.damage[k] = run->rainflow.damage[k];
        e.larger[k] = pow(load + share * fabs(others - load), slope);
    }
    return e;
}

static void find_load_errors(case_run *r) {
    const bough_companion *c = r->run.companion;
    bough_case_result *result = r->result;
    result->has_companion = c->coarser.simulation && !c->reason[0] && r->pair[0].channel[0].statistics.n > 0;
    for (int k = 0; k < 2; k++) bough_counts_finish(&r->pair[k]);
    for (int i = 0; i < r->study->n_channel && result->has_companion; i++)
        result->load_error[i] = error_of(&r->pair[0].channel[i], &r->pair[1].channel[i], c->ratio);
}

// -- building -------------------------------------------------------------------------------------

// The places of the study's channels among the run's.
static bough_status find_columns(bough_arena *arena, case_run *r) {
    const bough_study *s = r->study;
    r->column = bough_arena_take(arena, (size_t)s->n_channel * sizeof *r->column);
    for (int i = 0; i < s->n_channel; i++) {
        r->column[i] = bough_channels_find(&r->run.channels, s->channel[i]);
        if (r->column[i] < 0)
            return bough_fail(BOUGH_INVALID, "this run has no channel '%.80s'", s->channel[i]);
    }
    return bough_ok();
}

static bough_status changed(const char *scene, const char *why) {
    return bough_fail(
        BOUGH_IO,
        "the scene '%.150s' or one of its files has changed or disappeared since the study began%s%.100s; runs so far are kept",
        scene, why[0] ? ": " : "", why);
}

// Every scene was valid when the study began: an error now, BOUGH_IO, ends the study.
static bough_status read_scene(bough_arena *arena, const case_run *r, bough_scene **scene) {
    const bough_case *c = r->chosen;
    bough_errors errors = {.arena = arena};
    bough_status status =
        bough_scene_read(arena, r->study->files, c->scene, c->set, c->n_set, &errors, scene);
    if (c->files == 0 || status.code != BOUGH_INVALID) return status;
    return changed(c->scene, errors.n > 0 ? errors.item[0].text : "");
}

// BOUGH_IO if files of the scene have changed since the study began: its run must not be compared with
// earlier ones, and a failure to build it is no result.
static bough_status same_files(bough_arena *arena, const bough_scene *scene, uint64_t files) {
    uint64_t now = BOUGH_FINGERPRINT_START;
    if (files == 0) return bough_ok();
    bough_mix_scene(&now, &(bough_file_sums){.arena = arena}, scene);
    return now == files ? bough_ok() : changed(scene->file, "");
}

static bough_status open_recorder(bough_arena *arena, case_run *r) {
    bough_recorder_def def = {
        .folder = r->drive->folder, .title = r->chosen->settings, .channels = &r->run.channels};
    return def.folder ? bough_recorder_open(arena, &def, &r->recorder) : bough_ok();
}

static bough_status build(bough_arena *arena, case_run *r) {
    const bough_study *s = r->study;
    bough_scene *scene;
    BOUGH_TRY(read_scene(arena, r, &scene));
    int threads = s->is.parallel ? 1 : s->threads;
    if (threads > 0) scene->simulation.threads = threads;
    if (bough_is_reference(s, r->chosen)) scene->simulation.error_estimate = BOUGH_SCENE_NO_ESTIMATE;
    if (!r->series) scene->simulation.output.from = s->from;
    if (r->drive->boxes) scene->aero.wind.def.box = r->box = bough_boxes_lend(r->drive->boxes, scene);
    bough_status built = bough_run_create(arena, scene, &r->run);
    BOUGH_TRY(same_files(arena, scene, r->chosen->files));
    BOUGH_TRY(built);
    BOUGH_TRY(find_columns(arena, r));
    r->value = bough_arena_doubles(arena, (size_t)s->n_channel);
    for (int k = 0; k < 2 && s->is.weighted; k++)
        bough_counts_take(arena, s->n_channel, s->n_slope, s->slope, &r->pair[k]);
    return open_recorder(arena, r);
}

// Ends the series. A binary file replaces the text, which is ten times as large.
static bough_status finish_series(case_run *r) {
    const bough_scene_output *output = &r->run.simulation->scene->simulation.output;
    const bough_binary_def def = {.folder = r->drive->folder,
                                  .title = r->chosen->settings,
                                  .channels = &r->run.channels,
                                  .interval = output->interval};
    BOUGH_TRY(bough_recorder_finish(r->recorder, &r->run.outcome));
    if (!r->study->series || !output->binary || !bough_is_ok(&r->run.outcome)) return bough_ok();
    BOUGH_TRY(bough_binary_write(&def));
    return bough_folder_remove(def.folder, "channels.out");
}

// -- one run --------------------------------------------------------------------------------------

static bough_status judge(bough_arena *arena, const case_run *r) {
    double bound = r->run.simulation->scene->simulation.error_bound;
    bough_error_shares shares = {0};
    char warning[BOUGH_ERROR_WARNING], *text = r->result->warnings;
    BOUGH_TRY(bough_error_judge(arena, r->run.companion, r->drive->stop, bound, &shares, warning));
    size_t n = strlen(text);
    if (warning[0]) snprintf(text + n, BOUGH_CASE_WARNINGS - n, "%s%s", n > 0 ? "; " : "", warning);
    return bough_ok();
}

static bough_status run_in(bough_arena *arena, void *self) {
    case_run *r = self;
    bough_case_result *result = r->result;
    BOUGH_TRY(build(arena, r));
    bough_run *run = &r->run;
    const bough_master *m = run->simulation->master;
    double interval = r->series ? r->study->interval : run->simulation->scene->simulation.output.interval;
    if (r->series) r->series->filled = 0;
    bough_run_record_at(run, (bough_run_record){interval, .sample = sample, .self = r});
    run->beside = r->study->is.parallel; // each on one thread
    run->stop = r->drive->stop;
    run->steps_together = !run->side_by_side; // each step is counted beside that of the companion
    run->progress = &r->drive->progress;
    bough_run_all(run);
    assert(!r->series || !bough_is_ok(&run->outcome) || r->series->filled == r->series->n_row);
    if (r->series) gather_estimates(r);
    if (!r->series) bough_validity_list(run->simulation, result->warnings, BOUGH_CASE_WARNINGS);
    if (!r->series && bough_is_ok(&run->outcome)) run->outcome = judge(arena, r);
    if (!r->series) bough_counts_finish(&result->counts);
    if (r->study->is.weighted) find_load_errors(r);
    result->cpu = run->cpu_s;
    result->wall = run->wall_s;
    result->time = m->time;
    result->counted = m->time - r->study->from;
    result->warned = m->verdict[0] != '\0';
    result->coupling = bough_monitor_report(m->monitor, m->coupling);
    bough_status status = r->recorder ? finish_series(r) : bough_ok();
    return bough_is_ok(&run->outcome) ? status : run->outcome;
}

// With the time of building.
static void run_timed(case_run *r) {
    double wall = bough_wall_clock(), cpu = bough_cpu_clock(true);
    r->result->outcome = bough_arena_use(run_in, r);
    if (r->drive->boxes) bough_boxes_give_back(r->drive->boxes, r->box);
    r->result->cpu = bough_cpu_clock(true) - cpu;
    r->result->wall = bough_wall_clock() - wall;
}

// -- repeats --------------------------------------------------------------------------------------

bough_spread bough_spread_of(const double *values, int n) {
    double sorted[BOUGH_STUDY_REPEATS];
    memcpy(sorted, values, (size_t)n * sizeof *values);
    qsort(sorted, (size_t)n, sizeof *sorted, bough_ascending);
    return (bough_spread){0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted[n / 4], sorted[n - 1 - n / 4]};
}

bool bough_ends_study(bough_code code) {
    return code == BOUGH_INTERRUPTED || code == BOUGH_OUT_OF_MEMORY || code == BOUGH_IO;
}

static void run_repeatedly(case_run *r, int repeat) {
    bough_case_result *result = r->result;
    double wall[BOUGH_STUDY_REPEATS] = {0}, cpu[BOUGH_STUDY_REPEATS] = {0};
    int n = 0;
    assert(repeat >= 1 && repeat <= BOUGH_STUDY_REPEATS);
    while (n < repeat && bough_is_ok(&result->outcome)) {
        r->recorder = NULL;
        result->outcome = bough_arena_use(run_in, r);
        wall[n] = result->wall;
        cpu[n] = result->cpu;
        n++;
    }
    // a failed repeat keeps its own times, which belong to the time that it reached
    if (!bough_is_ok(&result->outcome)) return;
    result->wall = bough_spread_of(wall, n).median;
    result->cpu = bough_spread_of(cpu, n).median;
}

bough_status bough_case_run(const bough_study *study, const bough_case *c, int repeat,
                            bough_study_drive *drive, bough_study_series *series, bough_case_result *result) {
    case_run r = {.study = study, .chosen = c, .drive = drive, .series = series, .result = result};
    *result = (bough_case_result){
        .outcome = bough_ok(), .counts = result->counts, .load_error = result->load_error};
    for (int i = 0; i < study->n_measure; i++) result->error[i] = (double)NAN;
    if (series)
        run_repeatedly(&r, repeat);
    else
        run_timed(&r);
    if (bough_ends_study(result->outcome.code)) return result->outcome;
    result->done = true;
    return bough_ok();
}

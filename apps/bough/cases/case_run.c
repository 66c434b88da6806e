#include "apps/bough/cases/case_run.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/recorder.h"
#include "apps/bough/model/error_shares.h"
#include "apps/bough/model/run.h"
#include "apps/bough/cases/study_run.h"

#include <math.h>
#include <time.h>

typedef struct case_run {
    const bough_load_set *set;
    const bough_load_case *chosen_case;
    const char *folder;
    bool (*stop)(void);
    bough_case_result *result;
    bough_run run;
    bough_recorder *recorder; // NULL: no series
    int *column;              // (n_channel) of the set's channels among the run's
    double *chosen;           // (n_channel)
    bough_counts *counts;
} case_run;

static double cpu_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bough_case_result bough_case_take(bough_arena *arena, const bough_load_set *set) {
    bough_case_result result = {.outcome = bough_ok()};
    bough_counts_take(arena, set->n_channel, set->n_slope, set->slope, &result.counts);
    return result;
}

// -- recording ------------------------------------------------------------------------------------

static bough_status sample(void *self, double t) {
    case_run *r = self;
    if (r->recorder) {
        bough_status status = bough_recorder_sample(r->recorder, t);
        if (!bough_is_ok(&status)) return status;
    }
    if (t < r->set->from - 1e-6 * r->run.simulation->master->macro_step) return bough_ok();
    const double *value = bough_run_values(&r->run);
    for (int i = 0; i < r->set->n_channel; i++) r->chosen[i] = value[r->column[i]];
    bough_counts_add(r->counts, t, r->chosen);
    return bough_ok();
}

static bough_status open_series(bough_arena *arena, const bough_load_case *c, const char *folder,
                                case_run *r) {
    if (!r->set->series) return bough_ok();
    bough_status status = bough_folder_make(folder);
    bough_recorder_def def = {.folder = folder, .title = c->settings, .channels = &r->run.channels};
    return bough_is_ok(&status) ? bough_recorder_open(arena, &def, &r->recorder) : status;
}

// -- the run --------------------------------------------------------------------------------------

// What cannot be built is a case that fails.
static bough_status build(bough_arena *arena, const bough_load_case *c, const char *folder, case_run *r) {
    bough_scene *scene;
    bough_study_source source = {c->scene, c->n_set, c->set, c->files};
    bough_status status = bough_study_read_scene(arena, &source, &scene);
    if (!bough_is_ok(&status)) return status;
    scene->simulation.threads = 1;
    bough_status built = bough_run_create(arena, scene, &r->run);
    status = bough_study_same_files(arena, scene, c->files);
    if (!bough_is_ok(&status)) return status;
    status = built;
    const bough_load_set *s = r->set;
    r->chosen = bough_arena_doubles(arena, (size_t)s->n_channel);
    if (bough_is_ok(&status))
        status = bough_study_columns(arena, &r->run.channels, s->n_channel, s->channel, &r->column);
    if (status.code == BOUGH_INVALID) status.code = BOUGH_FAILED;
    return bough_is_ok(&status) ? open_series(arena, c, folder, r) : status;
}

static bough_status judge(bough_arena *arena, const case_run *r) {
    const bough_companion *c = r->run.companion;
    double bound = r->run.simulation->scene->simulation.error_bound;
    bough_error_shares shares = {0};
    char warning[BOUGH_ERROR_WARNING];
    bough_status status = bough_ok();
    if (bough_error_exceeds(c, bound)) status = bough_error_shares_find(arena, c, HUGE_VAL, r->stop, &shares);
    return bough_is_ok(&status) ? bough_error_judge(c, &shares, bound, warning) : status;
}

static bough_status run_in(bough_arena *arena, void *self) {
    case_run *r = self;
    bough_case_result *result = r->result;
    bough_status status = build(arena, r->chosen_case, r->folder, r);
    if (!bough_is_ok(&status)) return status;
    double interval = r->run.simulation->scene->simulation.output.interval;
    bough_run_record_at(&r->run, (bough_run_record){interval, .sample = sample, .self = r});
    r->run.beside = true;
    r->run.stop = r->stop;
    bough_run_all(&r->run);
    if (bough_is_ok(&r->run.outcome)) r->run.outcome = judge(arena, r);
    bough_counts_finish(r->counts);
    result->time = r->run.simulation->master->time;
    result->counted = result->time - r->set->from;
    if (!r->recorder) return r->run.outcome;
    bough_status end = bough_recorder_finish(r->recorder, &r->run.outcome);
    return bough_is_ok(&r->run.outcome) ? end : r->run.outcome;
}

bough_status bough_case_run(const bough_load_set *set, const bough_load_case *c, const char *folder,
                            bool (*stop)(void), bough_case_result *result) {
    double wall = bough_wall_clock(), cpu = cpu_clock();
    case_run r = {.set = set,
                  .chosen_case = c,
                  .folder = folder,
                  .stop = stop,
                  .result = result,
                  .counts = &result->counts};
    result->outcome = bough_arena_use(run_in, &r);
    result->cpu = cpu_clock() - cpu;
    result->wall = bough_wall_clock() - wall;
    if (bough_study_ends(result->outcome.code)) return result->outcome;
    result->done = true;
    return bough_ok();
}

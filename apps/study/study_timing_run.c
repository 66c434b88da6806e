// One timed run of a cell: what `bough run` does between reading and summary.
#include "apps/study/study_timing.h"

#include "apps/output/progress.h"
#include "apps/output/recorder.h"
#include "apps/simulation/error_probe.h"

#include <time.h>

typedef struct timed {
    const bough_study *study;
    const bough_study_options *options;
    bough_simulation *simulation;
    bough_channels channels;
    bough_error_probe probe;
    bough_recorder *recorder;
    bough_clock *clock; // NULL unless asked for
    long next_row;
    double recording; // [s]
    bough_status outcome;
} timed;

static double cpu_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bough_status build(bough_arena *arena, const bough_study_cell *cell, timed *t) {
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_status status =
        bough_scene_read(arena, t->study->scene, cell->set, cell->n_set, &errors, &scene);
    if (bough_is_ok(&status)) status = bough_simulation_build(arena, scene, &t->simulation);
    if (!bough_is_ok(&status)) return status;
    t->channels = bough_channels_start(arena);
    status = bough_simulation_channels(t->simulation, &t->channels);
    if (!bough_is_ok(&status)) return status;
    return bough_error_probe_create(arena, t->simulation, &t->channels, &t->probe);
}

static bough_status record_when_due(timed *t) {
    const bough_master *m = t->simulation->master;
    double due = (double)t->next_row * t->study->interval;
    if (m->time < due - 1e-6 * m->macro_step) return bough_ok();
    double began = t->clock ? bough_wall_clock() : 0;
    bough_simulation_update(t->simulation);
    bough_status status = bough_recorder_sample(t->recorder, m->time);
    t->next_row++;
    if (t->clock) t->recording += bough_wall_clock() - began;
    return status;
}

static bough_status step(timed *t) {
    if (t->options->stop && t->options->stop()) return bough_fail(BOUGH_INTERRUPTED, "interrupted");
    bough_status status = bough_step(t->simulation->master);
    bough_error_probe_update(&t->probe);
    return bough_is_ok(&status) ? record_when_due(t) : status;
}

static void step_all(void *self) {
    timed *t = self;
    t->outcome = record_when_due(t);
    while (bough_is_ok(&t->outcome) && !bough_master_done(t->simulation->master)) {
        t->outcome = step(t);
    }
}

static bough_status run_in(bough_arena *arena, const bough_study_cell *cell, timed *t, bool parts,
                           bough_timing_run *run) {
    double began = bough_wall_clock();
    bough_status status = build(arena, cell, t);
    run->build = bough_wall_clock() - began;
    if (bough_is_ok(&status) && parts) status = bough_clock_create(arena, t->simulation, &t->clock);
    bough_recorder_def def = {
        .folder = t->options->folder, .title = t->study->title, .channels = &t->channels};
    if (bough_is_ok(&status)) status = bough_recorder_open(arena, &def, &t->recorder);
    if (!bough_is_ok(&status)) return status;
    double wall = bough_wall_clock(), cpu = cpu_clock();
    bough_pool_region(t->simulation->pool, step_all, t);
    run->cpu = cpu_clock() - cpu;
    run->wall = bough_wall_clock() - wall;
    if (t->clock) bough_clock_read(t->clock, run->part);
    run->part[BOUGH_CLOCK_RECORDING] = t->recording;
    status = bough_recorder_finish(t->recorder, &t->outcome);
    return bough_is_ok(&t->outcome) ? status : t->outcome;
}

bough_status bough_timing_run_cell(const bough_study *study, const bough_study_cell *cell,
                                   const bough_study_options *options, bool parts,
                                   bough_timing_run *run) {
    timed t = {.study = study, .options = options};
    *run = (bough_timing_run){0};
    bough_arena *arena = bough_arena_create();
    if (!arena) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_status status = run_in(arena, cell, &t, parts, run);
    bough_arena_destroy(arena);
    return status;
}

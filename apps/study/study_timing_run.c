// One timed run of a cell: what `bough run` does between reading and summary.
#include "apps/study/study_timing.h"

#include "apps/output/progress.h"
#include "apps/output/recorder.h"
#include "apps/study/study_run.h"
#include "apps/simulation/run.h"

typedef struct timed {
    const bough_study *study;
    const bough_study_cell *cell;
    const bough_study_options *options;
    bough_timing_run *result;
    bough_run run;
    bough_recorder *recorder;
} timed;

static bough_status record(void *self, double time) {
    return bough_recorder_sample(((timed *)self)->recorder, time);
}

static bough_status build(bough_arena *arena, timed *t) {
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_status status =
        bough_scene_read(arena, t->study->scene, t->cell->set, t->cell->n_set, &errors, &scene);
    if (bough_is_ok(&status)) bough_study_estimate_cheaply(scene);
    if (bough_is_ok(&status)) status = bough_run_create(arena, scene, &t->run);
    if (!bough_is_ok(&status)) return status;
    bough_run_record rows = {t->study->interval, true, .sample = record, .self = t};
    bough_run_record_at(&t->run, rows);
    t->run.stop = t->options->stop;
    return bough_ok();
}

static bough_status run_in(bough_arena *arena, void *self) {
    timed *t = self;
    bough_timing_run *run = t->result;
    double began = bough_wall_clock();
    bough_status status = build(arena, t);
    run->build = bough_wall_clock() - began;
    bough_recorder_def def = {
        .folder = t->options->folder, .title = t->study->title, .channels = &t->run.channels};
    if (bough_is_ok(&status)) status = bough_recorder_open(arena, &def, &t->recorder);
    if (!bough_is_ok(&status)) return status;
    bough_run_all(&t->run);
    run->cpu = t->run.cpu_s;
    run->wall = t->run.wall_s;
    status = bough_recorder_finish(t->recorder, &t->run.outcome);
    return bough_is_ok(&t->run.outcome) ? status : t->run.outcome;
}

bough_status bough_timing_run_cell(const bough_study *study, const bough_study_cell *cell,
                                   const bough_study_options *options, bough_timing_run *run) {
    timed t = {.study = study, .cell = cell, .options = options, .result = run};
    *run = (bough_timing_run){0};
    return bough_arena_use(run_in, &t);
}

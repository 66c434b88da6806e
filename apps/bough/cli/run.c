// bough run: steps a scene through its duration and records its channels.
#include "apps/bough/cli/run.h"

#include "apps/bough/cli/checkpoint.h"
#include "apps/bough/cli/forecast.h"
#include "apps/bough/cli/open.h"
#include "apps/bough/cli/stop.h"
#include "apps/bough/cli/verb.h"
#include "apps/bough/model/validity.h"
#include "apps/bough/results/binary.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/lock.h"

// -- recording ------------------------------------------------------------------------------------

static bough_status sample_row(void *self, double t) {
    bough_job *job = self;
    bough_status status = bough_recorder_sample(job->recorder, t);
    const bough_simulation *s = job->run.simulation;
    if (t < s->scene->simulation.output.from - 1e-6 * s->master->macro_step) return status;
    const double *value = bough_recorder_values(job->recorder);
    for (int i = 0; i < job->recorded.count; i++)
        bough_sample_statistics_add(&job->statistics[i], t, value[i]);
    return status;
}

static bough_status sample_frame(void *self, double t) {
    return bough_frames_sample(((bough_job *)self)->frames, t);
}

static void record(bough_job *job) {
    const bough_scene_output *output = &job->run.simulation->scene->simulation.output;
    bough_run_record rows = {output->interval, true, .sample = sample_row, .self = job};
    bough_run_record frames = {output->frames, .sample = sample_frame, .self = job};
    bough_run_record_at(&job->run, rows);
    if (output->frames > 0) bough_run_record_at(&job->run, frames);
}

// -- results --------------------------------------------------------------------------------------

static bough_status open_frames(bough_job *job) {
    const bough_scene_output *output = &job->run.simulation->scene->simulation.output;
    if (!(output->frames > 0)) return bough_ok();
    bough_status status = bough_shape_create(job->arena, job->run.simulation, &job->shape);
    if (!bough_is_ok(&status)) return status;
    bough_frames_def def = {.folder = job->folder,
                            .n_line = job->shape.n_line,
                            .line = job->shape.line,
                            .points = bough_shape_points,
                            .loads = bough_shape_loads,
                            .self = &job->shape,
                            .kept = job->frames_kept};
    return bough_frames_open(job->arena, &def, &job->frames);
}

static const char *title(const bough_job *job) {
    const bough_scene *scene = job->run.simulation->scene;
    return scene->title ? scene->title : scene->file;
}

// What a run that was killed has left half-written; to resume, its rows are needed.
static bough_status clean(const bough_job *job) {
    char frames[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(job->folder, "frames", frames);
    if (!bough_is_ok(&status)) return status;
    if (!job->options->resume) bough_folder_clean(job->folder);
    bough_folder_clean(frames);
    return status;
}

// What an earlier run has left stays until this one can replace it; of its checkpoint nothing does.
static bough_status open_results(bough_job *job) {
    job->folder = bough_out_folder(job->arena, job->options);
    bough_status status = bough_checkpoint_open(job);
    if (bough_is_ok(&status)) status = bough_folder_make(job->folder);
    if (bough_is_ok(&status)) status = bough_lock_folder(job->arena, job->folder);
    if (bough_is_ok(&status)) status = clean(job);
    if (bough_is_ok(&status)) {
        status = job->options->resume ? bough_folder_remove(job->folder, "summary.json")
                                      : bough_checkpoint_remove(job->folder);
    }
    if (!bough_is_ok(&status)) return status;
    bough_recorder_def def = {
        .folder = job->folder, .title = title(job), .channels = &job->recorded, .kept = job->rows};
    status = bough_recorder_open(job->arena, &def, &job->recorder);
    if (bough_is_ok(&status)) status = open_frames(job);
    return bough_is_ok(&status) ? bough_run_forecast(job, stdout) : status;
}

bough_status bough_job_build(bough_job *job) {
    double began = bough_wall_clock();
    bough_scene *scene;
    bough_status status = bough_open_scene(job->arena, job->options, &scene);
    if (bough_is_ok(&status)) status = bough_run_create(job->arena, scene, &job->run);
    if (!bough_is_ok(&status)) return status;
    status = bough_open_channels(scene, &job->run.channels, &job->recorded);
    if (!bough_is_ok(&status)) return status;
    record(job);
    size_t n = (size_t)job->recorded.count;
    job->statistics = bough_arena_take(job->arena, (n + 1) * sizeof *job->statistics);
    job->build_s = bough_wall_clock() - began;
    return status;
}

static bough_status write_binary(const bough_job *job) {
    const bough_scene_output *output = &job->run.simulation->scene->simulation.output;
    if (!output->binary || !bough_is_ok(&job->run.outcome)) return bough_ok();
    return bough_binary_write(&(bough_binary_def){.folder = job->folder,
                                                  .title = title(job),
                                                  .channels = &job->recorded,
                                                  .interval = output->interval});
}

// Ends the files; the first thing that went wrong is the outcome that they tell. An older summary
// must not stand beside the new channels, nor a new one beside older channels.
static bough_status close_results(bough_job *job) {
    bough_status status = bough_recorder_finish(job->recorder, &job->run.outcome);
    if (!bough_is_ok(&status)) {
        if (bough_is_ok(&job->run.outcome)) job->run.outcome = status;
        return job->run.outcome;
    }
    status = bough_folder_remove(job->folder, "summary.json");
    if (bough_is_ok(&status)) status = bough_folder_remove(job->folder, "channels.outb");
    if (bough_is_ok(&status)) status = bough_folder_remove(job->folder, "report.html");
    if (bough_is_ok(&status)) {
        status = job->frames ? bough_frames_finish(job->frames) : bough_frames_remove(job->folder);
    }
    if (bough_is_ok(&status)) status = write_binary(job);
    if (bough_is_ok(&job->run.outcome)) job->run.outcome = status;
    status = bough_run_summarise(job);
    if (bough_is_ok(&job->run.outcome) && bough_is_ok(&status)) {
        status = bough_checkpoint_remove(job->folder);
    }
    return bough_is_ok(&job->run.outcome) ? status : job->run.outcome;
}

// What makes a run slow is known while it runs.
static void warn_of_work(bough_job *job) {
    const bough_simulation *s = job->run.simulation;
    if (job->warned || !s->validity->limit[BOUGH_LIMIT_STEPS].passed) return;
    char text[512];
    job->warned = true;
    bough_validity_describe(s, BOUGH_LIMIT_STEPS, text, sizeof text);
    if (job->run.progress) bough_progress_clear(job->run.progress);
    fprintf(stderr, "bough: warning: %s\n", text);
}

// After each step. The error is judged at the end, but a run that has lost the solution does not go on.
static bough_status after_step(void *self) {
    bough_job *job = self;
    const bough_run *run = &job->run;
    warn_of_work(job);
    bool lost = run->simulation->scene->simulation.error_bound > 0 && bough_companion_parted(run->companion);
    return lost ? bough_error_parted(run->companion) : bough_checkpoint_update(job);
}

// The stretch on which the cause of an error between accuracy and bound is looked for: a short one, if the
// error shows in it.
static double stretch_of(const bough_companion *c) {
    double duration = c->run->master->duration;
    bough_error_verdict v = bough_error_verdict_of(c, true, c->error);
    return (v.time < 0.1 * duration ? 0.1 : 0.25) * duration;
}

// The cause of an error above the bound is looked for by further runs, as the shares are where the scene
// asks.
static bough_status judge(bough_job *job) {
    const bough_scene_simulation *x = &job->run.simulation->scene->simulation;
    const bough_companion *c = job->run.companion;
    bough_status status = bough_ok();
    bough_error_shares stretch = {0}, *shares = &job->shares;
    if (x->error_shares || bough_error_exceeds(c, x->error_bound)) {
        status = bough_error_shares_find(job->arena, c, HUGE_VAL, bough_stop_requested, shares);
    } else if (bough_error_exceeds(c, x->accuracy)) {
        shares = &stretch;
        status = bough_error_shares_find(job->arena, c, stretch_of(c), bough_stop_requested, shares);
    }
    return bough_is_ok(&status) ? bough_error_judge(c, shares, x->error_bound, job->warning) : status;
}

static void step_all(bough_job *job) {
    bough_run *run = &job->run;
    const bough_master *m = run->simulation->master;
    if (m->verdict[0]) fprintf(stderr, "bough: warning: %s\n", m->verdict);
    bough_progress progress = bough_progress_start(m->time, m->duration, job->options->quiet);
    run->progress = &progress;
    run->stop = bough_stop_requested;
    run->after = after_step;
    run->self = job;
    bough_run_all(run);
    bough_progress_clear(&progress);
    if (run->outcome.code != BOUGH_INTERRUPTED) return;
    run->outcome = bough_fail(BOUGH_INTERRUPTED, "%s; the results so far are in %.200s", run->outcome.message,
                              job->folder);
}

bough_status bough_verb_run(bough_arena *arena, const bough_options *options) {
    bough_job job = {.options = options, .arena = arena, .verdict = bough_ok()};
    bough_status status = bough_job_build(&job);
    if (!bough_is_ok(&status)) return status;
    bough_stop_listen();
    status = open_results(&job);
    if (!bough_is_ok(&status)) return status;
    step_all(&job);
    if (bough_is_ok(&job.run.outcome)) job.verdict = judge(&job);
    status = close_results(&job);
    bough_run_report(&job, stdout);
    return bough_is_ok(&status) ? job.verdict : status;
}

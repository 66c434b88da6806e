// bough run: steps a scene through its duration and records its channels.
#include "apps/bough/run.h"

#include "apps/bough/forecast.h"
#include "apps/bough/open.h"
#include "apps/bough/stop.h"
#include "apps/bough/verb.h"
#include "apps/output/binary.h"
#include "apps/output/folder.h"
#include "apps/output/lock.h"
#include "apps/output/progress.h"

#include <time.h>

static double cpu_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// -- recording ------------------------------------------------------------------------------------

// Times closer than this are one [s].
static double resolution(const bough_run *run) {
    return 1e-6 * run->simulation->master->macro_step;
}

static bough_status record(bough_run *run) {
    const bough_master *m = run->simulation->master;
    double interval = run->simulation->scene->simulation.output.interval;
    run->recorded = m->time;
    while ((double)run->next_row * interval <= m->time + resolution(run))
        run->next_row++;
    bough_simulation_update(run->simulation);
    return bough_recorder_sample(run->recorder, m->time);
}

static bool row_is_due(const bough_run *run) {
    double interval = run->simulation->scene->simulation.output.interval;
    double now = run->simulation->master->time;
    return now >= (double)run->next_row * interval - resolution(run);
}

// A frame is stored at the first synchronisation point at or after its time.
static bough_status record_frame(bough_run *run) {
    double interval = run->simulation->scene->simulation.output.frames;
    double now = run->simulation->master->time;
    if (!run->frames || now < (double)run->next_frame * interval - resolution(run)) {
        return bough_ok();
    }
    while ((double)run->next_frame * interval <= now + resolution(run))
        run->next_frame++;
    bough_simulation_update(run->simulation);
    return bough_frames_sample(run->frames, now);
}

static bough_status record_vertices(bough_run *run) {
    double interval = run->simulation->scene->simulation.output.vertices;
    double now = run->simulation->master->time;
    if (!run->vertices || now < (double)run->next_vertices * interval - resolution(run)) {
        return bough_ok();
    }
    while ((double)run->next_vertices * interval <= now + resolution(run))
        run->next_vertices++;
    bough_simulation_update(run->simulation);
    return bough_vertices_sample(run->vertices, now);
}

// -- stepping -------------------------------------------------------------------------------------

static bough_status step(bough_run *run) {
    bough_master *m = run->simulation->master;
    if (bough_stop_requested()) {
        return bough_fail(BOUGH_INTERRUPTED,
                          "interrupted at %.9g s of %.9g s; the results so far "
                          "are in %.200s",
                          m->time, m->duration, run->folder);
    }
    bough_status status = bough_step(m);
    bough_error_probe_update(&run->probe);
    if (bough_is_ok(&status) && row_is_due(run)) status = record(run);
    if (bough_is_ok(&status)) status = record_frame(run);
    if (bough_is_ok(&status)) status = record_vertices(run);
    return bough_is_ok(&status) ? bough_checkpoint_update(run) : status;
}

// After a numerical failure the state means nothing: only a run that could go on gets a last row.
static bough_status record_end(bough_run *run, bough_status status) {
    if (!bough_is_ok(&status) && status.code != BOUGH_INTERRUPTED) return status;
    if (run->recorded >= run->simulation->master->time) return status;
    bough_status end = record(run);
    return bough_is_ok(&end) ? status : end;
}

void bough_run_settle_clock(bough_run *run) {
    double wall = bough_wall_clock(), cpu = cpu_clock();
    run->wall_s += wall - run->wall_from;
    run->cpu_s += cpu - run->cpu_from;
    run->wall_from = wall;
    run->cpu_from = cpu;
}

static bough_status record_start(bough_run *run) {
    if (run->options->resume) return bough_ok();
    bough_status status = record(run);
    if (bough_is_ok(&status)) status = record_frame(run);
    return bough_is_ok(&status) ? record_vertices(run) : status;
}

// In one parallel region: sets the run's outcome.
static void step_all(void *self) {
    bough_run *run = self;
    const bough_master *m = run->simulation->master;
    if (m->verdict[0]) fprintf(stderr, "bough: warning: %s\n", m->verdict);
    bough_progress progress = bough_progress_start(m->time, m->duration, run->options->quiet);
    run->wall_from = bough_wall_clock();
    run->cpu_from = cpu_clock();
    bough_status status = record_start(run);
    while (bough_is_ok(&status) && !bough_master_done(m)) {
        status = step(run);
        bough_progress_show(&progress, m->time);
    }
    run->outcome = record_end(run, status);
    bough_run_settle_clock(run);
    bough_progress_clear(&progress);
}

// -- results --------------------------------------------------------------------------------------

static bough_status open_vertices(bough_run *run) {
    bough_polyline *body = bough_shape_bodies(run->arena, &run->shape);
    if (!body) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_vertices_def def = {.folder = run->folder,
                              .n_body = run->shape.n_line,
                              .body = body,
                              .motion = bough_shape_motion,
                              .self = &run->shape};
    return bough_vertices_open(run->arena, &def, &run->vertices);
}

static bough_status open_frames(bough_run *run) {
    const bough_scene_output *output = &run->simulation->scene->simulation.output;
    if (!(output->frames > 0 || output->vertices > 0)) return bough_ok();
    bough_status status = bough_shape_create(run->arena, run->simulation, &run->shape);
    if (bough_is_ok(&status) && output->vertices > 0) status = open_vertices(run);
    if (!bough_is_ok(&status) || !(output->frames > 0)) return status;
    bough_frames_def def = {.folder = run->folder,
                            .n_line = run->shape.n_line,
                            .line = run->shape.line,
                            .points = bough_shape_points,
                            .self = &run->shape,
                            .kept = run->frames_kept};
    return bough_frames_open(run->arena, &def, &run->frames);
}

static const char *title(const bough_run *run) {
    const bough_scene *scene = run->simulation->scene;
    return scene->title ? scene->title : scene->file;
}

// What a run that was killed has left half-written; to resume, its rows are needed.
static bough_status clean(const bough_run *run) {
    char frames[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(run->folder, "frames", frames);
    if (!bough_is_ok(&status)) return status;
    if (!run->options->resume) bough_folder_clean(run->folder);
    bough_folder_clean(frames);
    return status;
}

// What an earlier run has left stays until this one can replace it; of its checkpoint nothing does.
static bough_status open_results(bough_run *run) {
    run->folder = bough_out_folder(run->arena, run->options);
    if (!run->folder) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_status status = bough_checkpoint_open(run);
    if (bough_is_ok(&status)) status = bough_folder_make(run->folder);
    if (bough_is_ok(&status)) status = bough_lock_folder(run->arena, run->folder);
    if (bough_is_ok(&status)) status = clean(run);
    if (bough_is_ok(&status)) {
        status = run->options->resume ? bough_folder_remove(run->folder, "summary.json")
                                      : bough_checkpoint_remove(run->folder);
    }
    if (!bough_is_ok(&status)) return status;
    bough_recorder_def def = {.folder = run->folder,
                              .title = title(run),
                              .channels = &run->channels,
                              .kept = run->rows};
    status = bough_recorder_open(run->arena, &def, &run->recorder);
    if (bough_is_ok(&status)) status = open_frames(run);
    return bough_is_ok(&status) ? bough_run_forecast(run) : status;
}

static bough_status build(bough_run *run) {
    double began = bough_wall_clock();
    bough_status status = bough_open(run->arena, run->options, &run->simulation);
    if (!bough_is_ok(&status)) return status;
    size_t n = (size_t)run->simulation->master->assembly->n_member;
    run->earlier = bough_arena_take(run->arena, n * sizeof *run->earlier);
    if (!run->earlier) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    run->channels = bough_channels_start(run->arena);
    status = bough_simulation_channels(run->simulation, &run->channels);
    if (bough_is_ok(&status)) {
        status = bough_error_probe_create(run->arena, run->simulation, &run->channels, &run->probe);
    }
    run->build_s = bough_wall_clock() - began;
    return status;
}

static bough_status write_binary(const bough_run *run) {
    const bough_scene_output *output = &run->simulation->scene->simulation.output;
    if (!output->binary || !bough_is_ok(&run->outcome)) return bough_ok();
    return bough_binary_write(&(bough_binary_def){.folder = run->folder,
                                                  .title = title(run),
                                                  .channels = &run->channels,
                                                  .interval = output->interval});
}

// Ends the files; the first thing that went wrong is the outcome that they tell. An older summary
// must not stand beside the new channels, nor a new one beside older channels.
static bough_status close_results(bough_run *run) {
    bough_status status = bough_recorder_finish(run->recorder, &run->outcome);
    if (!bough_is_ok(&status)) {
        if (bough_is_ok(&run->outcome)) run->outcome = status;
        return run->outcome;
    }
    status = bough_folder_remove(run->folder, "summary.json");
    if (bough_is_ok(&status)) status = bough_folder_remove(run->folder, "vertices.h5");
    bool whole = bough_is_ok(&status) && bough_is_ok(&run->outcome);
    if (whole && run->vertices) status = bough_vertices_finish(run->vertices);
    if (bough_is_ok(&status)) status = bough_folder_remove(run->folder, "channels.outb");
    if (bough_is_ok(&status) && run->frames) status = bough_frames_finish(run->frames);
    if (bough_is_ok(&status)) status = write_binary(run);
    if (bough_is_ok(&run->outcome)) run->outcome = status;
    status = bough_run_summarise(run);
    if (bough_is_ok(&run->outcome) && bough_is_ok(&status)) {
        status = bough_checkpoint_remove(run->folder);
    }
    return bough_is_ok(&run->outcome) ? status : run->outcome;
}

bough_status bough_verb_run(bough_arena *arena, const bough_options *options) {
    bough_run run = {.options = options, .arena = arena};
    bough_status status = build(&run);
    if (!bough_is_ok(&status)) return status;
    bough_stop_listen();
    status = open_results(&run);
    if (!bough_is_ok(&status)) return status;
    bough_pool_region(run.simulation->pool, step_all, &run);
    status = close_results(&run);
    bough_run_tell(&run, stdout);
    return status;
}

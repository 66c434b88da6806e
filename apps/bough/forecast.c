#include "apps/bough/forecast.h"

#include "apps/output/progress.h"

#include <math.h>
#include <sys/statvfs.h>

static const double long_run = 1e6;   // macro steps
static const double much_data = 1e9;  // [bytes]
static const double frame_head = 500; // bytes of a frame's file beside its points
static const double frame_point = 40; // bytes of one of its points
enum { COLUMN = 18, VERTEX = 96 };    // bytes of a value in channels.out, of a vertex in vertices.h5

static double samples(const bough_run *run, double interval) {
    return interval > 0 ? run->simulation->master->duration / interval : 0;
}

static double result_bytes(const bough_job *job) {
    const bough_run *run = &job->run;
    const bough_scene_output *output = &run->simulation->scene->simulation.output;
    double points = 0, row = COLUMN * (run->channels.count + 1.0) + (output->binary ? 2 : 0);
    for (int k = 0; k < job->shape.n_line; k++) points += job->shape.line[k].n_point;
    return row * samples(run, output->interval) +
           (frame_head + frame_point * points) * samples(run, output->frames) +
           VERTEX * points * samples(run, output->vertices);
}

// Each macro step evaluates every member at least twice; the shortest of some evaluations [s].
static double least_step_time(const bough_run *run) {
    const bough_coupling *c = run->simulation->master->coupling;
    const bough_assembly *a = c->assembly;
    double shortest = HUGE_VAL;
    for (int k = 0; k < 5; k++) {
        double began = bough_wall_clock();
        for (int i = 0; i < a->n_member; i++) {
            const bough_subsystem *s = a->member[i];
            s->ops->derivative(s->self, *s->time, s->state, c->input + a->input_offset[i],
                               c->state_rate + a->state_offset[i]);
        }
        shortest = fmin(shortest, bough_wall_clock() - began);
    }
    return 2 * shortest;
}

bough_status bough_run_forecast(const bough_job *job) {
    const bough_run *run = &job->run;
    const bough_master *m = run->simulation->master;
    double steps = m->duration / m->macro_step, bytes = result_bytes(job);
    struct statvfs disk;
    double room = statvfs(job->folder, &disk) == 0
                      ? (double)disk.f_bavail * (double)disk.f_frsize
                      : HUGE_VAL;
    if (bytes > much_data && bytes > room) {
        return bough_fail(BOUGH_INVALID,
                          "the results take about %.3g GB, '%.200s' has room for %.3g GB: a longer "
                          "simulation.output.interval or shorter duration",
                          1e-9 * bytes, job->folder, 1e-9 * room);
    }
    if (steps <= long_run && bytes <= much_data) return bough_ok();
    fprintf(stderr, "bough: %.3g macro steps, more than %.2g hours; results of about %.2g GB\n",
            steps, steps * least_step_time(run) / 3600, 1e-9 * bytes);
    return bough_ok();
}

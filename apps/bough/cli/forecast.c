#include "apps/bough/cli/run.h"

#include "apps/bough/results/progress.h"

#include <math.h>
#include <sys/statvfs.h>

static const double long_run = 1e6;    // macro steps
static const double much_data = 1e9;   // [bytes]
static const double frame_head = 900;  // bytes of a frame's file beside its points
static const double frame_point = 110; // bytes of one of its points
enum { COLUMN = 18 };                  // bytes of a value in channels.out

// How often something is recorded: at the start and after every interval.
static double samples(double duration, double interval) {
    return interval > 0 ? 1 + floor(duration / interval + 1e-9) : 0;
}

bough_forecast bough_run_results(const bough_simulation *simulation, const bough_channels *channels,
                                 const bough_shape *shape) {
    const bough_scene_output *output = &simulation->scene->simulation.output;
    double duration = simulation->master->duration, n_point = 0;
    for (int k = 0; k < shape->n_line; k++) n_point += shape->line[k].n_point;
    double row = COLUMN * (channels->count + 1.0) + 1 + (output->binary ? 2 * channels->count : 0);
    double rows = 1 + ceil(duration / output->interval - 1e-9); // the end is recorded too
    return (bough_forecast){rows, row * rows + (frame_head + frame_point * n_point) *
                                                   samples(duration, output->frames)};
}

void bough_forecast_print(bough_forecast f, const bough_channels *channels, FILE *stream) {
    fprintf(stream, "results: %.10g rows of %d columns, %.3g MB\n", f.rows, channels->count + 1,
            1e-6 * f.bytes);
}

double bough_forecast_derivative(const bough_coupling *c, int member, int tries, double *rate) {
    const bough_assembly *a = c->assembly;
    const bough_member *m = a->member[member];
    const bough_system *s = &m->system;
    double shortest = HUGE_VAL;
    for (int k = 0; k < tries; k++) {
        double began = bough_wall_clock();
        s->ops->derivative(s->self, m->time, m->state, c->input + a->input_offset[member], rate);
        shortest = fmin(shortest, bough_wall_clock() - began);
    }
    return shortest;
}

// Each macro step evaluates every member at least twice [s].
static double least_step_time(const bough_run_command *command) {
    const bough_coupling *c = command->run.simulation->master->coupling;
    double sum = 0, *rate = bough_arena_doubles(command->arena, (size_t)c->assembly->n_state + 1);
    for (int i = 0; i < c->assembly->n_member; i++) sum += bough_forecast_derivative(c, i, 5, rate);
    return 2 * sum;
}

bough_status bough_run_forecast(const bough_run_command *command, FILE *stream) {
    const bough_run *run = &command->run;
    const bough_master *m = run->simulation->master;
    bough_forecast results = bough_run_results(run->simulation, &command->recorded, &command->shape);
    double steps = m->duration / m->macro_step, bytes = results.bytes;
    struct statvfs disk;
    double room =
        statvfs(command->folder, &disk) == 0 ? (double)disk.f_bavail * (double)disk.f_frsize : HUGE_VAL;
    if (bytes > much_data && bytes > room) {
        return bough_fail(BOUGH_INVALID,
                          "the results take about %.3g GB, '%.200s' has room for %.3g GB: a longer "
                          "simulation.output.interval or shorter duration",
                          1e-9 * bytes, command->folder, 1e-9 * room);
    }
    bough_forecast_print(results, &command->recorded, stream);
    fflush(stream);
    if (steps <= long_run && bytes <= much_data) return bough_ok();
    fprintf(stderr, "bough: %.3g macro steps, more than %.2g hours\n", steps,
            steps * least_step_time(command) / 3600);
    return bough_ok();
}

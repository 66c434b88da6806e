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
                                 double n_point) {
    const bough_scene_output *output = &simulation->scene->simulation.output;
    double duration = simulation->master->duration;
    double row = COLUMN * (channels->count + 1.0) + 1 + (output->binary ? 2 * channels->count : 0);
    double rows = 1 + ceil(duration / output->interval - 1e-9); // the end is recorded too
    return (bough_forecast){rows, row * rows + (frame_head + frame_point * n_point) *
                                                   samples(duration, output->frames)};
}

void bough_forecast_print(bough_forecast f, const bough_channels *channels, FILE *stream) {
    fprintf(stream, "results: %.10g rows of %d columns, %.3g MB\n", f.rows, channels->count + 1,
            1e-6 * f.bytes);
}

double bough_forecast_points(const bough_shape *shape) {
    double n = 0;
    for (int k = 0; k < shape->n_line; k++) n += shape->line[k].n_point;
    return n;
}

// Each macro step evaluates every member at least twice; the shortest of some evaluations [s].
static double least_step_time(const bough_run *run) {
    bough_coupling *c = run->simulation->master->coupling;
    const bough_assembly *a = c->assembly;
    double shortest = HUGE_VAL;
    for (int k = 0; k < 5; k++) {
        double began = bough_wall_clock();
        for (int i = 0; i < a->n_member; i++) {
            bough_coupling_output_rate(c, i, a->member[i]->time, c->input + a->input_offset[i], NULL,
                                       c->advanced.start_rate + a->output_offset[i]);
        }
        shortest = fmin(shortest, bough_wall_clock() - began);
    }
    return 2 * shortest;
}

bough_status bough_run_forecast(const bough_run_command *command, FILE *stream) {
    const bough_run *run = &command->run;
    const bough_master *m = run->simulation->master;
    bough_forecast results =
        bough_run_results(run->simulation, &command->recorded, bough_forecast_points(&command->shape));
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
            steps * least_step_time(run) / 3600);
    return bough_ok();
}

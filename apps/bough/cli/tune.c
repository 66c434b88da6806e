// bough tune: speed against error of a scene.
#include "apps/bough/cases/tune.h"

#include "apps/bough/cli/command.h"

typedef struct tune_options {
    bough_options common;
    bough_tune_options how; // span 0: the default
} tune_options;

static const double default_span = 20; // [s]

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    BOUGH_OPTION_OUT,
    {"error", "E", "error to be met, relative to the range of each channel; default the scene's accuracy",
     bough_option_quantity, .offset = offsetof(tune_options, how.error), .range = "[1e-7, 0.5]"},
    {"for", "TIME", "simulated time of each run, from the start of the scene; default 20 s",
     bough_option_quantity, .offset = offsetof(tune_options, how.span), .dimension = BOUGH_TIME,
     .range = "> 0"},
    {0},
};

static bough_status perform(bough_arena *arena, const void *given) {
    const tune_options *own = given;
    const bough_options *options = &own->common;
    bough_scene *scene;
    BOUGH_TRY(bough_open_scene(arena, options, &scene));
    bough_tune_options how = own->how;
    how.span = fmin(how.span > 0 ? how.span : default_span, scene->simulation.duration);
    how.n_set = options->set.n;
    how.set = options->set.text;
    how.folder = bough_out_folder(arena, options);
    how.stop = bough_stop_requested;
    how.stream = stdout;
    bough_stop_listen();
    bough_status status = bough_tune(arena, scene, &how);
    if (bough_is_ok(&status)) printf("out: %s: tune.csv, tune.svg, tune.yaml\n", how.folder);
    return status;
}

const bough_command bough_command_tune = {
    .name = "tune",
    .summary = "finds the cheapest solvers, steps and segments of a scene that meet an error",
    .operands = "SCENE",
    .option = rows,
    .size = sizeof(tune_options),
    .run = perform,
};

// bough tune: speed against error of a scene.
#include "apps/bough/cases/tune.h"

#include "apps/bough/cli/command.h"
#include "apps/bough/config/schema.h"

#include <math.h>

typedef struct tune_options {
    bough_options common;
    bough_tune_options how; // span 0: the usual one
} tune_options;

static const double usual_span = 20; // [s]

static bough_status read_error(const char *name, const char *text, void *field) {
    char why[160];
    double *error = field;
    if (bough_quantity(text, BOUGH_PURE_NUMBER, error, why) && *error >= 1e-7 && *error <= 0.5)
        return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects a number from 1e-7 to 0.5, got '%.80s'", name, text);
}

static bough_status read_span(const char *name, const char *text, void *field) {
    char why[160];
    double *span = field;
    if (bough_quantity(text, BOUGH_TIME, span, why) && *span > 0) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects a time such as '20 s', got '%.80s'", name, text);
}

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    BOUGH_OPTION_OUT,
    {"error", "E", "to be met, over the range of each channel; default the scene's accuracy", read_error,
     offsetof(tune_options, how.error)},
    {"for", "TIME", "stretch of the scene that is run with each of the settings; default 20 s", read_span,
     offsetof(tune_options, how.span)},
    {0},
};

static bough_status perform(bough_arena *arena, const void *given) {
    const tune_options *own = given;
    const bough_options *options = &own->common;
    bough_scene *scene;
    BOUGH_TRY(bough_open_scene(arena, options, &scene));
    bough_tune_options how = own->how;
    how.scene = options->operand;
    how.n_set = options->set.n;
    how.set = options->set.text;
    how.span = fmin(how.span > 0 ? how.span : usual_span, scene->simulation.duration);
    how.folder = bough_out_folder(arena, options);
    how.stop = bough_stop_requested;
    how.stream = stdout;
    bough_stop_listen();
    bough_status status = bough_tune(arena, &how);
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

// A flexible body of a scene stepped by itself, as another program's member: its inputs are the motion of
// its frame, its outputs the wrench on its carrier. The rest of the scene stands still.
#ifndef BOUGH_APPS_SIMULATION_BODY_ALONE_H
#define BOUGH_APPS_SIMULATION_BODY_ALONE_H

#include "apps/bough/config/schema.h"
#include "apps/bough/model/simulation.h"

enum { BOUGH_BODY_INPUTS = BOUGH_ROD_INPUTS, BOUGH_BODY_OUTPUTS = BOUGH_ROD_OUTPUTS };

typedef struct bough_body bough_body;

// Names and units of inputs and outputs: velocity, angular velocity and gravity of the frame; force and
// moment about the frame's origin; all in the body's axes.
typedef struct bough_body_variable {
    const char *name;
    bough_dimension dimension; // of inputs
    const char *unit;          // of outputs
} bough_body_variable;
extern const bough_body_variable bough_body_inputs[BOUGH_BODY_INPUTS];
extern const bough_body_variable bough_body_outputs[BOUGH_BODY_OUTPUTS];

// BOUGH_INVALID: there is no such body, it is rigid, it carries bodies, or the scene has loads that are
// sampled outside the body.
bough_status bough_body_create(bough_arena *arena, bough_simulation *s, const char *name,
                               bough_body **body);

// The motion at the present time is the one that is set; the body rides with it if it differs from the
// scene's. Called once, before the first step.
void bough_body_begin(bough_body *body);

// One macro step, in which the motion goes linearly to what is set.
bough_status bough_body_step(bough_body *body);

double bough_body_time(const bough_body *body);

// The motion to be reached (BOUGH_BODY_INPUTS), which the caller sets.
double *bough_body_motion(bough_body *body);

// The wrench at the present time (BOUGH_BODY_OUTPUTS).
const double *bough_body_wrench(bough_body *body);

void bough_body_snapshot(bough_body *body, bough_snapshot *s);

#endif

// Hands the inputs of a scene, set between steps by whoever steps it, to the parts of the model. A
// value holds from the next macro step on; a joint with a prescribed motion gets there within it.
#ifndef BOUGH_APPS_MODEL_INPUT_LINK_H
#define BOUGH_APPS_MODEL_INPUT_LINK_H

#include "apps/bough/model/simulation.h"

typedef struct bough_input_link bough_input_link;

// Needs the built tree and rods; s->inputs stays NULL when the scene has none.
void bough_input_link_build(bough_arena *arena, bough_simulation *s);

// Values now (scene->n_input), SI; to be written between steps.
double *bough_input_link_values(bough_input_link *link);

// Puts input k at a value at once if it is a load; else does nothing.
void bough_input_link_put(const bough_input_link *link, int k, double value);

// For the macro loop, before all other loads.
bough_sampled_load bough_input_link_load(bough_input_link *link, double macro_step);

// What the inputs remember; restoring gives it to the model.
void bough_input_link_snapshot(bough_input_link *link, bough_snapshot *snapshot);

#endif

// Loads that jump at a time: ramps without length. The step that ends at the jump is integrated without the
// load, the step that begins there with it; a function of time alone could not distinguish the two.
#ifndef BOUGH_APPS_MODEL_JUMP_LINK_H
#define BOUGH_APPS_MODEL_JUMP_LINK_H

#include "apps/bough/model/simulation.h"

typedef struct bough_jump_link bough_jump_link;

// Finds them among the loads of the built tree and rods; s->jump stays NULL when there are none.
void bough_jump_link_build(bough_arena *arena, bough_simulation *s);

// Sets the loads to those of a step that begins at t.
void bough_jump_link_begin(bough_jump_link *link, double t);

// For the macro loop.
bough_sampled_load bough_jump_link_load(bough_jump_link *link, double macro_step);

#endif

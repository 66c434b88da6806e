// Puts the scene's loads on rods into the rods, lumped to their vertices.
#ifndef BOUGH_APPS_SIMULATION_LOAD_LINK_H
#define BOUGH_APPS_SIMULATION_LOAD_LINK_H

#include "apps/bough/model/simulation.h"

// Needs the rods and the view of a built simulation.
bough_status bough_load_link_build(bough_arena *arena, bough_simulation *s);

#endif

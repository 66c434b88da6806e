// A second model of a scene whose loads depend on its motion (air, controllers). It takes the same macro
// steps as the run, as one system. Its difference to the run is the run's error, the reaction of the loads
// included (second_solution.h).
#ifndef BOUGH_APPS_SIMULATION_SECOND_MODEL_H
#define BOUGH_APPS_SIMULATION_SECOND_MODEL_H

#include "apps/simulation/simulation.h"

// In the arena, at time 0. *second is NULL where the run measures no error so, where no load reacts, or where
// a second model cannot follow: an FMU keeps a memory of its own, and other programs set inputs of the first
// only. A controller in a library is loaded again, as a copy with variables of its own, if it can be.
bough_status bough_second_model_build(bough_arena *arena, const bough_simulation *s,
                                      bough_simulation **second);

#endif

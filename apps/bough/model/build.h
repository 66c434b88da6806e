// The composition root: makes a running simulation of a scene.
#ifndef BOUGH_APPS_MODEL_BUILD_H
#define BOUGH_APPS_MODEL_BUILD_H

#include "apps/bough/model/simulation.h"

// Number of threads that the scene asks for, or the environment.
int bough_simulation_threads(const bough_scene *scene);

// Builds everything the scene names, and nothing else, in the arena.
bough_status bough_simulation_build(bough_arena *arena, const bough_scene *scene,
                                    bough_simulation **simulation);

// The same with the threads of a pool (NULL: one thread), which several simulations may share.
bough_status bough_simulation_build_on(bough_arena *arena, const bough_scene *scene, bough_pool *pool,
                                       bough_simulation **simulation);

#endif

// Macro steps that are repeated until the interface agrees: the iterated scheme, and the ramp scheme where
// no prediction is stable. Options are those of the coupling: exchange, order, accelerator, relaxation,
// tolerance, iterations, reversed.
#ifndef BOUGH_COSIM_ITERATION_H
#define BOUGH_COSIM_ITERATION_H

#include "cosim/coupling.h"

// Takes the memory: coupling->iteration.
bough_status bough_iteration_create(bough_coupling *c, bough_arena *arena);

// Advances all members from t0 to t1. BOUGH_FAILED when it does not converge.
bough_status bough_iteration_step(bough_coupling *c);

// What is remembered from step to step.
void bough_iteration_snapshot(bough_coupling *c, bough_snapshot *s);

#endif

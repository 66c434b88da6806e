// Macro steps repeated until the interface agrees with itself: the iterated scheme, and the ramp's
// where no prediction holds. Options are the coupling's: exchange, order, accelerator, relaxation,
// tolerance, iterations, reversed.
#ifndef BOUGH_COSIM_ITERATION_H
#define BOUGH_COSIM_ITERATION_H

#include "cosim/coupling.h"

// Takes the memory: coupling->iteration.
bough_status bough_iteration_create(bough_coupling *c, bough_arena *arena);

// Takes all members from t0 to t1. BOUGH_FAILED when it does not converge.
bough_status bough_iteration_step(bough_coupling *c);

// What is remembered from step to step.
void bough_iteration_snapshot(bough_coupling *c, bough_snapshot *s);

#endif

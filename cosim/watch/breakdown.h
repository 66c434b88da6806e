// Diagnosis of a member that fails within a macro step: a stability analysis of the coupling about the state
// at the start of the step shows whether the coupling is the cause, the growth, and a stable scheme.
#ifndef BOUGH_COSIM_WATCH_BREAKDOWN_H
#define BOUGH_COSIM_WATCH_BREAKDOWN_H

#include "cosim/analysis/stability.h"
#include "cosim/coupling.h"

typedef struct bough_breakdown bough_breakdown;

// Takes memory for all states.
bough_breakdown *bough_breakdown_create(bough_arena *arena, const bough_assembly *assembly);

// Keeps the members' states and inputs; a macro step begins.
void bough_breakdown_keep(bough_breakdown *b, const bough_coupling *c);

// Members and inputs are again what they were then.
void bough_breakdown_undo(const bough_breakdown *b, bough_coupling *c);

// The failure of the coupling's present step, with the part of the coupling in it. `before`: result of the
// analysis before the run; if that found nothing, the stored states are analysed, because the members' own
// states are lost.
bough_status bough_breakdown_explain(bough_breakdown *b, bough_coupling *c,
                                     const bough_stability_advice *before, bough_status cause);

#endif

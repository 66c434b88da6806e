// Why a member broke down within a macro step: the coupling about the state it started from is judged,
// so that the message tells whether it is the cause, how fast it grows and what would hold.
#ifndef BOUGH_COSIM_BREAKDOWN_H
#define BOUGH_COSIM_BREAKDOWN_H

#include "cosim/coupling.h"
#include "cosim/stability.h"

typedef struct bough_breakdown bough_breakdown;

// Takes memory for all states.
bough_status bough_breakdown_create(bough_arena *arena, const bough_assembly *assembly,
                                    bough_breakdown **breakdown);

// Keeps the members' states; a macro step begins.
void bough_breakdown_keep(bough_breakdown *b);

// The failure of the coupling's present step with what the coupling has to do with it. `before`: what
// the judgement before the run gave; if that was nothing, the states kept are judged: the members'
// own are lost.
bough_status bough_breakdown_explain(bough_breakdown *b, bough_coupling *c,
                                     const bough_stability_advice *before, bough_status cause);

#endif

// A modal body, of one piece or several, behind the contract of core/solve/system.h: kind "modal".
// Its ports are a rod's (rod_system.h), so are its loads and its vertices' state.
#ifndef BOUGH_FLEXBODY_MODAL_MODAL_SYSTEM_H
#define BOUGH_FLEXBODY_MODAL_MODAL_SYSTEM_H

#include "core/solve/system.h"
#include "flexbody/modal/modal_chain.h"

typedef struct bough_modal_body bough_modal_body;

// Builds the body in the arena. It starts at rest relative to its frame, which moves with `input` (9);
// tolerances are those of a rod for the vertex that a shape moves most.
bough_modal_body *bough_modal_body_create(bough_arena *arena, const bough_modal_model *model,
                                          const double *input);

// The contract's view; valid as long as the arena.
bough_system bough_modal_body_system(bough_modal_body *body);

// The loads, to be changed between steps only; follower loads are not possible.
bough_rod_loads *bough_modal_body_loads(bough_modal_body *body);

// bough_modal_ride with the body's scratch.
void bough_modal_body_ride(bough_modal_body *body, const double *input, double *state);

const bough_modal_model *bough_modal_body_model(const bough_modal_body *body);

// The state of vertices from `first` on, in a state of the body, as rod.h lays out that of a rod
// (13 n); valid until the next call.
const double *bough_modal_body_vertices(bough_modal_body *body, const double *state, const double *input,
                                        int first);

#endif

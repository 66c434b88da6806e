// A modal body, one linear piece or several in a row, behind the contract of core/solve/system.h: kind
// "modal". Each piece has its own floating frame: the tip of a piece carries the frame of the next, which
// moves with the tip and exerts its root wrench on it. No acceleration crosses from piece to piece, so rates
// follow from two sweeps: motions outwards, wrenches inwards. One piece is the classic modal body.
//
// State: per piece q (m), then η (m). Ports, loads and the state of vertices are those of a rod
// (rod_system.h), but there are no follower loads.
#ifndef BOUGH_FLEXBODY_MODAL_MODAL_SYSTEM_H
#define BOUGH_FLEXBODY_MODAL_MODAL_SYSTEM_H

#include "core/solve/system.h"
#include "flexbody/modal/modal_piece.h"

typedef struct bough_modal_model {
    const char *name;
    const bough_rod_model *rod; // the body's vertices and segments
    int n_piece;
    bough_modal_piece *piece; // (n_piece) from the root
    int *offset;              // of each piece in the state (n_piece)
    int n_state;
} bough_modal_model;

// Divides the rod into `pieces` of equally many segments, or of one more or less.
bough_status bough_modal_create(bough_arena *arena, const bough_rod_def *def, int pieces,
                                bough_modal_options options, bough_modal_model **model);

typedef struct bough_modal_body bough_modal_body;

// Builds the body in the arena. It starts at rest relative to its frame, which moves with `input` (9);
// tolerances are those of a rod for the vertex that a shape moves most.
bough_modal_body *bough_modal_body_create(bough_arena *arena, const bough_modal_model *model,
                                          const double *input);

// The contract's view; valid as long as the arena.
bough_system bough_modal_body_system(bough_modal_body *body);

const bough_modal_model *bough_modal_body_model(const bough_modal_body *body);

// The loads, to be changed between steps only; follower loads are not possible.
bough_rod_loads *bough_modal_body_loads(bough_modal_body *body);

// Sets η to that of a body at rest relative to its frame in the shape of the state, q̇ = 0.
void bough_modal_body_ride(bough_modal_body *body, const double *input, double *state);

// The state of vertices from `first` on, in a state of the body, as rod.h lays out that of a rod
// (13 n), absolute velocities for the frame's twist in `input`; valid until the next call.
const double *bough_modal_body_vertices(bough_modal_body *body, const double *state, const double *input,
                                        int first);

// ∂f/∂y (n_state × n_state, by columns) of the last linearisation into these factors of the body's system.
const double *bough_modal_jacobian(const void *factors);

#endif

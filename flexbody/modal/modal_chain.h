// A body of linear modal pieces in a row, each in its own floating frame: the tip of a piece
// carries the frame of the next, which moves as the tip does and puts its root wrench on it. No
// acceleration crosses an interface, so rates go by two sweeps: motions outwards, wrenches
// inwards. One piece is the classic modal body.
//
// State: per piece q (m), then η (m). Input, output and loads are as those of a rod (rod.h), but there are no
// follower loads.
#ifndef BOUGH_FLEXBODY_MODAL_MODAL_CHAIN_H
#define BOUGH_FLEXBODY_MODAL_MODAL_CHAIN_H

#include "flexbody/modal/modal_piece.h"

typedef struct bough_modal_model {
    const char *name;
    const bough_rod_model *rod; // the body's vertices and segments
    int n_piece;
    bough_modal_piece *piece; // (n_piece) from the root
    int *offset;              // of each piece in the state (n_piece)
    int n_state;
} bough_modal_model;

// Work of evaluations, one after another.
typedef struct bough_modal_chain {
    bough_modal_point *point;         // (n_piece)
    double *load;                     // on the body's vertices at the time of evaluation (6 × rod stride)
    bough_modal_frame_change *change; // of each piece's frame and the last tip's (n_piece + 1)
} bough_modal_chain;

// Cuts the rod into `pieces` of equally many segments, or of one more or less.
bough_status bough_modal_create(bough_arena *arena, const bough_rod_def *def, int pieces,
                                bough_modal_options options, bough_modal_model **model);

void bough_modal_chain_init(bough_modal_chain *chain, bough_arena *arena, const bough_modal_model *m);

// The undeformed body moving rigidly with its frame: state (n_state), input (9).
void bough_modal_rest_state(const bough_modal_model *m, const double *input, double *state);

// Sets η to that of a body at rest relative to its frame in the shape of the state, q̇ = 0.
void bough_modal_ride(const bough_modal_model *m, const double *input, bough_modal_chain *chain,
                      double *state);

// rate (n_state); false when a value is not finite.
bool bough_modal_derivative(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                            const double *state, const double *input, bough_modal_chain *chain, double *rate);

// The root wrench (6).
void bough_modal_root_wrench(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                             const double *state, const double *input, bough_modal_chain *chain,
                             double *wrench);

// Evaluates there, which prepares bough_modal_tangent.
void bough_modal_chain_slopes(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                              const double *state, const double *input, bough_modal_chain *chain);

// Derivative of the rates, to rate (n_state), and of the root wrench (6) along a variation of state
// and input (9); either may be NULL for zero.
void bough_modal_tangent(const bough_modal_model *m, bough_modal_chain *chain, const double *state_variation,
                         const double *input_variation, double *rate, double *wrench);

// The state of vertices from `first` on as a rod's (13 n), absolute velocities for the frame's
// twist in `input`.
void bough_modal_expand(const bough_modal_model *m, const double *state, const double *input, int first,
                        bough_modal_chain *chain, double *rod_state);

// -- Newton's matrix of all pieces, dense ---------------------------------------------------------

// Matrices by columns.
typedef struct bough_modal_newton {
    // computed by bough_modal_linearise
    double *jacobian; // ∂f/∂y (n_state × n_state)
    double *input;    // ∂f/∂u (n_state × 9)
    double *wrench;   // of the root wrench, ∂/∂y and ∂/∂u (6 × (n_state + 9))
    double *unit;     // (n_state) zeros between uses
    // computed by bough_modal_factor
    double *matrix; // I − γ ∂f/∂y, factored (n_state × n_state)
    int *pivot;     // (n_state)
} bough_modal_newton;

void bough_modal_newton_init(bough_modal_newton *newton, bough_arena *arena, const bough_modal_model *m);

// Tangents there; false when they are not finite.
bool bough_modal_linearise(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                           const double *state, const double *input, bough_modal_chain *chain,
                           bough_modal_newton *newton);

// bough_modal_tangent's root wrench (6) from the last linearisation.
void bough_modal_kept_tangent(const bough_modal_model *m, const bough_modal_newton *newton,
                              const double *state_variation, const double *input_variation, double *wrench);

// Factors I − γ ∂f/∂y of the last tangents; false when singular.
bool bough_modal_factor(const bough_modal_model *m, bough_modal_newton *newton, double gamma);

// Solves with it in place: x (n_state).
void bough_modal_solve(const bough_modal_model *m, const bough_modal_newton *newton, double *x);

#endif

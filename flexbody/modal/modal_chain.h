// A body of linear modal pieces in a row, each in its own floating frame: the tip of a piece
// carries the frame of the next, which moves as the tip does and puts its root wrench on it. No
// acceleration crosses an interface, so rates go by two sweeps: motions outwards, wrenches
// inwards. One piece is the classic modal body.
//
// State: per piece q (m), then η (m). Input, output and loads are as those of a rod (rod.h), but there are no
// follower loads.
#ifndef BOUGH_FLEXBODY_MODAL_CHAIN_H
#define BOUGH_FLEXBODY_MODAL_CHAIN_H

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
    double *place;                    // state and input of the last slopes (n_state + 9)
    double *place_load;               // and its loads (6 × rod stride)
    bool placed;                      // they are those of an evaluation
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

// Evaluates there for the two below; nothing is done where it was done last.
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

// -- Newton's matrix: dense per piece, pieces eliminated from the tip to the root -----------------

// Matrices by columns. A piece's state has q and η; d is the change of its frame (12), w that of
// the outer wrench in the tip's axes (6). Only pieces that have an inner one carry what is by d,
// only inner ones what is by w and of the tip.
typedef struct bough_modal_newton_piece {
    double *by_q, *by_eta;            // of η̇ (m × stride each)
    double *rate_d;                   // of q̇ and η̇ (2m × 12)
    double *rate_w;                   // of η̇ (m × 6)
    double *root_x, *root_d, *root_w; // of the root wrench (6 × 2m), (6 × 12), (6 × 6)
    double *tip_x, *tip_d;            // of the tip's frame (12 × 2m), (12 × 12)
    // computed by bough_modal_factor, by_q and so on with the outer pieces' answer
    double *closed_q, *closed_eta; // (m × stride each)
    double *turn;                  // of q̇ by q at the linearisation (m × stride)
    double *matrix;                // of q alone, factored (m × m)
    int *pivot;                    // (m)
    double *answer;                // q and η by d (2m × 12)
    double *wrench_x, *wrench;     // root wrench by q and η (6 × 2m), by d (6 × 12)
    double *work;                  // (m)
    double *unit;                  // (2m) zeros between uses
} bough_modal_newton_piece;

typedef struct bough_modal_newton {
    bough_modal_newton_piece *piece; // (n_piece)
    double gamma;
} bough_modal_newton;

void bough_modal_newton_init(bough_modal_newton *newton, bough_arena *arena, const bough_modal_model *m);

// Tangents there; false when they are not finite.
bool bough_modal_linearise(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                           const double *state, const double *input, bough_modal_chain *chain,
                           bough_modal_newton *newton);

// Factors I − γ ∂f/∂y of the last tangents; false when singular.
bool bough_modal_factor(const bough_modal_model *m, bough_modal_newton *newton, double gamma);

// Solves with it in place: x (n_state).
void bough_modal_solve(const bough_modal_model *m, bough_modal_newton *newton, double *x);

#endif

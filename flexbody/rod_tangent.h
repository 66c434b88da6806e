// The rod's Newton matrix (THEORY 3): analytic tangents, elimination of the kinematic rows, and
// solution of (I − γ ∂f/∂y) x = b through the 6×6 block-tridiagonal system in the velocities
//     (M − γ(Dᵥ + γ K A)) δv = M r_v + γ K A r_q,
// K, Dᵥ the tangents of force with respect to configuration and velocity, A the elimination of the
// configuration increments.
#ifndef BOUGH_FLEXBODY_ROD_TANGENT_H
#define BOUGH_FLEXBODY_ROD_TANGENT_H

#include "core/block_tridiagonal.h"
#include "flexbody/rod.h"

// A linearisation and its factorisation; several may exist for one rod.
typedef struct bough_rod_tangent {
    // computed by bough_rod_linearise
    double *variation; // tangents of segment forces: (9 forces × 18 directions × stride)
    bough_block_tridiagonal position; // ∂(vertex force)/∂(x, φ); row 0's lower: the root's
    bough_block_tridiagonal velocity; // ∂(vertex force)/∂(u, W)
    double *mass;                     // (11) with force in BRF axes (n × block)
    double *vertex;                   // x p(state, not normalised) u W and R of each vertex
    bough_vec3 omega;                 // of the BRF
    // computed by bough_rod_factor
    double gamma;
    double *eliminate; // A (n × block)
    bough_block_tridiagonal matrix;
    double *work; // (4 × n × 8)
} bough_rod_tangent;

bool bough_rod_tangent_init(bough_rod_tangent *k, bough_arena *arena, const bough_rod_model *m);

// Tangents at a state. False when they are not finite there.
bool bough_rod_linearise(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                         const double *state, const double *input, bough_rod_scratch *scratch,
                         bough_rod_tangent *k);

// Factors I − γ ∂f/∂y of the last linearisation. False when singular.
bool bough_rod_factor(const bough_rod_model *m, bough_rod_tangent *k, double gamma);

// Solves (I − γ ∂f/∂y) x = b in place (13 n).
void bough_rod_solve(const bough_rod_model *m, bough_rod_tangent *k, double *x);

// ∂f/∂input at a state: (9 × 13 n), row j for input j.
void bough_rod_input_columns(const bough_rod_model *m, const double *state, const double *input,
                             bough_rod_scratch *scratch, double *column);

// Derivative of the root wrench (6) along state and input variations; either may be NULL for zero.
void bough_rod_wrench_tangent(const bough_rod_model *m, const double *state, const double *input,
                              const double *state_variation, const double *input_variation,
                              bough_rod_scratch *scratch, double *wrench);

#endif

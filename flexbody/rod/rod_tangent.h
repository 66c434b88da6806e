// The rod's Newton matrix, theory (24): analytic tangents, elimination of the
// kinematic rows, and solution of (I − γ ∂f/∂y) x = b through the 6×6 block-tridiagonal system in the
// velocities
//     (M − γ(Dᵥ + γ K A)) δv = M r_v + γ K A r_q,
// K, Dᵥ the tangents of force with respect to configuration and velocity, A the elimination of the
// configuration increments. Tangents are found per segment and per vertex as structures of arrays and
// then put into blocks, of which each factorisation forms its matrix.
#pragma once

#include "core/base/block_tridiagonal.h"
#include "flexbody/rod/rod.h"

// The tangents as blocks: M v̇ = K δq + Dᵥ δv.
typedef struct bough_rod_blocks {
    bough_block_tridiagonal position; // K: ∂(vertex force)/∂(x, φ)
    bough_block_tridiagonal velocity; // Dᵥ: ∂(vertex force)/∂(u, W)
    double *mass;                     // (padded n × block)
} bough_rod_blocks;

// A linearisation and its factorisation; several may exist for one rod. Arrays over segments and
// vertices have the model's stride; moving vertex v is at index v = 1..n.
typedef struct bough_rod_tangent {
    // computed by bough_rod_linearise
    double *variation;      // of segment forces by configuration, eight segments at a time: see
                            // rod_tangent_layout.h (padded N × 81)
    double *local_position; // tangents of a vertex' own terms, by rotation (18 × stride)
    double *vertex;         // see rod_tangent_layout.h
    bough_vec3 omega;       // of the BRF
    double *rate;           // f (13 × stride)
    double *root; // of the first segment's forces by configuration, then velocities (2 × 81): force f by
                  // direction d at 9 d + f
    double *end;  // the same of the last segment of a rod that carries bodies (2 × 81)
    double end_rotation[4]; // quaternion of such a rod's last vertex
    double end_load[18];    // change of the loads on it with its rotation: force and moment by columns
    bough_rod_blocks blocks;
    // computed by bough_rod_factor
    double gamma;
    bough_block_tridiagonal matrix;
    double *force;  // γ K A r_q of the segments (9 × stride)
    double *work;   // of a solution
    double *packed; // (padded n × 8)
} bough_rod_tangent;

void bough_rod_tangent_init(bough_rod_tangent *k, bough_arena *arena, const bough_rod_model *m);

// Tangents at a state. False when they are not finite there.
bool bough_rod_linearise(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                         const double *state, const double *input, bough_rod_scratch *scratch,
                         bough_rod_tangent *k);

// What goes into the blocks of eight segments and the vertices at their right ends only, rows of 8.
typedef struct bough_rod_eight {
    int first;                                // segment
    _Alignas(64) double velocity[81 * 8];     // of segment forces, by velocities: as `variation`
    _Alignas(64) double mass[36 * 8];         // of theory (11) with force in BRF axes
    _Alignas(64) double own_velocity[36 * 8]; // tangents of a vertex' own terms, by u, W
} bough_rod_eight;

// Puts them and the tangents by configuration into blocks. To be called in the order of segments.
void bough_rod_form_blocks(const bough_rod_model *m, bough_rod_tangent *k, const bough_rod_eight *eight);
BOUGH_DECLARE_LEVELS(bough_rod_form_blocks);

// Factors I − γ ∂f/∂y of the last linearisation. False when singular.
bool bough_rod_factor(const bough_rod_model *m, bough_rod_tangent *k, double gamma);

// Solves (I − γ ∂f/∂y) x = b in place (13 n).
void bough_rod_solve(const bough_rod_model *m, bough_rod_tangent *k, double *x);

// Stores in a linearisation of a rod that carries bodies how the loads in scratch change with the rotation of
// the last vertex, whose motion is `end`.
void bough_rod_keep_end(const bough_rod_model *m, const bough_rod_loads *loads, const double *end,
                        const bough_rod_scratch *scratch, bough_rod_tangent *k);

// -- about a steady motion ------------------------------------------------------------------------

// The rod about a steady motion, its BRF at rest or moving at a constant twist, in 6 tangent
// coordinates per vertex, q = (δx in BRF axes, δφ in section axes):
//     M q̈ + C q̇ + K q = 0,   δv = q̇ + B q,   C = M B − ∂f/∂v,   K = −(∂f/∂q + ∂f/∂v B).
// K is a stiffness, at rest minus the tangent K above.
// B = diag(ξ(ω), ξ(Rᵀω)): the variation of u₀ + ω×x and Rᵀω, the velocities of the steady motion, so
// gyroscopic terms, spin softening and centrifugal stiffening are exact. No quaternion norms, hence
// no spurious zero eigenvalues.

// Sets the state's velocities to those of a rod at rest in its BRF, which moves with the twist in `input`.
void bough_rod_move_rigidly(const bough_rod_model *m, const double *input, double *state);

// K from the blocks of the linearisation at a state that rides with the BRF; input as there.
void bough_rod_linear_stiffness(const bough_rod_model *m, const bough_rod_blocks *blocks, const double *input,
                                const double *state, bough_block_tridiagonal *stiffness);

// C likewise. M is blocks->mass.
void bough_rod_linear_damping(const bough_rod_model *m, const bough_rod_blocks *blocks, const double *input,
                              const double *state, bough_block_tridiagonal *damping);

// Kernels, each called at its model's level.
BOUGH_DECLARE_LEVELS(bough_rod_linearise);
BOUGH_DECLARE_LEVELS(bough_rod_factor);
BOUGH_DECLARE_LEVELS(bough_rod_solve);
#define bough_rod_linearise(m, ...) BOUGH_OF_LEVEL(bough_rod_linearise, (m)->level)(m, __VA_ARGS__)
#define bough_rod_factor(m, ...) BOUGH_OF_LEVEL(bough_rod_factor, (m)->level)(m, __VA_ARGS__)
#define bough_rod_solve(m, ...) BOUGH_OF_LEVEL(bough_rod_solve, (m)->level)(m, __VA_ARGS__)

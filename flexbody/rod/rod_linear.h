// The rod about a steady motion, its BRF at rest or turning at a constant twist, in 6 tangent
// coordinates per vertex, q = (δx in BRF axes, δφ in section axes):
//     M q̈ + C q̇ + K q = 0,   δv = q̇ + B q,   C = M B − ∂f/∂v,   K = −(∂f/∂q + ∂f/∂v B).
// B = diag(ξ(ω), ξ(Rᵀω)): the variation of u₀ + ω×x and Rᵀω, the velocities of the steady motion, so
// gyroscopic terms, spin softening and centrifugal stiffening are exact. No quaternion norms, hence
// no spurious zero eigenvalues.
#ifndef BOUGH_FLEXBODY_ROD_ROD_LINEAR_H
#define BOUGH_FLEXBODY_ROD_ROD_LINEAR_H

#include "flexbody/rod/rod_tangent.h"

// Sets the state's velocities to those of a rod that is at rest in its BRF of the twist in `input`.
void bough_rod_ride(const bough_rod_model *m, const double *input, double *state);

// K from the blocks of the linearisation at a state that rides with the BRF; input as there.
void bough_rod_linear_stiffness(const bough_rod_model *m, const bough_rod_blocks *blocks, const double *input,
                                const double *state, bough_block_tridiagonal *stiffness);

// C likewise. M is blocks->mass.
void bough_rod_linear_damping(const bough_rod_model *m, const bough_rod_blocks *blocks, const double *input,
                              const double *state, bough_block_tridiagonal *damping);

#endif

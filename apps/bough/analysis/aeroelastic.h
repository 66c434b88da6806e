// Modes of the whole scene and its air about a steady state, as an observer at rest sees them where a rotor
// turns (cosim/analysis/modes.h): eigenvalues of the full linear system of the members' states and those of
// the air, whose forces couple all (air_tangent.h), theory (77, 100).
#pragma once

#include "apps/bough/analysis/air_tangent.h"
#include "apps/bough/model/blade_group.h"
#include "cosim/analysis/modes.h"

#include <complex.h>

// The system and the state of the modes; all borrowed.
typedef struct bough_aeroelastic {
    const bough_simulation *simulation;
    bough_whole *whole;             // its factors are replaced
    const bough_modes_def *def;     // state, inputs, point on the real axis, and how the blades turn
    const bough_blade_group *group; // the equal blades, whose air turns with them
    const bough_air_tangent *air;   // how loads and air follow the motion
} bough_aeroelastic;

// Eigenvectors of one mode in members and air: real before imaginary part (2 × (n + n_air)).
typedef struct bough_mode_vectors {
    double *right, *left; // left: NULL where none is found
} bough_mode_vectors;

// Finds up to `wanted` oscillations and growing motions in which the bodies take part.
//   pair      by |λ|, room for count->wanted; their shapes (n_state), of any length and phase, in the arena
//   count     how many there are; with memory of the air `converged` counts the vectors of the subspace,
//             more than are wanted
//   vectors   (count->wanted) of each pair; NULL: not wanted
//   unpaired  eigenvectors that are not in the subspace, since their left or right partner did not converge
// The cost is that of factoring a dense matrix of n_state rows (a tenth of it for equal blades). With memory
// of the air all eigenvalues of a matrix of its states and three rows for each mode come to it. BOUGH_FAILED
// where eigenvalues do not converge or the system is singular about the point.
bough_status bough_aeroelastic_modes(bough_arena *arena, const bough_aeroelastic *system,
                                     bough_eigen_pair *pair, bough_eigen_count *count,
                                     bough_mode_vectors *vectors, int *unpaired);

// -- the same modes on another mesh (mesh_change.c) --------------------------------------------------

// Modes whose vectors are known; all borrowed.
typedef struct bough_known_modes {
    const bough_simulation *simulation;
    int n;
    const bough_eigen_pair *pair;     // (n)
    const bough_mode_vectors *vector; // (n) of them, with as many states of the air as on the other mesh
} bough_known_modes;

// By Galerkin's method, theory (117): sets the eigenvalues `there` (n) [1/s] of the system on the other mesh,
// whose bodies are the same and have states of their own or are rods. NaN of a mode without a left vector, or
// of which less than half is in one mode there. BOUGH_FAILED where the system is singular about its point.
bough_status bough_mesh_change_find(bough_arena *arena, const bough_known_modes *known,
                                    const bough_aeroelastic *system, double complex *there);

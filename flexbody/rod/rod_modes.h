// Natural modes of a rod, clamped at its root, about its equilibrium at rest or in steady rotation.
#pragma once

#include "flexbody/rod/rod_static.h"

// Where a mode's kinetic energy is: translations along x, y, z of the body's frame, and torsion.
// Of a blade along z these are flap, edge, axial and torsion.
typedef enum bough_rod_direction {
    BOUGH_ROD_FLAP,
    BOUGH_ROD_EDGE,
    BOUGH_ROD_AXIAL,
    BOUGH_ROD_TORSION,
    BOUGH_ROD_DIRECTIONS,
} bough_rod_direction;

typedef struct bough_rod_mode {
    double frequency;                   // natural, |λ|/2π [Hz]
    double damped_frequency;            // Im λ/2π [Hz]; 0: it grows without oscillating
    double damping;                     // ratio −Re λ/|λ|; negative: it grows
    double share[BOUGH_ROD_DIRECTIONS]; // of the energy, sum 1
    bough_rod_direction dominant;
    double *real, *imaginary; // shape, displacement and rotation of vertices 1..n in body axes
                              // (6 × n) [m, rad], scaled so that the largest displacement, of a
                              // torsional mode the largest twist, is real and 1
} bough_rod_mode;

typedef struct bough_rod_mode_list {
    int wanted;           // set before
    int found;            // fewer only if the rod has fewer
    bough_rod_mode *mode; // (found), ascending in frequency
} bough_rod_mode_list;

// The lowest modes. `state` (13 n) is the equilibrium that bough_rod_steady found with `input` and
// left in `work`.
bough_status bough_rod_modes(bough_arena *arena, const bough_rod_model *m, bough_rod_static *work,
                             const double *input, const double *state, bough_rod_mode_list *list);

// (I − γ(J − S + A))⁻¹ about the point of a search for modes in the air, theory (77, 109): what the air
// couples is a dense matrix, in blocks where a rotor's blades are equal (blade_inverse.h), for a tenth of the
// operations.
#ifndef BOUGH_APPS_ANALYSIS_AIR_INVERSE_H
#define BOUGH_APPS_ANALYSIS_AIR_INVERSE_H

#include "apps/bough/analysis/aeroelastic.h"

struct bough_blade_inverse;

typedef struct bough_air_inverse {
    const bough_aeroelastic *system;
    int n, n_other; // states; those that are neither held nor of `blades`
    int *other;     // (n_other)
    double gamma;
    const struct bough_blade_inverse *blades; // NULL: none
    int n_part, r;                            // of these; their states are in harmonics
    // all column-major
    double *from, *to;        // Vᵀ, W (n_part × r × n_other)
    double *others, *inverse; // P_oo, K⁻¹ (n_other × n_other)
    // scratch of MOST vectors: harmonics of arguments and images, and work of these; those of the others
    double *argument, *image, *work, *force, *moved;
} bough_air_inverse;

// About the factors of system->whole. Where a test vector shows that the blades are not alike, or push each
// other but through the other states and the air, they are others. NULL: singular.
bough_air_inverse *bough_air_inverse_create(bough_arena *arena, const bough_aeroelastic *system);

// Images of n vectors (n × n_state), one after the other, by the inverse or its transpose.
void bough_air_inverse_apply(bough_air_inverse *inverse, bool transposed, int n, const double *z,
                             double *image);

#endif

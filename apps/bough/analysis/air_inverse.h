// (I − γ(J − S + A))⁻¹ about the point of a search for modes in the air, theory (77, 109). The air
// makes it a dense matrix; where a rotor's blades are equal, this has blocks (blade_inverse.c), which take a
// tenth of the operations.
#pragma once

#include "apps/bough/analysis/aeroelastic.h"

// -- equal blades (blade_inverse.c) ---------------------------------------------------------------

// The equal blades of a rotor, coupled by the air alone: D = (K_b + N)⁻¹ with K_b = I − γJ of
// one blade and N = γ(S − A) between all. Over harmonics of the blades it falls into blocks of one blade or
// two, of which the kinematic rows are eliminated vertex by vertex: theory (116).
typedef struct bough_blade_inverse bough_blade_inverse;

// About the factors of system->whole. NULL where there are no equal blades or a block is singular.
bough_blade_inverse *bough_blade_inverse_create(bough_arena *arena, const bough_aeroelastic *system);

// Harmonics of the blades' part of vectors, (columns × n_state) → (n_part × columns × n_row).
void bough_blade_inverse_gather(const bough_blade_inverse *x, int columns, const double *z, double *hat);

// And back; other states stay as they are.
void bough_blade_inverse_scatter(const bough_blade_inverse *x, int columns, const double *hat, double *z);

// image ← D z or Dᵀ z, of harmonics (n_part × columns × n_row); work: twice as much.
void bough_blade_inverse_apply(const bough_blade_inverse *x, bool transposed, int columns, const double *z,
                               double *work, double *image);

// force += N z or Nᵀ z, likewise.
void bough_blade_inverse_force(const bough_blade_inverse *x, bool transposed, int columns, const double *z,
                               double *work, double *force);

// -- all states (air_inverse.c) -------------------------------------------------------------------

typedef struct bough_air_inverse {
    const bough_aeroelastic *system;
    int n, n_other; // states; those that are neither held nor of `blades`
    int *other;     // (n_other)
    double gamma;
    const bough_blade_inverse *blades; // NULL: none
    int n_part, r;                     // of these; their states are in harmonics
    // all column-major
    double *from, *to;        // Vᵀ, W (n_part × r × n_other)
    double *others, *inverse; // P_oo, K⁻¹ (n_other × n_other)
    // scratch of MOST vectors: harmonics of arguments and images, and work of these; those of the others
    double *argument, *image, *work, *force, *moved;
} bough_air_inverse;

// Factors system->whole, too. The blades count among the other states where a test vector shows that they
// differ, or that they act on each other by more than the other states and the air. BOUGH_FAILED: singular.
bough_status bough_air_inverse_create(bough_arena *arena, const bough_aeroelastic *system,
                                      bough_air_inverse **inverse);

// Images of n vectors (n × n_state), one after the other, by the inverse or its transpose.
void bough_air_inverse_apply(bough_air_inverse *inverse, bool transposed, int n, const double *z,
                             double *image);

// The equal blades of a rotor, coupled by the air alone: D = (K_b + N)⁻¹ with K_b = I − γJ of
// one blade and N = γ(S − A) between all. Over harmonics of the blades it falls into blocks of one blade or
// two, of which the kinematic rows are eliminated vertex by vertex: theory (116).
#ifndef BOUGH_APPS_ANALYSIS_BLADE_INVERSE_H
#define BOUGH_APPS_ANALYSIS_BLADE_INVERSE_H

#include "apps/bough/analysis/aeroelastic.h"

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

#endif

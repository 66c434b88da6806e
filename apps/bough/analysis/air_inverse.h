// (I − γ(J − S + A))⁻¹ about the point of a search for modes in the air, theory (77): what the air couples is
// a dense matrix, in blocks where a rotor's blades are equal (rotor_inverse.h).
#ifndef BOUGH_APPS_ANALYSIS_AIR_INVERSE_H
#define BOUGH_APPS_ANALYSIS_AIR_INVERSE_H

#include "apps/bough/analysis/aeroelastic.h"

typedef struct bough_air_inverse bough_air_inverse;

// About the factors of system->whole; `transposed`: the transpose is needed, too, and so many images that the
// inverse is worth a matrix. NULL: singular.
bough_air_inverse *bough_air_inverse_create(bough_arena *arena, const bough_aeroelastic *system,
                                            bool transposed);

// Images of n vectors (n × n_state), one after the other, by the inverse or its transpose.
void bough_air_inverse_apply(bough_air_inverse *inverse, bool transposed, int n, const double *z,
                             double *image);

#endif

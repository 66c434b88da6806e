// The inverse of aeroelastic.h for a rotor of equal blades, theory (109): over the blades' harmonics the part
// of the blades falls into blocks of one blade or two, which all other states (tower, joints) border. Its
// cost is that of factoring the blocks, a tenth of the dense matrix for three blades.
#ifndef BOUGH_APPS_ANALYSIS_ROTOR_INVERSE_H
#define BOUGH_APPS_ANALYSIS_ROTOR_INVERSE_H

#include "apps/bough/analysis/aeroelastic.h"

typedef struct bough_rotor_inverse bough_rotor_inverse;

// About the factors of system->whole. NULL where there are no equal blades, a block is singular, or a test
// vector shows that the blocks are not the whole: blades that push each other but through the others.
bough_rotor_inverse *bough_rotor_inverse_create(bough_arena *arena, const bough_aeroelastic *system,
                                                double going_back);

// Images of n vectors (n × n_state), one after the other, by the inverse or its transpose.
void bough_rotor_inverse_apply(bough_rotor_inverse *inverse, bool transposed, int n, const double *z,
                               double *image);

#endif

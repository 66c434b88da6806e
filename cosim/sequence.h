// Levels one after the other: the sequential macro step of extrapolated coupling.
#ifndef BOUGH_COSIM_SEQUENCE_H
#define BOUGH_COSIM_SEQUENCE_H

#include "cosim/coupling.h"

// Takes the levels in order. An input whose source has advanced already is interpolated; every
// other is extrapolated by the polynomial of `degree` through the last synchronisation values.
bough_status bough_sequence_step(bough_coupling *c, int degree);

// Whether a level comes before another in the sequence.
bool bough_sequence_before(const bough_coupling *c, int level, int other);

// Extrapolates input j (numbered over all inputs) of its member.
void bough_sequence_extrapolate(bough_coupling *c, int member, int j, int degree);

#endif

// The linear state space of the whole scene as files, for `bough modes`.
#ifndef BOUGH_APPS_BOUGH_MODES_LINEAR_H
#define BOUGH_APPS_BOUGH_MODES_LINEAR_H

#include "apps/bough/model/simulation.h"

// Writes A.mtx to D.mtx (Matrix Market, coordinates of the entries that are not 0) and states.csv,
// inputs.csv and outputs.csv, row k of which names row or column k of the matrices.
bough_status bough_modes_linear(bough_arena *arena, bough_simulation *s, double time, const char *folder);

#endif

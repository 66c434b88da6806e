// Forces and moments along a rod as work-equivalent loads on its vertices.
#ifndef BOUGH_FLEXBODY_ROD_LOAD_H
#define BOUGH_FLEXBODY_ROD_LOAD_H

#include "flexbody/rod.h"

// Where a load acts, in arc length: at `from` if to == from, else constant along [from, to].
typedef struct bough_rod_reach {
    double from, to; // [m]
} bough_rod_reach;

// Adds to value (6 × stride) a wrench (force, moment) [N, N m], or per length [N/m, N m/m], resolved
// in BRF axes, or for a follower in section axes. Forces and moments are shared by hat functions;
// between the vertices a force also bends, which the equal and opposite moments of a linear element
// on its two vertices account for: on a uniform mesh under a uniform load they stay at the ends only.
// Their direction is that of the undeformed rod.
void bough_rod_lump(const bough_rod_model *m, bough_rod_reach reach, const double *wrench,
                    bool follower, double *value);

#endif

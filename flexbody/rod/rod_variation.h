// Exact tangents of the forces of eight segments at a time, side by side in vector lanes.
#ifndef BOUGH_FLEXBODY_ROD_VARIATION_H
#define BOUGH_FLEXBODY_ROD_VARIATION_H

#include "flexbody/rod/rod.h"

// Shape, motion and stress of segments first..first + 7, from vertices and loads in `scratch`, into
// base (BOUGH_ROD_BASE rows of 8). Segments beyond the last exert nothing.
enum { BOUGH_ROD_BASE = 56 };
void bough_rod_base(const bough_rod_model *m, const bough_rod_scratch *scratch, int first, double *base);

// Their tangents, a row of 8 for force f along direction d at 9 f + d (rod_tangent_layout.h): along
// configurations, and along velocities.
void bough_rod_position_variation(const bough_rod_model *m, const bough_rod_scratch *scratch, int first,
                                  const double *base, double *variation);
void bough_rod_velocity_variation(const bough_rod_model *m, int first, const double *base, double *variation);

#endif

// Modes of the whole scene about its equilibrium, at rest or in steady rotation, or about the state
// it begins in. The air's forces are those of the equilibrium, or follow the motion (aeroelastic.h).
//
// Where the turbine's rotor turns, its blades are equal and evenly spaced and at least three, the
// frequencies are those an observer at rest sees: the multi-blade transform of cosim/analysis/modes.h, about
// the mean of the blades' shapes. In any other rotation they are those of the frozen azimuth.
#ifndef BOUGH_APPS_ANALYSIS_VIBRATION_H
#define BOUGH_APPS_ANALYSIS_VIBRATION_H

#include "apps/bough/analysis/mode_shape.h"
#include "apps/bough/model/equilibrium.h"

typedef struct bough_vibration {
    bough_equilibrium_work work; // how the equilibrium was found; 0 steps: none was sought
    double spin;                 // of the rotor [rad/s]
    bool frozen;                 // it turns, but the blades allow no transform
    int n_blade;                 // compared; 0: none
    int n_row;                   // of a shape
    int asked;                   // modes
    bough_eigen_count count;     // of the eigenvalues among which they are sought
    int unpaired;                // of these, left out of the air's system: see aeroelastic.h
    int found;
    bough_scene_mode *mode; // (found) by the distance of λ from a point near 0
    bough_eigen_pair *pair; // (found)
} bough_vibration;

// Whether the scene's modes block, or the scene without it, asks for modes of the whole.
bool bough_vibration_wanted(const bough_simulation *s);

// The `count` lowest modes, or fewer if not so many converge to 1e-9; free
// motions, whose eigenvalue is 0, are left out. The simulation is left in the state they are about.
bough_status bough_vibration_find(bough_arena *arena, bough_simulation *s, int count,
                                  bough_vibration *vibration);

#endif

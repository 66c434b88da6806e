// The mean of a turning rotor of n equal blades over its azimuths, theory (113). Where tilt, shear, weight
// and tower make the loads of a blade change with its azimuth, the linear system, seen by an observer at
// rest, repeats after an nth of a revolution. The modes are those of the mean of its linearisations at some
// azimuths within that part, each about its own equilibrium.
#pragma once

#include "apps/bough/analysis/aeroelastic.h"
#include "apps/bough/analysis/vibration.h"

#include <complex.h>

// The rotor at one of its azimuths.
typedef struct bough_azimuth {
    double turn; // from the scene's azimuth [rad]
    bough_simulation *simulation;
    bough_vibration_point point;
    double *blend; // C (n_part × n_part), row-major: the states of each blade here from those of all blades
                   // there, for an observer at rest who sees no change
} bough_azimuth;

typedef struct bough_azimuths {
    int n; // 1: the scene's alone
    bough_azimuth *at;
    const bough_blade_group *group; // of the scene's azimuth
} bough_azimuths;

// The first is that of the simulation and its point, both borrowed; the others are those of further
// simulations of its scene, in equilibrium at `time` if modes.at asks for it. Sets the point's state to the
// mean over all. Where no rotor of equal blades turns there is one azimuth only.
bough_status bough_azimuths_find(bough_arena *arena, bough_simulation *s, double time,
                                 bough_vibration_point *point, bough_azimuths *azimuths);

// The mean tangent, of blades on blades also over the blades.
bough_status bough_azimuths_tangent(bough_arena *arena, const bough_azimuths *azimuths,
                                    bough_air_tangent *mean);

// The state of the k-th azimuth for the mean tangent.
bough_air_azimuth bough_azimuths_air(const bough_azimuths *azimuths, int k);

// First-order change of the eigenvalues of n modes from those of the mean by the air of each azimuth: change
// (azimuths × n) [1/s]; NaN without a left vector.
bough_status bough_azimuths_change(bough_arena *arena, const bough_azimuths *azimuths, int n,
                                   const bough_mode_vectors *vector, double complex *change);

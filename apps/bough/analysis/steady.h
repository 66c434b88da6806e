// Rods in equilibrium: one by one with a clamped root, at rest or in steady rotation, for statics and
// eigenvalues; or in the equilibrium of the whole scene (equilibrium.h).
#pragma once

#include "apps/bough/model/simulation.h"
#include "flexbody/rod/rod_static.h"

typedef struct bough_steady {
    const bough_beam *beam;
    const bough_rod_model *model;
    double input[BOUGH_ROD_MOST_INPUTS]; // constant twist and gravity of the body's frame, in its
                                         // axes, and the motion of the end that carries bodies
    double time;                         // of the loads [s]
    double *state;                       // in equilibrium (13 n)
    bough_rod_static work; // work.scaled: the loads, all of them; work.scratch: the rod gathered
} bough_steady;

// A steady rotation of a rod's frame; speed 0: rest.
typedef struct bough_turning {
    double speed;      // [rad/s]
    bough_vec3 axis;   // unit vector, ground axes
    bough_vec3 centre; // a point of the axis, in the ground [m]
} bough_turning;

// The rotation of a rod that the scene's modes block asks for, in the simulation's initial pose.
// BOUGH_INVALID when it names no axis for this rod.
bough_status bough_steady_turning(const bough_simulation *s, const bough_beam *beam, bough_turning *turning);

// Number of bodies that are rods.
int bough_steady_rods(const bough_simulation *s);

// Equilibrium of the rod in the simulation's initial pose under gravity and its full loads. In rotation
// gravity is its mean over a revolution, along the axis.
bough_status bough_steady_find(bough_arena *arena, const bough_simulation *s, const bough_beam *beam,
                               const bough_turning *turning, bough_steady *steady);

// The rod in the equilibrium of the whole scene under the loads at `time`.
bough_status bough_steady_equilibrium(bough_arena *arena, const bough_simulation *s, const bough_beam *beam,
                                      double time, bough_steady *steady);

// Displacement [m] and rotation vector [rad] of vertex i from the undeformed rod, in body axes.
void bough_steady_displacement(const bough_steady *steady, int i, bough_vec3 *shift, bough_vec3 *turn);

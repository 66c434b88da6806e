// Rods in equilibrium one by one with a clamped root, at rest or in steady rotation, for statics and
// eigenvalues.
#pragma once

#include "apps/bough/model/simulation.h"
#include "flexbody/rod/rod_static.h"

typedef struct bough_steady {
    const bough_beam *beam;
    const bough_rod_model *model;
    double input[BOUGH_ROD_MOST_INPUTS]; // constant twist and gravity of the body's frame, in its
                                         // axes, and the motion of the end that carries bodies
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

// Masses with springs as members: linear, of two states or none, integrated exactly to rounding
// (Taylor series of the state under the cubic input). What the studies of coupling schemes and their
// tests are made of.
#pragma once

#include "cosim/member.h"

enum { BOUGH_OSCILLATOR_PORT = 4 };

// ẏ = A y + B u, o = C y + D u; y = (x, v)
typedef struct bough_oscillator {
    double a[2][2], b[2][BOUGH_OSCILLATOR_PORT], c[BOUGH_OSCILLATOR_PORT][2];
    double d[BOUGH_OSCILLATOR_PORT][BOUGH_OSCILLATOR_PORT];
    int n_state; // 2, or 0: only D counts
    int n_input, n_output;
    double y[2], scale[2], integrated[2];
    const bough_member *member; // that it is
    long advances, starts;
} bough_oscillator;

// A mass on a spring to the wall.
typedef struct bough_spring_mass {
    double m, k, c; // mass [kg], stiffness [N/m] and damping [N s/m] to the wall
} bough_spring_mass;

// Input: the force on it, times `sign`; output: (v, x). At x, at rest.
bough_oscillator bough_oscillator_force_in(bough_spring_mass s, double sign, double x);

// Input: the other's (v, x). It has the coupling spring (k, c); output: the force on the other.
bough_oscillator bough_oscillator_motion_in(bough_spring_mass s, double k, double c, double x);

// The same, but its output is its own (v, x).
bough_oscillator bough_oscillator_motion_in_and_out(bough_spring_mass s, double k, double c, double x);

// The coupling spring alone. Input: (v, x) of the first mass and of the second; output: the force on the
// first.
bough_oscillator bough_oscillator_link(double k, double c);

// Its contract; the oscillator stays where it is.
bough_system bough_oscillator_system(bough_oscillator *o, const char *name);

// A member that integrates it exactly, with its state at o->y; both stay where they are.
void bough_oscillator_member(bough_oscillator *o, const char *name, bough_member *member);

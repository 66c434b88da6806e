// Equilibrium of the whole, F(t, y) = 0 at a fixed time, except for the states that it holds, whose rates
// need not vanish: the angle and the speed of a steady rotation, for instance. Method: implicit Euler steps
// of growing length γ, two Newton corrections each, which follow the motion downhill from the initial state
// until, at the longest, they are Newton's method. An equilibrium near the initial state may be found though
// it is unstable.
#pragma once

#include "cosim/whole.h"

typedef struct bough_equilibrium_def {
    double time;         // [s]
    double unit;         // of time, to which the motions of the whole belong [s]
    double step;         // the first γ, in this unit
    double least;        // γ below which the search ends, in this unit
    double tolerance;    // of the last step, in units of the scales
    const double *scale; // (n_state) of the states; NULL: the members'
    int steps;           // most, refused ones among them
    bool kept;           // the whole has factors of the longest γ about a state that may be near the first
    void *self;
    // moved (n_state) ← state after a finite change, as its rotations and shapes add up; returns
    // its largest rotation [rad]. NULL: state + change.
    double (*move)(void *self, const double *state, const double *change, double *moved);
    // Takes the motion that is not part of the equilibrium out of a state, after each step; NULL:
    // none.
    void (*rest)(void *self, double *state);
    // Twice the kinetic energy of a state [J]. With it, states come to rest only after steps in which it
    // falls: light bodies then follow heavy ones, which gather speed. NULL: after each step.
    double (*kinetic)(void *self, const double *state);
} bough_equilibrium_def;

// Time 0, a unit of 1 s, 0.1, 1e-9, 1e-10, the members' scales, 1000 steps.
bough_equilibrium_def bough_equilibrium_def_default(void);

enum { BOUGH_EQUILIBRIUM_LONGEST = 120 }; // γ of the last steps, in units of time; beyond, rounding grows

typedef struct bough_equilibrium_report {
    int steps;     // taken and refused
    bool kept;     // the last factors are those of the longest γ
    int row;       // the state that moved most in the last step
    double change; // by how much, in units of its scale
    double rate;   // its rate of change [units per s]
} bough_equilibrium_report;

// Brings `state` (n_state) to equilibrium. BOUGH_FAILED when it is not found: the report has
// the state that still moves, `state` is the last one reached.
bough_status bough_equilibrium_find(bough_arena *arena, bough_whole *whole, const bough_equilibrium_def *def,
                                    double *state, bough_equilibrium_report *report);

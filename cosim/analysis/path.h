// A path of equilibria of the whole, F(λ, y) = 0, as the load factor λ grows and, past a limit point,
// shrinks: pseudo-arclength continuation, theory (73). Loads enter F linearly, so that
//     F(λ, y) = F(0 s, y) + λ (F(end, y) − F(0 s, y)),
// also for negative load factors. Each step predicts along the tangent and corrects by Newton's method in the
// plane normal to it, state and load factor together,
//     J δy + ∂F/∂λ δλ = −F,   ⟨δ, tangent⟩ = 0,
// by two solutions with the factors of the whole, those of the loads at λ end. E. Riks, An incremental
// approach to the solution of snapping and buckling problems, Int. J. Solids Struct. 15 (1979).
#pragma once

#include "cosim/whole.h"

typedef struct bough_path_def {
    double end;       // time of the whole loads; the path begins with those at time 0 [s]
    double step;      // the first step's length
    double tolerance; // of the last correction, in units of the members' scales
    int steps;        // most, refused ones among them
    void *self;
    // As in equilibrium.h, not NULL.
    double (*move)(void *self, const double *state, const double *change, double *moved);
    void (*rest)(void *self, double *state);
    // A point of the path; `limit`: there the load factor has an extremum. A failure
    // ends the path.
    bough_status (*point)(void *self, double factor, const double *state, bool limit);
} bough_path_def;

// Steps of 0.02 at first, 1e-8, 2000 steps.
bough_path_def bough_path_def_default(void);

typedef struct bough_path_report {
    int steps, points, limits;
    double factor; // load factor of the last point
} bough_path_report;

// Follows the path from `state` (n_state), an equilibrium under the loads at time 0, to the load factor 1 or
// −1. BOUGH_FAILED: the path cannot be followed, or is longer than the most steps; the state is that of the
// last point.
bough_status bough_path_follow(bough_arena *arena, bough_whole *whole, const bough_path_def *def,
                               double *state, bough_path_report *report);

// A joint coordinate q(t) that is given: its speed or itself constant, by a smooth ramp or by a
// table. Every form is a cubic in pieces and one smooth ramp on top of it.
#pragma once

#include "core/base/arena.h"

typedef struct bough_motion_def {
    bool given;                   // false: the joint moves by its forces, the other fields are not read
    bool speed;                   // what is given is q̇ [rad/s, m/s], else q [rad, m]
    double from, to;              // of the ramp; equal for a constant
    double start, end;            // of the ramp [s]
    int n;                        // rows of a table in place of the ramp, 0: none
    const double *times, *values; // (n) times increasing [s]; copied. Between them a speed is
                                  // linear, q a cubic spline at rest at both ends that
                                  // rises and falls only where the values do; held outside
} bough_motion_def;

typedef struct bough_motion {
    int n;         // breaks; n + 1 pieces
    double *times; // (n) where pieces meet [s]
    double *piece; // (n + 1) × 4: q by powers of the time since the piece's start; the first two
                   // pieces start at times[0], without breaks at 0
    double rise;   // what the ramp adds to q, or to q̇ if …
    bool of_speed;
    double start, end; // [s]
} bough_motion;

typedef struct bough_motion_point {
    double q, v, a; // coordinate, speed, acceleration [rad, m; per s; per s²]
} bough_motion_point;

// `initial` is q at time 0 where the speed is given. Values are finite, a ramp ends after it starts,
// times increase.
bough_motion *bough_motion_create(bough_arena *arena, const bough_motion_def *def, double initial);

// From t on the motion is the cubic from one point to another `span` [s] later, also beyond it; the points'
// accelerations are not read. For motions that a controller demands sample by sample. The motion given before
// is lost.
void bough_motion_steer(bough_motion *motion, double t, double span, bough_motion_point from,
                        bough_motion_point to);

// At a corner of a table the acceleration is that from then on.
bough_motion_point bough_motion_at(const bough_motion *motion, double t);

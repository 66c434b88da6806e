// The aerodynamic loads on one blade as functions of time between two samples.
#ifndef BOUGH_APPS_SIMULATION_AERO_SIGNAL_H
#define BOUGH_APPS_SIMULATION_AERO_SIGNAL_H

#include "apps/bough/model/build.h"

// For a rod: force and moment on each vertex in the body's axes (6 × vertices), then force and moment per
// length along each segment in the axes of its middle, mean and slope (12 × segments). For a modal body:
// the first of these. For a rigid body: the resultant (6).
typedef struct bough_aero_signal bough_aero_signal;

// A rotor's loads on the blade: on vertices (6 × n), mean and slope per length of segments
// (12 × (n − 1)), both in the axes of the blade's frame; their slopes (bough_rotor_data.slope; NULL: none);
// all by a factor.
typedef struct bough_aero_fresh {
    const double *load, *line, *slope;
    double factor;
} bough_aero_fresh;

// A blade's motion, rows as in bough_blade_motion.
typedef struct bough_aero_course {
    const double *before, *now, *next; // at the sample before, now, and as expected at the next
} bough_aero_course;

bough_status bough_aero_signal_build(bough_arena *arena, bough_simulation *simulation,
                                     const bough_beam *beam, bough_aero_signal **signal);

// The loads stay as they are from `start` on. `next` is the motion that they belong to.
void bough_aero_signal_hold(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course,
                            double start);

// They go from what they are now to the fresh ones over the span [s]. A signal that has been held or
// followed before is continuous.
void bough_aero_signal_follow(bough_aero_signal *s, bough_aero_fresh fresh,
                              bough_aero_course course, double start, double span);

// The recent difference between the loads and those at the body's actual motion, relative to the loads; 0 for
// a rod, whose loads follow its motion. About 1: the sampling rate is too low for the body's vibrations,
// which then grow.
double bough_aero_signal_missed(const bough_aero_signal *s);

// All that the signal depends on; restoring gives it to the body.
void bough_aero_signal_snapshot(bough_aero_signal *s, bough_snapshot *snapshot);

#endif

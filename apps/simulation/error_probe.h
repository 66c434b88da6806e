// What the estimated coupling error of the states means for the channels: the difference between a
// channel of the states and of the states without their error, where a batch of the estimate ends.
#ifndef BOUGH_APPS_SIMULATION_ERROR_PROBE_H
#define BOUGH_APPS_SIMULATION_ERROR_PROBE_H

#include "apps/simulation/build.h"

typedef struct bough_error_probe {
    bough_simulation *simulation;
    const bough_channels *channels;
    long batches;       // of the estimate, seen so far
    double *difference; // (channels.count) at the end of the last batch, in the channels' units
    double *largest;    // (channels.count) its largest magnitude so far
    double *low, *high; // (channels.count) the channels' range so far
    const double **own; // (n_member) scratch
    double *state;      // (n_state) scratch
    double *value;      // (channels.count) scratch
} bough_error_probe;

// Takes its memory from the arena. The channels are the simulation's own.
bough_status bough_error_probe_create(bough_arena *arena, bough_simulation *s,
                                      const bough_channels *channels, bough_error_probe *probe);

// After a step; true when a batch has ended and `difference` is new. Changes no result.
bool bough_error_probe_update(bough_error_probe *probe);

// Whether the channel's error is estimated: it follows from the states, and the scheme has one.
bool bough_error_probe_knows(const bough_error_probe *probe, int channel);

// Its largest error relative to its range; NaN for one that keeps its value.
double bough_error_probe_relative(const bough_error_probe *probe, int channel);

#endif

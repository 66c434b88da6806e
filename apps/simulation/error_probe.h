// What the estimated coupling error of the states means for the channels: the difference between a
// channel of the states and of the states without their error, where a batch of the estimate ends.
#ifndef BOUGH_APPS_SIMULATION_ERROR_PROBE_H
#define BOUGH_APPS_SIMULATION_ERROR_PROBE_H

#include "apps/simulation/simulation.h"

typedef struct bough_error_probe {
    bough_simulation *simulation;
    const bough_channels *channels;
    long batches;       // of the estimate, seen so far
    double *difference; // (channels.count) at the end of the last batch, in the channels' units
    double *largest;    // (channels.count) its largest magnitude so far
    double *low, *high; // (channels.count) the channels' range so far
    double *true_low, *true_high; // (channels.count) the same without the error
    double *passed;     // (channels.count) time when `largest` first passed a hundredth of it [s]
    int lost_for;       // updates in a row with an error larger than all ranges
    int *vector;        // (channels.count) first of the channels X, Y, Z that it is one of
    double **own;        // (n_member) scratch
    double *state;      // (n_state) scratch
    double *input;      // (n_input) scratch
    double *value;      // (channels.count) scratch
} bough_error_probe;

// Takes its memory from the arena. The channels are the simulation's own.
bough_status bough_error_probe_create(bough_arena *arena, bough_simulation *s,
                                      const bough_channels *channels, bough_error_probe *probe);

// After a step; true when a batch has ended and `difference` is new. Changes no result.
bool bough_error_probe_update(bough_error_probe *probe);

// Takes recorded values (channels.count) into the ranges.
void bough_error_probe_widen(bough_error_probe *probe, const double *value);

// Whether the channel's error is estimated: it follows from the states, and the scheme has one.
bool bough_error_probe_knows(const bough_error_probe *probe, int channel);

// Its largest error relative to its range; NaN for one that keeps its value. The components of a vector
// have one range, the largest of theirs.
double bough_error_probe_relative(const bough_error_probe *probe, int channel);

// What the errors mean for the run. Channels that hardly move, by less than a thousandth of what the
// others with their unit do, have no say: a relative error of next to nothing is none.
typedef struct bough_error_verdict {
    int channel;     // with the largest relative error of those that are estimated; −1: none is
    double relative; // that error
    double time;     // when it began to be noticeable [s]
    int unknown;     // channels of the states without an estimate
} bough_error_verdict;

bough_error_verdict bough_error_probe_verdict(const bough_error_probe *probe);

// Of each channel the first of the vector X, Y, Z that it is a component of: vector (channels.count).
void bough_error_probe_find_vectors(const bough_channels *channels, int *vector);

// Counts how long the errors have been hopeless, after an update.
void bough_error_probe_watch(bough_error_probe *probe);

// Notes which errors are noticeable now, at t [s].
void bough_error_probe_mark(bough_error_probe *probe, double t);

// Whether the errors have for some time been larger than anything that moves: the run need not go on.
bool bough_error_probe_hopeless(const bough_error_probe *probe);

// One sentence for what is below the bound and yet worth a warning, "" for nothing: text (size).
void bough_error_probe_warn(const bough_error_probe *probe, double bound, char *text, size_t size);

// BOUGH_FAILED, with channel, time, cause and what would hold, when a relative error is beyond the
// bound [1]; 0: there is none.
bough_status bough_error_probe_judge(const bough_error_probe *probe, double bound);

#endif

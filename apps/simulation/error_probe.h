// The estimated error of the channels: the difference between a channel of the states and the same channel
// of the states without their estimated error, at the end of each batch of the estimate.
#ifndef BOUGH_APPS_SIMULATION_ERROR_PROBE_H
#define BOUGH_APPS_SIMULATION_ERROR_PROBE_H

#include "apps/simulation/simulation.h"

// Judgement of the errors of motion. Channels that hardly move, by less than a thousandth of other channels
// with the same unit (directions count as angles), are left out, because their relative error has no meaning.
typedef struct bough_error_verdict {
    int channel;     // with the largest relative error of those that are estimated; −1: none is
    double relative; // that error
    double time;     // when it began to be noticeable [s]
    int unknown;     // channels of the states without an estimate
} bough_error_verdict;

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
    bough_error_verdict last; // of the last update with an estimate
    double last_error;        // of its channel, in the channel's unit
    int *vector;        // (channels.count) first of the channels X, Y, Z that it is one of
    double **own;        // (n_member) scratch
    double *state;      // (n_state) scratch
    double *input;      // (n_input) scratch
    double *value;      // (channels.count) scratch
} bough_error_probe;

// Takes its memory from the arena. The channels are the simulation's own. `second` is the model beside it, or
// NULL.
bough_status bough_error_probe_create(bough_arena *arena, bough_simulation *s, bough_simulation *second,
                                      const bough_channels *channels, bough_error_probe *probe);

// After a step; true when a batch has ended and `difference` is new. Changes no result.
bool bough_error_probe_update(bough_error_probe *probe);

// Takes recorded values (channels.count) into the ranges.
void bough_error_probe_widen(bough_error_probe *probe, const double *value);

// Whether the channel's error is estimated: it follows from the states, and the scheme has one.
bool bough_error_probe_knows(const bough_error_probe *probe, int channel);

// An error of the channel, in its unit, relative to its range; NaN for one that keeps its value. The components
// of a vector have one range, the largest of theirs.
double bough_error_probe_relative(const bough_error_probe *probe, int channel, double error);

bough_error_verdict bough_error_probe_verdict(const bough_error_probe *probe);

// The same of errors (n_motion_channel) from elsewhere, in the channels' units; `time` says nothing then.
bough_error_verdict bough_error_probe_verdict_of(const bough_error_probe *probe, const double *error);

// The error relative to the channel's range from which on a run warns.
#define BOUGH_ERROR_NOTICEABLE 0.01

// The same of forces and moments, which the bound does not judge.
bough_error_verdict bough_error_probe_force_verdict(const bough_error_probe *probe);

// Of each channel the first of the vector X, Y, Z that it is a component of: vector (channels.count).
void bough_error_probe_find_vectors(const bough_channels *channels, int *vector);

// Counts the steps with errors of several times the range, after an update.
void bough_error_probe_watch(bough_error_probe *probe);

// Notes which errors are noticeable now, at t [s].
void bough_error_probe_mark(bough_error_probe *probe, double t);

// Whether the errors have been several times the range for so many steps that the run should end.
bool bough_error_probe_hopeless(const bough_error_probe *probe);

enum { BOUGH_ERROR_WARNING = 600 };

// A warning about an error of motion below the bound, or that errors are not known any more, or "".
void bough_error_probe_warn(const bough_error_probe *probe, double bound, char text[BOUGH_ERROR_WARNING]);

// A warning about a force or moment with an error above the bound [1], or ""; 0: no bound.
void bough_error_probe_warn_of_force(const bough_error_probe *probe, double bound,
                                     char text[BOUGH_ERROR_WARNING]);

// BOUGH_FAILED, with channel, time, cause and settings to try, when the relative error of a motion exceeds
// the bound [1], or did so when it was last known; 0: no bound.
bough_status bough_error_probe_judge(const bough_error_probe *probe, double bound);

#endif

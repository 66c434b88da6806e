// What a run's loads come to, sample by sample, in memory that does not grow with time: statistics,
// cycles, time at levels, and the extremes of every channel with all others at that moment.
#ifndef BOUGH_APPS_CASES_COUNTS_H
#define BOUGH_APPS_CASES_COUNTS_H

#include "apps/bough/cases/rainflow.h"
#include "apps/bough/results/recorder.h"
#include "core/base/arena.h"

// Of one channel. The two rows hold the extremes in the channel's own place.
typedef struct bough_channel_counts {
    bough_sample_statistics statistics;
    bough_rainflow rainflow;
    bough_levels levels;        // samples at each level
    double *at_least, *at_most; // (n_channel) all channels when it was least and largest
} bough_channel_counts;

typedef struct bough_counts {
    int n_channel;
    bough_channel_counts *channel; // (n_channel)
    double broken;                 // samples left out because a value was not finite
} bough_counts;

// Counts for n channels and the slopes (n_slope ≤ BOUGH_MOST_SLOPES), empty.
void bough_counts_take(bough_arena *arena, int n_channel, int n_slope, const double *slope,
                       bough_counts *counts);

// Takes the values (n_channel) at t [s].
void bough_counts_add(bough_counts *counts, double t, const double *value);

// Ends the cycles that are still open.
void bough_counts_finish(bough_counts *counts);

#endif

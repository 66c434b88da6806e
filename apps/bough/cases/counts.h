// What a run's loads come to, sample by sample, in memory that does not grow with time: statistics,
// cycles, time at levels, and the extremes of every channel with all others at that moment.
#ifndef BOUGH_APPS_CASES_COUNTS_H
#define BOUGH_APPS_CASES_COUNTS_H

#include "apps/bough/results/recorder.h"
#include "core/base/arena.h"

#include <stdbool.h>
#include <stdint.h>

// -- levels ---------------------------------------------------------------------------------------

// How long a quantity stays between levels and how often it crosses each upwards, and how many
// cycles have which range: bins whose width is a power of two and whose edges are its multiples. As
// the values spread, pairs of bins become one, so the memory is fixed, and the bins follow from the
// least and the largest value alone: counts of parts that are added are those of the whole.

enum { BOUGH_LEVELS = 128 };

// All zero: nothing is counted yet.
typedef struct bough_levels {
    bool started;
    int exponent;                 // of the width, 2^exponent in the quantity's unit
    int64_t low, high;            // bins in use, at most BOUGH_LEVELS; bin k is [k, k + 1) widths
    double inside[BOUGH_LEVELS];  // counts in bin k, at k modulo BOUGH_LEVELS
    double crossed[BOUGH_LEVELS]; // upward crossings of the lower edge of bin k
    double last;                  // the value before
} bough_levels;

// The place of a bin in the counts.
static inline int bough_levels_slot(int64_t bin) {
    return (int)(((bin % BOUGH_LEVELS) + BOUGH_LEVELS) % BOUGH_LEVELS);
}

// Adds `count` in the bin of x, and no crossing.
void bough_levels_add(bough_levels *levels, double x, double count);

// Adds 1 in the bin of x, and the crossings on the way from the value before.
void bough_levels_follow(bough_levels *levels, double x);

// Adds the counts of `part`: those in bins times `inside`, its crossings times `crossed`.
void bough_levels_merge(bough_levels *levels, const bough_levels *part, double inside, double crossed);

double bough_levels_width(const bough_levels *levels);
double bough_levels_inside(const bough_levels *levels, int64_t bin);
double bough_levels_crossed(const bough_levels *levels, int64_t bin);

// -- rainflow -------------------------------------------------------------------------------------

// Rainflow counting, sample by sample: ASTM E1049-85 (2017), 5.4.4, "Rules for rainflow counting".
//
// The memory is fixed: the standard's open ranges always decrease, and where there are more of them
// than fit, the two points of the smallest are counted as one cycle at once.

enum { BOUGH_RAINFLOW_OPEN = 200, BOUGH_MOST_SLOPES = 6 };

// All zero but for the slopes: nothing is counted yet.
typedef struct bough_rainflow {
    int n_slope;
    double slope[BOUGH_MOST_SLOPES];  // exponents m of the S-N curves [-]
    double damage[BOUGH_MOST_SLOPES]; // Σ n Sᵐ over the cycles n of range S
    double cycles;                    // n in all, in halves
    bough_levels ranges;              // cycles by their range
    double forced;                    // cycles counted early for want of memory
    int direction;                    // of the last sample: −1, 0 before there is one, 1
    double last;                      // the latest sample, perhaps no turning point
    int n;
    double point[BOUGH_RAINFLOW_OPEN]; // (n) turning points whose ranges are open
    bool started;
} bough_rainflow;

// Takes the next sample, a finite number.
void bough_rainflow_add(bough_rainflow *r, double x);

// Ends the count: the ranges that are still open are half cycles. Nothing may be added after it.
void bough_rainflow_finish(bough_rainflow *r);

// The range that, `cycles` times repeated, does the damage `sum` = Σ n Sᵐ: (sum/cycles)^(1/m).
double bough_equivalent_load(double sum, double slope, double cycles);

// -- a run ----------------------------------------------------------------------------------------

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

// Statistics of the loads of a run, sample by sample in memory of constant size: moments, load cycles, time
// at levels, and the extremes of every channel with the simultaneous values of all others.
#pragma once

#include "apps/bough/results/recorder.h"

// -- levels ---------------------------------------------------------------------------------------

// How long a quantity stays between levels and how often it crosses each upwards, or how many cycles have
// which range: bins whose width is a power of two and whose edges are its multiples. As the range of the
// values grows, pairs of bins are merged, so that the memory is constant and the bins follow from the
// smallest and the largest value alone: added counts of parts are those of all values together.

enum { BOUGH_LEVELS = 128 };

// All zero: empty.
typedef struct bough_levels {
    bool started;
    int exponent;                 // of the width, 2^exponent in the quantity's unit
    int64_t low, high;            // bins in use, at most BOUGH_LEVELS; bin k is [k, k + 1) widths
    double inside[BOUGH_LEVELS];  // counts in bin k, at k modulo BOUGH_LEVELS
    double crossed[BOUGH_LEVELS]; // upward crossings of the lower edge of bin k
    double last;                  // the previous value
} bough_levels;

// The place of a bin in the counts.
static inline int bough_levels_slot(int64_t bin) {
    return (int)(((bin % BOUGH_LEVELS) + BOUGH_LEVELS) % BOUGH_LEVELS);
}

// Adds `count` in the bin of x, and no crossing.
void bough_levels_add(bough_levels *levels, double x, double count);

// Adds 1 in the bin of x, and the crossings between the previous value and x.
void bough_levels_follow(bough_levels *levels, double x);

// Adds the counts of `part`: those in bins times `inside`, its crossings times `crossed`.
void bough_levels_merge(bough_levels *levels, const bough_levels *part, double inside, double crossed);

double bough_levels_width(const bough_levels *levels);
double bough_levels_inside(const bough_levels *levels, int64_t bin);
double bough_levels_crossed(const bough_levels *levels, int64_t bin);

// -- rainflow -------------------------------------------------------------------------------------

// Rainflow counting, sample by sample: ASTM E1049-85 (2017), 5.4.4, "Rules for rainflow counting".
//
// The memory is constant: the open ranges of the standard always decrease, and if there are more than fit,
// the smallest one is counted as a cycle at once.

enum { BOUGH_RAINFLOW_OPEN = 200, BOUGH_MOST_SLOPES = 6 };

// All zero except the slopes: empty.
typedef struct bough_rainflow {
    int n_slope;
    double slope[BOUGH_MOST_SLOPES];  // exponents m of the S-N curves [-]
    double damage[BOUGH_MOST_SLOPES]; // Σ n Sᵐ over the cycles n of range S
    double cycles;                    // n in all, in halves
    double forced;                    // of them counted early to limit the memory
    bough_levels ranges;              // cycles by their range
    int direction;                    // of the last change: −1, 1, or 0 before the first
    double last;                      // the last sample, not necessarily a reversal
    int n;
    double point[BOUGH_RAINFLOW_OPEN]; // (n) reversals whose ranges are open
    bool started;
} bough_rainflow;

// Takes the next sample, a finite number.
void bough_rainflow_add(bough_rainflow *r, double x);

// Ends the count: open ranges become half cycles. Nothing may be added afterwards.
void bough_rainflow_finish(bough_rainflow *r);

// Range of a load that does the damage `sum` = Σ n Sᵐ in `cycles` cycles: (sum/cycles)^(1/m).
double bough_equivalent_load(double sum, double slope, double cycles);

// -- a run ----------------------------------------------------------------------------------------

// Counts of one channel. Its extremes stand in both rows at its own index.
typedef struct bough_channel_counts {
    bough_sample_statistics statistics;
    bough_rainflow rainflow;
    bough_levels levels;        // samples at each level
    double *at_least, *at_most; // (n_channel) all channels at its minimum and its maximum
} bough_channel_counts;

typedef struct bough_counts {
    int n_channel;
    bough_channel_counts *channel; // (n_channel)
    double broken;                 // samples that are left out, since a value is not finite
} bough_counts;

// Counts for n channels and the slopes (n_slope ≤ BOUGH_MOST_SLOPES), empty.
void bough_counts_take(bough_arena *arena, int n_channel, int n_slope, const double *slope,
                       bough_counts *counts);

// Takes the values (n_channel) at t [s].
void bough_counts_add(bough_counts *counts, double t, const double *value);

// Counts the ranges that are still open.
void bough_counts_finish(bough_counts *counts);

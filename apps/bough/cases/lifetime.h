// Loads of all cases of a load set over the turbine's lifetime. The cases are summed in their order, so
// that the result is the same to the bit, whichever process has run which case.
#ifndef BOUGH_APPS_CASES_LIFETIME_H
#define BOUGH_APPS_CASES_LIFETIME_H

#include "apps/bough/cases/case_run.h"

// The extreme of a channel whose design value, `factor` times the characteristic one, is the most extreme of
// all cases. Forces and moments alone have a factor; it is the load case's `favourable` where it would else
// take the value away from zero although nothing goes beyond: for a smallest above zero and a largest below.
typedef struct bough_extreme {
    bool found;
    double value;  // characteristic: as the run has it, in the channel's unit
    double factor; // [-]
    double range;  // of the channel in that case
    double at;     // [s]
    int number;    // of its case
    double *row;   // (n_channel) all channels at that moment, characteristic
} bough_extreme;

typedef struct bough_lifetime_channel {
    double damage[BOUGH_MOST_SLOPES]; // Σ n Sᵐ over the life
    double cycles;
    bough_levels ranges; // cycles by their range
    bough_levels levels; // hours at each level, upward crossings
    bough_extreme least, most;
    // Σ n Sᵐ over the life of the cases with a companion, and with their equivalent loads larger by their
    // errors
    double compared[BOUGH_MOST_SLOPES], larger[BOUGH_MOST_SLOPES];
} bough_lifetime_channel;

// Sums over cases with a companion, of one channel.
typedef struct bough_extreme_errors {
    double range, least, most; // of the squares of range, error of the smallest and of the largest value
} bough_extreme_errors;

typedef struct bough_lifetime {
    const bough_study *study;
    bough_lifetime_channel *channel; // (n_channel)
    int n_failed, n_missing;         // cases
    double hours;                    // of the life that are in the sums
    double total;                    // hours and events of all cases
    double lacking;                  // share of the cases' weight that failed or is missing
    double simulated, cpu;           // of all runs [s]
    int *n_compared;                 // (n_group + 1) cases with a companion of each load case; last of all
    bough_extreme_errors *errors;    // (n_group + 1, n_channel) likewise
} bough_lifetime;

bough_lifetime bough_lifetime_take(bough_arena *arena, const bough_study *study);

// Adds the next case. A result that is not done counts as missing.
void bough_lifetime_add(bough_lifetime *l, int number, const bough_case_result *result);

// Damage-equivalent load of a channel over the life, for the k-th slope.
double bough_lifetime_equivalent(const bough_lifetime *l, int channel, int slope);

// Its error: the cases with a companion stand for all. NaN: not known.
double bough_lifetime_equivalent_error(const bough_lifetime *l, int channel, int slope);

// How far a characteristic extreme of the channel, its least or its most, may be from the truth. The cases
// with a companion of its load case stand for it, or all where that has none: root mean square of their
// errors, relative to the range. NaN: not known.
double bough_lifetime_extreme_error(const bough_lifetime *l, int channel, const bough_extreme *e);

#endif

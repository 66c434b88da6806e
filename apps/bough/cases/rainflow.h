// Rainflow counting, sample by sample: ASTM E1049-85 (2017), 5.4.4, "Rules for rainflow counting".
//
// The memory is fixed: the standard's open ranges always decrease, and where there are more of them
// than fit, the two points of the smallest are counted as one cycle at once.
#ifndef BOUGH_APPS_CASES_RAINFLOW_H
#define BOUGH_APPS_CASES_RAINFLOW_H

#include "apps/bough/cases/levels.h"

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

#endif

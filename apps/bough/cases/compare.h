// Differences of runs at their common output times.
#ifndef BOUGH_APPS_CASES_COMPARE_H
#define BOUGH_APPS_CASES_COMPARE_H

#include "apps/bough/cases/study.h"

// Values of the study's channels at the common output times 0, interval, 2 interval, …
typedef struct bough_study_series {
    int n_row, n_channel;
    int filled;    // rows sampled so far
    double *value; // (n_row × n_channel)
} bough_study_series;

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study);

// The largest difference of each measure between the two series: error (n_measure).
void bough_study_compare(const bough_study *study, const bough_study_series *series,
                         const bough_study_series *reference, double *error);

// Each measure's norm of the values (n_channel) of the study's channels: norm (n_measure).
void bough_study_norms(const bough_study *study, const double *value, double *norm);

#endif

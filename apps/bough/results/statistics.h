// Minimum, maximum, mean and standard deviation of a sampled quantity, sample by sample.
//
// B. P. Welford, "Note on a method for calculating corrected sums of squares and products",
// Technometrics 4 (1962).
#ifndef BOUGH_OUTPUT_STATISTICS_H
#define BOUGH_OUTPUT_STATISTICS_H

// All zero: no sample yet.
typedef struct bough_sample_statistics {
    double n; // samples
    double mean;
    double squares;           // Σ (x − mean)²
    double least, most;       // of all samples
    double least_at, most_at; // when each was reached first [s]
} bough_sample_statistics;

void bough_sample_statistics_add(bough_sample_statistics *s, double t, double x);

// The standard deviation of the samples about their mean, √(Σ (x − mean)²/n); NaN without samples.
double bough_sample_statistics_deviation(const bough_sample_statistics *s);

#endif

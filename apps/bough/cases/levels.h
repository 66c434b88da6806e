// How long a quantity stays between levels and how often it crosses each upwards, and how many
// cycles have which range: bins whose width is a power of two and whose edges are its multiples. As
// the values spread, pairs of bins become one, so the memory is fixed, and the bins follow from the
// least and the largest value alone: counts of parts that are added are those of the whole.
#ifndef BOUGH_APPS_CASES_LEVELS_H
#define BOUGH_APPS_CASES_LEVELS_H

#include <stdbool.h>
#include <stdint.h>

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

// Adds `count` in the bin of x, and no crossing.
void bough_levels_add(bough_levels *levels, double x, double count);

// Adds 1 in the bin of x, and the crossings on the way from the value before.
void bough_levels_follow(bough_levels *levels, double x);

// Adds the counts of `part`: those in bins times `inside`, its crossings times `crossed`.
void bough_levels_merge(bough_levels *levels, const bough_levels *part, double inside, double crossed);

double bough_levels_width(const bough_levels *levels);
double bough_levels_inside(const bough_levels *levels, int64_t bin);
double bough_levels_crossed(const bough_levels *levels, int64_t bin);

#endif

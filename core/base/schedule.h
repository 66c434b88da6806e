// Factors of loads and of the air over time: a ramp or a table.
#pragma once

// 0 before start, 1 after end, linear between. A ramp without length is a jump from 0 to 1 at its time; with
// both times 0 it is always 1.
double bough_ramp_factor(double start, double end, double t);

// The row `low` of n > 1 with times[low] <= t < times[low + 1]; `stride` from one time to the next. For t
// between the first and the last time.
int bough_table_row(int n, const double *times, int stride, double t);

// The value of a table (n rows, times increasing), linear between its times and held outside.
double bough_table_value(int n, const double *times, const double *values, double t);

typedef struct bough_schedule {
    double start, end;            // of a ramp [s]
    int n;                        // rows of a table in place of the ramp, 0: none
    const double *times, *values; // (n) times increasing [s]; borrowed
} bough_schedule;

double bough_schedule_at(const bough_schedule *s, double t);

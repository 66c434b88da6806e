// bough modes --sweep: the modes of the whole scene over a list of operating points, as a table and a
// Campbell diagram.
#ifndef BOUGH_APPS_BOUGH_MODES_SWEEP_H
#define BOUGH_APPS_BOUGH_MODES_SWEEP_H

#include "apps/bough/cli/options.h"

enum { BOUGH_SWEEP_LABEL = 64 };

// One mode at one point.
typedef struct bough_sweep_mode {
    int point, line; // a line joins what is the same mode of neighbouring points
    double frequency, damped, damping, growth;
    char body[32], shape[16], pattern[16];
} bough_sweep_mode;

typedef struct bough_sweep {
    int n_key, n_point;
    const char **key;   // (n_key)
    const char **value; // (n_key × n_point) as written
    double *x, *speed;  // (n_point) of the first key, else its place in the list;
                        // of the rotor [rpm]
    int n_mode, n_line;
    bough_sweep_mode *mode; // (n_mode) point after point
} bough_sweep;

// Solves every point and writes campbell.csv and campbell.svg.
bough_status bough_modes_sweep(bough_arena *arena, const bough_options *options);

// The picture of a bough_sweep (modes_plot.c).
void bough_modes_plot(const void *sweep, FILE *svg);

#endif

// What the files of `bough modes` share.
#pragma once

#include "apps/bough/analysis/sensitivity.h"
#include "apps/bough/analysis/vibration.h"
#include "apps/bough/cli/command.h"

// Solves every point of --sweep and writes campbell.csv and campbell.svg. `until_unstable`: ends at the
// first point at which an oscillation grows, or a divergence where the rotor is not free, and finds where the
// growth begins between this point and the one before.
bough_status bough_modes_sweep(bough_arena *arena, const bough_options *options, const bough_texts *sweeps,
                               bool until_unstable);

// Sensitivities of a mode.
typedef struct bough_modes_dependence {
    int mode; // index among the modes found; −1: none
    bough_sensitivities of;
} bough_modes_dependence;

// Prints it and writes sensitivity.csv. `wanted` is the mode's number, or words of its row, with a number
// behind them if several rows have these words.
bough_status bough_modes_sensitivity(bough_arena *arena, bough_simulation *s, const bough_vibration *v,
                                     const char *wanted, const char *folder, bough_modes_dependence *found);

// Whether nothing but inertia holds the rotor's joint.
bool bough_modes_rotor_is_free(const bough_simulation *s);

// The body with the largest motion in a mode, and the kind of motion.
const char *bough_modes_body(const bough_simulation *s, const bough_scene_mode *mode);
const char *bough_modes_shape(const bough_simulation *s, const bough_scene_mode *mode);

// Frequency, damped frequency, damping ratio and logarithmic decrement, of a row of the table and of a file.
void bough_modes_print_value(double frequency, double damped_frequency, double damping);
void bough_modes_write_value(FILE *file, double frequency, double damped_frequency, double damping);

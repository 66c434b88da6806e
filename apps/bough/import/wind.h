// Wind of other programs as a box: files in the style of Bladed (.wnd with its .sum), and the three files of
// HAWC's Mann generator; and how an imported scene names them.
#pragma once

#include "aero/wind/wind_box.h"
#include "apps/bough/import/draft.h"

// Reads NAME.wnd, given with or without its ending, and NAME.sum beside it, as TurbSim writes them:
// the old head or the new one of models 1 to 8, one or three components. BOUGH_INVALID says what is
// wrong with which file.
bough_status bough_wind_bladed_read(bough_arena *arena, const char *path, bough_wind_box *box);

// How the mean wind grows with the height in a HAWC field.
typedef enum bough_hawc_profile {
    BOUGH_HAWC_CONSTANT,
    BOUGH_HAWC_LOG,
    BOUGH_HAWC_POWER,
} bough_hawc_profile;

typedef struct bough_hawc_def {
    const char *file[3];        // of u, v, w: float32, x slowest, z fastest
    int nx, ny, nz;             // points
    double dx, dy, dz;          // between them [m]
    double height;              // of the middle of the grid, and of the mean speed [m]
    double mean;                // [m/s]
    int profile;                // bough_hawc_profile
    double exponent;            // of the power law
    double roughness;           // of the logarithmic law [m]
    int scaling;                // 0: none, 1: by `factor`, 2: to the deviation `sigma` in the middle
    double factor[3], sigma[3]; // [-], [m/s]
} bough_hawc_def;

bough_status bough_wind_hawc_read(bough_arena *arena, const bough_hawc_def *def, bough_wind_box *box);

// -- files of wind in an imported scene: their form, and how the scene names them -----------------

typedef enum bough_wind_form {
    BOUGH_WIND_UNIFORM_FILE, // rows over time
    BOUGH_WIND_TURBSIM,      // a box
    BOUGH_WIND_BLADED,       // another, with a .sum beside it
} bough_wind_form;

// The form of a file by how it begins.
bough_wind_form bough_wind_form_of(const char *path);

// Reads the file to check it and writes the beginning of the scene's `wind` without the closing brace. Height
// of the hub and diameter of the rotor [m] are used for files of rows. BOUGH_INVALID says what is wrong with
// the file; nothing is then written.
bough_status bough_wind_given(bough_draft *d, bough_wind_form form, const char *path, double height,
                              double diameter);

// The same for a box that was converted from other files; `path` is the first of them.
void bough_wind_made(bough_draft *d, const bough_wind_box *box, const char *path);

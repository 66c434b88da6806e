// Turbulent wind of other programs as a box: files in the style of Bladed (.wnd with its .sum), and
// the three files of HAWC's Mann generator.
#ifndef BOUGH_IMPORT_WIND_CONVERT_H
#define BOUGH_IMPORT_WIND_CONVERT_H

#include "aero/wind/wind_box.h"

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

#endif

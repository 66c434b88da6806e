// Wind from a hub-height file (`.wnd`): a table over time of speed, direction, shears, gust and upflow,
// the same everywhere at one time.
#pragma once

#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/base/vec3.h"

// One row, linear between rows, constant outside.
typedef struct bough_wind_hub_row {
    double time;             // [s]
    double speed;            // horizontal, at the reference height [m/s]
    double direction;        // from where, clockwise seen from above; 0: blows along x [rad]
    double vertical;         // upwards [m/s]
    double horizontal_shear; // linear across the wind, per reference length [-]
    double exponent;         // of the power law [-]
    double vertical_shear;   // linear, per reference length [-]
    double gust;             // added everywhere [m/s]
    double upflow;           // angle of the whole wind [rad]
} bough_wind_hub_row;

typedef struct bough_wind_hub {
    double reference_height; // [m]
    double reference_length; // of the linear shears, the rotor's diameter [m]
    int n;
    const bough_wind_hub_row *row; // (n)
} bough_wind_hub;

// Reads a file: lines that start with ! are comments, the others have 8 or 9 numbers, angles in
// degrees. BOUGH_INVALID names file and line.
bough_status bough_wind_hub_read(bough_arena *arena, const char *path, bough_wind_hub *hub);

bough_vec3 bough_wind_hub_at(const bough_wind_hub *hub, bough_vec3 position, double t);

// Turbulent wind from a TurbSim full-field file (`.bts`): a box of velocities over time, height and
// breadth that the mean wind carries past the rotor unchanged (Taylor).
//
// The file, little-endian: int16 7, or 8 if it repeats; int32 points over height and breadth, tower
// points, times; float32 distance in height and breadth [m], time step [s], mean speed [m/s], hub
// height, height of the lowest point [m], slope and offset of u, v, w; int32 n and n characters;
// int16 velocities, (value − offset)/slope in m/s: for every time u, v, w at every point of the
// grid, breadth fastest, then at the tower points from below the grid downwards.
#pragma once

#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/base/vec3.h"

typedef struct bough_wind_box {
    bool periodic;
    int n_z, n_y, n_tower, n_time;
    double dz, dy, dt;          // [m], [m], [s]
    double mean;                // speed with which the box passes [m/s]
    double hub, bottom;         // heights [m]
    double duration;            // of the table; when periodic until it begins again [s]
    double half_width;          // [m]; y = 0 in the middle
    double scale[3], offset[3]; // velocity = (value − offset)·scale
    const int16_t *value;       // (n_time × (n_z·n_y + n_tower) × 3)
} bough_wind_box;

// Reads a file. BOUGH_INVALID: the message states its fault; its size is compared with that in its
// header before anything is allocated.
bough_status bough_wind_box_read(bough_arena *arena, const char *path, bough_wind_box *box);

// Writes it as such a file with a line of text; false when the stream refused.
bool bough_wind_box_write(const bough_wind_box *box, const char *text, FILE *stream);

// Whether the box passes x = 0 until that time [s]: always when it repeats.
bool bough_wind_box_lasts(const bough_wind_box *box, double until);

// The velocity [m/s], linear in time and place. At t = 0 the first times are at x = 0 if the box
// repeats, else half a width downwind, as in InflowWind. Outside the grid the value of its edge;
// below it that of the tower points, if there are any.
bough_vec3 bough_wind_box_at(const bough_wind_box *box, bough_vec3 position, double t);

// Undisturbed wind: along global +x, constant in time, with an optional power-law shear.
#ifndef BOUGH_AERO_WIND_H
#define BOUGH_AERO_WIND_H

#include "core/vec3.h"

typedef struct bough_wind_def {
    double speed;            // at the reference height [m/s]
    double shear_exponent;   // 0: uniform [-]
    double reference_height; // above z = 0; used only with shear [m]
} bough_wind_def;

// 0 m/s, uniform, reference height 90 m.
bough_wind_def bough_wind_def_default(void);

// The wind at a point in global axes (z up) and a time [s]; nothing at or below the ground when
// sheared.
bough_vec3 bough_wind_at(const bough_wind_def *wind, bough_vec3 position, double t);

#endif

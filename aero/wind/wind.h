// Undisturbed wind: one direction everywhere, sheared over the height, its speed constant or a
// table over time, in which the wind changes everywhere at once; or a wind file; or a condition of
// IEC 61400-1. Any of them may be inclined and veer with the height.
#pragma once

#include "aero/wind/wind_box.h"
#include "aero/wind/wind_hub.h"
#include "aero/wind/wind_iec.h"
#include "core/base/arena.h"
#include "core/base/status.h"
#include "core/base/vec3.h"

typedef enum bough_wind_source {
    BOUGH_WIND_FORMULA,
    BOUGH_WIND_HUB_FILE, // .wnd
    BOUGH_WIND_BOX_FILE, // .bts
    BOUGH_WIND_STANDARD, // by name, of IEC 61400-1
} bough_wind_source;

// How the horizontal speed grows with the height above z = 0.
typedef enum bough_wind_shear {
    BOUGH_WIND_UNIFORM,
    BOUGH_WIND_POWER, // (z/z_ref)^exponent
    BOUGH_WIND_LOG,   // ln(z/z_0)/ln(z_ref/z_0), nothing below the roughness length z_0
} bough_wind_shear;

typedef struct bough_wind_def {
    double speed;     // horizontal, at the reference height [m/s]
    double vertical;  // upwards, everywhere and always [m/s]
    double direction; // where it blows to, from x about z [rad]
    bough_wind_shear shear;
    double exponent;         // of the power law [-]
    double roughness;        // length, of the logarithmic law [m]
    double reference_height; // above z = 0; used only with shear [m]
    // In place of the speed, linear between and constant outside; n_time = 0 for none.
    int n_time;
    const double *time;          // (n_time) increasing [s]
    const double *speed_at_time; // (n_time) at the reference height [m/s]
    // In place of all but the direction, about which the wind of the file is rotated.
    bough_wind_source source;
    const char *file;
    double reference_length;   // of the linear shears of a hub file [m]
    double until;              // how long a box must last [s]
    bough_wind_iec_def iec;    // source STANDARD
    const bough_wind_box *box; // of another wind of the same definition, shared; NULL: one of its own
    // Of any source: the whole wind inclined upwards, and rotated about the vertical with the height,
    // clockwise seen from above, about that of the reference or of a box's hub.
    double upflow; // [rad]
    double veer;   // [rad/m]
} bough_wind_def;

// 0 m/s along x, uniform, reference height 90 m; 0.2 and 0.03 m if sheared.
bough_wind_def bough_wind_def_default(void);

typedef struct bough_wind {
    bough_wind_def def; // its tables are the model's own
    double along_x, along_y;
    double shear_scale;        // of the logarithmic law: 1/ln(z_ref/z_0)
    const bough_wind_hub *hub; // NULL: no such file
    const bough_wind_box *box; // likewise; or turbulence of the standard
    const bough_wind_iec *iec; // a condition without turbulence
    double up_x, up_z;         // cosine and sine of the upflow
    double level;              // height without veer [m]
} bough_wind;

bough_status bough_wind_build(bough_arena *arena, const bough_wind_def *def, bough_wind *wind);

// Whether a wind of a box is known all over a disk of that radius across it [m].
bool bough_wind_covers(const bough_wind *wind, bough_vec3 centre, double radius);

// When a box that does not repeat passes a place, time[2] [s]; all times of another wind.
void bough_wind_passes(const bough_wind *wind, bough_vec3 place, double time[2]);

// The part of a table or a hub-height file that samples at equal times miss, because the wind may rise and
// fall between two of them. Zero for other winds.
typedef struct bough_wind_missed {
    double speed; // the furthest that a component of the wind goes beyond both samples around it [m/s]
    double time;  // of that [s]
    double range; // of a component over all times [m/s]
} bough_wind_missed;

// Of samples from time 0 on, a period apart [s], up to a time [s].
bough_wind_missed bough_wind_between(const bough_wind *wind, double period, double until);

// The row of a table or a hub-height file from which the wind jumps, from a row on: by more than a tenth of
// the higher speed at the reference height, to the next row, less than a period [s] away, with no other row
// less than a period before or after. -1: none.
int bough_wind_jump(const bough_wind *wind, double period, int row);

// Time of a row of the table or the hub-height file [s].
double bough_wind_row_time(const bough_wind *wind, int row);

// The wind at a point in global axes (z up) and a time [s].
bough_vec3 bough_wind_at(const bough_wind *wind, bough_vec3 position, double t);

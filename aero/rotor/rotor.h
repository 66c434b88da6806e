// Aerodynamic loads on the deformed, moving blades of a rotor: blade element momentum theory at
// the aero stations, mapped to the vertices of the structural mesh conserving force and moment.
//
// Axes. Ground: x downwind, z up. Blade root: z along the span, x flapwise (downwind at zero
// pitch), y edgewise (towards the trailing edge). The rotor rotates about +shaft (downwind), that
// is clockwise seen from upwind. The rotor is sampled at one time; holding and ramping the loads
// between samples is the caller's.
#pragma once

#include "aero/rotor/induction.h"
#include "aero/rotor/polar.h"
#include "aero/rotor/stall.h"
#include "aero/rotor/tower.h"
#include "aero/wind/wind.h"
#include "core/base/arena.h"
#include "core/base/snapshot.h"
#include "core/base/spatial.h"
#include "core/base/status.h"

// One row of the aerodynamic blade table (undeformed blade).
typedef struct bough_station_def {
    double span;     // along the reference axis from the root [m]
    double chord;    // [m]
    double twist;    // about the axis of the structure, positive: leading edge into the wind [rad]
    double centre_x; // aerodynamic centre in blade-root axes, flapwise [m]
    double centre_y; //   and edgewise [m]; its z is that of the reference axis at `span`
    int polar;       // index into the rotor's polars
    int second;      // of a second polar …
    double share;    // … and its weight in the coefficients, 0 to 1
} bough_station_def;

typedef struct bough_rotor_def {
    int n_blade;
    double density;    // of air [kg/m³]
    double hub_radius; // from the shaft axis to the blade roots [m]
    bool pitching_moment;
    bool skew;   // Pitt–Peters correction of the axial induction
    bool slopes; // derivatives of the loads by the vertices' motion are computed
    bough_induction_options induction;
    bough_inflow_def inflow;
    bough_stall_kind stall;
    bough_wind_def wind;
    bough_tower_def tower;

    int n_polar;
    const bough_polar_def *polar; // (n_polar)
    bool smooth_polars;           // monotone cubics in place of straight lines
    int n_station;
    const bough_station_def *station; // (n_station) increasing in span, the last one is the tip

    // The structural mesh of one blade, undeformed, in blade-root axes. Sections may or may not
    // include the structural twist; the aero twist is counted from the root axes.
    int n_vertex;
    const double *vertex_span;         // (n_vertex) along the reference axis, increasing [m]
    const bough_vec3 *vertex_position; // (n_vertex) [m]
    const bough_mat3 *vertex_rotation; // (n_vertex) columns: section axes
} bough_rotor_def;

// 3 blades, 1.225 kg/m³, every correction on, equilibrium inflow, static polars, no tower, no wind;
// tables left empty.
bough_rotor_def bough_rotor_def_default(void);

// One blade's vertices in the axes of a frame that moves with it, as rows of n_vertex numbers: a
// state of rods.
enum {
    BOUGH_BLADE_POSITION = 0, // [m]
    BOUGH_BLADE_ROTATION = 3, // quaternion of the section axes, of about unit length
    BOUGH_BLADE_VELOCITY = 7, // absolute [m/s]
    BOUGH_BLADE_SPIN = 10,    // absolute angular velocity, in section axes [rad/s]
    BOUGH_BLADE_ROWS = 13,
};

enum { BOUGH_SLOPES = 12 }; // per vertex

typedef struct bough_blade_motion {
    bough_transform frame; // in ground axes
    const double *vertex;  // (BOUGH_BLADE_ROWS × n_vertex)
} bough_blade_motion;

// The motion at a sample.
typedef struct bough_rotor_motion {
    double time;                     // [s]
    bough_vec3 hub;                  // where the blade-root axes meet the shaft, ground axes [m]
    bough_vec3 hub_velocity;         // ground axes; the wake sees the wind relative to it [m/s]
    bough_vec3 shaft;                // unit vector, downwind, ground axes
    const bough_blade_motion *blade; // (n_blade)
} bough_rotor_motion;

// What a station reports. y is tangential, against the rotation; x normal to the deformed blade in
// the plane of shaft and radius.
typedef struct bough_station {
    double radius;                   // from the shaft axis [m]
    double inflow_x, inflow_y;       // relative to the station, without induction [m/s]
    double axial, tangential;        // a, a' after the skew correction [-]
    double alpha;                    // angle of attack in the section's plane, from −π to π [rad]
    double phi, twist;               // inflow angle, chord to the y axis [rad]
    double speed;                    // relative, with induction [m/s]
    bough_coefficients coefficients; // Cl, Cd, Cm
    double force_x, force_y;         // line force [N/m]
} bough_station;

typedef struct bough_rotor bough_rotor; // the model: constant, but for bough_rotor_set_speed

// What dynamic inflow and stall remember of the samples before; nothing without them.
typedef struct bough_rotor_memory {
    bough_inflow_station *station; // (n_blade × n_station); NULL without
    bough_stall_state *stall;      // (n_blade × n_station); NULL without
    bough_inflow_clock *clock;     // NULL without either
} bough_rotor_memory;

typedef struct bough_rotor_data {
    bough_rotor_memory memory; // advanced by bough_rotor_conclude
    // computed by the stages of a sample
    double *load;      // (n_blade × 6 × n_vertex) force on each vertex, moment about it, in the axes of
                       // the blade's frame [N, N m]
    double *line;      // (n_blade × 12 × (n_vertex − 1)) the same loads per length, their mean over each
                       // segment between two vertices [N/m, N] and their slope [N/m², N/m], same axes
    double *slope;     // (n_blade × BOUGH_SLOPES × n_vertex) how the loads follow the vertices' own
                       // motion: row 4 c + j, c of forces along x and y and moment about z of the blade's
                       // frame, j of velocities along x and y, rotation about the section's normal and
                       // its rate [N s/m, N, N s; N s, N m, N m s]
    bool skips_slopes; // of the caller: they are not wanted, and stay as they are
    bool same_motion;  // of the caller: motion, time and wind are those of the last sample, whose `approach`
                       // holds
    double thrust;     // along the shaft [N]
    double torque;     // about the shaft [N m]
    bough_vec3 disk_wind;     // mean of the disturbed wind over all stations [m/s]
    bough_vec3 disk_velocity; // mean of the stations' velocities [m/s]
    struct bough_rotor_scratch *scratch;
} bough_rotor_data;

// Builds the model; the def and all it points to may be released afterwards. BOUGH_INVALID for a
// station off the blade and for wind that cannot be read or made.
bough_status bough_rotor_build(bough_arena *arena, const bough_rotor_def *def, bough_rotor **rotor);

// Takes the memory of a data struct; its loads are zero. The only other allocation.
void bough_rotor_data_build(bough_arena *arena, const bough_rotor *rotor, bough_rotor_data *data);

// Evaluates the loads at the given motion. In equilibrium inflow and with static polars they are a
// pure function of it: nothing is kept from sample to sample. Else the memory goes on from the last
// sample's time to this one's, with the inflow's time constant of the last. Finite for any finite
// motion. In stages, each after the one before it for all blades, but induce only after the same
// blade's approach. Blades are independent within a stage and may be given to different threads.
//   approach: where the blade's stations are and the wind they meet; reads only the blade in
//             `motion`, and hub and shaft
//   induce:   the induction there, most of the work
//   survey:   quantities of the whole rotor for each station
//   load:     the loads on the blade's vertices
//   conclude: the rotor's sums, the memory's clock
void bough_rotor_approach(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                          bough_rotor_data *data);
void bough_rotor_induce(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                        bough_rotor_data *data);
void bough_rotor_survey(const bough_rotor *rotor, const bough_rotor_motion *motion, bough_rotor_data *data);
void bough_rotor_load(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                      bough_rotor_data *data);
void bough_rotor_conclude(const bough_rotor *rotor, const bough_rotor_motion *motion, bough_rotor_data *data);

// A station's results of the last sample.
bough_station bough_rotor_station(const bough_rotor_data *data, int blade, int station);

// The results of a sample: those of every station, thrust, torque and wind; not the loads.
void bough_rotor_result_snapshot(const bough_rotor *rotor, bough_rotor_data *data, bough_snapshot *s);

// The extreme values of a blade's last sample, to be compared with the range of tables and model.
typedef struct bough_rotor_extremes {
    bool outside_table; // an angle of attack is outside the rows of its polar …
    double alpha;       // … this one [rad]
    double speed;       // the largest relative speed [m/s]
    double distance;    // the least from the tower's axis, in radii there [-]
} bough_rotor_extremes;

bough_rotor_extremes bough_rotor_look(const bough_rotor *rotor, const bough_rotor_data *data, int blade);

// Makes the next sample the first.
void bough_rotor_forget(const bough_rotor *rotor, bough_rotor_data *data);

// The memory, and the number of doubles in a copy of it, 0 without dynamic inflow and stall.
void bough_rotor_memory_snapshot(const bough_rotor *rotor, bough_rotor_data *data, bough_snapshot *s);
int bough_rotor_memory_size(const bough_rotor *rotor);

// Rows of that copy that are states of the air, section by section: the delayed inductions, the shed
// wake, the lags of pressure and separation; the others are their inputs at the last sample. The first
// row is the time of the last sample. Returns their number; row has room for the memory's length.
int bough_rotor_memory_states(const bough_rotor *rotor, int *row);

// Drag by the undisturbed wind at a time [s]: of the tower, bough_tower_drag [N/m], and of a hub of
// that drag area [m²] at a place and velocity in ground axes [N].
bough_vec3 bough_rotor_tower_drag(const bough_rotor *rotor, bough_vec3 position, bough_vec3 axis,
                                  bough_vec3 velocity, double t);
bough_vec3 bough_rotor_hub_drag(const bough_rotor *rotor, double area, bough_vec3 position,
                                bough_vec3 velocity, double t);

// The undisturbed wind that it meets.
const bough_wind *bough_rotor_wind(const bough_rotor *rotor);

// Changes the speed of a wind by a formula [m/s]; the next sample meets it.
void bough_rotor_set_speed(bough_rotor *rotor, double speed);

// The aerodynamics of a scene, as scene.h: wind, polars, blade elements, induction, tower.
#pragma once

#include "aero/rotor/rotor.h"
#include "apps/bough/config/text.h"

typedef struct bough_scene_aero_station {
    const bough_node *node;
    bough_station_def def;
    const char *polar_name, *second_name; // NULL second: the polar alone
} bough_scene_aero_station;

typedef struct bough_scene_aero_blade {
    const bough_node *node;
    const char *source;
    int n_station;
    bough_scene_aero_station *station; // (n_station), spans strictly increasing from 0
} bough_scene_aero_blade;

typedef struct bough_scene_polar_row {
    const bough_node *node;
    double alpha; // [rad]
    double cl, cd, cm;
} bough_scene_polar_row;

typedef struct bough_scene_polar {
    const bough_node *node;
    const char *name;
    int n_row;
    bough_scene_polar_row *row; // (n_row), alpha strictly increasing from −π to π
    double indicial[4];         // A₁, A₂, b₁, b₂ of dynamic stall [-]
} bough_scene_polar;

typedef struct bough_scene_polars {
    const bough_node *node;
    const char *source;
    int n_polar;
    bough_scene_polar *polar; // (n_polar), at least two rows each
} bough_scene_polars;

typedef enum bough_scene_hold { BOUGH_SCENE_LINEAR, BOUGH_SCENE_CONSTANT } bough_scene_hold;
typedef enum bough_scene_interpolation {
    BOUGH_SCENE_POLARS_LINEAR,
    BOUGH_SCENE_POLARS_SMOOTH,
} bough_scene_interpolation;
typedef enum bough_scene_wind_kind {
    BOUGH_SCENE_WIND_UNIFORM,
    BOUGH_SCENE_WIND_POWER,
    BOUGH_SCENE_WIND_LOG,
    BOUGH_SCENE_WIND_WND,
    BOUGH_SCENE_WIND_BTS,
    BOUGH_SCENE_WIND_IEC,
} bough_scene_wind_kind;
// Wind speed over time, linear between the rows, constant before and after.
typedef struct bough_scene_wind_table {
    const bough_node *node; // NULL: the speed is constant
    int n_time, n_speed;    // equal
    double *time;           // (n_time) strictly increasing [s]
    double *speed;          // (n_time) [m/s]
} bough_scene_wind_table;

typedef struct bough_scene_wind {
    const bough_node *node;
    int kind;                     // bough_scene_wind_kind
    bough_scene_wind_table table; // in place of the speed
    const char *input;            // in place of the speed; NULL: none
    // Without kind and table. The veer is over 100 m of height [rad]; `file` is a path once it is checked. Of
    // kind iec, 0 means "auto", and speed, exponent and reference height stand here, not in `iec`.
    bough_wind_def def;
} bough_scene_wind;

// Whether its speed is one number: a wind by a formula, no table.
static inline bool bough_scene_wind_is_steady(const bough_scene_wind *wind) {
    return wind->table.node == NULL &&
           (wind->kind == BOUGH_SCENE_WIND_UNIFORM || wind->kind == BOUGH_SCENE_WIND_POWER ||
            wind->kind == BOUGH_SCENE_WIND_LOG);
}

typedef struct bough_scene_induction {
    const bough_node *node;
    bough_induction_options options; // without drag
    bool drag;                       // in the axial and the tangential induction
    int skew;                        // 1: corrected by Pitt and Peters
    bough_inflow_def inflow;         // time 0: from induction and wind ("auto")
} bough_scene_induction;

// Vertical along ground z from the origin.
typedef struct bough_scene_tower {
    const bough_node *node; // NULL: no tower influence
    bough_tower_def def;    // drag at each height (def.n) once it is checked
    int n_diameter, n_drag; // def.n, 1 or def.n
    const char *body_name;  // NULL: no drag on the tower
    int body;               // index of a body with a rod
} bough_scene_tower;

typedef struct bough_scene_aero {
    const bough_node *node; // NULL: no aerodynamics
    double rate;            // samples per second [Hz]; the period is a multiple of the macro step
    double air_density;     // [kg/m³]
    bough_scene_wind wind;
    double ramp[2]; // [s] as in bough_scene_load
    int hold;       // bough_scene_hold: loads between samples
    bough_scene_aero_blade blade;
    bough_scene_polars polars;
    bough_scene_induction induction;
    bough_scene_tower tower;
    double hub_radius;    // [m]
    double hub_drag_area; // drag coefficient times area [m²]
    int dynamic_stall;    // bough_stall_kind
    int interpolation;    // bough_scene_interpolation
    int n_node;           // blade elements whose channels are recorded, of every blade
    double *nodes;        // (n_node) numbers from 1
    bool pitching_moment;
} bough_scene_aero;

// A rigid rotor of the NREL 5 MW turbine for tests of the aerodynamics: placed, moved and sampled.
#pragma once

#include "aero/rotor/rotor.h"
#include "core/base/rotation.h"
#include "tests/unit/nrel5mw_aero.h"

static const double degree = BOUGH_PI / 180, rpm = BOUGH_PI / 30;

enum { VERTICES = 25, BLADES = 3, STATIONS = 19 };

// A rigid rotor on straight blades: what the loads need of a turbine.
typedef struct rig {
    bough_arena *arena;
    bough_rotor_def def;
    bough_rotor *rotor;
    bough_rotor_data data;
    bough_rotor_motion motion;
    double tilt, cone, overhang; // cone: blade tips upwind [rad], [m]
    double pitch, speed;
    bough_station_def station[STATIONS];
    double span[VERTICES];
    bough_vec3 axis[VERTICES];
    bough_mat3 section[VERTICES];
    bough_vec3 position[BLADES * VERTICES], velocity[BLADES * VERTICES], spin[BLADES * VERTICES];
    bough_mat3 rotation[BLADES * VERTICES];
    bough_blade_motion blade[BLADES];
    double vertex[BLADES][BOUGH_BLADE_ROWS * VERTICES];
    bough_vec3 force[BLADES * VERTICES], moment[BLADES * VERTICES]; // ground axes
} rig;

static inline bough_mat3 turned(bough_vec3 rotation_vector) {
    return bough_rotation_matrix(bough_quaternion_exponential(rotation_vector));
}

static inline rig *create_rig(bool flat) {
    bough_arena *arena = check_memory();
    rig *r = bough_arena_take(arena, sizeof *r);
    r->arena = arena;
    r->def = bough_rotor_def_default();
    nrel5mw_stations(r->station, flat);
    for (int i = 0; i < VERTICES; i++) {
        r->span[i] = 61.5 * i / (VERTICES - 1);
        r->axis[i] = bough_v3(0, 0, r->span[i]);
        r->section[i] = bough_mat3_identity();
    }
    r->def.hub_radius = 1.5;
    r->def.n_polar = 8;
    r->def.polar = nrel5mw_polars;
    r->def.n_station = STATIONS;
    r->def.station = r->station;
    r->def.n_vertex = VERTICES;
    r->def.vertex_span = r->span;
    r->def.vertex_position = r->axis;
    r->def.vertex_rotation = r->section;
    r->motion.blade = r->blade;
    if (!flat) {
        r->tilt = 5 * degree;
        r->cone = 2.5 * degree;
        r->overhang = 5.0191;
        r->def.tower =
            (bough_tower_def){.n = 12, .height = nrel5mw_tower_height, .diameter = nrel5mw_tower_diameter};
    }
    return r;
}

static inline void build(rig *r) {
    check_ok(bough_rotor_build(r->arena, &r->def, &r->rotor));
    bough_rotor_data_build(r->arena, r->rotor, &r->data);
}

// Places the rigid rotor at an azimuth of blade 1 (0: up).
static inline void place(rig *r, double azimuth) {
    bough_mat3 nacelle = turned(bough_v3(0, r->tilt, 0));
    r->motion.shaft = nacelle.c1;
    r->motion.hub = bough_axpy(-r->overhang, nacelle.c1, bough_v3(0, 0, 87.6 + 1.96256));
    bough_vec3 omega = bough_scale(r->speed, nacelle.c1);
    for (int b = 0; b < BLADES; b++) {
        bough_mat3 blade =
            bough_mat3_product(nacelle, turned(bough_v3(azimuth + 2 * BOUGH_PI * b / BLADES, 0, 0)));
        blade = bough_mat3_product(blade, turned(bough_v3(0, -r->cone, 0)));
        blade = bough_mat3_product(blade, turned(bough_v3(0, 0, -r->pitch)));
        for (int i = 0; i < VERTICES; i++) {
            int k = b * VERTICES + i;
            bough_vec3 arm = bough_mat3_mul(blade, bough_add(r->axis[i], bough_v3(0, 0, 1.5)));
            r->position[k] = bough_add(r->motion.hub, arm);
            r->rotation[k] = bough_mat3_product(blade, r->section[i]);
            r->velocity[k] = bough_cross(omega, arm);
            r->spin[k] = omega;
        }
    }
}

static inline void operate(rig *r, double wind, double pitch_deg, double speed_rpm) {
    r->def.wind.speed = wind;
    r->speed = speed_rpm * rpm;
    r->pitch = pitch_deg * degree;
    build(r);
}

// Blade by blade into a frame that stands somewhere: the loads do not depend on it.
static inline void send_motion(rig *r) {
    for (int k = 0; k < BLADES * VERTICES; k++) {
        int b = k / VERTICES, i = k % VERTICES;
        bough_transform f = {bough_v3(-3, 40, 7 * b), turned(bough_v3(0.4 * b, 0.3, -0.2))};
        bough_vec3 x = bough_mat3_tmul(f.rotation, bough_sub(r->position[k], f.position));
        bough_vec3 v = bough_mat3_tmul(f.rotation, r->velocity[k]);
        bough_vec3 w = bough_mat3_tmul(r->rotation[k], r->spin[k]);
        bough_quaternion p =
            bough_quaternion_of_matrix(bough_mat3_product(bough_mat3_transpose(f.rotation), r->rotation[k]));
        const double row[BOUGH_BLADE_ROWS] = {x.x, x.y, x.z, p.w, p.x, p.y, p.z,
                                              v.x, v.y, v.z, w.x, w.y, w.z};
        for (int c = 0; c < BOUGH_BLADE_ROWS; c++) r->vertex[b][c * VERTICES + i] = row[c];
        r->blade[b] = (bough_blade_motion){f, r->vertex[b]};
    }
}

static inline void fetch_loads(rig *r) {
    for (int k = 0; k < BLADES * VERTICES; k++) {
        int b = k / VERTICES, i = k % VERTICES;
        double x[6];
        for (int c = 0; c < 6; c++) x[c] = r->data.load[(6 * b + c) * VERTICES + i];
        r->force[k] = bough_mat3_mul(r->blade[b].frame.rotation, bough_v3(x[0], x[1], x[2]));
        r->moment[k] = bough_mat3_mul(r->blade[b].frame.rotation, bough_v3(x[3], x[4], x[5]));
    }
}

// The stages one after another.
static inline void evaluate(rig *r) {
    for (int b = 0; b < BLADES; b++) {
        bough_rotor_approach(r->rotor, &r->motion, b, &r->data);
        bough_rotor_induce(r->rotor, &r->motion, b, &r->data);
    }
    bough_rotor_survey(r->rotor, &r->motion, &r->data);
    for (int b = 0; b < BLADES; b++) bough_rotor_load(r->rotor, &r->motion, b, &r->data);
    bough_rotor_conclude(r->rotor, &r->motion, &r->data);
}

static inline void sample_as_placed(rig *r) {
    send_motion(r);
    evaluate(r);
    fetch_loads(r);
}

static inline void sample(rig *r, double azimuth) {
    place(r, azimuth);
    sample_as_placed(r);
}

// The flat rotor without tilt, cone and offsets, with Buhl's high thrust.
static inline rig *create_flat_rig(void) {
    rig *r = create_rig(true);
    r->def.induction.high_thrust = BOUGH_HIGH_THRUST_BUHL;
    return r;
}

// Rods for the tests: a uniform straight one and a curved, twisted, fully coupled one.
#pragma once

#include "flexbody/rod/rod_static.h"
#include "tests/unit/sample_numbers.h"

typedef struct sample_arrays {
    double *span, *stiffness, *damping;
    bough_vec3 *position;
    bough_quaternion *rotation;
    bough_vertex_inertia *inertia;
} sample_arrays;

static inline sample_arrays sample_take(bough_arena *arena, int n) {
    size_t vertices = (size_t)n + 1;
    sample_arrays a;
    a.span = bough_arena_doubles(arena, vertices);
    a.stiffness = bough_arena_doubles(arena, 21 * (size_t)n);
    a.damping = bough_arena_doubles(arena, 21 * (size_t)n);
    a.position = bough_arena_take(arena, vertices * sizeof *a.position);
    a.rotation = bough_arena_take(arena, vertices * sizeof *a.rotation);
    a.inertia = bough_arena_take(arena, vertices * sizeof *a.inertia);
    return a;
}

static inline bough_rod_def sample_def(int n, sample_arrays a, bool carries) {
    return (bough_rod_def){.name = "sample",
                           .n_segment = n,
                           .span = a.span,
                           .position = a.position,
                           .rotation = a.rotation,
                           .stiffness = a.stiffness,
                           .damping = a.damping,
                           .inertia = a.inertia,
                           .carries = carries};
}

static inline bough_rod_model *sample_build(bough_arena *arena, int n, sample_arrays a, bool carries) {
    bough_rod_def def = sample_def(n, a, carries);
    bough_rod_model *model = NULL;
    check_ok(bough_rod_create(arena, &def, &model));
    return model;
}

// A straight uniform rod along z: diagonal stiffness (6), viscosity mu [s], mass per length,
// rotary inertia per length about x, y, z.
static inline bough_rod_model *sample_uniform(bough_arena *arena, int n, double length,
                                              const double stiffness[6], double mu, const double inertia[4]) {
    static const int diagonal[6] = {0, 6, 11, 15, 18, 20};
    sample_arrays a = sample_take(arena, n);
    double h = length / n;
    for (int i = 0; i <= n; i++) {
        double share = i == 0 || i == n ? h / 2 : h;
        double along = i == 0 ? h / 4 : i == n ? -h / 4 : 0; // centre of the two half-segments
        double spread = inertia[0] * (i == 0 || i == n ? h * h * h / 24 : h * h * h / 12);
        a.span[i] = h * i;
        a.position[i] = bough_v3(0, 0, h * i);
        a.rotation[i] = bough_quaternion_identity();
        a.inertia[i].mass = inertia[0] * share;
        a.inertia[i].moment = bough_v3(0, 0, inertia[0] * share * along);
        a.inertia[i].inertia[0] = inertia[1] * share + spread;
        a.inertia[i].inertia[1] = inertia[2] * share + spread;
        a.inertia[i].inertia[2] = inertia[3] * share;
    }
    for (int k = 0; k < n; k++) {
        for (int j = 0; j < 6; j++) {
            a.stiffness[21 * k + diagonal[j]] = stiffness[j];
            a.damping[21 * k + diagonal[j]] = mu * stiffness[j];
        }
    }
    return sample_build(arena, n, a, false);
}

// A curved, twisted rod with full random stiffness, damping and inertia, of unit-like magnitude,
// whose last vertex may belong to what it carries.
static inline sample_arrays sample_general_arrays(bough_arena *arena, int n) {
    unsigned seed = 7;
    sample_arrays a = sample_take(arena, n);
    bough_quaternion p = bough_quaternion_exponential(bough_v3(0.1, -0.2, 0.3));
    for (int i = 0; i <= n; i++) {
        bough_vec3 turn = {0.2 * sample_random(&seed), 0.2, 0.3 * sample_random(&seed)};
        a.span[i] = 0.5 * i;
        a.rotation[i] = p;
        bough_vec3 step = bough_scale(0.5, bough_rotation_matrix(p).c3);
        if (i < n) a.position[i + 1] = bough_add(a.position[i], step);
        p = bough_quaternion_product(p, bough_quaternion_exponential(turn));
        bough_vertex_inertia *v = &a.inertia[i];
        v->mass = 1.2 + 0.3 * sample_random(&seed);
        v->moment = bough_v3(0.1 * sample_random(&seed), 0.2 * sample_random(&seed), 0.05);
        const double inertia[6] = {0.9, 1.1, 1.3, 0.1, -0.05, 0.08};
        memcpy(v->inertia, inertia, sizeof inertia);
    }
    for (int k = 0; k < n; k++) {
        double g[6][6];
        for (int i = 0; i < 36; i++) g[i / 6][i % 6] = sample_random(&seed);
        int at = 0;
        for (int i = 0; i < 6; i++) {
            for (int j = i; j < 6; j++, at++) {
                double sum = i == j ? 2.0 : 0;
                for (int l = 0; l < 6; l++) sum += g[l][i] * g[l][j];
                a.stiffness[21 * k + at] = 20 * sum;
                a.damping[21 * k + at] = 0.4 * sum + (i == j ? 0.1 : 0);
            }
        }
    }
    return a;
}

static inline bough_rod_model *sample_general_as(bough_arena *arena, int n, bool carries) {
    return sample_build(arena, n, sample_general_arrays(arena, n), carries);
}

static inline bough_rod_model *sample_general(bough_arena *arena, int n) {
    return sample_general_as(arena, n, false);
}

// A strongly deformed, fast moving state about the undeformed one; quaternions not normalised.
static inline void sample_state(const bough_rod_model *m, const double *input, double *state) {
    unsigned seed = 11;
    int n = m->n;
    bough_rod_rest_state(m, input, state);
    for (int c = 0; c < BOUGH_ROD_STATES; c++) {
        double size = c < 3 ? 0.1 : c < 7 ? 0.2 : 0.8;
        for (int i = 0; i < n; i++) state[c * n + i] += size * sample_random(&seed);
    }
}

static inline void sample_loads(const bough_rod_model *m, bough_rod_loads *loads) {
    unsigned seed = 5;
    for (int k = 0; k < 6 * m->stride; k++) {
        loads->value[k] = sample_random(&seed);
        loads->rate[k] = sample_random(&seed);
    }
    loads->start = 0.25;
}

// D of its segments at random.
static inline void sample_line(bough_rod_model *m) {
    unsigned seed = 29;
    for (int k = 0; k < 36 * m->stride; k++) m->line[k] = 0.05 * sample_random(&seed);
}

// Adds loads on all vertices and along all segments that change in time: ramped dead ones and followers from
// 0.1 to 1 s, and strains without stress that grow steadily.
static inline void sample_loads_along(bough_arena *arena, const bough_rod_model *m, bough_rod_loads *loads) {
    const bough_schedule ramp = {.start = 0.1, .end = 1};
    unsigned seed = 23;
    for (int follower = 0; follower < 2; follower++) {
        bough_rod_ramped_load *load = bough_rod_loads_ramped(loads, arena, m, follower, &ramp);
        load->along = true;
        for (int k = 0; k < 6 * m->stride; k++) {
            load->line[k] = sample_random(&seed);
            load->value[k] += sample_random(&seed);
        }
    }
    loads->moving = true;
    for (int k = 0; k < 6 * m->stride; k++) loads->rest_rate[k] = 0.01 * sample_random(&seed);
}

// Equilibrium of a rod whose frame is at rest.
static inline bough_status rod_equilibrium(const bough_rod_model *m, const bough_rod_loads *loads,
                                           bough_vec3 gravity, bough_rod_static *work, double *state) {
    const double input[BOUGH_ROD_INPUTS] = {0, 0, 0, 0, 0, 0, gravity.x, gravity.y, gravity.z};
    return bough_rod_steady(m, loads, input, work, state);
}

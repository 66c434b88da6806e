// Trees for tests: built as members, and one that holds everything a tree may.
#pragma once

#include "tests/unit/member.h"
#include "tests/unit/sample_numbers.h"

#include "core/base/rotation.h"
#include "core/tree/dynamics.h"
#include "core/tree/loop.h"
#include "core/tree/tree.h"

enum { MOST = 64 };

// Parts of a bough_tree_def from an array.
#define LIST(part, array) .n_##part = (int)(sizeof(array) / sizeof *(array)), .part = (array)

static const bough_vec3 down_z = {0, 0, -9.81};

typedef struct fixture {
    bough_arena *arena;
    bough_tree *tree;
    bough_tree_data *data;
    bough_system s;
    bough_member *m;
} fixture;

static inline fixture build_with(const bough_tree_def *def, bough_integrator_kind solver, double rtol) {
    fixture f = {.arena = check_memory()};
    check_ok(bough_tree_create(f.arena, def, &f.tree));
    f.data = bough_tree_data_create(f.arena, f.tree);
    f.s = bough_tree_system_create(f.arena, f.tree, "tree");
    f.m = member_of(f.arena, &f.s, (bough_integrator_options){.kind = solver, .rtol = rtol, .rho = 0.8});
    assert_true(f.s.n_state <= MOST);
    return f;
}

static inline fixture build(const bough_tree_def *def, double rtol) {
    return build_with(def, BOUGH_IDA, rtol);
}

static inline void advance(fixture *f, double t1, bool restart) {
    check_ok(bough_member_advance(f->m, t1, NULL, restart));
    check_near(f->m->time, t1, 0, 0);
}

static inline bough_mat3 diagonal(double a, double b, double c) {
    return (bough_mat3){{a, 0, 0}, {0, b, 0}, {0, 0, c}};
}

static inline bough_mat3 turned(double x, double y, double z) {
    return bough_rotation_matrix(bough_quaternion_exponential(bough_v3(x, y, z)));
}

static inline bough_vec3 next3(unsigned *seed) {
    double x = sample_random(seed), y = sample_random(seed), z = sample_random(seed);
    return bough_v3(x, y, z);
}

static inline bough_body_def random_body(unsigned *seed, const char *name, int parent,
                                         bough_joint_kind kind) {
    bough_body_def b = bough_body_def_default();
    bough_vec3 turn = next3(seed);
    b.name = name;
    b.parent = parent;
    b.kind = kind;
    b.joint = (bough_transform){next3(seed), turned(turn.x, turn.y, turn.z)};
    b.axis = next3(seed);
    b.second_axis = bough_cross(b.axis, bough_v3(0.3, 0.5, -0.8));
    b.mass = 1 + 0.5 * sample_random(seed);
    b.mass_centre = next3(seed);
    bough_mat3 r = turned(sample_random(seed), sample_random(seed), sample_random(seed));
    b.inertia = bough_mat3_product(r, bough_mat3_product(diagonal(0.3, 0.5, 0.7), bough_mat3_transpose(r)));
    for (int k = 0; k < BOUGH_JOINT_COORDINATES; k++) b.coordinates[k] = sample_random(seed);
    for (int k = 0; k < BOUGH_JOINT_SPEEDS; k++) b.speeds[k] = sample_random(seed);
    return b;
}

// Every kind of joint, branches, a welded body in between, bodies out of order, two ports (one on
// the welded body), a joint load with a ramp and an external wrench.
static inline fixture everything(double rtol) {
    static const char *names[] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
    static const int parents[] = {8, 0, 7, 9, 3, 4, BOUGH_GROUND, BOUGH_GROUND, 2, 2};
    static const bough_joint_kind kinds[] = {
        BOUGH_JOINT_REVOLUTE,    BOUGH_JOINT_SPHERICAL, BOUGH_JOINT_FREE,      BOUGH_JOINT_PRISMATIC,
        BOUGH_JOINT_FIXED,       BOUGH_JOINT_REVOLUTE,  BOUGH_JOINT_SPHERICAL, BOUGH_JOINT_UNIVERSAL,
        BOUGH_JOINT_CYLINDRICAL, BOUGH_JOINT_PLANAR};
    unsigned seed = 7;
    bough_body_def bodies[10];
    for (int i = 0; i < 10; i++) bodies[i] = random_body(&seed, names[i], parents[i], kinds[i]);
    bodies[5].spring = (bough_joint_spring){.stiffness = 7, .damping = 0.5, .rest = 0.3};
    bodies[3].spring =
        (bough_joint_spring){.stiffness = 3, .damping = 1, .low = -2, .high = -1, .stop_stiffness = 20};
    bough_marker_def markers[] = {
        {"on b", 1, {next3(&seed), turned(0.3, -0.4, 1)}},
        {"on e", 4, {next3(&seed), turned(-1, 0.2, 0.5)}},
        {"on f", 5, {next3(&seed), turned(1, 1, 0.1)}},
    };
    bough_port_def ports[] = {
        {0, bough_inertia_of(0.4, bough_v3(0.1, 0, 0.2), diagonal(0.1, 0.2, 0.2)), true},
        {1, bough_inertia_of(0.2, bough_v3(0, 0.3, 0), diagonal(0.1, 0.1, 0.1)), false},
    };
    bough_spring_def springs[] = {{{0, 2}, 6, 0.4, 0.5}, {{1, 2}, 9, 0, 1.5}};
    bough_joint_load_def loads[] = {{.body = 5, .value = 3.0, .schedule = {.start = 0.1, .end = 0.3}},
                                    {.body = 3, .value = -2.0}};
    bough_tree_def def = {.gravity = {1, -2, -9},
                          LIST(bodies, bodies),
                          LIST(markers, markers),
                          LIST(ports, ports),
                          LIST(loads, loads),
                          LIST(springs, springs)};
    fixture f = build(&def, rtol);
    double value[6] = {1, 2, 3, -1, -2, 0.5}, rate[6] = {0.5, 0, 1, 0, 1, 0};
    bough_tree_set_wrench(f.tree, 2, 0.05, value, rate, NULL);
    return f;
}

static const double some_input[12] = {1, -2, 0.5, 0.3, 0.8, -0.6, -1, 0.4, 2, 0.7, -0.1, 0.9};

// Closed loops: derivatives of the constraints, every kind against the joint that it replaces,
// plane four-bars, which are redundant in space, against their one equation of motion, assembly.
#include "tests/unit/contract.h"
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

static const bough_joint_kind kinds[] = {
    BOUGH_JOINT_FIXED,     BOUGH_JOINT_REVOLUTE,    BOUGH_JOINT_PRISMATIC, BOUGH_JOINT_SPHERICAL,
    BOUGH_JOINT_UNIVERSAL, BOUGH_JOINT_CYLINDRICAL, BOUGH_JOINT_PLANAR,
};
enum { KINDS = sizeof kinds / sizeof *kinds };

// -- constraints -----------------------------------------------------------------------------

// A frame in a smooth motion of time, with twist and its rate by the definition.
static bough_frame_motion moving(double t, double seed) {
    bough_frame_motion m;
    double s = sin(seed + t), c = cos(seed + t);
    // the rotation by the vector t·w about a turned start: Ω = w in body axes
    bough_vec3 w = bough_v3(0.7 * seed, -0.4, 0.9);
    bough_quaternion p = bough_quaternion_product(bough_quaternion_exponential(bough_v3(0.3, seed, -0.2)),
                                                  bough_quaternion_exponential(bough_scale(t, w)));
    m.pose.rotation = bough_rotation_matrix(p);
    m.pose.position = bough_v3(s, 0.5 * c, s * c);
    bough_vec3 velocity = bough_v3(c, -0.5 * s, c * c - s * s);
    m.twist.linear = bough_mat3_tmul(m.pose.rotation, velocity);
    m.twist.angular = w;
    return m;
}

// v̇ of the components: Rᵀ r̈ − Ω × v; Ω̇ is zero
static bough_twist rate_of_twist(double t, double seed) {
    bough_frame_motion m = moving(t, seed);
    double s = sin(seed + t), c = cos(seed + t);
    bough_vec3 r = bough_mat3_tmul(m.pose.rotation, bough_v3(-s, -0.5 * c, -4 * s * c));
    bough_vec3 turning = bough_cross(m.twist.angular, m.twist.linear);
    return (bough_twist){bough_sub(r, turning), {0, 0, 0}};
}

TEST(rates_and_bias_are_the_derivatives) {
    const double t = 0.4, h = 1e-4;
    bough_vec3 axis = bough_v3(0.3, -0.5, 0.8), second = bough_v3(0.9, 0.2, 0.1);
    for (int k = 0; k < KINDS; k++) {
        bough_constraint c = bough_constraint_make(kinds[k], axis, second);
        int n = bough_constraint_n_rows(&c);
        assert_int_equal(n, 6 - bough_joint_n_speeds(kinds[k]));
        bough_constraint_row at[3][BOUGH_CONSTRAINT_ROWS];
        for (int i = 0; i < 3; i++) {
            bough_frame_motion a = moving(t + (i - 1) * h, 0.2), b = moving(t + (i - 1) * h, 1.3);
            bough_constraint_rows(&c, &a, &b, at[i]);
        }
        bough_twist va = moving(t, 0.2).twist, vb = moving(t, 1.3).twist;
        bough_twist aa = rate_of_twist(t, 0.2), ab = rate_of_twist(t, 1.3);
        for (int r = 0; r < n; r++) {
            const bough_constraint_row *row = &at[1][r];
            double slope = (at[2][r].value - at[0][r].value) / (2 * h);
            double second_slope = (at[2][r].rate - at[0][r].rate) / (2 * h);
            check_near(row->rate, slope, 0, 1e-7);
            check_near(bough_power(va, row->wrench[0]) + bough_power(vb, row->wrench[1]), row->rate, 0,
                       1e-13);
            double second_rate =
                bough_power(aa, row->wrench[0]) + bough_power(ab, row->wrench[1]) + row->bias;
            check_near(second_rate, second_slope, 0, 1e-6);
        }
    }
}

// -- trees -----------------------------------------------------------------------------------

static void go_to(fixture *f, double t1, bool restart) {
    advance(f, t1, restart);
    bough_tree_kinematics(f->tree, f->m->state, f->data);
}

static void check_closed(fixture *f, double allowed) {
    for (int c = 0; c < f->tree->n_closures; c++) {
        double value, rate;
        tree_closure_error(f->tree, f->data, c, &value, &rate);
        check_near(value, 0, 0, allowed);
        check_near(rate, 0, 0, 10 * allowed);
    }
}

// -- every kind against the joint it replaces -----------------------------------------------------

static void base_and_arm(bough_body_def *b, bough_joint_kind kind) {
    b[0] = b[1] = bough_body_def_default();
    b[0].name = "base";
    b[0].kind = BOUGH_JOINT_REVOLUTE;
    b[0].axis = bough_v3(0, 1, 0);
    b[0].speeds[0] = 0.7;
    b[0].mass = 2, b[0].mass_centre = bough_v3(0.4, 0.1, 0), b[0].inertia = diagonal(0.2, 0.3, 0.4);
    b[1].name = "arm";
    b[1].parent = 0;
    b[1].kind = kind;
    b[1].joint = (bough_transform){{0.8, 0.1, -0.2}, turned(0.3, -0.5, 0.4)};
    b[1].axis = bough_v3(0.2, 0.9, -0.3);
    b[1].second_axis = bough_cross(b[1].axis, bough_v3(1, 0.2, 0.5));
    for (int k = 0; k < BOUGH_JOINT_COORDINATES; k++)
        b[1].coordinates[k] = kind == BOUGH_JOINT_SPHERICAL ? k == 0 : 0.1 * k + 0.2;
    for (int k = 0; k < BOUGH_JOINT_SPEEDS; k++) b[1].speeds[k] = 0.6 - 0.25 * k;
    b[1].mass = 1, b[1].mass_centre = bough_v3(0.3, -0.2, 0.25);
    b[1].inertia = diagonal(0.05, 0.08, 0.06);
}

// The arm moves freely, starting as the joint's arm does, and a closure holds it to the base.
static bough_tree_def closed_def(bough_body_def *b, bough_marker_def *m, bough_closure_def *c,
                                 const fixture *open) {
    const bough_frame *arm = &open->tree->bodies[1];
    bough_transform pose = bough_tree_frame_pose(open->data, arm);
    bough_quaternion p = bough_quaternion_of_matrix(pose.rotation);
    *c = (bough_closure_def){"hold", b[1].kind, {0, 1}, b[1].axis, b[1].second_axis};
    m[0] = (bough_marker_def){"from", 0, b[1].joint};
    m[1] = (bough_marker_def){"to", 1, bough_transform_identity()};
    const double q[7] = {pose.position.x, pose.position.y, pose.position.z, p.w, p.x, p.y, p.z};
    b[1].parent = BOUGH_GROUND, b[1].kind = BOUGH_JOINT_FREE, b[1].joint = bough_transform_identity();
    memcpy(b[1].coordinates, q, sizeof q);
    bough_twist_store(bough_tree_frame_twist(open->data, arm), b[1].speeds);
    return (bough_tree_def){.gravity = down_z,
                            .n_bodies = 2,
                            .bodies = b,
                            .n_markers = 2,
                            .markers = m,
                            .n_closures = 1,
                            .closures = c,
                            .closure_time = 0.02};
}

static void compare(fixture *open, fixture *closed, double allowed) {
    for (int i = 0; i < 2; i++) {
        bough_transform x = bough_tree_frame_pose(open->data, &open->tree->bodies[i]);
        bough_transform y = bough_tree_frame_pose(closed->data, &closed->tree->bodies[i]);
        check_near(bough_norm(bough_sub(x.position, y.position)), 0, 0, allowed);
        check_near(bough_norm(bough_sub(x.rotation.c1, y.rotation.c1)), 0, 0, allowed);
        check_near(bough_norm(bough_sub(x.rotation.c2, y.rotation.c2)), 0, 0, allowed);
    }
}

// What the joint transmits, from the inverse dynamics, and what the closure does
static void compare_wrenches(fixture *open, fixture *closed) {
    double acceleration[MOST], rate[MOST];
    if (open->tree->bodies[1].link == open->tree->bodies[0].link) return; // welded
    bough_tree_forward_dynamics(open->tree, open->data, 0, NULL, acceleration);
    bough_tree_inverse_dynamics(open->tree, open->data, 0, NULL, acceleration, rate);
    bough_wrench joint = open->data->wrench[open->tree->bodies[1].link];
    bough_tree_forward_dynamics(closed->tree, closed->data, 0, NULL, acceleration);
    bough_wrench closure = bough_loops_wrench(closed->tree, closed->data, 0);
    bough_wrench off = bough_wrench_sub(joint, closure);
    check_near(bough_norm(off.force) / bough_norm(joint.force), 0, 0, 1e-9);
    check_near(bough_norm(off.moment) / (1 + bough_norm(joint.moment)), 0, 0, 1e-9);
}

// Lengths of a tree that only turns, and with them what its motion scales by.
static void resize(bough_tree_def *def, bough_body_def *b, double size) {
    def->gravity = bough_scale(size, def->gravity);
    for (int i = 0; i < 2; i++) {
        b[i].joint.position = bough_scale(size, b[i].joint.position);
        b[i].mass_centre = bough_scale(size, b[i].mass_centre);
        bough_vec3 *column[] = {&b[i].inertia.c1, &b[i].inertia.c2, &b[i].inertia.c3};
        for (int j = 0; j < 3; j++) *column[j] = bough_scale(size * size, *column[j]);
    }
}

// The tree with the joint and the one with a closure in its place.
static void build_both(bough_joint_kind kind, int solver, double size, fixture *open, fixture *closed) {
    bough_body_def b[2];
    bough_marker_def m[2];
    bough_closure_def c;
    base_and_arm(b, kind);
    bough_tree_def def = {.gravity = down_z, .n_bodies = 2, .bodies = b};
    resize(&def, b, size);
    *open = build_with(&def, BOUGH_RADAU5, 1e-11);
    bough_tree_kinematics(open->tree, open->m->state, open->data);
    bough_vec3 gravity = def.gravity;
    def = closed_def(b, m, &c, open);
    def.gravity = gravity;
    *closed = build_with(&def, solver, 1e-9);
    bough_tree_kinematics(closed->tree, closed->m->state, closed->data);
}

TEST(closures_act_as_the_joints_they_replace) {
    for (int k = 0; k < KINDS; k++) {
        for (int solver = BOUGH_IDA; solver <= BOUGH_RADAU5; solver += BOUGH_RADAU5) {
            fixture open, closed;
            build_both(kinds[k], solver, 1, &open, &closed);
            compare(&open, &closed, 1e-9);
            compare_wrenches(&open, &closed);
            assert_int_equal(closed.tree->closure_rank, 6 - bough_joint_n_speeds(kinds[k]));
            for (int step = 1; step <= 20; step++) {
                go_to(&open, 0.05 * step, step == 1);
                go_to(&closed, 0.05 * step, step == 1);
                check_closed(&closed, 1e-8);
            }
            compare(&open, &closed, 1e-6);
            bough_arena_destroy(open.arena);
            bough_arena_destroy(closed.arena);
        }
    }
}

// A mechanism of another size turns as the one of 1 m does.
TEST(closures_act_alike_in_every_size) {
    static const bough_joint_kind turning[] = {BOUGH_JOINT_REVOLUTE, BOUGH_JOINT_UNIVERSAL,
                                               BOUGH_JOINT_SPHERICAL};
    static const double sizes[] = {1, 1e-3, 1e3, 1e-7, 1e7};
    for (int k = 0; k < 3; k++) {
        bough_vec3 expected[2];
        for (int j = 0; j < 5; j++) {
            fixture open, f;
            build_both(turning[k], BOUGH_RADAU5, sizes[j], &open, &f);
            bough_arena_destroy(open.arena);
            assert_int_equal(f.tree->closure_rank, 6 - bough_joint_n_speeds(turning[k]));
            // the integrator's tolerance is one of 1 m
            int steps = j < 3 ? 20 : 0;
            for (int step = 1; step <= steps; step++) go_to(&f, 0.05 * step, step == 1);
            check_closed(&f, 1e-6 * sizes[j]);
            for (int i = 0; i < 2 && steps > 0; i++) {
                bough_vec3 x = bough_tree_frame_pose(f.data, &f.tree->bodies[i]).rotation.c1;
                if (j == 0) expected[i] = x;
                check_near(bough_norm(bough_sub(x, expected[i])), 0, 0, 1e-8);
            }
            bough_arena_destroy(f.arena);
        }
    }
}

// -- plane four-bars -------------------------------------------------------------------------

// Windows of uniform rods of 1 m and 1 kg, n uprights behind the first, a coupler between
// neighbours' tops, closed by revolute joints (IFToMM benchmark A02). From upright with the tops
// moving at 1 m/s the angle φ from the upright follows
//     φ¨ = g sin φ ((n + 1)/2 + n)/((n + 1)/3 + n).
enum { WINDOWS = 2, BODIES = 2 * WINDOWS + 1, MARKERS = 2 * WINDOWS };

typedef struct windows {
    bough_body_def body[BODIES];
    bough_marker_def marker[MARKERS];
    bough_closure_def closure[WINDOWS];
    bough_tree_def def;
} windows;

static bough_body_def rod(const char *name, int parent, double x, double z) {
    bough_body_def b = bough_body_def_default();
    b.name = name;
    b.parent = parent;
    b.kind = BOUGH_JOINT_REVOLUTE;
    b.axis = bough_v3(0, 1, 0);
    b.joint.position = bough_v3(x, 0, z);
    b.mass = 1;
    return b;
}

static void make_windows(windows *w, int n, bough_joint_kind kind) {
    static const char *const uprights[] = {"a0", "a1", "a2"}, *const couplers[] = {"c1", "c2"};
    memset(w, 0, sizeof *w);
    for (int i = 0; i <= n; i++) {
        bough_body_def *b = &w->body[i];
        *b = rod(uprights[i], BOUGH_GROUND, i, 0);
        b->mass_centre = bough_v3(0, 0, 0.5);
        b->inertia = diagonal(1.0 / 12, 1.0 / 12, 0);
        b->speeds[0] = 1;
    }
    for (int i = 0; i < n; i++) { // on its left upright, closed on the right one
        bough_body_def *b = &w->body[n + 1 + i];
        *b = rod(couplers[i], i, 0, 1);
        b->mass_centre = bough_v3(0.5, 0, 0);
        b->inertia = diagonal(0, 1.0 / 12, 1.0 / 12);
        b->speeds[0] = -1;
        w->marker[2 * i] = (bough_marker_def){"end", n + 1 + i, bough_transform_identity()};
        w->marker[2 * i].placement.position = bough_v3(1, 0, 0);
        w->marker[2 * i + 1] = (bough_marker_def){"top", i + 1, bough_transform_identity()};
        w->marker[2 * i + 1].placement.position = bough_v3(0, 0, 1);
        w->closure[i] = (bough_closure_def){"close", kind, {2 * i, 2 * i + 1}, {0, 1, 0}, {1, 0, 0}};
    }
    w->def = (bough_tree_def){.gravity = down_z,
                              .n_bodies = 2 * n + 1,
                              .bodies = w->body,
                              .n_markers = 2 * n,
                              .markers = w->marker,
                              .n_closures = n,
                              .closures = w->closure,
                              .closure_time = 0.01};
}

// φ(t) by many classic Runge–Kutta steps
static double angle_at(int n, double t) {
    double k = 9.81 * ((n + 1) / 2.0 + n) / ((n + 1) / 3.0 + n), y = 0, v = 1;
    int count = 20000;
    double h = t / count;
    for (int i = 0; i < count; i++) {
        double a1 = k * sin(y), v2 = v + 0.5 * h * a1, a2 = k * sin(y + 0.5 * h * v);
        double v3 = v + 0.5 * h * a2, a3 = k * sin(y + 0.5 * h * v2);
        double v4 = v + h * a3, a4 = k * sin(y + h * v3);
        y += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return y;
}

// Until before the bars come to lie on one line, where the mechanism may branch.
TEST(windows_follow_their_one_equation) {
    windows w;
    for (int n = 1; n <= WINDOWS; n++) {
        for (int solver = BOUGH_IDA; solver <= BOUGH_RADAU5; solver += BOUGH_RADAU5) {
            make_windows(&w, n, BOUGH_JOINT_REVOLUTE);
            fixture f = build_with(&w.def, solver, 1e-8);
            assert_int_equal(f.tree->n_rows, 5 * n);
            assert_int_equal(f.tree->closure_rank, 2 * n);
            bough_tree_kinematics(f.tree, f.m->state, f.data);
            tree_sums start = tree_sum(f.tree, f.data);
            for (int k = 1; k <= 40; k++) {
                go_to(&f, 0.01 * k, k == 1);
                check_closed(&f, 1e-7);
            }
            check_near(f.m->state[0], angle_at(n, 0.4), 0, 5e-7);
            tree_sums end = tree_sum(f.tree, f.data);
            check_near(end.kinetic + end.potential, start.kinetic + start.potential, 1e-7, 0);
            bough_arena_destroy(f.arena);
        }
    }
}

// A hinge closed twice over, on the closures and off them.
TEST(closed_trees_fulfil_the_contract) {
    const bough_port_def port = {.marker = 1};
    const double input[6] = {1, 2, 3, -1, -2, 0.5};
    double y[MOST];
    for (int solver = BOUGH_IDA; solver <= BOUGH_RADAU5; solver += BOUGH_RADAU5) {
        bough_body_def b[2];
        bough_marker_def m[2];
        bough_closure_def c[2];
        base_and_arm(b, BOUGH_JOINT_REVOLUTE);
        bough_tree_def def = {.gravity = down_z, .n_bodies = 2, .bodies = b};
        fixture open = build_with(&def, BOUGH_RADAU5, 1e-11);
        bough_tree_kinematics(open.tree, open.m->state, open.data);
        def = closed_def(b, m, c, &open);
        c[1] = c[0], c[1].name = "again";
        def.n_closures = 2;
        def.n_ports = 1, def.ports = &port;
        fixture f = build_with(&def, solver, 1e-8);
        assert_int_equal(f.tree->n_rows, 10);
        assert_int_equal(f.tree->closure_rank, 5);
        memcpy(y, f.m->state, (size_t)f.s.n_state * sizeof(double));
        contract_point at = {0.2, y, input, 1e-5};
        contract_check(f.m, at, 0.07, 0.05);
        contract_set_state(f.m, at, 1e-4);
        for (int i = 0; i < f.s.n_state; i++) y[i] += 0.01 * sin(3.0 * i);
        contract_check(f.m, at, 0.07, 0.05);
        bough_arena_destroy(open.arena);
        bough_arena_destroy(f.arena);
    }
}

// Inertias and mobility depend on the coordinates alone: where speeds alone differ they are not found again,
// so that a mass that has changed since then does not count; elsewhere it does.
TEST(inertias_are_found_once_for_each_position) {
    bough_body_def b[2];
    bough_marker_def m[2];
    bough_closure_def c[2];
    double rate[2][MOST] = {{0}}, y[MOST];
    base_and_arm(b, BOUGH_JOINT_REVOLUTE);
    bough_tree_def def = {.gravity = down_z, .n_bodies = 2, .bodies = b};
    fixture open = build_with(&def, BOUGH_RADAU5, 1e-11);
    bough_tree_kinematics(open.tree, open.m->state, open.data);
    def = closed_def(b, m, c, &open);
    fixture f = build_with(&def, BOUGH_IDA, 1e-8);
    size_t bytes = (size_t)f.s.n_state * sizeof(double);
    double *speed = &y[f.s.n_state - 1], *matrix = f.tree->links[1].matrix;
    memcpy(y, f.m->state, bytes);
    for (int pass = 0; pass < 3; pass++) {
        *speed += 0.5;
        if (pass == 2) y[0] += 1e-3, f.s.ops->derivative(f.s.self, 0, y, NULL, rate[1]), y[0] -= 1e-3;
        assert_true(f.s.ops->derivative(f.s.self, 0, y, NULL, rate[pass > 0]));
        *speed -= 0.5;
        assert_int_equal(memcmp(rate[0], rate[1], bytes) == 0, pass == 1);
        assert_true(f.s.ops->derivative(f.s.self, 0, y, NULL, rate[1]));
        for (int k = 0; k < 36 && pass == 0; k++) matrix[k] *= 2;
    }
    bough_arena_destroy(open.arena);
    bough_arena_destroy(f.arena);
}

// A crank turned at 1 rad/s: the kinetic energy is constant, so the drive balances the weight of
// the uprights at half their height and the coupler, 2 g cos φ.
TEST(driven_cranks_take_the_torque_of_the_weights) {
    windows w;
    make_windows(&w, 1, BOUGH_JOINT_REVOLUTE);
    w.body[0].motion = (bough_motion_def){.given = true, .speed = true, .from = 1, .to = 1};
    w.body[1].speeds[0] = w.body[2].speeds[0] = 0; // they follow
    for (int solver = BOUGH_IDA; solver <= BOUGH_RADAU5; solver += BOUGH_RADAU5) {
        fixture f = build_with(&w.def, solver, 1e-9);
        check_near(f.m->state[4], 1, 1e-9, 0);
        for (int k = 1; k <= 10; k++) {
            double t = 0.1 * k, acceleration[MOST];
            go_to(&f, t, k == 1);
            check_closed(&f, 1e-7);
            check_near(f.m->state[0], t, 0, 1e-14);
            check_near(f.m->state[1], t, 0, 1e-7);
            bough_tree_forward_dynamics(f.tree, f.data, t, NULL, acceleration);
            check_near(f.data->drive[0], -2 * 9.81 * sin(t), 0, 1e-5);
        }
        bough_arena_destroy(f.arena);
    }
}

// Off the closures the state comes back to them within a few time constants.
TEST(violations_decay) {
    windows w;
    double y[MOST];
    make_windows(&w, 1, BOUGH_JOINT_REVOLUTE);
    fixture f = build_with(&w.def, BOUGH_RADAU5, 1e-9);
    memcpy(y, f.m->state, (size_t)f.s.n_state * sizeof(double));
    y[1] += 0.01;
    bough_member_set(f.m, 0, y);
    double before, after, rate;
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_closure_error(f.tree, f.data, 0, &before, &rate);
    check_near(before, 0.01, 0.1, 0);
    go_to(&f, 0.05, true); // five of them
    tree_closure_error(f.tree, f.data, 0, &after, &rate);
    check_near(after / before, exp(-5), 0.5, 0);
}

// -- assembly --------------------------------------------------------------------------------

// The closure on the coupler or on the end of a rod, which keeps its place on the coupler, its root.
TEST(loops_are_assembled_from_near) {
    for (int ends = 0; ends <= 1; ends++) {
        windows w;
        make_windows(&w, 1, BOUGH_JOINT_REVOLUTE);
        w.body[0].coordinates[0] = 0.5;
        w.body[1].coordinates[0] = 0.52, w.body[2].coordinates[0] = -0.53;
        w.body[1].speeds[0] = w.body[2].speeds[0] = 0; // they follow
        w.body[3] = rod("end", 2, 0, 0);
        w.body[3].kind = BOUGH_JOINT_FREE;
        w.body[3].coordinates[0] = w.body[3].coordinates[3] = 1;
        w.body[3].inertia = diagonal(0.1, 0.1, 0.1);
        const bough_end_def end = {.body = 3};
        if (ends > 0) w.marker[0] = (bough_marker_def){"end", 3, bough_transform_identity()};
        w.def.n_bodies += ends, w.def.n_ends = ends, w.def.ends = &end;
        fixture f = build_with(&w.def, BOUGH_RADAU5, 1e-9);
        bough_tree_kinematics(f.tree, f.m->state, f.data);
        check_closed(&f, 1e-10);
        assert_true(f.tree->closure_moved > 1e-3 && f.tree->closure_moved < 0.05);
        const double *q = f.m->state, *v = q + f.tree->n_q;
        const double sign[] = {1, 1, -1}; // a parallelogram
        for (int k = 0; k < 3; k++) check_near(q[k], sign[k] * q[0], 1e-9, 0);
        for (int k = 0; k < 3; k++) check_near(v[k], sign[k], k > 0 ? 1e-9 : 0, 0); // the first is given
        for (int k = 0; k < 7 * ends; k++) check_near(q[3 + k], k == 0 || k == 3, 0, 1e-9);
        bough_arena_destroy(f.arena);
    }
}

// A shallow arch of rods whose far end must move by much more than the joints' first step.
TEST(arches_are_assembled) {
    enum { RODS = 8 };
    bough_body_def body[RODS];
    for (int i = 0; i < RODS; i++) {
        body[i] = rod("rod", i - 1, i > 0, 0);
        body[i].mass_centre = bough_v3(0.5, 0, 0);
        body[i].inertia = diagonal(0, 1.0 / 12, 1.0 / 12);
        body[i].coordinates[0] = i == 0 ? 0.15 : -0.04;
    }
    bough_marker_def marker[2] = {{"end", RODS - 1, bough_transform_identity()},
                                  {"wall", BOUGH_GROUND, bough_transform_identity()}};
    marker[0].placement.position = bough_v3(1, 0, 0);
    marker[1].placement.position = bough_v3(7.75, 0, 0);
    const bough_closure_def closure = {"pin", BOUGH_JOINT_SPHERICAL, {0, 1}, {0, 0, 1}, {1, 0, 0}};
    bough_tree_def def = {.gravity = down_z, .n_bodies = RODS, .bodies = body, .n_markers = 2};
    def.markers = marker, def.n_closures = 1, def.closures = &closure;
    fixture f = build_with(&def, BOUGH_RADAU5, 1e-8);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    check_closed(&f, 1e-9);
    assert_int_equal(f.tree->closure_rank, 2);
    tree_sums start = tree_sum(f.tree, f.data);
    for (int k = 1; k <= 20; k++) go_to(&f, 0.01 * k, k == 1);
    check_closed(&f, 1e-6);
    tree_sums end = tree_sum(f.tree, f.data);
    check_near(end.kinetic + end.potential, start.kinetic + start.potential, 0, 1e-5);
}

static void refused(const bough_tree_def *def, const char *what, const char *also) {
    check_arena(arena);
    bough_tree *tree;
    bough_status status = bough_tree_create(arena, def, &tree);
    check_fails(status, BOUGH_INVALID, what);
    check_fails(status, BOUGH_INVALID, also);
}

TEST(what_cannot_be_closed_is_refused) {
    windows w;
    make_windows(&w, 1, BOUGH_JOINT_REVOLUTE);
    w.body[1].coordinates[0] = 0.6; // far
    refused(&w.def, "closure 'close'", " m apart");
    make_windows(&w, 1, BOUGH_JOINT_REVOLUTE);
    w.marker[0].placement.position.y = 0.01; // beside the plane that nothing leaves
    refused(&w.def, "closure 'close'", "0.01 m apart");
    make_windows(&w, 1, BOUGH_JOINT_REVOLUTE);
    w.body[1].speeds[0] = 0.5;
    refused(&w.def, "separate", "closure 'close'");
    make_windows(&w, 1, BOUGH_JOINT_REVOLUTE);
    w.marker[1].body = w.marker[0].body;
    refused(&w.def, "closure 'close'", "nothing to close");
}

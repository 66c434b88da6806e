// Prescribed motion of joints: the functions of time, the tree that is driven by them, scenes.
#include "tests/unit/built_scene.h"
#include "tests/unit/contract.h"
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

static const double pi = BOUGH_PI;

static bough_motion *motion_of(bough_arena *arena, bough_motion_def def, double initial) {
    def.given = true;
    return bough_motion_create(arena, &def, initial);
}

// -- functions of time -----------------------------------------------------------------------

// The hub angle of Simo and Vu-Quoc's spin-up is the ramp of its speed.
TEST(ramp_of_speed_is_the_published_one) {
    check_arena(arena);
    bough_motion *m =
        motion_of(arena, (bough_motion_def){.speed = true, .to = 6, .start = 0, .end = 15}, 0.7);
    for (int k = 0; k <= 40; k++) {
        double t = 0.5 * k, w = 2 * pi / 15;
        double angle = t < 15 ? 0.4 * (0.5 * t * t + (cos(w * t) - 1) / (w * w)) : 6 * t - 45;
        check_near(bough_motion_at(m, t).q, 0.7 + angle, 1e-14, 1e-13);
    }
    check_near(bough_motion_at(m, -3).q, 0.7, 0, 0);
}

// Speed and acceleration are the derivatives, and continuous where pieces meet.
static void check_derivatives(const bough_motion *m, bool smooth) {
    double h = 1e-5;
    for (int k = 0; k < 70; k++) {
        double t = -0.53 + 0.1 * k;
        double back = bough_motion_at(m, t - h).q, q = bough_motion_at(m, t).q;
        double ahead = bough_motion_at(m, t + h).q;
        check_near(bough_motion_at(m, t).v, (ahead - back) / (2 * h), 1e-8, 1e-8);
        check_near(bough_motion_at(m, t).a, (ahead - 2 * q + back) / (h * h), 1e-4, 1e-4);
    }
    for (int k = 0; k <= 12; k++) {
        double t = 0.5 * k, eps = 1e-9;
        bough_motion_point a = bough_motion_at(m, t - eps), b = bough_motion_at(m, t + eps);
        check_near(b.q, a.q, 1e-7, 1e-7);
        check_near(b.v, a.v, 1e-7, 1e-7);
        if (smooth) check_near(b.a, a.a, 1e-6, 1e-6);
    }
}

TEST(speeds_and_accelerations_are_derivatives) {
    const double times[] = {0.5, 1, 2.5, 4}, values[] = {1, -2, 3, 0.5};
    check_arena(arena);
    bough_motion_def def = {.from = 0.3, .to = -1.2, .start = 1, .end = 4};
    check_derivatives(motion_of(arena, def, 0), true);
    def.speed = true;
    check_derivatives(motion_of(arena, def, 0.4), true);
    def = (bough_motion_def){.n = 4, .times = times, .values = values};
    bough_motion *spline = motion_of(arena, def, 0), *table;
    def.speed = true;
    table = motion_of(arena, def, 0.4);
    check_derivatives(table, false);
    // a spline at rest at both ends may jump in its acceleration there, nowhere else
    check_derivatives(spline, false);
    check_near(bough_motion_at(spline, 1 - 1e-9).a, bough_motion_at(spline, 1).a, 1e-7, 0);
    check_near(bough_motion_at(spline, 2.5 - 1e-9).a, bough_motion_at(spline, 2.5).a, 1e-7, 0);
    for (int i = 0; i < 4; i++) {
        check_near(bough_motion_at(spline, times[i]).q, values[i], 1e-14, 0);
        check_near(bough_motion_at(table, times[i]).v, values[i], 1e-14, 0);
    }
    check_near(bough_motion_at(table, 0).q, 0.4, 1e-15, 0);
    check_near(bough_motion_at(table, 5).q - bough_motion_at(table, 2.5).q, 1.75 * 1.5 + 0.5, 1e-14, 0);
    check_near(bough_motion_at(spline, 9).v, 0, 0, 0);
}

// Where values rise, fall or stay, the motion does: plateaus beside a step, steps between ramps, uneven
// times.
TEST(tables_of_positions_do_not_overshoot) {
    static const double times[][8] = {
        {0, 15, 16, 30}, {0, 1, 1.1, 5, 5.01, 9, 9.5, 12}, {0, 1, 2, 3, 4, 5, 6, 7}, {0, 15, 16, 30, 31, 45}};
    static const double values[][8] = {
        {0, 0, 5, 5}, {0, 1, 8, 8, -3, -3.1, -3.2, -9}, {0, 1, 4, 4, 3.9, 0, 0, 0}, {0, 0, 5, 5, 0, 0}};
    static const int n[] = {4, 8, 8, 6};
    check_arena(arena);
    for (int k = 0; k < 4; k++) {
        bough_motion_def def = {.n = n[k], .times = times[k], .values = values[k]};
        const bough_motion *m = motion_of(arena, def, 0);
        for (int i = 0; i + 1 < n[k]; i++) {
            double d = times[k][i + 1] - times[k][i], rise = values[k][i + 1] - values[k][i];
            double a = fmin(values[k][i], values[k][i + 1]), b = fmax(values[k][i], values[k][i + 1]);
            for (int j = 0; j < 100; j++) {
                bough_motion_point p = bough_motion_at(m, times[k][i] + 0.01 * j * d);
                assert_true(p.q >= a - 1e-12 && p.q <= b + 1e-12);
                assert_true(p.v * rise >= -1e-12 && fabs(p.v) <= 3 * fabs(rise) / d + 1e-12);
            }
            double t = times[k][i + 1];
            check_near(bough_motion_at(m, t - 1e-12).v, bough_motion_at(m, t).v, 1e-5, 1e-5);
        }
    }
}

// A sampled sine keeps its accelerations, at the maxima between its samples too.
TEST(smooth_tables_stay_smooth) {
    enum { SAMPLES = 41 };
    double times[SAMPLES], values[SAMPLES], w = 1.3;
    for (int i = 0; i < SAMPLES; i++) times[i] = 0.25 * i, values[i] = sin(w * times[i]);
    check_arena(arena);
    bough_motion_def def = {.n = SAMPLES, .times = times, .values = values};
    const bough_motion *m = motion_of(arena, def, 0);
    for (double t = 2; t < 8; t += 0.03) {
        check_near(bough_motion_at(m, t).q, sin(w * t), 0, 1e-4);
        check_near(bough_motion_at(m, t).v, w * cos(w * t), 0, 2e-3);
        check_near(bough_motion_at(m, t).a, -w * w * sin(w * t), 0, 2e-2);
    }
}

// -- the driven tree -------------------------------------------------------------------------

// A satellite, free or clamped, with a wheel on a driven shaft, a boom driven out along z from the
// wheel and a sprung hinge with a port at its end.
static fixture satellite(bough_joint_kind base, double rtol) {
    bough_body_def b[4];
    for (int i = 0; i < 4; i++) {
        b[i] = bough_body_def_default();
        b[i].parent = i - 1;
        b[i].mass = 1 + 0.3 * i, b[i].inertia = diagonal(0.3 + 0.1 * i, 0.4, 0.5);
        b[i].mass_centre = bough_v3(0.1, -0.05 * i, 0.2);
        b[i].joint.position = bough_v3(0.2, 0.1, 0.3 * i);
    }
    b[0].name = "base", b[0].kind = base, b[0].coordinates[3] = 1, b[0].speeds[3] = 0.4;
    b[1].name = "wheel", b[1].kind = BOUGH_JOINT_REVOLUTE, b[1].coordinates[0] = 0.3;
    b[1].axis = bough_v3(0.2, 0.1, 1);
    b[1].motion = (bough_motion_def){true, true, 0, 5, 0, 1, 0, NULL, NULL};
    b[2].name = "boom", b[2].kind = BOUGH_JOINT_PRISMATIC;
    b[2].motion = (bough_motion_def){true, false, 0.2, 0.9, 0, 1, 0, NULL, NULL};
    b[3].name = "hinge", b[3].kind = BOUGH_JOINT_REVOLUTE, b[3].axis = bough_v3(1, 0, 0.2);
    b[3].spring.stiffness = 3;
    bough_marker_def marker = {"end", 3, bough_transform_identity()};
    bough_port_def port = {.root = {.mass = 0.1}};
    bough_tree_def def = {
        .n_bodies = 4, .bodies = b, .n_markers = 1, .markers = &marker, .n_ports = 1, .ports = &port};
    if (base == BOUGH_JOINT_FIXED) def.gravity = bough_v3(0, 3, -9.81);
    return build(&def, rtol);
}

// What drives the wheel is an inner torque: momenta stay, and the motion is the given one exactly.
TEST(driven_joints_keep_the_momenta) {
    fixture f = satellite(BOUGH_JOINT_FREE, 1e-10);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_sums before = tree_sum(f.tree, f.data);
    for (int k = 1; k <= 15; k++) advance(&f, 0.1 * k, false);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_sums after = tree_sum(f.tree, f.data);
    bough_vec3 l = bough_sub(after.angular_momentum, before.angular_momentum);
    bough_vec3 p = bough_sub(after.linear_momentum, before.linear_momentum);
    check_near(bough_norm(l), 0, 0, 1e-7);
    check_near(bough_norm(p), 0, 0, 1e-7);
    assert_true(after.kinetic > before.kinetic + 1);
    check_near(f.m->state[7], 0.3 + 5 * (0.5 + 0.5), 1e-15, 0);
    check_near(f.m->state[8], 0.9, 1e-15, 0);
    check_near(f.m->state[f.tree->n_q + 6], 5, 1e-15, 0);
}

// The drives' power is the rate of the energy.
TEST(energy_is_what_the_drives_put_in) {
    fixture f = satellite(BOUGH_JOINT_FIXED, 1e-10);
    double work = 0, power = 0, h = 0.01, acceleration[8];
    tree_sums first = {0}, last = {0};
    for (int k = 0; k <= 100; k++) {
        if (k > 0) advance(&f, h * k, false);
        bough_tree_kinematics(f.tree, f.m->state, f.data);
        assert_true(bough_tree_forward_dynamics(f.tree, f.data, h * k, NULL, acceleration));
        last = tree_sum(f.tree, f.data);
        if (k == 0) first = last;
        const double *v = f.m->state + f.tree->n_q;
        power = f.data->drive[0] * v[0] + f.data->drive[1] * v[1];
        work += h * power * (k % 100 == 0 ? 1 : k % 2 == 1 ? 4 : 2) / 3; // Simpson
    }
    double gained =
        last.kinetic + last.potential + last.elastic - first.kinetic - first.potential - first.elastic;
    assert_true(fabs(gained) > 1);
    check_near(work, gained, 1e-5, 0);
}

TEST(recursions_agree_on_driven_joints) {
    fixture f = satellite(BOUGH_JOINT_FREE, 1e-6);
    double acceleration[MOST], residual[MOST], drive[MOST], u[6] = {1, -2, 0.5, 0.3, 0.8, -0.6};
    double t = 0.4;
    bough_tree_prescribe(f.tree, t, f.tree->initial);
    bough_tree_kinematics(f.tree, f.tree->initial, f.data);
    assert_true(bough_tree_forward_dynamics(f.tree, f.data, t, u, acceleration));
    memcpy(drive, f.data->drive, (size_t)f.tree->n_v * sizeof(double));
    bough_tree_inverse_dynamics(f.tree, f.data, t, u, acceleration, residual);
    for (int i = 0; i < f.tree->n_v; i++) {
        check_near(residual[i], 0, 0, 1e-12);
        check_near(f.data->drive[i], drive[i], 1e-12, 1e-12);
    }
    assert_true(fabs(drive[6]) > 0.1 && fabs(drive[7]) > 0.1);
}

TEST(driven_tree_fulfils_the_contract) {
    fixture f = satellite(BOUGH_JOINT_FREE, 1e-8);
    double y[MOST], u[6] = {1, -2, 0.5, 0.3, 0.8, -0.6};
    bough_tree_prescribe(f.tree, 0.2, f.tree->initial);
    memcpy(y, f.tree->initial, (size_t)f.s.n_state * sizeof(double));
    contract_point at = {0.2, y, u, 1e-5};
    contract_check(f.m, at, 0.07, 0.05);
    contract_set_state(f.m, at, 1e-4);
}

// A joint held still needs no inertia, and carries the moment of the weight.
TEST(locked_joint_reports_its_torque) {
    bough_body_def b = bough_body_def_default();
    b.name = "beam", b.kind = BOUGH_JOINT_REVOLUTE, b.axis = bough_v3(0, 1, 0);
    b.mass = 2, b.mass_centre = bough_v3(1.5, 0, 0);
    b.motion.given = b.motion.speed = true;
    bough_tree_def def = {.gravity = {0, 0, -9.81}, .n_bodies = 1, .bodies = &b};
    fixture f = build(&def, 1e-8);
    double acceleration;
    advance(&f, 3, false);
    check_near(f.m->state[0], 0, 0, 0);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    assert_true(bough_tree_forward_dynamics(f.tree, f.data, 3, NULL, &acceleration));
    check_near(acceleration, 0, 0, 0);
    check_near(f.data->drive[0], -2 * 9.81 * 1.5, 1e-14, 0); // y points away from the turn
}

// -- scenes ----------------------------------------------------------------------------------

TEST(scenes_drive_joints) {
    check_build(arena, s, "tests/data/scenes/motion.yaml", no_sets);
    bough_channels list = scene_channels(arena, s);
    assert_int_equal(s->master->n_event, 2 + 3 + 2 + 2 - 1); // two begin at 0
    check_near(s->master->event[2], 0.105, 1e-15, 0);
    while (s->master->time < 1) scene_step(s);
    check_near(scene_channel(s, &list, "tablePos"), 90, 1e-14, 0);
    check_near(scene_channel(s, &list, "fanVel"), 12.1 * 6, 1e-14, 0);
    check_near(scene_channel(s, &list, "fanPos"), 12.1 * 6, 1e-13, 0);
    check_near(scene_channel(s, &list, "fanTrq"), 0, 0, 1e-12);
    check_near(scene_channel(s, &list, "ramPos"), 3, 1e-15, 0);
    check_near(scene_channel(s, &list, "ramAngPos") * pi / 180, 2, 1e-8, 0); // it spins on freely
    check_near(scene_channel(s, &list, "ramFrc"), 4 * 9.80665, 1e-12, 0);
    check_near(scene_channel(s, &list, "gimbalAng1Pos"), 30, 1e-14, 0);
    check_near(scene_channel(s, &list, "gimbalAng2Pos"), 90, 1e-14, 0);
    // the mass stands up from the gimbal's x, leaned by 30 degrees: at (0, cos, sin) of them
    double lean = pi / 6;
    check_near(scene_channel(s, &list, "gimbalTrq1"), 2 * 9.80665 * cos(lean), 1e-12, 0);
    check_near(scene_channel(s, &list, "gimbalTrq2"), 0, 0, 1e-12);
    // the lift stands still, held against 4 kg
    check_near(scene_channel(s, &list, "liftVel"), 0, 0, 0);
    check_near(scene_channel(s, &list, "liftFrc"), 4 * 9.80665, 1e-12, 0);
    check_near(scene_channel(s, &list, "liftPos"), 0.5 * 0.105 * 2 + 0.5 * 0.295 * 2, 1e-12, 0);
}

// Given every tenth of a second where a sine will be, a motion follows it without a jump in speed,
// to the fourth order; the first span starts at rest from where the motion is.
TEST(steered_motion_follows) {
    check_arena(arena);
    bough_motion *m = motion_of(arena, (bough_motion_def){.from = 0.3, .to = 0.3}, 0);
    double worst = 0;
    for (int k = 0; k < 40; k++) {
        double t = 0.1 * k, next = 0.1 * (k + 1);
        bough_motion_point from = {sin(t), cos(t), 0}, to = {sin(next), cos(next), 0};
        bough_motion_steer(m, t, 0.1, from, to);
        check_near(bough_motion_at(m, t).q, sin(t), 1e-14, 1e-14);
        check_near(bough_motion_at(m, next).v, cos(next), 1e-12, 1e-12);
        worst = fmax(worst, fabs(bough_motion_at(m, t + 0.05).q - sin(t + 0.05)));
        check_derivatives(m, true);
    }
    assert_true(worst > 1e-8 && worst < 1e-4 / 384 * 1.1); // h⁴/384 of the fourth derivative
}

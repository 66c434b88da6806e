// Force elements between markers and applied wrenches: analytic motions, changes by differences,
// conservation, scenes.
#include "tests/unit/built_scene.h"
#include "tests/unit/contract.h"
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

#include "core/tree/force.h"

static void go_to(fixture *f, double t1) {
    advance(f, t1, false);
    bough_tree_kinematics(f->tree, f->m->state, f->data);
}

static bough_transform placed(double x, double y, double z, double turn) {
    bough_quaternion p = bough_quaternion_exponential(bough_v3(0.3 * turn, -turn, 0.5 * turn));
    return (bough_transform){{x, y, z}, bough_rotation_matrix(p)};
}

// Two free bodies with a spring and a bushing between them, a spring and a bushing to the ground, a
// wrench in ground axes and one in the body's.
static fixture mounted(double rtol, bool damped) {
    bough_body_def b[2];
    for (int i = 0; i < 2; i++) {
        b[i] = bough_body_def_default();
        b[i].name = i == 0 ? "one" : "two", b[i].kind = BOUGH_JOINT_FREE;
        b[i].mass = 1 + i, b[i].inertia = diagonal(0.4, 0.5, 0.6 + 0.1 * i);
        b[i].mass_centre = bough_v3(0.1, 0, -0.1 * i);
        double q[7] = {0.2 + i, 0.4 * i, -0.3, 0.8, 0.3 - 0.5 * i, 0.2, -0.4};
        double v[6] = {0.3, -0.4 * i, 0.2, 0.5, 0.7 - i, -0.6};
        memcpy(b[i].coordinates, q, sizeof q);
        memcpy(b[i].speeds, v, sizeof v);
    }
    static const char name[] = "marker";
    const bough_marker_def markers[] = {{name, 0, placed(0.1, 0.2, 0.3, 0.4)},
                                        {name, 1, placed(-0.3, 0.1, 0.2, -0.3)},
                                        {name, BOUGH_GROUND, placed(0.5, -1, 0, 0.2)}};
    double c = damped ? 1 : 0;
    const bough_spring_def springs[] = {{{0, 1}, 20, 0.4 * c, 0.5}, {{1, 2}, 9, 0.2 * c, 1.5}};
    const bough_bushing_def bushings[] = {
        {{0, 1}, {8, 5, 3, 4, 6, 2}, {0.4 * c, 0.2 * c, 0.3 * c, 0.2 * c, 0.1 * c, 0.5 * c}},
        {{2, 0}, {3, 5, 7, 2, 5, 4}, {0.1 * c, 0.2 * c, 0.3 * c, 0.1 * c, 0.4 * c, 0.2 * c}}};
    static const double times[] = {0, 0.3, 1}, values[] = {0.5, 2, -1};
    const bough_applied_def applied[] = {
        {0, {{1, -2, 3}, {0.4, 0.5, -0.6}}, true, {.start = 0, .end = 1}},
        {1, {{2, 1, -1}, {-0.4, 0.3, 0.6}}, false, {.n = 3, .times = times, .values = values}}};
    bough_tree_def def = {.gravity = {0, 0, -9.81},
                          LIST(bodies, b),
                          LIST(markers, markers),
                          LIST(springs, springs),
                          LIST(bushings, bushings),
                          .n_applied = damped ? 2 : 0,
                          .applied = applied};
    return build(&def, rtol);
}

// -- bushings --------------------------------------------------------------------------------

// About one axis and along one axis a bushing is a linear spring and damper at any amplitude.
TEST(bushing_is_linear_along_and_about_an_axis) {
    bough_body_def b = bough_body_def_default();
    b.name = "plate", b.kind = BOUGH_JOINT_FREE, b.mass = 2, b.inertia = diagonal(1, 1, 0.5);
    b.coordinates[2] = 0.7, b.coordinates[3] = cos(1.2), b.coordinates[6] = sin(1.2);
    const bough_marker_def markers[] = {{"ground", BOUGH_GROUND, bough_transform_identity()},
                                        {"plate", 0, bough_transform_identity()}};
    const bough_bushing_def bushing = {{0, 1}, {100, 100, 50, 30, 30, 8}, {0, 0, 0.8, 0, 0, 0.4}};
    bough_tree_def def = {.n_bodies = 1, .bodies = &b, LIST(markers, markers)};
    def.n_bushings = 1, def.bushings = &bushing;
    fixture f = build(&def, 1e-10);
    double t = 2.3, delta = 0.2, w = sqrt(25 - delta * delta);
    go_to(&f, t);
    check_near(f.m->state[2], 0.7 * exp(-delta * t) * (cos(w * t) + delta / w * sin(w * t)), 0, 1e-8);
    delta = 0.4, w = sqrt(16 - delta * delta);
    bough_vec3 turn = bough_quaternion_logarithm(
        (bough_quaternion){f.m->state[3], f.m->state[4], f.m->state[5], f.m->state[6]});
    check_near(turn.z, 2.4 * exp(-delta * t) * (cos(w * t) + delta / w * sin(w * t)), 0, 1e-8);
    check_near(f.m->state[0], 0, 0, 1e-12);
}

// Undamped elements keep the energy at large turns about changing axes, with unequal stiffnesses.
TEST(elements_conserve) {
    fixture f = mounted(1e-10, false);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_sums before = tree_sum(f.tree, f.data);
    double largest = 0;
    for (int k = 1; k <= 20; k++) {
        go_to(&f, 0.1 * k);
        tree_sums now = tree_sum(f.tree, f.data);
        check_near(now.kinetic + now.potential + now.elastic,
                   before.kinetic + before.potential + before.elastic, 1e-7, 1e-7);
        largest = fmax(largest, fabs(now.elastic - before.elastic));
    }
    assert_true(largest > 3);
}

// Action and reaction: the wrenches of an element in the ground about the ground's origin.
TEST(elements_act_and_react) {
    fixture f = mounted(1e-6, true);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    for (int e = 0; e < bough_tree_n_elements(f.tree); e++) {
        double energy, sum[6], size = 0;
        bough_force_pair pair = bough_element_force(f.tree, f.data, e, &energy);
        bough_wrench total = {{0, 0, 0}, {0, 0, 0}};
        for (int end = 0; end < 2; end++) {
            bough_transform x = bough_tree_frame_pose(f.data, bough_element_frame(f.tree, e, end));
            total = bough_wrench_add(total, bough_wrench_to_parent(&x, pair.on[end]));
            size += bough_norm(pair.on[end].force);
        }
        bough_wrench_store(total, sum);
        for (int i = 0; i < 6; i++) check_near(sum[i], 0, 0, 1e-13 * size);
        assert_true(size > 1 && energy > 0);
    }
}

static bough_twist moved(const double *change) { return bough_twist_load(change); }

static bough_transform shifted(bough_transform x, bough_twist by) {
    bough_transform step = {by.linear, bough_rotation_matrix(bough_quaternion_exponential(by.angular))};
    return bough_transform_compose(x, step);
}

// The change along poses and twists against central differences with the links' data changed.
TEST(changes_are_derivatives) {
    fixture f = mounted(1e-6, true);
    double direction[24], h = 1e-6, t = 0.4;
    for (int i = 0; i < 24; i++) direction[i] = sin(1.3 * i + 0.4);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    bough_transform pose[2] = {f.data->pose[0], f.data->pose[1]};
    bough_twist twist[2] = {f.data->twist[0], f.data->twist[1]};
    bough_twist shift[2] = {moved(direction), moved(direction + 6)};
    bough_twist rate[2] = {moved(direction + 12), moved(direction + 18)};
    for (int e = 0; e < bough_tree_n_elements(f.tree) + f.tree->n_applied; e++) {
        int k = e - bough_tree_n_elements(f.tree);
        double value[2][12] = {{0}}, expected[12] = {0}, energy;
        for (int side = 0; side < 2; side++) {
            double s = side == 0 ? h : -h;
            for (int i = 0; i < 2; i++) {
                bough_twist by = {bough_scale(s, shift[i].linear), bough_scale(s, shift[i].angular)};
                f.data->pose[i] = shifted(pose[i], by);
                f.data->twist[i].linear = bough_axpy(s, rate[i].linear, twist[i].linear);
                f.data->twist[i].angular = bough_axpy(s, rate[i].angular, twist[i].angular);
            }
            if (k >= 0) {
                bough_wrench_store(bough_applied_force(f.tree, f.data, k, t), value[side]);
                continue;
            }
            bough_force_pair pair = bough_element_force(f.tree, f.data, e, &energy);
            bough_wrench_store(pair.on[0], value[side]);
            bough_wrench_store(pair.on[1], value[side] + 6);
        }
        for (int i = 0; i < 2; i++) f.data->pose[i] = pose[i], f.data->twist[i] = twist[i];
        bough_twist s[2], r[2];
        for (int end = 0; end < 2; end++) {
            const bough_frame *frame =
                k >= 0 ? &f.tree->markers[f.tree->applied[k].marker] : bough_element_frame(f.tree, e, end);
            bough_twist none = {{0, 0, 0}, {0, 0, 0}};
            bool ground = frame->link < 0;
            s[end] = ground ? none : bough_twist_to_child(&frame->placement, shift[frame->link]);
            r[end] = ground ? none : bough_twist_to_child(&frame->placement, rate[frame->link]);
        }
        if (k >= 0) {
            bough_wrench_store(bough_applied_change(f.tree, f.data, k, t, s[0]), expected);
        } else {
            bough_force_pair change = bough_element_change(f.tree, f.data, e, s, r);
            bough_wrench_store(change.on[0], expected);
            bough_wrench_store(change.on[1], expected + 6);
        }
        for (int i = 0; i < 12; i++) {
            check_near(expected[i], (value[0][i] - value[1][i]) / (2 * h), 1e-7, 1e-7);
        }
    }
}

TEST(tree_with_forces_fulfils_the_contract) {
    fixture f = mounted(1e-8, true);
    double y[26], none[1] = {0};
    memcpy(y, f.m->state, sizeof y);
    contract_point at = {0.2, y, none, 1e-5};
    contract_check(f.m, at, 0.07, 0.05);
}

// -- applied wrenches ------------------------------------------------------------------------

// A force in ground axes at a point of a turning body pushes its mass centre straight; a factor from
// a table scales it.
TEST(wrench_in_ground_axes_pushes_straight) {
    const double times[] = {0, 1, 2}, values[] = {0, 1, 0};
    bough_body_def b = bough_body_def_default();
    b.name = "puck", b.kind = BOUGH_JOINT_FREE, b.mass = 2, b.inertia = diagonal(1, 1, 1);
    b.coordinates[3] = 1, b.speeds[5] = 4;
    const bough_marker_def marker = {"rim", 0, placed(0.5, 0, 0, 1)};
    const bough_applied_def applied = {
        0, {{6, 0, 0}, {0, 0, 0}}, true, {.n = 3, .times = times, .values = values}};
    bough_tree_def def = {
        .n_bodies = 1, .bodies = &b, .n_markers = 1, .markers = &marker, .n_applied = 1, .applied = &applied};
    fixture f = build(&def, 1e-10);
    go_to(&f, 1);
    check_near(f.m->state[0], 3.0 / 6, 1e-8, 0); // ∫∫ 3t
    check_near(f.m->state[1], 0, 0, 1e-8);
    go_to(&f, 2);
    check_near(f.m->state[0], 0.5 + 1.5 + 1.5 - 0.5, 1e-7, 0);
}

// -- scenes ----------------------------------------------------------------------------------

// A machine on its mounts, turned against the ground, sinks by m g/k; a second body is lifted by
// exactly its weight; a wheel is spun up by a force that turns with it.
TEST(scenes_mount_and_load_bodies) {
    check_build(arena, s, "tests/data/scenes/mounts.yaml", no_sets);
    bough_channels list = scene_channels(arena, s);
    check_near(scene_channel(s, &list, "mountFrcX"), 0, 0, 1e-12);
    assert_int_equal(s->master->n_event, 2);
    while (s->master->time < 4) scene_step(s);
    check_near(scene_channel(s, &list, "mountFrcX"), -10 * 9.81, 1e-6, 0); // x points down
    check_near(scene_channel(s, &list, "engineX"), 1, 0, 1e-9);
    check_near(scene_channel(s, &list, "engineZ"), 2 - 10 * 9.81 / 5000, 0, 1e-7);
    check_near(scene_channel(s, &list, "liftedPos"), 0, 0, 1e-9);
    double angle = scene_channel(s, &list, "wheelPos") * acos(-1.0) / 180;
    check_near(angle, 0.6 * (0.5 * 3.85 * 3.85 + 0.01 / 24), 1e-6, 0);
}

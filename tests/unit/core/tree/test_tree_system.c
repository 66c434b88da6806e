// The tree behind the contract: history, ports.
#include "tests/unit/contract.h"
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

TEST(tree_fulfils_the_contract) {
    fixture f = everything(1e-8);
    double y[MOST];
    memcpy(y, f.m->state, (size_t)f.s.n_state * sizeof(double));
    contract_point at = {0.2, y, some_input, 1e-5};
    contract_check(f.m, at, 0.07, 0.05);
    contract_set_state(f.m, at, 1e-4);
}

// Kept history over many macro steps agrees with a far tighter run.
TEST(kept_history_keeps_the_accuracy) {
    fixture f = everything(1e-7), tight = everything(1e-11);
    bough_statistics count;
    double coefficient[48] = {0};
    for (int i = 0; i < 24; i++) coefficient[i] = some_input[i % 12];
    bough_signal signal = {12, 0, 1, coefficient};
    for (int k = 1; k <= 25; k++) {
        check_ok(bough_member_advance(f.m, 0.02 * k, &signal, k == 1));
    }
    bough_member_advance(tight.m, 0.3, &signal, true); // the ramp's end is a kink
    bough_member_advance(tight.m, 0.5, &signal, true);
    for (int i = 0; i < f.s.n_state; i++) check_near(f.m->state[i], tight.m->state[i], 1e-5, 1e-5);
    count = bough_member_statistics(f.m);
    assert_int_equal(count.starts, 1);
    assert_true(count.steps > 0 && count.jacobians > 0 && count.derivatives > count.steps);
}

// A marker's wrench against the same wrench at the port in the same place.
TEST(external_wrench_acts_as_a_port_does) {
    fixture f = everything(1e-6);
    double a[MOST], b[MOST], zero[12] = {0}, later[6], rate[6] = {1, 0, -1, 2, 0, 1};
    bough_tree_set_wrench(f.tree, 2, 0, NULL, NULL, NULL);
    f.s.ops->derivative(f.s.self, 0.4, f.m->state, some_input, a);
    for (int m = 0; m < 2; m++) {
        for (int i = 0; i < 6; i++) later[i] = some_input[6 * m + i] - 0.3 * rate[i];
        bough_tree_set_wrench(f.tree, m, 0.1, later, rate, NULL);
    }
    f.s.ops->derivative(f.s.self, 0.4, f.m->state, zero, b);
    for (int i = 0; i < f.s.n_state; i++) check_near(b[i], a[i], 1e-11, 1e-11);
}

// Velocity queries against differences of poses along the motion.
TEST(frame_velocity_is_the_rate_of_the_pose) {
    fixture f = everything(1e-6);
    const bough_frame *marker = &f.tree->markers[2];
    double rate[MOST], y[MOST], h = 1e-6;
    bough_transform pose[2];
    f.s.ops->derivative(f.s.self, 0, f.m->state, some_input, rate);
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < f.s.n_state; i++) y[i] = f.m->state[i] + (side ? h : -h) * rate[i];
        bough_tree_kinematics(f.tree, y, f.data);
        pose[side] = bough_tree_frame_pose(f.data, marker);
    }
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    bough_twist v = bough_tree_frame_velocity(f.data, marker);
    bough_vec3 move = bough_sub(pose[1].position, pose[0].position);
    bough_vec3 turn = bough_quaternion_logarithm(bough_quaternion_of_matrix(
        bough_mat3_product(pose[1].rotation, bough_mat3_transpose(pose[0].rotation))));
    check_near(bough_norm(bough_axpy(-2 * h, v.linear, move)), 0, 0, 1e-8 * 2 * h);
    check_near(bough_norm(bough_axpy(-2 * h, v.angular, turn)), 0, 0, 1e-8 * 2 * h);
    assert_true(bough_norm(v.angular) > 0.1);
    int q, speed;
    assert_true(bough_tree_joint_rows(f.tree, tree_find_body(f.tree, "d"), &q, &speed));
    check_near(rate[q], f.m->state[speed], 0, 0);
    assert_false(bough_tree_joint_rows(f.tree, tree_find_body(f.tree, "e"), &q, &speed));
}

// The recursions of the tree against each other and against laws of mechanics.
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

TEST(inverse_dynamics_inverts_forward_dynamics) {
    fixture f = everything(1e-6);
    double acceleration[MOST], residual[MOST], bias[MOST], mass[MOST * MOST];
    double zero[MOST] = {0};
    int n = f.tree->n_v;
    double t = 0.2;
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    assert_true(bough_tree_forward_dynamics(f.tree, f.data, t, some_input, acceleration));
    bough_tree_inverse_dynamics(f.tree, f.data, t, some_input, acceleration, residual);
    bough_tree_inverse_dynamics(f.tree, f.data, t, some_input, zero, bias);
    tree_mass_matrix(f.tree, f.data, mass);
    for (int i = 0; i < n; i++) {
        check_near(residual[i], 0, 0, 1e-11);
        double sum = bias[i]; // M v̇ + h − τ with M by composite bodies
        for (int j = 0; j < n; j++) sum += mass[n * i + j] * acceleration[j];
        check_near(sum, 0, 0, 1e-11);
        assert_true(fabs(bias[i]) > 1e-6);
    }
}

TEST(kinetic_energy_is_the_mass_matrix_form) {
    fixture f = everything(1e-6);
    double mass[MOST * MOST], energy = 0;
    int n = f.tree->n_v;
    const double *v = f.m->state + f.tree->n_q;
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_mass_matrix(f.tree, f.data, mass);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) energy += 0.5 * v[i] * mass[n * i + j] * v[j];
    }
    check_near(tree_sum(f.tree, f.data).kinetic, energy, 1e-12, 0);
}

// Power of the loads = rate of the energy, by differences along the exact motion.
TEST(energy_follows_the_power_of_the_loads) {
    fixture f = everything(1e-11);
    f.tree->external[2].active = false;
    f.tree->n_loads = 0;
    for (int i = 0; i < f.tree->n_links; i++) f.tree->links[i].spring.damping = 0;
    f.tree->springs[0].damping = 0;
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_sums before = tree_sum(f.tree, f.data);
    for (int k = 1; k <= 10; k++) advance(&f, 0.1 * k, k == 1);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_sums after = tree_sum(f.tree, f.data);
    assert_true(fabs(after.kinetic - before.kinetic) > 1);
    assert_true(after.elastic > 0 && after.elastic != before.elastic);
    check_near(after.kinetic + after.potential + after.elastic,
               before.kinetic + before.potential + before.elastic, 1e-7, 1e-7);
}

// Along the motion: the links' accelerations of the forward dynamics, and ġ = −ω×g.
TEST(output_tangent_along_the_motion_is_the_acceleration) {
    fixture f = everything(1e-6);
    double rate[MOST], tangent[MOST], out[MOST];
    assert_true(f.s.ops->derivative(f.s.self, 0, f.m->state, some_input, rate));
    f.s.ops->output(f.s.self, 0, f.m->state, some_input, out);
    f.s.ops->output_tangent(f.s.self, 0, f.m->state, some_input, rate, NULL, tangent);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    double ignored[MOST];
    assert_true(bough_tree_forward_dynamics(f.tree, f.data, 0, some_input, ignored));
    for (int p = 0; p < 2; p++) {
        const bough_frame *port = &f.tree->ports[p];
        double expected[6];
        bough_twist_store(bough_twist_to_child(&port->placement, f.data->acceleration[port->link]), expected);
        for (int i = 0; i < 6; i++) check_near(tangent[9 * p + i], expected[i], 1e-12, 1e-12);
        bough_vec3 omega = bough_v3(out[9 * p + 3], out[9 * p + 4], out[9 * p + 5]);
        bough_vec3 g = bough_v3(out[9 * p + 6], out[9 * p + 7], out[9 * p + 8]);
        bough_vec3 gdot = bough_cross(g, omega);
        check_near(tangent[9 * p + 6], gdot.x, 1e-12, 1e-12);
        check_near(tangent[9 * p + 7], gdot.y, 1e-12, 1e-12);
        check_near(tangent[9 * p + 8], gdot.z, 1e-12, 1e-12);
        check_near(bough_norm(g), bough_norm(f.tree->gravity), 1e-14, 0);
    }
}

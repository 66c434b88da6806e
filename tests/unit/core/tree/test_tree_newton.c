// Newton's systems of the tree in O(n), against differences of the residual.
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

#include "core/tree/tree_newton.h"

static bough_transform placed(unsigned *seed) {
    bough_vec3 at = next3(seed);
    bough_quaternion p = bough_quaternion_exponential(next3(seed));
    return (bough_transform){at, bough_rotation_matrix(p)};
}

// Every kind of joint, branches, joint springs and a stop, driven joints at the root and in between,
// an end, springs and bushings between bodies and to the ground, applied wrenches.
static fixture everything_driven(void) {
    static const int parents[] = {BOUGH_GROUND, 0, 1, 1, 3, 4, 3, BOUGH_GROUND, 7, 8};
    static const bough_joint_kind kinds[] = {
        BOUGH_JOINT_REVOLUTE,  BOUGH_JOINT_SPHERICAL,   BOUGH_JOINT_FREE,   BOUGH_JOINT_PRISMATIC,
        BOUGH_JOINT_UNIVERSAL, BOUGH_JOINT_CYLINDRICAL, BOUGH_JOINT_PLANAR, BOUGH_JOINT_FREE,
        BOUGH_JOINT_REVOLUTE,  BOUGH_JOINT_REVOLUTE};
    unsigned seed = 5;
    bough_body_def bodies[10];
    for (int i = 0; i < 10; i++) bodies[i] = random_body(&seed, "body", parents[i], kinds[i]);
    bodies[9].spring = (bough_joint_spring){.stiffness = 7, .damping = 0.5, .rest = 0.3};
    bodies[3].spring =
        (bough_joint_spring){.stiffness = 3, .damping = 1, .low = -2, .high = -1.2, .stop_stiffness = 20};
    bodies[0].motion = (bough_motion_def){true, true, 0.4, 2, 0, 1, 0, NULL, NULL};
    bodies[8].motion = (bough_motion_def){true, false, -0.4, 0.6, 0, 1, 0, NULL, NULL};
    const bough_marker_def markers[] = {{"a", 2, placed(&seed)},
                                        {"b", 5, placed(&seed)},
                                        {"c", 9, placed(&seed)},
                                        {"d", BOUGH_GROUND, placed(&seed)},
                                        {"e", 1, placed(&seed)}};
    const bough_spring_def springs[] = {{{0, 1}, 20, 0.4, 0.5}, {{2, 3}, 9, 0.2, 1.5}};
    const bough_bushing_def bushings[] = {{{4, 2}, {8, 5, 3, 4, 6, 2}, {0.4, 0.2, 0.3, 0.2, 0.1, 0.5}},
                                          {{3, 1}, {3, 5, 7, 2, 5, 4}, {0.1, 0.2, 0.3, 0.1, 0.4, 0.2}}};
    const bough_schedule always = {.start = 0};
    const bough_applied_def applied[] = {{0, {{1, -2, 3}, {0.4, 0.5, -0.6}}, true, always},
                                         {2, {{2, 1, -1}, {-0.4, 0.3, 0.6}}, false, always}};
    const bough_end_def ends[] = {{7, {.mass = 0.3}}};
    bough_tree_def def = {.gravity = {1, -2, -9},
                          LIST(bodies, bodies),
                          LIST(markers, markers),
                          LIST(springs, springs),
                          LIST(bushings, bushings),
                          LIST(applied, applied),
                          LIST(ends, ends)};
    return build(&def, 1e-6);
}

static const double input[6] = {3, -2, 1, 0.5, 0.4, -0.8};

// The rows of the integrator at (y, v̇)
static void residual(const fixture *f, double t, const double *y, const double *rate, double *r) {
    const bough_tree *tree = f->tree;
    bough_tree_kinematics(tree, y, f->data);
    bough_tree_coordinate_rate(tree, y, r);
    for (int i = 0; i < tree->n_q; i++) r[i] = rate[i] - r[i];
    bough_tree_inverse_dynamics(tree, f->data, t, input, rate + tree->n_q, r + tree->n_q);
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        if (link->motion == NULL) continue;
        r[link->first_coordinate] = y[link->first_coordinate];
        r[tree->n_q + link->first_speed] = y[tree->n_q + link->first_speed];
    }
}

// x with ∂F/∂y x + c ∂F/∂ẏ x given by differences along x.
TEST(solve_inverts_the_differences) {
    fixture f = everything_driven();
    bough_tree_newton *newton = bough_tree_newton_create(f.arena, f.tree);
    int n = f.tree->n_q + f.tree->n_v;
    double rate[MOST], x[MOST], y[MOST], yp[MOST], r[2][MOST], h = 1e-6, t = 0.3;
    unsigned seed = 9;
    memcpy(y, f.tree->initial, (size_t)n * sizeof(double));
    for (int i = 0; i < n; i++) rate[i] = sample_random(&seed);
    for (int trial = 0; trial < 6; trial++) {
        double c = trial < 3 ? 12 : 3e4;
        assert_true(bough_tree_newton_setup(newton, f.data, t, input, y, rate + f.tree->n_q, c));
        for (int i = 0; i < n; i++) x[i] = sample_random(&seed);
        for (int side = 0; side < 2; side++) {
            double s = side == 0 ? h : -h, changed[MOST];
            for (int i = 0; i < n; i++) {
                changed[i] = y[i] + s * x[i];
                yp[i] = rate[i] + s * c * x[i];
            }
            residual(&f, t, changed, yp, r[side]);
        }
        for (int i = 0; i < n; i++) r[0][i] = (r[0][i] - r[1][i]) / (2 * h);
        bough_tree_newton_solve(newton, NULL, r[0]);
        for (int i = 0; i < n; i++) check_near(r[0][i], x[i], 0, 1e-7);
    }
}

// A known change of v̇ adds as the mass matrix times it would on the right.
TEST(known_accelerations_are_forces) {
    fixture f = everything_driven();
    bough_tree_newton *newton = bough_tree_newton_create(f.arena, f.tree);
    int n_q = f.tree->n_q, n_v = f.tree->n_v;
    double rate[MOST] = {0}, a[MOST], x[MOST] = {0}, y[MOST] = {0}, mass[MOST * MOST];
    unsigned seed = 3;
    for (int i = 0; i < n_v; i++) a[i] = sample_random(&seed);
    for (int i = 0; i < f.tree->n_links; i++) {
        if (f.tree->links[i].motion != NULL) a[f.tree->links[i].first_speed] = 0;
    }
    assert_true(bough_tree_newton_setup(newton, f.data, 0.3, input, f.tree->initial, rate, 20));
    bough_tree_kinematics(f.tree, f.tree->initial, f.data);
    tree_mass_matrix(f.tree, f.data, mass);
    for (int i = 0; i < n_v; i++) {
        for (int j = 0; j < n_v; j++) y[n_q + i] -= mass[n_v * i + j] * a[j];
    }
    for (int i = 0; i < f.tree->n_links; i++) {
        if (f.tree->links[i].motion != NULL) y[n_q + f.tree->links[i].first_speed] = 0;
    }
    bough_tree_newton_solve(newton, a, x);
    bough_tree_newton_solve(newton, NULL, y);
    for (int i = 0; i < n_q + n_v; i++) check_near(x[i], y[i], 1e-10, 1e-11);
}

// The rigid tree: analytic motions, and how bodies hang together.
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

// -- analytic motions ------------------------------------------------------------------------

// A point mass m = 1 on a massless rod l = 1 about the y axis, from (−1, 0) at rest.
TEST(pendulum_follows_the_elliptic_solution) {
    bough_body_def b = bough_body_def_default();
    b.name = "bob", b.kind = BOUGH_JOINT_REVOLUTE, b.axis = bough_v3(0, 1, 0);
    b.mass = 1, b.mass_centre = bough_v3(-1, 0, 0);
    bough_tree_def def = {.gravity = down_z, .n_bodies = 1, .bodies = &b};
    fixture f = build(&def, 1e-10);
    advance(&f, 2.367841947577, true); // one period
    check_near(f.m->state[0], 0, 0, 2e-6);
    check_near(f.m->state[1], 0, 0, 2e-6);
    for (int k = 1; k <= 100; k++) {
        double t = 0.1 * k;
        if (t > 2.367841947577) advance(&f, t, false);
    }
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    bough_vec3 at = tree_sum(f.tree, f.data).mass_centre;
    check_near(at.x, -.2750874625761, 0, 1e-6);
    check_near(at.z, -.9614192050991, 0, 1e-6);
}

// Point masses, l = 1 each, both horizontal and at rest. Absolute angles θ1, θ2 from the vertical
// start at π/2; the joints turn about y from the horizontal, θ = π/2 − (sum of joint angles).
TEST(double_pendulum_reaches_the_known_angles) {
    bough_body_def b[2] = {bough_body_def_default(), bough_body_def_default()};
    for (int i = 0; i < 2; i++) {
        b[i].name = "bob", b[i].kind = BOUGH_JOINT_REVOLUTE, b[i].axis = bough_v3(0, 1, 0);
        b[i].mass = 1, b[i].mass_centre = bough_v3(1, 0, 0);
    }
    b[1].parent = 0, b[1].joint.position = bough_v3(1, 0, 0);
    bough_tree_def def = {.gravity = down_z, .n_bodies = 2, .bodies = b};
    fixture f = build(&def, 1e-11);
    advance(&f, 1, true);
    check_near(BOUGH_PI / 2 - f.m->state[0], -.6250876998, 0, 1e-7);
    check_near(BOUGH_PI / 2 - f.m->state[0] - f.m->state[1], -1.0345850857, 0, 1e-7);
}

static bough_tree_def free_body_def(bough_body_def *b, bough_mat3 inertia) {
    *b = bough_body_def_default();
    b->name = "top", b->kind = BOUGH_JOINT_FREE, b->mass = 2, b->inertia = inertia;
    double q[7] = {1, 2, 3, 0.9, 0.1, -0.3, 0.2};
    memcpy(b->coordinates, q, sizeof q);
    return (bough_tree_def){.n_bodies = 1, .bodies = b};
}

// Ω of a body with moments (A, A, C): Ω3 constant, (Ω1, Ω2) turns at λ = (C − A)/A·Ω3.
TEST(axisymmetric_body_precesses) {
    bough_body_def b;
    bough_tree_def def = free_body_def(&b, diagonal(0.5, 0.5, 0.9));
    double v[6] = {0.3, -0.2, 0.1, 1.5, 0, 4};
    memcpy(b.speeds, v, sizeof v);
    fixture f = build(&def, 1e-10);
    double t = 3.7, lambda = (0.9 - 0.5) / 0.5 * 4;
    advance(&f, t, true);
    check_near(f.m->state[10], 1.5 * cos(lambda * t), 0, 1e-7);
    check_near(f.m->state[11], 1.5 * sin(lambda * t), 0, 1e-7);
    check_near(f.m->state[12], 4, 1e-9, 0);
}

// The mass centre flies straight, energy and both momenta stay, though the intermediate axis tips.
TEST(free_asymmetric_body_conserves) {
    bough_body_def b;
    bough_tree_def def = free_body_def(&b, diagonal(0.5, 0.7, 0.9));
    b.mass_centre = bough_v3(0.1, -0.2, 0.3);
    double v[6] = {0.3, -0.2, 0.1, 0.02, 3, 0.01};
    memcpy(b.speeds, v, sizeof v);
    fixture f = build(&def, 1e-10);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_sums before = tree_sum(f.tree, f.data);
    double turned_most = 3;
    for (int k = 1; k <= 400; k++) {
        advance(&f, 0.05 * k, k == 1);
        turned_most = fmin(turned_most, f.m->state[11]);
    }
    assert_true(turned_most < -2.9); // the intermediate axis did tip over
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    tree_sums after = tree_sum(f.tree, f.data);
    check_near(after.kinetic, before.kinetic, 1e-6, 0);
    bough_vec3 l = bough_sub(after.angular_momentum, before.angular_momentum);
    bough_vec3 p = bough_sub(after.linear_momentum, before.linear_momentum);
    check_near(bough_norm(l), 0, 0, 1e-6 * bough_norm(before.angular_momentum));
    check_near(bough_norm(p), 0, 0, 1e-5);
    bough_vec3 way = bough_axpy(20 / before.mass, before.linear_momentum, before.mass_centre);
    check_near(bough_norm(bough_sub(after.mass_centre, way)), 0, 0, 1e-4);
    const double *q = f.m->state + 3;
    check_near(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-14, 0);
}

// A constant torque M on a revolute joint of inertia J without gravity, ramped over [1, 3] s:
// ω = M/J·∫ factor.
TEST(ramped_joint_load_spins_up) {
    bough_body_def b = bough_body_def_default();
    b.name = "rotor", b.kind = BOUGH_JOINT_REVOLUTE, b.axis = bough_v3(0, 0, 2);
    b.inertia = diagonal(1, 1, 4);
    bough_joint_load_def load = {.body = 0, .value = 8, .schedule = {.start = 1, .end = 3}};
    bough_tree_def def = {.n_bodies = 1, .bodies = &b, .n_loads = 1, .loads = &load};
    fixture f = build(&def, 1e-9);
    advance(&f, 1, true);
    check_near(f.m->state[1], 0, 0, 1e-12);
    advance(&f, 2, true);
    check_near(f.m->state[1], 2 * 0.25, 1e-6, 0);
    advance(&f, 3, false);
    check_near(f.m->state[1], 2 * 1.0, 1e-6, 0);
    advance(&f, 4, true);
    check_near(f.m->state[1], 2 * 2.0, 1e-6, 0);
}

// J θ̈ + c θ̇ + k (θ − θ₀) = 0 from rest at θ = 0: θ₀ (1 − e^(−δt) (cos ωt + δ/ω sin ωt)).
TEST(sprung_joint_oscillates_and_decays) {
    bough_body_def b = bough_body_def_default();
    b.name = "balance", b.kind = BOUGH_JOINT_REVOLUTE, b.inertia = diagonal(1, 1, 0.5);
    b.spring = (bough_joint_spring){.stiffness = 8, .damping = 0.4, .rest = 0.7};
    bough_tree_def def = {.gravity = down_z, .n_bodies = 1, .bodies = &b};
    fixture f = build(&def, 1e-10);
    double delta = 0.4 / (2 * 0.5), omega = sqrt(8 / 0.5 - delta * delta);
    double period = 2 * BOUGH_PI / omega;
    for (int k = 1; k <= 8; k++) {
        double t = 0.25 * k * period, decay = exp(-delta * t);
        advance(&f, t, k == 1);
        double expected = 0.7 * (1 - decay * (cos(omega * t) + delta / omega * sin(omega * t)));
        check_near(f.m->state[0], expected, 0, 1e-7);
        check_near(f.m->state[1], 0.7 * decay * 16 / omega * sin(omega * t), 0, 1e-6);
    }
    check_near(f.m->state[0], 0.7 * (1 - exp(-2 * delta * period)), 0, 1e-7);
}

// A slider flies between its stops, gives its energy to the one and comes back as fast.
TEST(stops_throw_back_without_loss) {
    bough_body_def b = bough_body_def_default();
    b.name = "slider", b.kind = BOUGH_JOINT_PRISMATIC, b.mass = 2;
    b.speeds[0] = 3;
    b.spring = (bough_joint_spring){.low = -0.5, .high = 0.5, .stop_stiffness = 5000};
    bough_tree_def def = {.n_bodies = 1, .bodies = &b};
    fixture f = build(&def, 1e-10);
    // k/2 (p² − w p + w²/3) = m v²/2 with w = 0.01
    double w = 0.01, e = 0.5 * 2 * 9, k = 5000, deepest = 0;
    double p = 0.5 * w + sqrt(0.25 * w * w - w * w / 3 + 2 * e / k);
    for (int i = 1; i <= 1200; i++) {
        advance(&f, 0.001 * i, i == 1);
        deepest = fmax(deepest, fabs(f.m->state[0]) - 0.5);
        bough_tree_kinematics(f.tree, f.m->state, f.data);
        tree_sums sum = tree_sum(f.tree, f.data);
        check_near(sum.kinetic + sum.elastic, e, 1e-6, 0);
        if (fabs(f.m->state[0]) < 0.5) check_near(fabs(f.m->state[1]), 3, 1e-6, 0);
    }
    check_near(deepest, p, 1e-3, 0);
}

// Two free masses on a spring: the relative motion has the reduced mass, the sum of momenta stays.
TEST(two_bodies_swing_on_a_spring) {
    bough_body_def b[2] = {bough_body_def_default(), bough_body_def_default()};
    bough_marker_def markers[2] = {{"a", 0, bough_transform_identity()},
                                   {"b", 1, bough_transform_identity()}};
    for (int i = 0; i < 2; i++) {
        b[i].name = "mass", b[i].kind = BOUGH_JOINT_FREE, b[i].mass = 1 + 2 * i;
        b[i].inertia = diagonal(1, 1, 1), b[i].coordinates[3] = 1;
    }
    b[1].coordinates[0] = 2.5, b[0].speeds[4] = 1; // the turning marker feels it all the same
    bough_spring_def spring = {{0, 1}, 12, 0, 2};
    bough_tree_def def = {
        .n_bodies = 2, .bodies = b, .n_markers = 2, .markers = markers, .n_springs = 1, .springs = &spring};
    fixture f = build(&def, 1e-10);
    double omega = sqrt(12 / 0.75), t = 1.3;
    advance(&f, t, true);
    check_near(f.m->state[7] - f.m->state[0], 2 + 0.5 * cos(omega * t), 1e-7, 0);
    check_near(f.m->state[0] + 3 * f.m->state[7], 7.5, 1e-8, 0);
}

// A body thrown along a cylindrical joint and spun about it: h = v t − g cos(α) t²/2, φ = ω t, with
// the axis z leaned by α about x.
TEST(cylindrical_joint_slides_and_spins) {
    bough_body_def b = bough_body_def_default();
    b.name = "screwless", b.kind = BOUGH_JOINT_CYLINDRICAL;
    b.joint.rotation = turned(0.4, 0, 0);
    b.mass = 2, b.inertia = diagonal(1, 1, 4);
    b.coordinates[0] = 0.5, b.speeds[0] = 3, b.speeds[1] = 7;
    bough_tree_def def = {.gravity = down_z, .n_bodies = 1, .bodies = &b};
    fixture f = build(&def, 1e-9);
    advance(&f, 1.5, true);
    check_near(f.m->state[0], 0.5 + 3 * 1.5 - 0.5 * 9.81 * cos(0.4) * 1.5 * 1.5, 1e-7, 0);
    check_near(f.m->state[1], 7 * 1.5, 1e-7, 0);
}

// On a plane leaned by α about x: the mass centre, off the body's origin, is thrown on a parabola
// while the body spins steadily.
TEST(planar_joint_throws_on_a_parabola) {
    bough_body_def b = bough_body_def_default();
    b.name = "puck", b.kind = BOUGH_JOINT_PLANAR;
    b.joint.rotation = turned(0.4, 0, 0);
    b.mass = 2, b.inertia = diagonal(1, 1, 4), b.mass_centre = bough_v3(0.3, 0, 0);
    b.speeds[0] = 1, b.speeds[1] = 2, b.speeds[2] = 5;
    bough_tree_def def = {.gravity = down_z, .n_bodies = 1, .bodies = &b};
    fixture f = build(&def, 1e-10);
    double t = 1.3;
    advance(&f, t, true);
    const double *q = f.m->state;
    check_near(q[2], 5 * t, 1e-7, 0);
    check_near(q[0] + 0.3 * cos(q[2]), 0.3 + 1 * t, 1e-7, 0);
    check_near(q[1] + 0.3 * sin(q[2]), (2 + 5 * 0.3) * t - 0.5 * 9.81 * sin(0.4) * t * t, 1e-7, 0);
}

// A spherical pendulum on a universal joint (about x, then y) against the same on a spherical one:
// the bob is a point, so that the spin about the rod does not count.
TEST(universal_joint_swings_as_a_spherical_pendulum) {
    bough_body_def b = bough_body_def_default();
    b.name = "bob", b.kind = BOUGH_JOINT_UNIVERSAL;
    b.axis = bough_v3(2, 0, 0), b.second_axis = bough_v3(0, 1, 0);
    b.mass = 1.5, b.mass_centre = bough_v3(0, 0, -1), b.inertia = diagonal(1e-6, 1e-6, 1e-6);
    b.speeds[0] = 1.5, b.speeds[1] = -2;
    bough_body_def c = b;
    c.kind = BOUGH_JOINT_SPHERICAL, c.coordinates[0] = 1;
    bough_tree_def universal = {.gravity = down_z, .n_bodies = 1, .bodies = &b};
    bough_tree_def ball = {.gravity = down_z, .n_bodies = 1, .bodies = &c};
    fixture f = build(&universal, 1e-10), g = build(&ball, 1e-10);
    assert_int_equal(f.s.n_state, 4);
    tree_sums before, after, other;
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    before = tree_sum(f.tree, f.data);
    advance(&f, 2, true);
    advance(&g, 2, true);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    bough_tree_kinematics(g.tree, g.m->state, g.data);
    after = tree_sum(f.tree, f.data);
    other = tree_sum(g.tree, g.data);
    check_near(after.kinetic + after.potential, before.kinetic + before.potential, 1e-7, 0);
    // the ball may spin, which a small inertia of the bob feels by its square
    check_near(bough_norm(bough_sub(after.mass_centre, other.mass_centre)), 0, 0, 1e-5);
    int q, v;
    assert_true(bough_tree_joint_rows(f.tree, 0, &q, &v));
    assert_int_equal(q, 0);
    assert_int_equal(v, 2);
}

// 8 N m falling to 0 from 1 s to 3 s, on J = 4.
TEST(tabulated_joint_load_spins_up) {
    const double times[] = {1, 3}, values[] = {8, 0};
    bough_body_def b = bough_body_def_default();
    b.name = "rotor", b.kind = BOUGH_JOINT_REVOLUTE, b.inertia = diagonal(1, 1, 4);
    bough_joint_load_def load = {
        .body = 0, .value = 1, .schedule = {.n = 2, .times = times, .values = values}};
    bough_tree_def def = {.n_bodies = 1, .bodies = &b, .n_loads = 1, .loads = &load};
    fixture f = build(&def, 1e-9);
    advance(&f, 1, true);
    check_near(f.m->state[1], 2, 1e-6, 0);
    advance(&f, 2, true);
    check_near(f.m->state[1], 2 + 2 * 0.75, 1e-6, 0);
    advance(&f, 3, false);
    advance(&f, 4, true);
    check_near(f.m->state[1], 2 + 2, 1e-6, 0);
}

// -- topology --------------------------------------------------------------------------------

// Pendulum whose mass sits on a body welded to it, hung from a tower and a nacelle welded to the
// ground, against the same masses in one body.
TEST(welded_bodies_move_as_one) {
    unsigned seed = 11;
    bough_body_def whole = random_body(&seed, "whole", BOUGH_GROUND, BOUGH_JOINT_SPHERICAL);
    bough_body_def extra = random_body(&seed, "extra", 2, BOUGH_JOINT_FIXED);
    bough_body_def tower = random_body(&seed, "tower", BOUGH_GROUND, BOUGH_JOINT_FIXED);
    bough_body_def parts[3] = {extra, tower, whole}; // children before parents
    parts[2].parent = 1;
    parts[2].joint = bough_transform_compose(bough_transform_inverse(tower.joint), whole.joint);
    bough_inertia sum =
        bough_inertia_add(bough_inertia_of(whole.mass, whole.mass_centre, whole.inertia),
                          bough_inertia_to_parent(
                              &extra.joint, bough_inertia_of(extra.mass, extra.mass_centre, extra.inertia)));
    whole.mass = sum.mass;
    whole.mass_centre = bough_scale(1 / sum.mass, sum.first);
    bough_mat3 shift = bough_steiner(bough_scale(-0.5, sum.first), whole.mass_centre);
    whole.inertia = bough_mat3_add(sum.rotational, shift);
    bough_tree_def one = {.gravity = down_z, .n_bodies = 1, .bodies = &whole};
    bough_tree_def three = {.gravity = down_z, .n_bodies = 3, .bodies = parts};
    fixture a = build(&one, 1e-9), b = build(&three, 1e-9);
    assert_int_equal(b.s.n_state, 7);
    assert_int_equal(b.tree->n_links, 1);
    advance(&a, 1, true);
    advance(&b, 1, true);
    for (int i = 0; i < 7; i++) check_near(b.m->state[i], a.m->state[i], 0, 1e-6);
    assert_true(fabs(a.m->state[1] - a.tree->initial[1]) > 1e-2);
}

// A port's root inertia is felt as a body welded there.
TEST(root_inertia_is_felt_as_a_welded_body) {
    unsigned seed = 21;
    bough_body_def b[2] = {random_body(&seed, "hub", BOUGH_GROUND, BOUGH_JOINT_FREE),
                           random_body(&seed, "root", 0, BOUGH_JOINT_FIXED)};
    bough_marker_def marker = {"flange", 0, b[1].joint};
    bough_port_def port = {.root = bough_inertia_of(b[1].mass, b[1].mass_centre, b[1].inertia)};
    bough_tree_def welded = {.gravity = down_z, .n_bodies = 2, .bodies = b};
    bough_tree_def ported = {.gravity = down_z, .n_bodies = 1, .bodies = b, .n_ports = 1, .ports = &port};
    ported.n_markers = 1;
    ported.markers = &marker;
    fixture f = build(&welded, 1e-6), g = build(&ported, 1e-6);
    double a[MOST], c[MOST], zero[6] = {0};
    f.s.ops->derivative(f.s.self, 0, f.m->state, NULL, a);
    g.s.ops->derivative(g.s.self, 0, g.m->state, zero, c);
    for (int i = 0; i < f.s.n_state; i++) check_near(c[i], a[i], 1e-12, 1e-12);
}

TEST(ground_fixed_tree_has_no_states) {
    bough_body_def b = bough_body_def_default();
    b.name = "base", b.joint.position = bough_v3(1, 2, 3);
    b.joint.rotation = turned(0, BOUGH_PI / 2, 0); // x to −z
    bough_marker_def marker = {"clamp", 0, bough_transform_identity()};
    bough_port_def port = {.root = {.mass = 1}};
    bough_tree_def def = {.gravity = down_z, .n_bodies = 1, .bodies = &b, .n_ports = 1, .ports = &port};
    def.n_markers = 1, def.markers = &marker;
    fixture f = build(&def, 1e-6);
    assert_int_equal(f.s.n_state, 0);
    assert_int_equal(f.s.n_input, 6);
    double out[9], rate[9], u[6] = {1, 2, 3, 4, 5, 6}, coefficient[24] = {0};
    bough_signal signal = {6, 0, 1, coefficient};
    check_ok(bough_member_advance(f.m, 1, &signal, true));
    check_near(f.m->time, 1, 0, 0);
    f.s.ops->output(f.s.self, 1, f.m->state, u, out);
    f.s.ops->output_tangent(f.s.self, 1, f.m->state, u, f.m->state, NULL, rate);
    const double expected[9] = {0, 0, 0, 0, 0, 0, 9.81, 0, 0};
    for (int i = 0; i < 9; i++) {
        check_near(out[i], expected[i], 0, 1e-14);
        check_near(rate[i], 0, 0, 0);
    }
    void *factors = f.s.ops->factors(f.s.self, f.arena);
    assert_non_null(factors);
    assert_true(f.s.ops->linearise(f.s.self, 1, f.m->state, u, factors));
    assert_true(f.s.ops->factor(f.s.self, factors, 0.1));
    f.s.ops->solve(f.s.self, factors, out);
    bough_tree_kinematics(f.tree, f.m->state, f.data);
    check_near(bough_tree_frame_pose(f.data, &f.tree->markers[0]).position.y, 2, 0, 0);
}

static bough_code create_code(const bough_body_def *bodies, int n, const char *word) {
    check_arena(arena);
    bough_tree *tree;
    bough_tree_def def = {.n_bodies = n, .bodies = bodies};
    bough_status status = bough_tree_create(arena, &def, &tree);
    assert_true(bough_is_ok(&status) || strstr(status.message, word) != NULL);
    return status.code;
}

TEST(bad_defs_are_named) {
    unsigned seed = 2;
    bough_body_def b[2] = {random_body(&seed, "one", BOUGH_GROUND, BOUGH_JOINT_REVOLUTE),
                           random_body(&seed, "two", 0, BOUGH_JOINT_SPHERICAL)};
    bough_body_def good[2] = {b[0], b[1]};
    assert_int_equal(create_code(b, 2, ""), BOUGH_OK);
    b[1].joint.position.y = (double)INFINITY;
    assert_int_equal(create_code(b, 2, "'two'"), BOUGH_INVALID);
    b[1] = good[1], b[1].mass = 0, b[1].inertia = diagonal(0, 0, 0);
    assert_int_equal(create_code(b, 2, "'two'"), BOUGH_INVALID);
    // a point mass on its own axis, and a free point mass away from its origin
    b[1] = good[1], b[1].inertia = diagonal(0, 0, 0);
    b[1].kind = BOUGH_JOINT_REVOLUTE, b[1].mass_centre = b[1].axis;
    assert_int_equal(create_code(b, 2, "inertia"), BOUGH_INVALID);
    b[1].kind = BOUGH_JOINT_FREE;
    assert_int_equal(create_code(b, 2, "inertia"), BOUGH_INVALID);
}

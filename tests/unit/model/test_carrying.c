// Rods that carry bodies, as scenes: statics, frequencies, conservation against theory, and every
// coupling scheme against the monolithic one.
#include "apps/bough/model/equilibrium.h"
#include "core/tree/force.h"
#include "tests/unit/built_scene.h"
#include "tests/unit/rod_energy.h"
#include "tests/unit/tree_measure.h"

static const char tip_weight[] = "tests/data/scenes/tip-weight.yaml";
static const char mast[] = "tests/data/scenes/tower.yaml";
static const char parked[] = "tests/data/scenes/parked.yaml";

static bough_vec3 tip_of(const bough_simulation *s) {
    bough_quaternion rotation;
    return bough_simulation_beam_tip(s, &s->beam[0], &rotation);
}

static double tip_velocity(const bough_simulation *s, int axis) {
    return bough_simulation_rod_input(s, &s->beam[0])[BOUGH_ROD_INPUTS + axis];
}

static void run(bough_simulation *s) {
    while (!bough_master_done(s->master)) scene_step(s);
}

// -- accelerations between steps ------------------------------------------------------------------

// At one time they are found once, and again after an update, then under the forces of that moment.
TEST(accelerations_stay_until_the_next_update) {
    check_build(arena, s, tip_weight, no_sets);
    for (int k = 0; k < 3; k++) scene_step(s);
    double t = s->master->time, *force = s->master->coupling->input;
    bough_simulation_update(s);
    assert_true(bough_simulation_accelerate(s, t));
    int link = s->tree->bodies[1].link;
    bough_vec3 before = s->view->acceleration[link].linear;
    for (int j = 0; j < s->master->assembly->n_input; j++) force[j] += 1;
    assert_true(bough_simulation_accelerate(s, t));
    assert_memory_equal(&s->view->acceleration[link].linear, &before, sizeof before);
    bough_simulation_update(s);
    assert_true(bough_simulation_accelerate(s, t));
    assert_true(bough_norm(bough_sub(s->view->acceleration[link].linear, before)) > 1);
}

// -- a weight at the end of a cantilever ----------------------------------------------------------

static const double length = 2, bending = 1000, shear = 1e5, mass = 0.05, arm = 0.1, turning = 2e-3;

// Flexibility of the end: displacement and rotation by a force and a moment.
static void flexibility(double f[2][2]) {
    f[0][0] = length * length * length / (3 * bending) + length / shear;
    f[0][1] = f[1][0] = length * length / (2 * bending);
    f[1][1] = length / bending;
}

TEST(weight_bends_a_cantilever_as_beam_theory_says) {
    double f[2][2], weight = 9.8 * mass, own = 9.8 * 1e-4;
    flexibility(f);
    check_build(arena, s, tip_weight, no_sets);
    check_ok(bough_simulation_equilibrium(s, 0, 0, NULL));
    double expected = weight * (f[0][0] + arm * f[0][1]) + own * pow(length, 4) / (8 * bending);
    check_near(tip_of(s).x, expected, 2e-5, 0); // the body's x points down
    bough_quaternion p;
    bough_simulation_beam_tip(s, &s->beam[0], &p);
    expected = weight * (f[1][0] + arm * f[1][1]) + own * pow(length, 3) / (6 * bending);
    check_near(bough_quaternion_logarithm(p).y, expected, 2e-5, 0);
}

// Periods between the turning points of a motion after a time [Hz].
static double frequency(bough_simulation *s, int axis, double from) {
    double first = 0, last = 0, before = tip_velocity(s, axis), time = s->master->time;
    int count = 0;
    while (!bough_master_done(s->master)) {
        scene_step(s);
        double now = tip_velocity(s, axis), step = s->master->time - time;
        if (time > from && before * now < 0) {
            last = time + step * before / (before - now);
            if (count++ == 0) first = last;
        }
        before = now;
        time = s->master->time;
    }
    assert_true(count > 4);
    return (count - 1) / (2 * (last - first));
}

// The lower root of det(K − ω²M), M about the end.
TEST(weight_swings_on_a_cantilever_as_beam_theory_says) {
    double f[2][2];
    flexibility(f);
    double m00 = mass + 33.0 / 140 * 1e-4 * length, m01 = mass * arm;
    double m11 = turning + mass * arm * arm;
    // of F M: 1/ω² its eigenvalues
    double a = f[0][0] * m00 + f[0][1] * m01, b = f[0][0] * m01 + f[0][1] * m11;
    double c = f[1][0] * m00 + f[1][1] * m01, d = f[1][0] * m01 + f[1][1] * m11;
    double largest = 0.5 * (a + d) + sqrt(0.25 * (a - d) * (a - d) + b * c);
    check_build(arena, s, tip_weight, no_sets);
    check_near(frequency(s, 0, 0.1), 1 / (2 * BOUGH_PI * sqrt(largest)), 1e-3, 0);
}

// -- equivalence and conservation -----------------------------------------------------------------

// A wire along z holds the end of a beam by a body without mass: of two springs in a row the force.
TEST(spring_takes_hold_of_a_rod) {
    const double wire = 1000, slack = 1e-3, own = 9.8 * 1e-4;
    double f[2][2];
    flexibility(f);
    check_build(arena, s, "tests/data/scenes/wire.yaml", no_sets);
    check_ok(bough_simulation_equilibrium(s, 0, 0, NULL));
    double sag = own * pow(length, 4) / (8 * bending);
    double force = (slack + sag) / (1 / wire + f[0][0]), tension;
    bough_vec3 direction;
    bough_simulation_update(s);
    bough_tree_spring(s->tree, s->view, 0, &tension, &direction);
    check_near(tension, force, 1e-4, 0);
}

TEST(rod_that_carries_nothing_heavy_moves_as_a_free_one) {
#define SAME                                                                                                 \
    "bodies[1].mass=0", "gravity=[9, -5, 0]", "simulation.duration=0.3 s",                                   \
        "simulation.coupling.scheme=monolithic", "simulation.master.rtol=1e-8"
    static const char *const hung[] = {SAME, NULL};
    static const char *const apart[] = {SAME, "bodies[1].joint.parent=ground", NULL};
    check_arena(arena);
    bough_simulation *a = scene_build(arena, "tests/data/scenes/carrying.yaml", hung);
    bough_simulation *b = scene_build(arena, "tests/data/scenes/carrying.yaml", apart);
    assert_int_equal(a->master->assembly->n_state, b->master->assembly->n_state);
    run(a);
    run(b);
    check_near(bough_norm(bough_sub(tip_of(a), tip_of(b))), 0, 0, 1e-6);
    assert_true(fabs(tip_of(a).x) > 5e-3);
}

static bough_transform pose_of(const bough_simulation *s, int body) {
    return bough_tree_frame_pose(s->view, &s->tree->bodies[body]);
}

// Rods in a row, cut between stations, move what they carry as the whole rod on the same mesh does.
TEST(rods_in_a_row_are_the_whole) {
    static const char path[] = "tests/data/scenes/tower-in-parts.yaml";
    static const char *const whole[] = {"bodies[0].rod.part=[0, 87.6]", "bodies[0].rod.segments=20",
                                        "bodies[1].joint.parent=ground", "bodies[2].joint.parent=lower",
                                        NULL};
    check_arena(arena);
    bough_simulation *parts = scene_build(arena, path, no_sets);
    bough_simulation *one = scene_build(arena, path, whole);
    for (int i = 1; i < parts->beam[0].def.n_segment; i++) { // but where it is cut
        check_near(parts->beam[0].def.inertia[i].mass, one->beam[0].def.inertia[i].mass, 1e-12, 0);
    }
    run(parts);
    run(one);
    bough_simulation_update(parts);
    bough_simulation_update(one);
    bough_transform a = pose_of(parts, 2), b = pose_of(one, 2);
    check_near(bough_norm(bough_sub(a.position, b.position)), 0, 0, 1e-7);
    check_near(bough_norm(bough_sub(a.rotation.c1, b.rotation.c1)), 0, 0, 1e-7);
    assert_true(a.position.x > 0.02);
}

TEST(weight_at_an_inner_vertex_bends_the_beam_as_theory_says) {
    const double from = 0.8, weight = 9.8 * mass, own = 9.8 * 1e-4;
    check_build(arena, s, "tests/data/scenes/mid-weight.yaml", no_sets);
    check_ok(bough_simulation_equilibrium(s, 0, 0, NULL));
    double expected = weight * (pow(from, 3) / (3 * bending) + from / shear +
                                (length - from) * from * from / (2 * bending)) +
                      own * pow(length, 4) / (8 * bending);
    // of the outer rod's end, from its own frame, which the inner one's end carries
    bough_quaternion rotation;
    bough_vec3 tip = bough_simulation_beam_tip(s, &s->beam[0], &rotation);
    bough_transform frame = pose_of(s, 0);
    tip = bough_add(frame.position, bough_mat3_mul(frame.rotation, tip));
    check_near(-tip.z, expected, 1e-4, 0);
}

typedef struct invariants {
    double energy;
    bough_vec3 momentum, angular;
} invariants;

// The tree with root and end, and the vertices between.
static invariants measure(const bough_simulation *s, bough_rod_scratch *scratch) {
    const bough_beam *beam = &s->beam[0];
    const bough_rod_model *m = bough_rod_body_model(beam->rod);
    bough_vertex_motion moving[16];
    bough_simulation_beam_motion(s, beam, moving);
    tree_sums tree = tree_sum(s->tree, s->view);
    invariants sum = {tree.kinetic + tree.elastic, tree.linear_momentum, tree.angular_momentum};
    for (int i = 1; i <= m->n; i++) {
        const bough_vertex_inertia *v = &m->vertex[i];
        const double *j = v->inertia;
        bough_inertia inertia = {
            v->mass, v->moment, {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}}};
        bough_mat3 r = moving[i].rotation;
        bough_twist twist = {bough_mat3_tmul(r, moving[i].velocity), bough_mat3_tmul(r, moving[i].angular)};
        bough_wrench p = bough_inertia_mul(&inertia, twist);
        sum.energy += 0.5 * bough_power(twist, p);
        bough_vec3 linear = bough_mat3_mul(r, p.force);
        sum.momentum = bough_add(sum.momentum, linear);
        sum.angular = bough_add(
            sum.angular, bough_add(bough_mat3_mul(r, p.moment), bough_cross(moving[i].position, linear)));
    }
    bough_rod_gather(m, s->rod[beam->port].state, bough_simulation_rod_input(s, beam), scratch);
    sum.energy += rod_elastic_energy(m, scratch);
    return sum;
}

TEST(tumbling_rod_with_an_arm_conserves_momentum_and_energy) {
    check_build(arena, s, "tests/data/scenes/tumbling.yaml", no_sets);
    bough_rod_scratch scratch;
    bough_rod_scratch_init(&scratch, arena, bough_rod_body_model(s->beam[0].rod));
    invariants start = measure(s, &scratch);
    double bent = 0;
    while (!bough_master_done(s->master)) {
        scene_step(s);
        bough_simulation_update(s);
        invariants now = measure(s, &scratch);
        check_near(now.energy, start.energy, 1e-6, 0);
        check_near(bough_norm(bough_sub(now.momentum, start.momentum)), 0, 0, 1e-6);
        check_near(bough_norm(bough_sub(now.angular, start.angular)), 0, 0, 1e-6);
        bough_vec3 shift = bough_sub(tip_of(s), s->beam[0].def.position[5]);
        bent = fmax(bent, bough_norm(shift));
    }
    assert_true(bent > 0.1);
}

// -- schemes --------------------------------------------------------------------------------------

// The mast's top after half a second and the arm's angle.
static void end_of_run(const char *scheme, const char *macro_step, double end[4]) {
    check_build_with(arena, s, mast, scheme, macro_step, "simulation.duration=0.5 s");
    run(s);
    bough_vec3 x = tip_of(s);
    int q, v;
    assert_true(bough_tree_joint_rows(s->tree, 2, &q, &v));
    const double values[4] = {x.x, x.y, x.z, s->leader.state[q]};
    memcpy(end, values, sizeof values);
}

static double distance(const double a[4], const double b[4]) {
    double sum = 0;
    for (int k = 0; k < 4; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(sum);
}

TEST(every_scheme_comes_to_the_monolithic_motion) {
    static const struct {
        const char *scheme;
        double error;
    } schemes[] = {
        {"frozen", 3e-3}, {"gauss-seidel", 2e-3}, {"extrapolated", 1e-4}, {"iterated", 3e-4}, {"ramp", 2e-5}};
    double exact[4], end[4], start[4] = {0, 0, 10, 1};
    end_of_run("simulation.coupling.scheme=monolithic", "simulation.macro_step=2.5 ms", exact);
    assert_true(distance(exact, start) > 0.05);
    for (size_t k = 0; k < sizeof schemes / sizeof *schemes; k++) {
        char set[64];
        snprintf(set, sizeof set, "simulation.coupling.scheme=%s", schemes[k].scheme);
        end_of_run(set, "simulation.macro_step=2.5 ms", end);
        if (distance(end, exact) > schemes[k].error) {
            fail_msg("%s: off by %.3g", schemes[k].scheme, distance(end, exact));
        }
    }
}

TEST(ramp_is_of_second_order_on_a_mast) {
    double exact[4], coarse[4], fine[4];
    end_of_run("simulation.coupling.scheme=monolithic", "simulation.macro_step=5 ms", exact);
    end_of_run("simulation.coupling.scheme=ramp", "simulation.macro_step=10 ms", coarse);
    end_of_run("simulation.coupling.scheme=ramp", "simulation.macro_step=5 ms", fine);
    double order = log2(distance(coarse, exact) / distance(fine, exact));
    if (!(order > 1.8)) fail_msg("order %.3g", order);
    check_near(distance(fine, exact), 0, 0, 1e-4);
}

// -- the NREL 5 MW turbine ------------------------------------------------------------------------

// An independent code's first frequencies, MSC.ADAMS: fore-aft 0.3195, side to side 0.3164 Hz.
// Reference: NREL/TP-500-38060, table 9-1.
TEST(parked_turbine_swings_as_published) {
    static const double published[] = {0.3195, 0.3164};
    for (int axis = 0; axis < 2; axis++) {
        check_build(arena, s, parked, no_sets);
        check_near(frequency(s, axis, 0.6), published[axis], 0.02, 0);
    }
}

// Two shapes of the tapered tower, bent by a force and by a moment at its top, by Ritz: 0.3233 and
// 0.3211 Hz of the same bodies, rigid, without gravity and shear; shear takes 0.4 %.
TEST(tower_with_rigid_blades_swings_as_by_ritz) {
    static const char *const sets[] = {"gravity=[0, 0, 0]", "bodies[3-5].fidelity=rigid", NULL};
    static const double ritz[] = {0.3233 * 0.996, 0.3211 * 0.996};
    for (int axis = 0; axis < 2; axis++) {
        check_build(arena, s, parked, sets);
        check_near(frequency(s, axis, 0.6), ritz[axis], 3e-3, 0);
    }
}

// Gravity falls upon an undeformed tower: 20 ms are coarse for its first axial swings, in which the
// interface makes more than a hundredth of what it has exchanged by then, but for nothing after.
TEST(jolt_at_the_start_does_not_end_a_run) {
    check_build_with(arena, s, parked, "simulation.initial=undeformed", "simulation.duration=3 s",
                     "bodies[3-5].fidelity=rigid");
    run(s);
    // weight of the head and of the tapered tower on its axial stiffness
    check_near(tip_of(s).z - 87.6, -4.4e-3, 0.05, 0);
}

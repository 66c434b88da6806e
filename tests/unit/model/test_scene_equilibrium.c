// Equilibrium of whole scenes.
#include "apps/bough/analysis/steady.h"
#include "apps/bough/model/equilibrium.h"
#include "tests/unit/built_scene.h"

static const char runup[] = "apps/turbine/runup.yaml";

static bough_equilibrium_work equilibrium_of(bough_simulation *s) {
    bough_equilibrium_work work;
    check_ok(bough_simulation_equilibrium(s, bough_equilibrium_time(s), 0, &work));
    return work;
}

// Of the loads at the start: why there is none, and the steps to one that may be unstable.
static bough_status seek(bough_simulation *s) {
    bough_equilibrium_work work;
    return bough_simulation_equilibrium(s, 0, 0, &work);
}

static int steps_to_any(bough_simulation *s) {
    bough_equilibrium_work work;
    check_ok(bough_simulation_equilibrium(s, 0, BOUGH_EQUILIBRIUM_UNSTABLE, &work));
    return work.steps;
}

static bough_growth growth_of(bough_simulation *s) {
    bough_growth growth;
    check_ok(bough_simulation_growth(s, 0, false, &growth));
    return growth;
}

static double joint_angle(const bough_simulation *s, int body) {
    int coordinate, speed;
    assert_true(bough_tree_joint_rows(s->tree, body, &coordinate, &speed));
    return s->leader.state[coordinate];
}

// A bob of 1 kg at 1 m from the horizontal on a spring: k θ + m g cos θ = 0.
TEST(spring_holds_the_pendulum) {
    check_build_with(arena, s, "apps/mechanisms/pendulum.yaml", "bodies[0].joint.stiffness=20");
    equilibrium_of(s);
    double angle = joint_angle(s, 0);
    assert_true(angle < -0.1);
    check_near(20 * angle, -9.81 * cos(angle), 0, 1e-9);
}

// Started above the hinge: it falls and hangs.
TEST(chain_hangs) {
    check_build_with(arena, s, "apps/mechanisms/chain.yaml", "bodies[0].joint.angle=-45 deg");
    equilibrium_of(s);
    check_near(sin(joint_angle(s, 0)), 1, 0, 1e-9);
    for (int body = 1; body < 5; body++) {
        check_near(sin(joint_angle(s, body)), 0, 0, 1e-9);
        check_near(cos(joint_angle(s, body)), 1, 0, 1e-9);
    }
}

// A cantilever of EI = 1 and L = 1 under a dead load q per length across it, by shooting:
// θ″ = −q (1 − s) cos θ, θ(0) = 0, θ′(1) = 0; x, z and θ at the tip.
static void shoot(double q, double tip[3]) {
    enum { STEPS = 4000 };
    double low = 0, high = q, end[4];
    for (int trial = 0; trial < 60; trial++) {
        double y[4] = {0, (low + high) / 2, 0, 0}, h = 1.0 / STEPS; // θ, θ′, x, z
        for (int i = 0; i < STEPS; i++) {
            double k[4][4], at[4];
            for (int stage = 0; stage < 4; stage++) {
                double c = stage == 0 ? 0 : stage == 3 ? 1 : 0.5;
                for (int j = 0; j < 4; j++) at[j] = y[j] + (stage ? c * h * k[stage - 1][j] : 0);
                k[stage][0] = at[1];
                k[stage][1] = -q * (1 - (i + c) * h) * cos(at[0]);
                k[stage][2] = sin(at[0]);
                k[stage][3] = cos(at[0]);
            }
            for (int j = 0; j < 4; j++) y[j] += h / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
        }
        *(y[1] > 0 ? &high : &low) = (low + high) / 2;
        memcpy(end, y, sizeof end);
    }
    tip[0] = end[2], tip[1] = end[3], tip[2] = end[0];
}

// The load acts on the axis, which bends away from the chords of segments: its moment about them counts, else
// the rod converges at second order only.
TEST(dead_line_load_bends_the_rod_at_fourth_order) {
    double exact[3], error[2];
    shoot(20, exact);
    for (int k = 0; k < 2; k++) {
        check_build_with(arena, s, "apps/beams/elastica.yaml",
                         k == 0 ? "bodies[0].rod.segments=16" : "bodies[0].rod.segments=32",
                         "loads=[{body: beam, along: [0 m, 1 m], force: [20, 0, 0], frame: body}]");
        equilibrium_of(s);
        bough_quaternion p;
        bough_vec3 tip = bough_simulation_beam_tip(s, &s->beam[0], &p);
        error[k] = hypot(tip.x - exact[0], tip.z - exact[1]);
    }
    print_message("dead line load, tip off by %.2g and %.2g m\n", error[0], error[1]);
    assert_true(error[1] < 1e-5);
    assert_true(error[0] / error[1] > 12 && error[0] / error[1] < 25);
}

// The elastica under a transverse force F L²/EI = 1 and 10: tip deflections of the exact solution
// (K. Bisshopp and D. Drucker 1945). Positions alone would let the axial stiffness answer to the square
// of every turn.
TEST(massless_tip_bends_the_elastica) {
    const struct {
        const char *force;
        double deflection;
    } cases[] = {{"loads[0].force=[1, 0, 0]", 0.30172}, {"loads[0].force=[10, 0, 0]", 0.81061}};
    for (int k = 0; k < 2; k++) {
        check_build_with(arena, s, "tests/data/scenes/elastica-tip.yaml", cases[k].force);
        bough_equilibrium_work work = equilibrium_of(s);
        assert_in_range(work.steps, 1, 30);
        bough_quaternion p;
        check_near(bough_simulation_beam_tip(s, &s->beam[0], &p).x, cases[k].deflection, 2e-4, 0);
    }
}

// x″ = −k² x with x′(L) = 1, k² = ρA Ω²/EA: the tip of a turning bar is at tan(kL)/k.
TEST(turning_bar_stretches) {
    check_build_with(arena, s, "apps/beams/spin-up.yaml", "bodies[1].joint.motion={speed: 20 rad/s}");
    equilibrium_of(s);
    double k = sqrt(1.2 * 20 * 20 / 2.8e7), z = tan(10 * k) / k - 10;
    int n = s->beam[0].def.n_segment;
    const double *y = s->rod[s->beam[0].port].state;
    check_near(y[3 * n - 1] - 10, z, 2e-3, 0);
    check_near(y[n - 1], 0, 0, 1e-9);
    check_near(joint_angle(s, 1), 0, 0, 0);
}

// The rod's own solution, by Newton's method with increments of load.
TEST(rod_alone_stands_where_its_own_statics_says) {
    const char *sets[] = {"loads=[{body: blade, at: tip, force: [100 kN, 0, 0]}]", NULL};
    check_build(arena, s, "tests/data/scenes/blade.yaml", sets);
    bough_turning rest = {0};
    bough_steady steady;
    check_ok(bough_steady_find(arena, s, &s->beam[0], &rest, &steady));
    equilibrium_of(s);
    int n = s->beam[0].def.n_segment;
    const double *y = s->rod[s->beam[0].port].state;
    for (int k = 0; k < 7 * n; k++) check_near(y[k], steady.state[k], 0, 1e-8);
}

// Nothing moves in a run that starts from the equilibrium of the parked turbine in its wind.
TEST(parked_turbine_stays_at_rest) {
    const char *sets[] = {"simulation.initial=equilibrium",
                          "simulation.threads=1",
                          "loads=[]",
                          "bodies[2].joint={kind: revolute, parent: nacelle, axis: x, placement: "
                          "[move z 89.6 m, move x -5 m], motion: {angle: 0}}",
                          "aero.ramp=[0, 0]",
                          "bodies[3-5].rod.segments=24",
                          NULL};
    check_build(arena, s, runup, sets);
    size_t bytes = (size_t)s->rod[0].system.n_state * sizeof(double);
    double *before = bough_arena_take(arena, 3 * bytes);
    for (int k = 0; k < 3; k++) memcpy(before + k * s->rod[0].system.n_state, s->rod[k].state, bytes);
    int n = s->rod[0].system.n_state / BOUGH_ROD_STATES;
    assert_true(fabs(before[n - 1]) > 0.5); // bent
    for (int step = 0; step < 50; step++) scene_step(s);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3 * n; i++) {
            check_near(s->rod[k].state[i], before[k * s->rod[0].system.n_state + i], 0, 1e-6);
        }
    }
}

// With tower, yaw drive and drive train.
TEST(turbine_on_its_tower_stays_at_rest) {
    const char *sets[] = {"bodies[0].rod.segments=8", "bodies[4-6].rod.segments=8", NULL};
    check_build(arena, s, "apps/turbine/parked.yaml", sets);
    size_t n = (size_t)s->master->assembly->n_state;
    double *before = bough_arena_doubles(arena, 2 * n), *after = before + n;
    bough_assembly_states(s->master->assembly, before);
    for (int step = 0; step < 30; step++) scene_step(s);
    bough_assembly_states(s->master->assembly, after);
    for (size_t k = 0; k < n; k++) check_near(after[k], before[k], 0, 1e-6);
}

// At the speed where load and air balance, only the tower excites.
TEST(turning_rotor_starts_smoothly) {
    static const char *const initial[] = {"simulation.initial=equilibrium", "simulation.initial=undeformed"};
    double moved[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        check_build_with(arena, s, runup, initial[k], "simulation.threads=1",
                         "bodies[2].joint.speed=1.49 rad/s", "loads[0].ramp=[0, 0]", "aero.ramp=[0, 0]",
                         "gravity=[0, 0, 0]");
        int n = s->rod[0].system.n_state / BOUGH_ROD_STATES;
        double start = s->rod[1].state[n - 1]; // the tip of a blade away from the tower
        for (int step = 0; step < 25; step++) {
            scene_step(s);
            moved[k] = fmax(moved[k], fabs(s->rod[1].state[n - 1] - start));
        }
    }
    printf("tip moves by %.3g m, from undeformed by %.3g m\n", moved[0], moved[1]);
    assert_true(moved[0] < 0.02 * moved[1]);
}

TEST(driven_free_rotor_has_none) {
    check_build_with(arena, s, runup, "bodies[2].joint.speed=0", "aero.ramp=[0, 0]");
    bough_status status = seek(s);
    check_fails(status, BOUGH_FAILED, "no equilibrium");
    assert_non_null(strstr(status.message, "a spring, a speed or a motion"));
}

// A pad holds the wheel, up to half a turn: there is none for its torque, but not for want of a spring.
TEST(wheel_on_a_pad_has_none) {
    const char *sets[] = {
        "bodies=[{name: wheel, fidelity: rigid, mass: 1, inertia: [1, 1, 1], joint: {kind: revolute, parent: "
        "ground, axis: z}}]",
        "bushings=[{name: pad, from: wheel, to: ground, rotational_stiffness: [10, 10, 10]}]",
        "loads=[{joint: wheel, torque: 1000}]", "markers=[]", NULL};
    check_build(arena, s, "apps/mechanisms/pendulum.yaml", sets);
    bough_status status = seek(s);
    check_fails(status, BOUGH_FAILED, "no equilibrium");
    assert_null(strstr(status.message, "nothing but loads"));
}

// A slack chain is found by way of stiff rods. The elastic catenary, from the force at its top down.
TEST(chain_hangs_in_a_catenary) {
    static const char *const bending[] = {"1e4", "1e2", "1"};
    const double w = 700 * 8.5, length = 850, axial = 3.2e9, h = 2.4e6, top = 3e6, foot = top - w * length;
    double x = h / w * (asinh(top / h) - asinh(foot / h)) + h * length / axial;
    double z = (hypot(h, top) - hypot(h, foot)) / w + (top - w * length / 2) * length / axial;
    for (int k = 0; k < 3; k++) {
        char set[160];
        const char *sets[] = {set, NULL};
        const char *b = bending[k];
        snprintf(set, sizeof set, "bodies[1].rod.stiffness=[1.2e9, 1.2e9, 3.2e9, %s, %s, %s]", b, b, b);
        check_build(arena, s, "tests/data/scenes/mooring.yaml", sets);
        int steps = steps_to_any(s);
        bough_channels list = scene_channels(arena, s);
        printf("EI %s N m2: %d steps\n", b, steps);
        check_near(scene_channel(s, &list, "lineTipX"), x, 0, 1e-4 * length);
        check_near(scene_channel(s, &list, "lineTipZ"), z, 0, 1e-4 * length);
    }
}

// The chain is stable: that its sections twist is the mesh's, until there are as many segments as the message
// asks for.
TEST(twist_of_long_segments_is_not_called_unstable) {
    char more[60] = "bodies[1].rod.segments=48";
    const char *sets[] = {"bodies[1].rod.stiffness=[1.2e9, 1.2e9, 3.2e9, 1e4, 1e4, 1e4]", more, NULL};
    for (int k = 0; k < 2; k++) {
        check_build(arena, s, "tests/data/scenes/mooring.yaml", sets);
        check_ok(seek(s));
        bough_growth growth = growth_of(s);
        check_near(growth.rate, 0, 0, 0);
        assert_true((growth.twisting != NULL) == (k == 0));
        assert_true(k == 1 || (growth.segments > 60 && growth.segments < 100));
        snprintf(more, sizeof more, "bodies[1].rod.segments=%d", growth.segments);
    }
}

// A cable of 1 N/m and 10 m on a spherical joint, pulled at its tip and within a segment, spins freely about
// its own axis. The elastic cable, T its tension: x = ∫ T/|T| (1 + |T|/EA) ds.
TEST(cable_on_a_spherical_joint_hangs_under_forces) {
    enum { PARTS = 20000 };
    const double bending[] = {1e-3, 0.1, 10};
    const bough_vec3 tip = {6, 3, -2}, side = {-2, 5, 1};
    bough_vec3 x = {0, 0, 0};
    for (int i = 0; i < PARTS; i++) {
        double at = (i + 0.5) * 10 / PARTS;
        bough_vec3 pull = bough_add(tip, bough_v3(0, 0, -(10 - at)));
        if (at < 4.3) pull = bough_add(pull, side);
        x = bough_axpy(10.0 / PARTS * (1 / bough_norm(pull) + 1e-4), pull, x);
    }
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        double b = bending[k];
        const char *sets[] = {
            bough_arena_print(
                arena,
                "bodies=[{name: line, fidelity: rod, joint: {kind: spherical, parent: ground, "
                "placement: [rotate x 60 deg]}, rod: {length: 10, segments: 24, stiffness: [4e3, "
                "4e3, 1e4, %g, %g, %g], mass: [0.1, 0, 0, 1e-6, 1e-6, 0]}}]",
                b, b, b),
            "loads=[{body: line, at: tip, force: [6, 3, -2]}, {body: line, at: 4.3 m, force: [-2, 5, 1]}]",
            "gravity=[0, 0, -10]", "markers=[]", NULL};
        bough_simulation *s = scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
        int steps = steps_to_any(s);
        bough_channels list = scene_channels(arena, s);
        const bough_vec3 found = {scene_channel(s, &list, "lineTipX"), scene_channel(s, &list, "lineTipY"),
                                  scene_channel(s, &list, "lineTipZ")};
        printf("EI %g N m2: %d steps, tip off by %.2g m\n", b, steps, bough_norm(bough_sub(found, x)));
        check_near(bough_norm(bough_sub(found, x)), 0, 0, 0.03 + 0.3 * sqrt(b / 10));
    }
}

// Heavy bodies on a light rod that bends far fall and come to rest in a stable equilibrium: where each step
// starts at rest, 1000 do not suffice.
TEST(heavy_bodies_fall_from_a_light_rod) {
    check_build(arena, s, "tests/data/scenes/slender-tree.yaml", no_sets);
    printf("%d steps\n", equilibrium_of(s).steps);
    bough_growth growth = growth_of(s);
    check_near(growth.rate, 0, 0, 0);
}

// A thin rod that stands on a clamp and is pulled down bends within sqrt(EI/F) = 0.03 m of its length 1 m.
// Four segments have no equilibrium; the message says with how many there is one.
TEST(segments_too_long_for_a_bend_are_named) {
    const char *sets[] = {
        "bodies=[{name: whip, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: {length: 1, segments: "
        "4, stiffness: [1e3, 1e3, 1e3, 1e-3, 1e-3, 1e-3], mass: [0.01, 0, 0, 1e-6, 1e-6, 0]}}]",
        "loads=[{body: whip, at: tip, force: [0.1, 0, -1]}]", "gravity=[0, 0, 0]", "markers=[]", NULL};
    check_build(arena, s, "apps/mechanisms/pendulum.yaml", sets);
    bough_status status = seek(s);
    check_fails(status, BOUGH_FAILED, "whip: no equilibrium found: its segments are too long for its load");
    int times = 0;
    const char *with = strstr(status.message, "with ");
    assert_non_null(with);
    assert_int_equal(sscanf(with, "with %d times", &times), 1);
    char set[60];
    snprintf(set, sizeof set, "bodies[0].rod.segments=%d", 4 * times);
    const char *finer[] = {sets[0], sets[1], sets[2], sets[3], set, NULL};
    s = scene_build(arena, "apps/mechanisms/pendulum.yaml", finer);
    check_ok(seek(s));
}

// A bar on a table between pads, which turn it by 16 degrees; its mass times `mass`.
static bough_simulation *bar_on_pads(bough_arena *arena, int n_segment, double mass) {
    const char *sets[] = {
        bough_arena_print(
            arena,
            "bodies=[{name: bar, fidelity: rod, joint: {kind: planar, parent: ground, axis: y}, rod: {length: "
            "1, segments: %d, stiffness: [2e6, 2e6, 5e6, 80, 80, 80], mass: [%g, 0, 0, %g, %g, 0]}}, {name: "
            "tip, fidelity: rigid, joint: {kind: fixed, parent: bar}, mass: %g, inertia: [%g, %g, %g]}]",
            n_segment, 0.15 * mass, 3e-4 * mass, 4e-4 * mass, 0.05 * mass, 2e-3 * mass, 2e-3 * mass,
            2e-3 * mass),
        "loads=[{body: bar, along: [0.3 m, 0.9 m], force: [-16, -24, -45], moment: [18, 9, -12]}]",
        "bushings=[{name: pad, from: tip, to: ground, stiffness: [400, 140, 1300], rotational_stiffness: "
        "[380, 24, 22]}]",
        "gravity=[0, 0, 0]",
        "markers=[]",
        NULL};
    return scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
}

// Rounding of the longest steps is above what is left, and grows with the number of segments.
TEST(fine_mesh_on_pads_is_found) {
    check_arena(arena);
    bough_simulation *s = bar_on_pads(arena, 100, 1);
    bough_equilibrium_work work = equilibrium_of(s);
    int coordinate, speed;
    assert_in_range(work.steps, 1, 40);
    assert_true(bough_tree_joint_rows(s->tree, 0, &coordinate, &speed));
    check_near(s->leader.state[coordinate + 2] * 180 / BOUGH_PI, 16.4484, 1e-5, 0);
}

// Eigenvalues of rounding about points far below its frequencies of 50 kHz are no growth.
TEST(light_bar_on_pads_is_stable) {
    check_arena(arena);
    bough_simulation *s = bar_on_pads(arena, 8, 1e-8);
    equilibrium_of(s);
    bough_growth growth = growth_of(s);
    check_near(growth.rate, 0, 0, 0);
    check_near(growth.oscillation, 0, 0, 0);
}

// A bob of 1 kg at 1 m above its hinge, and below.
TEST(standing_pendulum_is_unstable) {
    static const char *const angle[] = {"bodies[0].joint.angle=90 deg", "bodies[0].joint.angle=-90 deg"};
    for (int k = 0; k < 2; k++) {
        check_build_with(arena, s, "apps/mechanisms/pendulum.yaml", angle[k]);
        equilibrium_of(s);
        bough_growth growth = growth_of(s);
        check_near(growth.rate, k == 0 ? sqrt(9.81) : 0, 0, 1e-6);
        check_near(growth.oscillation, 0, 0, 0);
    }
}

// Beck's column flutters beyond a follower force of 20.05: growth and frequency at 22, none at 19.
TEST(follower_force_makes_a_column_flutter) {
    static const char *const force[] = {"loads[0].force=[0, 0, -22]", "loads[0].force=[0, 0, -19]"};
    for (int k = 0; k < 2; k++) {
        check_build_with(arena, s, "apps/beams/beck.yaml", force[k], "bodies[0].rod.segments=20");
        equilibrium_of(s);
        bough_growth growth = growth_of(s);
        check_near(growth.oscillation, k == 0 ? 3.05491 : 0, 5e-3, 1e-6);
        check_near(growth.rate, 0, 0, 0);
    }
}

// A rod on a hinge with a spring, pulled at its tip: of a unit of length, mass and time.
static bough_simulation *hinged_rod(bough_arena *arena, double length, double mass, double time) {
    double force = mass * length / (time * time), bending = force * length * length,
           inertia = mass * length * length;
    const char *sets[] = {
        bough_arena_print(
            arena,
            "bodies=[{name: hub, fidelity: rigid, mass: %g, inertia: [%g, %g, %g], joint: {kind: revolute, axis: y, "
            "parent: ground, stiffness: %g}}, {name: r, fidelity: rod, joint: {kind: fixed, parent: hub}, rod: "
            "{length: %g, segments: 16, stiffness: [%g, %g, %g, %g, %g, %g], mass: [%g, 0, 0, %g, %g, 0]}}]",
            mass, inertia, inertia, inertia, 50 * force * length, length, 1e4 * force, 1e4 * force,
            3e4 * force, bending, bending, bending, mass / length, 1e-3 * mass * length,
            1e-3 * mass * length),
        bough_arena_print(arena, "loads=[{body: r, at: tip, force: [%g, 0, %g]}]", 10 * force, -5 * force),
        "gravity=[0, 0, 0]", "markers=[]", NULL};
    return scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
}

// A beam of 0.1 mm and 10 kHz and one of 10 km and 100 s take the shape of one of 1 m and 1 s.
TEST(shape_does_not_depend_on_scale) {
    static const double unit[3][3] = {{1, 1, 1}, {1e-4, 1e-10, 1e-4}, {1e4, 1e6, 100}};
    double first[2] = {0, 0};
    int first_steps = 0;
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        double length = unit[k][0];
        bough_simulation *s = hinged_rod(arena, length, unit[k][1], unit[k][2]);
        int steps = equilibrium_of(s).steps;
        printf("%g m: %d steps\n", length, steps);
        if (k == 0) first_steps = steps;
        assert_in_range(steps, first_steps - 2, first_steps + 2);
        bough_channels list = scene_channels(arena, s);
        double x = scene_channel(s, &list, "rTipX") / length, z = scene_channel(s, &list, "rTipZ") / length;
        if (k == 0) first[0] = x;
        if (k == 0) first[1] = z;
        check_near(x, first[0], 0, 1e-7);
        check_near(z, first[1], 0, 1e-7);
        bough_growth growth = growth_of(s);
        check_near(growth.rate, 0, 0, 0);
    }
}

// A cable of 30 segments, so thin that its clamp's moment ends within one of them.
static bough_simulation *thin_cable(bough_arena *arena, const char *joint, int angle, double length) {
    double w = 9.81 * length, bending = 1e-5 * w * length * length, inertia = 1e-6 * length * length;
    const char *sets[] = {
        bough_arena_print(
            arena,
            "bodies=[{name: line, fidelity: rod, joint: {kind: %s, parent: ground, placement: [rotate y %d deg]}, "
            "rod: {length: %g, segments: 30, stiffness: [%g, %g, %g, %g, %g, %g], mass: [1, 0, 0, %g, %g, 0]}}]",
            joint, angle, length, 300 * w, 300 * w, 1000 * w, bending, bending, bending, inertia, inertia),
        "gravity=[0, 0, -9.81]", "markers=[]", NULL};
    return scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
}

// A cable that starts nearly upright on a spherical joint comes to hang, whatever its length. Steps that are
// long for a short cable would leave it upright.
TEST(cable_of_any_length_falls_from_upright) {
    static const double length[] = {1e-4, 0.01, 1, 1e4};
    for (int k = 0; k < 4; k++) {
        check_arena(arena);
        bough_simulation *s = thin_cable(arena, "spherical", 30, length[k]);
        int steps = equilibrium_of(s).steps;
        printf("%g m: %d steps\n", length[k], steps);
        assert_in_range(steps, 1, 100);
        bough_channels list = scene_channels(arena, s);
        check_near(scene_channel(s, &list, "lineTipZ"), -length[k] * 1.0005, 1e-6, 0);
    }
}

// A beam that is pushed straight back to its clamp by more than Euler's load buckles as fast at every length,
// by its own time.
TEST(growth_does_not_depend_on_scale) {
    static const double length[] = {1, 1e-6, 1e6};
    double first = 0;
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        double l = length[k];
        const char *sets[] = {
            bough_arena_print(
                arena,
                "bodies=[{name: column, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: {length: %g, segments: "
                "12, stiffness: [%g, %g, %g, %g, %g, %g], mass: [1, 0, 0, %g, %g, 0]}}]",
                l, 3e4 * l, 3e4 * l, 1e5 * l, l * l * l, 2 * l * l * l, l * l * l, 1e-5 * l * l,
                1e-5 * l * l),
            bough_arena_print(arena, "loads=[{body: column, at: tip, force: [0, 0, %g]}]", -30 * l),
            "gravity=[0, 0, 0]", "markers=[]", NULL};
        bough_simulation *s = scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
        equilibrium_of(s);
        bough_growth growth = growth_of(s);
        printf("%g m: growth %g 1/s\n", l, growth.rate);
        if (k == 0) first = growth.rate;
        assert_true(first > 5);
        check_near(growth.rate * sqrt(l), first, 1e-4, 0);
    }
}

// Two masses in a row of springs that are just slack: only the third power of their deflection pulls them
// back.
TEST(net_without_stiffness_is_found) {
    const char *sets[] = {
        "bodies=[{name: a, fidelity: rigid, mass: 1, inertia: [0.1, 0.1, 0.1], joint: {kind: free, parent: ground, "
        "placement: [move x 1 m, move z 0.05 m]}}, {name: b, fidelity: rigid, mass: 1, inertia: [0.1, 0.1, 0.1], "
        "joint: {kind: free, parent: ground, placement: [move x 2 m, move z -0.02 m]}}]",
        "springs=[{name: r, from: ground, to: a, stiffness: 1e4, length: 1}, {name: s, from: a, to: b, stiffness: "
        "1e4, length: 1}, {name: t, from: b, to: ground, to_point: [3, 0, 0], stiffness: 1e4, length: 1}]",
        "gravity=[0, 0, 0]", "markers=[{name: a, body: a}, {name: b, body: b}]", NULL};
    check_build(arena, s, "apps/mechanisms/pendulum.yaml", sets);
    int steps = equilibrium_of(s).steps;
    printf("%d steps\n", steps);
    assert_in_range(steps, 1, 300);
    bough_channels list = scene_channels(arena, s);
    check_near(scene_channel(s, &list, "aZ"), 0, 0, 1e-3);
    check_near(scene_channel(s, &list, "bZ"), 0, 0, 1e-3);
}

// Four times the segments start in the shape of the chain found, and its joint where it is: far fewer steps
// lead to the equilibrium than from the undeformed chain.
TEST(finer_mesh_starts_in_the_shape_found) {
    const char *finer[] = {"bodies[1].rod.segments=192", NULL};
    check_arena(arena);
    bough_simulation *coarse = scene_build(arena, "tests/data/scenes/mooring.yaml", no_sets);
    bough_simulation *fine = scene_build(arena, "tests/data/scenes/mooring.yaml", finer);
    bough_equilibrium_work work;
    int first = equilibrium_of(coarse).steps;
    bough_simulation_take_shape(coarse, fine);
    check_near(fine->leader.state[0], coarse->leader.state[0], 0, 0);
    check_ok(bough_simulation_equilibrium(fine, 0, BOUGH_EQUILIBRIUM_FINER, &work));
    printf("%d steps, then %d\n", first, work.steps);
    assert_in_range(work.steps, 1, 12);
    bough_channels list = scene_channels(arena, coarse), finer_list = scene_channels(arena, fine);
    check_near(scene_channel(fine, &finer_list, "lineTipZ"), scene_channel(coarse, &list, "lineTipZ"), 1e-3,
               0);
}

// Bodies that springs hold together fall together; a spring without stiffness holds nothing.
TEST(bodies_tied_only_to_each_other_have_none) {
    static const char *const stay[] = {"0", "100"};
    for (int k = 0; k < 2; k++) {
        check_arena(arena);
        const char *sets[] = {
            "bodies=[{name: a, fidelity: rigid, mass: 1, inertia: [1, 1, 1], joint: {kind: free, parent: ground}}, "
            "{name: b, fidelity: rigid, mass: 1, inertia: [1, 1, 1], joint: {kind: free, parent: ground, placement: "
            "[move z -2 m]}}]",
            bough_arena_print(
                arena,
                "springs=[{name: link, from: a, to: b, stiffness: 100, length: 1}, {name: stay, from: "
                "ground, from_point: [0, 0, 2], to: a, stiffness: %s, length: 1}]",
                stay[k]),
            "markers=[]", NULL};
        bough_simulation *s = scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
        bough_status status = seek(s);
        if (k == 0)
            check_fails(status, BOUGH_FAILED, "a: no equilibrium found: nothing ties it to the ground");
        if (k == 1) check_ok(status);
    }
}

// Eight rigid links, 4 m between their hinges, hang in a discrete catenary: the tangent of link k's angle is
// (k − ½)/H.
TEST(chain_of_rigid_links_hangs) {
    double low = 0.1, high = 10, middle = 0;
    for (int i = 0; i < 100; i++) {
        double h = (low + high) / 2, reach = middle = 0;
        for (int k = 1; k <= 4; k++) {
            reach += h / hypot(h, k - 0.5);
            middle -= (k - 0.5) / hypot(h, k - 0.5);
        }
        *(reach < 2 ? &low : &high) = h;
    }
    check_build(arena, s, "tests/data/scenes/link-chain.yaml", no_sets);
    assert_in_range(equilibrium_of(s).steps, 1, 300);
    bough_channels list = scene_channels(arena, s);
    check_near(scene_channel(s, &list, "middleX"), 2, 0, 1e-6);
    check_near(scene_channel(s, &list, "middleZ"), middle, 0, 1e-6);
    bough_growth growth = growth_of(s);
    check_near(growth.rate, 0, 0, 0);
}

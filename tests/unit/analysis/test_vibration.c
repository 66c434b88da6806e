// Modes of whole scenes.
#include "apps/bough/analysis/steady.h"
#include "apps/bough/analysis/vibration.h"
#include "tests/unit/built_scene.h"

static const char pendulum[] = "apps/mechanisms/pendulum.yaml", runup[] = "apps/turbine/runup.yaml";

#define COARSE_LAND "bodies[4-6].rod.segments=6"

typedef struct found {
    bough_arena *arena;
    bough_simulation *s;
    bough_vibration v;
} found;

static found modes_of(const char *path, const char *const *sets, int count) {
    found f = {.arena = check_memory()};
    f.s = scene_build(f.arena, path, sets);
    check_ok(bough_vibration_find(f.arena, f.s, count, &f.v));
    return f;
}

// ω² = g/l
TEST(pendulum_swings) {
    found f = modes_of(pendulum, no_sets, 4);
    assert_int_equal(f.v.found, 1);
    check_near(f.v.mode[0].frequency, sqrt(9.81) / (2 * BOUGH_PI), 1e-8, 0);
    check_near(f.v.mode[0].damping, 0, 0, 1e-9);
    check_near(f.v.mode[0].share[0], 1, 1e-12, 0);
}

// m l² λ² + c λ + m g l = 0
TEST(damper_damps_the_pendulum) {
    const char *sets[] = {"bodies[0].joint.damping=2", NULL};
    found f = modes_of(pendulum, sets, 4);
    check_near(f.v.mode[0].frequency, sqrt(9.81) / (2 * BOUGH_PI), 1e-8, 0);
    check_near(f.v.mode[0].damping, 1 / sqrt(9.81), 1e-8, 0);
    check_near(f.v.mode[0].damped_frequency, sqrt(9.81 - 1) / (2 * BOUGH_PI), 1e-8, 0);
}

// On a spherical joint it swings in two planes; its free turn and its quaternion give nothing.
TEST(spherical_pendulum_swings_twice) {
    const char *sets[] = {"bodies[0].joint={kind: spherical, parent: ground}",
                          "bodies[0].inertia=[0.1, 0.1, 0.1]", NULL};
    found f = modes_of(pendulum, sets, 6);
    double expected = sqrt(9.81 / 1.1) / (2 * BOUGH_PI);
    assert_int_equal(f.v.found, 2);
    for (int k = 0; k < 2; k++) check_near(f.v.mode[k].frequency, expected, 1e-7, 0);
}

// Two windows of four-bars hang: ω² = g ((N + 1)/2 + N)/((N + 1)/3 + N), and nothing else moves.
TEST(closed_loops_swing_as_one) {
    const char *sets[] = {"bodies[0].joint.speed=0", "bodies[0-2].joint.angle=180 deg",
                          "bodies[3-4].joint.angle=-180 deg", NULL};
    found f = modes_of("apps/mechanisms/four-bar.yaml", sets, 6);
    assert_int_equal(f.v.found, 1);
    check_near(f.v.mode[0].frequency, sqrt(9.81 * 3.5 / 3) / (2 * BOUGH_PI), 1e-6, 0);
}

// Clamped and propped: β² √(EI/ρA)/2πL², β = 3.926602, in both planes; shear and inertia of the
// sections lower it a little.
TEST(propped_beam_vibrates_in_both_planes) {
    found f = modes_of("tests/data/scenes/prop.yaml", no_sets, 3);
    double exact = 3.926602 * 3.926602 * sqrt(1e5 / 2) / (2 * BOUGH_PI * 9);
    for (int k = 0; k < 2; k++) check_near(f.v.mode[k].frequency, exact, 3e-3, 0);
    assert_true(f.v.mode[2].frequency > 2 * exact);
}

// A disc that spins in two elastic gimbals: A λ² ± i C Ω λ + k = 0.
TEST(gyroscope_nutates_and_precesses) {
    const char *sets[] = {
        "bodies=[{name: outer, fidelity: rigid, joint: {kind: revolute, parent: ground, axis: x, "
        "stiffness: 50}}, {name: inner, fidelity: rigid, joint: {kind: revolute, parent: outer, "
        "axis: y, stiffness: 50}}, {name: disc, fidelity: rigid, inertia: [1, 1, 1.6], "
        "joint: {kind: revolute, parent: inner, axis: z, motion: {speed: 10 rad/s}}}]",
        "markers=[]", NULL};
    found f = modes_of(pendulum, sets, 4);
    double half = 0.5 * 1.6 * 10, root = sqrt(half * half + 50);
    assert_int_equal(f.v.found, 2);
    check_near(f.v.mode[0].frequency, (root - half) / (2 * BOUGH_PI), 1e-8, 0);
    check_near(f.v.mode[1].frequency, (root + half) / (2 * BOUGH_PI), 1e-8, 0);
    assert_true(f.v.frozen); // it is no turbine's rotor
}

// The same out of balance, whose linear system changes with the disc's azimuth, a turbine of unequal
// blades, and one of equal blades on a hub whose centre is off the shaft or which differs across it.
TEST(periodic_systems_are_refused) {
    const char *disc[] = {
        "bodies=[{name: outer, fidelity: rigid, joint: {kind: revolute, parent: ground, axis: x, "
        "stiffness: 50}}, {name: disc, fidelity: rigid, inertia: [1, 1.01, 1.6], "
        "joint: {kind: revolute, parent: outer, axis: z, motion: {speed: 10 rad/s}}}]",
        "markers=[]", NULL};
    const char *blades[] = {"bodies[blade1].pitch=7 deg", COARSE_LAND, NULL};
    const char *known[] = {"bodies[blade1].pitch=7 deg", COARSE_LAND, "modes.linear=true", NULL};
    check_arena(arena);
    bough_vibration v;
    bough_simulation *s = scene_build(arena, pendulum, disc);
    check_fails(bough_vibration_find(arena, s, 4, &v), BOUGH_INVALID, "as the bodies turn");
    s = scene_build(arena, "apps/turbine/land.yaml", blades);
    check_fails(bough_vibration_find(arena, s, 4, &v), BOUGH_INVALID, "as the bodies turn");
    const char *hubs[] = {"bodies[hub].centre_of_mass=[0, 0.5, 0]", "bodies[hub].inertia=[5e6, 2.6e6, 2e6]"};
    for (int k = 0; k < 2; k++) {
        s = scene_build(arena, "apps/turbine/land.yaml", (const char *[]){hubs[k], COARSE_LAND, NULL});
        check_fails(bough_vibration_find(arena, s, 4, &v), BOUGH_INVALID, "as the bodies turn");
        s = scene_build(arena, "apps/turbine/land.yaml",
                        (const char *[]){hubs[k], COARSE_LAND, "modes.linear=true", NULL});
        check_ok(bough_vibration_find(arena, s, 4, &v));
        assert_true(v.frozen && v.n_blade == 0); // no transform of the blades
    }
    s = scene_build(arena, "apps/turbine/land.yaml", known);
    check_ok(bough_vibration_find(arena, s, 4, &v));
    assert_true(v.frozen);
}

// A nearly massless cantilever of length L with a body at its end, its centre a further:
// flexibility D and mass M of the end's deflection and turn, 1/ω² are the eigenvalues of D M.
TEST(body_on_a_rod_swings) {
    const char *sets[] = {"gravity=[0, 0, 0]", "bodies[0].rod.mass=[1e-6, 0, 0, 1e-9, 1e-9, 0]", NULL};
    found f = modes_of("tests/data/scenes/tip-weight.yaml", sets, 5);
    double l = 2, ei = 1000, ga = 1e5, m = 0.05, a = 0.1, j = 2e-3;
    double d[3] = {l * l * l / (3 * ei) + l / ga, l * l / (2 * ei), l / ei};
    double mass[3] = {m, m * a, j + m * a * a};
    double trace = d[0] * mass[0] + 2 * d[1] * mass[1] + d[2] * mass[2];
    double determinant = (d[0] * d[2] - d[1] * d[1]) * (mass[0] * mass[2] - mass[1] * mass[1]);
    double largest = 0.5 * (trace + sqrt(trace * trace - 4 * determinant));
    double torsion = l / 800 * 1e-3;
    assert_int_equal(f.v.found, 5);
    for (int k = 0; k < 5; k++) {
        double square = k < 2 ? largest : k == 2 ? torsion : determinant / largest;
        check_near(f.v.mode[k].frequency, 1 / (2 * BOUGH_PI * sqrt(square)), 1e-4, 0);
        assert_true(f.v.mode[k].share[1] > 0.99);
    }
}

#define HUB(motion)                                                                                          \
    "bodies[2].joint={kind: revolute, parent: nacelle, axis: x, motion: " motion                             \
    ", placement: [move z 1.96256 m, rotate y 5 deg, move x -5.0191 m]}"
#define CALM "aero.ramp=[0, 1000]", "aero.wind.speed=0", "loads=[]", "gravity=[0, 0, 0]"
#define COARSE "bodies[3-5].rod.segments=8"

// The blades of a locked rotor on a rigid support do not know of each other.
TEST(parked_blades_have_their_own_frequencies) {
    const char *sets[] = {HUB("{angle: 0}"), CALM, COARSE, "modes.at=undeformed", NULL};
    found f = modes_of(runup, sets, 9);
    bough_beam *beam = &f.s->beam[0];
    bough_steady steady;
    bough_turning rest = {0};
    check_ok(bough_steady_find(f.arena, f.s, beam, &rest, &steady));
    bough_rod_mode_list list = {.wanted = 3};
    check_ok(bough_rod_modes(f.arena, steady.model, &steady.work, steady.input, steady.state, &list));
    assert_int_equal(f.v.found, 9);
    for (int k = 0; k < 9; k++) {
        check_near(f.v.mode[k].frequency, list.mode[k / 3].frequency, 1e-7, 0);
        check_near(f.v.mode[k].damping, list.mode[k / 3].damping, 1e-6, 0);
        assert_true(f.v.mode[k].blades);
        assert_int_equal(f.v.mode[k].direction, list.mode[k / 3].dominant);
    }
}

static const bough_scene_mode *mode_with(const found *f, int direction, bough_pattern pattern) {
    for (int k = 0; k < f->v.found; k++) {
        const bough_scene_mode *m = &f->v.mode[k];
        if (m->direction == direction && m->pattern == pattern) return m;
    }
    fail_msg("no such mode");
    return NULL;
}

// On a rigid support an observer at rest sees each blade frequency, and it plus and minus the
// rotor's, exactly; the equilibrium is stretched by the rotation.
TEST(whirl_is_split_by_the_rotation) {
    const char *sets[] = {HUB("{speed: 12.1 rpm}"), CALM, COARSE, "aero.air_density=1e-9", NULL};
    found f = modes_of(runup, sets, 6);
    assert_false(f.v.frozen);
    for (int direction = BOUGH_ROD_FLAP; direction <= BOUGH_ROD_EDGE; direction++) {
        const bough_scene_mode *mean = mode_with(&f, direction, BOUGH_PATTERN_COLLECTIVE);
        const bough_scene_mode *forward = mode_with(&f, direction, BOUGH_PATTERN_FORWARD);
        const bough_scene_mode *backward = mode_with(&f, direction, BOUGH_PATTERN_BACKWARD);
        check_near(forward->damped_frequency - mean->damped_frequency, 12.1 / 60, 0, 1e-7);
        check_near(mean->damped_frequency - backward->damped_frequency, 12.1 / 60, 0, 1e-7);
        check_near(forward->growth, mean->growth, 1e-5, 0);
        check_near(forward->whirl[1], 1, 0, 1e-6);
        check_near(backward->whirl[2], 1, 0, 1e-6);
        check_near(mean->whirl[0], 1, 0, 1e-6);
    }
}

// What gravity does to a blade in a slow revolution averages out: its bending adds no stress.
TEST(gravity_averages_out) {
    const char *const *with = sets_of(HUB("{speed: 1e-3 rpm}"), "aero.ramp=[0, 1000]", "aero.wind.speed=0",
                                      "loads=[]", COARSE, "modes.shapes=true");
    const char *without[] = {HUB("{angle: 0}"), CALM, COARSE, "modes.at=undeformed", NULL};
    found a = modes_of(runup, with, 6), b = modes_of(runup, without, 6);
    for (int k = 0; k < 6; k++) {
        check_near(a.v.mode[k].frequency, b.v.mode[k].frequency, 1e-4, 0);
    }
}

// The change is that to the modes of half the segments, and a rigid body has no mesh.
TEST(another_mesh_moves_the_modes_as_it_should) {
    const char *sets[] = {"bodies[0].rod.segments=12", NULL};
    const char *coarse[] = {"bodies[0].rod.segments=6", NULL};
    found a = modes_of("tests/data/scenes/prop.yaml", sets, 2),
          b = modes_of("tests/data/scenes/prop.yaml", coarse, 2);
    bool compared;
    check_ok(bough_vibration_compare(a.arena, a.s, &a.v, &compared));
    assert_true(compared);
    for (int k = 0; k < 2; k++) {
        double growth = a.v.mode[k].growth - b.v.mode[k].growth;
        double frequency = 2 * BOUGH_PI * (a.v.mode[k].damped_frequency - b.v.mode[k].damped_frequency);
        double apart = hypot(growth, frequency) / (2 * BOUGH_PI * a.v.mode[k].frequency);
        assert_true(apart > 1e-4);
        check_near(a.v.mode[k].moved, apart, 1e-3, 0);
    }
    found rigid = modes_of(pendulum, no_sets, 1);
    check_ok(bough_vibration_compare(rigid.arena, rigid.s, &rigid.v, &compared));
    assert_false(compared);
}

// Five segments have thirty motions, ten have more: those without a partner are not said to be moved.
TEST(a_mode_that_another_mesh_lacks_has_no_partner) {
    const char *sets[] = {"bodies[0].rod.segments=10", "modes.of=scene", NULL};
    found a = modes_of("apps/beams/blade.yaml", sets, 60);
    bool compared;
    int alone = 0;
    check_ok(bough_vibration_compare(a.arena, a.s, &a.v, &compared));
    for (int k = 0; k < a.v.found; k++) {
        alone += isinf(a.v.mode[k].moved);
        assert_true(isinf(a.v.mode[k].moved) || a.v.mode[k].moved < 0.5);
    }
    assert_true(a.v.found > 40 && alone >= a.v.found - 30);
    assert_true(a.v.mode[0].moved < 0.01);
}

// The rows of a shape join: a rod's end and what hangs on it move alike; the largest is real and 1.
TEST(shapes_join_the_bodies) {
    const char *sets[] = {"modes.shapes=true", NULL};
    found f = modes_of("tests/data/scenes/tip-weight.yaml", sets, 2);
    assert_int_equal(f.v.n_row, 5 + 1);
    const bough_shape_row *row = f.v.mode[0].shape, *end = row + 4, *weight = row + 5;
    const double lever[3] = {0, 0.1 * end->motion[0][5], -0.1 * end->motion[0][4]}; // along x
    double most = 0;
    for (int c = 0; c < 6; c++) check_near(row->motion[0][c], 0, 0, 1e-9);
    for (int c = 0; c < 3; c++) {
        check_near(weight->motion[0][c], end->motion[0][c] + lever[c], 0, 1e-5);
        check_near(weight->motion[0][3 + c], end->motion[0][3 + c], 1e-6, 1e-9);
        most = fmax(most, fabs(weight->motion[0][c]));
    }
    check_near(most, 1, 0, 1e-9);
    check_near(end->span, 2, 1e-12, 0);
}

// Reduced to their modes, the blades of a rotor on a rigid support keep patterns and frequencies.
TEST(modal_blades_whirl_as_rods_do) {
    const char *rods[] = {HUB("{speed: 6 rpm}"), CALM, COARSE, "aero.air_density=1e-9", NULL};
    const char *modal[] = {HUB("{speed: 6 rpm}"),        CALM, COARSE, "aero.air_density=1e-9",
                           "bodies[3-5].fidelity=modal", NULL};
    found a = modes_of(runup, rods, 6), b = modes_of(runup, modal, 6);
    for (int k = 0; k < 6; k++) {
        const bough_scene_mode *rod = &a.v.mode[k], *reduced = &b.v.mode[k];
        check_near(reduced->frequency, rod->frequency, 1e-2, 0);
        assert_int_equal(reduced->pattern, rod->pattern);
        assert_int_equal(reduced->direction, rod->direction);
        check_near(reduced->share[3], rod->share[3], 1e-2, 0);
    }
}

// On a support that yaws and rolls the transformed system is the same at any azimuth; that of the
// blades' own axes is not.
TEST(azimuth_does_not_matter) {
    const char *nacelle =
        "bodies[1].joint={kind: revolute, parent: tower, axis: z, stiffness: 3e8, placement: "
        "[move z 87.6 m]}";
    const char *zero[] = {HUB("{speed: 12.1 rpm}"), nacelle, CALM, COARSE, "modes.at=undeformed", NULL};
    const char *const *turned =
        sets_of(HUB("{speed: 12.1 rpm}"), nacelle, CALM, COARSE,
                "bodies[3].joint.placement=[rotate x 40 deg, rotate y -2.5 deg, move z 1.5 m]",
                "bodies[4].joint.placement=[rotate x 160 deg, rotate y -2.5 deg, move z 1.5 m]",
                "bodies[5].joint.placement=[rotate x 280 deg, rotate y -2.5 deg, move z 1.5 m]",
                "modes.at=undeformed");
    found a = modes_of(runup, zero, 8), b = modes_of(runup, turned, 8);
    double support = 0;
    for (int k = 0; k < 8; k++) {
        check_near(a.v.mode[k].frequency, b.v.mode[k].frequency, 1e-7, 0);
        check_near(a.v.mode[k].growth, b.v.mode[k].growth, 1e-4, 1e-7);
        assert_int_equal(a.v.mode[k].pattern, b.v.mode[k].pattern);
        support = fmax(support, a.v.mode[k].share[1]);
    }
    assert_true(support > 0.01); // the nacelle moves
}

// Generator and hub on the two ends of the shaft's spring: the same turbine whichever of them is the rotor
// that the nacelle carries.
TEST(either_end_of_the_shaft_may_be_the_rotor) {
    const char *usual[] = {"loads=[]", "bodies[hub].joint.speed=12.1 rpm", "aero=null", COARSE_LAND, NULL};
    const char *const *other = sets_of(
        "loads=[]", "turbine.rotor=generator",
        "bodies[hub].joint={kind: revolute, axis: x, parent: generator, stiffness: 8.67637e8, damping: 6.215e6}",
        "bodies[generator].joint={kind: revolute, axis: x, parent: nacelle, speed: 12.1 rpm, placement: "
        "[move z 1.96256 m, rotate y 5 deg, move x -5.0191 m]}",
        "aero=null", COARSE_LAND);
    found a = modes_of("apps/turbine/land.yaml", usual, 10),
          b = modes_of("apps/turbine/land.yaml", other, 10);
    assert_int_equal(b.v.n_blade, 3);
    assert_false(a.v.frozen || b.v.frozen);
    for (int k = 0; k < 10; k++) {
        check_near(b.v.mode[k].frequency, a.v.mode[k].frequency, 1e-6, 0);
        check_near(b.v.mode[k].growth, a.v.mode[k].growth, 1e-4, 1e-7);
        assert_int_equal(b.v.mode[k].pattern, a.v.mode[k].pattern);
    }
}

// A rod across the end of another under a load, stiffness and load times `factor`.
static found modes_of_angle(double factor) {
    bough_arena *arena = check_memory();
    char rod[200];
    snprintf(rod, sizeof rod,
             "rod: {length: 1, segments: 8, stiffness: [%g, %g, %g, %g, %g, %g], mass: [0.5, 0, 0, 1e-3, "
             "1e-3, 0]}",
             1e7 * factor, 1e7 * factor, 3e7 * factor, 2e3 * factor, 4e3 * factor, 2e3 * factor);
    const char *sets[] = {
        bough_arena_print(
            arena,
            "bodies=[{name: arm, fidelity: rod, joint: {kind: fixed, parent: ground}, %s}, "
            "{name: fore, fidelity: rod, joint: {kind: fixed, parent: arm, placement: [rotate y "
            "90 deg]}, %s}]",
            rod, rod),
        bough_arena_print(arena, "loads=[{body: fore, at: tip, force: [%g, %g, %g]}]", 300 * factor,
                          1000 * factor, 300 * factor),
        "gravity=[0, 0, 0]", "markers=[]", NULL};
    return modes_of(pendulum, sets, 6);
}

// However high they are.
TEST(frequencies_grow_with_the_root_of_the_stiffness) {
    found soft = modes_of_angle(1), stiff = modes_of_angle(1e8);
    assert_int_equal(stiff.v.found, soft.v.found);
    for (int k = 0; k < soft.v.found; k++)
        check_near(stiff.v.mode[k].frequency, 1e4 * soft.v.mode[k].frequency, 1e-6, 0);
}

// A body that slides on a plane between springs, all its lengths times `size`.
static found modes_of_slab(double size) {
    bough_arena *arena = check_memory();
    double x = size, i = 0.1 * size * size;
    const char *sets[] = {
        bough_arena_print(
            arena,
            "bodies=[{name: slab, fidelity: rigid, mass: 1, inertia: [%g, %g, %g], joint: {kind: "
            "free, parent: ground}}]",
            i, i, i),
        "closures=[{name: table, kind: planar, axis: z, from: ground, to: slab}]",
        bough_arena_print(
            arena,
            "springs=[{name: a, from: ground, from_point: [%g, %g, 0], to: slab, stiffness: 50, length: %g}, "
            "{name: b, from: ground, from_point: [%g, %g, 0], to: slab, to_point: [%g, %g, 0], stiffness: 80, "
            "length: %g}]",
            0.5 * x, 0.2 * x, 0.2 * x, -0.4 * x, 0.6 * x, -0.1 * x, 0.2 * x, 0.3 * x),
        "gravity=[0, 0, 0]",
        "markers=[]",
        NULL};
    return modes_of(pendulum, sets, 3);
}

// A closed loop of a millimetre has the frequencies of one of a metre.
TEST(frequencies_do_not_depend_on_the_size) {
    found large = modes_of_slab(1), small = modes_of_slab(1e-3);
    assert_int_equal(large.v.found, 3);
    assert_int_equal(small.v.found, 3);
    for (int k = 0; k < 3; k++) check_near(small.v.mode[k].frequency, large.v.mode[k].frequency, 1e-6, 0);
}

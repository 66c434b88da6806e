// Modes in the air: damping of a rigid rotor on a slide beside its thrust's slope and beside time
// marching; without density the modes of the bodies alone. And a blade that the air brings to rest.
#include "apps/bough/analysis/state_space.h"
#include "apps/bough/analysis/vibration.h"
#include "apps/bough/model/aero_link.h"
#include "core/base/linalg.h"
#include "tests/unit/built_scene.h"

// The blades of the run-up rigid on a heavy hub, whose nacelle slides along the wind on a spring.
static const char *const sliding[] = {
    "gravity=[0, 0, 0]",
    "bodies[1].joint.kind=prismatic",
    "bodies[1].joint.axis=x",
    "bodies[1].joint.stiffness=1e6",
    "bodies[2].joint.placement=[move x -5 m]",
    "bodies[2].joint.speed=12.1 rpm",
    "bodies[2].inertia=[1e14, 6e13, 6e13, 0, 0, 0]",
    "bodies[3-5].fidelity=rigid",
    "bodies[3-5].pitch=0 deg",
    "aero.wind.speed=9 m/s",
    "aero.ramp=[0 s, 0 s]",
    "aero.rate=200 Hz",
    "aero.tower.influence=potential",
    "aero.tower.diameter=[1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3]",
    "simulation.macro_step=5 ms",
    "simulation.threads=1",
    "loads[0].torque=0",
    "modes.of=scene",
};
enum { SLIDING = sizeof sliding / sizeof *sliding, MOST = SLIDING + 6 };

// The scene with more settings (up to NULL).
static bough_simulation *build(bough_arena *arena, const char *const *more) {
    const char *sets[MOST + 1] = {NULL};
    memcpy(sets, sliding, sizeof sliding);
    for (int k = 0; k < MOST - SLIDING && more[k] != NULL; k++) sets[SLIDING + k] = more[k];
    return scene_build(arena, "apps/turbine/runup.yaml", sets);
}

static bough_scene_mode slide_mode(bough_arena *arena, bough_simulation *s) {
    bough_vibration v;
    check_ok(bough_vibration_find(arena, s, 2, &v));
    assert_int_equal(v.found, 1);
    return v.mode[0];
}

static double thrust(const char *wind) {
    check_arena(arena);
    bough_simulation *s = build(arena, sets_of(wind));
    double factor;
    bough_aero_link_hold(s->aero, 0);
    double value = bough_aero_link_data(s->aero, &factor)->thrust;
    return value;
}

// m ẍ + T' ẋ + k x = 0 with T' the slope of the thrust over the wind.
TEST(quasi_steady_damping_is_the_slope_of_the_thrust) {
    check_arena(arena);
    bough_simulation *s = build(arena, sets_of("modes.air=quasi-steady"));
    bough_scene_mode m = slide_mode(arena, s);
    double slope = (thrust("aero.wind.speed=9.01 m/s") - thrust("aero.wind.speed=8.99 m/s")) / 0.02;
    double omega = 2 * BOUGH_PI * m.frequency, mass = 1e6 / (omega * omega);
    check_near(mass, 240e3 + 56780 + 3 * 17.7e3, 1e-2, 0); // the blades' to 5 %
    check_near(m.growth, -slope / (2 * mass), 1e-3, 0);
}

// Growth [1/s] and frequency [Hz] of the slide's decay after a push, from two swings between a turning
// point and the next.
static void march(bough_simulation *s, double *growth, double *frequency) {
    double x[3] = {0}, time[4] = {0}, turn[4] = {0};
    int q, v, found = 0;
    bough_tree_joint_rows(s->tree, 1, &q, &v);
    while (found < 4) {
        assert_false(bough_master_done(s->master));
        scene_step(s);
        x[0] = x[1], x[1] = x[2], x[2] = s->leader.state[q];
        double t = s->master->time - s->master->macro_step;
        if (t < 5 || (x[1] - x[0]) * (x[2] - x[1]) > 0) continue;
        double bend = (x[0] - 2 * x[1] + x[2]) / 2, rise = (x[2] - x[0]) / 2;
        time[found] = t - rise / (2 * bend) * s->master->macro_step;
        turn[found++] = x[1] - rise * rise / (4 * bend);
    }
    *growth = log((turn[2] - turn[3]) / (turn[0] - turn[1])) / (time[2] - time[0]);
    *frequency = 1 / (time[2] - time[0]);
}

TEST(dynamic_damping_is_that_of_time_marching) {
    static const char *const air[3][2] = {{"oye", "none"}, {"equilibrium", "hgm"}, {"oye", "hgm"}};
    for (int k = 0; k < 3; k++) {
        char inflow[64], stall[64];
        snprintf(inflow, sizeof inflow, "aero.induction.inflow=%s", air[k][0]);
        snprintf(stall, sizeof stall, "aero.dynamic_stall=%s", air[k][1]);
        check_arena(arena);
        bough_simulation *s = build(arena, sets_of(inflow, stall, "modes.air=dynamic"));
        bough_scene_mode m = slide_mode(arena, s);
        bough_simulation *run =
            build(arena, sets_of(inflow, stall, "simulation.initial=equilibrium", "simulation.duration=20 s",
                                 "loads[0]={body: nacelle, force: [1e5, 0, 0], factor: {times: "
                                 "[0, 0.5, 1], values: [0, 1, 0]}}"));
        double growth, frequency;
        march(run, &growth, &frequency);
        check_near(m.growth, growth, 2e-3, 0);
        check_near(m.damped_frequency, frequency, 1e-3, 0);
    }
}

// The blades bend; next to no air: the reduced system has the modes of the bodies.
TEST(thin_air_leaves_the_modes_as_they_are) {
    check_arena(arena);
    bough_vibration v[2];
    for (int k = 0; k < 2; k++) {
        const char *const *sets = sets_of(
            "bodies[2].joint.speed=12.1 rpm", "bodies[3-5].rod.segments=10", "aero.air_density=1e-9",
            "modes.count=8", k == 0 ? "modes.air=frozen" : "modes.air=quasi-steady", "simulation.threads=1");
        bough_simulation *s = scene_build(arena, "apps/turbine/runup.yaml", sets);
        check_ok(bough_vibration_find(arena, s, 8, &v[k]));
        assert_int_equal(v[k].found, 8);
    }
    for (int k = 0; k < 8; k++) {
        check_near(v[1].mode[k].frequency, v[0].mode[k].frequency, 1e-6, 0);
        check_near(v[1].mode[k].growth, v[0].mode[k].growth, 1e-4, 0);
        assert_int_equal(v[1].mode[k].pattern, v[0].mode[k].pattern);
    }
}

// Modes that are not kept follow the air's forces at once: few wanted modes are as exact as the same of many.
TEST(modes_do_not_depend_on_how_many_are_wanted) {
    enum { FEW = 6, MANY = 30 };
    const char *const *sets =
        sets_of("bodies[2].joint.speed=12.1 rpm", "bodies[3-5].rod.segments=10", "gravity=[0, 0, 0]",
                "aero.ramp=[0 s, 0 s]", "aero.wind.speed=9 m/s", "bodies[3-5].pitch=0 deg",
                "modes.air=quasi-steady", "simulation.threads=1", "loads[0].torque=0");
    check_arena(arena);
    bough_vibration v[2];
    for (int k = 0; k < 2; k++) {
        bough_simulation *s = scene_build(arena, "apps/turbine/runup.yaml", sets);
        check_ok(bough_vibration_find(arena, s, k == 0 ? FEW : MANY, &v[k]));
    }
    for (int k = 0; k < FEW; k++) {
        check_near(v[0].mode[k].frequency, v[1].mode[k].frequency, 5e-3, 0);
        check_near(v[0].mode[k].growth, v[1].mode[k].growth, 1e-2, 0);
    }
}

// The fastest turning of a tip in the next steps [rad/s].
static double fastest(bough_simulation *s, const bough_beam *beam, int steps) {
    enum { MOST_VERTICES = 64 };
    bough_vertex_motion vertex[MOST_VERTICES];
    double most = 0;
    for (int k = 0; k < steps; k++) {
        scene_step(s);
        bough_simulation_update(s);
        bough_simulation_beam_motion(s, beam, vertex);
        most = fmax(most, bough_norm(vertex[beam->def.n_segment].angular));
    }
    return most;
}

// Blades that do not turn, flat across the wind or nearly, at a rate of the air with four samples a period of
// their torsion: dynamic stall fades there, and slopes that take it for whole feed that mode.
TEST(held_blades_come_to_rest_in_stall) {
    static const char *const pitch[] = {"bodies[3-5].pitch=285 deg", "bodies[3-5].pitch=45 deg",
                                        "bodies[3-5].pitch=20 deg"};
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        bough_simulation *s = scene_build(
            arena, "apps/turbine/runup.yaml",
            sets_of("bodies[2].joint={kind: revolute, parent: nacelle, axis: x, motion: {angle: 0}, "
                    "placement: [move z 2 m, move x -5 m]}",
                    "bodies[3-5].rod.segments=10", pitch[k], "loads=[]", "aero.wind.speed=24 m/s",
                    "aero.dynamic_stall=hgm", "aero.rate=25 Hz", "simulation.macro_step=40 ms",
                    "simulation.coupling.scheme=monolithic", "simulation.master.step=20 ms",
                    "simulation.master.rtol=3e-3", "simulation.error_estimate=none", "simulation.threads=1"));
        fastest(s, &s->beam[0], 50);
        double early = fastest(s, &s->beam[0], 50);
        fastest(s, &s->beam[0], 100);
        double late = fastest(s, &s->beam[0], 50);
        print_message("%s: %.2g rad/s, 6 s later %.2g\n", pitch[k], early, late);
        assert_true(late < 0.7 * early);
    }
}

// -- flutter --------------------------------------------------------------------------------------

static const char wing[] = "tests/data/scenes/goland.yaml";

// The mass of the wing without that of the air around it.
static const char structure[] = "bodies[1].rod.mass=[35.71, 0, 0.18288, 8.64, 1e-3, 0]";

// Of the two modes, that which flutters; `mass`: NULL for the scene's or the mass of the sections.
static bough_scene_mode fluttering(double speed, const char *mass) {
    char wind[48];
    snprintf(wind, sizeof wind, "aero.wind.speed=%.6f m/s", speed);
    check_arena(arena);
    bough_vibration v;
    bough_simulation *s = scene_build(arena, wing, sets_of(wind, mass));
    check_ok(bough_vibration_find(arena, s, 2, &v));
    assert_int_equal(v.found, 2);
    bough_scene_mode mode = v.mode[0].growth > v.mode[1].growth ? v.mode[0] : v.mode[1];
    return mode;
}

static double flutter_speed(const char *mass, double *omega) {
    double low = 130, high = 150;
    while (high - low > 0.02) {
        double middle = 0.5 * (low + high);
        bough_scene_mode mode = fluttering(middle, mass);
        if (mode.growth > 0)
            high = middle;
        else
            low = middle;
        *omega = 2 * BOUGH_PI * mode.damped_frequency;
    }
    print_message("flutter at %.2f m/s, %.2f rad/s\n", low, *omega);
    return low;
}

// Goland's speed is 137.25 m/s at 70.7 rad/s. Four bending and four torsional shapes in strips with
// Theodorsen's function have theirs at 137.34 m/s and 69.35 rad/s, with Jones' function and without the
// apparent mass of the air at 139.63 m/s and 72.03 rad/s.
TEST(wing_flutters_at_the_published_speed) {
    double omega, speed = flutter_speed(NULL, &omega);
    check_near(speed, 137.34, 1e-3, 0);
    check_near(omega, 69.35, 2e-3, 0);
    check_near(speed, 137.25, 2e-3, 0);
}

TEST(wing_without_apparent_mass_flutters_at_the_speed_of_strips) {
    double omega, speed = flutter_speed(structure, &omega);
    check_near(speed, 139.63, 2e-3, 0);
    check_near(omega, 72.03, 2e-3, 0);
}

// The reduced system's eigenvalues are within their residuals of those of the whole one, dense, by
// differences.
TEST(modes_are_within_their_residuals) {
    check_arena(arena);
    bough_vibration v;
    bough_state_space x;
    bough_simulation *s = scene_build(arena, wing, no_sets);
    check_ok(bough_vibration_find(arena, s, 2, &v));
    check_ok(bough_state_space_find(arena, s, 0, &x));
    size_t n = (size_t)x.n;
    double *value = bough_arena_doubles(arena, 2 * n), *vector = bough_arena_doubles(arena, n * n);
    assert_true(bough_dense_eigen(x.n, x.a, value, vector, bough_arena_doubles(arena, BOUGH_EIGEN_WORK(n))));
    assert_int_equal(v.found, 2);
    for (int k = 0; k < v.found; k++) {
        double nearest = HUGE_VAL, real = v.pair[k].real, imaginary = v.pair[k].imaginary;
        for (size_t j = 0; j < n; j++)
            nearest = fmin(nearest, hypot(value[j] - real, value[n + j] - imaginary));
        double off = nearest / hypot(real, imaginary);
        assert_true(v.mode[k].residual < 1e-4);
        assert_true(off < 10 * v.mode[k].residual);
    }
}

// Growth [1/s] of the tip's swings in the chord's normal, over their turning points from 1 s on.
static double swings_grow(double speed, const char *mass) {
    char wind[48];
    snprintf(wind, sizeof wind, "aero.wind.speed=%.6f m/s", speed);
    check_build_with(arena, s, wing, wind, mass);
    double first = 0, last = 0, from = 0, to = 0, before[2] = {0, 0};
    while (!bough_master_done(s->master)) {
        scene_step(s);
        bough_simulation_update(s);
        bough_quaternion p;
        double x = bough_simulation_beam_tip(s, &s->beam[0], &p).x, t = s->master->time;
        if (t > 1 && before[0] > before[1] && before[0] >= x) {
            if (first == 0) first = before[0], from = t;
            last = before[0], to = t;
        }
        before[1] = before[0], before[0] = x;
    }
    return log(last / first) / (to - from);
}

TEST(wing_flutters_in_time_as_its_modes_say) {
    static const double speed[] = {134, 136, 139, 141, 138, 141};
    for (int k = 0; k < 6; k++) {
        const char *mass = k < 4 ? NULL : structure;
        double modes = fluttering(speed[k], mass).growth, time = swings_grow(speed[k], mass);
        print_message("%g m/s: %.4f 1/s in time, %.4f by modes\n", speed[k], time, modes);
        check_near(time, modes, 0, 0.05);
        assert_true((modes > 0) == (speed[k] > (mass ? 139.63 : 137.34)));
    }
}

// -- the rotor's speed ----------------------------------------------------------------------------

#define OPERATION(wind)                                                                                      \
    "aero.wind={kind: uniform, speed: " wind "}", "aero.ramp=[0 s, 0 s]",                                    \
        "modes={of: scene, air: quasi-steady}", "bodies[3-5].rod.segments=10", "simulation.threads=1"

// Of the air in equilibrium at a speed of the rotor.
static double torque_at(const char *wind, const char *speed) {
    check_arena(arena);
    bough_simulation *s =
        scene_build(arena, "apps/turbine/land-operation.yaml",
                    sets_of(OPERATION("12 m/s"), wind, speed, "simulation.initial=equilibrium"));
    double factor, torque = bough_aero_link_data(s->aero, &factor)->torque;
    return torque;
}

// A rotor on pitch joints is seen from rest: gravity on it, at an azimuth that stands still, makes no mode
// grow. Where its torque grows with the speed, the speed does by that slope over the inertia.
TEST(speed_follows_the_slope_of_the_torque) {
    static const char *const wind[] = {"aero.wind.speed=14 m/s", "aero.wind.speed=18 m/s"};
    const double inertia = 4.378e7, step = 0.04 * BOUGH_PI / 30;
    for (int k = 0; k < 2; k++) {
        double slope = torque_at(wind[k], "bodies[2].joint.speed=12.02 rpm") -
                       torque_at(wind[k], "bodies[2].joint.speed=11.98 rpm");
        check_build_with(arena, s, "apps/turbine/land-operation.yaml", OPERATION("12 m/s"), wind[k]);
        bough_vibration v;
        check_ok(bough_vibration_find(arena, s, 4, &v));
        assert_int_equal(v.n_blade, 3);
        assert_false(v.frozen);
        double growth = v.mode[0].damped_frequency == 0 ? v.mode[0].growth : 0;
        print_message("%s: slope %.4f 1/s, mode %.4f 1/s\n", wind[k], slope / step / inertia, growth);
        if (slope < 0) check_near(growth, 0, 0, 0);
        if (slope > 0) check_near(growth, slope / step / inertia, 0.04, 0);
        assert_true((slope > 0) == (k == 1));
    }
}

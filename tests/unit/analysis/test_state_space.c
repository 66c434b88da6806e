// The linear state space of whole scenes: a pendulum by hand, rods beside the exact tangents, and a rotor
// in the air beside its thrust and torque at other winds and pitches.
#include "apps/bough/analysis/state_space.h"
#include "apps/bough/model/aero_link.h"
#include "cosim/whole.h"
#include "tests/unit/built_scene.h"

static bough_state_space linear(bough_arena *arena, bough_simulation *s) {
    bough_state_space x;
    check_ok(bough_state_space_find(arena, s, 0, &x));
    return x;
}

static int find(const bough_signal_name *list, int n, const char *name) {
    for (int k = 0; k < n; k++) {
        if (strcmp(list[k].name, name) == 0) return k;
    }
    fail_msg("no signal %s", name);
    return -1;
}

static double entry(const double *a, int rows, int i, int j) { return a[(size_t)j * rows + i]; }

// m l² q̈ = m g l sin q − c q̇ + T at 30° from the horizontal; the marker at −l (cos q, −sin q) in x and z.
TEST(pendulum_by_hand) {
    check_arena(arena);
    const char *sets[] = {
        "bodies[0].joint={kind: revolute, parent: ground, axis: y, angle: -30 deg, damping: 0.4}",
        "loads=[{joint: bob, torque: 0.25, input: push}]", NULL};
    bough_simulation *s = scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
    bough_state_space x = linear(arena, s);
    double g = 9.81, q = -30 * BOUGH_PI / 180;
    assert_int_equal(x.n, 2);
    assert_int_equal(x.n_input, 1);
    assert_string_equal(x.input[0].name, "push");
    assert_string_equal(x.input[0].unit, "N m");
    check_near(x.input[0].value, 0.25, 1e-15, 0);
    assert_string_equal(x.state[0].name, "bob coordinate 1");
    assert_string_equal(x.state[1].unit, "rad/s");
    check_near(entry(x.a, 2, 0, 1), 1, 1e-9, 0);
    check_near(entry(x.a, 2, 0, 0), 0, 0, 1e-9);
    check_near(entry(x.a, 2, 1, 0), g * sin(q), 1e-8, 0);
    check_near(entry(x.a, 2, 1, 1), -0.4, 1e-8, 0);
    check_near(x.b[0], 0, 0, 1e-12);
    check_near(x.b[1], 1, 1e-8, 0);
    int along = find(x.output, x.n_output, "bobX"), up = find(x.output, x.n_output, "bobZ");
    check_near(x.output[along].value, -cos(q), 1e-12, 0);
    check_near(entry(x.c, x.n_output, along, 0), sin(q), 1e-8, 0);
    check_near(entry(x.c, x.n_output, up, 0), cos(q), 1e-8, 0);
    check_near(entry(x.c, x.n_output, find(x.output, x.n_output, "bobVel"), 1), 180 / BOUGH_PI, 1e-8, 0);
}

// What acts on a driven joint is at once in what drives it: D.
TEST(drive_takes_the_load_at_once) {
    check_arena(arena);
    const char *sets[] = {"bodies[0].joint={kind: revolute, parent: ground, axis: y, motion: {angle: 0}}",
                          "loads=[{body: bob, moment: [0, 0, 0], frame: ground, input: push}]", NULL};
    bough_simulation *s = scene_build(arena, "apps/mechanisms/pendulum.yaml", sets);
    bough_state_space x = linear(arena, s);
    assert_int_equal(x.n_input, 6);
    check_near(
        entry(x.d, x.n_output, find(x.output, x.n_output, "bobTrq"), find(x.input, x.n_input, "pushMy")), -1,
        1e-8, 0);
}

// (I − γA) x = b for x by the members' own tangents and factors.
TEST(rods_beside_exact_tangents) {
    check_arena(arena);
    const char *sets[] = {"bodies[3-5].rod.segments=6", "bodies[2].joint.speed=10 rpm",
                          "simulation.initial=equilibrium", "simulation.threads=1", NULL};
    bough_simulation *s = scene_build(arena, "apps/turbine/runup.yaml", sets);
    bough_state_space x = linear(arena, s);
    const bough_assembly *a = s->master->assembly;
    assert_int_equal(x.n, a->n_state);
    bough_whole *whole = bough_whole_create(arena, a, NULL);
    double *y = bough_arena_doubles(arena, (size_t)x.n), *solution = bough_arena_doubles(arena, (size_t)x.n);
    bough_assembly_states(a, y);
    bough_whole_inputs(whole, 0, y);
    const double gamma = 0.01;
    check_ok(bough_whole_setup(whole, 0, y, whole->input, gamma));
    for (int trial = 0; trial < 5; trial++) {
        double *b = bough_arena_doubles(arena, (size_t)x.n), worst = 0;
        for (int k = 0; k < x.n; k++) solution[k] = b[k] = sin(1.7 * k + trial);
        bough_whole_solve(whole, solution);
        for (int i = 0; i < x.n; i++) {
            double sum = solution[i], size = fabs(solution[i]) + fabs(b[i]);
            for (int j = 0; j < x.n; j++) {
                double part = gamma * entry(x.a, x.n, i, j) * solution[j];
                sum -= part;
                size += fabs(part);
            }
            worst = fmax(worst, fabs(sum - b[i]) / size);
        }
        print_message("tangents and differences: %.2g\n", worst);
        assert_true(worst < 1e-6);
    }
}

typedef struct air {
    double thrust, torque;
} air;

static air air_of(const char *const *sets) {
    check_build(arena, s, "apps/turbine/power.yaml", sets);
    double factor;
    bough_aero_link_hold(s->aero, 0);
    const bough_rotor_data *data = bough_aero_link_data(s->aero, &factor);
    air x = {data->thrust, data->torque};
    return x;
}

// A rigid rotor in quasi-steady air: how its speed follows torque, pitch and wind.
TEST(rotor_follows_torque_pitch_and_wind) {
    static const char rigid[] = "bodies[3-5].fidelity=rigid", ramp[] = "aero.ramp=[0 s, 0 s]",
                      quiet[] = "gravity=[0, 0, 0]";
    check_arena(arena);
    bough_simulation *s =
        scene_build(arena, "apps/turbine/power.yaml", sets_of(rigid, ramp, quiet, "modes.air=quasi-steady"));
    bough_state_space x = linear(arena, s);
    int speed = find(x.state, x.n, "hub speed 1"),
        torque = find(x.input, x.n_input, "generator torque, fast shaft");
    int pitch = find(x.input, x.n_input, "collective pitch"), wind = find(x.input, x.n_input, "wind speed");
    double inertia = -97 / entry(x.b, x.n, speed, torque);
    check_near(inertia, 5.1414e6 + 3 * 11.776e6, 0.05, 0); // hub, and blades about their roots
    check_near(x.input[wind].value, 8, 1e-12, 0);
    const char *const more[4] = {"aero.wind.speed=8.0001 m/s", "aero.wind.speed=7.9999 m/s",
                                 "bodies[3-5].pitch=1e-5 rad", "bodies[3-5].pitch=-1e-5 rad"};
    double value[4];
    for (int k = 0; k < 4; k++) value[k] = air_of(sets_of(rigid, ramp, quiet, more[k])).torque;
    check_near(inertia * entry(x.b, x.n, speed, wind), (value[0] - value[1]) / 2e-4, 1e-4, 0);
    // the inertia turns with the blades, too
    check_near(inertia * entry(x.b, x.n, speed, pitch), (value[2] - value[3]) / 2e-5, 1e-3, 0);
}

// The land turbine as shipped, its bodies coupled at the stages of the steps.
#include "tests/unit/built_scene.h"

enum { MOST = 128, ROWS = 501 };

static int linearised;
static bough_system_ops counted, plain;
static bool count(void *self, double t, const double *state, const double *input, void *factors) {
    linearised++;
    return plain.linearise(self, t, state, input, factors);
}

// In their own axes tangents of rods hardly change: every second time the tower's are kept.
TEST(rods_keep_tangents_longer_than_the_tree) {
    check_build(arena, s, "apps/turbine/land-operation.yaml", sets_of("simulation.duration=20 s"));
    counted = plain = *s->rod[0].system.ops;
    counted.linearise = count;
    s->rod[0].system.ops = &counted;
    while (!bough_master_done(s->master)) scene_step(s);
    int all = (int)bough_master_statistics(s->master).jacobians;
    assert_in_range(linearised, all / 2, 5 * all / 6);
}

static double (*record(const char *speed, int *n))[MOST] {
    static double rows[2][ROWS][MOST];
    static int turn;
    double(*to)[MOST] = rows[turn++ % 2];
    check_build_with(arena, s, "apps/turbine/land.yaml", "simulation.duration=10 s", speed);
    bough_channels list = scene_channels(arena, s);
    assert_true(list.count <= MOST);
    *n = list.count;
    for (int k = 0; k < ROWS; k++) {
        bough_simulation_update(s);
        bough_channels_sample(&list, s->master->time, to[k]);
        if (k < ROWS - 1) scene_step(s);
    }
    return to;
}

// The last digit of a start value stays in the last digits: every channel within 1e-6 of its range.
TEST(a_last_digit_is_not_amplified) {
    int n, same;
    double(*a)[MOST] = record("bodies[2].joint.speed=0.5 rad/s", &n);
    double(*b)[MOST] = record("bodies[2].joint.speed=0.5000000000001 rad/s", &same);
    assert_int_equal(n, same);
    for (int j = 0; j < n; j++) {
        double low = HUGE_VAL, high = -HUGE_VAL, largest = 0;
        for (int k = 0; k < ROWS; k++) {
            low = fmin(low, a[k][j]);
            high = fmax(high, a[k][j]);
            largest = fmax(largest, fabs(a[k][j] - b[k][j]));
        }
        if (largest > 1e-6 * (high - low))
            fail_msg("channel %d differs by %.1e of its range", j, largest / (high - low));
    }
}

// A blade that turns on a hub with a flywheel, on a mass that slides sideways on a spring, by tangents of 24
// steps, in which it turns by 17 deg: y = A (sin Ωt − Ω/ω sin ωt).
TEST(a_turning_blade_shakes_its_support) {
    static const double speed = 1.25, length = 10, blade = 500, mass = 5501, stiffness = 2.2e4;
    static const char text[] =
        "gravity: [0, 0, 0]\n"
        "simulation: {duration: 20 s, macro_step: 20 ms, coupling: {scheme: monolithic},\n"
        "  master: {solver: rosenbrock, step: 10 ms, rtol: 1e-3}, error_estimate: none}\n"
        "bodies:\n"
        "  - {name: slide, fidelity: rigid, mass: 5000, inertia: [1, 1, 1],\n"
        "     joint: {kind: prismatic, axis: y, parent: ground, stiffness: 2.2e4}}\n"
        "  - {name: hub, fidelity: rigid, mass: 1, inertia: [1e12, 1, 1],\n"
        "     joint: {kind: revolute, axis: x, parent: slide, speed: 1.25 rad/s}}\n"
        "  - name: blade\n    fidelity: rod\n    joint: {kind: fixed, parent: hub}\n"
        "    rod: {length: 10 m, segments: 4, stiffness: [1e9, 1e9, 1e9, 1e9, 1e9, 1e9],\n"
        "      damping: [0.01, 0.01, 0.01, 0.01, 0.01, 0.01], mass: [50, 0, 0, 1, 1, 0]}\n";
    check_arena(arena);
    bough_simulation *s = scene_build_text(arena, text);
    bough_channels list = scene_channels(arena, s);
    double natural = sqrt(stiffness / mass), error = 0;
    double amplitude = -blade * length / 2 * speed * speed / (mass * (natural * natural - speed * speed));
    while (!bough_master_done(s->master)) {
        scene_step(s);
        double t = s->master->time;
        double exact = amplitude * (sin(speed * t) - speed / natural * sin(natural * t));
        error = fmax(error, fabs(scene_channel(s, &list, "slidePos") - exact));
    }
    check_near(error, 0, 0, 0.01 * fabs(amplitude));
}

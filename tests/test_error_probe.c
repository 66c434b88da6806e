// The estimated coupling error of a scene's channels against the true one, the difference to the
// monolithic run.
#include "apps/simulation/error_probe.h"
#include "tests/built_scene.h"

#include <stdlib.h>

static const char scene_path[] = "tests/scenes/arms.yaml";
enum { STEPS = 100, MOST = 64 };

typedef struct recorded {
    int n;                      // channels
    double value[STEPS][MOST];  // at the end of each step
    double estimate[MOST];      // told
    bool known[MOST];
    int hub;                    // the channel hubVel
    char unit[MOST][48];
} recorded;

static recorded *run_with(const char *scheme, const char *micro, bool probing) {
    const char *const sets[] = {scheme, micro, "simulation.macro_step=2 ms",
                                "simulation.duration=200 ms", "simulation.master.rtol=1e-9", NULL};
    recorded *r = calloc(1, sizeof *r);
    bough_arena *arena = bough_arena_create();
    bough_simulation *s = scene_build(arena, scene_path, sets);
    bough_channels channels = bough_channels_start(arena);
    bough_error_probe probe;
    bough_simulation_channels(s, &channels);
    bough_status status = bough_error_probe_create(arena, s, NULL, &channels, &probe);
    assert_true(bough_is_ok(&status));
    assert_true(channels.count <= MOST);
    r->n = channels.count;
    r->hub = bough_channels_find(&channels, "hubVel");
    for (int i = 0; i < r->n; i++) {
        snprintf(r->unit[i], sizeof r->unit[i], "%s", channels.channel[i].unit);
    }
    for (int k = 0; k < STEPS; k++) {
        scene_step(s);
        if (probing) bough_error_probe_update(&probe);
        bough_simulation_update(s);
        bough_channels_sample(&channels, s->master->time, r->value[k]);
    }
    for (int i = 0; i < r->n; i++) {
        r->known[i] = bough_error_probe_knows(&probe, i);
        r->estimate[i] = probe.largest[i];
    }
    bough_arena_destroy(arena);
    return r;
}

static recorded *run(const char *scheme, bool probing) {
    return run_with(scheme, "simulation.micro.rtol=1e-8", probing);
}

static double largest_error(const recorded *r, const recorded *reference, int channel) {
    double largest = 0;
    for (int k = 0; k < STEPS; k++) {
        largest = fmax(largest, fabs(r->value[k][channel] - reference->value[k][channel]));
    }
    return largest;
}

static void channels_err_by_what_is_told(void **state) {
    (void)state;
    recorded *reference = run("simulation.coupling.scheme=monolithic", true);
    recorded *r = run("simulation.coupling.scheme=gauss-seidel", true);
    int checked = 0;
    for (int i = 0; i < r->n; i++) {
        assert_true(r->known[i]);
        assert_false(reference->known[i]);
        double error = largest_error(r, reference, i);
        if (error < 1e-7) continue; // of the integrators
        checked++;
        if (error < 3 * r->estimate[i] && error > r->estimate[i] / 100) continue;
        fail_msg("channel %d: %g estimated, %g true", i, r->estimate[i], error);
    }
    assert_true(checked >= 7); // the hub and two tips
    assert_true(largest_error(r, reference, r->hub) > 1e-4);
    free(reference);
    free(r);
}

// The ramp's own error is far below what loose sub-solvers do. Of all places the largest component.
static void errors_of_sub_solvers_are_told(void **state) {
    (void)state;
    recorded *reference = run("simulation.coupling.scheme=monolithic", true);
    static const char *const micro[] = {
        "simulation.micro={solver: cvode-bdf, rtol: 1e-5}",
        "simulation.micro={solver: rosenbrock, step: 2 ms, rtol: 0.1}"};
    for (size_t k = 0; k < sizeof micro / sizeof *micro; k++) {
        recorded *r = run_with("simulation.coupling.scheme=ramp", micro[k], true);
        double hub = largest_error(r, reference, r->hub), tips = 0, told = 0;
        for (int i = 0; i < r->n; i++) {
            if (strcmp(r->unit[i], "m") != 0) continue;
            tips = fmax(tips, largest_error(r, reference, i));
            told = fmax(told, r->estimate[i]);
        }
        print_message("%s: hub %.2f, tips %.2f told/true\n", micro[k], r->estimate[r->hub] / hub,
                      told / tips);
        assert_true(hub > 1e-5 && tips > 1e-6); // far above the reference's own
        if (tips > 4 * told || told > 4 * tips) fail_msg("tips: %g told, %g true", told, tips);
        if (hub > 4 * r->estimate[r->hub] || r->estimate[r->hub] > 4 * hub) fail_msg("hub");
        free(r);
    }
    free(reference);
}

// What a second solution cannot follow, vibrations of an undamped beam in steps of 5 ms, is given up and
// said.
static void a_lost_second_solution_is_said(void **state) {
    (void)state;
    const char *const sets[] = {"simulation.coupling={scheme: ramp}", "simulation.duration=0.5 s",
                                "simulation.micro={solver: generalized-alpha, step: 5 ms}",
                                "simulation.error_estimate=second-solution", NULL};
    bough_arena *arena = bough_arena_create();
    bough_simulation *s = scene_build(arena, "apps/beams/short.yaml", sets);
    bough_channels channels = bough_channels_start(arena);
    bough_error_probe probe;
    char text[BOUGH_ERROR_WARNING];
    bough_simulation_channels(s, &channels);
    bough_status status = bough_error_probe_create(arena, s, NULL, &channels, &probe);
    assert_true(bough_is_ok(&status));
    for (int k = 0; k < 50; k++) {
        scene_step(s);
        bough_error_probe_update(&probe);
    }
    bough_error_probe_warn(&probe, 0, text);
    print_message("%s\n", text);
    assert_non_null(strstr(text, "the second solution, by which errors are measured, was given up from 0."));
    assert_non_null(strstr(text, "errors since then: not estimated"));
    bough_arena_destroy(arena);
}

// Forces, and the torque that a prescribed motion needs, err as the rods' wrenches do: a second solution
// measures that, the linearised members leave them unknown, not too small.
static void torques_of_motions_are_measured_or_unknown(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        const char *const sets[] = {
            "simulation.coupling.scheme=gauss-seidel", "simulation.error_estimate=second-solution",
            "bodies[hub].joint={kind: revolute, parent: ground, axis: x, motion: {speed: 2 rad/s}}", NULL};
        bough_arena *arena = bough_arena_create();
        bough_simulation *s = scene_build(arena, scene_path, sets);
        if (k == 1) s->master->error = BOUGH_ERROR_BY_LINEARISED_MEMBERS;
        bough_channels channels = bough_channels_start(arena);
        bough_error_probe probe;
        bough_simulation_channels(s, &channels);
        bough_status status = bough_error_probe_create(arena, s, NULL, &channels, &probe);
        assert_true(bough_is_ok(&status));
        for (int i = 0; i < 100; i++) {
            scene_step(s);
            bough_error_probe_update(&probe);
        }
        int torque = bough_channels_find(&channels, "hubTrq");
        int tip = bough_channels_find(&channels, "firstTipX");
        assert_true(torque >= 0 && tip >= 0);
        assert_int_equal(bough_error_probe_knows(&probe, torque), k == 0);
        assert_true(bough_error_probe_knows(&probe, tip));
        bough_arena_destroy(arena);
    }
}

// The values without the error are known at few times only. Their range must not be too small because of
// that, and not too large where the recorded motion has run away.
static void a_range_seen_at_few_times_is_not_too_small(void **state) {
    (void)state;
    static const struct {
        double high, true_low, true_high, largest, range;
    } cases[] = {
        {7e-3, 3e-3, 3.9e-3, 1e-4, 6.8e-3}, // the values turn back between two of these times
        {10, 0.1, 1.1, 9.5, 1},             // an error of nine times the motion
        {2, 0, 1.9, 0.2, 1.9},              // all of the motion was seen
        {2, 0, 2.5, 0.6, 2},                // the error hides some of it
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        bough_channel channel = {.unit = "m"};
        bough_channels channels = {.count = 1, .channel = &channel};
        int vector = 0;
        double low = 0, high = cases[k].high, true_low = cases[k].true_low, true_high = cases[k].true_high;
        double largest = cases[k].largest;
        bough_error_probe probe = {.channels = &channels, .vector = &vector, .batches = 2, .low = &low,
                                   .high = &high, .true_low = &true_low, .true_high = &true_high,
                                   .largest = &largest};
        check_near(bough_error_probe_relative(&probe, 0, largest), largest / cases[k].range, 0, 1e-12);
    }
}

static void probing_changes_nothing(void **state) {
    (void)state;
    recorded *with = run("simulation.coupling.scheme=ramp", true);
    recorded *without = run("simulation.coupling.scheme=ramp", false);
    assert_memory_equal(with->value, without->value, sizeof with->value);
    free(with);
    free(without);
}

// A body that a joint keeps from turning, on a pendulum of 40 degrees: what is left of its directions is rounding
// and the joint's tolerance.
static void a_direction_that_hardly_turns_beside_an_angle_is_not_judged(void **state) {
    (void)state;
    static const struct {
        double angle;  // range of the other channel [deg]
        int worst;
    } cases[] = {{40, 0}, {1e-4, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        bough_channel channel[2] = {{.name = "topPos", .unit = "deg"}, {.name = "loadDirXy", .unit = "-"}};
        bough_channels channels = {.channel = channel, .count = 2};
        bough_simulation simulation = {.n_motion_channel = 2};
        int vector[] = {0, 1};
        double none[] = {0, 0}, high[] = {cases[k].angle, 2e-6}, error[] = {1e-3 * cases[k].angle, 5e-6};
        double passed[] = {-1, -1};
        bough_error_probe probe = {.simulation = &simulation, .channels = &channels, .vector = vector,
                                   .low = none, .high = high, .true_low = none, .true_high = high,
                                   .largest = none, .passed = passed};
        bough_error_verdict v = bough_error_probe_verdict_of(&probe, error);
        assert_int_equal(v.channel, cases[k].worst);
    }
}

static void components_of_a_vector_have_one_range(void **state) {
    (void)state;
    bough_channel channel[] = {{"RotSpeed", "rpm"},  {"OoPDefl1", "m"},   {"IPDefl1", "m"},    {"TipDxb1", "m"},
                               {"TipDyb1", "m"},     {"OoPDefl2", "m"},   {"IPDefl2", "m"},    {"TTDspFA", "m"},
                               {"TTDspSS", "m"},     {"TTDspAx", "m"},    {"TTDspRoll", "deg"}, {"TTDspPtch", "deg"},
                               {"TTDspTwst", "deg"}, {"towerTipX", "m"},  {"towerTipZ", "m"}};
    enum { N = sizeof channel / sizeof *channel };
    static const int expected[N] = {0, 1, 1, 3, 3, 5, 5, 7, 7, 7, 10, 10, 10, 13, 13};
    int vector[N];
    bough_channels channels = {.channel = channel, .count = N};
    bough_error_probe_find_vectors(&channels, vector);
    for (int i = 0; i < N; i++) assert_int_equal(vector[i], expected[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_err_by_what_is_told),
        cmocka_unit_test(errors_of_sub_solvers_are_told),
        cmocka_unit_test(a_lost_second_solution_is_said),
        cmocka_unit_test(torques_of_motions_are_measured_or_unknown),
        cmocka_unit_test(a_range_seen_at_few_times_is_not_too_small),
        cmocka_unit_test(components_of_a_vector_have_one_range),
        cmocka_unit_test(a_direction_that_hardly_turns_beside_an_angle_is_not_judged),
        cmocka_unit_test(probing_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

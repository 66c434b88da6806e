// Errors of a turbine under a controller: what is told contains the reaction of air and controller, so that
// the pitch that the controller demands has an error, too.
#include "apps/simulation/run.h"
#include "tests/built_scene.h"

#include <math.h>

enum { STEPS = 150, WATCHED = 3 };
static const char *const watched[WATCHED] = {"blade1Pos", "RotSpeed", "OoPDefl1"};

typedef struct series {
    double value[STEPS][WATCHED], told[WATCHED];
    bool beside; // there is a second model
} series;

static series run(const char *coupling, const char *master, const char *control) {
    const char *const sets[] = {"simulation.error_estimate=auto",
                                coupling,
                                master,
                                control,
                                "simulation.duration=3 s",
                                "simulation.threads=1",
                                "bodies[3-5].rod.segments=4",
                                "bodies[2].joint.speed=13.5 rpm", "aero.wind.speed=14", NULL};
    series s = {0};
    bough_arena *arena = bough_arena_create();
    bough_run r;
    bough_status status = bough_run_create(arena, scene_read(arena, "apps/turbine/power.yaml", sets), &r);
    assert_int_equal(status.code, BOUGH_OK);
    s.beside = r.second != NULL;
    int channel[WATCHED];
    for (int i = 0; i < WATCHED; i++) channel[i] = bough_channels_find(&r.channels, watched[i]);
    for (int k = 0; k < STEPS; k++) {
        do { // steps of 20 ms, or parts of them
            status = bough_run_step(&r);
            assert_int_equal(status.code, BOUGH_OK);
        } while (r.simulation->master->time < 0.02 * (k + 1) - 1e-9);
        for (int i = 0; i < WATCHED; i++) s.value[k][i] = bough_run_values(&r)[channel[i]];
    }
    for (int i = 0; i < WATCHED; i++) s.told[i] = r.probe.largest[channel[i]];
    bough_arena_destroy(arena);
    return s;
}

static void errors_contain_the_reaction_of_loads(const char *steps) {
    series coupled = run("simulation.coupling={scheme: gauss-seidel}", steps, "control.rate=50");
    series truth = run("simulation.coupling={scheme: monolithic}",
                       "simulation.master={solver: ida, rtol: 1e-7}", "control.rate=50");
    assert_true(coupled.beside);
    assert_false(truth.beside);
    for (int i = 0; i < WATCHED; i++) {
        double error = 0;
        for (int k = 0; k < STEPS; k++) error = fmax(error, fabs(coupled.value[k][i] - truth.value[k][i]));
        print_message("%s: true %.2g, told %.2g\n", watched[i], error, coupled.told[i]);
        assert_true(error > 1e-5);
        check_near(coupled.told[i], 1.25 * error, 0.2, 0); // told with a margin of 1.25
    }
}

static void errors_of_equal_steps(void **state) {
    (void)state;
    errors_contain_the_reaction_of_loads("simulation.master={rtol: 1e-6}");
}

// The second model takes the whole macro steps, which these runs divide.
static void errors_of_controlled_steps(void **state) {
    (void)state;
    errors_contain_the_reaction_of_loads("simulation.step_control={tolerance: 1e-2}");
}

#define LIBRARY                                                                                              \
    "control={kind: bladed, rate: 50, gear_ratio: 97, input: memory, library: " BOUGH_SAMPLE_DISCON "}"

// A library has a memory, and the second model one of its own: the run's values are those without it.
static void a_library_is_copied(void **state) {
    (void)state;
    series coupled =
        run("simulation.coupling={scheme: gauss-seidel}", "simulation.error_estimate=auto", LIBRARY);
    assert_true(coupled.beside);
    series alone =
        run("simulation.coupling={scheme: gauss-seidel}", "simulation.error_estimate=none", LIBRARY);
    assert_false(alone.beside);
    series truth = run("simulation.coupling={scheme: monolithic}",
                       "simulation.master={solver: ida, rtol: 1e-7}", LIBRARY);
    for (int i = 0; i < WATCHED; i++) {
        double error = 0;
        for (int k = 0; k < STEPS; k++) error = fmax(error, fabs(coupled.value[k][i] - truth.value[k][i]));
        print_message("%s: true %.2g, told %.2g\n", watched[i], error, coupled.told[i]);
        check_near(coupled.told[i], 1.25 * error, 0.2, 1e-12);
        for (int k = 0; k < STEPS; k++) assert_true(coupled.value[k][i] == alone.value[k][i]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_of_equal_steps),
        cmocka_unit_test(errors_of_controlled_steps),
        cmocka_unit_test(a_library_is_copied),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

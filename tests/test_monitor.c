// The growth watch on Gauss–Seidel coupling of the two-mass oscillator (limit .0777) and of a lightly
// damped one: slow growth is diagnosed, stable runs never are.
#include "tests/two_mass.h"

static bough_status run(bough_two_mass m, const char *scheme, double macro_step, double duration,
                        double *stopped) {
    bough_master_def def = bough_master_def_default();
    def.scheme.name = scheme;
    def.macro_step = macro_step;
    def.duration = duration;
    bough_status status = bough_two_mass_build(&m, def);
    while (bough_is_ok(&status) && !bough_master_done(m.master)) status = bough_step(m.master);
    *stopped = m.master->time;
    bough_two_mass_destroy(&m);
    return status;
}

// Like a rotor on its shaft: the leader heavier, damping of 0.1 %.
static bough_two_mass lightly_damped(void) {
    bough_two_mass m = bough_two_mass_default();
    m.s1 = (bough_spring_mass){2, 4, .004};
    m.s2 = (bough_spring_mass){1, 1, .002};
    m.k = 30;
    m.c = .03;
    return m;
}

static void slow_growth_is_diagnosed(void **state) {
    (void)state;
    static const double macro_step[] = {.02, .04, .08, .16}, latest[] = {150, 65, 32, 20};
    double stopped;
    for (int k = 0; k < 4; k++) { // growing by .05, .13, .27 and .51 per second
        bough_status status = run(lightly_damped(), "gauss-seidel", macro_step[k], 400, &stopped);
        assert_int_equal(status.code, BOUGH_FAILED);
        assert_non_null(strstr(status.message, "unstable"));
        assert_true(stopped < latest[k]);
    }
    bough_status status = run(lightly_damped(), "gauss-seidel", .01, 400, &stopped);
    if (!bough_is_ok(&status)) fail_msg("%s", status.message);
}

static void stable_runs_raise_no_alarm(void **state) {
    (void)state;
    for (const char *const *name = bough_scheme_names(); *name; name++) {
        for (double h = .005; h < .077; h *= 1.2) {
            double stopped;
            bough_status status = run(bough_two_mass_default(), *name, h, 200, &stopped);
            if (!bough_is_ok(&status)) fail_msg("%s", status.message);
        }
    }
}

static void what_is_not_finite_is_told(void **state) {
    (void)state;
    const double values[] = {NAN, (double)INFINITY, -(double)INFINITY, 1e308, -1e308};
    bough_two_mass m = bough_two_mass_default();
    bough_master_def def = bough_master_def_default();
    def.macro_step = .01;
    def.duration = 1;
    bough_status status = bough_two_mass_build(&m, def);
    if (bough_is_ok(&status)) status = bough_step(m.master);
    assert_true(bough_is_ok(&status));
    bough_coupling *c = m.master->coupling;
    for (int k = 0; k < 5; k++) {
        c->output[c->assembly->n_output - 1] = values[k];
        status = bough_monitor_step(m.master->monitor, c);
        assert_int_equal(bough_is_ok(&status), isfinite(values[k]) != 0);
        if (bough_is_ok(&status)) continue;
        assert_non_null(strstr(status.message, "no finite state or output"));
    }
    bough_two_mass_destroy(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slow_growth_is_diagnosed),
        cmocka_unit_test(stable_runs_raise_no_alarm),
        cmocka_unit_test(what_is_not_finite_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// Macro-step control on the two-mass oscillator.
#include "tests/unit/two_mass.h"

static bough_master_def definition(const char *scheme, double macro_step, double tolerance) {
    bough_master_def def = two_mass_def(scheme, macro_step, 4);
    def.scheme.tolerance = 1e-11;
    def.control = (bough_step_control_def){tolerance, macro_step / 8};
    return def;
}

// No step meets the tolerance: the first ones are taken back three times, and what follows is the run
// with an eighth of the macro step. So nothing of the steps taken back is left.
TEST(steps_taken_back_leave_nothing) {
    static const char *const schemes[] = {"frozen", "gauss-seidel", "extrapolated", "ramp", "iterated"};
    for (size_t k = 0; k < sizeof schemes / sizeof *schemes; k++) {
        for (int light = 0; light < 2; light++) {
            bough_two_mass m = bough_two_mass_default(), fixed = bough_two_mass_default();
            if (light) m.s1 = fixed.s1 = (bough_spring_mass){.4, 1, .1};
            check_ok(bough_two_mass_build(check_memory(), &m, definition(schemes[k], .08, 1e-14)));
            bough_status status =
                bough_two_mass_build(check_memory(), &fixed, definition(schemes[k], .01, 0));
            check_ok(status);
            while (!bough_master_done(m.master)) {
                status = bough_step(m.master);
                if (bough_is_ok(&status)) status = bough_step(fixed.master);
                check_ok(status);
                check_near(m.master->time, fixed.master->time, 0, 1e-12);
                for (int i = 0; i < 2; i++) {
                    check_near(m.mass[i].y[0], fixed.mass[i].y[0], 0, 1e-10);
                    check_near(m.mass[i].y[1], fixed.mass[i].y[1], 0, 1e-10);
                }
            }
            assert_int_equal(m.master->control->now.rejected, 3);
            assert_int_equal(m.master->control->now.forced, m.master->steps);
            assert_int_equal(m.master->control->now.accepted, m.master->steps);
        }
    }
}

static double error_with(const char *scheme, double tolerance, long *steps) {
    bough_two_mass m = bough_two_mass_default();
    bough_master_def def = definition(scheme, .16, tolerance);
    def.control.least = .16 / 1024;
    check_ok(bough_two_mass_build(check_memory(), &m, def));
    double error = two_mass_error(&m);
    *steps = m.master->steps;
    return error;
}

// Gauss–Seidel is unstable at .16 s; under control its error follows the tolerance.
TEST(error_follows_the_tolerance) {
    static const char *const schemes[] = {"gauss-seidel", "extrapolated", "ramp"};
    for (size_t k = 0; k < sizeof schemes / sizeof *schemes; k++) {
        long few, more;
        double coarse = error_with(schemes[k], 3e-2, &few);
        double fine = error_with(schemes[k], 3e-3, &more);
        assert_true(few < more);
        assert_true(coarse < .01 && fine < coarse / 5);
    }
}

// The motion dies; relative to what the ports have seen the defects do too, and steps grow again.
TEST(steps_grow_again_and_meet_events) {
    static const double event[] = {.333, 2.5};
    bough_two_mass m = bough_two_mass_default();
    bough_master_def def = definition("extrapolated", .16, 3e-3);
    def.duration = 20;
    def.event = event;
    def.n_event = 2;
    bough_two_mass_build(check_memory(), &m, def);
    double longest = 0, shortest = 1;
    int met = 0;
    while (!bough_master_done(m.master)) {
        double t = m.master->time;
        check_ok(bough_step(m.master));
        double length = m.master->time - t;
        if (t < 1) shortest = fmin(shortest, length);
        if (t > 16) longest = fmax(longest, length);
        met += m.master->at_event;
    }
    assert_int_equal(met, 2);
    check_near(longest, .16, 1e-9, 0);
    assert_true(shortest <= .021);
}

static bough_integrator_ops failing; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static bough_code failure;
static int calls;

static bough_status fail_to_advance(void *self, double *t, double t1, bool restart, double *y) {
    (void)self, (void)t, (void)restart, (void)y;
    calls++;
    return bough_fail(failure, "mass1 at t = %g s: gave up", t1);
}

// A numerical failure is tried again with shorter steps down to the shortest, .02 s; no other is.
TEST(only_what_asks_for_it_is_repeated) {
    static const struct {
        bough_code code, expected;
        int calls;
    } cases[] = {{BOUGH_FAILED, BOUGH_FAILED, 4}, // .16, .08, .04, .02 s
                 {BOUGH_IO, BOUGH_IO, 1},
                 {BOUGH_OUT_OF_MEMORY, BOUGH_OUT_OF_MEMORY, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        bough_two_mass m = bough_two_mass_default();
        check_ok(bough_two_mass_build(check_memory(), &m, definition("gauss-seidel", .16, 1e-3)));
        failing = *m.member[0].integrator.ops;
        failing.advance = fail_to_advance;
        m.member[0].integrator.ops = &failing;
        failure = cases[k].code;
        calls = 0;
        bough_status status = bough_step(m.master);
        assert_int_equal(status.code, cases[k].expected);
        assert_int_equal(calls, cases[k].calls);
    }
}

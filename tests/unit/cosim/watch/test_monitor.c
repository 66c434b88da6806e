// The growth watches on the two-mass oscillator (limit of Gauss–Seidel .0777) and on a lightly
// damped one: slow growth is diagnosed, stable runs never are, growth of the mechanics is not under
// implicit coupling.
#include "tests/unit/sample_numbers.h"
#include "tests/unit/two_mass.h"

static bough_status run(bough_two_mass m, const char *scheme, double macro_step, double duration,
                        double *stopped) {
    bough_master_def def = two_mass_def(scheme, macro_step, duration);
    bough_status status = bough_two_mass_build(check_memory(), &m, def);
    while (bough_is_ok(&status) && !bough_master_done(m.master)) status = bough_step(m.master);
    *stopped = m.master->time;
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

TEST(slow_growth_is_diagnosed) {
    static const double macro_step[] = {.01, .02, .04, .08, .16}, latest[] = {300, 150, 65, 32, 20};
    double stopped;
    for (int k = 0; k < 5; k++) { // growing by .015, .05, .13, .27 and .51 per second
        check_fails(run(lightly_damped(), "gauss-seidel", macro_step[k], 400, &stopped), BOUGH_FAILED,
                    "unstable");
        assert_true(stopped < latest[k]);
    }
    check_ok(run(lightly_damped(), "gauss-seidel", .004, 400, &stopped));
}

TEST(stable_runs_raise_no_alarm) {
    const char *name;
    for (int k = 0; (name = bough_scheme_name(k)) != NULL; k++) {
        for (double h = .005; h < .077; h *= 1.2) {
            double stopped;
            check_ok(run(bough_two_mass_default(), name, h, 200, &stopped));
        }
    }
}

TEST(what_is_not_finite_is_reported) {
    const double values[] = {NAN, (double)INFINITY, -(double)INFINITY, 1e308, -1e308};
    bough_two_mass m = bough_two_mass_default();
    bough_master_def def = bough_master_def_default();
    def.macro_step = .01;
    def.duration = 1;
    check_ok(bough_two_mass_build(check_memory(), &m, def));
    check_ok(bough_step(m.master));
    bough_coupling *c = m.master->coupling;
    for (int k = 0; k < 5; k++) {
        c->output[c->assembly->n_output - 1] = values[k];
        bough_status status = bough_monitor_step(m.master->monitor, c, false);
        assert_int_equal(bough_is_ok(&status), isfinite(values[k]) != 0);
        if (bough_is_ok(&status)) continue;
        assert_non_null(strstr(status.message, "no finite state or output"));
    }
}

// The fate of a run of 20 s: −1 stopped, else its largest motion relative to the start.
static double fate(bough_two_mass m, const char *scheme, bough_exchange exchange, double macro_step) {
    bough_master_def def = two_mass_def(scheme, macro_step, 20);
    def.scheme.exchange = exchange;
    bough_status status = bough_two_mass_build(check_memory(), &m, def);
    double largest = 0;
    while (bough_is_ok(&status) && !bough_master_done(m.master)) {
        status = bough_step(m.master);
        largest = fmax(largest, fmax(fabs(m.mass[0].y[0]), fabs(m.mass[1].y[0])));
    }
    return bough_is_ok(&status) ? largest : -1;
}

typedef struct variant {
    const char *scheme;
    bough_exchange exchange;
} variant;

// Undamped masses and springs of any ratio, 100 to 1000 macro steps of up to several radians. Who
// does not hold is stopped; 1e4 is what a first step of 13 radians throws the masses by.
TEST(no_scheme_blows_up_in_silence) {
    static const variant tried[] = {{.scheme = "frozen"},       {.scheme = "gauss-seidel"},
                                    {.scheme = "extrapolated"}, {.scheme = "ramp"},
                                    {.scheme = "iterated"},     {"iterated", BOUGH_EXCHANGE_WAVEFORM}};
    unsigned seed = 1;
    int stopped = 0;
    for (int n = 0; n < 60; n++) {
        bough_two_mass m = {.s2.m = 1, .y0 = {1, 0, 0, 0}};
        m.s1.m = pow(10, 3 * sample_between(&seed, 0, 1) - 1);
        m.s1.k = pow(10, 4 * sample_between(&seed, 0, 1) - 1);
        m.s2.k = pow(10, 4 * sample_between(&seed, 0, 1) - 1);
        m.k = pow(10, 4 * sample_between(&seed, 0, 1));
        double macro_step = .02 * pow(10, sample_between(&seed, 0, 1));
        for (int k = 0; k < 6; k++) {
            double largest = fate(m, tried[k].scheme, tried[k].exchange, macro_step);
            stopped += largest < 0;
            assert_true(largest < 2e4);
        }
    }
    assert_in_range(stopped, 60, 240);
}

// Members whose equations are not known have no eigenvalues.
TEST(unknown_members_do_not_blow_up_in_silence) {
    for (double h = .004; h < .2; h *= 40) {
        bough_two_mass m = lightly_damped();
        bough_status status = bough_two_mass_build(check_memory(), &m, two_mass_def("gauss-seidel", h, 100));
        m.master->assembly->opaque = true;
        double largest = 0;
        while (bough_is_ok(&status) && !bough_master_done(m.master)) {
            status = bough_step(m.master);
            largest = fmax(largest, fabs(m.mass[0].y[0]));
        }
        assert_int_equal(bough_is_ok(&status), h < .1); // at .16 s it grows by .51 per second
        assert_true(largest < 1e4);
    }
}

// A fall and a flutter that the masses bring with them, to a thousand times the start.
TEST(growth_of_the_mechanics_goes_on) {
    static const variant tried[] = {
        {.scheme = "ramp"}, {.scheme = "iterated"}, {"iterated", BOUGH_EXCHANGE_WAVEFORM}};
    bough_two_mass falls = bough_two_mass_default(), flutters = bough_two_mass_default();
    falls.s1.k = falls.s2.k = -1;
    flutters.s1.c = -1.5;
    for (int k = 0; k < 3; k++) {
        assert_true(fate(falls, tried[k].scheme, tried[k].exchange, .02) > 1000);
        assert_true(fate(flutters, tried[k].scheme, tried[k].exchange, .02) > 1000);
    }
}

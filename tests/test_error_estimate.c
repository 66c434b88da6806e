// The estimated coupling error against the true one of the two-mass oscillator.
#include "cosim/error_estimate.h"
#include "tests/two_mass.h"

// Largest errors of the positions where batches end: the true and the estimated.
typedef struct errors {
    double exact, estimate;
} errors;

static errors errors_of(bough_two_mass m, bough_master_def def) {
    errors e = {0};
    bough_status status = bough_two_mass_build(&m, def);
    if (!bough_is_ok(&status)) fail_msg("%s", status.message);
    long batches = 0;
    while (!bough_master_done(m.master)) {
        status = bough_step(m.master);
        if (!bough_is_ok(&status)) fail_msg("%s", status.message);
        if (bough_error_estimate_batches(m.master->estimate) == batches) continue;
        batches = bough_error_estimate_batches(m.master->estimate);
        const double *error = bough_error_estimate_states(m.master->estimate);
        double y[4];
        bough_two_mass_at(&m, m.master->time, y);
        e.exact = fmax(e.exact, fabs(m.mass[0].y[0] - y[0]));
        e.exact = fmax(e.exact, fabs(m.mass[1].y[0] - y[2]));
        e.estimate = fmax(e.estimate, fmax(fabs(error[0]), fabs(error[2])));
    }
    bough_two_mass_destroy(&m);
    return e;
}

static bough_master_def definition(const char *scheme, int order, double macro_step) {
    bough_master_def def = bough_master_def_default();
    def.scheme.name = scheme;
    def.scheme.order = order;
    def.scheme.tolerance = 1e-11;
    def.scheme.exchange = BOUGH_EXCHANGE_END_VALUES;
    def.macro_step = macro_step;
    def.duration = 10;
    return def;
}

// ε of a linear system is its error to the order of the defects' own reconstruction.
static void check_ratio(bough_master_def def, double h, bool kinematic) {
    bough_two_mass m = bough_two_mass_default();
    m.kinematic = kinematic;
    def.macro_step = h;
    errors e = errors_of(m, def);
    double ratio = e.estimate / e.exact;
    if (ratio > .8 && ratio < 2.5) return;
    fail_msg("%s, order %d, %g s: %g estimated, %g true", def.scheme.name, def.scheme.order, h,
             e.estimate, e.exact);
}

static void every_scheme_tells_its_error(void **state) {
    (void)state;
    static const struct {
        const char *scheme;
        int order;
        bool parallel;
    } row[] = {{"frozen", 0, false},       {"gauss-seidel", 0, false}, {"extrapolated", 0, true},
               {"extrapolated", 1, false}, {"extrapolated", 2, false}, {"extrapolated", 1, true},
               {"extrapolated", 2, true},  {"ramp", 0, false},         {"iterated", 0, false},
               {"iterated", 1, false},     {"iterated", 2, false}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        bough_master_def def = definition(row[k].scheme, row[k].order, 0);
        def.scheme.parallel = row[k].parallel;
        for (double h = .0025; h < .05; h *= 4) check_ratio(def, h, k % 2 == 0);
        if (!def.scheme.parallel) def.scheme.interpolation = BOUGH_POLYNOMIAL;
        check_ratio(def, .02, false);
    }
}

// Waveforms err at order 6 and are told at order 4, never too little; nor is what a loose tolerance
// leaves.
static void waveforms_are_told_enough(void **state) {
    (void)state;
    for (double h = .4; h > .02; h /= 2) {
        for (int loose = 0; loose < 2; loose++) {
            bough_master_def def = definition("iterated", 1, h);
            def.scheme.exchange = BOUGH_EXCHANGE_WAVEFORM;
            if (loose) def.scheme.tolerance = 1e-4;
            errors e = errors_of(bough_two_mass_default(), def);
            assert_true(e.estimate > .45 * e.exact);
            assert_true(e.estimate < 1.2 * e.exact + 2 * h * h * h * h);
        }
    }
}

// Beyond its limit an explicit scheme's error grows, and the estimate with it.
static void growth_is_told(void **state) {
    (void)state;
    bough_master_def def = definition("gauss-seidel", 0, .1);
    errors e = errors_of(bough_two_mass_default(), def);
    assert_true(e.exact > .1 && e.estimate > .8 * e.exact && e.estimate < 3 * e.exact);
}

static void forces_are_told_too(void **state) {
    (void)state;
    bough_two_mass m = bough_two_mass_default();
    bough_status status = bough_two_mass_build(&m, definition("gauss-seidel", 0, .01));
    double exact = 0, y[4];
    while (bough_is_ok(&status) && !bough_master_done(m.master)) {
        status = bough_step(m.master);
        bough_two_mass_at(&m, m.master->time, y);
        double force = m.k * (y[2] - y[0]) + m.c * (y[3] - y[1]);
        exact = fmax(exact, fabs(m.master->coupling->input[0] - force));
    }
    assert_true(bough_is_ok(&status));
    check_near(bough_error_estimate_input(m.master->estimate, 0) / BOUGH_ERROR_SAFETY, exact, .05, 0);
    bough_two_mass_destroy(&m);
}

// A force that its receiver knows before it changes: no defect, no error.
static void no_defect_no_error(void **state) {
    (void)state;
    bough_two_mass m = bough_two_mass_default();
    m.k = m.c = 0;
    errors e = errors_of(m, definition("frozen", 0, .02));
    check_near(e.estimate, 0, 0, 1e-15);
    check_near(e.exact, 0, 0, 1e-12);
}

static void monolithic_has_none(void **state) {
    (void)state;
    bough_two_mass m = bough_two_mass_default();
    bough_two_mass_build(&m, definition("monolithic", 0, .02));
    assert_null(m.master->estimate);
    bough_two_mass_destroy(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scheme_tells_its_error),
        cmocka_unit_test(waveforms_are_told_enough),
        cmocka_unit_test(growth_is_told),
        cmocka_unit_test(forces_are_told_too),
        cmocka_unit_test(no_defect_no_error),
        cmocka_unit_test(monolithic_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

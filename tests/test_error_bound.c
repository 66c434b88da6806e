// The bound on the coupling error, on made-up windows of 64 steps of 20 ms.
#include "cosim/error_bound.h"
#include "tests/check.h"

static const double length = 1.28; // of a window [s]

static void close_windows(bough_error_bound *b, int count, const double *defect, double energy) {
    for (int k = 0; k < count; k++) {
        bough_error_window window = {.defect = defect[k], .energy = energy};
        bough_error_bound_close(b, window, 64, length * (b->n_window + 1));
    }
}

static void growth_beyond_the_bound_breaks_it(void **state) {
    (void)state;
    const double defect[] = {.05, .02, .012, .01, .014, .02, .033, .053, .085};
    bough_error_bound b = {0};
    close_windows(&b, 8, defect, .15);
    assert_false(bough_error_bound_broken(&b));
    close_windows(&b, 1, defect + 8, .15);
    assert_true(bough_error_bound_broken(&b));
    assert_false(bough_error_bound_hopeless(&b));
    check_near(b.good_time, 5 * length, 1e-12, 0);
    check_near(b.growth, 1.0074, 1e-4, 0);
}

static void both_measures_must_agree(void **state) {
    (void)state;
    const double defect[] = {.01, .04, .08, .16, .3};
    bough_error_bound b = {0};
    close_windows(&b, 5, defect, .09);
    assert_false(bough_error_bound_broken(&b));
}

static void start_up_and_coarse_coupling_do_not_break_it(void **state) {
    (void)state;
    const double start[] = {.25, .2, .12, .08, .06}, coarse[] = {.11, .1, .12, .1, .13, .11};
    bough_error_bound b = {0};
    close_windows(&b, 5, start, .3);
    assert_false(bough_error_bound_broken(&b));
    b = (bough_error_bound){0};
    close_windows(&b, 6, coarse, .3);
    assert_false(bough_error_bound_broken(&b));
}

// A gust: the error rises once and dies away.
static void a_passing_rise_does_not_break_it(void **state) {
    (void)state;
    const double defect[] = {.01, .01, .09, .06, .04, .03, .02, .09, .07};
    bough_error_bound b = {0};
    for (int k = 0; k < 9; k++) {
        close_windows(&b, 1, defect + k, .2);
        assert_false(bough_error_bound_broken(&b));
    }
}

static void a_large_error_is_hopeless(void **state) {
    (void)state;
    const double defect[] = {.01, .1, .25, .4};
    bough_error_bound b = {0};
    close_windows(&b, 4, defect, .3);
    assert_true(bough_error_bound_hopeless(&b));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(growth_beyond_the_bound_breaks_it),
        cmocka_unit_test(both_measures_must_agree),
        cmocka_unit_test(start_up_and_coarse_coupling_do_not_break_it),
        cmocka_unit_test(a_passing_rise_does_not_break_it),
        cmocka_unit_test(a_large_error_is_hopeless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

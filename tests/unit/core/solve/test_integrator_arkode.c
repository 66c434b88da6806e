// ARKODE with a Newton solver of one's own, on a stiff linear system whose solution is known.
#include "tests/unit/stiff_modes.h"

static const char *solver(void) { return "ARKODE"; }
static problem *create(double rtol) { return create_kind(BOUGH_ARKODE_ESDIRK, rtol); }

static double error_with(double rtol) {
    problem *p = create(rtol);
    double y[N];
    exact(0, y);
    advance(p, 0, 2, true, y);
    double error = error_at(y, 2);
    destroy(p);
    return error;
}

// At many tolerances: with its own settings ARKODE now and then accepts a step that is wrong by
// its size in the stiffest mode, because it trusts the convergence rate of other factors.
TEST(no_tolerance_gives_a_wrong_stiff_state) {
    for (double rtol = 1e-3; rtol > 1e-9; rtol *= 0.9) assert_true(error_with(rtol) < 30 * rtol);
}

// Order 4: the error follows the tolerance.
TEST(error_falls_with_the_tolerance) {
    double coarse = error_with(1e-4), fine = error_with(1e-8);
    assert_true(fine < 1e-3 * coarse);
}

// The tolerance is rtol times the scale of each state.
TEST(tolerance_is_relative_to_the_scale) {
    static const double scales[2][N] = {{1, 1, 1}, {1e-3, 1e-3, 1e-3}};
    double y[2][N];
    for (int k = 0; k < 2; k++) {
        problem *p = create_scaled(BOUGH_ARKODE_ESDIRK, scales[k], k == 0 ? 1e-6 : 1e-3);
        exact(0, y[k]);
        advance(p, 0, 1, true, y[k]);
        destroy(p);
    }
    for (int i = 0; i < N; i++) check_near(y[1][i], y[0][i], 1e-9, 1e-12);
}

// f has no value beyond the end, and the end is reached though no natural step ends there.
TEST(stops_at_the_end_and_looks_no_further) {
    problem *p = create(1e-6);
    double y[N];
    exact(0, y);
    for (int k = 0; k < 50; k++) {
        double t1 = (k + 1) * 0.0317;
        p->wall = t1;
        advance(p, k * 0.0317, t1, k == 0, y);
        assert_true(p->latest <= t1);
        check_near(p->latest, t1, 1e-14, 0);
        assert_true(error_at(y, t1) < 2e-5);
    }
    destroy(p);
}

// A jump costs a start, not an order.
TEST(restarts_are_nearly_free) {
    long steps[2];
    for (int restart = 0; restart < 2; restart++) {
        problem *p = create(1e-6);
        double y[N];
        exact(0, y);
        for (int k = 0; k < 20; k++) advance(p, 0.5 * k, 0.5 * (k + 1), restart || k == 0, y);
        assert_true(error_at(y, 10) < 2e-5);
        bough_statistics s = counts(p);
        assert_int_equal(s.starts, restart ? 20 : 1);
        steps[restart] = s.steps;
        destroy(p);
    }
    print_message("kept %ld, anew %ld steps\n", steps[0], steps[1]);
    assert_true(steps[1] < 3 * steps[0]);
}

// CVODE with a Newton solver of one's own, on a stiff linear system whose solution is known.
#include "tests/unit/stiff_modes.h"

static const char *solver(void) { return "CVODE"; }
static problem *create(double rtol) { return create_kind(BOUGH_CVODE_BDF, rtol); }

TEST(error_falls_with_the_tolerance) {
    double last = INFINITY;
    for (double rtol = 1e-3; rtol > 1e-8; rtol *= 1e-2) {
        problem *p = create(rtol);
        double y[N];
        exact(0, y);
        advance(p, 0, 2, true, y);
        double error = error_at(y, 2);
        assert_true(error < 30 * rtol);
        assert_true(error < 0.1 * last);
        last = error;
        destroy(p);
    }
}

// The tolerance is rtol times the scale of each state.
TEST(tolerance_is_relative_to_the_scale) {
    static const double scales[2][N] = {{1, 1, 1}, {1e-3, 1e-3, 1e-3}};
    double y[2][N];
    for (int k = 0; k < 2; k++) {
        problem *p = create_scaled(BOUGH_CVODE_BDF, scales[k], k == 0 ? 1e-6 : 1e-3);
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

static long steps_of(bool restart) {
    problem *p = create(1e-6);
    double y[N];
    exact(0, y);
    for (int k = 0; k < 100; k++) {
        advance(p, 0.1 * k, 0.1 * (k + 1), restart || k == 0, y);
    }
    assert_true(error_at(y, 10) < 2e-5);
    bough_statistics s = counts(p);
    assert_int_equal(s.starts, restart ? 100 : 1);
    destroy(p);
    return s.steps;
}

TEST(kept_history_saves_steps) {
    long kept = steps_of(false), anew = steps_of(true);
    assert_true(kept >= 100);
    assert_true(2 * kept < anew);
}

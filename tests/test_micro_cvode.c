// CVODE with a Newton solver of one's own, on a stiff linear system whose solution is known.
#include "tests/stiff_modes.h"

static problem *create(double rtol) { return create_kind(BOUGH_MICRO_CVODE_BDF, rtol); }

static void error_falls_with_the_tolerance(void **context) {
    (void)context;
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
static void tolerance_is_relative_to_the_scale(void **context) {
    (void)context;
    static const double scales[2][N] = {{1, 1, 1}, {1e-3, 1e-3, 1e-3}};
    double y[2][N];
    for (int k = 0; k < 2; k++) {
        problem *p = create_scaled(BOUGH_MICRO_CVODE_BDF, scales[k], k == 0 ? 1e-6 : 1e-3);
        exact(0, y[k]);
        advance(p, 0, 1, true, y[k]);
        destroy(p);
    }
    for (int i = 0; i < N; i++) check_near(y[1][i], y[0][i], 1e-9, 1e-12);
}

// f has no value beyond the end, and the end is reached though no natural step ends there.
static void stops_at_the_end_and_looks_no_further(void **context) {
    (void)context;
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
    assert_int_equal(s.restarts, restart ? 99 : 0);
    destroy(p);
    return s.steps;
}

static void kept_history_saves_steps(void **context) {
    (void)context;
    long kept = steps_of(false), anew = steps_of(true);
    assert_true(kept >= 100);
    assert_true(2 * kept < anew);
}

// From a state that was changed outside, as the exact solution of the same modes started there.
static void restart_takes_up_a_changed_state(void **context) {
    (void)context;
    problem *p = create(1e-7);
    double y[N], moved[N];
    exact(0, y);
    advance(p, 0, 0.4, false, y); // the first call starts in any case
    exact(0, moved);
    advance(p, 0, 0.4, true, moved);
    for (int i = 0; i < N; i++) check_near(moved[i], y[i], 0, 0);
    assert_int_equal(counts(p).restarts, 1);
    exact(3, y);
    advance(p, 3, 3.7, true, y);
    assert_true(error_at(y, 3.7) < 3e-6);
    destroy(p);
}

static void check_failure(const bough_status *status, const char *time, const char *why) {
    assert_int_equal(status->code, BOUGH_FAILED);
    const char *parts[] = {"stiff", "CVODE", time, why};
    for (int k = 0; k < 4; k++) {
        if (strstr(status->message, parts[k]) == NULL) {
            fail_msg("\"%s\" does not name \"%s\"", status->message, parts[k]);
        }
    }
}

static void failure_names_body_time_and_solver(void **context) {
    (void)context;
    problem *p = create(1e-6);
    double y[N];
    exact(0, y);
    advance(p, 0, 0.2, true, y);
    p->wall = 0.5;
    bough_status status = try_advance(p, 0.2, 1, false, y);
    check_failure(&status, "t = 0.5 s", "no finite forces"); // ever smaller ones up to the wall
    exact(0.2, y);
    p->wall = 0.3;
    p->lasting = true;
    status = try_advance(p, 0.2, 1, true, y);
    check_failure(&status, "t = 0.2", "finite");
    p->broken = false;
    p->wall = 0;
    exact(0.25, y);
    status = try_advance(p, 0.25, 1, true, y);
    check_failure(&status, "t = 0.25 s", "finite");
    p->broken = false;
    p->wall = INFINITY;
    p->singular = true;
    status = try_advance(p, 0.25, 1, true, y);
    check_failure(&status, "t = 0.25 s", "Newton");
    p->singular = false; // and a restart brings it back
    exact(0.25, y);
    advance(p, 0.25, 1, true, y);
    assert_true(error_at(y, 1) < 2e-5);
    destroy(p);
}

static void statistics_add_up_over_restarts(void **context) {
    (void)context;
    problem *p = create(1e-6);
    double y[N];
    bough_statistics sum = counts(p);
    assert_int_equal(sum.steps + sum.derivatives + sum.restarts, 0);
    exact(0, y);
    for (int k = 0; k < 12; k++) {
        bough_statistics before = counts(p);
        advance(p, 0.1 * k, 0.1 * (k + 1), k % 4 == 0, y);
        assert_true(counts(p).steps > before.steps);
    }
    sum = counts(p);
    assert_int_equal(sum.derivatives, p->derivatives);
    assert_int_equal(sum.jacobians, p->linearisations);
    assert_int_equal(sum.factorisations, p->factorisations);
    assert_int_equal(sum.iterations, p->solutions);
    assert_int_equal(sum.restarts, 2);
    bough_statistics twice = sum; // counts are added to what is there
    add_counts(p, &twice);
    assert_int_equal(twice.steps, 2 * sum.steps);
    assert_int_equal(twice.failed_steps, 2 * sum.failed_steps);
    assert_int_equal(twice.restarts, 4);
    destroy(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_falls_with_the_tolerance),
        cmocka_unit_test(tolerance_is_relative_to_the_scale),
        cmocka_unit_test(stops_at_the_end_and_looks_no_further),
        cmocka_unit_test(kept_history_saves_steps),
        cmocka_unit_test(restart_takes_up_a_changed_state),
        cmocka_unit_test(failure_names_body_time_and_solver),
        cmocka_unit_test(statistics_add_up_over_restarts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

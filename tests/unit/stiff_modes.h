// A stiff linear system whose solution is known, for sub-solvers with a Newton solver of one's own.
#ifndef BOUGH_TESTS_STIFF_MODES_H
#define BOUGH_TESTS_STIFF_MODES_H

#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

#include "core/base/linalg.h"
#include "core/solve/integrator.h"

#include <stdlib.h>
#include <string.h>

enum { N = 3 };

// ẏ = Q Λ (w(t) − Qᵀy) with Q orthogonal, w = (cos t, cos t, cos t): each mode follows the cosine
// with its own rate.
static const double rates[N] = {0.7, 40, 3000}; // Λ [1/s]
static const double columns[N][N] = {
    {2.0 / 3, 2.0 / 3, 1.0 / 3}, {-2.0 / 3, 1.0 / 3, 2.0 / 3}, {1.0 / 3, -2.0 / 3, 2.0 / 3}};

typedef struct problem {
    bough_arena *arena;
    bough_integrator micro;
    double wall;  // f has no value beyond [s]
    bool lasting; // nor anywhere once it was asked for there
    bool broken;
    bool singular;
    double latest; // time of an evaluation [s]
    long derivatives, linearisations, factorisations, solutions;
    double factor[N * N];
    int pivot[N];
} problem;

static double mode(const double *y, int k) {
    return columns[k][0] * y[0] + columns[k][1] * y[1] + columns[k][2] * y[2];
}

static bool derivative(void *self, double t, const double *y, double *rate) {
    problem *p = self;
    p->derivatives++;
    p->latest = fmax(p->latest, t);
    if (t > p->wall && isfinite(p->wall)) p->broken = p->lasting;
    if (t > p->wall || p->broken) return false;
    memset(rate, 0, N * sizeof *rate);
    for (int k = 0; k < N; k++) {
        double z = rates[k] * (cos(t) - mode(y, k));
        for (int i = 0; i < N; i++) rate[i] += columns[k][i] * z;
    }
    return true;
}

static bool linearise(void *self, double t, const double *y) {
    (void)y;
    problem *p = self;
    p->linearisations++;
    return t <= p->wall;
}

static bool factor(void *self, double gamma) {
    problem *p = self;
    p->factorisations++;
    if (p->singular) return false;
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            p->factor[N * j + i] = i == j;
            for (int k = 0; k < N; k++) {
                p->factor[N * j + i] += gamma * rates[k] * columns[k][i] * columns[k][j];
            }
        }
    }
    return bough_dense_factor(N, p->factor, p->pivot);
}

static void solve(void *self, double *x) {
    problem *p = self;
    p->solutions++;
    bough_dense_solve(N, 1, p->factor, p->pivot, x);
}

static const double first[N] = {0.5, -1, 2}; // initial values of the modes

static double exact_mode(double lambda, double start, double t) {
    double square = lambda * lambda + 1, c = lambda * lambda / square, s = lambda / square;
    return c * cos(t) + s * sin(t) + (start - c) * exp(-lambda * t);
}

static void exact(double t, double *y) {
    memset(y, 0, N * sizeof *y);
    for (int k = 0; k < N; k++) {
        for (int i = 0; i < N; i++) y[i] += columns[k][i] * exact_mode(rates[k], first[k], t);
    }
}

// The system under a sub-solver; scale (N) must outlive it.
static problem *create_scaled(bough_integrator_kind kind, const double *scale, double rtol) {
    problem *p = calloc(1, sizeof *p);
    assert_non_null(p);
    p->arena = bough_arena_create();
    p->wall = (double)INFINITY;
    bough_ode ode = {"stiff", N, scale, p, derivative, NULL, linearise, factor, solve, 0};
    bough_integrator_options options = {.kind = kind, .rtol = rtol};
    check_ok(bough_integrator_create(p->arena, &ode, &options, &p->micro));
    return p;
}

static problem *create_kind(bough_integrator_kind kind, double rtol) {
    static const double scale[N] = {1, 1, 1};
    return create_scaled(kind, scale, rtol);
}

static void destroy(problem *p) {
    bough_arena_destroy(p->arena);
    free(p);
}

static bough_status try_advance(problem *p, double t, double t1, bool restart, double *y) {
    return integrator_advance(&p->micro, t, t1, restart, y);
}

static void advance(problem *p, double t, double t1, bool restart, double *y) {
    check_ok(try_advance(p, t, t1, restart, y));
}

static void add_counts(const problem *p, bough_statistics *sum) {
    p->micro.ops->statistics(p->micro.self, sum);
}

static bough_statistics counts(const problem *p) {
    bough_statistics sum = {0};
    add_counts(p, &sum);
    return sum;
}

static double error_at(const double *y, double t) {
    double expected[N], largest = 0;
    exact(t, expected);
    for (int i = 0; i < N; i++) largest = fmax(largest, fabs(y[i] - expected[i]));
    return largest;
}

// -- what every sub-solver must hold; the test says which it is -----------------------------------

static problem *create(double rtol);
static const char *solver(void); // as its messages name it

// From a state that was changed outside, as the exact solution of the same modes started there.
TEST(restart_takes_up_a_changed_state) {
    problem *p = create(1e-7);
    double y[N], moved[N];
    exact(0, y);
    advance(p, 0, 0.4, false, y); // the first call starts in any case
    exact(0, moved);
    advance(p, 0, 0.4, true, moved);
    for (int i = 0; i < N; i++) check_near(moved[i], y[i], 0, 0);
    assert_int_equal(counts(p).starts, 2);
    exact(3, y);
    advance(p, 3, 3.7, true, y);
    assert_true(error_at(y, 3.7) < 3e-6);
    destroy(p);
}

static void check_failure(const bough_status *status, const char *time, const char *why) {
    assert_int_equal(status->code, BOUGH_FAILED);
    const char *parts[] = {"stiff", solver(), time, why};
    for (int k = 0; k < 4; k++) {
        if (strstr(status->message, parts[k]) == NULL) {
            fail_msg("\"%s\" does not name \"%s\"", status->message, parts[k]);
        }
    }
}

TEST(failure_names_body_time_and_solver) {
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

TEST(statistics_add_up_over_restarts) {
    problem *p = create(1e-6);
    double y[N];
    bough_statistics sum = counts(p);
    assert_int_equal(sum.steps + sum.derivatives + sum.starts, 0);
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
    assert_int_equal(sum.starts, 3);
    bough_statistics twice = sum; // counts are added to what is there
    add_counts(p, &twice);
    assert_int_equal(twice.steps, 2 * sum.steps);
    assert_int_equal(twice.failed_steps, 2 * sum.failed_steps);
    assert_int_equal(twice.starts, 6);
    destroy(p);
}

#endif

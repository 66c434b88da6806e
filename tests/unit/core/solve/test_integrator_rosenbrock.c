// The Rosenbrock method on a damped oscillator beside a stiff mode and a nonlinear equation, forced,
// with a known solution.
#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

#include "core/solve/integrator.h"

#include <string.h>

// y = (position, speed, stiff, decay): ẍ + 2ζωẋ + ω²x = ω² sin t, ż = −λ(z − cos t) − sin t,
// ẇ = −w².
static const double omega = 12, zeta = 0.02, lambda = 4e4;
enum { N = 4 };

typedef struct problem {
    bough_integrator micro;
    double gamma, tangent[N];
    double skew; // factor of the stiffness that the tangents know
    double wall; // f has no value beyond [s]
} problem;

static bool derivative(void *self, double t, const double *y, double *rate) {
    const problem *p = self;
    rate[0] = y[1];
    rate[1] = omega * omega * (sin(t) - y[0]) - 2 * zeta * omega * y[1];
    rate[2] = -lambda * (y[2] - cos(t)) - sin(t);
    rate[3] = -y[3] * y[3];
    return !(t > p->wall);
}

static bool linearise(void *self, double t, const double *y) {
    problem *p = self;
    (void)t;
    memcpy(p->tangent, y, sizeof p->tangent);
    return true;
}

static bool factor(void *self, double gamma) {
    problem *p = self;
    p->gamma = gamma;
    return true;
}

// (I − γJ) x = b, by Cramer's rule for the oscillator
static void solve(void *self, double *x) {
    const problem *p = self;
    double g = p->gamma, a = 1 + 2 * zeta * omega * g, b = p->skew * omega * omega * g;
    double determinant = a + g * b, first = x[0];
    x[0] = (a * first + g * x[1]) / determinant;
    x[1] = (x[1] - b * first) / determinant;
    x[2] /= 1 + lambda * g;
    x[3] /= 1 + 2 * p->skew * g * p->tangent[3];
}

static double steady(double t, double *speed) {
    double stiff = omega * omega - 1, damped = 2 * zeta * omega;
    double scale = omega * omega / (stiff * stiff + damped * damped);
    *speed = scale * (stiff * cos(t) + damped * sin(t));
    return scale * (stiff * sin(t) - damped * cos(t));
}

static void exact(double t, double *y) {
    y[0] = steady(t, &y[1]);
    y[2] = cos(t);
    y[3] = 1 / (1 + t);
}

static bough_arena *build(problem *p, double step, double rtol) {
    static const double scale[N] = {1, 1, 1, 1};
    bough_arena *arena = bough_arena_create();
    bough_ode ode = {"sample", N, scale, p, derivative, NULL, linearise, factor, solve, 0};
    bough_integrator_options options = {BOUGH_ROSENBROCK, rtol, step, 0, 0, false};
    check_ok(bough_integrator_create(arena, &ode, &options, &p->micro));
    return arena;
}

static double distance(const double *y, double t) {
    double expected[N], largest = 0;
    exact(t, expected);
    for (int k = 0; k < N; k++) largest = fmax(largest, fabs(y[k] - expected[k]));
    return largest;
}

static double error_with(double step, double rtol, double skew, long *steps) {
    problem p = {.skew = skew, .wall = (double)INFINITY};
    double y[N];
    bough_arena *arena = build(&p, step, rtol);
    exact(0, y);
    for (int k = 0; k < 10; k++) {
        check_ok(integrator_advance(&p.micro, 0.2 * k, 0.2 * (k + 1), false, y));
    }
    bough_statistics sum = {0};
    p.micro.ops->statistics(p.micro.self, &sum);
    if (steps != NULL) *steps = sum.steps;
    bough_arena_destroy(arena);
    return distance(y, 2);
}

// Exact tangents or half of them.
TEST(order_is_three_whatever_the_tangents) {
    for (double skew = 1; skew > 0.4; skew -= 0.5) {
        double coarse = error_with(0.01, 1, skew, NULL), fine = error_with(0.005, 1, skew, NULL);
        assert_true(coarse < 1e-4);
        check_near(log2(coarse / fine), 3, 0, 0.2);
    }
}

TEST(error_follows_the_tolerance) {
    long before = 0;
    for (double rtol = 1e-2; rtol > 1e-9; rtol *= 0.1) {
        long steps;
        assert_true(error_with(1, rtol, 1, &steps) < 20 * rtol);
        assert_true(steps >= before);
        before = steps;
    }
    assert_true(before > 100);
}

// A mode far above the step's reach is gone after a few steps.
TEST(stiff_mode_is_forgotten) {
    problem p = {.skew = 1, .wall = (double)INFINITY};
    double y[N];
    bough_arena *arena = build(&p, 0.01, 1e3);
    exact(0, y);
    y[2] += 1;
    integrator_advance(&p.micro, 0, 0.1, false, y);
    assert_true(distance(y, 0.1) < 1e-4);
    bough_arena_destroy(arena);
}

TEST(a_restart_gives_the_same_bits) {
    problem p = {.skew = 1, .wall = (double)INFINITY};
    double once[N], twice[N];
    bough_arena *arena = build(&p, 0.05, 1e-5);
    exact(0, once);
    integrator_advance(&p.micro, 0, 0.7, true, once);
    exact(0, twice);
    integrator_advance(&p.micro, 0, 0.7, true, twice);
    assert_memory_equal(once, twice, sizeof once);
    bough_arena_destroy(arena);
}

TEST(a_pause_changes_no_bit) {
    problem p = {.skew = 1, .wall = (double)INFINITY};
    double once[N], twice[N], t = 0;
    bough_arena *arena = build(&p, 0.05, 1e-5);
    exact(0, once);
    integrator_advance(&p.micro, 0, 0.7, true, once);
    exact(0, twice);
    p.micro.ops->advance(p.micro.self, &t, 0.33, 0.7, true, twice);
    assert_true(t >= 0.33 && t < 0.4);
    integrator_advance(&p.micro, t, 0.7, false, twice);
    assert_memory_equal(once, twice, sizeof once);
    bough_arena_destroy(arena);
}

TEST(what_has_no_value_ends_with_a_diagnosis) {
    problem p = {.skew = 1, .wall = (double)INFINITY};
    double y[N];
    bough_arena *arena = build(&p, 0.01, 1e-3);
    exact(0, y);
    integrator_advance(&p.micro, 0, 0.1, false, y);
    p.wall = 0.125;
    bough_status status = integrator_advance(&p.micro, 0.1, 0.2, false, y);
    check_fails(status, BOUGH_FAILED, "sample");
    if (strstr(status.message, "0.125 s") == NULL) fail_msg("%s", status.message);
    bough_arena_destroy(arena);
}

// Generalised-α on a damped oscillator beside a stiff mode, forced, with a known solution.
#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

#include "core/solve/integrator.h"

#include <string.h>

// y = (position, speed, stiff): ẍ + 2ζωẋ + ω²x = ω² sin t and ż = −λ(z − cos t).
static const double omega = 12, zeta = 0.02, lambda = 4e4;

typedef struct problem {
    bough_integrator micro;
    double gamma;
    bool broken; // f has no value
    long linearisations;
} problem;

static bool derivative(void *self, double t, const double *y, double *rate) {
    const problem *p = self;
    rate[0] = y[1];
    rate[1] = omega * omega * (sin(t) - y[0]) - 2 * zeta * omega * y[1];
    rate[2] = -lambda * (y[2] - cos(t));
    return !p->broken;
}

static bool linearise(void *self, double t, const double *y) {
    problem *p = self;
    (void)t, (void)y;
    p->linearisations++;
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
    double g = p->gamma, a = 1 + 2 * zeta * omega * g, b = omega * omega * g;
    double determinant = a + g * b, first = x[0];
    x[0] = (a * first + g * x[1]) / determinant;
    x[1] = (x[1] - b * first) / determinant;
    x[2] /= 1 + lambda * g;
}

// The steady motion from initial values on it.
static double steady(double t, double *speed) {
    double stiff = omega * omega - 1, damped = 2 * zeta * omega;
    double scale = omega * omega / (stiff * stiff + damped * damped);
    *speed = scale * (stiff * cos(t) + damped * sin(t));
    return scale * (stiff * sin(t) - damped * cos(t));
}

static void start(double *y) {
    y[0] = steady(0, &y[1]);
    y[2] = 1;
}

static bough_arena *build(problem *p, double step, double rho) {
    static const double scale[3] = {1, 1, 1};
    bough_arena *arena = bough_arena_create();
    bough_ode ode = {"sample", 3, scale, p, derivative, NULL, linearise, factor, solve, 0};
    bough_integrator_options options = {BOUGH_GENERALIZED_ALPHA, 1e-10, step, rho, 0, false};
    check_ok(bough_integrator_create(arena, &ode, &options, &p->micro));
    return arena;
}

static double error_with(double step, double rho) {
    problem p = {0};
    double y[3], speed;
    bough_arena *arena = build(&p, step, rho);
    start(y);
    for (int k = 0; k < 10; k++) {
        check_ok(integrator_advance(&p.micro, 0.2 * k, 0.2 * (k + 1), false, y));
    }
    assert_true(fabs(y[2] - cos(2.0)) < 1e-3); // the stiff mode neither rings nor lags
    double error = fabs(y[0] - steady(2, &speed));
    assert_int_equal(p.linearisations, 1); // equal steps share one factorisation
    bough_arena_destroy(arena);
    return error;
}

TEST(order_is_two_for_any_damping) {
    for (double rho = 0; rho <= 1; rho += 0.4) {
        double coarse = error_with(0.01, rho), fine = error_with(0.005, rho);
        check_near(coarse / fine, 4, 0.15, 0);
    }
}

// A mode far above the step's reach is damped by ρ∞ each step.
TEST(highest_frequencies_are_damped_as_asked) {
    problem p = {0};
    double y[3];
    bough_arena *arena = build(&p, 0.01, 0.5);
    start(y);
    y[2] = 2; // off the solution by one
    integrator_advance(&p.micro, 0, 0.2, false, y);
    double left = fabs(y[2] - cos(0.2));
    assert_true(left < pow(0.55, 19) * 30 + 1e-4);
    assert_true(isfinite(left));
    bough_arena_destroy(arena);
}

TEST(what_has_no_value_ends_with_a_diagnosis) {
    problem p = {0};
    double y[3];
    bough_arena *arena = build(&p, 0.01, 0.8);
    start(y);
    integrator_advance(&p.micro, 0, 0.1, false, y);
    p.broken = true;
    bough_status status = integrator_advance(&p.micro, 0.1, 0.2, false, y);
    check_fails(status, BOUGH_FAILED, "sample");
    assert_non_null(strstr(status.message, "0.1 s"));
    bough_arena_destroy(arena);
}

TEST(counts_its_work) {
    problem p = {0};
    double y[3];
    bough_statistics sum = {0};
    bough_arena *arena = build(&p, 0.01, 0.8);
    start(y);
    integrator_advance(&p.micro, 0, 0.1, false, y);
    integrator_advance(&p.micro, 0.1, 0.2, true, y);
    p.micro.ops->statistics(p.micro.self, &sum);
    assert_int_equal(sum.steps, 20);
    assert_int_equal(sum.starts, 2);
    assert_int_equal(sum.failed_steps, 0);
    bough_arena_destroy(arena);
}

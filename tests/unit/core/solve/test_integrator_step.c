// The methods of given steps on a damped oscillator beside a stiff mode and a nonlinear equation, forced,
// with a known solution: orders as rows of a table.
#include "core/solve/integrator.h"

#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

// y = (position, speed, stiff, decay): ẍ + 2ζωẋ + ω²x = ω² sin t, ż = −λ(z − cos t) − sin t, ẇ = −w².
static const double omega = 12, zeta = 0.02, lambda = 4e4;
enum { N = 4, LINEAR = 3 };

typedef struct method {
    bough_integrator_kind kind;
    int n;         // equations
    double rho;    // of generalised-α
    double known;  // part of the stiffness that the tangents know
    double order;  // of the error
    double linear; // linearisations of equal steps, at most
    int measured;  // components of y whose error is measured
} method;

static const method methods[] = {
    {BOUGH_ROSENBROCK, N, 0, 1, 3, INFINITY, N},        {BOUGH_ROSENBROCK, N, 0, 0.5, 3, INFINITY, N},
    {BOUGH_GENERALIZED_ALPHA, LINEAR, 0, 1, 2, 1, 1},   {BOUGH_GENERALIZED_ALPHA, LINEAR, 0.4, 1, 2, 1, 1},
    {BOUGH_GENERALIZED_ALPHA, LINEAR, 0.8, 1, 2, 1, 1},
};

typedef struct problem {
    bough_arena *arena;
    bough_integrator micro;
    method m;
    double gamma, decay;
    long linearisations;
    bool broken; // f has no value
} problem;

static bool derivative(void *self, double t, const double *y, double *rate) {
    const problem *p = self;
    rate[0] = y[1];
    rate[1] = omega * omega * (sin(t) - y[0]) - 2 * zeta * omega * y[1];
    rate[2] = -lambda * (y[2] - cos(t)) - sin(t);
    if (p->m.n > LINEAR) rate[3] = -y[3] * y[3];
    return !p->broken;
}

static bool linearise(void *self, double t, const double *y) {
    problem *p = self;
    (void)t;
    p->linearisations++;
    if (p->m.n > LINEAR) p->decay = y[3];
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
    double g = p->gamma, a = 1 + 2 * zeta * omega * g, b = p->m.known * omega * omega * g;
    double determinant = a + g * b, first = x[0];
    x[0] = (a * first + g * x[1]) / determinant;
    x[1] = (x[1] - b * first) / determinant;
    x[2] /= 1 + lambda * g;
    if (p->m.n > LINEAR) x[3] /= 1 + 2 * p->m.known * g * p->decay;
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

// The problem at its initial values y.
static void build(problem *p, method m, double step, double *y) {
    static const double scale[N] = {1, 1, 1, 1};
    *p = (problem){.arena = check_memory(), .m = m};
    bough_ode ode = {"sample", m.n, scale, p, derivative, NULL, linearise, NULL, factor, solve, 0};
    // Newton's method of generalised-α to rounding; the Rosenbrock method takes all steps that it is given
    bough_integrator_options options = {
        .kind = m.kind, .rtol = m.n > LINEAR ? 1e3 : 1e-10, .step = step, .rho = m.rho};
    check_ok(bough_integrator_create(p->arena, &ode, &options, &p->micro));
    exact(0, y);
}

static double distance(const problem *p, const double *y, double t) {
    double expected[N], largest = 0;
    exact(t, expected);
    for (int k = 0; k < p->m.measured; k++) largest = fmax(largest, fabs(y[k] - expected[k]));
    return largest;
}

static double error_with(method m, double step) {
    problem p;
    double y[N];
    build(&p, m, step, y);
    for (int k = 0; k < 10; k++) check_ok(integrator_advance(&p.micro, 0.2 * k, 0.2 * (k + 1), false, y));
    assert_true(fabs(y[2] - cos(2)) < 1e-3); // the stiff mode neither rings nor lags
    assert_true((double)p.linearisations <= m.linear);
    bough_arena_destroy(p.arena);
    return distance(&p, y, 2);
}

TEST(errors_fall_with_the_order_of_the_method) {
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        double coarse = error_with(methods[k], 0.01), fine = error_with(methods[k], 0.005);
        assert_true(coarse < (methods[k].order > 2 ? 1e-4 : 1));
        check_near(log2(coarse / fine), methods[k].order, 0, 0.2);
    }
}

// A mode far above the step's reach is gone after a few steps of the Rosenbrock method, and damped by ρ∞ in
// each of generalised-α.
TEST(highest_frequencies_are_damped_as_asked) {
    const method alpha = {BOUGH_GENERALIZED_ALPHA, LINEAR, 0.5, 1, 2, 1, 1};
    const method *const rows[] = {&methods[0], &alpha};
    const double most[] = {1e-4, 3e-4};
    for (int k = 0; k < 2; k++) {
        problem p;
        double y[N];
        build(&p, *rows[k], 0.01, y);
        y[2] += 1;
        check_ok(integrator_advance(&p.micro, 0, 0.2, false, y));
        assert_true(fabs(y[2] - cos(0.2)) <= most[k]);
        bough_arena_destroy(p.arena);
    }
}

TEST(what_has_no_value_ends_with_a_diagnosis) {
    problem p;
    double y[N];
    build(&p, methods[4], 0.01, y);
    check_ok(integrator_advance(&p.micro, 0, 0.1, false, y));
    p.broken = true;
    bough_status status = integrator_advance(&p.micro, 0.1, 0.2, false, y);
    check_fails(status, BOUGH_FAILED, "sample");
    check_fails(status, BOUGH_FAILED, "0.1 s");
}

TEST(steps_and_starts_are_counted) {
    problem p;
    double y[N];
    bough_statistics sum = {0};
    build(&p, methods[4], 0.01, y);
    check_ok(integrator_advance(&p.micro, 0, 0.1, false, y));
    check_ok(integrator_advance(&p.micro, 0.1, 0.2, true, y));
    p.micro.ops->statistics(p.micro.self, &sum);
    assert_int_equal(sum.steps, 20);
    assert_int_equal(sum.starts, 2);
    assert_int_equal(sum.failed_steps, 0);
}

// After an hour, times and their differences are rounded to 5e-13 s.
TEST(steps_stay_equal_late_in_a_run) {
    const size_t rows[] = {0, 4};
    for (int k = 0; k < 2; k++) {
        problem p;
        double y[N];
        bough_statistics sum = {0};
        build(&p, methods[rows[k]], 0.02, y);
        exact(3600, y);
        for (int i = 0; i < 100; i++) {
            check_ok(integrator_advance(&p.micro, 3600 + 0.04 * i, 3600 + 0.04 * (i + 1), false, y));
        }
        p.micro.ops->statistics(p.micro.self, &sum);
        assert_int_equal(sum.steps, 200);
        assert_int_equal(sum.factorisations, sum.jacobians);
        bough_arena_destroy(p.arena);
    }
}

// -- the age of tangents --------------------------------------------------------------------------

// A mass on an undamped spring, 1000 rad/s along its axis, whose length follows 1 + sin(t)/10: y = (x, ẋ) in
// the plane. Its tangents change as it turns about the origin.
typedef struct spring {
    double gamma, tangent[2][2]; // ∂ẍ/∂x
    double inverse[2][2];        // of 1 − γ² ∂ẍ/∂x
} spring;

static const double stiffness = 1e6; // over the mass [1/s²]

static double stretch(double t, const double *y) { return 1 - (1 + 0.1 * sin(t)) / hypot(y[0], y[1]); }

static bool spring_derivative(void *self, double t, const double *y, double *rate) {
    (void)self;
    for (int i = 0; i < 2; i++) rate[i] = y[2 + i], rate[2 + i] = -stiffness * stretch(t, y) * y[i];
    return true;
}

static bool spring_linearise(void *self, double t, const double *y) {
    spring *p = self;
    double square = y[0] * y[0] + y[1] * y[1], e = stretch(t, y);
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            p->tangent[i][j] = -stiffness * (e * (i == j) + (1 - e) * y[i] * y[j] / square);
    return true;
}

static bool spring_factor(void *self, double gamma) {
    spring *p = self;
    double a = 1 - gamma * gamma * p->tangent[0][0], b = -gamma * gamma * p->tangent[0][1];
    double d = 1 - gamma * gamma * p->tangent[1][1], determinant = a * d - b * b;
    p->gamma = gamma;
    p->inverse[0][0] = d / determinant, p->inverse[1][1] = a / determinant;
    p->inverse[0][1] = p->inverse[1][0] = -b / determinant;
    return true;
}

static void spring_solve(void *self, double *x) {
    const spring *p = self;
    double b[2] = {x[0] + p->gamma * x[2], x[1] + p->gamma * x[3]};
    for (int i = 0; i < 2; i++) x[i] = p->inverse[i][0] * b[0] + p->inverse[i][1] * b[1];
    for (int i = 0; i < 2; i++) x[2 + i] += p->gamma * (p->tangent[i][0] * x[0] + p->tangent[i][1] * x[1]);
}

// Steps for each linearisation in one second of steps of 10 ms.
static double age_of_tangents(const bough_integrator *micro, double t, double *y) {
    bough_statistics before = {0}, after = {0};
    micro->ops->statistics(micro->self, &before);
    check_ok(integrator_advance(micro, t, t + 1, false, y));
    micro->ops->statistics(micro->self, &after);
    return (double)(after.steps - before.steps) / (double)(after.jacobians - before.jacobians);
}

static bool forced_derivative(void *self, double t, const double *y, double *rate) {
    (void)self;
    rate[0] = sin(50 * t) - y[0];
    return true;
}

static bool forced_linearise(void *self, double t, const double *y) {
    (void)self, (void)t, (void)y;
    return true;
}

static bool forced_factor(void *self, double gamma) {
    *(double *)self = 1 + gamma;
    return true;
}

static void forced_solve(void *self, double *x) { *x /= *(double *)self; }

// The error of a linear system's steps grows and falls with its force, by which its tangents are no older.
TEST(tangents_are_kept_where_the_motion_changes_the_error) {
    static const double scale[1] = {1};
    double divisor, y[1] = {0};
    bough_arena *arena = check_memory();
    bough_ode ode = {
        "lag",        1, scale, &divisor, forced_derivative, NULL, forced_linearise, NULL, forced_factor,
        forced_solve, 1};
    bough_integrator_options options = {.kind = BOUGH_ROSENBROCK, .rtol = 1e-3, .step = 0.01};
    bough_integrator micro;
    check_ok(bough_integrator_create(arena, &ode, &options, &micro));
    age_of_tangents(&micro, 0, y);
    double age = 0;
    for (int i = 1; i < 5; i++) age += age_of_tangents(&micro, i, y) / 4;
    bough_statistics sum = {0};
    micro.ops->statistics(micro.self, &sum);
    print_message("%g steps for each linearisation, %ld failed\n", age, sum.failed_steps);
    assert_int_equal(sum.failed_steps, 0);
    assert_true(age > 14);
    bough_arena_destroy(arena);
}

// Without damping, tangents are kept as long as they hardly change, and no longer once they do.
TEST(undamped_systems_keep_tangents_that_hardly_change) {
    static const double scale[4] = {1, 1, 1, 1};
    for (int coarse = 0; coarse < 2; coarse++) {
        spring p;
        bough_arena *arena = check_memory();
        bough_ode ode = {"spring",         4,    scale,         &p,           spring_derivative, NULL,
                         spring_linearise, NULL, spring_factor, spring_solve, INFINITY};
        bough_integrator_options options = {
            .kind = BOUGH_ROSENBROCK, .rtol = 1e3, .step = 0.01, .coarse = coarse};
        bough_integrator micro;
        double y[4] = {1, 0, 0.1, 0};
        check_ok(bough_integrator_create(arena, &ode, &options, &micro));
        age_of_tangents(&micro, 0, y);
        age_of_tangents(&micro, 1, y);
        double straight = age_of_tangents(&micro, 2, y);
        y[3] = 2 * y[0];
        double turning = age_of_tangents(&micro, 3, y);
        print_message("%g steps for each linearisation, %g turning at 2 rad/s\n", straight, turning);
        assert_true(straight > (coarse ? 8 : 15));
        assert_true(turning < 4);
        bough_arena_destroy(arena);
    }
}

// The method of scenes that name none, on oscillators with known motion: a slow one stays with the
// Rosenbrock method, an undamped fast one is left to IDA, one that is too fast ends with its reason.
#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

enum { N = 2, MANY = 4000 };

typedef struct oscillator {
    int n;        // states of equal ones
    double omega; // [1/s]
    double gamma;
} oscillator;

static bool derivative(void *self, double t, const double *y, double *rate) {
    const oscillator *o = self;
    (void)t;
    for (int k = 0; k < o->n; k += N) {
        rate[k] = o->omega * y[k + 1];
        rate[k + 1] = -o->omega * y[k];
    }
    return true;
}

static bool linearise(void *self, double t, const double *y) {
    (void)self, (void)t, (void)y;
    return true;
}

static bool factor(void *self, double gamma) {
    oscillator *o = self;
    o->gamma = gamma;
    return true;
}

static void solve(void *self, double *x) {
    const oscillator *o = self;
    double g = o->gamma * o->omega;
    for (int k = 0; k < o->n; k += N) {
        double x0 = x[k];
        x[k] = (x0 + g * x[k + 1]) / (1 + g * g);
        x[k + 1] = (x[k + 1] - g * x0) / (1 + g * g);
    }
}

typedef struct outcome {
    bough_status status;
    double error; // of the motion at the end
    bough_statistics work;
} outcome;

// n states, `count` macro steps [s] from (0, 1).
static outcome run_of(int n, const bough_integrator_options *options, double omega, int count, double macro) {
    check_arena(arena);
    double *y = bough_arena_doubles(arena, (size_t)n), *scale = bough_arena_doubles(arena, (size_t)n);
    for (int k = 0; k < n; k++) y[k] = k % N, scale[k] = 1;
    oscillator o = {.n = n, .omega = omega};
    bough_ode ode = {.name = "oscillator",
                     .n = n,
                     .scale = scale,
                     .self = &o,
                     .derivative = derivative,
                     .linearise = linearise,
                     .factor = factor,
                     .solve = solve};
    bough_integrator method;
    outcome r = {.status = bough_integrator_create(arena, &ode, options, &method)};
    assert_int_equal(r.status.code, BOUGH_OK);
    for (int k = 0; k < count && bough_is_ok(&r.status); k++) {
        r.status = integrator_advance(&method, k * macro, (k + 1) * macro, k == 0, y);
    }
    r.error = hypot(y[0] - sin(omega * count * macro), y[1] - cos(omega * count * macro));
    method.ops->statistics(method.self, &r.work);
    return r;
}

static outcome run_with(const bough_integrator_options *options, double omega, int count, double macro) {
    return run_of(N, options, omega, count, macro);
}

static outcome run_for(bough_integrator_kind kind, double omega, int count, double macro) {
    return run_with(&(bough_integrator_options){.kind = kind, .rtol = 1e-5}, omega, count, macro);
}

static outcome run(bough_integrator_kind kind, double omega, int count) {
    return run_for(kind, omega, count, 0.01);
}

TEST(slow_motion_is_the_rosenbrock_methods) {
    outcome own = run(BOUGH_AUTOMATIC, 20, 50), rosenbrock = run(BOUGH_ROSENBROCK, 20, 50);
    assert_int_equal(own.status.code, BOUGH_OK);
    assert_true(own.error == rosenbrock.error && own.error < 1e-3);
    assert_int_equal(own.work.steps, rosenbrock.work.steps);
    assert_int_equal(own.work.iterations, 0);
}

// 4 kHz, 400 periods.
TEST(fast_vibrations_take_a_fifth_of_the_evaluations) {
    outcome own = run(BOUGH_AUTOMATIC, 25000, 10), rosenbrock = run(BOUGH_ROSENBROCK, 25000, 10);
    print_message("evaluations %ld, %ld; errors %.2e, %.2e\n", own.work.derivatives,
                  rosenbrock.work.derivatives, own.error, rosenbrock.error);
    assert_int_equal(own.status.code, BOUGH_OK);
    assert_true(own.work.iterations > 0);
    assert_true(own.work.derivatives < rosenbrock.work.derivatives / 5);
    assert_true(own.error < rosenbrock.error);
}

// 5 kHz in macro steps of 1 ms, of which none takes the Rosenbrock method more than some hundred steps.
TEST(short_macro_steps_leave_fast_vibrations_to_ida) {
    outcome own = run_for(BOUGH_AUTOMATIC, 30000, 100, 1e-3),
            rosenbrock = run_for(BOUGH_ROSENBROCK, 30000, 100, 1e-3);
    print_message("evaluations %ld, %ld; errors %.2e, %.2e\n", own.work.derivatives,
                  rosenbrock.work.derivatives, own.error, rosenbrock.error);
    assert_int_equal(own.status.code, BOUGH_OK);
    assert_true(own.work.derivatives < rosenbrock.work.derivatives / 3);
    assert_true(own.error < rosenbrock.error);
}

// Beside a tenth of the tolerance: less than half the work where the vibration is small, and not lost where
// it is large.
TEST(a_coarse_solution_has_order_2_where_vibrations_are_small) {
    static const double rtol[2] = {2e-3, 2e-4};
    for (int k = 0; k < 2; k++) {
        outcome coarse =
            run_with(&(bough_integrator_options){.kind = BOUGH_AUTOMATIC, .rtol = rtol[k], .coarse = true},
                     25000, 50, 0.01);
        outcome fine = run_with(&(bough_integrator_options){.kind = BOUGH_AUTOMATIC, .rtol = rtol[k] / 10},
                                25000, 50, 0.01);
        print_message("evaluations %ld, %ld; errors %.2e, %.2e\n", coarse.work.derivatives,
                      fine.work.derivatives, coarse.error, fine.error);
        assert_true(coarse.work.derivatives < (k == 0 ? 0.5 : 0.9) * (double)fine.work.derivatives);
        assert_true(k == 0 || coarse.error < 0.5);
    }
}

// So many states allow IDA 5000 steps.
TEST(what_ida_cannot_follow_is_the_rosenbrock_methods) {
    static const bough_integrator_options o = {.kind = BOUGH_AUTOMATIC, .rtol = 5e-4};
    outcome own = run_of(MANY, &o, 1e5, 2, 0.01);
    assert_int_equal(own.status.code, BOUGH_OK);
    assert_true(own.work.iterations > 0);
}

// CVODE takes half the evaluations of slow motion; of fast vibrations it would take many steps.
TEST(beside_bdf_a_coarse_solution_begins_with_cvode) {
    for (int k = 0; k < 2; k++) {
        bough_integrator_options options = {.kind = BOUGH_AUTOMATIC, .rtol = 1e-5, .coarse = true};
        outcome usual = run_with(&options, k ? 25000 : 20, 50, 0.01);
        options.by_bdf = true;
        outcome own = run_with(&options, k ? 25000 : 20, 50, 0.01);
        print_message("evaluations %ld, %ld; errors %.2e, %.2e\n", own.work.derivatives,
                      usual.work.derivatives, own.error, usual.error);
        assert_true((double)own.work.derivatives < (k ? 1.1 : 0.5) * (double)usual.work.derivatives);
        assert_true(own.error < 2 * usual.error);
    }
}

TEST(what_nobody_would_wait_for_ends_with_its_reason) {
    outcome own = run(BOUGH_AUTOMATIC, 3e6, 10);
    assert_int_equal(own.status.code, BOUGH_FAILED);
    assert_non_null(strstr(own.status.message, "oscillator"));
    assert_non_null(strstr(own.status.message, "because the vibrations are so fast"));
    assert_true(own.work.steps < 75000);
}

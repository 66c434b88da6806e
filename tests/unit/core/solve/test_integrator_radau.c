// The Radau master on equations with exact solutions and known orders.
#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

enum { MOST = 4 };
static const double unit[MOST] = {1, 1, 1, 1};
static const double wild[MOST] = {1, 1e4, 1, 1}; // van der Pol's speeds reach 1e6

typedef struct problem {
    double stiffness;
    int n;
    bool (*f)(struct problem *, double t, const double *y, double *rate);
} problem;

static bool derivative(void *self, double t, const double *y, double *rate) {
    problem *p = self;
    return p->f(p, t, y, rate);
}

// -- problems --------------------------------------------------------------------------------

// The pendulum of length 1 in g = 9.81.
static bool pendulum(problem *p, double t, const double *y, double *rate) {
    (void)p, (void)t;
    rate[0] = y[1];
    rate[1] = -9.81 * sin(y[0]);
    return true;
}

// Prothero and Robinson: ẏ = −λ (y − sin t) + cos t, y = sin t.
static bool prothero(problem *p, double t, const double *y, double *rate) {
    rate[0] = -p->stiffness * (y[0] - sin(t)) + cos(t);
    return true;
}

// Van der Pol: ẏ = (y1, k ((1 − y0²) y1 − y0)).
static bool van_der_pol(problem *p, double t, const double *y, double *rate) {
    (void)t;
    rate[0] = y[1];
    rate[1] = p->stiffness * ((1 - y[0] * y[0]) * y[1] - y[0]);
    return true;
}

static problem make(int n, bool (*f)(problem *, double, const double *, double *), double stiffness) {
    return (problem){.n = n, .f = f, .stiffness = stiffness};
}

static bough_integrator create(bough_arena *arena, problem *p, double rtol) {
    const double *scale = p->f == van_der_pol ? wild : unit;
    bough_ode ode = {.name = "test", .n = p->n, .scale = scale, .self = p, .derivative = derivative};
    bough_integrator_options options = {.kind = BOUGH_RADAU5, .rtol = rtol};
    bough_integrator radau;
    check_ok(bough_integrator_create(arena, &ode, &options, &radau));
    return radau;
}

static void advance(const bough_integrator *radau, double from, double to, double *y) {
    check_ok(integrator_advance(radau, from, to, false, y));
}

typedef struct result {
    double y[MOST];
    bough_statistics count;
} result;

// From y0 to t1 in equal calls.
static result run(problem p, double rtol, const double *y0, double t1, int calls) {
    result r = {{0}, {0}};
    check_arena(arena);
    bough_integrator radau = create(arena, &p, rtol);
    memcpy(r.y, y0, (size_t)p.n * sizeof *y0);
    for (int k = 1; k <= calls; k++) advance(&radau, (k - 1) * t1 / calls, k * t1 / calls, r.y);
    radau.ops->statistics(radau.self, &r.count);
    return r;
}

// -- orders and tolerances -------------------------------------------------------------------

// Half a period, 2 K(sin²(y0/2))/√9.81, takes the pendulum from y0 to −y0.
static double half_period(double y0) {
    double a = 1, b = cos(0.5 * y0);
    while (fabs(a - b) > 1e-15) {
        double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return acos(-1.0) / (a * sqrt(9.81));
}

TEST(error_follows_the_tolerance_at_order_five) {
    problem p = make(2, pendulum, 0);
    const double y0[MOST] = {2, 0};
    double error[4], steps[4];
    for (int k = 0; k < 4; k++) {
        double rtol = pow(10, -4 - 2 * k);
        result r = run(p, rtol, y0, half_period(2), 1);
        error[k] = hypot(r.y[0] + 2, r.y[1]);
        steps[k] = (double)r.count.steps;
        check_near(error[k], 0, 0, 10 * rtol);
    }
    check_near(log(error[0] / error[3]) / log(steps[3] / steps[0]), 5, 0, 0.4);
}

// Order 5 falls to 3 where the problem is stiff, and the error is proportional to 1/λ.
TEST(stiff_error_falls_with_order_three) {
    problem p = make(1, prothero, 1e5), stiffer = p;
    stiffer.stiffness = 1e6;
    const double y0[MOST] = {0};
    double coarse = fabs(run(p, 1e-2, y0, 1, 10).y[0] - sin(1));
    double fine = fabs(run(p, 1e-2, y0, 1, 20).y[0] - sin(1));
    double stiff = fabs(run(stiffer, 1e-2, y0, 1, 10).y[0] - sin(1));
    print_message("errors %.3e %.3e, stiffer %.3e\n", coarse, fine, stiff);
    check_near(log2(coarse / fine), 3, 0, 0.15);
    check_near(coarse / stiff, 10, 0, 0.2);
}

// The test set's reference at t = 2 (F. Mazzia, C. Magherini, Test Set for IVP Solvers, 2008).
TEST(van_der_pol_reaches_its_reference) {
    problem p = make(2, van_der_pol, 1e6);
    const double y0[MOST] = {2, 0};
    result r = run(p, 1e-8, y0, 2, 1);
    print_message("%ld steps, %ld failed, %ld Jacobians, %ld factorisations\n", r.count.steps,
                  r.count.failed_steps, r.count.jacobians, r.count.factorisations);
    check_near(r.y[0], 0.1706167732170483e1, 1e-7, 0);
    check_near(r.y[1], -0.8928097010247975, 1e-6, 0);
    assert_true(r.count.steps < 1500);
    assert_true(r.count.jacobians < r.count.steps);
}

// -- calls -----------------------------------------------------------------------------------

// Going on from a copy is the same as having gone on, to the last bit and the last factorisation. With a
// loose tolerance every call is one step of the same size, whose factors are only of another Jacobian.
static void check_copies(double rtol, double ahead) {
    problem p = make(2, van_der_pol, 100);
    check_arena(arena);
    bough_integrator radau = create(arena, &p, rtol);
    bough_snapshot copy = {.move = BOUGH_SNAPSHOT_MEASURE};
    radau.ops->transfer(radau.self, &copy);
    char *memory = malloc(copy.used);
    double start[MOST] = {2, 0}, first[MOST] = {0}, second[MOST] = {0}, third[MOST] = {0}, y[MOST];
    assert_non_null(memory);
    for (int k = 1; k <= 40; k++) {
        double t = 0.05 * k;
        copy = (bough_snapshot){BOUGH_SNAPSHOT_SAVE, memory, 0};
        radau.ops->transfer(radau.self, &copy);
        for (int pass = 0; pass < 2; pass++) {
            memcpy(y, start, sizeof y);
            advance(&radau, t - 0.05, t, y);
            memcpy(pass == 0 ? first : second, y, sizeof y);
            advance(&radau, t, t + ahead, y);
            if (pass == 0) memcpy(third, y, sizeof y);
            copy = (bough_snapshot){BOUGH_SNAPSHOT_RESTORE, memory, 0};
            radau.ops->transfer(radau.self, &copy);
        }
        assert_memory_equal(first, second, sizeof first);
        assert_memory_equal(third, y, sizeof y);
        advance(&radau, t - 0.05, t, start);
        assert_memory_equal(first, start, sizeof first);
    }
    free(memory);
}

TEST(copies_are_complete) {
    check_copies(1e-7, 0.3);
    check_copies(1e-2, 0.05);
}

// A load that jumps at a call's end costs nothing once the integrator knows.
static bool pushed(problem *p, double t, const double *y, double *rate) {
    (void)t;
    rate[0] = y[1];
    rate[1] = p->stiffness - 100 * y[0];
    return true;
}

TEST(jumps_are_passed) {
    problem p = make(2, pushed, 0);
    check_arena(arena);
    bough_integrator radau = create(arena, &p, 1e-8);
    double y[MOST] = {0, 0}, force[3] = {100, 0, 50}, q = 0, v = 0;
    for (int k = 0; k < 3; k++) {
        p.stiffness = force[k];
        check_ok(integrator_advance(&radau, 0.5 * k, 0.5 * (k + 1), true, y));
        double rest = force[k] / 100, c = cos(5), s = sin(5), old = q - rest;
        q = rest + c * old + s * v / 10;
        v = c * v - 10 * s * old;
        check_near(y[0], q, 0, 1e-7);
        check_near(y[1], v, 0, 1e-6);
    }
}

TEST(systems_too_large_for_dense_matrices_are_refused) {
    check_arena(arena);
    problem p = make(2, pendulum, 0);
    bough_ode ode = {.name = "test", .n = 100000, .scale = unit, .self = &p, .derivative = derivative};
    bough_integrator_options options = {.kind = BOUGH_RADAU5, .rtol = 1e-6};
    bough_integrator radau;
    check_fails(bough_integrator_create(arena, &ode, &options, &radau), BOUGH_INVALID, "rosenbrock");
}

// Every integrator that chooses its steps, as rows of one table, on a stiff linear system whose solution is
// known.
#include "core/solve/integrator.h"

#include "core/base/linalg.h"
#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

typedef struct method {
    bough_integrator_kind kind;
    const char *name;
    double error;         // at most, in units of the tolerance
    double loose, tight;  // tolerances that are tried
    double least, most;   // steps of a hundred starts over those of one
    double scaling;       // difference that the units of the states make [-]
    bool differentiates;  // f itself: it asks for no tangents
    const char *overflow; // how messages say that f has no value
    const char *newton;   // and that the tangents cannot be factored; NULL: not met
} method;

static const method methods[] = {
    {BOUGH_ARKODE_ESDIRK, "ARKODE", 30, 1e-3, 1e-9, 1.2, 3, 1e-12, false, "finite", "Newton"},
    {BOUGH_CVODE_BDF, "CVODE", 30, 1e-3, 1e-8, 2, 4, 1e-12, false, "finite", "Newton"},
    {BOUGH_IDA, "IDA", 100, 1e-4, 1e-11, 2, 6, 1e-12, false, "finite", "Newton"},
    {BOUGH_ROSENBROCK, "Rosenbrock", 20, 1e-2, 1e-9, 0.8, 1.2, 1e-12, false, "error test", "error test"},
    {BOUGH_RADAU5, "Radau", 10, 1e-3, 1e-9, 1, 1.2, 1e-7, true, "no step", NULL},
};

// Calls it for each method; what is printed last before a failure names the method.
static void each(void (*check)(const method *m)) {
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        print_message("%s\n", methods[k].name);
        check(methods + k);
    }
}

// -- the problem ----------------------------------------------------------------------------------

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
    double slow;   // f has no value from here on [s]
    int refusals;  // so many times
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
    if (t > p->slow && p->refusals-- > 0) return false;
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

// The system under a method; scale (N) must outlive it.
static problem *create_scaled(const method *m, const double *scale, double rtol) {
    problem *p = calloc(1, sizeof *p);
    assert_non_null(p);
    p->arena = check_memory();
    p->wall = (double)INFINITY;
    bough_ode ode = {"stiff", N, scale, p, derivative, NULL, linearise, NULL, factor, solve, 0};
    bough_integrator_options options = {.kind = m->kind, .rtol = rtol};
    check_ok(bough_integrator_create(p->arena, &ode, &options, &p->micro));
    return p;
}

// … at its initial values y.
static problem *create(const method *m, double rtol, double *y) {
    static const double scale[N] = {1, 1, 1};
    exact(0, y);
    return create_scaled(m, scale, rtol);
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

// -- accuracy -------------------------------------------------------------------------------------

static double error_with(const method *m, double rtol) {
    double y[N];
    problem *p = create(m, rtol, y);
    advance(p, 0, 2, true, y);
    destroy(p);
    return error_at(y, 2);
}

// At many tolerances: with its own settings ARKODE now and then accepts a step that is wrong by
// its size in the stiffest mode, because it trusts the convergence rate of other factors.
static void follow_the_tolerance(const method *m) {
    for (double rtol = m->loose; rtol > m->tight; rtol *= 0.9)
        assert_true(error_with(m, rtol) < m->error * rtol);
    assert_true(error_with(m, 1e-8) < 1e-2 * error_with(m, 1e-4));
}

TEST(error_follows_every_tolerance) { each(follow_the_tolerance); }

// The tolerance is rtol times the scale of each state.
static void scale_the_tolerance(const method *m) {
    static const double scales[2][N] = {{1, 1, 1}, {1e-3, 1e-3, 1e-3}};
    double y[2][N];
    for (int k = 0; k < 2; k++) {
        problem *p = create_scaled(m, scales[k], k == 0 ? 1e-6 : 1e-3);
        exact(0, y[k]);
        advance(p, 0, 1, true, y[k]);
        destroy(p);
    }
    for (int i = 0; i < N; i++) check_near(y[1][i], y[0][i], 0, m->scaling);
}

TEST(tolerance_is_relative_to_the_scale) { each(scale_the_tolerance); }

// -- calls ----------------------------------------------------------------------------------------

// f has no value beyond the end, and the end is reached though no natural step ends there.
static void stop_at_the_end(const method *m) {
    double y[N];
    problem *p = create(m, 1e-6, y);
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

TEST(stops_at_the_end_and_looks_no_further) { each(stop_at_the_end); }

static long steps_of(const method *m, bool restart) {
    double y[N];
    problem *p = create(m, 1e-6, y);
    for (int k = 0; k < 100; k++) advance(p, 0.1 * k, 0.1 * (k + 1), restart || k == 0, y);
    assert_true(error_at(y, 10) < 2e-5);
    bough_statistics s = counts(p);
    assert_int_equal(s.starts, restart ? 100 : 1);
    destroy(p);
    return s.steps;
}

// One-step methods lose little by a start, the others their order.
static void compare_starts(const method *m) {
    long kept = steps_of(m, false), anew = steps_of(m, true);
    print_message("kept %ld, anew %ld steps\n", kept, anew);
    assert_true(kept >= 100);
    assert_in_range(100 * anew, (LargestIntegralType)(100 * m->least) * kept,
                    (LargestIntegralType)(100 * m->most) * kept);
}

TEST(a_start_costs_what_the_method_loses) { each(compare_starts); }

// From a state that was changed outside, as the exact solution of the same modes started there.
static void start_elsewhere(const method *m) {
    double y[N], moved[N];
    problem *p = create(m, 1e-7, y);
    advance(p, 0, 0.4, false, y); // the first call starts in any case
    exact(0, moved);
    advance(p, 0, 0.4, true, moved);
    // Radau keeps its tangents
    for (int i = 0; i < N; i++) check_near(moved[i], y[i], 0, m->differentiates ? 1e-8 : 0);
    assert_int_equal(counts(p).starts, 2);
    exact(3, y);
    advance(p, 3, 3.7, true, y);
    assert_true(error_at(y, 3.7) < 3e-6);
    destroy(p);
}

TEST(restart_takes_up_a_changed_state) { each(start_elsewhere); }

// -- failures -------------------------------------------------------------------------------------

// A rate that has no value shortens the step.
static void refuse_some_rates(const method *m) {
    double y[N];
    problem *p = create(m, 1e-6, y);
    p->slow = 0.5, p->refusals = 3;
    advance(p, 0, 1, true, y);
    assert_true(p->refusals <= 0);
    assert_true(counts(p).failed_steps > 0);
    assert_true(error_at(y, 1) < 2e-5);
    destroy(p);
}

TEST(refused_rate_is_retried) { each(refuse_some_rates); }

static void check_failure(bough_status status, const method *m, const char *time, const char *why) {
    const char *parts[] = {"stiff", m->name, time, why};
    for (int k = 0; k < 4; k++) check_fails(status, BOUGH_FAILED, parts[k]);
    assert_null(strstr(status.message, "try")); // the coupling says it, once
}

static void fail_in_four_ways(const method *m) {
    double y[N];
    problem *p = create(m, 1e-6, y);
    advance(p, 0, 0.2, true, y);
    p->wall = 0.5;
    check_failure(try_advance(p, 0.2, 1, false, y), m, "t = 0.5 s",
                  m->overflow); // shorter steps up to the wall
    exact(0.2, y);
    p->wall = 0.3;
    p->lasting = true;
    check_failure(try_advance(p, 0.2, 1, true, y), m, "t = 0.2", m->overflow);
    p->broken = false;
    p->wall = 0;
    exact(0.25, y);
    check_failure(try_advance(p, 0.25, 1, true, y), m, "t = 0.25 s", m->overflow);
    p->broken = false;
    p->wall = INFINITY;
    p->singular = true;
    if (m->newton) check_failure(try_advance(p, 0.25, 1, true, y), m, "t = 0.25 s", m->newton);
    p->singular = false; // and a restart brings it back
    exact(0.25, y);
    advance(p, 0.25, 1, true, y);
    assert_true(error_at(y, 1) < 2e-5);
    destroy(p);
}

TEST(failure_names_body_time_and_method) { each(fail_in_four_ways); }

// -- statistics -----------------------------------------------------------------------------------

static void count_over_restarts(const method *m) {
    double y[N];
    problem *p = create(m, 1e-6, y);
    bough_statistics sum = counts(p);
    assert_int_equal(sum.steps + sum.derivatives + sum.starts, 0);
    for (int k = 0; k < 12; k++) {
        bough_statistics before = counts(p);
        advance(p, 0.1 * k, 0.1 * (k + 1), k % 4 == 0, y);
        assert_true(counts(p).steps > before.steps);
    }
    sum = counts(p);
    assert_int_equal(sum.derivatives, p->derivatives);
    if (!m->differentiates) {
        assert_int_equal(sum.jacobians, p->linearisations);
        assert_int_equal(sum.factorisations, p->factorisations);
        assert_int_equal(sum.iterations, m->kind == BOUGH_ROSENBROCK ? 0 : p->solutions);
    }
    assert_true(sum.jacobians > 0 && 2 * sum.jacobians < sum.factorisations); // other lengths keep tangents
    assert_int_equal(sum.starts, 3);
    bough_statistics twice = sum; // counts are added to what is there
    add_counts(p, &twice);
    assert_int_equal(twice.steps, 2 * sum.steps);
    assert_int_equal(twice.failed_steps, 2 * sum.failed_steps);
    assert_int_equal(twice.starts, 6);
    destroy(p);
}

TEST(statistics_add_up_over_restarts) { each(count_over_restarts); }

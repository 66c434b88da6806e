// The IDA master on equations with exact solutions.
#include "tests/unit/check.h"
#include "tests/unit/integrator.h"

#include "core/solve/integrator.h"

#include <string.h>

// A damped oscillator: ẏ0 = y1, ẏ1 = −2 d y1 − k y0.
typedef struct oscillator {
    double k, d, latest, break_after, refuse_after, gamma;
    int setups, refusals; // refusals left
} oscillator;

static bool derivative(void *self, double t, const double *y, double *rate) {
    oscillator *o = self;
    if (t > o->latest) o->latest = t;
    rate[0] = y[1];
    rate[1] = -2 * o->d * y[1] - o->k * y[0];
    if (t > o->break_after) rate[0] = NAN;
    if (t > o->refuse_after && o->refusals > 0) {
        o->refusals--;
        return false;
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
    o->setups++;
    return true;
}

static void solve(void *self, double *x) {
    oscillator *o = self;
    double g = o->gamma, a = 1 + 2 * o->d * g, b = o->k * g, first = x[0];
    x[0] = (a * first + g * x[1]) / (a + g * b);
    x[1] = (x[1] - b * first) / (a + g * b);
}

static const double unit[2] = {1, 1};

static bough_integrator create(bough_arena *arena, oscillator *o, double rtol) {
    bough_ode ode = {"oscillator", 2, unit, o, derivative, NULL, linearise, factor, solve, 0};
    bough_integrator_options options = {.kind = BOUGH_IDA, .rtol = rtol};
    bough_integrator ida;
    check_ok(bough_integrator_create(arena, &ode, &options, &ida));
    return ida;
}

static void advance(const bough_integrator *ida, double t, double t1, bool restart, double *y) {
    check_ok(integrator_advance(ida, t, t1, restart, y));
}

// From y0 = 1 at rest: e^{−dt}(cos ωt + d/ω sin ωt)
static double exact(const oscillator *o, double t) {
    double omega = sqrt(o->k - o->d * o->d);
    return exp(-o->d * t) * (cos(omega * t) + o->d / omega * sin(omega * t));
}

static double exact_rate(const oscillator *o, double t) {
    double omega = sqrt(o->k - o->d * o->d);
    return -o->k / omega * exp(-o->d * t) * sin(omega * t);
}

static oscillator ordinary(void) { return (oscillator){.k = 9, .d = 0.4, .latest = -1, .break_after = 1e9}; }

static double error_at(double rtol) {
    oscillator o = ordinary();
    check_arena(arena);
    bough_integrator ida = create(arena, &o, rtol);
    double y[2] = {1, 0}, worst = 0;
    for (int k = 1; k <= 20; k++) {
        double t = 0.25 * k;
        advance(&ida, t - 0.25, t, false, y);
        worst = fmax(worst, fabs(y[0] - exact(&o, t)));
        worst = fmax(worst, fabs(y[1] - exact_rate(&o, t)));
    }
    return worst;
}

TEST(error_follows_the_tolerance) {
    for (double rtol = 1e-4; rtol > 1e-11; rtol *= 1e-2) {
        double error = error_at(rtol);
        print_message("rtol %.0e: error %.2e\n", rtol, error);
        check_near(error, 0, 0, 100 * rtol);
    }
}

TEST(nothing_is_evaluated_past_the_end) {
    oscillator o = ordinary();
    check_arena(arena);
    bough_integrator ida = create(arena, &o, 1e-6);
    double y[2] = {1, 0};
    for (int k = 1; k <= 300; k++) {
        double t = 0.013 * k;
        advance(&ida, 0.013 * (k - 1), t, false, y);
        assert_true(o.latest <= t);
        check_near(y[0], exact(&o, t), 0, 1e-4);
    }
}

TEST(restarting_repeats_bit_by_bit) {
    oscillator o = ordinary();
    check_arena(arena);
    bough_integrator ida = create(arena, &o, 1e-6);
    double first[2] = {1, 0}, second[2];
    advance(&ida, 0, 0.7, true, first);
    bough_statistics count = {0}, after = {0};
    ida.ops->statistics(ida.self, &count);
    assert_true(count.steps > 5);
    memcpy(second, first, sizeof second);
    advance(&ida, 0.7, 2.9, false, second); // leave other leftovers behind
    second[0] = 1, second[1] = 0;
    advance(&ida, 0, 0.7, true, second);
    assert_memory_equal(first, second, sizeof first);
    ida.ops->statistics(ida.self, &after);
    assert_int_equal(after.starts, 2);
    assert_true(after.steps > 2 * count.steps); // counted across the restart
    assert_int_equal(after.factorisations, o.setups);
    assert_true(after.jacobians >= 3 &&
                3 * after.jacobians < o.setups); // steps of other lengths keep tangents
}

TEST(failures_name_body_time_and_cure) {
    oscillator o = ordinary();
    o.break_after = 0.5; // NaN from here on
    check_arena(arena);
    bough_integrator ida = create(arena, &o, 1e-6);
    double y[2] = {1, 0};
    bough_status status = integrator_advance(&ida, 0, 1, true, y);
    check_fails(status, BOUGH_FAILED, "oscillator at t = 0.5");
    assert_non_null(strstr(status.message, "IDA"));
    assert_null(strstr(status.message, "try")); // the coupling says it, once
    o.break_after = 1e9;                        // a new start is possible after a failure
    y[0] = 1, y[1] = 0;
    advance(&ida, 0, 1, false, y);
    check_near(y[0], exact(&o, 1), 0, 1e-4);
}

// A rate that has no value makes IDA shorten its step and go on.
TEST(refused_rate_is_retried) {
    oscillator o = ordinary();
    o.refuse_after = 0.5, o.refusals = 3;
    check_arena(arena);
    bough_integrator ida = create(arena, &o, 1e-6);
    double y[2] = {1, 0};
    advance(&ida, 0, 1, true, y);
    assert_int_equal(o.refusals, 0);
    check_near(y[0], exact(&o, 1), 0, 1e-4);
    bough_statistics count = {0};
    ida.ops->statistics(ida.self, &count);
    assert_true(count.failed_steps >= 3);
}

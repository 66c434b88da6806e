// The IDA master on equations with exact solutions.
#include "tests/check.h"

#include "core/integrator_ida.h"

#include <string.h>

// A damped, driven oscillator as a DAE: ẏ0 = y1, ẏ1 = −2 d y1 − k y0 + a(t), and an algebraic
// y2 = y0 + y1.
typedef struct oscillator {
    double k, d, latest, break_after, refuse_after;
    double j[3][3];
    int setups, refusals; // refusals left
} oscillator;

static bool residual(void *self, double t, const double *y, const double *rate, double *r) {
    oscillator *o = self;
    if (t > o->latest) o->latest = t;
    r[0] = rate[0] - y[1];
    r[1] = rate[1] + 2 * o->d * y[1] + o->k * y[0];
    r[2] = y[2] - y[0] - y[1];
    if (t > o->break_after) r[0] = NAN;
    if (t > o->refuse_after && o->refusals > 0) {
        o->refusals--;
        return false;
    }
    return true;
}

static bool setup(void *self, double t, const double *y, const double *rate, double cj) {
    (void)t, (void)y, (void)rate;
    oscillator *o = self;
    const double j[3][3] = {{cj, -1, 0}, {o->k, cj + 2 * o->d, 0}, {-1, -1, 1}};
    memcpy(o->j, j, sizeof j);
    o->setups++;
    return true;
}

static void solve(void *self, double *x) {
    oscillator *o = self;
    const double a = o->j[0][0], b = o->j[0][1], c = o->j[1][0], d = o->j[1][1];
    double det = a * d - b * c, x0 = (d * x[0] - b * x[1]) / det;
    x[1] = (a * x[1] - c * x[0]) / det;
    x[0] = x0;
    x[2] += x[0] + x[1];
}

static const double unit[3] = {1, 1, 1};

static bough_ida *create(bough_arena *arena, oscillator *o, double rtol) {
    bough_dae dae = {"oscillator", 3, o, residual, setup, solve};
    bough_ida *ida = NULL;
    bough_status status = bough_ida_create(arena, &dae, unit, rtol, &ida);
    assert_int_equal(status.code, BOUGH_OK);
    return ida;
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

static void start(bough_ida *ida, const oscillator *o) {
    const double y[3] = {1, 0, 1}, rate[3] = {0, -o->k, -o->k};
    bough_status status = bough_ida_start(ida, 0, y, rate);
    assert_int_equal(status.code, BOUGH_OK);
}

static oscillator ordinary(void) {
    return (oscillator){.k = 9, .d = 0.4, .latest = -1, .break_after = 1e9};
}

static double error_at(double rtol) {
    oscillator o = ordinary();
    bough_arena *arena = bough_arena_create();
    bough_ida *ida = create(arena, &o, rtol);
    double y[3], rate[3], worst = 0;
    start(ida, &o);
    for (int k = 1; k <= 20; k++) {
        double t = 0.25 * k;
        bough_status status = bough_ida_advance(ida, t, y, rate);
        assert_int_equal(status.code, BOUGH_OK);
        worst = fmax(worst, fabs(y[0] - exact(&o, t)));
        worst = fmax(worst, fabs(y[1] - exact_rate(&o, t)));
        worst = fmax(worst, 0.1 * fabs(rate[0] - exact_rate(&o, t)));
        worst = fmax(worst, fabs(y[2] - y[0] - y[1]));
    }
    bough_arena_destroy(arena);
    return worst;
}

static void error_follows_the_tolerance(void **state) {
    (void)state;
    for (double rtol = 1e-4; rtol > 1e-11; rtol *= 1e-2) {
        double error = error_at(rtol);
        print_message("rtol %.0e: error %.2e\n", rtol, error);
        check_near(error, 0, 0, 100 * rtol);
    }
}

static void nothing_is_evaluated_past_the_end(void **state) {
    (void)state;
    oscillator o = ordinary();
    bough_arena *arena = bough_arena_create();
    bough_ida *ida = create(arena, &o, 1e-6);
    double y[3], rate[3];
    start(ida, &o);
    for (int k = 1; k <= 300; k++) {
        double t = 0.013 * k;
        bough_status status = bough_ida_advance(ida, t, y, rate);
        assert_int_equal(status.code, BOUGH_OK);
        assert_true(o.latest <= t);
        check_near(y[0], exact(&o, t), 0, 1e-4);
    }
    bough_arena_destroy(arena);
}

static void dense_output_lies_on_the_solution(void **state) {
    (void)state;
    oscillator o = ordinary();
    bough_arena *arena = bough_arena_create();
    bough_ida *ida = create(arena, &o, 1e-8);
    double y[3], rate[3];
    start(ida, &o);
    bough_status status = bough_ida_advance(ida, 1, y, rate);
    assert_int_equal(status.code, BOUGH_OK);
    status = bough_ida_dense(ida, 0.9999, y, rate);
    assert_int_equal(status.code, BOUGH_OK);
    check_near(y[0], exact(&o, 0.9999), 0, 1e-6);
    check_near(rate[0], exact_rate(&o, 0.9999), 0, 1e-5);
    status = bough_ida_dense(ida, 0.1, y, rate); // long left behind
    assert_int_equal(status.code, BOUGH_FAILED);
    bough_arena_destroy(arena);
}

static void restarting_repeats_bit_by_bit(void **state) {
    (void)state;
    oscillator o = ordinary();
    bough_arena *arena = bough_arena_create();
    bough_ida *ida = create(arena, &o, 1e-6);
    double first[3], second[3], rate[3];
    bough_statistics count;
    start(ida, &o);
    bough_ida_advance(ida, 0.7, first, rate);
    bough_ida_statistics(ida, &count);
    long steps = count.steps;
    assert_true(steps > 5);
    bough_ida_advance(ida, 2.9, second, rate); // leave other leftovers behind
    start(ida, &o);
    bough_ida_advance(ida, 0.7, second, rate);
    assert_memory_equal(first, second, sizeof first);
    bough_ida_statistics(ida, &count);
    assert_int_equal(count.restarts, 2);
    assert_true(count.steps > 2 * steps); // counted across the restart
    assert_int_equal(count.jacobians, o.setups);
    assert_int_equal(count.factorisations, o.setups);
    bough_arena_destroy(arena);
}

static void failures_name_body_time_and_cure(void **state) {
    (void)state;
    oscillator o = ordinary();
    o.break_after = 0.5; // NaN from here on
    bough_arena *arena = bough_arena_create();
    bough_ida *ida = create(arena, &o, 1e-6);
    double y[3], rate[3];
    start(ida, &o);
    bough_status status = bough_ida_advance(ida, 1, y, rate);
    assert_int_equal(status.code, BOUGH_FAILED);
    assert_non_null(strstr(status.message, "oscillator at t = 0.5"));
    assert_non_null(strstr(status.message, "IDA"));
    assert_non_null(strstr(status.message, "smaller macro step"));
    o.break_after = 1e9; // a new start is possible after a failure
    start(ida, &o);
    status = bough_ida_advance(ida, 1, y, rate);
    assert_int_equal(status.code, BOUGH_OK);
    check_near(y[0], exact(&o, 1), 0, 1e-4);
    bough_arena_destroy(arena);
}

// A residual that refuses a state makes IDA shorten its step and go on.
static void refused_residual_is_retried(void **state) {
    (void)state;
    oscillator o = ordinary();
    o.refuse_after = 0.5, o.refusals = 3;
    bough_arena *arena = bough_arena_create();
    bough_ida *ida = create(arena, &o, 1e-6);
    double y[3], rate[3];
    start(ida, &o);
    bough_status status = bough_ida_advance(ida, 1, y, rate);
    assert_int_equal(status.code, BOUGH_OK);
    assert_int_equal(o.refusals, 0);
    check_near(y[0], exact(&o, 1), 0, 1e-4);
    bough_statistics count;
    bough_ida_statistics(ida, &count);
    assert_true(count.failed_steps >= 3);
    bough_arena_destroy(arena);
}

static void bad_tolerance_is_refused(void **state) {
    (void)state;
    oscillator o = ordinary();
    bough_arena *arena = bough_arena_create();
    bough_dae dae = {"oscillator", 3, &o, residual, setup, solve};
    bough_ida *ida = NULL;
    bough_status status = bough_ida_create(arena, &dae, unit, 0, &ida);
    assert_int_equal(status.code, BOUGH_INVALID);
    bough_arena_destroy(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_follows_the_tolerance),
        cmocka_unit_test(nothing_is_evaluated_past_the_end),
        cmocka_unit_test(dense_output_lies_on_the_solution),
        cmocka_unit_test(restarting_repeats_bit_by_bit),
        cmocka_unit_test(failures_name_body_time_and_cure),
        cmocka_unit_test(refused_residual_is_retried),
        cmocka_unit_test(bad_tolerance_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "cosim/signal.h"

#include "tests/unit/check.h"

static double cubic(double t) { return 1 + t * (-2 + t * (3 - t)); }

static double cubic_rate(double t) { return -2 + t * (6 - 3 * t); }

static void check_signal(const bough_signal *s, double (*expected)(double)) {
    for (double t = s->t0; t <= s->t1; t += .1) {
        double value[2];
        bough_signal_value(s, t, value);
        check_near(value[0], 0, 0, 0); // another component
        check_near(value[1], expected(t), 1e-13, 1e-13);
    }
}

static bough_signal signal_on(bough_arena *arena, double t0, double t1) {
    bough_signal s = bough_signal_create(arena, 2);
    s.t0 = t0;
    s.t1 = t1;
    return s;
}

static double constant(double t) {
    (void)t;
    return 4;
}

static double line(double t) { return 4 - 3 * (t - 2); }

static double parabola(double t) { return 2 - t + .5 * t * t; }

TEST(held_values_and_rates) {
    check_arena(arena);
    bough_signal s = signal_on(arena, 2, 2.5);
    const double value = 4, rate = -3, end = 2.5;
    bough_signal_hold(&s, 1, value);
    check_signal(&s, constant);
    bough_signal_hold_rate(&s, 1, value, rate);
    check_signal(&s, line);
    bough_signal_linear(&s, 1, value, end);
    check_signal(&s, line);
}

TEST(hermite_reproduces_a_cubic) {
    check_arena(arena);
    bough_signal s = signal_on(arena, .5, 1.3);
    const double v0 = cubic(.5), r0 = cubic_rate(.5), v1 = cubic(1.3), r1 = cubic_rate(1.3);
    bough_signal_hermite(&s, 1, (bough_signal_end){v0, r0}, (bough_signal_end){v1, r1});
    check_signal(&s, cubic);
}

TEST(polynomials_extrapolate_and_interpolate) {
    check_arena(arena);
    bough_signal s = signal_on(arena, .5, 1.3);
    const double back[3] = {.5, .2, -.3}, around[4] = {1.3, .5, .2, -.3};
    double value[4];
    for (int p = 0; p < 3; p++) value[p] = parabola(back[p]);
    bough_signal_polynomial(&s, 1, 3, back, value);
    check_signal(&s, parabola);
    for (int p = 0; p < 4; p++) value[p] = cubic(around[p]);
    bough_signal_polynomial(&s, 1, 4, around, value);
    check_signal(&s, cubic);
}

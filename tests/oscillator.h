// A test subsystem: one mass with springs, linear, integrated exactly to rounding (Taylor series of
// the state under the cubic input). Two kinds couple to the two-mass oscillator: the mass that is
// told the coupling force and tells its motion (v, x), and the mass that holds the coupling spring,
// is told the other's motion and tells the force on it.
#ifndef BOUGH_TESTS_OSCILLATOR_H
#define BOUGH_TESTS_OSCILLATOR_H

#include "core/subsystem.h"

#include <math.h>
#include <string.h>

enum { OSCILLATOR_PORT = 3 };

// ẏ = A y + B u, o = C y + D u; y = (x, v)
typedef struct oscillator {
    double a[2][2], b[2][OSCILLATOR_PORT], c[OSCILLATOR_PORT][2];
    double d[OSCILLATOR_PORT][OSCILLATOR_PORT];
    int n_input, n_output;
    double time, y[2], scale[2];
    double inverse[2][2]; // (I − γA)⁻¹
    long advances, restarts;
} oscillator;

static inline bool oscillator_derivative(void *self, double t, const double *y, const double *u,
                                         double *rate) {
    const oscillator *o = self;
    (void)t;
    for (int i = 0; i < 2; i++) {
        rate[i] = o->a[i][0] * y[0] + o->a[i][1] * y[1];
        for (int j = 0; j < o->n_input; j++) rate[i] += o->b[i][j] * u[j];
    }
    return isfinite(rate[0]) && isfinite(rate[1]);
}

static inline void oscillator_output_tangent(void *self, double t, const double *y, const double *u,
                                             const double *dy, const double *du, double *out) {
    const oscillator *o = self;
    (void)t, (void)y, (void)u;
    for (int i = 0; i < o->n_output; i++) {
        out[i] = dy ? o->c[i][0] * dy[0] + o->c[i][1] * dy[1] : 0;
        for (int j = 0; du && j < o->n_input; j++) out[i] += o->d[i][j] * du[j];
    }
}

static inline void oscillator_output(void *self, double t, const double *y, const double *u,
                                     double *out) {
    oscillator_output_tangent(self, t, y, u, y, u, out);
}

static inline void oscillator_input_columns(void *self, double t, const double *y, const double *u,
                                            double *column) {
    const oscillator *o = self;
    (void)t, (void)y, (void)u;
    for (int j = 0; j < o->n_input; j++) {
        column[2 * j] = o->b[0][j];
        column[2 * j + 1] = o->b[1][j];
    }
}

static inline bool oscillator_newton_setup(void *self, double t, const double *y, const double *u,
                                           double gamma) {
    oscillator *o = self;
    (void)t, (void)y, (void)u;
    double m00 = 1 - gamma * o->a[0][0], m01 = -gamma * o->a[0][1];
    double m10 = -gamma * o->a[1][0], m11 = 1 - gamma * o->a[1][1];
    double determinant = m00 * m11 - m01 * m10;
    o->inverse[0][0] = m11 / determinant;
    o->inverse[0][1] = -m01 / determinant;
    o->inverse[1][0] = -m10 / determinant;
    o->inverse[1][1] = m00 / determinant;
    return determinant != 0;
}

static inline void oscillator_newton_solve(void *self, double *x) {
    const oscillator *o = self;
    double x0 = x[0];
    x[0] = o->inverse[0][0] * x0 + o->inverse[0][1] * x[1];
    x[1] = o->inverse[1][0] * x0 + o->inverse[1][1] * x[1];
}

// Taylor coefficients of the input about t, in (time)ᵏ.
static inline void oscillator_input_series(const bough_signal *s, double t, double (*series)[4]) {
    double length = s->t1 - s->t0, tau = (t - s->t0) / length;
    for (int j = 0; j < s->n; j++) {
        const double *c = s->coefficient + j;
        double c1 = c[s->n], c2 = c[2 * s->n], c3 = c[3 * s->n];
        series[j][0] = c[0] + tau * (c1 + tau * (c2 + tau * c3));
        series[j][1] = (c1 + tau * (2 * c2 + 3 * tau * c3)) / length;
        series[j][2] = (c2 + 3 * tau * c3) / (length * length);
        series[j][3] = c3 / (length * length * length);
    }
}

static inline void oscillator_step(oscillator *o, const bough_signal *input, double t, double h) {
    double series[OSCILLATOR_PORT][4], term[2] = {o->y[0], o->y[1]}, power = 1;
    oscillator_input_series(input, t, series);
    for (int k = 0; k < 24; k++) {
        double next[2];
        for (int i = 0; i < 2; i++) {
            next[i] = o->a[i][0] * term[0] + o->a[i][1] * term[1];
            for (int j = 0; k < 4 && j < o->n_input; j++) next[i] += o->b[i][j] * series[j][k];
        }
        power *= h;
        for (int i = 0; i < 2; i++) {
            term[i] = next[i] / (k + 1);
            o->y[i] += power * term[i];
        }
    }
}

static inline bough_status oscillator_advance(void *self, double t1, const bough_signal *input,
                                              bool restart) {
    oscillator *o = self;
    double norm = fabs(o->a[1][0]) + fabs(o->a[1][1]) + 1, t0 = o->time;
    int n = (int)ceil((t1 - t0) * norm);
    for (int k = 0; k < n; k++) {
        oscillator_step(o, input, t0 + (t1 - t0) * k / n, (t1 - t0) / n);
    }
    o->time = t1;
    o->advances++;
    o->restarts += restart;
    return bough_ok();
}

static inline size_t oscillator_save_size(void *self) {
    (void)self;
    return sizeof(oscillator);
}

static inline void oscillator_save(void *self, void *copy) {
    memcpy(copy, self, sizeof(oscillator));
}

static inline void oscillator_restore(void *self, const void *copy) {
    memcpy(self, copy, sizeof(oscillator));
}

static inline void oscillator_set_state(void *self, double t, const double *y) {
    oscillator *o = self;
    o->time = t;
    o->y[0] = y[0];
    o->y[1] = y[1];
}

static inline void oscillator_statistics(void *self, bough_statistics *sum) {
    const oscillator *o = self;
    sum->steps += o->advances;
    sum->restarts += o->restarts;
}

static const bough_subsystem_ops oscillator_ops = {
    .derivative = oscillator_derivative,
    .output = oscillator_output,
    .output_tangent = oscillator_output_tangent,
    .input_columns = oscillator_input_columns,
    .newton_setup = oscillator_newton_setup,
    .newton_solve = oscillator_newton_solve,
    .advance = oscillator_advance,
    .save_size = oscillator_save_size,
    .save = oscillator_save,
    .restore = oscillator_restore,
    .set_state = oscillator_set_state,
    .statistics = oscillator_statistics,
};

static inline bough_subsystem oscillator_subsystem(oscillator *o, const char *name) {
    o->scale[0] = o->scale[1] = 1;
    return (bough_subsystem){.name = name,
                             .kind = "oscillator",
                             .solver = "Taylor series",
                             .n_state = 2,
                             .n_input = o->n_input,
                             .n_output = o->n_output,
                             .scale = o->scale,
                             .time = &o->time,
                             .state = o->y,
                             .ops = &oscillator_ops,
                             .self = o};
}

typedef struct spring {
    double m, k, c; // mass [kg], stiffness [N/m] and damping [N s/m] to the wall
} spring;

// Told the force on it; tells (v, x).
static inline oscillator oscillator_told_force(spring s, double x) {
    return (oscillator){.a = {{0, 1}, {-s.k / s.m, -s.c / s.m}},
                        .b = {{0}, {1 / s.m}},
                        .c = {{0, 1}, {1, 0}},
                        .n_input = 1,
                        .n_output = 2,
                        .y = {x, 0}};
}

// Told the other's (v, x), holds the coupling spring (k, c); tells the force on the other.
static inline oscillator oscillator_told_motion(spring s, double k, double c, double x) {
    return (oscillator){.a = {{0, 1}, {-(s.k + k) / s.m, -(s.c + c) / s.m}},
                        .b = {{0}, {c / s.m, k / s.m}},
                        .c = {{k, c}},
                        .d = {{-c, -k}},
                        .n_input = 2,
                        .n_output = 1,
                        .y = {x, 0}};
}

// The same with 3 ports on either side: the leader takes the sum of three forces and tells
// (v, x, x), a follower takes the mean of the two positions.
static inline void oscillator_widen(oscillator *leader, oscillator *follower) {
    for (int j = 1; j < 3; j++) leader->b[1][j] = leader->b[1][0];
    leader->c[2][0] = leader->c[1][0];
    leader->n_input = leader->n_output = 3;
    follower->b[1][1] /= 2;
    follower->d[0][1] /= 2;
    follower->b[1][2] = follower->b[1][1];
    follower->d[0][2] = follower->d[0][1];
    follower->n_input = 3;
}

// The two coupled: (x1, v1, x2, v2) exactly, forwards or backwards in time.
static inline void two_mass_exact(spring s1, spring s2, double k, double c, double duration,
                                  double y[4]) {
    double norm = (s1.k + k + s1.c + c) / s1.m + (s2.k + k + s2.c + c) / s2.m + 1;
    int n = (int)ceil(fabs(duration) * norm);
    double h = duration / n;
    for (int step = 0; step < n; step++) {
        double z[4] = {y[0], y[1], y[2], y[3]};
        for (int p = 1; p < 24; p++) {
            double force = k * (z[2] - z[0]) + c * (z[3] - z[1]);
            double next[4] = {z[1], (force - s1.k * z[0] - s1.c * z[1]) / s1.m, z[3],
                              (-force - s2.k * z[2] - s2.c * z[3]) / s2.m};
            for (int i = 0; i < 4; i++) {
                z[i] = next[i] * h / p;
                y[i] += z[i];
            }
        }
    }
}

#endif

// Input signals on one macro step: vector-valued cubics in time, filled component by component from values
// (and rates) at synchronisation points.
#pragma once

#include "core/base/arena.h"

// On [t0, t1]: value(t) = Σ_k coefficient[k*n + i] τᵏ, τ = (t − t0)/(t1 − t0), k = 0..3.
typedef struct bough_signal {
    int n;
    double t0, t1;       // [s]
    double *coefficient; // (4 × n), in the units of the port
} bough_signal;

static inline void bough_signal_value(const bough_signal *s, double t, double *value) {
    double tau = (t - s->t0) / (s->t1 - s->t0);
    const double *c = s->coefficient;
    for (int i = 0; i < s->n; i++) {
        value[i] = c[i] + tau * (c[s->n + i] + tau * (c[2 * s->n + i] + tau * c[3 * s->n + i]));
    }
}

static inline void bough_signal_rate(const bough_signal *s, double t, double *rate) {
    double length = s->t1 - s->t0, tau = (t - s->t0) / length;
    const double *c = s->coefficient;
    for (int i = 0; i < s->n; i++) {
        double slope = c[s->n + i] + tau * (2 * c[2 * s->n + i] + tau * 3 * c[3 * s->n + i]);
        rate[i] = slope / length;
    }
}

// A zero signal of n components on [0, 1], in the arena.
bough_signal bough_signal_create(bough_arena *arena, int n);

// Component j on the step. Held: value(t) = value.
void bough_signal_hold(bough_signal *s, int j, double value);

// value(t) = value + rate (t − t0)
void bough_signal_hold_rate(bough_signal *s, int j, double value, double rate);

// The polynomial of degree n_point − 1 <= 3 through n_point values: at time[p] value[p]. Extrapolates when
// the times are before t0, interpolates otherwise.
void bough_signal_polynomial(bough_signal *s, int j, int n_point, const double *time, const double *value);

// Linear from `start` at t0 to `end` at t1.
void bough_signal_linear(bough_signal *s, int j, double start, double end);

// The cubic with these values and rates at t0 and at t1.
typedef struct bough_signal_end {
    double value, rate;
} bough_signal_end;
void bough_signal_hermite(bough_signal *s, int j, bough_signal_end start, bough_signal_end end);

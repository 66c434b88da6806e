// Input signals on one macro step: cubics in fixed storage, filled component-wise from values (and
// rates) at synchronisation points. `first` and `count` select components of the signal; value
// arrays start at the selected components.
#ifndef BOUGH_COSIM_PORT_H
#define BOUGH_COSIM_PORT_H

#include "core/base/arena.h"
#include "core/solve/signal.h"

// A zero signal of n components on [0, 1], in the arena.
bough_signal bough_port_signal(bough_arena *arena, int n);

// value(t) = value
void bough_port_hold(bough_signal *s, int first, int count, const double *value);

// value(t) = value + rate (t − t0)
void bough_port_hold_rate(bough_signal *s, int first, int count, const double *value, const double *rate);

// The polynomial of degree n_point − 1 <= 3 through n_point values: at times time[p] the values
// value[p][0 … count − 1]. Extrapolates when the times are before t0, interpolates otherwise.
void bough_port_polynomial(bough_signal *s, int first, int count, int n_point, const double *time,
                           const double *const *value);

// Linear from `start` at t0 to `end` at t1.
void bough_port_linear(bough_signal *s, int first, int count, const double *start, const double *end);

// The cubic with these values and rates (2 × count each: at t0, at t1).
typedef struct bough_port_end {
    const double *value, *rate; // (count)
} bough_port_end;
void bough_port_hermite(bough_signal *s, int first, int count, bough_port_end start, bough_port_end end);

#endif

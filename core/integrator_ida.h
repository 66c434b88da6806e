// Implicit master integrator: SUNDIALS IDA (variable-order BDF, the DASSL family) on F(t, y, ẏ) = 0
// with tolerance rtol · scale per component. The only user of IDA.
#ifndef BOUGH_CORE_INTEGRATOR_IDA_H
#define BOUGH_CORE_INTEGRATOR_IDA_H

#include "core/arena.h"
#include "core/status.h"
#include "core/subsystem.h"

// What is integrated. Callbacks return false where the residual or matrix has no finite value.
typedef struct bough_dae {
    const char *name; // for messages
    int n;
    void *self;
    // residual = F(t, y, rate), each (n)
    bool (*residual)(void *self, double t, const double *y, const double *rate, double *residual);
    // Prepares the solution with ∂F/∂y + cj ∂F/∂ẏ at (t, y, rate).
    bool (*setup)(void *self, double t, const double *y, const double *rate, double cj);
    // Solves with the last setup, in place: x (n).
    void (*solve)(void *self, double *x);
} bough_dae;

typedef struct bough_ida bough_ida;

// Builds the integrator in the arena; all its memory is taken here.
bough_status bough_ida_create(bough_arena *arena, const bough_dae *dae, const double *scale,
                              double rtol, bough_ida **ida);

// Starts anew at (t, y, rate) with order 1. The rate must satisfy F = 0.
bough_status bough_ida_start(bough_ida *ida, double t, const double *y, const double *rate);

// Integrates to exactly t1, never evaluating F beyond it; y and rate (n) receive the values there.
// The history is kept from call to call.
bough_status bough_ida_advance(bough_ida *ida, double t1, double *y, double *rate);

// y and rate at a time within the last internal step, or the last call's interval if it took one.
bough_status bough_ida_dense(bough_ida *ida, double t, double *y, double *rate);

void bough_ida_statistics(const bough_ida *ida, bough_statistics *sum);

#endif

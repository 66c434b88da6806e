// Micro steps by SUNDIALS CVODE (variable-order BDF) with the body's own Newton solver. The only
// user of CVODE.
#ifndef BOUGH_FLEXBODY_MICRO_CVODE_H
#define BOUGH_FLEXBODY_MICRO_CVODE_H

#include "core/arena.h"
#include "core/status.h"
#include "core/subsystem.h"

// What is integrated: ẏ = f(t, y). Callbacks return false where there is no finite value.
typedef struct bough_ode {
    const char *name; // of the body, for messages
    int n;
    void *self;
    bool (*derivative)(void *self, double t, const double *y, double *rate);
    bool (*linearise)(void *self, double t, const double *y); // tangents of f
    bool (*factor)(void *self, double gamma);                 // I − γ ∂f/∂y of the last tangents
    void (*solve)(void *self, double *x);                     // in place
} bough_ode;

typedef struct bough_micro_cvode bough_micro_cvode;

// Builds the integrator in the arena with tolerance rtol · scale per state (n).
bough_status bough_micro_cvode_create(bough_arena *arena, const bough_ode *ode,
                                      const double *scale, double rtol, bough_micro_cvode **micro);

// Integrates y (n) from t to exactly t1, never evaluating f beyond it. `restart`: y was changed or
// f jumps at t, so the history is dropped and order 1 begins.
bough_status bough_micro_cvode_advance(bough_micro_cvode *micro, double t, double t1, bool restart,
                                       double *y);

void bough_micro_cvode_statistics(const bough_micro_cvode *micro, bough_statistics *sum);

#endif

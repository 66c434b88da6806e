// Micro steps of a flexible body: what a sub-solver integrates, and the sub-solvers by name. One
// file per method; this is the table.
#ifndef BOUGH_FLEXBODY_MICRO_H
#define BOUGH_FLEXBODY_MICRO_H

#include "core/arena.h"
#include "core/status.h"
#include "core/subsystem.h"

// ẏ = f(t, y). Callbacks return false where there is no finite value.
typedef struct bough_ode {
    const char *name; // of the body, for messages
    int n;
    void *self;
    bool (*derivative)(void *self, double t, const double *y, double *rate);
    // the same at another time, y being that of the last call: may be cheaper
    bool (*derivative_again)(void *self, double t, const double *y, double *rate);
    bool (*linearise)(void *self, double t, const double *y); // tangents of f
    bool (*factor)(void *self, double gamma);                 // I − γ ∂f/∂y of the last tangents
    void (*solve)(void *self, double *x);                     // in place
} bough_ode;

typedef enum bough_micro_kind {
    BOUGH_MICRO_CVODE_BDF,
    BOUGH_MICRO_GENERALIZED_ALPHA,
    BOUGH_MICRO_ARKODE_ESDIRK,
    BOUGH_MICRO_ROSENBROCK,
} bough_micro_kind;

typedef struct bough_micro_options {
    bough_micro_kind kind;
    double rtol; // tolerance per state: rtol · scale; of Newton's method in generalised-α
    double step; // longest step of generalised-α and the Rosenbrock method [s]
    double rho;  // its spectral radius at infinite frequency, 0 … 1
} bough_micro_options;

typedef struct bough_micro {
    const char *name; // of the method, for messages
    void *self;
    // Integrates y (n) from t to exactly t1, never evaluating f beyond it. `restart`: y was changed
    // or f jumps at t.
    bough_status (*advance)(void *self, double t, double t1, bool restart, double *y);
    void (*statistics)(const void *self, bough_statistics *sum);
    // The same from *t, but ends with the first step that reaches `pause`, and tells in *t where.
    // NULL: cannot stop on the way.
    bough_status (*advance_part)(void *self, double *t, double pause, double t1, bool restart,
                                 double *y);
    // (n) sum of the errors of all steps, by the method's own estimate; readers set it to zero. NULL:
    // it has none.
    double *own_error;
} bough_micro;

// The sub-solver of the options' kind in the arena; scale (n) is borrowed.
bough_status bough_micro_create(bough_arena *arena, const bough_ode *ode, const double *scale,
                                bough_micro_options options, bough_micro *micro);

#endif

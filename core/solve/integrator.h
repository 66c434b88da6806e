// Integrators: any method on any system. One file per method; this is the table.
//
// A method gets a system under its inputs (a rod, the tree, two masses or a whole assembly) as
// ẏ = f(t, y), together with solutions of (I − γ ∂f/∂y) x = b.
#pragma once

#include "core/base/snapshot.h"
#include "core/solve/system.h"

// Work done so far, for the summary.
typedef struct bough_statistics {
    long steps, failed_steps, derivatives, jacobians, factorisations, iterations;
    long starts; // the first, those after jumps of the input or the state, and at every checkpoint
} bough_statistics;

// sum += factor part
static inline void bough_statistics_add(bough_statistics *sum, long factor, const bough_statistics *part) {
    sum->steps += factor * part->steps;
    sum->failed_steps += factor * part->failed_steps;
    sum->derivatives += factor * part->derivatives;
    sum->jacobians += factor * part->jacobians;
    sum->factorisations += factor * part->factorisations;
    sum->iterations += factor * part->iterations;
    sum->starts += factor * part->starts;
}

// ẏ = f(t, y). Callbacks return false where there is no finite value.
typedef struct bough_ode {
    const char *name; // of the body, for messages
    int n;
    const double *scale; // (n) tolerance = rtol · scale; borrowed
    void *self;
    // f: rate (n)
    bool (*derivative)(void *self, double t, const double *y, double *rate);
    // f at two times, rate[0] and rate[1] (n): may be cheaper than twice the above. NULL: it is not.
    bool (*derivative_twice)(void *self, const double t[2], const double *y, double *const rate[2]);
    bool (*linearise)(void *self, double t, const double *y); // tangents of f
    // as in system.h; NULL: not known
    bool (*linearise_ahead)(void *self, double t, const double *y, const double *ahead, bool keep);
    bool (*factor)(void *self, double gamma); // I − γ ∂f/∂y of the last tangents
    void (*solve)(void *self, double *x);     // in place
    double elastic_rate;                      // [1/s] as in system.h
} bough_ode;

typedef enum bough_integrator_kind {
    BOUGH_IDA,
    BOUGH_CVODE_BDF,
    BOUGH_ARKODE_ESDIRK,
    BOUGH_RADAU5,
    BOUGH_GENERALIZED_ALPHA,
    BOUGH_ROSENBROCK,
    BOUGH_AUTOMATIC,
} bough_integrator_kind;

typedef struct bough_integrator_options {
    bough_integrator_kind kind;
    double rtol;    // tolerance per state: rtol · scale; of Newton's method in generalised-α
    double step;    // longest step of generalised-α and the Rosenbrock method [s]; 0: none
    double rho;     // of generalised-α: spectral radius at infinite frequency, 0 … 1
    int most_steps; // of IDA, CVODE and the Rosenbrock method in a macro step; 0: their own limits
    int most_order; // of IDA; 0: 5
    bool by_bdf;    // beside a run by BDF: the automatic choice begins with CVODE
    bool coarse; // of long steps: Radau IIA does not divide macro steps evenly; the Rosenbrock method takes
                 // a third of the usual damping to cover old tangents, and renews them after fewer
                 // steps; the automatic choice of a method has one more
} bough_integrator_options;

// Options besides rtol that only some methods read.
enum { BOUGH_METHOD_READS_STEP = 1, BOUGH_METHOD_READS_RHO = 2 };

// A method. `create` returns its memory, which the other calls get as `self`.
typedef struct bough_integrator_ops {
    const char *name;  // in scenes
    const char *title; // in messages
    int most_states;   // largest system that it suits; 0: any
    unsigned reads;    // BOUGH_METHOD_READS_…
    void *(*create)(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options);
    // Integrates y (n) from *t to exactly t1 and never evaluates f beyond t1; after a failure *t is the time
    // of y. `restart`: y was changed, or f jumps at *t.
    bough_status (*advance)(void *self, double *t, double t1, bool restart, double *y);
    // Sets the most steps in a macro step from now on. NULL: the method has no such limit.
    void (*limit)(void *self, int most_steps);
    void (*statistics)(const void *self, bough_statistics *sum); // added to sum
    // The memory that the next step depends on, besides t and y. NULL: the method restarts.
    void (*transfer)(void *self, bough_snapshot *s);
} bough_integrator_ops;

typedef struct bough_integrator {
    const bough_integrator_ops *ops;
    void *self;
} bough_integrator;

const bough_integrator_ops *bough_integrator_find(bough_integrator_kind kind);

// Name of the method at that place of the table, as of bough_integrator_kind; NULL beyond its end.
const char *bough_integrator_name(int index);

// The integrator of the options' kind in the arena. BOUGH_INVALID where the method does not suit so
// large a system.
bough_status bough_integrator_create(bough_arena *arena, const bough_ode *ode,
                                     const bough_integrator_options *options, bough_integrator *integrator);

extern const bough_integrator_ops bough_integrator_ida, bough_integrator_cvode, bough_integrator_arkode,
    bough_integrator_radau, bough_integrator_alpha, bough_integrator_rosenbrock, bough_integrator_automatic;

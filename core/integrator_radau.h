// Implicit master integrator: Radau IIA of order 5 on ẏ = f(t, y), with tolerance rtol · scale per
// component. A one-step method: an input that jumps costs it nothing but a Jacobian, and a copy
// of it is complete.
// Method: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.8:
// simplified Newton iterations on the stages, transformed to one real and one complex system; step
// size by the predictive controller; the Jacobian is kept while the iterations converge fast.
#ifndef BOUGH_CORE_INTEGRATOR_RADAU_H
#define BOUGH_CORE_INTEGRATOR_RADAU_H

#include "core/arena.h"
#include "core/status.h"
#include "core/subsystem.h"

// What is integrated. Callbacks return false where a value is not finite.
typedef struct bough_ode {
    const char *name; // for messages
    int n;
    void *self;
    bool (*derivative)(void *self, double t, const double *y, double *rate); // f: rate (n)
    // ∂f/∂y: matrix (n × n, column-major)
    bool (*jacobian)(void *self, double t, const double *y, double *matrix);
} bough_ode;

typedef struct bough_radau bough_radau;

// Builds the integrator in the arena; all its memory is taken here. BOUGH_INVALID for a tolerance
// that is not positive.
bough_status bough_radau_create(bough_arena *arena, const bough_ode *ode, const double *scale,
                                double rtol, bough_radau **radau);

// Starts anew at (t, y) and finds a first step.
void bough_radau_start(bough_radau *radau, double t, const double *y);

// Tells that f jumped at the current time: what was learnt of it is dropped, the step size kept.
void bough_radau_jump(bough_radau *radau);

// Integrates to exactly t1, never evaluating f beyond it; y (n) receives the value there.
bough_status bough_radau_advance(bough_radau *radau, double t1, double *y);

// y at a time within the last step, by the collocation polynomial.
void bough_radau_dense(const bough_radau *radau, double t, double *y);

// Everything that the next step depends on: going on from a copy gives the same bits.
size_t bough_radau_save_size(const bough_radau *radau);
void bough_radau_save(const bough_radau *radau, void *copy);
void bough_radau_restore(bough_radau *radau, const void *copy);

// Steps, Jacobians, factorisations, iterations, starts; evaluations of f are the caller's to count.
void bough_radau_statistics(const bough_radau *radau, bough_statistics *sum);

#endif

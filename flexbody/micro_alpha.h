// Micro steps by the generalised-α method for first-order systems (Jansen, Whiting, Hulbert 2000):
// second order, unconditionally stable, the highest frequencies damped by ρ∞ per step, equal steps
// with one factorisation for as long as Newton's method converges with it.
//
//     ẏ_m = f(t + α_f h, y_f),  ẏ_m = ẏ₀ + α_m(ẏ₁ − ẏ₀),  y_f = y₀ + α_f(y₁ − y₀),
//     y₁ = y₀ + h ẏ₀ + γ h(ẏ₁ − ẏ₀)
#ifndef BOUGH_FLEXBODY_MICRO_ALPHA_H
#define BOUGH_FLEXBODY_MICRO_ALPHA_H

#include "flexbody/micro.h"

typedef struct bough_micro_alpha_options {
    double step; // longest step [s]; a macro step is divided into equal parts no longer than this
    double rho;  // spectral radius at infinite frequency, 0 … 1
    double rtol; // Newton's method ends below rtol · scale
} bough_micro_alpha_options;

typedef struct bough_micro_alpha bough_micro_alpha;

// Builds the integrator in the arena with the error scale of each state (n).
bough_status bough_micro_alpha_create(bough_arena *arena, const bough_ode *ode,
                                      const double *scale, bough_micro_alpha_options options,
                                      bough_micro_alpha **micro);

// As bough_micro_cvode_advance. `restart`: ẏ is evaluated anew, as after any jump it must be.
bough_status bough_micro_alpha_advance(bough_micro_alpha *micro, double t, double t1, bool restart,
                                       double *y);

// (n) sum of the errors of all steps, which a reader sets to zero; NULL without integrator. A step that
// starts exact errs by C h³ y‴ with C = 1/12 − ½(α_f − α_m)² + ½(α_f(1 − α_f) − α_m(1 − α_m)); y‴ is the
// difference of the slopes of ẏ in the last two steps, so that the first after a restart tells nothing.
double *bough_micro_alpha_error(const bough_micro_alpha *micro);

void bough_micro_alpha_statistics(const bough_micro_alpha *micro, bough_statistics *sum);

#endif

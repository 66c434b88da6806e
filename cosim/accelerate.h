// Fixed-point accelerators: iterations u ← H(u) that converge where the plain one diverges or is
// slow. The residual is r = H(u) − u; components should be scaled to a common size by the caller,
// because Aitken and IQN-ILS take scalar products of them.
#pragma once

#include "core/base/arena.h"

typedef enum bough_acceleration {
    BOUGH_ACCELERATE_NONE,       // u + r
    BOUGH_ACCELERATE_RELAXATION, // u + ω r, ω constant
    BOUGH_ACCELERATE_AITKEN,     // u + ω r, ω from the last two residuals
    BOUGH_ACCELERATE_IQN_ILS,    // quasi-Newton: least squares over all differences so far
    BOUGH_ACCELERATE_NEWTON,     // u + (I − ∂H/∂u)⁻¹ r, corrected by the differences, too
} bough_acceleration;

// Whether it learns from the differences of iterates.
static inline bool bough_acceleration_learns(bough_acceleration kind) {
    return kind == BOUGH_ACCELERATE_IQN_ILS || kind == BOUGH_ACCELERATE_NEWTON;
}

typedef struct bough_accelerator_def {
    bough_acceleration kind;
    int n;             // components
    double relaxation; // ω in (0, 1], of Aitken and IQN-ILS in the first iteration
    // of Newton: x (n) ← (I − ∂H/∂u)⁻¹ x, as nearly as is known
    void (*solve)(void *self, double *x);
    void *self;
} bough_accelerator_def;

typedef struct bough_accelerator bough_accelerator;

// "none", "relaxation", "aitken", "iqn-ils", "interface-newton" in the order of the kinds, NULL-terminated.
extern const char *const bough_acceleration_names[];

// Takes all memory from the arena; iterating takes none.
bough_accelerator *bough_accelerator_create(bough_arena *arena, const bough_accelerator_def *def);

// Begins a new problem, without the differences so far.
void bough_accelerator_start(bough_accelerator *a);

// Takes an evaluation, image = H(u), and returns the norm of its residual.
double bough_accelerator_take(bough_accelerator *a, const double *u, const double *image);

// Whether the iteration diverges: the residual is not finite or too large.
bool bough_accelerator_diverges(const bough_accelerator *a);

// Mean factor by which an iteration changed the residual, over the last few; 1 before the second.
double bough_accelerator_contraction(const bough_accelerator *a);

// u: the next iterate in place of the one taken.
void bough_accelerator_next(bough_accelerator *a, double *u);

// The contract of a model: a rod, a modal body, the tree, a mass, or all of them connected.
//
// A system is an ordinary differential equation with ports,
//     ẏ = f(t, y, u),   o = h(t, y, u),
// which provides f, h, their tangents and the solution of (I − γ ∂f/∂y) x = b. It has no current time
// and state, no integrator and no factors: these belong to the caller. The result of a call does not
// depend on earlier calls.
#pragma once

#include "core/base/arena.h"

// One evaluation of f and h together.
typedef struct bough_evaluation {
    double t;            // [s]
    const double *input; // (n_input)
    double *rate;        // (n_state) f
    double *output;      // (n_output) h; NULL: not needed
} bough_evaluation;

typedef struct bough_system_ops {
    // f: rate (n_state). False when the value is not finite.
    bool (*derivative)(void *self, double t, const double *state, const double *input, double *rate);

    // h: output (n_output). NULL, as the next two, of a system without ports.
    void (*output)(void *self, double t, const double *state, const double *input, double *output);

    // ∂h/∂y·state_rate + ∂h/∂u·input_rate: output_rate (n_output). Either rate may be NULL for 0.
    void (*output_tangent)(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *output_rate);

    // ∂f/∂u: column (n_input × n_state), column j = ∂f/∂u_j as row j of the array.
    void (*input_columns)(void *self, double t, const double *state, const double *input, double *column);

    // Memory for one linearisation and its factors in the arena. It belongs to the caller: no
    // other call changes it.
    void *(*factors)(void *self, bough_arena *arena);

    // Linearises f about (t, state, input). False when the tangents are not finite.
    bool (*linearise)(void *self, double t, const double *state, const double *input, void *factors);

    // Factors I − γ ∂f/∂y of the last linearisation. False when singular.
    bool (*factor)(void *self, void *factors, double gamma);

    // Solves with the last factors, in place: x (n_state).
    void (*solve)(void *self, void *factors, double *x);

    // -- optional: may be NULL ------------------------------------------------------------------

    // f and h of one state at n times and inputs; cheaper than one call for each. False when a rate is not
    // finite. The first is as from derivative and output; in the others a system may neglect some of the
    // change of its inner forces with time, and documents what.
    bool (*evaluate)(void *self, const double *state, int n, const bough_evaluation *at);

    // ∂h/∂t: drift (n_output). NULL: 0.
    void (*output_drift)(void *self, double t, const double *state, const double *input, double *drift);

    // As output_tangent at the point where `factors` were last linearised, computed from what they store.
    // False when they do not store it.
    bool (*kept_tangent)(void *self, const void *factors, const double *state_rate, const double *input_rate,
                         double *output_rate);

    // As linearise without input; members whose tangents may be ahead are linearised at `ahead` (n_state).
    // `keep`: members with kept_tangent keep their tangents, and for the same γ their factors.
    bool (*linearise_ahead)(void *self, double t, const double *state, const double *ahead, bool keep,
                            void *factors);

    // Projects a state that was integrated to t onto its constraints: prescribed motions, quaternions
    // of length 1. True when the change is so large that a multistep method must restart.
    bool (*constrain)(void *self, double t, double *state);

    // Removes from a tangent x (n_state) at `state` the part that is not a motion: changes of a
    // quaternion's length.
    void (*project)(void *self, const double *state, double *x);
} bough_system_ops;

// The required operations, for static functions that have the names above.
#define BOUGH_SYSTEM_REQUIRED                                                                                \
    .derivative = derivative, .output = output, .output_tangent = output_tangent,                            \
    .input_columns = input_columns, .factors = factors, .linearise = linearise, .factor = factor,            \
    .solve = solve

typedef struct bough_system {
    const char *name; // as the scene names it, for messages
    const char *kind; // "tree", "rod", …
    int n_state, n_input, n_output;
    const double *scale;   // error scale of each state (n_state): tolerance = rtol · scale
    const double *initial; // (n_state) where a run starts
    double elastic_rate;   // greatest ratio of stiffness to viscosity of its flexible bodies [1/s]: infinite
                           // without damping, 0 where nothing deforms
    bool ahead; // its tangents may be taken at a state that it will have: open trees of rigid bodies
    const bough_system_ops *ops;
    void *self;
} bough_system;

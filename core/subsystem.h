// The contract that co-simulation sees: a rod, a modal body, the tree or a test oscillator.
//
// A subsystem is an ordinary differential equation with ports,
//     ẏ = f(t, y, u),   o = h(t, y, u),
// that can be asked for f, h, their tangents and the solution of (I − γ ∂f/∂y) x = b (model
// exchange), and that can integrate itself over a macro step by its own steps (co-simulation).
// It owns one current time and state; everything else is an argument.
#ifndef BOUGH_CORE_SUBSYSTEM_H
#define BOUGH_CORE_SUBSYSTEM_H

#include "core/arena.h"
#include "core/status.h"

#include <stdbool.h>
#include <stddef.h>

// A vector-valued cubic in time on [t0, t1]: value(t) = Σ_k coefficient[k*n + i] τᵏ,
// τ = (t − t0)/(t1 − t0), k = 0..3.
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

// Work done so far, for the summary.
typedef struct bough_statistics {
    long steps, failed_steps, derivatives, jacobians, factorisations, iterations, restarts;
} bough_statistics;

static inline void bough_statistics_add(bough_statistics *sum, const bough_statistics *part) {
    sum->steps += part->steps;
    sum->failed_steps += part->failed_steps;
    sum->derivatives += part->derivatives;
    sum->jacobians += part->jacobians;
    sum->factorisations += part->factorisations;
    sum->iterations += part->iterations;
    sum->restarts += part->restarts;
}

static inline void bough_statistics_subtract(bough_statistics *from, const bough_statistics *part) {
    from->steps -= part->steps;
    from->failed_steps -= part->failed_steps;
    from->derivatives -= part->derivatives;
    from->jacobians -= part->jacobians;
    from->factorisations -= part->factorisations;
    from->iterations -= part->iterations;
    from->restarts -= part->restarts;
}

typedef struct bough_subsystem_ops {
    // -- model exchange: no effect on the current time and state ------------------------------

    // f: rate (n_state). False when it has no finite value there.
    bool (*derivative)(void *self, double t, const double *state, const double *input,
                       double *rate);

    // f at another time and input, the state being that of the last call of derivative, between which
    // and this one only outputs were asked for: may be cheaper. NULL: it is not.
    bool (*derivative_again)(void *self, double t, const double *state, const double *input,
                             double *rate);

    // h: output (n_output).
    void (*output)(void *self, double t, const double *state, const double *input, double *output);

    // ∂h/∂y·state_rate + ∂h/∂u·input_rate: output_rate (n_output). Either rate may be NULL for 0.
    void (*output_tangent)(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate,
                           double *output_rate);

    // ∂h/∂t: drift (n_output). NULL: 0.
    void (*output_drift)(void *self, double t, const double *state, const double *input,
                         double *drift);

    // ∂f/∂u: column (n_input × n_state), column j = ∂f/∂u_j as row j of the array.
    void (*input_columns)(void *self, double t, const double *state, const double *input,
                          double *column);

    // Memory of one linearisation and its factors in the arena; NULL when that is exhausted. They
    // belong to who asks: others' steps, evaluations and factors leave them alone.
    void *(*factors)(void *self, bough_arena *arena);

    // Linearises f about (t, state, input). False when the tangents are not finite.
    bool (*linearise)(void *self, double t, const double *state, const double *input,
                      void *factors);

    // Factors I − γ ∂f/∂y of the last linearisation. False when singular.
    bool (*factor)(void *self, void *factors, double gamma);

    // Solves with the last factors, in place: x (n_state).
    void (*solve)(void *self, void *factors, double *x);

    // -- co-simulation ------------------------------------------------------------------------

    // Integrates the current state to t1 by own steps under input(t), which covers [time, t1].
    // `restart` says that the input or a load jumped at the current time: a multistep solver
    // starts anew. On failure the state is undefined until `restore` or `set_state`.
    bough_status (*advance)(void *self, double t1, const bough_signal *input, bool restart);

    // The complete state, the integrator's included as far as it can be kept; a copy restored
    // twice and advanced twice gives the same bits.
    size_t (*save_size)(void *self);
    void (*save)(void *self, void *copy);
    void (*restore)(void *self, const void *copy);

    // Replaces the current time and state (n_state); the integrator starts anew.
    void (*set_state)(void *self, double t, const double *state);

    void (*statistics)(void *self, bough_statistics *sum);

    // Takes out of a tangent x (n_state) at `state` what is no motion: changes of a quaternion's
    // length. NULL: there is nothing such.
    void (*project)(void *self, const double *state, double *x);

    // As `advance`, but may stop on the way, at the first of its own steps' ends at or after `pause`:
    // the current time tells. `advance` to t1 under the same input, without restart, then goes on to
    // the bits of an advance in one go. NULL: cannot.
    bough_status (*advance_part)(void *self, double pause, double t1, const bough_signal *input,
                                 bool restart);
} bough_subsystem_ops;

typedef struct bough_subsystem {
    const char *name;         // as the scene names it, for messages
    const char *kind;         // "tree", "rod", …
    const char *solver;       // the scheme of its own steps, for messages: "IDA", "CVODE BDF", …
    int n_state, n_input, n_output;
    const double *scale;      // error scale of each state (n_state): tolerance = rtol · scale
    const double *time;       // current time [s]
    const double *state;      // current state (n_state)
    double *own_error;        // (n_state) what its own steps have erred by, by their estimate, since
                              // a reader last set it to zero; NULL: it does not tell
    const bough_subsystem_ops *ops;
    void *self;
} bough_subsystem;

#endif

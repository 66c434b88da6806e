// What every subsystem must fulfil, checked at a time, state and input where f is smooth. `tolerance`
// is relative to the largest entry of what is compared; 1e-5 suits central differences.
#ifndef BOUGH_TESTS_CONTRACT_H
#define BOUGH_TESTS_CONTRACT_H

#include "core/subsystem.h"
#include "tests/check.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct contract_point {
    double t;            // [s]
    const double *state; // (n_state)
    const double *input; // (n_input)
    double tolerance;
} contract_point;

static inline double *contract_doubles(int n) {
    double *x = calloc((size_t)(n > 0 ? n : 1), sizeof *x);
    assert_non_null(x);
    return x;
}

static inline double contract_largest(const double *x, int n) {
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(x[i]));
    return largest;
}

static inline void contract_near(const double *value, const double *expected, int n,
                                 double tolerance, const char *what) {
    double allowed = tolerance * (contract_largest(expected, n) + 1e-30);
    for (int i = 0; i < n; i++) {
        if (fabs(value[i] - expected[i]) <= allowed) continue;
        fail_msg("%s[%d] = %.12g, expected %.12g", what, i, value[i], expected[i]);
    }
}

// A direction that touches every component, in its own scale; the same at each call.
static inline void contract_direction(const double *scale, int n, int seed, double *x) {
    for (int i = 0; i < n; i++) x[i] = (scale ? scale[i] : 1) * sin(1.7 * i + 0.6 * seed + 0.3);
}

static inline void contract_shifted(const double *x, double factor, const double *direction, int n,
                                    double *shifted) {
    for (int i = 0; i < n; i++) shifted[i] = x[i] + factor * direction[i];
}

// Which of f and h a difference quotient is taken of.
typedef enum contract_function { CONTRACT_RATE, CONTRACT_OUTPUT } contract_function;

static inline void contract_evaluate(const bough_subsystem *s, contract_function f, double t,
                                     const double *state, const double *input, double *value) {
    if (f == CONTRACT_OUTPUT) {
        s->ops->output(s->self, t, state, input, value);
    } else {
        assert_true(s->ops->derivative(s->self, t, state, input, value));
    }
}

// Central difference along (dy, du); either may be NULL.
static inline void contract_difference(const bough_subsystem *s, contract_point at,
                                       contract_function f, const double *dy, const double *du,
                                       double *slope) {
    const double step = 1e-6;
    int n = f == CONTRACT_OUTPUT ? s->n_output : s->n_state;
    double *y = contract_doubles(s->n_state), *u = contract_doubles(s->n_input);
    double *back = contract_doubles(n);
    memcpy(y, at.state, (size_t)s->n_state * sizeof *y);
    memcpy(u, at.input, (size_t)s->n_input * sizeof *u);
    if (dy) contract_shifted(at.state, -step, dy, s->n_state, y);
    if (du) contract_shifted(at.input, -step, du, s->n_input, u);
    contract_evaluate(s, f, at.t, y, u, back);
    if (dy) contract_shifted(at.state, step, dy, s->n_state, y);
    if (du) contract_shifted(at.input, step, du, s->n_input, u);
    contract_evaluate(s, f, at.t, y, u, slope);
    for (int i = 0; i < n; i++) slope[i] = (slope[i] - back[i]) / (2 * step);
    free(y), free(u), free(back);
}

// output_tangent against differences of output, along state and input, together and apart.
static inline void contract_output_tangent(const bough_subsystem *s, contract_point at) {
    double *dy = contract_doubles(s->n_state), *du = contract_doubles(s->n_input);
    double *slope = contract_doubles(s->n_output), *tangent = contract_doubles(s->n_output);
    for (int which = 1; which < 4; which++) {
        contract_direction(s->scale, s->n_state, which, dy);
        contract_direction(NULL, s->n_input, which, du);
        const double *y = which & 1 ? dy : NULL, *u = which & 2 ? du : NULL;
        contract_difference(s, at, CONTRACT_OUTPUT, y, u, slope);
        s->ops->output_tangent(s->self, at.t, at.state, at.input, y, u, tangent);
        contract_near(tangent, slope, s->n_output, at.tolerance, "output_tangent");
    }
    free(dy), free(du), free(slope), free(tangent);
}

// input_columns against differences of derivative.
static inline void contract_input_columns(const bough_subsystem *s, contract_point at) {
    double *column = contract_doubles(s->n_input * s->n_state), *du = contract_doubles(s->n_input);
    double *slope = contract_doubles(s->n_state);
    s->ops->input_columns(s->self, at.t, at.state, at.input, column);
    for (int j = 0; j < s->n_input; j++) {
        du[j] = 1;
        contract_difference(s, at, CONTRACT_RATE, NULL, du, slope);
        du[j] = 0;
        contract_near(column + j * s->n_state, slope, s->n_state, at.tolerance, "input_columns");
    }
    free(column), free(du), free(slope);
}

// Factors at the point with that γ, in the arena.
static inline void *contract_factors(const bough_subsystem *s, contract_point at, double gamma,
                                     bough_arena *arena) {
    void *factors = s->ops->factors(s->self, arena);
    assert_non_null(factors);
    assert_true(s->ops->linearise(s->self, at.t, at.state, at.input, factors));
    assert_true(s->ops->factor(s->self, factors, gamma));
    return factors;
}

// solve undoes x − γ ∂f/∂y x, the product by differences; with another γ of the same linearisation
// too, and while others hold factors of their own.
static inline void contract_newton(const bough_subsystem *s, contract_point at, double gamma) {
    int n = s->n_state;
    double *x = contract_doubles(n), *slope = contract_doubles(n), *solved = contract_doubles(n);
    bough_arena *arena = bough_arena_create();
    void *factors = contract_factors(s, at, 3 * gamma, arena);
    contract_factors(s, at, 7 * gamma, arena); // another's
    for (int seed = 1; seed < 4; seed++) {
        double own = seed == 1 ? 3 * gamma : gamma;
        if (seed == 2) assert_true(s->ops->factor(s->self, factors, gamma));
        contract_direction(s->scale, n, seed, x);
        contract_difference(s, at, CONTRACT_RATE, x, NULL, slope);
        for (int i = 0; i < n; i++) solved[i] = x[i] - own * slope[i];
        s->ops->solve(s->self, factors, solved);
        contract_near(solved, x, n, at.tolerance, "solve");
    }
    free(x), free(slope), free(solved);
    bough_arena_destroy(arena);
}

// Two constant pieces of input; `restart` is what the first is told, the second keeps the history.
static inline void contract_run(const bough_subsystem *s, contract_point at, double length,
                                bool restart) {
    double *coefficient = contract_doubles(4 * s->n_input);
    memcpy(coefficient, at.input, (size_t)s->n_input * sizeof(double));
    for (int piece = 0; piece < 2; piece++) {
        double t0 = *s->time;
        bough_signal input = {s->n_input, t0, t0 + length, coefficient};
        bough_status status = s->ops->advance(s->self, input.t1, &input, restart && piece == 0);
        if (!bough_is_ok(&status)) fail_msg("%s", status.message);
        check_near(*s->time, input.t1, 0, 0);
    }
    free(coefficient);
}

// A copy restored twice and advanced twice gives the same bits, and the model-exchange operations in
// between disturb nothing. Without a restart too: the integrator's history is not that of the copy,
// and who restores need not say so.
static inline void contract_save_restore(const bough_subsystem *s, contract_point at,
                                         double length, bool restart) {
    size_t n = (size_t)s->n_state * sizeof(double);
    void *copy = malloc(s->ops->save_size(s->self));
    double *first = contract_doubles(s->n_state), *work = contract_doubles(s->n_state);
    assert_non_null(copy);
    s->ops->set_state(s->self, at.t, at.state);
    contract_run(s, at, length, restart);
    s->ops->save(s->self, copy);
    double t = *s->time;
    contract_run(s, at, length, restart);
    s->ops->restore(s->self, copy);
    check_near(*s->time, t, 0, 0);
    contract_run(s, at, length, restart);
    memcpy(first, s->state, n);
    s->ops->restore(s->self, copy);
    bough_arena *arena = bough_arena_create();
    void *factors = contract_factors(s, at, length, arena);
    contract_evaluate(s, CONTRACT_RATE, at.t, at.state, at.input, work);
    s->ops->solve(s->self, factors, work);
    bough_arena_destroy(arena);
    contract_run(s, at, length, restart);
    assert_memory_equal(first, s->state, n);
    free(copy), free(first), free(work);
}

// set_state replaces time and state; a short advance then follows f.
static inline void contract_set_state(const bough_subsystem *s, contract_point at, double length) {
    int n = s->n_state;
    double *rate = contract_doubles(n), *moved = contract_doubles(n);
    double *coefficient = contract_doubles(4 * s->n_input);
    memcpy(coefficient, at.input, (size_t)s->n_input * sizeof(double));
    s->ops->set_state(s->self, at.t, at.state);
    check_near(*s->time, at.t, 0, 0);
    assert_memory_equal(s->state, at.state, (size_t)n * sizeof(double));
    contract_evaluate(s, CONTRACT_RATE, at.t, at.state, at.input, rate);
    bough_signal input = {s->n_input, at.t, at.t + length, coefficient};
    bough_status status = s->ops->advance(s->self, at.t + length, &input, true);
    if (!bough_is_ok(&status)) fail_msg("%s", status.message);
    for (int i = 0; i < n; i++) moved[i] = (s->state[i] - at.state[i]) / length;
    contract_near(moved, rate, n, 0.05, "advance over a short time / derivative");
    free(rate), free(moved), free(coefficient);
}

// A pause on the way changes no bit.
static inline void contract_pause(const bough_subsystem *s, contract_point at, double length) {
    if (s->ops->advance_part == NULL) return;
    size_t n = (size_t)s->n_state * sizeof(double);
    double *whole = contract_doubles(s->n_state);
    double *coefficient = contract_doubles(4 * s->n_input);
    memcpy(coefficient, at.input, (size_t)s->n_input * sizeof(double));
    for (int run = 0; run < 2; run++) {
        bough_signal input = {s->n_input, at.t, at.t + length, coefficient};
        double pause = at.t + 0.4 * length;
        bough_status status = bough_ok();
        s->ops->set_state(s->self, at.t, at.state);
        if (run == 1) {
            status = s->ops->advance_part(s->self, pause, input.t1, &input, true);
            assert_true(*s->time >= pause && *s->time <= input.t1);
        }
        if (bough_is_ok(&status) && *s->time < input.t1) {
            status = s->ops->advance(s->self, input.t1, &input, run == 0);
        }
        if (!bough_is_ok(&status)) fail_msg("%s", status.message);
        check_near(*s->time, input.t1, 0, 0);
        if (run == 0) memcpy(whole, s->state, n);
    }
    assert_memory_equal(whole, s->state, n);
    free(whole), free(coefficient);
}

// Everything; `gamma` for the Newton matrix and `length` of an advance [s]. contract_set_state is
// left to the caller, who knows a length short against the fastest motion.
static inline void contract_check(const bough_subsystem *s, contract_point at, double gamma,
                                  double length) {
    contract_output_tangent(s, at);
    contract_input_columns(s, at);
    contract_newton(s, at, gamma);
    contract_save_restore(s, at, length, true);
    contract_save_restore(s, at, length, false);
    contract_pause(s, at, length);
}

#endif

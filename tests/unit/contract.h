// What every system and every member must fulfil, checked at a time, state and input where f is smooth.
// `tolerance` is relative to the largest entry of what is compared; 1e-5 suits central differences.
#pragma once

#include "cosim/member.h"
#include "tests/unit/member.h"

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

static inline void contract_near(const double *value, const double *expected, int n, double tolerance,
                                 const char *what) {
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

static inline void contract_evaluate(const bough_system *s, contract_function f, double t,
                                     const double *state, const double *input, double *value) {
    if (f == CONTRACT_OUTPUT) {
        s->ops->output(s->self, t, state, input, value);
    } else {
        assert_true(s->ops->derivative(s->self, t, state, input, value));
    }
}

// Central difference along (dy, du); either may be NULL.
static inline void contract_difference(const bough_system *s, contract_point at, contract_function f,
                                       const double *dy, const double *du, double *slope) {
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

// output_tangent against differences of output, along state and input, together and apart; what factors keep
// of it.
static inline void contract_output_tangent(const bough_system *s, contract_point at) {
    double *dy = contract_doubles(s->n_state), *du = contract_doubles(s->n_input);
    double *slope = contract_doubles(s->n_output), *tangent = contract_doubles(s->n_output);
    bough_arena *arena = bough_arena_create();
    void *factors = s->ops->factors(s->self, arena);
    assert_true(s->ops->linearise(s->self, at.t, at.state, at.input, factors));
    for (int which = 1; which < 4; which++) {
        contract_direction(s->scale, s->n_state, which, dy);
        contract_direction(NULL, s->n_input, which, du);
        const double *y = which & 1 ? dy : NULL, *u = which & 2 ? du : NULL;
        contract_difference(s, at, CONTRACT_OUTPUT, y, u, slope);
        s->ops->output_tangent(s->self, at.t, at.state, at.input, y, u, tangent);
        contract_near(tangent, slope, s->n_output, at.tolerance, "output_tangent");
        if (s->ops->kept_tangent && s->ops->kept_tangent(s->self, factors, y, u, slope)) {
            contract_near(slope, tangent, s->n_output, 1e-10, "kept_tangent");
        }
    }
    bough_arena_destroy(arena);
    free(dy), free(du), free(slope), free(tangent);
}

// input_columns against differences of derivative.
static inline void contract_input_columns(const bough_system *s, contract_point at) {
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
static inline void *contract_factors(const bough_system *s, contract_point at, double gamma,
                                     bough_arena *arena) {
    void *factors = s->ops->factors(s->self, arena);
    assert_non_null(factors);
    assert_true(s->ops->linearise(s->self, at.t, at.state, at.input, factors));
    assert_true(s->ops->factor(s->self, factors, gamma));
    return factors;
}

// solve undoes x − γ ∂f/∂y x, the product by differences; with another γ of the same linearisation
// too, and while others hold factors of their own.
static inline void contract_newton(const bough_system *s, contract_point at, double gamma) {
    int n = s->n_state;
    double *x = contract_doubles(n), *slope = contract_doubles(n), *solved = contract_doubles(n);
    check_arena(arena);
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
}

// Two constant pieces of input; `restart` is of the first, the second keeps the history.
static inline void contract_run(bough_member *m, contract_point at, double length, bool restart) {
    double *coefficient = contract_doubles(4 * m->system.n_input);
    memcpy(coefficient, at.input, (size_t)m->system.n_input * sizeof(double));
    for (int piece = 0; piece < 2; piece++) {
        double t0 = m->time;
        bough_signal input = {m->system.n_input, t0, t0 + length, coefficient};
        check_ok(bough_member_advance(m, input.t1, &input, restart && piece == 0));
        check_near(m->time, input.t1, 0, 0);
    }
    free(coefficient);
}

// A copy restored twice and advanced twice gives the same bits, and questions to the system in between
// disturb nothing. Without a restart too: the integrator's history is not that of the copy, and who
// restores need not say so.
static inline void contract_save_restore(bough_member *m, contract_point at, double length, bool restart) {
    const bough_system *s = &m->system;
    size_t n = (size_t)s->n_state * sizeof(double);
    check_arena(arena);
    double *first = contract_doubles(s->n_state), *work = contract_doubles(s->n_state);
    bough_member_set(m, at.t, at.state);
    contract_run(m, at, length, restart);
    char *copy = member_save(arena, m);
    double t = m->time;
    contract_run(m, at, length, restart);
    member_restore(m, copy);
    check_near(m->time, t, 0, 0);
    contract_run(m, at, length, restart);
    memcpy(first, m->state, n);
    contract_run(m, at, length, restart); // elsewhere: what the integrator keeps differs
    member_restore(m, copy);
    void *factors = contract_factors(s, at, length, arena);
    contract_evaluate(s, CONTRACT_RATE, at.t, at.state, at.input, work);
    s->ops->solve(s->self, factors, work);
    contract_run(m, at, length, restart);
    assert_memory_equal(first, m->state, n);
    free(first), free(work);
}

// Setting replaces time and state, but for rounding where it is constrained; a short advance then
// follows f.
static inline void contract_set_state(bough_member *m, contract_point at, double length) {
    const bough_system *s = &m->system;
    int n = s->n_state;
    double *rate = contract_doubles(n), *moved = contract_doubles(n);
    double *coefficient = contract_doubles(4 * s->n_input);
    memcpy(coefficient, at.input, (size_t)s->n_input * sizeof(double));
    bough_member_set(m, at.t, at.state);
    check_near(m->time, at.t, 0, 0);
    for (int i = 0; i < n; i++) check_near(m->state[i], at.state[i], 0, 1e-15);
    contract_evaluate(s, CONTRACT_RATE, at.t, at.state, at.input, rate);
    bough_signal input = {s->n_input, at.t, at.t + length, coefficient};
    check_ok(bough_member_advance(m, at.t + length, &input, true));
    for (int i = 0; i < n; i++) moved[i] = (m->state[i] - at.state[i]) / length;
    contract_near(moved, rate, n, 0.05, "advance over a short time / derivative");
    free(rate), free(moved), free(coefficient);
}

// What each operation returns at the point; the solution needs factors.
static const char *const contract_results[] = {"derivative",   "output", "output_tangent",
                                               "output_drift", "solve",  "input_columns"};
enum { CONTRACT_RESULTS = sizeof contract_results / sizeof *contract_results };

static inline int contract_result_size(const bough_system *s, int which) {
    const int n_drift = s->ops->output_drift ? s->n_output : 0;
    const int size[] = {s->n_state, s->n_output, s->n_output, n_drift, s->n_state, s->n_input * s->n_state};
    return size[which];
}

static inline void contract_result(const bough_system *s, contract_point at, double gamma, int which,
                                   void *factors, double *x) {
    const bough_system_ops *ops = s->ops;
    if (contract_result_size(s, which) == 0) return;
    double *dy = contract_doubles(s->n_state), *du = contract_doubles(s->n_input);
    contract_direction(s->scale, s->n_state, 1, dy);
    contract_direction(NULL, s->n_input, 1, du);
    switch (which) {
    case 0: assert_true(ops->derivative(s->self, at.t, at.state, at.input, x)); break;
    case 1: ops->output(s->self, at.t, at.state, at.input, x); break;
    case 2: ops->output_tangent(s->self, at.t, at.state, at.input, dy, du, x); break;
    case 3: ops->output_drift(s->self, at.t, at.state, at.input, x); break;
    case 4:
        assert_true(ops->linearise(s->self, at.t, at.state, at.input, factors));
        assert_true(ops->factor(s->self, factors, gamma));
        memcpy(x, dy, (size_t)s->n_state * sizeof *x);
        ops->solve(s->self, factors, x);
        break;
    default: ops->input_columns(s->self, at.t, at.state, at.input, x);
    }
    free(dy), free(du);
}

// No result depends on earlier calls: to the bit the same after a derivative and a linearisation at another
// time, state and input, and once factors from there are renewed.
static inline void contract_no_memory(const bough_system *s, contract_point at, double gamma) {
    int most = 1 + s->n_state + s->n_output + s->n_input * s->n_state;
    double *first = contract_doubles(most), *again = contract_doubles(most);
    double *y = contract_doubles(s->n_state), *u = contract_doubles(s->n_input);
    check_arena(arena);
    void *factors = s->ops->factors(s->self, arena), *others = s->ops->factors(s->self, arena);
    contract_direction(s->scale, s->n_state, 5, y);
    contract_direction(NULL, s->n_input, 5, u);
    contract_shifted(at.state, 1e-2, y, s->n_state, y);
    contract_shifted(at.input, 1e-2, u, s->n_input, u);
    contract_point elsewhere = {at.t + 0.37, y, u, at.tolerance};
    for (int which = 0; which < CONTRACT_RESULTS; which++) {
        contract_result(s, at, gamma, 0, factors, again);
        contract_result(s, at, gamma, which, factors, first);
        contract_result(s, elsewhere, gamma, 4, others, again);
        contract_result(s, elsewhere, gamma, 1, others, again);
        contract_result(s, elsewhere, gamma, 0, others, again);
        contract_result(s, at, gamma, which, factors, again);
        contract_near(again, first, contract_result_size(s, which), 0, contract_results[which]);
        assert_true(s->ops->factor(s->self, others, gamma)); // of elsewhere
        contract_result(s, at, gamma, which, factors, again);
        contract_near(again, first, contract_result_size(s, which), 0, contract_results[which]);
    }
    free(first), free(again), free(y), free(u);
}

// f and h evaluated together at two times are those of the single calls: at the first time to the bit, at the
// second but for less than a third of what time changes.
static inline void contract_evaluate_together(const bough_system *s, contract_point at) {
    if (s->ops->evaluate == NULL) return;
    const double t[2] = {at.t + 0.2, at.t};
    double *rate[2], *output[2], *expected[2], largest = 0;
    for (int k = 0; k < 2; k++) {
        rate[k] = contract_doubles(s->n_state);
        output[k] = contract_doubles(s->n_output);
        expected[k] = contract_doubles(s->n_state);
    }
    bough_evaluation both[2];
    for (int k = 0; k < 2; k++) both[k] = (bough_evaluation){t[k], at.input, rate[k], output[k]};
    assert_true(s->ops->evaluate(s->self, at.state, 2, both));
    for (int k = 0; k < 2; k++) contract_evaluate(s, CONTRACT_RATE, t[k], at.state, at.input, expected[k]);
    contract_near(rate[0], expected[0], s->n_state, 0, "rate of evaluate");
    for (int i = 0; i < s->n_state; i++) largest = fmax(largest, fabs(expected[0][i] - expected[1][i]));
    for (int i = 0; i < s->n_state; i++) check_near(rate[1][i], expected[1][i], 1e-12, 0.3 * largest);
    for (int k = 0; k < 2; k++) {
        contract_evaluate(s, CONTRACT_OUTPUT, t[k], at.state, at.input, expected[0]);
        contract_near(output[k], expected[0], s->n_output, at.tolerance, "output of evaluate");
        free(rate[k]), free(output[k]);
    }
    free(expected[0]), free(expected[1]);
}

// What needs no member.
static inline void contract_check_system(const bough_system *s, contract_point at, double gamma) {
    contract_no_memory(s, at, gamma);
    contract_evaluate_together(s, at);
    if (s->n_output > 0) contract_output_tangent(s, at);
    if (s->n_input > 0) contract_input_columns(s, at);
    contract_newton(s, at, gamma);
}

// Everything; `gamma` for the Newton matrix and `length` of an advance [s]. contract_set_state is
// left to the caller, who knows a length short against the fastest motion.
static inline void contract_check(bough_member *m, contract_point at, double gamma, double length) {
    contract_check_system(&m->system, at, gamma);
    contract_save_restore(m, at, length, true);
    contract_save_restore(m, at, length, false);
}

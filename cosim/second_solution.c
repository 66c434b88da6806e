#include "cosim/second_solution.h"

#include "cosim/coupled.h"

#include <math.h>
#include <string.h>

static const double most_steps = 20000; // a macro step on average: beyond it nobody would wait

struct bough_second_solution {
    const bough_assembly *assembly;
    bough_coupled *coupled;
    bough_integrator integrator;
    double share;
    double *scale, *state, *error; // (n_state)
    double *input_worst;           // (n_input) largest difference of an input
    bool started, lost;
    long taken; // macro steps
};

// -- the whole as one system ----------------------------------------------------------------------

static bool derivative(void *self, double t, const double *y, double *rate) {
    bough_second_solution *s = self;
    bough_status status = bough_coupled_rate(s->coupled, t, y, rate);
    return bough_is_ok(&status);
}

static bool derivative_again(void *self, double t, const double *y, double *rate) {
    bough_second_solution *s = self;
    bough_status status = bough_coupled_rate_again(s->coupled, t, y, rate);
    return bough_is_ok(&status);
}

static bool linearise(void *self, double t, const double *y) {
    bough_second_solution *s = self;
    bough_coupled_inputs(s->coupled, t, y);
    bough_status status = bough_coupled_linearise(s->coupled, t, y, s->coupled->input);
    return bough_is_ok(&status);
}

static bool factor(void *self, double gamma) {
    bough_second_solution *s = self;
    bough_status status = bough_coupled_factor(s->coupled, gamma);
    return bough_is_ok(&status);
}

static void solve(void *self, double *x) {
    bough_second_solution *s = self;
    bough_coupled_solve(s->coupled, x);
}

// -- building -------------------------------------------------------------------------------------

static void copy_states(const bough_assembly *a, double *state) {
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *m = &a->member[i]->system;
        memcpy(state + a->state_offset[i], a->member[i]->state, (size_t)m->n_state * sizeof *state);
    }
}

static bool take(bough_second_solution *s, bough_arena *arena) {
    size_t n = (size_t)s->assembly->n_state, n_input = (size_t)s->assembly->n_input;
    s->scale = bough_arena_doubles(arena, n);
    s->state = bough_arena_doubles(arena, n);
    s->error = bough_arena_doubles(arena, n);
    s->input_worst = bough_arena_doubles(arena, n_input);
    return !bough_arena_exhausted(arena);
}

bough_status bough_second_solution_create(bough_arena *arena, const bough_coupling *c,
                                          const bough_second_solution_def *def,
                                          bough_second_solution **second) {
    bough_second_solution *s = bough_arena_take(arena, sizeof *s);
    if (!s) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    const bough_assembly *a = s->assembly = c->assembly;
    s->share = def->share;
    if (!take(s, arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *m = &a->member[i]->system;
        memcpy(s->scale + a->state_offset[i], m->scale, (size_t)m->n_state * sizeof *s->scale);
    }
    copy_states(a, s->state);
    bough_status status = bough_coupled_create(arena, a, c->pool, &s->coupled);
    if (!bough_is_ok(&status)) return status;
    bough_ode ode = {.name = "second solution",
                     .n = a->n_state,
                     .scale = s->scale,
                     .self = s,
                     .derivative = derivative,
                     .derivative_again = derivative_again,
                     .linearise = linearise,
                     .factor = factor,
                     .solve = solve};
    bough_integrator_options options = {
        .kind = def->kind, .rtol = def->rtol, .step = def->step};
    *second = s;
    return bough_integrator_create(arena, &ode, &options, &s->integrator);
}

// -- stepping -------------------------------------------------------------------------------------

static bool works_too_hard(const bough_second_solution *s) {
    bough_statistics sum = {0};
    s->integrator.ops->statistics(s->integrator.self, &sum);
    return (double)(sum.steps + sum.failed_steps) > most_steps * (double)(s->taken + 1);
}

static void compare(bough_second_solution *s, const bough_coupling *c) {
    const bough_assembly *a = s->assembly;
    copy_states(a, s->error);
    for (int k = 0; k < a->n_state; k++) s->error[k] = s->share * (s->error[k] - s->state[k]);
    bough_coupled_inputs(s->coupled, c->t1, s->state);
    for (int j = 0; j < a->n_input; j++) {
        double difference = s->share * fabs(c->input[j] - s->coupled->input[j]);
        s->input_worst[j] = fmax(s->input_worst[j], difference);
    }
}

void bough_second_solution_step(bough_second_solution *s, const bough_coupling *c) {
    if (s->lost) return;
    bool restart = c->restart || !s->started;
    bough_status status = bough_integrator_advance(&s->integrator, c->t0, c->t1, restart, s->state);
    s->started = true;
    s->lost = !bough_is_ok(&status) || works_too_hard(s);
    s->taken++;
    if (!s->lost) compare(s, c);
}

const double *bough_second_solution_error(const bough_second_solution *s) {
    return s->lost ? NULL : s->error;
}

double bough_second_solution_input(const bough_second_solution *s, int j) {
    return s->lost ? (double)NAN : s->input_worst[j];
}

void bough_second_solution_snapshot(bough_second_solution *s, bough_snapshot *snapshot) {
    const bough_assembly *a = s->assembly;
    bough_snapshot_doubles(snapshot, s->state, a->n_state);
    bough_snapshot_doubles(snapshot, s->error, a->n_state);
    bough_snapshot_doubles(snapshot, s->input_worst, a->n_input);
    bough_snapshot_take(snapshot, &s->lost, sizeof s->lost);
    bough_snapshot_take(snapshot, &s->taken, sizeof s->taken);
    if (s->integrator.ops->transfer) s->integrator.ops->transfer(s->integrator.self, snapshot);
    if (snapshot->move == BOUGH_SNAPSHOT_RESTORE) s->started = false;
}

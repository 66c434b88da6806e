// All members in one system ẏ = F(t, y), coupled.h, integrated by one method across macro steps: no
// coupling error. With a one-step method the members are coupled at its stages, each of which costs
// a member what its own sub-solver would; with an implicit multistep method at a tight tolerance it
// is the reference of every error figure.
#include "core/integrator.h"
#include "cosim/coupled.h"
#include "cosim/port.h"
#include "cosim/scheme.h"

#include <string.h>

typedef struct monolith {
    bough_coupled *coupled;
    bough_integrator integrator;
    double *scale, *state; // (n_state)
    bool started;
} monolith;

static bool derivative(void *self, double t, const double *y, double *rate) {
    monolith *m = self;
    bough_status status = bough_coupled_rate(m->coupled, t, y, rate);
    return bough_is_ok(&status);
}

static bool derivative_again(void *self, double t, const double *y, double *rate) {
    monolith *m = self;
    bough_status status = bough_coupled_rate_again(m->coupled, t, y, rate);
    return bough_is_ok(&status);
}

static bool linearise(void *self, double t, const double *y) {
    monolith *m = self;
    bough_coupled_inputs(m->coupled, t, y);
    bough_status status = bough_coupled_linearise(m->coupled, t, y, m->coupled->input);
    return bough_is_ok(&status);
}

static bool factor(void *self, double gamma) {
    monolith *m = self;
    bough_status status = bough_coupled_factor(m->coupled, gamma);
    return bough_is_ok(&status);
}

static void solve(void *self, double *x) {
    monolith *m = self;
    bough_coupled_solve(m->coupled, x);
}

static bool take(monolith *m, bough_arena *arena, const bough_assembly *a) {
    size_t n = (size_t)a->n_state;
    m->scale = bough_arena_doubles(arena, n);
    m->state = bough_arena_doubles(arena, n);
    return !bough_arena_exhausted(arena);
}

static bough_status create(bough_coupling *c, bough_arena *arena) {
    const bough_assembly *a = c->assembly;
    monolith *m = bough_arena_take(arena, sizeof *m);
    if (!m || !take(m, arena, a)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    c->scheme_data = m;
    bough_status status = bough_coupled_create(arena, a, c->pool, &m->coupled);
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < a->n_member; i++) {
        size_t size = (size_t)a->member[i]->system.n_state * sizeof(double);
        memcpy(m->scale + a->state_offset[i], a->member[i]->system.scale, size);
    }
    bough_ode ode = {.name = "monolithic system",
                     .n = a->n_state,
                     .scale = m->scale,
                     .self = m,
                     .derivative = derivative,
                     .derivative_again = derivative_again,
                     .linearise = linearise,
                     .factor = factor,
                     .solve = solve};
    c->whole = &m->integrator;
    return bough_integrator_create(arena, &ode, &c->options.integrator, &m->integrator);
}

// The members' states as they are set: given motions in place, quaternions of length 1.
static void take_states(const bough_assembly *a, monolith *m) {
    for (int i = 0; i < a->n_member; i++) {
        size_t size = (size_t)a->member[i]->system.n_state * sizeof(double);
        memcpy(m->state + a->state_offset[i], a->member[i]->state, size);
    }
}

// The members' states are set, for queries; nobody's integrator runs but the scheme's.
static bough_status step(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    monolith *m = c->scheme_data;
    if (!m->started) take_states(a, m);
    bough_status status = bough_integrator_advance(&m->integrator, c->t0, c->t1,
                                                   !m->started || c->restart, m->state);
    m->started = bough_is_ok(&status);
    if (!m->started) return status;
    for (int i = 0; i < a->n_member; i++) {
        bough_member_set(a->member[i], c->t1, m->state + a->state_offset[i]);
    }
    take_states(a, m);
    bough_coupling_begin(c);
    bough_coupled_inputs(m->coupled, c->t1, m->state);
    for (int i = 0; i < a->n_member; i++) {
        int first = a->input_offset[i], count = a->member[i]->system.n_input;
        bough_port_linear(&c->signal[i], 0, count, c->input + first, m->coupled->input + first);
    }
    return bough_ok();
}

// Restored, it starts anew from the members' states, with what else the method remembers.
static void snapshot(bough_coupling *c, bough_snapshot *s) {
    monolith *m = c->scheme_data;
    if (m->integrator.ops->transfer) m->integrator.ops->transfer(m->integrator.self, s);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) m->started = false;
}

const bough_scheme bough_scheme_monolithic = {
    .name = "monolithic",
    .summary = "all bodies in one system, coupled at the stages of the master's method: no coupling "
               "error",
    .one_system = true,
    .create = create,
    .step = step,
    .snapshot = snapshot,
};

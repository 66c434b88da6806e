// Monolithic reference: the states of all members in one implicit system ẏ − F(t, y) = 0,
// integrated by the master integrator across macro steps; Newton's matrix is that of coupled.h.
// No coupling error: every error figure is measured against it.
#include "core/integrator_ida.h"
#include "cosim/coupled.h"
#include "cosim/port.h"
#include "cosim/scheme.h"

#include <string.h>

typedef struct monolith {
    bough_coupled *coupled;
    bough_ida *ida;
    double *scale, *state, *rate; // (n_state)
    double *f;                    // (n_state) rate of change at the evaluation's state
    double gamma;
    bool started;
} monolith;

static bool residual(void *self, double t, const double *y, const double *rate, double *result) {
    monolith *m = self;
    bough_status status = bough_coupled_rate(m->coupled, t, y, m->f);
    if (!bough_is_ok(&status)) return false;
    for (int k = 0; k < m->coupled->assembly->n_state; k++)
        result[k] = rate[k] - m->f[k];
    return true;
}

static bool setup(void *self, double t, const double *y, const double *rate, double cj) {
    (void)rate;
    monolith *m = self;
    m->gamma = 1 / cj;
    bough_coupled_inputs(m->coupled, t, y);
    bough_status status = bough_coupled_setup(m->coupled, t, y, m->coupled->input, m->gamma);
    return bough_is_ok(&status);
}

// (cj − J)⁻¹ x
static void solve(void *self, double *x) {
    monolith *m = self;
    for (int k = 0; k < m->coupled->assembly->n_state; k++)
        x[k] *= m->gamma;
    bough_coupled_solve(m->coupled, x);
}

static bool take(monolith *m, bough_arena *arena, size_t n) {
    m->scale = bough_arena_doubles(arena, n);
    m->state = bough_arena_doubles(arena, n);
    m->rate = bough_arena_doubles(arena, n);
    m->f = bough_arena_doubles(arena, n);
    return !bough_arena_exhausted(arena);
}

static bough_status create(bough_coupling *c, bough_arena *arena) {
    const bough_assembly *a = c->assembly;
    monolith *m = bough_arena_take(arena, sizeof *m);
    if (!m || !take(m, arena, (size_t)a->n_state)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    }
    c->scheme_data = m;
    bough_status status = bough_coupled_create(arena, a, c->pool, &m->coupled);
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < a->n_member; i++) {
        size_t size = (size_t)a->member[i]->n_state * sizeof(double);
        memcpy(m->scale + a->state_offset[i], a->member[i]->scale, size);
    }
    bough_dae dae = {.name = "monolithic system",
                     .n = a->n_state,
                     .self = m,
                     .residual = residual,
                     .setup = setup,
                     .solve = solve};
    return bough_ida_create(arena, &dae, m->scale, c->options.rtol, &m->ida);
}

static bough_status start(bough_coupling *c, monolith *m) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        size_t size = (size_t)a->member[i]->n_state * sizeof(double);
        memcpy(m->state + a->state_offset[i], a->member[i]->state, size);
    }
    bough_status status = bough_coupled_rate(m->coupled, c->t0, m->state, m->rate);
    if (!bough_is_ok(&status)) return status;
    m->started = true;
    return bough_ida_start(m->ida, c->t0, m->state, m->rate);
}

// The members' states are set, for queries; nobody's integrator runs but the master's.
static bough_status step(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    monolith *m = c->scheme_data;
    bough_status status = bough_ok();
    if (!m->started || c->restart) status = start(c, m);
    if (bough_is_ok(&status)) status = bough_ida_advance(m->ida, c->t1, m->state, m->rate);
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < a->n_member; i++) {
        const bough_subsystem *s = a->member[i];
        s->ops->set_state(s->self, c->t1, m->state + a->state_offset[i]);
    }
    bough_coupling_begin(c);
    bough_coupled_inputs(m->coupled, c->t1, m->state);
    for (int i = 0; i < a->n_member; i++) {
        int first = a->input_offset[i], count = a->member[i]->n_input;
        bough_port_linear(&c->signal[i], 0, count, c->input + first, m->coupled->input + first);
    }
    return bough_ok();
}

// The integrator hides its history: it starts anew from the members' states.
static void snapshot(bough_coupling *c, bough_snapshot *s) {
    monolith *m = c->scheme_data;
    if (s->move == BOUGH_SNAPSHOT_RESTORE) m->started = false;
}

const bough_scheme bough_scheme_monolithic = {
    .name = "monolithic",
    .summary = "all bodies in one implicit system: the reference, no coupling error",
    .one_system = true,
    .create = create,
    .step = step,
    .snapshot = snapshot,
};

#include "cosim/member.h"

// -- the system under its inputs, as an ODE for its integrator -------------------------------------

// A system without inputs may be advanced without a signal.
static const double *input_at(const bough_member *m, double t) {
    if (m->signal != NULL) bough_signal_value(m->signal, t, m->input);
    return m->input;
}

static bool derivative(void *self, double t, const double *y, double *rate) {
    const bough_member *m = self;
    if (m->stop && m->stop()) return false;
    return m->system.ops->derivative(m->system.self, t, y, input_at(m, t), rate);
}

// Rates at two times of one state.
static bool derivative_twice(void *self, const double t[2], const double *y, double *const rate[2]) {
    bough_member *m = self;
    if (m->stop && m->stop()) return false;
    memcpy(m->first_input, input_at(m, t[0]), (size_t)m->system.n_input * sizeof(double));
    const bough_evaluation at[2] = {{t[0], m->first_input, rate[0], NULL},
                                    {t[1], input_at(m, t[1]), rate[1], NULL}};
    return m->system.ops->evaluate(m->system.self, y, 2, at);
}

static bool linearise(void *self, double t, const double *y) {
    const bough_member *m = self;
    return m->system.ops->linearise(m->system.self, t, y, input_at(m, t), m->factors);
}

static bool linearise_ahead(void *self, double t, const double *y, const double *ahead, bool keep) {
    const bough_member *m = self;
    return m->system.ops->linearise_ahead(m->system.self, t, y, ahead, keep, m->factors);
}

static bool factor(void *self, double gamma) {
    const bough_member *m = self;
    return m->system.ops->factor(m->system.self, m->factors, gamma);
}

static void solve(void *self, double *x) {
    const bough_member *m = self;
    m->system.ops->solve(m->system.self, m->factors, x);
}

bough_status bough_member_create(bough_arena *arena, const bough_system *system, double start,
                                 const bough_integrator_options *options, bough_member *member) {
    bough_member *m = member;
    size_t n = (size_t)system->n_state;
    *m = (bough_member){.system = *system,
                        .solver = bough_integrator_find(options->kind)->title,
                        .state = bough_arena_doubles(arena, n),
                        .integrated = bough_arena_doubles(arena, n),
                        .input = bough_arena_doubles(arena, (size_t)system->n_input),
                        .first_input = bough_arena_doubles(arena, (size_t)system->n_input),
                        .factors = system->ops->factors(system->self, arena)};
    bough_member_set(m, start, system->initial);
    if (n == 0) return bough_ok();
    // the ODE and its integrator
    bool twice = system->ops->evaluate != NULL;
    bough_ode ode = {.name = system->name,
                     .n = system->n_state,
                     .scale = system->scale,
                     .self = m,
                     .derivative = derivative,
                     .derivative_twice = twice ? derivative_twice : NULL,
                     .linearise = linearise,
                     .linearise_ahead = system->ops->linearise_ahead ? linearise_ahead : NULL,
                     .factor = factor,
                     .solve = solve,
                     .elastic_rate = system->elastic_rate};
    return bough_integrator_create(arena, &ode, options, &m->integrator);
}

// -- own steps ------------------------------------------------------------------------------------

// Brings the state back to its constraints; true: by so much that the integrator starts anew.
static bool constrain(const bough_member *m) {
    if (m->system.ops->constrain == NULL) return false;
    return m->system.ops->constrain(m->system.self, m->time, m->state);
}

bough_status bough_member_advance(bough_member *m, double t1, const bough_signal *input, bool restart) {
    size_t size = (size_t)m->system.n_state * sizeof(double);
    double t = m->time;
    bough_status status = bough_ok();
    assert(t <= t1 && (input == NULL || input->n == m->system.n_input));
    m->signal = input;
    // its own steps, from a copy: a failure leaves the state as it is
    memcpy(m->integrated, m->state, size);
    if (m->integrator.ops != NULL) {
        status =
            m->integrator.ops->advance(m->integrator.self, &t, t1, restart || !m->started, m->integrated);
    }
    m->started = bough_is_ok(&status);
    if (!m->started) return status;
    m->time = t1;
    memcpy(m->state, m->integrated, size);
    // the integrator keeps its own state; a correction that is large starts it anew
    if (constrain(m)) m->started = false;
    return status;
}

bough_statistics bough_member_statistics(const bough_member *m) {
    bough_statistics sum = {0};
    if (m->integrator.ops != NULL) m->integrator.ops->statistics(m->integrator.self, &sum);
    return sum;
}

// -- state ----------------------------------------------------------------------------------------

void bough_member_set(bough_member *m, double t, const double *state) {
    m->time = t;
    memmove(m->state, state, (size_t)m->system.n_state * sizeof(double));
    constrain(m);
    m->started = false;
}

void bough_member_snapshot(bough_member *m, bough_snapshot *s) {
    const bough_integrator_ops *ops = m->integrator.ops;
    // without the method's own memory it starts anew
    bool kept = ops != NULL && ops->transfer != NULL, started = m->started && kept;
    BOUGH_SNAPSHOT(s, m->time, started);
    bough_snapshot_doubles(s, m->state, m->system.n_state);
    if (kept) ops->transfer(m->integrator.self, s);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) m->started = started;
}

// Monolithic reference: the states of all members in one implicit system F = ẏ − f(t, y, u(y)),
// integrated by the master integrator across macro steps. Newton matrices are solved by static
// condensation onto the inputs,
//     (I − γJ_i) δ_i = r_i + γ B_i δu_i,   δo_i = C_i δ_i + D_i δu_i,   δu = P δo,
// so each member is factored by itself and the interface system has the size of all inputs.
// No coupling error: every error figure is measured against it.
#include "core/integrator_ida.h"
#include "core/linalg.h"
#include "cosim/port.h"
#include "cosim/scheme.h"

#include <string.h>

typedef struct monolith {
    bough_coupling *coupling;
    bough_ida *ida;
    double *scale, *state, *rate;  // (n_state)
    double *output, *input;        // (n_output), (n_input)
    double *column;   // of each member (n_input × n_state): (I − γJ)⁻¹ γB, member after member
    double *response; // of each member (n_input × n_output): its outputs' change with its inputs
    size_t *column_offset, *response_offset; // (n_member) where they begin
    double *matrix;   // (n_input × n_input, column-major) interface
    double *change;   // (n_input) increments of the inputs
    double *output_change; // (n_output)
    int *pivot;       // (n_input)
    double gamma, time;
    const double *at;     // (n_state) the state of the current evaluation
    double *f;            // (n_state) rate of change there
    double *setup_state;  // (n_state) where the Newton matrix was taken
    double *setup_input;  // (n_input)
    double setup_time;    // [s]
    double *x;            // (n_state) right side of the current solution
    bool started;
} monolith;

// -- evaluation -----------------------------------------------------------------------------------

static void find_inputs(monolith *m, double t, const double *state) {
    const bough_assembly *a = m->coupling->assembly;
    for (int n = 0; n < a->n_member; n++) {
        int i = a->order[n];
        const bough_subsystem *s = a->member[i];
        bough_assembly_gather(a, i, m->output, m->input);
        s->ops->output(s->self, t, state + a->state_offset[i], m->input + a->input_offset[i],
                       m->output + a->output_offset[i]);
    }
    for (int i = 0; i < a->n_member; i++) bough_assembly_gather(a, i, m->output, m->input);
}

static void evaluate(bough_coupling *c, int i) {
    const bough_assembly *a = c->assembly;
    const monolith *m = c->scheme_data;
    const bough_subsystem *s = a->member[i];
    if (!s->ops->derivative(s->self, m->time, m->at + a->state_offset[i],
                            m->input + a->input_offset[i], m->f + a->state_offset[i])) {
        c->status[i] = bough_coupling_not_finite(c, i);
    }
}

// m->f = f at (t, state)
static bool find_rate(monolith *m, double t, const double *state) {
    find_inputs(m, t, state);
    m->time = t;
    m->at = state;
    bough_status status = bough_coupling_each(m->coupling, BOUGH_ALL_STAGES, evaluate);
    return bough_is_ok(&status);
}

static bool residual(void *self, double t, const double *y, const double *rate, double *result) {
    monolith *m = self;
    if (!find_rate(m, t, y)) return false;
    for (int k = 0; k < m->coupling->assembly->n_state; k++) result[k] = rate[k] - m->f[k];
    return true;
}

// -- Newton matrix --------------------------------------------------------------------------------

static void factor(bough_coupling *c, int i) {
    const bough_assembly *a = c->assembly;
    const monolith *m = c->scheme_data;
    const bough_subsystem *s = a->member[i];
    const double *state = m->at + a->state_offset[i];
    const double *input = m->input + a->input_offset[i];
    double *column = m->column + m->column_offset[i];
    double *response = m->response + m->response_offset[i];
    double *unit = c->seen + a->input_offset[i];
    if (!s->ops->newton_setup(s->self, m->time, state, input, m->gamma)) {
        c->status[i] = bough_fail(BOUGH_RETRY, "%s: singular Newton matrix", s->name);
        return;
    }
    s->ops->input_columns(s->self, m->time, state, input, column);
    memset(unit, 0, (size_t)s->n_input * sizeof(double));
    for (int j = 0; j < s->n_input; j++, column += s->n_state, response += s->n_output) {
        for (int k = 0; k < s->n_state; k++) column[k] *= m->gamma;
        s->ops->newton_solve(s->self, column);
        unit[j] = 1;
        s->ops->output_tangent(s->self, m->time, state, input, column, unit, response);
        unit[j] = 0;
    }
}

// matrix = I − P · response
static void assemble_interface(monolith *m) {
    const bough_assembly *a = m->coupling->assembly;
    int n = a->n_input;
    memset(m->matrix, 0, (size_t)n * (size_t)n * sizeof(double));
    for (int row = 0; row < n; row++) {
        int from = a->source_member[row], p = a->source[row] - a->output_offset[from];
        const double *response = m->response + m->response_offset[from];
        m->matrix[row * n + row] = 1;
        for (int j = 0; j < a->member[from]->n_input; j++) {
            int column = a->input_offset[from] + j;
            m->matrix[column * n + row] -= response[j * a->member[from]->n_output + p];
        }
    }
}

static bool setup(void *self, double t, const double *y, const double *rate, double cj) {
    (void)rate;
    monolith *m = self;
    find_inputs(m, t, y);
    m->time = m->setup_time = t;
    m->at = m->setup_state;
    memcpy(m->setup_state, y, (size_t)m->coupling->assembly->n_state * sizeof(double));
    memcpy(m->setup_input, m->input, (size_t)m->coupling->assembly->n_input * sizeof(double));
    m->gamma = 1 / cj;
    bough_status status = bough_coupling_each(m->coupling, BOUGH_ALL_STAGES, factor);
    if (!bough_is_ok(&status)) return false;
    assemble_interface(m);
    int n = m->coupling->assembly->n_input;
    return n == 0 || bough_dense_factor(n, m->matrix, m->pivot);
}

// x_i = (I − γJ_i)⁻¹ r_i / cj and the outputs' change with it, the inputs held
static void solve_alone(bough_coupling *c, int i) {
    const bough_assembly *a = c->assembly;
    const monolith *m = c->scheme_data;
    const bough_subsystem *s = a->member[i];
    double *x = m->x + a->state_offset[i];
    for (int k = 0; k < s->n_state; k++) x[k] *= m->gamma;
    s->ops->newton_solve(s->self, x);
    s->ops->output_tangent(s->self, m->setup_time, m->setup_state + a->state_offset[i],
                           m->setup_input + a->input_offset[i], x, NULL,
                           m->output_change + a->output_offset[i]);
}

static void add_interface(bough_coupling *c, int i) {
    const bough_assembly *a = c->assembly;
    const monolith *m = c->scheme_data;
    const double *column = m->column + m->column_offset[i];
    double *x = m->x + a->state_offset[i];
    int n = a->member[i]->n_state;
    for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++, column += n) {
        for (int k = 0; k < n; k++) x[k] += m->change[j] * column[k];
    }
}

static void solve(void *self, double *x) {
    monolith *m = self;
    bough_coupling *c = m->coupling;
    m->x = x;
    bough_coupling_each(c, BOUGH_ALL_STAGES, solve_alone);
    int n = c->assembly->n_input;
    for (int j = 0; j < n; j++) m->change[j] = m->output_change[c->assembly->source[j]];
    if (n > 0) bough_dense_solve(n, 1, m->matrix, m->pivot, m->change);
    bough_coupling_each(c, BOUGH_ALL_STAGES, add_interface);
}

// -- the scheme -----------------------------------------------------------------------------------

static bool take(monolith *m, bough_arena *arena) {
    const bough_assembly *a = m->coupling->assembly;
    size_t n = (size_t)a->n_state, n_input = (size_t)a->n_input, n_output = (size_t)a->n_output;
    m->column_offset = bough_arena_take(arena, (size_t)a->n_member * sizeof(size_t));
    m->response_offset = bough_arena_take(arena, (size_t)a->n_member * sizeof(size_t));
    if (bough_arena_exhausted(arena)) return false;
    size_t columns = 0, responses = 0;
    for (int i = 0; i < a->n_member; i++) {
        const bough_subsystem *s = a->member[i];
        m->column_offset[i] = columns;
        m->response_offset[i] = responses;
        columns += (size_t)s->n_input * (size_t)s->n_state;
        responses += (size_t)s->n_input * (size_t)s->n_output;
    }
    m->column = bough_arena_doubles(arena, columns);
    m->response = bough_arena_doubles(arena, responses);
    m->scale = bough_arena_doubles(arena, n);
    m->state = bough_arena_doubles(arena, n);
    m->rate = bough_arena_doubles(arena, n);
    m->f = bough_arena_doubles(arena, n);
    m->setup_state = bough_arena_doubles(arena, n);
    m->setup_input = bough_arena_doubles(arena, n_input);
    m->input = bough_arena_doubles(arena, n_input);
    m->change = bough_arena_doubles(arena, n_input);
    m->output = bough_arena_doubles(arena, n_output);
    m->output_change = bough_arena_doubles(arena, n_output);
    m->matrix = bough_arena_doubles(arena, n_input * n_input);
    m->pivot = bough_arena_take(arena, n_input * sizeof(int));
    return !bough_arena_exhausted(arena);
}

static bough_status create(bough_coupling *c, bough_arena *arena) {
    const bough_assembly *a = c->assembly;
    monolith *m = bough_arena_take(arena, sizeof *m);
    if (!m) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    m->coupling = c;
    c->scheme_data = m;
    if (!take(m, arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
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
    if (!find_rate(m, c->t0, m->state)) {
        return bough_coupling_not_finite(c, c->failed_member);
    }
    memcpy(m->rate, m->f, (size_t)a->n_state * sizeof(double));
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
    find_inputs(m, c->t1, m->state);
    for (int i = 0; i < a->n_member; i++) {
        int first = a->input_offset[i], count = a->member[i]->n_input;
        bough_port_linear(&c->signal[i], 0, count, c->input + first, m->input + first);
    }
    return bough_ok();
}

const bough_scheme bough_scheme_monolithic = {
    .name = "monolithic",
    .summary = "all bodies in one implicit system: the reference, no coupling error",
    .create = create,
    .step = step,
};

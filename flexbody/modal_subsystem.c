#include "flexbody/modal_subsystem.h"

#include <string.h>

struct bough_modal_body {
    const bough_modal_model *model;
    bough_rod_loads loads;
    double time, *state; // (n_state)
    double *scale;       // (n_state)
    bool moved;          // the state was set from outside: the integrator starts anew
    const bough_signal *input; // of the step in progress
    double *vertices;    // (13 n) computed on request
    double *work;        // rates of a tangent (n_state)
    bough_modal_chain chain;
    bough_modal_chain slopes;        // of tangents
    bough_modal_newton micro_newton; // of the sub-solver
    bough_integrator micro;
};

// -- the sub-solver's view ------------------------------------------------------------------------

static bool micro_derivative(void *self, double t, const double *y, double *rate) {
    bough_modal_body *b = self;
    double input[BOUGH_ROD_INPUTS];
    bough_signal_value(b->input, t, input);
    return bough_modal_derivative(b->model, &b->loads, t, y, input, &b->chain, rate);
}

static bool micro_linearise(void *self, double t, const double *y) {
    bough_modal_body *b = self;
    double input[BOUGH_ROD_INPUTS];
    bough_signal_value(b->input, t, input);
    return bough_modal_linearise(b->model, &b->loads, t, y, input, &b->slopes, &b->micro_newton);
}

static bool micro_factor(void *self, double gamma) {
    bough_modal_body *b = self;
    return bough_modal_factor(b->model, &b->micro_newton, gamma);
}

static void micro_solve(void *self, double *x) {
    bough_modal_body *b = self;
    bough_modal_solve(b->model, &b->micro_newton, x);
}

// -- the contract ---------------------------------------------------------------------------------

static bool derivative(void *self, double t, const double *state, const double *input,
                       double *rate) {
    bough_modal_body *b = self;
    return bough_modal_derivative(b->model, &b->loads, t, state, input, &b->chain, rate);
}

static void output(void *self, double t, const double *state, const double *input,
                   double *wrench) {
    bough_modal_body *b = self;
    bough_modal_root_wrench(b->model, &b->loads, t, state, input, &b->chain, wrench);
}

static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    bough_modal_body *b = self;
    bough_modal_chain_slopes(b->model, &b->loads, t, state, input, &b->slopes);
    bough_modal_tangent(b->model, &b->slopes, state_rate, input_rate, b->work, rate);
}

static void input_columns(void *self, double t, const double *state, const double *input,
                          double *column) {
    bough_modal_body *b = self;
    bough_modal_chain_slopes(b->model, &b->loads, t, state, input, &b->slopes);
    for (int j = 0; j < BOUGH_ROD_INPUTS; j++) {
        double unit[BOUGH_ROD_INPUTS] = {0}, wrench[BOUGH_ROD_OUTPUTS];
        unit[j] = 1;
        bough_modal_tangent(b->model, &b->slopes, NULL, unit,
                            column + (size_t)j * b->model->n_state, wrench);
    }
}

static void *factors(void *self, bough_arena *arena) {
    const bough_modal_body *b = self;
    bough_modal_newton *newton = bough_arena_take(arena, sizeof *newton);
    return newton != NULL && bough_modal_newton_init(newton, arena, b->model) ? newton : NULL;
}

static bool linearise(void *self, double t, const double *state, const double *input,
                      void *factors) {
    bough_modal_body *b = self;
    return bough_modal_linearise(b->model, &b->loads, t, state, input, &b->slopes, factors);
}

static bool factor(void *self, void *factors, double gamma) {
    const bough_modal_body *b = self;
    return bough_modal_factor(b->model, factors, gamma);
}

static void solve(void *self, void *factors, double *x) {
    const bough_modal_body *b = self;
    bough_modal_solve(b->model, factors, x);
}

static bough_status advance(void *self, double t1, const bough_signal *input, bool restart) {
    bough_modal_body *b = self;
    b->input = input;
    bough_modal_hold_loads(b->model, &b->loads, b->time, t1, &b->chain);
    bough_status status =
        bough_integrator_advance(&b->micro, b->time, t1, restart || b->moved, b->state);
    bough_modal_release_loads(&b->chain);
    b->moved = !bough_is_ok(&status);
    b->time = t1;
    return status;
}

static size_t state_bytes(const bough_modal_body *b) {
    return (size_t)b->model->n_state * sizeof(double);
}

static size_t save_size(void *self) {
    return sizeof(double) + state_bytes(self);
}

static void save(void *self, void *copy) {
    const bough_modal_body *b = self;
    memcpy(copy, &b->time, sizeof b->time);
    memcpy((char *)copy + sizeof b->time, b->state, state_bytes(b));
}

// The state is another's now: its own steps have made no error in it.
static void begin_anew(bough_modal_body *b, double t) {
    b->time = t;
    b->moved = true;
    if (b->micro.own_error != NULL) memset(b->micro.own_error, 0, state_bytes(b));
}

static void restore(void *self, const void *copy) {
    bough_modal_body *b = self;
    double t;
    memcpy(&t, copy, sizeof t);
    begin_anew(b, t);
    memcpy(b->state, (const char *)copy + sizeof t, state_bytes(b));
}

static void set_state(void *self, double t, const double *state) {
    bough_modal_body *b = self;
    begin_anew(b, t);
    if (state != b->state) memcpy(b->state, state, state_bytes(b));
}

static void statistics(void *self, bough_statistics *sum) {
    const bough_modal_body *b = self;
    b->micro.ops->statistics(b->micro.self, sum);
}

// -- life -----------------------------------------------------------------------------------------

static bool take_memory(bough_modal_body *b, bough_arena *arena) {
    size_t states = (size_t)b->model->n_state;
    b->state = bough_arena_doubles(arena, states);
    b->scale = bough_arena_doubles(arena, states);
    b->work = bough_arena_doubles(arena, states);
    b->vertices = bough_arena_doubles(arena, (size_t)BOUGH_ROD_STATES * b->model->rod->n);
    bool ok = bough_rod_loads_init(&b->loads, arena, b->model->rod);
    ok = bough_modal_chain_init(&b->chain, arena, b->model) && ok;
    ok = bough_modal_newton_init(&b->micro_newton, arena, b->model) && ok;
    ok = bough_modal_chain_init(&b->slopes, arena, b->model) && ok;
    return ok && !bough_arena_exhausted(arena);
}

static void set_scale(bough_modal_body *b) {
    for (int k = 0; k < b->model->n_piece; k++) {
        const bough_modal_piece *p = &b->model->piece[k];
        double *to = b->scale + b->model->offset[k];
        memcpy(to, p->scale, (size_t)p->m * sizeof *to);
        memcpy(to + p->m, p->scale, (size_t)p->m * sizeof *to);
    }
}

bough_status bough_modal_body_create(bough_arena *arena, const bough_modal_model *model,
                                     double start, bough_integrator_options micro, const double *input,
                                     bough_modal_body **body) {
    bough_modal_body *b = bough_arena_take(arena, sizeof *b);
    if (b == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: out of memory", model->name);
    b->model = model;
    if (!take_memory(b, arena)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: out of memory", model->name);
    }
    b->time = start;
    b->moved = true;
    bough_modal_rest_state(model, input, b->state);
    set_scale(b);
    bough_ode ode = {.name = model->name,
                     .n = model->n_state,
                     .scale = b->scale,
                     .self = b,
                     .derivative = micro_derivative,
                     .linearise = micro_linearise,
                     .factor = micro_factor,
                     .solve = micro_solve};
    bough_status status = bough_integrator_create(arena, &ode, &micro, &b->micro);
    if (bough_is_ok(&status)) *body = b;
    return status;
}

bough_subsystem bough_modal_body_subsystem(bough_modal_body *body) {
    static const bough_subsystem_ops ops = {
        .derivative = derivative,
        .output = output,
        .output_tangent = output_tangent,
        .input_columns = input_columns,
        .factors = factors,
        .linearise = linearise,
        .factor = factor,
        .solve = solve,
        .advance = advance,
        .save_size = save_size,
        .save = save,
        .restore = restore,
        .set_state = set_state,
        .statistics = statistics,
    };
    return (bough_subsystem){.name = body->model->name,
                             .kind = "modal",
                             .solver = body->micro.ops->title,
                             .n_state = body->model->n_state,
                             .n_input = BOUGH_ROD_INPUTS,
                             .n_output = BOUGH_ROD_OUTPUTS,
                             .scale = body->scale,
                             .time = &body->time,
                             .state = body->state,
                             .own_error = body->micro.own_error,
                             .ops = &ops,
                             .self = body};
}

bough_rod_loads *bough_modal_body_loads(bough_modal_body *body) {
    return &body->loads;
}

void bough_modal_body_ride(bough_modal_body *body, const double *input, double *state) {
    bough_modal_ride(body->model, input, &body->chain, state);
}

const bough_modal_model *bough_modal_body_model(const bough_modal_body *body) {
    return body->model;
}

const bough_rod_model *bough_modal_body_rod(const bough_modal_body *body) {
    return body->model->rod;
}

const double *bough_modal_body_vertices(bough_modal_body *body, const double *state,
                                        const double *input, int first) {
    bough_modal_expand(body->model, state, input, first, &body->chain, body->vertices);
    return body->vertices;
}

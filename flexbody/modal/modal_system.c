// A modal body behind the contract of core/solve/system.h.
#include "flexbody/modal/modal_system.h"

#include <string.h>

struct bough_modal_body {
    const bough_modal_model *model;
    bough_rod_loads loads;
    double *initial;  // (n_state)
    double *scale;    // (n_state)
    double *vertices; // (13 n) computed on request
    double *work;     // rates of a tangent (n_state)
    bough_modal_chain chain;
    bough_modal_chain slopes; // of tangents, beside evaluations
};

// -- the contract ---------------------------------------------------------------------------------

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    bough_modal_body *b = self;
    return bough_modal_derivative(b->model, &b->loads, t, state, input, &b->chain, rate);
}

static void output(void *self, double t, const double *state, const double *input, double *wrench) {
    bough_modal_body *b = self;
    bough_modal_root_wrench(b->model, &b->loads, t, state, input, &b->chain, wrench);
}

static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    bough_modal_body *b = self;
    bough_modal_chain_slopes(b->model, &b->loads, t, state, input, &b->slopes);
    bough_modal_tangent(b->model, &b->slopes, state_rate, input_rate, b->work, rate);
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    bough_modal_body *b = self;
    bough_modal_chain_slopes(b->model, &b->loads, t, state, input, &b->slopes);
    // a column along each unit input
    for (int j = 0; j < BOUGH_ROD_INPUTS; j++) {
        double unit[BOUGH_ROD_INPUTS] = {0}, wrench[BOUGH_ROD_OUTPUTS];
        unit[j] = 1;
        bough_modal_tangent(b->model, &b->slopes, NULL, unit, column + (size_t)j * b->model->n_state, wrench);
    }
}

static bool kept_tangent(void *self, const void *factors, const double *state_rate, const double *input_rate,
                         double *rate) {
    const bough_modal_body *b = self;
    bough_modal_kept_tangent(b->model, factors, state_rate, input_rate, rate);
    return true;
}

static void *factors(void *self, bough_arena *arena) {
    const bough_modal_body *b = self;
    bough_modal_newton *newton = bough_arena_take(arena, sizeof *newton);
    bough_modal_newton_init(newton, arena, b->model);
    return newton;
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
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

// -- life -----------------------------------------------------------------------------------------

static void take_memory(bough_modal_body *b, bough_arena *arena) {
    size_t states = (size_t)b->model->n_state;
    bough_arena_each(arena, states, &b->initial, &b->scale, &b->work);
    b->vertices = bough_arena_doubles(arena, (size_t)BOUGH_ROD_STATES * b->model->rod->n);
    bough_rod_loads_init(&b->loads, arena, b->model->rod);
    bough_modal_chain_init(&b->chain, arena, b->model);
    bough_modal_chain_init(&b->slopes, arena, b->model);
}

// q and η have the scale of the displacement that they cause.
static void set_scale(bough_modal_body *b) {
    for (int k = 0; k < b->model->n_piece; k++) {
        const bough_modal_piece *p = &b->model->piece[k];
        double *to = b->scale + b->model->offset[k];
        memcpy(to, p->scale, (size_t)p->m * sizeof *to);
        memcpy(to + p->m, p->scale, (size_t)p->m * sizeof *to);
    }
}

bough_modal_body *bough_modal_body_create(bough_arena *arena, const bough_modal_model *model,
                                          const double *input) {
    bough_modal_body *b = bough_arena_take(arena, sizeof *b);
    b->model = model;
    take_memory(b, arena);
    bough_modal_rest_state(model, input, b->initial);
    set_scale(b);
    return b;
}

bough_system bough_modal_body_system(bough_modal_body *body) {
    static const bough_system_ops ops = {BOUGH_SYSTEM_REQUIRED, .kept_tangent = kept_tangent};
    return (bough_system){.name = body->model->name,
                          .kind = "modal",
                          .n_state = body->model->n_state,
                          .n_input = BOUGH_ROD_INPUTS,
                          .n_output = BOUGH_ROD_OUTPUTS,
                          .scale = body->scale,
                          .initial = body->initial,
                          .ops = &ops,
                          .self = body};
}

bough_rod_loads *bough_modal_body_loads(bough_modal_body *body) { return &body->loads; }

void bough_modal_body_ride(bough_modal_body *body, const double *input, double *state) {
    bough_modal_ride(body->model, input, &body->chain, state);
}

const bough_modal_model *bough_modal_body_model(const bough_modal_body *body) { return body->model; }

const double *bough_modal_body_vertices(bough_modal_body *body, const double *state, const double *input,
                                        int first) {
    bough_modal_expand(body->model, state, input, first, &body->chain, body->vertices);
    return body->vertices;
}

#include "flexbody/rod_subsystem.h"

#include "flexbody/rod_tangent.h"

#include <string.h>

struct bough_rod_body {
    const bough_rod_model *model;
    bough_rod_loads loads;
    double time, *state; // (13 n)
    double *scale;       // (13 n)
    bool moved;          // the state was set from outside: the integrator starts anew
    const bough_signal *input; // of the step in progress
    bough_rod_scratch scratch;
    bough_rod_tangent micro_tangent; // of the sub-solver
    bough_integrator micro;
};

// -- the sub-solver's view --------------------------------------------------------------------------

static bool micro_derivative(void *self, double t, const double *y, double *rate) {
    bough_rod_body *b = self;
    double input[BOUGH_ROD_MOST_INPUTS];
    bough_signal_value(b->input, t, input);
    return bough_rod_derivative(b->model, &b->loads, t, y, input, &b->scratch, rate);
}

static bool micro_derivative_again(void *self, double t, const double *y, double *rate) {
    bough_rod_body *b = self;
    double input[BOUGH_ROD_MOST_INPUTS];
    bough_signal_value(b->input, t, input);
    return bough_rod_derivative_again(b->model, &b->loads, t, y, input, &b->scratch, rate);
}

// |p| = 1 to rounding in what others see; the integrator's own history is not touched.
static void normalise(bough_rod_body *b) {
    int n = b->model->n;
    double *p = b->state + BOUGH_ROD_P * n;
    for (int i = 0; i < n; i++) {
        bough_quaternion unit = bough_quaternion_normalised(
            (bough_quaternion){p[i], p[n + i], p[2 * n + i], p[3 * n + i]});
        p[i] = unit.w;
        p[n + i] = unit.x;
        p[2 * n + i] = unit.y;
        p[3 * n + i] = unit.z;
    }
}

static bool micro_linearise(void *self, double t, const double *y) {
    bough_rod_body *b = self;
    double input[BOUGH_ROD_MOST_INPUTS];
    bough_signal_value(b->input, t, input);
    return bough_rod_linearise(b->model, &b->loads, t, y, input, &b->scratch, &b->micro_tangent);
}

static bool micro_factor(void *self, double gamma) {
    bough_rod_body *b = self;
    return bough_rod_factor(b->model, &b->micro_tangent, gamma);
}

static void micro_solve(void *self, double *x) {
    bough_rod_body *b = self;
    bough_rod_solve(b->model, &b->micro_tangent, x);
}

// -- the contract -----------------------------------------------------------------------------------

static bool derivative(void *self, double t, const double *state, const double *input,
                       double *rate) {
    bough_rod_body *b = self;
    return bough_rod_derivative(b->model, &b->loads, t, state, input, &b->scratch, rate);
}

static bool derivative_again(void *self, double t, const double *state, const double *input,
                             double *rate) {
    bough_rod_body *b = self;
    return bough_rod_derivative_again(b->model, &b->loads, t, state, input, &b->scratch, rate);
}

static void output(void *self, double t, const double *state, const double *input,
                   double *wrench) {
    bough_rod_body *b = self;
    bough_rod_root_wrench(b->model, &b->loads, t, state, input, &b->scratch, wrench);
    if (!bough_rod_carries(b->model)) return;
    bough_rod_end_wrench(b->model, &b->loads, t, state, input, &b->scratch,
                         wrench + BOUGH_ROD_OUTPUTS);
}

static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    bough_rod_body *b = self;
    bough_rod_wrench_tangent(b->model, state, input, state_rate, input_rate, &b->scratch, rate);
    if (!bough_rod_carries(b->model)) return;
    bough_rod_variation at = {state, input, state_rate, input_rate};
    bough_rod_end_tangent(b->model, &b->loads, t, &at, &b->scratch, rate + BOUGH_ROD_OUTPUTS);
}

static void input_columns(void *self, double t, const double *state, const double *input,
                          double *column) {
    (void)t;
    bough_rod_body *b = self;
    bough_rod_input_columns(b->model, state, input, &b->scratch, column);
}

static void *factors(void *self, bough_arena *arena) {
    const bough_rod_body *b = self;
    bough_rod_tangent *k = bough_arena_take(arena, sizeof *k);
    return k != NULL && bough_rod_tangent_init(k, arena, b->model) ? k : NULL;
}

static bool linearise(void *self, double t, const double *state, const double *input,
                      void *factors) {
    bough_rod_body *b = self;
    return bough_rod_linearise(b->model, &b->loads, t, state, input, &b->scratch, factors);
}

static bool factor(void *self, void *factors, double gamma) {
    const bough_rod_body *b = self;
    return bough_rod_factor(b->model, factors, gamma);
}

static void solve(void *self, void *factors, double *x) {
    const bough_rod_body *b = self;
    bough_rod_solve(b->model, factors, x);
}

static bough_status advance(void *self, double t1, const bough_signal *input, bool restart) {
    bough_rod_body *b = self;
    b->input = input;
    bough_status status = bough_integrator_advance(&b->micro, b->time, t1, restart || b->moved,
                                                   b->state);
    normalise(b);
    b->moved = !bough_is_ok(&status);
    b->time = t1;
    return status;
}

static bough_status advance_part(void *self, double pause, double t1, const bough_signal *input,
                                 bool restart) {
    bough_rod_body *b = self;
    b->input = input;
    bough_status status = b->micro.ops->advance(b->micro.self, &b->time, pause, t1,
                                                restart || b->moved, b->state);
    if (b->time >= t1) normalise(b);
    b->moved = !bough_is_ok(&status);
    return status;
}

static size_t state_bytes(const bough_rod_body *b) {
    return (size_t)BOUGH_ROD_STATES * b->model->n * sizeof(double);
}

static size_t save_size(void *self) {
    return sizeof(double) + state_bytes(self);
}

// CVODE gives no access to its history: a restored rod starts anew.
static void save(void *self, void *copy) {
    const bough_rod_body *b = self;
    memcpy(copy, &b->time, sizeof b->time);
    memcpy((char *)copy + sizeof b->time, b->state, state_bytes(b));
}

// The state is another's now: its own steps have made no error in it.
static void begin_anew(bough_rod_body *b, double t) {
    b->time = t;
    b->moved = true;
    if (b->micro.own_error != NULL) memset(b->micro.own_error, 0, state_bytes(b));
}

static void set_state(void *self, double t, const double *state) {
    bough_rod_body *b = self;
    begin_anew(b, t);
    if (state != b->state) memcpy(b->state, state, state_bytes(b));
}

static void restore(void *self, const void *copy) {
    bough_rod_body *b = self;
    double t;
    memcpy(&t, copy, sizeof t);
    begin_anew(b, t);
    memcpy(b->state, (const char *)copy + sizeof t, state_bytes(b));
}

static void statistics(void *self, bough_statistics *sum) {
    const bough_rod_body *b = self;
    b->micro.ops->statistics(b->micro.self, sum);
}

// δp ← δp − p (p·δp)/|p|²
static void project(void *self, const double *state, double *x) {
    const bough_rod_body *b = self;
    int n = b->model->n;
    const double *p = state + (size_t)BOUGH_ROD_P * n;
    double *change = x + (size_t)BOUGH_ROD_P * n;
    for (int i = 0; i < n; i++) {
        double along = 0, square = 0;
        for (int c = 0; c < 4; c++) {
            along += p[c * n + i] * change[c * n + i];
            square += p[c * n + i] * p[c * n + i];
        }
        for (int c = 0; c < 4; c++) change[c * n + i] -= p[c * n + i] * along / square;
    }
}

// -- life -------------------------------------------------------------------------------------------

static bool take_memory(bough_rod_body *b, bough_arena *arena) {
    size_t states = (size_t)BOUGH_ROD_STATES * b->model->n;
    b->state = bough_arena_doubles(arena, states);
    b->scale = bough_arena_doubles(arena, states);
    bool ok = bough_rod_loads_init(&b->loads, arena, b->model);
    ok = bough_rod_scratch_init(&b->scratch, arena, b->model) && ok;
    ok = bough_rod_tangent_init(&b->micro_tangent, arena, b->model) && ok;
    return ok && !bough_arena_exhausted(arena);
}

bough_status bough_rod_body_create(bough_arena *arena, const bough_rod_model *model, double start,
                                   bough_integrator_options micro, const double *input,
                                   bough_rod_body **body) {
    // error scales of x, p, u, W: a tenth of a radian weighs as a metre
    static const double scale[BOUGH_ROD_STATES] = {1, 1, 1, 0.1, 0.1, 0.1, 0.1,
                                                   1, 1, 1, 0.1, 0.1, 0.1};
    bough_rod_body *b = bough_arena_take(arena, sizeof *b);
    if (b == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "rod %s: out of memory", model->name);
    b->model = model;
    if (!take_memory(b, arena)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "rod %s: out of memory", model->name);
    }
    b->time = start;
    b->moved = true;
    bough_rod_rest_state(model, input, b->state);
    int n = model->n;
    for (int k = 0; k < BOUGH_ROD_STATES * n; k++) b->scale[k] = scale[k / n];
    bough_ode ode = {.name = model->name,
                     .n = BOUGH_ROD_STATES * n,
                     .scale = b->scale,
                     .self = b,
                     .derivative = micro_derivative,
                     .derivative_again = micro_derivative_again,
                     .linearise = micro_linearise,
                     .factor = micro_factor,
                     .solve = micro_solve};
    bough_status status = bough_integrator_create(arena, &ode, &micro, &b->micro);
    if (bough_is_ok(&status)) *body = b;
    return status;
}

bough_subsystem bough_rod_body_subsystem(bough_rod_body *body) {
    static const bough_subsystem_ops ops = {
        .derivative = derivative,
        .derivative_again = derivative_again,
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
        .project = project,
        .advance_part = advance_part,
    };
    return (bough_subsystem){.name = body->model->name,
                             .kind = "rod",
                             .solver = body->micro.ops->title,
                             .n_state = BOUGH_ROD_STATES * body->model->n,
                             .n_input = bough_rod_n_inputs(body->model),
                             .n_output = bough_rod_n_outputs(body->model),
                             .scale = body->scale,
                             .time = &body->time,
                             .state = body->state,
                             .own_error = body->micro.own_error,
                             .ops = &ops,
                             .self = body};
}

bough_rod_loads *bough_rod_body_loads(bough_rod_body *body) {
    return &body->loads;
}

const bough_rod_model *bough_rod_body_model(const bough_rod_body *body) {
    return body->model;
}

const double *bough_rod_body_state(const bough_rod_body *body) {
    return body->state;
}

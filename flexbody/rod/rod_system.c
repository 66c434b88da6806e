#include "flexbody/rod/rod_system.h"

#include "core/base/symmetric6.h"
#include "flexbody/rod/rod_tangent.h"

#include <math.h>
#include <string.h>

struct bough_rod_body {
    const bough_rod_model *model;
    bough_rod_loads loads;
    double *initial; // (13 n)
    double *scale;   // (13 n)
    bough_rod_scratch scratch;
};

// -- the contract -----------------------------------------------------------------------------------

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    bough_rod_body *b = self;
    return bough_rod_derivative(b->model, &b->loads, t, state, input, &b->scratch, rate);
}

static void output(void *self, double t, const double *state, const double *input, double *wrench) {
    bough_rod_body *b = self;
    bough_rod_root_wrench(b->model, &b->loads, t, state, input, &b->scratch, wrench);
    if (!bough_rod_carries(b->model)) return;
    bough_rod_end_wrench(b->model, &b->loads, t, state, input, &b->scratch, wrench + BOUGH_ROD_OUTPUTS);
}

// The wrenches by the forces of the derivative just evaluated, and of the second derivative what the first
// has.
static bool evaluate(void *self, const double *state, int n, const bough_evaluation *at) {
    bough_rod_body *b = self;
    bool ok = true;
    for (int k = 0; k < n && ok; k++) {
        bool (*f)(const bough_rod_model *, const bough_rod_loads *, double, const double *, const double *,
                  bough_rod_scratch *, double *) = k == 0 ? bough_rod_derivative : bough_rod_derivative_again;
        ok = f(b->model, &b->loads, at[k].t, state, at[k].input, &b->scratch, at[k].rate);
        if (at[k].output == NULL) continue;
        bough_rod_present_root_wrench(b->model, &b->scratch, at[k].output);
        if (!bough_rod_carries(b->model)) continue;
        bough_rod_present_end_wrench(b->model, &b->scratch, at[k].output + BOUGH_ROD_OUTPUTS);
    }
    return ok;
}

static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    bough_rod_body *b = self;
    bough_rod_variation at = {state, input, state_rate, input_rate};
    bough_rod_wrench_tangent(b->model, &b->loads, t, &at, &b->scratch, rate);
    if (!bough_rod_carries(b->model)) return;
    bough_rod_end_tangent(b->model, &b->loads, t, &at, &b->scratch, rate + BOUGH_ROD_OUTPUTS);
}

static bool kept_tangent(void *self, const void *factors, const double *state_rate, const double *input_rate,
                         double *rate) {
    const bough_rod_body *b = self;
    bough_rod_kept_wrench_tangent(b->model, factors, state_rate, input_rate, rate);
    return true;
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    bough_rod_body *b = self;
    bough_rod_input_columns(b->model, &b->loads, t, state, input, &b->scratch, column);
}

static void *factors(void *self, bough_arena *arena) {
    const bough_rod_body *b = self;
    bough_rod_tangent *k = bough_arena_take(arena, sizeof *k);
    bough_rod_tangent_init(k, arena, b->model);
    return k;
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
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

// |p| = 1 to rounding in what others see.
static bool constrain(void *self, double t, double *state) {
    (void)t;
    const bough_rod_body *b = self;
    int n = b->model->n;
    double *restrict p = state + (size_t)BOUGH_ROD_P * n;
#pragma omp simd
    for (int i = 0; i < n; i++) {
        double w = p[i], x = p[n + i], y = p[2 * n + i], z = p[3 * n + i];
        double norm = sqrt(w * w + x * x + y * y + z * z);
        p[i] = w / norm;
        p[n + i] = x / norm;
        p[2 * n + i] = y / norm;
        p[3 * n + i] = z / norm;
    }
    return false;
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

static void take_memory(bough_rod_body *b, bough_arena *arena) {
    size_t states = (size_t)BOUGH_ROD_STATES * b->model->n;
    b->initial = bough_arena_doubles(arena, states);
    b->scale = bough_arena_doubles(arena, states);
    bough_rod_loads_init(&b->loads, arena, b->model);
    bough_rod_scratch_init(&b->scratch, arena, b->model);
}

bough_rod_body *bough_rod_body_create(bough_arena *arena, const bough_rod_model *model, const double *input) {
    // error scales of x, p, u, W: a tenth of a radian weighs as a metre
    static const double scale[BOUGH_ROD_STATES] = {1, 1, 1, 0.1, 0.1, 0.1, 0.1, 1, 1, 1, 0.1, 0.1, 0.1};
    bough_rod_body *b = bough_arena_take(arena, sizeof *b);
    b->model = model;
    take_memory(b, arena);
    bough_rod_rest_state(model, input, b->initial);
    int n = model->n;
    for (int k = 0; k < BOUGH_ROD_STATES * n; k++) b->scale[k] = scale[k / n];
    return b;
}

// The greatest ratio of stiffness to viscosity over segments and strains.
static double elastic_rate(const bough_rod_model *m) {
    double greatest = 0;
    for (int n = 0; n < m->n_segment; n++) {
        for (int i = 0; i < 6; i++) {
            int k = bough_symmetric6_index(i, i) * m->stride + n;
            greatest = fmax(greatest, m->damping[k] > 0 ? m->stiffness[k] / m->damping[k] : (double)INFINITY);
        }
    }
    return greatest;
}

bough_system bough_rod_body_system(bough_rod_body *body) {
    static const bough_system_ops ops = {
        BOUGH_SYSTEM_REQUIRED,  .evaluate = evaluate, .kept_tangent = kept_tangent,
        .constrain = constrain, .project = project,
    };
    return (bough_system){.name = body->model->name,
                          .kind = "rod",
                          .n_state = BOUGH_ROD_STATES * body->model->n,
                          .n_input = bough_rod_n_inputs(body->model),
                          .n_output = bough_rod_n_outputs(body->model),
                          .scale = body->scale,
                          .initial = body->initial,
                          .elastic_rate = elastic_rate(body->model),
                          .ops = &ops,
                          .self = body};
}

bough_rod_loads *bough_rod_body_loads(bough_rod_body *body) { return &body->loads; }

const bough_rod_model *bough_rod_body_model(const bough_rod_body *body) { return body->model; }

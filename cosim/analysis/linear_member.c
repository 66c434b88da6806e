// The linear member of stability.h. Its own steps are those of the two-stage SDIRK method with γ = 1 − 1/√2,
// which keeps oscillations (their amplitude falls by 0.004 (ωh)⁴ per step h) and damps stiff motions at once;
// the trapezoidal rule would keep all stiff modes.
#include "cosim/analysis/stability.h"

static const double sdirk_gamma = 0.29289321881345248; // 1 − 1/√2

typedef struct linear_factors {
    void *real;      // of the system
    bool linearised; // there, once and for all
    double gamma;    // of the factors; 0: none
} linear_factors;

typedef struct linear_member {
    const bough_system *real;
    const bough_member *member; // the linear one
    double sub_step, time;      // of the linearisation [s]
    double *at, *input_at;      // (n_state), (n_input) where the system is linearised
    double *column;             // (n_input × n_state) B
    linear_factors *own;        // of its own steps
    double *plus, *minus;       // (n_state) scratch
    double *seen;               // (n_input) scratch
} linear_member;

// -- model exchange -------------------------------------------------------------------------------

// sum += factor B u
static void add_inputs(const linear_member *s, double factor, const double *input, double *sum) {
    int n = s->real->n_state;
    for (int j = 0; j < s->real->n_input; j++) {
        double weight = factor * input[j];
        const double *column = s->column + (size_t)j * (size_t)n;
        if (weight == 0) continue;
        for (int k = 0; k < n; k++) sum[k] += weight * column[k];
    }
}

// f at the state of linearisation plus factor y
static bool shifted_rate(linear_member *s, double factor, const double *state, double *rate) {
    const bough_system *r = s->real;
    for (int k = 0; k < r->n_state; k++) s->plus[k] = s->at[k] + factor * state[k];
    return r->ops->derivative(r->self, s->time, s->plus, s->input_at, rate);
}

// J y by central differences along y, B u from the columns.
static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    (void)t;
    linear_member *s = self;
    const bough_system *r = s->real;
    double largest = bough_largest(r->n_state, state, r->scale);
    // J y
    memset(rate, 0, (size_t)r->n_state * sizeof(double));
    if (largest > 0) {
        double step = 6e-6 / largest; // the cube root of the rounding error
        if (!shifted_rate(s, step, state, rate)) return false;
        if (!shifted_rate(s, -step, state, s->minus)) return false;
        for (int k = 0; k < r->n_state; k++) rate[k] = (rate[k] - s->minus[k]) / (2 * step);
    }
    // B u
    add_inputs(s, 1, input, rate);
    return true;
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    (void)t, (void)state, (void)input;
    const linear_member *s = self;
    const bough_system *r = s->real;
    r->ops->output_tangent(r->self, s->time, s->at, s->input_at, state_rate, input_rate, rate);
}

static void output(void *self, double t, const double *state, const double *input, double *out) {
    output_tangent(self, t, state, input, state, input, out);
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    (void)t, (void)state, (void)input;
    const linear_member *s = self;
    size_t count = (size_t)s->real->n_input * (size_t)s->real->n_state;
    memcpy(column, s->column, count * sizeof(double));
}

static void *factors(void *self, bough_arena *arena) {
    const linear_member *s = self;
    linear_factors *k = bough_arena_take(arena, sizeof *k);
    k->real = s->real->ops->factors(s->real->self, arena);
    return k;
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
    (void)t, (void)state, (void)input;
    const linear_member *s = self;
    const bough_system *r = s->real;
    linear_factors *k = factors;
    if (k->linearised) return true;
    k->linearised = r->ops->linearise(r->self, s->time, s->at, s->input_at, k->real);
    return k->linearised;
}

static bool factor(void *self, void *factors, double gamma) {
    const linear_member *s = self;
    linear_factors *k = factors;
    if (gamma == k->gamma) return true;
    bool ok = s->real->ops->factor(s->real->self, k->real, gamma);
    k->gamma = ok ? gamma : 0;
    return ok;
}

static void solve(void *self, void *factors, double *x) {
    const linear_member *s = self;
    const linear_factors *k = factors;
    s->real->ops->solve(s->real->self, k->real, x);
}

// -- own steps ------------------------------------------------------------------------------------

// One SDIRK step of length h: with x1 = y + γh f1, x2 = y + (1 − γ)h f1 + γh f2 = the new state.
static void step(linear_member *s, double t, double h, double *y) {
    const bough_signal *input = s->member->signal;
    int n = s->real->n_state;
    double part = (1 - sdirk_gamma) / sdirk_gamma;
    // first stage
    memcpy(s->plus, y, (size_t)n * sizeof(double));
    bough_signal_value(input, t + sdirk_gamma * h, s->seen);
    add_inputs(s, s->own->gamma, s->seen, s->plus);
    solve(s, s->own, s->plus);
    // second stage
    for (int k = 0; k < n; k++) y[k] += part * (s->plus[k] - y[k]);
    bough_signal_value(input, t + h, s->seen);
    add_inputs(s, s->own->gamma, s->seen, y);
    solve(s, s->own, y);
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    (void)restart;
    linear_member *s = self;
    double t0 = *t;
    int n_step = (int)ceil((t1 - t0) / s->sub_step - 1e-6);
    double h = (t1 - t0) / n_step;
    // rounded, so that factors serve all macro steps of nearly the same length
    double gamma = (double)(float)(sdirk_gamma * h);
    if (!linearise(s, t0, NULL, NULL, s->own) || !factor(s, s->own, gamma)) {
        return bough_fail(BOUGH_FAILED, "%s: singular Newton matrix", s->real->name);
    }
    for (int k = 0; k < n_step; k++) step(s, t0 + k * h, h, y);
    *t = t1;
    return bough_ok();
}

static void statistics(const void *self, bough_statistics *sum) { (void)self, (void)sum; }

static const bough_integrator_ops sdirk = {.title = "SDIRK2", .advance = advance, .statistics = statistics};

static const bough_system_ops operations = {BOUGH_SYSTEM_REQUIRED};

void bough_linear_member_create(bough_arena *arena, const bough_member *real, const double *input,
                                double sub_step, bough_member *linear) {
    const bough_system *r = &real->system;
    size_t n = (size_t)r->n_state, n_input = (size_t)r->n_input;
    linear_member *s = bough_arena_take(arena, sizeof *s);
    *s = (linear_member){.real = r, .member = linear, .sub_step = sub_step, .time = real->time};
    bough_arena_each(arena, n, &s->at, &s->plus, &s->minus);
    bough_arena_each(arena, n_input, &s->input_at, &s->seen);
    s->column = bough_arena_doubles(arena, n_input * n);
    s->own = factors(s, arena);
    *linear = (bough_member){.system = *r,
                             .solver = sdirk.title,
                             .time = real->time,
                             .state = bough_arena_doubles(arena, n),
                             .integrated = bough_arena_doubles(arena, n),
                             .integrator = {.ops = &sdirk, .self = s}};
    linear->system.ops = &operations;
    linear->system.self = s;
    memcpy(s->at, real->state, n * sizeof(double));
    memcpy(s->input_at, input, n_input * sizeof(double));
    r->ops->input_columns(r->self, real->time, s->at, s->input_at, s->column);
}

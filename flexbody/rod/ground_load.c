// Loads in ground axes are linear in the components of these axes: each is lumped once for every component,
// and an evaluation sums the nine results.
#include "flexbody/rod/ground_load.h"

enum { VERTEX_ROWS = 6, ROWS = 18 }; // of a load: on the vertices, and with those along the segments

// A load is linear in the axes' components: value = Σ_j axis_j by_axis_j.
typedef struct ground_load {
    struct ground_load *next;
    bough_rod_ramped_load *resolved; // in BRF axes, one of the body's
    double *by_axis;                 // (9 × 18 × stride): on the vertices, then along the segments
} ground_load;

struct bough_ground_body {
    bough_system inner;
    bough_system_ops ops;
    const bough_rod_model *mesh;
    bough_rod_loads *loads;
    bool vertices_only; // the body takes no loads between its vertices
    ground_load *first;
    double *rate, *out; // (n_state), (n_output) scratch
    double *probe;      // (inputs) scratch
};

// sum (n) ← Σ_j axis_j by (n × 18 × stride rows apart)
static void sum_axes(const bough_ground_body *b, const double *axis, const double *by, int n, double *sum) {
    memset(sum, 0, (size_t)n * sizeof *sum);
    for (int j = 0; j < BOUGH_GROUND_AXES; j++, by += (size_t)ROWS * b->mesh->stride) {
        for (int k = 0; k < n; k++) sum[k] += axis[j] * by[k];
    }
}

void bough_ground_body_turn(bough_ground_body *b, const double *axis) {
    int s = b->mesh->stride;
    for (ground_load *l = b->first; l != NULL; l = l->next) {
        sum_axes(b, axis, l->by_axis, VERTEX_ROWS * s, l->resolved->value);
        if (l->resolved->along)
            sum_axes(b, axis, l->by_axis + VERTEX_ROWS * s, (ROWS - VERTEX_ROWS) * s, l->resolved->line);
    }
}

// -- the contract ---------------------------------------------------------------------------------

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    bough_ground_body *b = self;
    bough_ground_body_turn(b, input + b->inner.n_input);
    return b->inner.ops->derivative(b->inner.self, t, state, input, rate);
}

static void output(void *self, double t, const double *state, const double *input, double *out) {
    bough_ground_body *b = self;
    bough_ground_body_turn(b, input + b->inner.n_input);
    b->inner.ops->output(b->inner.self, t, state, input, out);
}

// The input with changed axes. f and h are nearly linear in these: central differences over a unit vector are
// as good as exact.
static double *with_axes(bough_ground_body *b, const double *input, const double *change, double factor) {
    int n = b->inner.n_input;
    memcpy(b->probe, input, (size_t)n * sizeof *input);
    for (int j = 0; j < BOUGH_GROUND_AXES; j++) b->probe[n + j] = input[n + j] + factor * change[j];
    return b->probe;
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *out) {
    bough_ground_body *b = self;
    bough_ground_body_turn(b, input + b->inner.n_input);
    b->inner.ops->output_tangent(b->inner.self, t, state, input, state_rate, input_rate, out);
    if (input_rate == NULL) return;
    // ∂h/∂axes · change by a central difference over a change of unit length
    const double *change = input_rate + b->inner.n_input;
    double largest = 0;
    for (int j = 0; j < BOUGH_GROUND_AXES; j++) largest = fmax(largest, fabs(change[j]));
    if (largest == 0) return;
    for (int sign = -1; sign <= 1; sign += 2) {
        output(b, t, state, with_axes(b, input, change, sign / largest), b->out);
        for (int k = 0; k < b->inner.n_output; k++) out[k] += sign * largest / 2 * b->out[k];
    }
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    bough_ground_body *b = self;
    bough_ground_body_turn(b, input + b->inner.n_input);
    b->inner.ops->input_columns(b->inner.self, t, state, input, column);
    // then a column for each component of the axes
    column += (size_t)b->inner.n_input * (size_t)b->inner.n_state;
    for (int j = 0; j < BOUGH_GROUND_AXES; j++, column += b->inner.n_state) {
        double unit[BOUGH_GROUND_AXES] = {0};
        unit[j] = 1;
        derivative(b, t, state, with_axes(b, input, unit, -1), b->rate);
        derivative(b, t, state, with_axes(b, input, unit, 1), column);
        for (int k = 0; k < b->inner.n_state; k++) column[k] = (column[k] - b->rate[k]) / 2;
    }
}

// The loads do not depend on the state: tangents by it are the inner system's.
static void *factors(void *self, bough_arena *arena) {
    const bough_ground_body *b = self;
    return b->inner.ops->factors(b->inner.self, arena);
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
    bough_ground_body *b = self;
    bough_ground_body_turn(b, input + b->inner.n_input);
    return b->inner.ops->linearise(b->inner.self, t, state, input, factors);
}

static bool factor(void *self, void *factors, double gamma) {
    const bough_ground_body *b = self;
    return b->inner.ops->factor(b->inner.self, factors, gamma);
}

static void solve(void *self, void *factors, double *x) {
    const bough_ground_body *b = self;
    b->inner.ops->solve(b->inner.self, factors, x);
}

static bool constrain(void *self, double t, double *state) {
    const bough_ground_body *b = self;
    return b->inner.ops->constrain(b->inner.self, t, state);
}

static void project(void *self, const double *state, double *x) {
    const bough_ground_body *b = self;
    b->inner.ops->project(b->inner.self, state, x);
}

// -- life -----------------------------------------------------------------------------------------

bough_ground_body *bough_ground_body_create(bough_arena *arena, const bough_system *inner,
                                            const bough_rod_model *mesh, bough_rod_loads *loads,
                                            bool vertices_only) {
    bough_ground_body *b = bough_arena_take(arena, sizeof *b);
    // the inner system's inputs, then the axes
    size_t inputs = (size_t)inner->n_input + BOUGH_GROUND_AXES;
    *b = (bough_ground_body){.inner = *inner,
                             .ops = {BOUGH_SYSTEM_REQUIRED},
                             .mesh = mesh,
                             .loads = loads,
                             .vertices_only = vertices_only,
                             .rate = bough_arena_doubles(arena, (size_t)inner->n_state),
                             .out = bough_arena_doubles(arena, (size_t)inner->n_output),
                             .probe = bough_arena_doubles(arena, inputs)};
    if (inner->ops->constrain != NULL) b->ops.constrain = constrain;
    if (inner->ops->project != NULL) b->ops.project = project;
    return b;
}

bough_system bough_ground_body_system(bough_ground_body *body) {
    bough_system system = body->inner;
    system.n_input += BOUGH_GROUND_AXES;
    system.ops = &body->ops;
    system.self = body;
    return system;
}

// The value of the load, as vertices have it, with one component of the axes 1 and the others 0.
static void add_axis(const bough_ground_body *b, const bough_ground_load_def *def, int j,
                     bough_rod_ramped_load *to) {
    double wrench[2][6] = {{0}};
    const double *const given[2] = {def->wrench, def->end};
    // component `component` of the ground's axis number `axis`
    int axis = j / 3, component = j % 3;
    for (int side = 0; side < 2; side++) {
        wrench[side][component] = given[side][axis];
        wrench[side][3 + component] = given[side][3 + axis];
    }
    bool tapered = memcmp(def->wrench, def->end, sizeof def->end) != 0;
    bough_rod_lump(b->mesh, def->reach, wrench[0], tapered ? wrench[1] : NULL, to);
    if (b->vertices_only) bough_rod_lump_line(b->mesh, to);
}

void bough_ground_body_load(bough_ground_body *b, bough_arena *arena, const bough_ground_load_def *def) {
    size_t s = (size_t)b->mesh->stride, size = ROWS * s;
    ground_load *l = bough_arena_take(arena, sizeof *l);
    *l = (ground_load){.next = b->first, .by_axis = bough_arena_doubles(arena, BOUGH_GROUND_AXES * size)};
    b->first = l;
    // lumped once for each component of the axes; later only sums of these are formed
    l->resolved = bough_rod_loads_add(b->loads, arena, b->mesh, false, &def->schedule);
    for (int j = 0; j < BOUGH_GROUND_AXES; j++) {
        double *by = l->by_axis + (size_t)j * size;
        memset(l->resolved->value, 0, VERTEX_ROWS * s * sizeof(double));
        memset(l->resolved->line, 0, (ROWS - VERTEX_ROWS) * s * sizeof(double));
        add_axis(b, def, j, l->resolved);
        memcpy(by, l->resolved->value, VERTEX_ROWS * s * sizeof(double));
        memcpy(by + VERTEX_ROWS * s, l->resolved->line, (ROWS - VERTEX_ROWS) * s * sizeof(double));
    }
}

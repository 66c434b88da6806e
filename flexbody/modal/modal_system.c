// A modal body: sweeps over its pieces, their tangents, one dense Newton matrix.
#include "flexbody/modal/modal_system.h"

#include "core/base/linalg.h"

struct bough_modal_body {
    const bough_modal_model *model;
    bough_rod_loads loads;
    double *initial;  // (n_state)
    double *scale;    // (n_state)
    double *vertices; // (13 n) computed on request
    // of the last evaluation
    bough_modal_point *point;         // (n_piece)
    double *load;                     // on the vertices (6 × rod stride)
    bough_modal_frame_change *change; // of each piece's frame and the last tip's (n_piece + 1)
    double *unit;                     // (n_state) zeros between uses
    double *rate;                     // (n_state) scratch
};

bough_status bough_modal_create(bough_arena *arena, const bough_rod_def *def, int pieces,
                                bough_modal_options options, bough_modal_model **model) {
    bough_modal_model *m = bough_arena_take(arena, sizeof *m);
    bough_modal_piece *piece = bough_arena_take(arena, (size_t)pieces * sizeof *piece);
    int *offset = bough_arena_take(arena, (size_t)pieces * sizeof *offset);
    bough_rod_model *rod = NULL;
    assert(pieces <= def->n_segment);
    BOUGH_TRY(bough_rod_create(arena, def, &rod));
    *m = (bough_modal_model){rod->name, rod, pieces, piece, offset, 0};
    for (int k = 0; k < pieces; k++) {
        // equally many segments, or one more or less
        int first = k * def->n_segment / pieces, last = (k + 1) * def->n_segment / pieces;
        BOUGH_TRY(bough_modal_piece_create(arena, def, first, last, options, &piece[k]));
        offset[k] = m->n_state;
        m->n_state += 2 * piece[k].m;
    }
    *model = m;
    return bough_ok();
}

// -- sweeps ---------------------------------------------------------------------------------------

// The frame of the first piece: the body's.
static bough_modal_frame body_frame(const double *input) {
    return (bough_modal_frame){bough_v3_load(input), bough_v3_load(input + 3), bough_v3_load(input + 6),
                               bough_transform_identity()};
}

static void forward(bough_modal_body *b, const double *state, const double *input) {
    const bough_modal_model *m = b->model;
    bough_modal_frame frame = body_frame(input);
    for (int k = 0; k < m->n_piece; k++) {
        const double *q = state + m->offset[k];
        bough_modal_forward(&b->point[k], &frame, q, q + m->piece[k].m);
        frame = b->point[k].tip;
    }
}

// Vertex loads at t: the sampled parabola and the ramped loads.
static void set_loads(bough_modal_body *b, double t) {
    int count = 6 * b->model->rod->stride;
    const bough_rod_loads *loads = &b->loads;
    double elapsed = t - loads->start, *load = b->load;
    for (int k = 0; k < count; k++) {
        load[k] = loads->value[k] + elapsed * (loads->rate[k] + elapsed * loads->curve[k]);
    }
    for (const bough_rod_ramped_load *l = loads->ramped; l != NULL; l = l->next) {
        double factor = bough_schedule_at(&l->schedule, t);
        for (int k = 0; k < count; k++) load[k] += factor * l->value[k];
    }
}

// Motions outwards, then wrenches inwards; the root wrench of the first piece only if `root`.
static void evaluate(bough_modal_body *b, double t, const double *state, const double *input, bool root) {
    bough_wrench outer = {{0, 0, 0}, {0, 0, 0}};
    set_loads(b, t);
    forward(b, state, input);
    for (int k = b->model->n_piece - 1; k >= 0; k--) {
        bough_modal_backward(&b->point[k], b->load, b->model->rod->stride, outer, root || k > 0);
        outer = b->point[k].root;
    }
}

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    bough_modal_body *b = self;
    const bough_modal_model *m = b->model;
    evaluate(b, t, state, input, false);
    for (int k = 0; k < m->n_piece; k++) {
        size_t size = (size_t)m->piece[k].m * sizeof *rate;
        memcpy(rate + m->offset[k], b->point[k].rate_q, size);
        memcpy(rate + m->offset[k] + m->piece[k].m, b->point[k].rate_eta, size);
    }
    return bough_all_finite(m->n_state, rate);
}

static void output(void *self, double t, const double *state, const double *input, double *wrench) {
    bough_modal_body *b = self;
    evaluate(b, t, state, input, true);
    bough_wrench_store(b->point[0].root, wrench);
    for (int c = 0; c < 6; c++) wrench[c] += b->load[c * b->model->rod->stride];
}

// -- tangents -------------------------------------------------------------------------------------

// Evaluates there, for the tangents along directions below.
static void set_slopes(bough_modal_body *b, double t, const double *state, const double *input) {
    evaluate(b, t, state, input, true);
    for (int k = 0; k < b->model->n_piece; k++) {
        bough_modal_slopes(&b->point[k], b->load, b->model->rod->stride);
    }
}

// Derivative of the rates, to rate (n_state), and of the root wrench (6) along a variation of state
// and input (9); either may be NULL for zero.
static void tangent(bough_modal_body *b, const double *y, const double *d, double *rate, double *wrench) {
    const bough_modal_model *m = b->model;
    bough_modal_frame_change *frame = b->change;
    bough_wrench outer = {{0, 0, 0}, {0, 0, 0}};
    // the first frame changes with the input
    frame[0] = (bough_modal_frame_change){0};
    if (d != NULL) {
        frame[0] = (bough_modal_frame_change){
            .velocity = bough_v3_load(d), .spin = bough_v3_load(d + 3), .gravity = bough_v3_load(d + 6)};
    }
    // motions outwards
    for (int k = 0; k < m->n_piece; k++) {
        const double *dq = y == NULL ? NULL : y + m->offset[k];
        const double *deta = y == NULL ? NULL : dq + m->piece[k].m;
        bough_modal_forward_tangent(&b->point[k], dq, deta, &frame[k], rate + m->offset[k], &frame[k + 1]);
    }
    // wrenches inwards
    for (int k = m->n_piece - 1; k >= 0; k--) {
        const double *dq = y == NULL ? NULL : y + m->offset[k];
        const double *deta = y == NULL ? NULL : dq + m->piece[k].m;
        double *to = rate + m->offset[k];
        outer =
            bough_modal_backward_tangent(&b->point[k], dq, deta, to, &frame[k], outer, to + m->piece[k].m);
    }
    bough_wrench_store(outer, wrench);
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *wrench) {
    bough_modal_body *b = self;
    set_slopes(b, t, state, input);
    tangent(b, state_rate, input_rate, b->rate, wrench);
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    bough_modal_body *b = self;
    set_slopes(b, t, state, input);
    for (int j = 0; j < BOUGH_ROD_INPUTS; j++) {
        double unit[BOUGH_ROD_INPUTS] = {0}, wrench[BOUGH_ROD_OUTPUTS];
        unit[j] = 1;
        tangent(b, NULL, unit, column + (size_t)j * (size_t)b->model->n_state, wrench);
    }
}

// -- Newton's matrix of all pieces, dense ---------------------------------------------------------

// Matrices by columns.
typedef struct newton {
    // computed by linearise
    double *jacobian; // ∂f/∂y (n_state × n_state)
    double *wrench;   // of the root wrench, ∂/∂y and ∂/∂u (6 × (n_state + 9))
    // computed by factor
    double *matrix; // I − γ ∂f/∂y, factored (n_state × n_state)
    int *pivot;     // (n_state)
} newton;

static void *factors(void *self, bough_arena *arena) {
    size_t n = (size_t)((const bough_modal_body *)self)->model->n_state;
    newton *k = bough_arena_take(arena, sizeof *k);
    bough_arena_each(arena, n * n, &k->jacobian, &k->matrix);
    k->wrench = bough_arena_doubles(arena, BOUGH_ROD_OUTPUTS * (n + BOUGH_ROD_INPUTS));
    k->pivot = bough_arena_take(arena, n * sizeof *k->pivot);
    return k;
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
    bough_modal_body *b = self;
    newton *k = factors;
    int n = b->model->n_state;
    double *wrench = k->wrench, unit[BOUGH_ROD_INPUTS] = {0};
    set_slopes(b, t, state, input);
    // columns by state
    for (int j = 0; j < n; j++, wrench += BOUGH_ROD_OUTPUTS) {
        b->unit[j] = 1;
        tangent(b, b->unit, NULL, k->jacobian + (size_t)j * (size_t)n, wrench);
        b->unit[j] = 0;
    }
    // the root wrench by input
    for (int j = 0; j < BOUGH_ROD_INPUTS; j++, wrench += BOUGH_ROD_OUTPUTS) {
        unit[j] = 1;
        tangent(b, NULL, unit, b->rate, wrench);
        unit[j] = 0;
    }
    return bough_all_finite(n * n, k->jacobian);
}

static bool kept_tangent(void *self, const void *factors, const double *state_rate, const double *input_rate,
                         double *wrench) {
    const double *const along[] = {state_rate, input_rate}, *column = ((const newton *)factors)->wrench;
    const int count[] = {((const bough_modal_body *)self)->model->n_state, BOUGH_ROD_INPUTS};
    memset(wrench, 0, BOUGH_ROD_OUTPUTS * sizeof *wrench);
    for (int part = 0; part < 2; part++) {
        for (int j = 0; j < count[part]; j++, column += BOUGH_ROD_OUTPUTS) {
            double factor = along[part] == NULL ? 0 : along[part][j];
            for (int c = 0; c < BOUGH_ROD_OUTPUTS; c++) wrench[c] += factor * column[c];
        }
    }
    return true;
}

static bool factor(void *self, void *factors, double gamma) {
    newton *k = factors;
    int n = ((const bough_modal_body *)self)->model->n_state;
    for (int j = 0; j < n * n; j++) k->matrix[j] = (j % (n + 1) == 0) - gamma * k->jacobian[j];
    return bough_dense_factor(n, k->matrix, k->pivot);
}

static void solve(void *self, void *factors, double *x) {
    const newton *k = factors;
    bough_dense_solve(((const bough_modal_body *)self)->model->n_state, 1, k->matrix, k->pivot, x);
}

// -- states ---------------------------------------------------------------------------------------

// The undeformed body moving rigidly with its frame.
static void set_initial(bough_modal_body *b, const double *input) {
    const bough_modal_model *m = b->model;
    bough_vec3 u0 = bough_v3_load(input), omega = bough_v3_load(input + 3);
    for (int k = 0; k < m->n_piece; k++) {
        const bough_modal_piece *p = &m->piece[k];
        double *eta = b->initial + m->offset[k] + p->m, twist[6];
        // η of the rigid motion with the frame: C times the twist there
        bough_vec3 u = bough_add(u0, bough_cross(omega, m->rod->position0[p->first]));
        bough_twist_store((bough_twist){u, omega}, twist);
        for (int c = 0; c < 6; c++) {
            for (int l = 0; l < p->m; l++) eta[l] += p->rigid[c * p->stride + l] * twist[c];
        }
    }
}

void bough_modal_body_move_rigidly(bough_modal_body *b, const double *input, double *state) {
    const bough_modal_model *m = b->model;
    bough_modal_frame frame = body_frame(input);
    for (int k = 0; k < m->n_piece; k++) {
        bough_modal_point *at = &b->point[k];
        double *q = state + m->offset[k], *eta = q + m->piece[k].m;
        memset(eta, 0, (size_t)m->piece[k].m * sizeof *eta);
        // q̇ = η − …: the η that makes it 0 is minus q̇ at η = 0
        bough_modal_forward(at, &frame, q, eta);
        for (int l = 0; l < m->piece[k].m; l++) eta[l] = -at->rate_q[l];
        bough_modal_forward(at, &frame, q, eta);
        frame = at->tip;
    }
}

// Vertex i of a piece into entry v of the rod's state (13 × n): pose and velocities by the shapes, in the
// piece's frame, then in the body's and in section axes.
static void expand_vertex(const bough_modal_point *at, int i, int v, int n, double *to) {
    const bough_modal_piece *p = at->piece;
    bough_twist shift = bough_modal_vertex(p, i, at->q);
    bough_twist rate = bough_modal_vertex(p, i, at->rate_q);
    bough_vec3 x = bough_add(p->rod->position0[i], shift.linear);
    bough_vec3 u = bough_add(bough_add(at->frame.velocity, rate.linear), bough_cross(at->frame.spin, x));
    bough_vec3 w = bough_add(at->frame.spin, bough_modal_spin(shift.angular, rate.angular));
    bough_quaternion turned =
        bough_quaternion_product(bough_quaternion_exponential(shift.angular), p->rod->rotation0[i]);
    w = bough_mat3_tmul(bough_rotation_matrix(turned), w);
    u = bough_mat3_mul(at->frame.pose.rotation, u);
    x = bough_add(at->frame.pose.position, bough_mat3_mul(at->frame.pose.rotation, x));
    bough_quaternion r =
        bough_quaternion_product(bough_quaternion_of_matrix(at->frame.pose.rotation), turned);
    const double values[BOUGH_ROD_STATES] = {x.x, x.y, x.z, r.w, r.x, r.y, r.z, u.x, u.y, u.z, w.x, w.y, w.z};
    for (int c = 0; c < BOUGH_ROD_STATES; c++) to[c * n + v] = values[c];
}

const double *bough_modal_body_vertices(bough_modal_body *b, const double *state, const double *input,
                                        int first) {
    forward(b, state, input);
    for (int k = 0; k < b->model->n_piece; k++) {
        const bough_modal_piece *p = &b->model->piece[k];
        for (int i = first > p->first ? first - p->first : 1; i <= p->n; i++) {
            expand_vertex(&b->point[k], i, p->first + i - 1, b->model->rod->n, b->vertices);
        }
    }
    return b->vertices;
}

// -- life -----------------------------------------------------------------------------------------

static void take_memory(bough_modal_body *b, bough_arena *arena) {
    const bough_modal_model *m = b->model;
    size_t n_piece = (size_t)m->n_piece;
    bough_arena_each(arena, (size_t)m->n_state, &b->initial, &b->scale, &b->unit, &b->rate);
    b->vertices = bough_arena_doubles(arena, (size_t)BOUGH_ROD_STATES * m->rod->n);
    b->point = bough_arena_take(arena, n_piece * sizeof *b->point);
    b->load = bough_arena_doubles(arena, 6 * (size_t)m->rod->stride);
    b->change = bough_arena_take(arena, (n_piece + 1) * sizeof *b->change);
    for (int k = 0; k < m->n_piece; k++) bough_modal_point_init(&b->point[k], arena, &m->piece[k]);
    bough_rod_loads_init(&b->loads, arena, m->rod);
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
    set_initial(b, input);
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

const bough_modal_model *bough_modal_body_model(const bough_modal_body *body) { return body->model; }

bough_rod_loads *bough_modal_body_loads(bough_modal_body *body) { return &body->loads; }

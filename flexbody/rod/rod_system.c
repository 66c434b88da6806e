// The rod as a system, and its ports linearised: what the motion of its two ends does to the rod, and the rod
// to them.
#include "flexbody/rod/rod_system.h"

#include "core/base/linalg.h"
#include "flexbody/rod/rod_lanes.h"
#include "flexbody/rod/rod_tangent.h"
#include "flexbody/rod/rod_tangent_layout.h"

struct bough_rod_body {
    const bough_rod_model *model;
    bough_rod_loads loads;
    double *initial; // (13 n)
    double *scale;   // (13 n)
    bough_rod_scratch scratch;
};

// p⁻¹∘r: the rotation 2·vector of a quaternion's variation r, any |p|
BOUGH_INLINE bough_vec3 rotation_of(const double *p, int p_stride, const double *r, int stride) {
    bough_quaternion q = lane_load_quaternion(p, p_stride, 0), dq = lane_load_quaternion(r, stride, 0);
    bough_quaternion d = bough_quaternion_product(bough_quaternion_conjugate(q), dq);
    double inverse = 1 / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return bough_scale(2 * inverse, bough_v3(d.x, d.y, d.z));
}

// -- variations of vertices -----------------------------------------------------------------------

// Of the root, along a change of the BRF's velocity and angular velocity.
BOUGH_INLINE vertex_variation root_variation(const bough_rod_model *m, const double *d) {
    return (vertex_variation){.u = bough_v3_load(d), .w = bough_mat3_tmul(m->root, bough_v3_load(d + 3))};
}

// Of the moving vertex i + 1, whose quaternion is p, along the variation d of the state.
BOUGH_INLINE vertex_variation state_variation(const bough_rod_model *m, const double *p, int stride,
                                              const double *d, int i) {
    int n = m->n;
    return (vertex_variation){.x = lane_load(d, n, i),
                              .phi = rotation_of(p, stride, d + 3 * n + i, n),
                              .u = lane_load(d + (size_t)BOUGH_ROD_U * n, n, i),
                              .w = lane_load(d + (size_t)BOUGH_ROD_W * n, n, i)};
}

// Of the last vertex, whose quaternion is p; its motion: u, W, x, p.
static vertex_variation end_variation(const double *p, const double *d) {
    return (vertex_variation){.u = bough_v3_load(d),
                              .w = bough_v3_load(d + 3),
                              .x = bough_v3_load(d + 6),
                              .phi = rotation_of(p, 1, d + 9, 1)};
}

// Of the vertices of the first segment, and of the last one of a rod that carries bodies.
typedef struct variations {
    vertex_variation left[2], right[2];
} variations;

// p: the quaternions of the moving vertices; end: that of the last vertex. Either rate may be NULL for zero.
BOUGH_INLINE variations variations_along(const bough_rod_model *m, const double *p, int stride,
                                         const double *end, const double *state_rate,
                                         const double *input_rate) {
    variations v = {0};
    bool carries = bough_rod_carries(m);
    int last = m->n - 1;
    if (input_rate != NULL) v.left[0] = root_variation(m, input_rate);
    if (state_rate != NULL) v.right[0] = state_variation(m, p, stride, state_rate, 0);
    if (state_rate != NULL && carries) v.left[1] = state_variation(m, p + last, stride, state_rate, last);
    if (input_rate != NULL && carries) v.right[1] = end_variation(end, input_rate + BOUGH_ROD_INPUTS);
    return v;
}

// -- the wrenches ---------------------------------------------------------------------------------

// theory (12): all that the carrier feels is the first segment's force on the root; moment in BRF axes.
static void put_root(const bough_rod_model *m, segment_force f, double *wrench) {
    bough_v3_store(f.f, wrench);
    bough_v3_store(bough_mat3_mul(m->root, f.ll), wrench + 3);
}

// `load`: how the loads on the vertex change with its rotation.
static void put_end(segment_force load, segment_force f, double *wrench) {
    bough_v3_store(bough_sub(load.f, f.f), wrench);
    bough_v3_store(bough_add(load.lr, f.lr), wrench + 3);
}

// Change of the loads on the last vertex with its rotation phi: in section axes that of a dead moment, in BRF
// axes that of a follower's force.
static segment_force load_variation(const bough_rod_model *m, const bough_rod_loads *loads,
                                    const bough_rod_scratch *scratch, bough_vec3 phi) {
    int s = m->stride, end = m->n_segment;
    bough_mat3 r = bough_rotation_matrix(load_vertex(scratch->vertex, s, end).p);
    bough_vec3 moment = bough_mat3_tmul(r, lane_load(scratch->load + 3 * s, s, end));
    segment_force d = {.f = {0, 0, 0}};
    if (bough_rod_loads_follow(loads)) {
        bough_vec3 force = lane_load(scratch->follower, s, end);
        d.f = bough_mat3_mul(r, bough_cross(phi, force));
        moment = bough_sub(moment, lane_load(scratch->follower + 3 * s, s, end));
    }
    d.lr = bough_cross(moment, phi);
    return d;
}

void bough_rod_keep_end(const bough_rod_model *m, const bough_rod_loads *loads, const double *end,
                        const bough_rod_scratch *scratch, bough_rod_tangent *k) {
    memcpy(k->end_rotation, end + 9, 4 * sizeof(double));
    for (int j = 0; j < 3; j++) {
        segment_force load = load_variation(m, loads, scratch, bough_unit3(j));
        lane_store(k->end_load + 3 * j, 1, 0, load.f);
        lane_store(k->end_load + 9 + 3 * j, 1, 0, load.lr);
    }
}

// A segment's forces by the motion of its vertices, from its kept tangents.
BOUGH_INLINE segment_force kept_force(const double *position, vertex_variation l, vertex_variation r) {
    // the directions of the tangents: differences of place and velocity, rotations of both vertices
    double q[DIRECTIONS], v[DIRECTIONS], force[FORCES] = {0};
    const double *velocity = position + TANGENTS;
    lane_store(q + DELTA, 1, 0, bough_sub(r.x, l.x));
    lane_store(q + LEFT, 1, 0, l.phi);
    lane_store(q + RIGHT, 1, 0, r.phi);
    lane_store(v + DELTA, 1, 0, bough_sub(r.u, l.u));
    lane_store(v + LEFT, 1, 0, l.w);
    lane_store(v + RIGHT, 1, 0, r.w);
    for (int d = 0; d < DIRECTIONS; d++, position += FORCES, velocity += FORCES) {
        for (int f = 0; f < FORCES; f++) force[f] += position[f] * q[d] + velocity[f] * v[d];
    }
    return (segment_force){bough_v3_load(force + F), bough_v3_load(force + LL), bough_v3_load(force + LR)};
}

// Both wrenches where the factors were linearised, from their tangents.
static bool kept_tangent(void *self, const void *factors, const double *state_rate, const double *input_rate,
                         double *wrench) {
    const bough_rod_model *m = ((const bough_rod_body *)self)->model;
    const bough_rod_tangent *k = factors;
    int s = m->stride;
    variations v =
        variations_along(m, k->vertex + (size_t)KEPT_P * s + 1, s, k->end_rotation, state_rate, input_rate);
    put_root(m, kept_force(k->root, v.left[0], v.right[0]), wrench);
    if (!bough_rod_carries(m)) return true;
    // the last segment, and the loads on the last vertex
    bough_vec3 phi = v.right[1].phi;
    segment_force load = {.f = bough_mat3_mul(lane_load_matrix(k->end_load, 1, 0), phi),
                          .lr = bough_mat3_mul(lane_load_matrix(k->end_load + 9, 1, 0), phi)};
    put_end(load, kept_force(k->end, v.left[1], v.right[1]), wrench + BOUGH_ROD_OUTPUTS);
    return true;
}

// -- the rate -------------------------------------------------------------------------------------

// Adds the acceleration of moving vertex i + 1 by a force in BRF axes and a moment in section axes.
static void vertex_response(const bough_rod_model *m, const bough_rod_scratch *scratch, int i,
                            bough_vec3 force, bough_vec3 moment, double *column) {
    int n = m->n;
    bough_mat3 r = bough_rotation_matrix(load_vertex(scratch->vertex, m->stride, i + 1).p);
    strain h = {bough_mat3_tmul(r, force), moment};
    strain q = symmetric_times(bough_rod_tile(m->inverse_mass, 21, i), BOUGH_LANES, 0, h);
    bough_vec3 u = bough_mat3_mul(r, q.v);
    const double values[6] = {u.x, u.y, u.z, q.u.x, q.u.y, q.u.z};
    for (int c = 0; c < 6; c++) column[(BOUGH_ROD_U + c) * n + i] += values[c];
}

// Column of ∂f/∂ω along a unit vector e over the vertices' kinematics, by theory (16): −e×x, −½ (0,e)∘p; and
// −e×u of (11).
static void spin_column(int n, const double *restrict state, bough_vec3 e, double *restrict column) {
#pragma omp simd
    for (int i = 0; i < n; i++) {
        bough_vec3 x = lane_load(state, n, i), u = lane_load(state + BOUGH_ROD_U * n, n, i);
        bough_quaternion p = lane_load_quaternion(state + BOUGH_ROD_P * n, n, i);
        bough_quaternion rate = bough_quaternion_product((bough_quaternion){0, e.x, e.y, e.z}, p);
        lane_store(column, n, i, bough_cross(x, e));
        column[3 * n + i] = -0.5 * rate.w;
        lane_store(column + 4 * n, n, i, bough_scale(-0.5, bough_v3(rate.x, rate.y, rate.z)));
        lane_store(column + BOUGH_ROD_U * n, n, i, bough_cross(u, e));
    }
}

// That of u₀, ω or g, by `kind`.
static void frame_column(int n, const double *state, int kind, int axis, double *column) {
    int row = kind == 0 ? axis : BOUGH_ROD_U + axis;
    if (kind == 1) spin_column(n, state, bough_unit3(axis), column);
    for (int i = 0; i < n && kind != 1; i++) column[row * n + i] = kind - 1;
}

// The root's motion strains the first segment.
static void root_columns(const bough_rod_model *m, const double *state, const bough_rod_scratch *scratch,
                         double *column) {
    for (int j = 0; j < BOUGH_ROD_INPUTS; j++, column += (size_t)BOUGH_ROD_STATES * m->n) {
        double e[6] = {0};
        frame_column(m->n, state, j / 3, j % 3, column);
        if (j / 3 == 2) continue;
        e[j] = 1;
        vertex_variation l = root_variation(m, e), r = {0};
        segment_force f = segment_tangent(m, scratch, 0, &l, &r);
        vertex_response(m, scratch, 0, bough_scale(-1, f.f), f.lr, column);
    }
}

// The end's motion strains the last one.
static void end_columns(const bough_rod_model *m, const double *end, const bough_rod_scratch *scratch,
                        double *column) {
    for (int j = 0; j < BOUGH_ROD_END_INPUTS; j++, column += (size_t)BOUGH_ROD_STATES * m->n) {
        double e[BOUGH_ROD_END_INPUTS] = {0};
        e[j] = 1;
        vertex_variation l = {0}, r = end_variation(end + 9, e);
        segment_force f = segment_tangent(m, scratch, m->n, &l, &r);
        vertex_response(m, scratch, m->n - 1, f.f, f.ll, column);
    }
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    bough_rod_body *b = self;
    const bough_rod_model *m = b->model;
    bough_rod_scratch *scratch = &b->scratch;
    size_t size = (size_t)BOUGH_ROD_STATES * m->n, inputs = (size_t)bough_rod_n_inputs(m);
    bough_rod_gather(m, state, input, scratch);
    bough_rod_load(m, &b->loads, t, scratch);
    memset(column, 0, inputs * size * sizeof *column);
    root_columns(m, state, scratch, column);
    if (!bough_rod_carries(m)) return;
    end_columns(m, input + BOUGH_ROD_INPUTS, scratch, column + BOUGH_ROD_INPUTS * size);
}

// -- the contract -----------------------------------------------------------------------------------

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    bough_rod_body *b = self;
    return bough_rod_derivative(b->model, &b->loads, t, state, input, &b->scratch, rate);
}

static void output(void *self, double t, const double *state, const double *input, double *wrench) {
    bough_rod_body *b = self;
    bough_rod_wrenches(b->model, &b->loads, t, state, input, &b->scratch, wrench);
}

// The wrenches by the forces of the derivative just evaluated, and of the second derivative what the first
// has.
static bool evaluate(void *self, const double *state, int n, const bough_evaluation *at) {
    bough_rod_body *b = self;
    bool ok = true;
    for (int k = 0; k < n && ok; k++) {
        const double t = at[k].t, *input = at[k].input;
        ok = k == 0
                 ? derivative(b, t, state, input, at[k].rate)
                 : bough_rod_derivative_again(b->model, &b->loads, t, state, input, &b->scratch, at[k].rate);
        if (at[k].output != NULL) bough_rod_present_wrenches(b->model, &b->scratch, at[k].output);
    }
    return ok;
}

static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    bough_rod_body *b = self;
    const bough_rod_model *m = b->model;
    bool carries = bough_rod_carries(m);
    double now[BOUGH_ROD_MOST_OUTPUTS]; // leaves vertices and loads in scratch
    output(b, t, state, input, now);
    variations v = variations_along(m, state + (size_t)BOUGH_ROD_P * m->n, m->n,
                                    carries ? input + BOUGH_ROD_INPUTS + 9 : NULL, state_rate, input_rate);
    put_root(m, segment_tangent(m, &b->scratch, 0, &v.left[0], &v.right[0]), rate);
    if (!carries) return;
    put_end(load_variation(m, &b->loads, &b->scratch, v.right[1].phi),
            segment_tangent(m, &b->scratch, m->n, &v.left[1], &v.right[1]), rate + BOUGH_ROD_OUTPUTS);
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

// A displacement d of the end and its rotation by phi, spread over a straight rod of this length without
// loads, at the part t of it. The axis is zero for a ring, which has no direction from end to end.
static void spread(bough_vec3 axis, double length, double t, bough_vec3 *d, bough_vec3 *phi) {
    double bubble = t * (1 - t);
    bough_vec3 turned = bough_scale(length, bough_cross(*phi, axis));
    bough_vec3 side = bough_sub(*d, bough_scale(bough_dot(axis, *d), axis));
    bough_vec3 bent = bough_sub(bough_scale(2 * t - 1, side), bough_scale(t, turned));
    bough_vec3 slope = bough_cross(axis, bough_sub(bough_scale(2, *d), turned));
    *d = bough_add(bough_scale(t, *d), bough_scale(bubble, bent));
    *phi = bough_add(bough_scale(t, *phi), bough_scale(3 * bubble / length, slope));
}

// In a closed loop the end may be off its undeformed place: the whole rod yields, not its last segment alone.
static void follow_end(const bough_rod_model *m, const double *end, double *state) {
    int n = m->n, last = m->n_segment;
    bough_vec3 chord = m->position0[last], off = bough_sub(bough_v3_load(end + 6), chord);
    double length = m->span[last], apart = bough_norm(chord);
    bough_vec3 axis = bough_scale(apart > 1e-6 * length ? 1 / apart : 0, chord);
    bough_quaternion p = {end[9], end[10], end[11], end[12]},
                     back = bough_quaternion_conjugate(m->rotation0[last]);
    for (int i = 0; i < n; i++) {
        bough_vec3 d = off, phi = bough_quaternion_logarithm(bough_quaternion_product(p, back));
        spread(axis, length, m->span[i + 1] / length, &d, &phi);
        bough_vec3 x = bough_add(m->position0[i + 1], d);
        bough_quaternion r = bough_quaternion_product(bough_quaternion_exponential(phi), m->rotation0[i + 1]);
        const double values[] = {x.x, x.y, x.z, r.w, r.x, r.y, r.z};
        for (int c = 0; c < BOUGH_ROD_U; c++) state[c * n + i] = values[c];
    }
}

bough_rod_body *bough_rod_body_create(bough_arena *arena, const bough_rod_model *model, const double *input) {
    // error scales of x, p, u, W: a tenth of a radian weighs as a metre
    static const double scale[BOUGH_ROD_STATES] = {1, 1, 1, 0.1, 0.1, 0.1, 0.1, 1, 1, 1, 0.1, 0.1, 0.1};
    bough_rod_body *b = bough_arena_take(arena, sizeof *b);
    b->model = model;
    bough_arena_each(arena, (size_t)BOUGH_ROD_STATES * model->n, &b->initial, &b->scale);
    bough_rod_loads_init(&b->loads, arena, model);
    bough_rod_scratch_init(&b->scratch, arena, model);
    bough_rod_rest_state(model, input, b->initial);
    if (bough_rod_carries(model)) follow_end(model, input + BOUGH_ROD_INPUTS, b->initial);
    for (int k = 0; k < BOUGH_ROD_STATES * model->n; k++) b->scale[k] = scale[k / model->n];
    return b;
}

// The greatest ratio of stiffness to viscosity over segments and strains.
static double elastic_rate(const bough_rod_model *m) {
    double greatest = 0;
    for (int n = 0; n < m->n_segment; n++) {
        for (int i = 0; i < 6; i++) {
            int k = bough_symmetric6_index(i, i) * BOUGH_LANES;
            double c = bough_rod_tile(m->stiffness, 21, n)[k], d = bough_rod_tile(m->damping, 21, n)[k];
            greatest = fmax(greatest, d > 0 ? c / d : (double)INFINITY);
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

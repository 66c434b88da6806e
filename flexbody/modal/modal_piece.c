#include "flexbody/modal/modal_system.h"

// -- vectors over the shapes, matrices by columns (m × stride) -----------------------------------------

static inline double dot(int n, const double *restrict x, const double *restrict y) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int k = 0; k < n; k++) sum += x[k] * y[k];
    return sum;
}

static inline void add_scaled(int n, double c, const double *restrict x, double *restrict y) {
#pragma omp simd
    for (int k = 0; k < n; k++) y[k] += c * x[k];
}

// y += c A x; of a unit vector x one column
static inline void add_product(const bough_modal_piece *p, double c, const double *a, const double *x,
                               double *y) {
    for (int l = 0; l < p->m; l++) {
        if (x[l] != 0) add_scaled(p->m, c * x[l], a + (size_t)l * p->stride, y);
    }
}

// y += Σ c_a A_a x of three matrices, one after the other in memory
static inline void add_products3(const bough_modal_piece *p, const double *c, const double *list,
                                 const double *x, double *restrict y) {
    size_t size = (size_t)p->m * p->stride;
    for (int l = 0; l < p->m; l++) {
        const double *restrict a = list + (size_t)l * p->stride;
        double c0 = c[0] * x[l], c1 = c[1] * x[l], c2 = c[2] * x[l];
#pragma omp simd
        for (int k = 0; k < p->m; k++) {
            y[k] += c0 * a[k] + c1 * a[size + k] + c2 * a[2 * size + k];
        }
    }
}

// y += Aᵀ x
static inline void add_transposed(const bough_modal_piece *p, const double *a, const double *x, double *y) {
    for (int l = 0; l < p->m; l++) y[l] += dot(p->m, a + (size_t)l * p->stride, x);
}

static inline const double *matrix(const bough_modal_piece *p, const double *list, int j) {
    return list + (size_t)j * p->m * p->stride;
}

static inline void clear(const bough_modal_piece *p, int rows, double *x) {
    memset(x, 0, (size_t)rows * p->stride * sizeof *x);
}

static inline double component(bough_vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

// The products of three rows with x, and their sum weighted by c.
static inline bough_vec3 dot3(const bough_modal_piece *p, const double *rows, const double *x) {
    const double *restrict a = rows, *restrict b = rows + p->stride;
    const double *restrict c = rows + 2 * p->stride, *restrict v = x;
    double sum_a = 0, sum_b = 0, sum_c = 0;
#pragma omp simd reduction(+ : sum_a, sum_b, sum_c)
    for (int k = 0; k < p->m; k++) {
        sum_a += a[k] * v[k];
        sum_b += b[k] * v[k];
        sum_c += c[k] * v[k];
    }
    return bough_v3(sum_a, sum_b, sum_c);
}

static inline void add3(const bough_modal_piece *p, double sign, const double *rows, bough_vec3 c,
                        double *y) {
    const double *restrict a = rows, *restrict b = rows + p->stride;
    const double *restrict d = rows + 2 * p->stride;
    double *restrict to = y;
    bough_vec3 w = bough_scale(sign, c);
#pragma omp simd
    for (int k = 0; k < p->m; k++) to[k] += w.x * a[k] + w.y * b[k] + w.z * d[k];
}

bough_twist bough_modal_vertex(const bough_modal_piece *p, int i, const double *q) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    return (bough_twist){dot3(p, rows, q), dot3(p, rows + 3 * p->stride, q)};
}

// Φᵢᵀ(force, moment)
static inline void add_force(const bough_modal_piece *p, int i, bough_wrench w, double *to) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    add3(p, 1, rows, w.force, to);
    add3(p, 1, rows + 3 * p->stride, w.moment, to);
}

// A load of the body at vertex i, in frame axes.
static inline bough_wrench vertex_load(const bough_modal_point *at, const double *load, int stride, int i) {
    const double *f = load + at->piece->first + i;
    bough_mat3 r = at->frame.pose.rotation;
    return (bough_wrench){bough_mat3_tmul(r, bough_v3(f[0], f[stride], f[2 * stride])),
                          bough_mat3_tmul(r, bough_v3(f[3 * stride], f[4 * stride], f[5 * stride]))};
}

static inline bough_twist frame_twist(const bough_modal_frame *f) {
    return (bough_twist){f->velocity, f->spin};
}

// ω_aω_b in the order of the fields, of the symmetric product of two vectors.
static inline void squares(bough_vec3 v, bough_vec3 w, double *to) {
    const double values[6] = {v.x * w.x,
                              v.y * w.y,
                              v.z * w.z,
                              0.5 * (v.x * w.y + v.y * w.x),
                              0.5 * (v.x * w.z + v.z * w.x),
                              0.5 * (v.y * w.z + v.z * w.y)};
    memcpy(to, values, sizeof values);
}

// (C_a + G_a q)ᵀx
static inline bough_vec3 arms_times(const bough_modal_point *at, const double *x) {
    const bough_modal_piece *p = at->piece;
    return bough_add(dot3(p, p->rigid + 3 * p->stride, x), dot3(p, at->rotating_q, x));
}

// Momentum (P, L) about the frame's origin.
static inline bough_wrench momentum_of(const bough_modal_point *at) {
    return (bough_wrench){dot3(at->piece, at->piece->rigid, at->eta), arms_times(at, at->eta)};
}

// -- life ------------------------------------------------------------------------------------------

void bough_modal_point_init(bough_modal_point *point, bough_arena *arena, const bough_modal_piece *piece) {
    size_t s = (size_t)piece->stride;
    point->piece = piece;
    point->coefficient = bough_arena_doubles(arena, BOUGH_MODAL_FIELDS);
    point->field_q = bough_arena_doubles(arena, BOUGH_MODAL_FIELDS * s);
    bough_arena_each(arena, s, &point->rate_q, &point->force, &point->rate_eta, &point->rest);
    bough_arena_each(arena, 3 * s, &point->rotating_q, &point->rotating_rate, &point->lever,
                     &point->gyroscopic_eta, &point->eta_rotating, &point->rest_rotating,
                     &point->force_by_rotation);
    bough_arena_each(arena, (size_t)piece->m * s, &point->rotating, &point->gyroscopic, &point->field);
}

bough_vec3 bough_modal_spin(bough_vec3 psi, bough_vec3 rate) {
    return bough_exp_tangent(bough_exp_factors_of(psi), psi, rate);
}

// -- forward --------------------------------------------------------------------------------------

// The tip's frame: pose x̂⁰ + ξ, exp(ψ), and its twist.
static void set_tip(bough_modal_point *at) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *frame = &at->frame;
    bough_twist shift = at->tip_shift = bough_modal_vertex(p, p->n, at->q);
    bough_twist rate = at->tip_rate = bough_modal_vertex(p, p->n, at->rate_q);
    bough_mat3 e = at->tip_rotation = bough_rotation_matrix(bough_quaternion_exponential(shift.angular));
    bough_vec3 x = bough_add(p->rod->position0[p->n], shift.linear);
    bough_vec3 u = bough_add(bough_add(frame->velocity, rate.linear), bough_cross(frame->spin, x));
    bough_vec3 w = bough_add(frame->spin, bough_modal_spin(shift.angular, rate.angular));
    at->tip.velocity = bough_mat3_tmul(e, u);
    at->tip.spin = bough_mat3_tmul(e, w);
    at->tip.gravity = bough_mat3_tmul(e, frame->gravity);
    at->tip.pose = bough_transform_compose(frame->pose, (bough_transform){x, e});
}

// theory (35)
void bough_modal_forward(bough_modal_point *at, const bough_modal_frame *frame, const double *q,
                         const double *eta) {
    const bough_modal_piece *p = at->piece;
    int s = p->stride;
    at->frame = *frame;
    at->q = q;
    at->eta = eta;
    clear(p, 3, at->rotating_q);
    for (int a = 0; a < 3; a++) add_product(p, 1, matrix(p, p->rotating, a), q, at->rotating_q + a * s);
    memcpy(at->rate_q, eta, (size_t)p->m * sizeof *eta);
    add3(p, -1, p->rigid, frame->velocity, at->rate_q);
    add3(p, -1, p->rigid + 3 * s, frame->spin, at->rate_q);
    add3(p, -1, at->rotating_q, frame->spin, at->rate_q);
    if (p->inner) set_tip(at);
}

// -- backward -------------------------------------------------------------------------------------

// The outer wrench in frame axes, and its moment conjugate to ψ̇.
static bough_wrench outer_wrench(const bough_modal_point *at, bough_vec3 *working) {
    bough_wrench w = {bough_mat3_mul(at->tip_rotation, at->outer.force),
                      bough_mat3_mul(at->tip_rotation, at->outer.moment)};
    *working = bough_modal_spin(bough_scale(-1, at->tip_shift.angular), w.moment);
    return w;
}

// A wrench at vertex i adds to the resultant about the frame's origin.
static void add_resultant(const bough_modal_point *at, int i, bough_wrench w, bough_wrench *resultant) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 x =
        bough_add(p->rod->position0[i], dot3(p, p->shape + (size_t)6 * (i - 1) * p->stride, at->q));
    resultant->force = bough_add(resultant->force, w.force);
    resultant->moment = bough_add(resultant->moment, bough_add(w.moment, bough_cross(x, w.force)));
}

static const bough_wrench no_wrench = {{0, 0, 0}, {0, 0, 0}};

// Φᵀf and, if `root`, the loads' resultant at the displaced vertices.
static bough_wrench gather_loads(bough_modal_point *at, const double *load, int stride, bool root) {
    const bough_modal_piece *p = at->piece;
    bough_wrench resultant = no_wrench;
    clear(p, 1, at->force);
    for (int i = 1; i <= p->n; i++) {
        bough_wrench w = vertex_load(at, load, stride, i);
        add_force(p, i, w, at->force);
        if (root) add_resultant(at, i, w, &resultant);
    }
    if (!p->inner) return resultant;
    bough_vec3 working;
    bough_wrench outer = outer_wrench(at, &working);
    add_force(p, p->n, (bough_wrench){outer.force, working}, at->force);
    if (root) add_resultant(at, p->n, outer, &resultant);
    for (int k = 0; k < 3; k++) at->coefficient[9 + k] = component(outer.force, k);
    return resultant;
}

// theory (36)
static void set_rate(bough_modal_point *at) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *f = &at->frame;
    double *rate = at->rate_eta, *c = at->coefficient;
    // coefficients of the fields: ω_a ω_b, the apparent acceleration a_k
    squares(f->spin, f->spin, c);
    bough_vec3 apparent = bough_sub(bough_cross(f->spin, f->velocity), f->gravity);
    for (int k = 0; k < 3; k++) c[6 + k] = component(apparent, k);
    // loads, elastic and viscous forces
    memcpy(rate, at->force, (size_t)p->m * sizeof *rate);
    for (int k = 0; k < p->m; k++) rate[k] -= p->square[k] * at->q[k];
    add_product(p, -1, p->damping, at->rate_q, rate);
    // gyroscopic forces, fields, centrifugal force, weight
    const double spin[3] = {-f->spin.x, -f->spin.y, -f->spin.z};
    add_products3(p, spin, p->gyroscopic, at->eta, rate);
    for (int j = 0; j < (p->inner ? BOUGH_MODAL_FIELDS : 9); j += 3) {
        add_products3(p, c + j, matrix(p, p->field, j), at->q, rate);
    }
    for (int j = 0; j < BOUGH_MODAL_SQUARES; j++) {
        add_scaled(p->m, c[j], p->centrifugal + j * p->stride, rate);
    }
    add3(p, 1, p->rigid, f->gravity, rate);
}

// theory (37): the root wrench is the loads less the rates of momentum.
static void set_root(bough_modal_point *at, bough_wrench loads) {
    const bough_modal_piece *p = at->piece;
    double *rest = at->rest;
    // G_a q̇, the rate of the arms
    clear(p, 3, at->rotating_rate);
    for (int a = 0; a < 3; a++) {
        add_product(p, 1, matrix(p, p->rotating, a), at->rate_q, at->rotating_rate + a * p->stride);
    }
    // loads and weight less C_tη̇ and (C_a + G_a q)ᵀη̇
    for (int k = 0; k < p->m; k++) rest[k] = -at->rate_eta[k];
    add3(p, 1, p->rigid, at->frame.gravity, rest);
    bough_wrench w = {bough_add(loads.force, dot3(p, p->rigid, rest)),
                      bough_add(loads.moment, arms_times(at, rest))};
    w.moment = bough_sub(w.moment, dot3(p, at->rotating_rate, at->eta));
    // transport of momentum by the frame
    bough_wrench carried = bough_wrench_cross(frame_twist(&at->frame), momentum_of(at));
    at->root = bough_wrench_sub(w, carried);
}

void bough_modal_backward(bough_modal_point *at, const double *load, int load_stride, bough_wrench outer,
                          bool root) {
    at->outer = outer;
    bough_wrench loads = gather_loads(at, load, load_stride, root);
    set_rate(at);
    if (root) set_root(at, loads);
}

// -- slopes ---------------------------------------------------------------------------------------

// to = Σ c_j A_j
static void combine(const bough_modal_piece *p, int count, const double *c, const double *list, double *to) {
    size_t size = (size_t)p->m * p->stride;
    memset(to, 0, size * sizeof *to);
    for (int j = 0; j < count; j++) {
        if (c[j] != 0) add_scaled((int)size, c[j], matrix(p, list, j), to);
    }
}

// The moment of a force at vertex i about each axis, per unit of q: Φᵢ × f
static void add_lever(const bough_modal_piece *p, int i, bough_vec3 f, double *lever) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    for (int a = 0; a < 3; a++) {
        add3(p, 1, rows, bough_cross(f, bough_unit3(a)), lever + a * p->stride);
    }
}

static void set_lever(bough_modal_point *at, const double *load, int stride) {
    const bough_modal_piece *p = at->piece;
    clear(p, 3, at->lever);
    for (int i = 1; i <= p->n; i++) {
        bough_vec3 force = vertex_load(at, load, stride, i).force;
        if (i == p->n && p->inner) {
            const double *outer = at->coefficient + 9;
            force = bough_add(force, bough_v3_load(outer));
        }
        add_lever(p, i, force, at->lever);
    }
}

// Derivatives of the loads by a rotation of the frame, with which they do not rotate.
static void set_load_rotations(bough_modal_point *at, const double *load, int stride) {
    const bough_modal_piece *p = at->piece;
    clear(p, 3, at->force_by_rotation);
    for (int a = 0; a < 3; a++) {
        bough_vec3 sum = {0, 0, 0};
        for (int i = 1; i <= p->n; i++) {
            bough_wrench w = vertex_load(at, load, stride, i);
            w.force = bough_cross(w.force, bough_unit3(a));
            w.moment = bough_cross(w.moment, bough_unit3(a));
            add_force(p, i, w, at->force_by_rotation + a * p->stride);
            bough_vec3 x = bough_add(p->rod->position0[i], bough_modal_vertex(p, i, at->q).linear);
            sum = bough_add(sum, bough_add(w.moment, bough_cross(x, w.force)));
        }
        at->moment_by_rotation[a] = sum;
    }
}

// Combines the matrices and products on which the tangents of (35) to (37) depend.
void bough_modal_slopes(bough_modal_point *at, const double *load, int load_stride) {
    const bough_modal_piece *p = at->piece;
    const double spin[3] = {at->frame.spin.x, at->frame.spin.y, at->frame.spin.z};
    int s = p->stride;
    // Σ ω_a G_a, Σ ω_a B_a, Σ c_j N_j
    combine(p, 3, spin, p->rotating, at->rotating);
    combine(p, 3, spin, p->gyroscopic, at->gyroscopic);
    combine(p, p->inner ? BOUGH_MODAL_FIELDS : 9, at->coefficient, p->field, at->field);
    clear(p, BOUGH_MODAL_FIELDS, at->field_q);
    clear(p, 3, at->gyroscopic_eta);
    clear(p, 3, at->eta_rotating);
    clear(p, 3, at->rest_rotating);
    // derivatives by the coefficients and by the spin
    for (int j = 0; j < (p->inner ? BOUGH_MODAL_FIELDS : 9); j++) {
        add_product(p, 1, matrix(p, p->field, j), at->q, at->field_q + j * s);
    }
    for (int a = 0; a < 3; a++) {
        add_product(p, 1, matrix(p, p->gyroscopic, a), at->eta, at->gyroscopic_eta + a * s);
        add_transposed(p, matrix(p, p->rotating, a), at->eta, at->eta_rotating + a * s);
        add_transposed(p, matrix(p, p->rotating, a), at->rest, at->rest_rotating + a * s);
    }
    set_lever(at, load, load_stride);
    if (p->first > 0) set_load_rotations(at, load, load_stride);
}

// -- the tip --------------------------------------------------------------------------------------

// The change of the tip's frame by the changes of its displacement and rotation, of their rates, and of the
// piece's frame.
static void tip_change(const bough_modal_point *at, bough_twist dshift, bough_twist dmove,
                       const bough_modal_frame_change *d, bough_modal_frame_change *tip) {
    const bough_modal_piece *p = at->piece;
    bough_twist shift = at->tip_shift, move = at->tip_rate;
    bough_exp_factors j = bough_exp_factors_of(shift.angular);
    bough_mat3 e = at->tip_rotation;
    bough_vec3 beta = bough_mat3_tmul(e, bough_exp_tangent(j, shift.angular, dshift.angular));
    bough_vec3 x = bough_add(p->rod->position0[p->n], shift.linear);
    bough_vec3 du = bough_add(bough_add(d->velocity, dmove.linear),
                              bough_add(bough_cross(d->spin, x), bough_cross(at->frame.spin, dshift.linear)));
    bough_vec3 dw = bough_add(bough_add(d->spin, bough_exp_tangent(j, shift.angular, dmove.angular)),
                              bough_exp_tangent_change(j, shift.angular, dshift.angular, move.angular));
    tip->velocity = bough_sub(bough_mat3_tmul(e, du), bough_cross(beta, at->tip.velocity));
    tip->spin = bough_sub(bough_mat3_tmul(e, dw), bough_cross(beta, at->tip.spin));
    tip->gravity = bough_sub(bough_mat3_tmul(e, d->gravity), bough_cross(beta, at->tip.gravity));
    tip->rotation = bough_add(bough_mat3_tmul(e, d->rotation), beta);
}

// The change of the outer wrench in frame axes by the tip's rotation and by its own change d in the tip's
// axes, and the change of its moment conjugate to ψ̇.
static bough_wrench outer_change(const bough_modal_point *at, bough_vec3 dpsi, bough_wrench d,
                                 bough_vec3 *working) {
    bough_vec3 psi = at->tip_shift.angular, back = bough_scale(-1, psi);
    bough_exp_factors j = bough_exp_factors_of(psi);
    bough_mat3 e = at->tip_rotation;
    bough_vec3 spin = bough_exp_tangent(j, psi, dpsi), moment = bough_mat3_mul(e, at->outer.moment);
    bough_vec3 force = bough_mat3_mul(e, at->outer.force);
    bough_wrench w = {bough_add(bough_mat3_mul(e, d.force), bough_cross(spin, force)),
                      bough_add(bough_mat3_mul(e, d.moment), bough_cross(spin, moment))};
    *working = bough_add(bough_exp_tangent(j, back, w.moment),
                         bough_exp_tangent_change(j, back, bough_scale(-1, dpsi), moment));
    return w;
}

// The contribution of a change of the outer wrench, in frame axes, to η̇ and to the loads' resultant.
static bough_wrench add_outer(const bough_modal_point *at, bough_wrench w, bough_vec3 working, double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 x = bough_add(p->rod->position0[p->n], at->tip_shift.linear);
    add_force(p, p->n, (bough_wrench){w.force, working}, rate);
    add3(p, 1, at->field_q + (size_t)9 * p->stride, w.force, rate);
    return (bough_wrench){w.force, bough_add(w.moment, bough_cross(x, w.force))};
}

// -- along a direction ----------------------------------------------------------------------------

static const bough_modal_frame_change held;

// δ of theory (35)
void bough_modal_forward_tangent(const bough_modal_point *at, const double *dq, const double *deta,
                                 const bough_modal_frame_change *d, double *rate,
                                 bough_modal_frame_change *tip) {
    const bough_modal_piece *p = at->piece;
    bough_twist dshift = {{0, 0, 0}, {0, 0, 0}};
    memset(rate, 0, (size_t)p->m * sizeof *rate);
    if (dq != NULL) {
        memcpy(rate, deta, (size_t)p->m * sizeof *rate);
        add_product(p, -1, at->rotating, dq, rate);
        if (p->inner) dshift = bough_modal_vertex(p, p->n, dq);
    }
    if (d != NULL) {
        add3(p, -1, p->rigid, d->velocity, rate);
        add3(p, -1, p->rigid + 3 * p->stride, d->spin, rate);
        add3(p, -1, at->rotating_q, d->spin, rate);
    }
    if (p->inner) tip_change(at, dshift, bough_modal_vertex(p, p->n, rate), d ? d : &held, tip);
}

// The frame's change in η̇, without its effect through q̇.
static void add_frame_change(const bough_modal_point *at, const bough_modal_frame_change *d, double *rate) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *f = &at->frame;
    double c[BOUGH_MODAL_SQUARES];
    squares(f->spin, d->spin, c);
    for (int j = 0; j < BOUGH_MODAL_SQUARES; j++) {
        add_scaled(p->m, 2 * c[j], at->field_q + j * p->stride, rate);
        add_scaled(p->m, 2 * c[j], p->centrifugal + j * p->stride, rate);
    }
    bough_vec3 apparent = bough_sub(
        bough_add(bough_cross(d->spin, f->velocity), bough_cross(f->spin, d->velocity)), d->gravity);
    add3(p, 1, at->field_q + 6 * p->stride, apparent, rate);
    add3(p, -1, at->gyroscopic_eta, d->spin, rate);
    add3(p, 1, p->rigid, d->gravity, rate);
    add3(p, 1, at->force_by_rotation, d->rotation, rate);
}

// The loads' and the weight's resultant by the frame's change.
static bough_wrench resultant_change(const bough_modal_point *at, const bough_modal_frame_change *d) {
    const bough_modal_piece *p = at->piece;
    bough_wrench w = {bough_scale(p->mass, d->gravity), {0, 0, 0}};
    for (int a = 0; a < 3; a++) {
        double angle = component(d->rotation, a), g = component(d->gravity, a);
        w.force = bough_axpy(angle, dot3(p, p->rigid, at->force_by_rotation + a * p->stride), w.force);
        w.moment = bough_axpy(angle, at->moment_by_rotation[a], w.moment);
        w.moment = bough_axpy(g, arms_times(at, p->rigid + a * p->stride), w.moment);
    }
    return w;
}

// Subtracts the rates of momentum by q̇, η̇ and the frame's twist.
static bough_wrench less_momentum(const bough_modal_point *at, bough_wrench w, const double *drate_q,
                                  const double *drate_eta, bough_twist dtwist) {
    const bough_modal_piece *p = at->piece;
    w.force = bough_sub(w.force, dot3(p, p->rigid, drate_eta));
    w.moment = bough_sub(w.moment, bough_add(arms_times(at, drate_eta), dot3(p, at->eta_rotating, drate_q)));
    return bough_wrench_sub(w, bough_wrench_cross(dtwist, momentum_of(at)));
}

// δ of theory (36, 37)
bough_wrench bough_modal_backward_tangent(const bough_modal_point *at, const double *dq, const double *deta,
                                          const double *drate_q, const bough_modal_frame_change *d,
                                          bough_wrench outer, double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_wrench w = {{0, 0, 0}, {0, 0, 0}};
    bough_twist dtwist = {{0, 0, 0}, {0, 0, 0}};
    memset(rate, 0, (size_t)p->m * sizeof *rate);
    // by the wrench of the next piece
    if (p->inner) {
        bough_vec3 working, dpsi = {0, 0, 0};
        if (dq != NULL) dpsi = bough_modal_vertex(p, p->n, dq).angular;
        bough_wrench change = outer_change(at, dpsi, outer, &working);
        w = add_outer(at, change, working, rate);
    }
    // by the motion of the frame
    if (d != NULL) {
        dtwist = (bough_twist){d->velocity, d->spin};
        w = bough_wrench_add(w, resultant_change(at, d));
        add_frame_change(at, d, rate);
    }
    // by q̇, q and η
    add_product(p, -1, p->damping, drate_q, rate);
    if (dq != NULL) {
        for (int k = 0; k < p->m; k++) rate[k] -= p->square[k] * dq[k];
        add_product(p, -1, at->gyroscopic, deta, rate);
        add_product(p, 1, at->field, dq, rate);
        w.moment = bough_add(w.moment, bough_add(dot3(p, at->lever, dq), dot3(p, at->rest_rotating, dq)));
        w.moment = bough_sub(w.moment, dot3(p, at->rotating_rate, deta));
        bough_wrench change = {dot3(p, p->rigid, deta),
                               bough_add(arms_times(at, deta), dot3(p, at->eta_rotating, dq))};
        w = bough_wrench_sub(w, bough_wrench_cross(frame_twist(&at->frame), change));
    }
    return less_momentum(at, w, drate_q, rate, dtwist);
}

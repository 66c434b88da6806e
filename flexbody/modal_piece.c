#include "flexbody/modal_piece.h"

#include <string.h>

static const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

bool bough_modal_point_init(bough_modal_point *point, bough_arena *arena,
                            const bough_modal_piece *piece) {
    size_t s = (size_t)piece->stride, matrix = (size_t)piece->m * s;
    struct {
        double **array;
        size_t size;
    } arrays[] = {{&point->turn_q, 3 * s},      {&point->rate_q, s},
                  {&point->force, s},           {&point->lever, 3 * s},
                  {&point->coefficient, BOUGH_MODAL_FIELDS},
                  {&point->rate_eta, s},        {&point->turn_rate, 3 * s},
                  {&point->turn, matrix},       {&point->gyroscopic, matrix},
                  {&point->field, matrix},      {&point->field_q, BOUGH_MODAL_FIELDS * s},
                  {&point->gyroscopic_eta, 3 * s}, {&point->eta_turn, 3 * s},
                  {&point->rest_turn, 3 * s},   {&point->force_turn, 3 * s}};
    point->piece = piece;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        *arrays[k].array = bough_arena_doubles(arena, arrays[k].size);
    }
    return !bough_arena_exhausted(arena);
}

// -- small algebra ----------------------------------------------------------------------------------

static double dot(int n, const double *restrict x, const double *restrict y) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int k = 0; k < n; k++) sum += x[k] * y[k];
    return sum;
}

static void add_scaled(int n, double c, const double *restrict x, double *restrict y) {
#pragma omp simd
    for (int k = 0; k < n; k++) y[k] += c * x[k];
}

// y += c A x of an (m × stride) matrix
static void add_product(const bough_modal_piece *p, double c, const double *a, const double *x,
                        double *y) {
    if (c == 0) return;
    for (int k = 0; k < p->m; k++) y[k] += c * dot(p->m, a + (size_t)k * p->stride, x);
}

// y += Aᵀ x
static void add_transposed(const bough_modal_piece *p, const double *a, const double *x,
                           double *y) {
    for (int k = 0; k < p->m; k++) add_scaled(p->m, x[k], a + (size_t)k * p->stride, y);
}

static const double *matrix(const bough_modal_piece *p, const double *list, int j) {
    return list + (size_t)j * p->m * p->stride;
}

static void clear(const bough_modal_piece *p, int rows, double *x) {
    memset(x, 0, (size_t)rows * p->stride * sizeof *x);
}

static double component(bough_vec3 v, int k) {
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

static bough_vec3 dot3(const bough_modal_piece *p, const double *rows, const double *x) {
    int s = p->stride;
    return bough_v3(dot(p->m, rows, x), dot(p->m, rows + s, x), dot(p->m, rows + 2 * s, x));
}

static void add3(const bough_modal_piece *p, double sign, const double *rows, bough_vec3 c,
                 double *y) {
    for (int k = 0; k < 3; k++) add_scaled(p->m, sign * component(c, k), rows + k * p->stride, y);
}

bough_twist bough_modal_vertex(const bough_modal_piece *p, int i, const double *q) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    return (bough_twist){dot3(p, rows, q), dot3(p, rows + 3 * p->stride, q)};
}

// -- rotation vectors: J(ψ) v = v + b ψ×v + c ψ×(ψ×v) ------------------------------------------------

typedef struct turning {
    double b, c, db, dc; // and their derivatives by |ψ|²
} turning;

static turning turning_of(bough_vec3 psi) {
    double t = bough_dot(psi, psi);
    if (t < 0.05) {
        return (turning){
            1 / 2. - t * (1 / 24. - t * (1 / 720. - t * (1 / 40320. - t / 3628800))),
            1 / 6. - t * (1 / 120. - t * (1 / 5040. - t * (1 / 362880. - t / 39916800))),
            -1 / 24. + t * (1 / 360. - t * (1 / 13440. - t / 907200)),
            -1 / 120. + t * (1 / 2520. - t * (1 / 120960. - t / 9979200))};
    }
    double angle = sqrt(t), b = (1 - cos(angle)) / t, c = (1 - sin(angle) / angle) / t;
    return (turning){b, c, (sin(angle) / angle - 2 * b) / (2 * t), (b - 3 * c) / (2 * t)};
}

static bough_vec3 tangent_map(turning j, bough_vec3 psi, bough_vec3 v) {
    bough_vec3 once = bough_cross(psi, v);
    return bough_add(v, bough_axpy(j.c, bough_cross(psi, once), bough_scale(j.b, once)));
}

// Derivative of J(ψ) v along dψ, v held.
static bough_vec3 tangent_map_change(turning j, bough_vec3 psi, bough_vec3 d, bough_vec3 v) {
    double dt = 2 * bough_dot(psi, d);
    bough_vec3 once = bough_cross(psi, v), other = bough_cross(d, v);
    bough_vec3 twice = bough_add(bough_cross(d, once), bough_cross(psi, other));
    bough_vec3 first = bough_axpy(j.db * dt, once, bough_scale(j.b, other));
    return bough_add(first,
                     bough_axpy(j.dc * dt, bough_cross(psi, once), bough_scale(j.c, twice)));
}

bough_vec3 bough_modal_spin(bough_vec3 psi, bough_vec3 rate) {
    return tangent_map(turning_of(psi), psi, rate);
}

// -- forward ----------------------------------------------------------------------------------------

// The tip's frame: pose x̂⁰ + ξ, exp(ψ), and its twist.
static void set_tip(bough_modal_point *at) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *frame = &at->frame;
    bough_twist shift = bough_modal_vertex(p, p->n, at->q);
    bough_twist rate = bough_modal_vertex(p, p->n, at->rate_q);
    bough_mat3 e = bough_rotation_matrix(bough_quaternion_exponential(shift.angular));
    bough_vec3 x = bough_add(p->rod->position0[p->n], shift.linear);
    bough_vec3 u = bough_add(bough_add(frame->velocity, rate.linear), bough_cross(frame->spin, x));
    bough_vec3 w = bough_add(frame->spin, bough_modal_spin(shift.angular, rate.angular));
    at->tip.velocity = bough_mat3_tmul(e, u);
    at->tip.spin = bough_mat3_tmul(e, w);
    at->tip.gravity = bough_mat3_tmul(e, frame->gravity);
    at->tip.pose = bough_transform_compose(frame->pose, (bough_transform){x, e});
}

void bough_modal_forward(bough_modal_point *at, const bough_modal_frame *frame, const double *q,
                         const double *eta) {
    const bough_modal_piece *p = at->piece;
    int s = p->stride;
    at->frame = *frame;
    at->q = q;
    at->eta = eta;
    clear(p, 3, at->turn_q);
    for (int a = 0; a < 3; a++) add_product(p, 1, matrix(p, p->turn, a), q, at->turn_q + a * s);
    memcpy(at->rate_q, eta, (size_t)p->m * sizeof *eta);
    add3(p, -1, p->rigid, frame->velocity, at->rate_q);
    add3(p, -1, p->rigid + 3 * s, frame->spin, at->rate_q);
    add3(p, -1, at->turn_q, frame->spin, at->rate_q);
    set_tip(at);
}

void bough_modal_forward_tangent(const bough_modal_point *at, const double *dq, const double *deta,
                                 const bough_modal_frame_change *d, double *rate,
                                 bough_modal_frame_change *tip) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *frame = &at->frame;
    memcpy(rate, deta, (size_t)p->m * sizeof *rate);
    add_product(p, -1, at->turn, dq, rate);
    add3(p, -1, p->rigid, d->velocity, rate);
    add3(p, -1, p->rigid + 3 * p->stride, d->spin, rate);
    add3(p, -1, at->turn_q, d->spin, rate);
    bough_twist shift = bough_modal_vertex(p, p->n, at->q), dshift = bough_modal_vertex(p, p->n, dq);
    bough_twist move = bough_modal_vertex(p, p->n, at->rate_q);
    bough_twist dmove = bough_modal_vertex(p, p->n, rate);
    turning j = turning_of(shift.angular);
    bough_mat3 e = bough_rotation_matrix(bough_quaternion_exponential(shift.angular));
    bough_vec3 turn = tangent_map(j, shift.angular, dshift.angular); // in frame axes
    bough_vec3 beta = bough_mat3_tmul(e, turn);
    bough_vec3 x = bough_add(p->rod->position0[p->n], shift.linear);
    bough_vec3 du = bough_add(bough_add(d->velocity, dmove.linear),
                              bough_add(bough_cross(d->spin, x),
                                        bough_cross(frame->spin, dshift.linear)));
    bough_vec3 dw = bough_add(
        bough_add(d->spin, tangent_map(j, shift.angular, dmove.angular)),
        tangent_map_change(j, shift.angular, dshift.angular, move.angular));
    tip->velocity = bough_sub(bough_mat3_tmul(e, du), bough_cross(beta, at->tip.velocity));
    tip->spin = bough_sub(bough_mat3_tmul(e, dw), bough_cross(beta, at->tip.spin));
    tip->gravity = bough_sub(bough_mat3_tmul(e, d->gravity), bough_cross(beta, at->tip.gravity));
    tip->turn = bough_add(bough_mat3_tmul(e, d->turn), beta);
}

// -- backward ---------------------------------------------------------------------------------------

static bough_wrench vertex_load(const bough_modal_point *at, const double *load, int stride,
                                int i) {
    const double *f = load + at->piece->first + i;
    bough_mat3 r = at->frame.pose.rotation;
    return (bough_wrench){
        bough_mat3_tmul(r, bough_v3(f[0], f[stride], f[2 * stride])),
        bough_mat3_tmul(r, bough_v3(f[3 * stride], f[4 * stride], f[5 * stride]))};
}

// Φᵢᵀ(force, moment)
static void add_force(const bough_modal_piece *p, int i, bough_wrench w, double *to) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    add3(p, 1, rows, w.force, to);
    add3(p, 1, rows + 3 * p->stride, w.moment, to);
}

// The moment of a force at vertex i about each axis, per unit of q: Φᵢ × f
static void add_lever(const bough_modal_piece *p, int i, bough_vec3 f, double *lever) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    for (int a = 0; a < 3; a++) {
        add3(p, 1, rows, bough_cross(f, unit[a]), lever + a * p->stride);
    }
}

// The outer wrench in frame axes, and its moment as it works on ψ̇.
static bough_wrench outer_wrench(const bough_modal_point *at, bough_vec3 *working) {
    bough_vec3 psi = bough_modal_vertex(at->piece, at->piece->n, at->q).angular;
    bough_mat3 e = bough_rotation_matrix(bough_quaternion_exponential(psi));
    bough_wrench w = {bough_mat3_mul(e, at->outer.force), bough_mat3_mul(e, at->outer.moment)};
    *working = bough_modal_spin(bough_scale(-1, psi), w.moment);
    return w;
}

// force and lever; returns the loads' resultant on the undeformed piece.
static bough_wrench gather_loads(bough_modal_point *at, const double *load, int stride) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 working, force = {0, 0, 0}, moment = {0, 0, 0};
    clear(p, 1, at->force);
    clear(p, 3, at->lever);
    for (int i = 1; i <= p->n; i++) {
        bough_wrench w = vertex_load(at, load, stride, i);
        if (i == p->n) {
            bough_wrench outer = outer_wrench(at, &working);
            add_force(p, i, (bough_wrench){{0, 0, 0}, working}, at->force);
            bough_vec3 direct = w.moment;
            w = bough_wrench_add(w, outer);
            add_force(p, i, (bough_wrench){w.force, direct}, at->force);
            for (int k = 0; k < 3; k++) at->coefficient[9 + k] = component(outer.force, k);
        } else {
            add_force(p, i, w, at->force);
        }
        add_lever(p, i, w.force, at->lever);
        force = bough_add(force, w.force);
        moment = bough_add(moment,
                           bough_add(w.moment, bough_cross(p->rod->position0[i], w.force)));
    }
    return (bough_wrench){force, moment};
}

// ω_aω_b in the order of the fields, of the symmetric product of two vectors
static void squares(bough_vec3 v, bough_vec3 w, double *to) {
    const double values[6] = {v.x * w.x, v.y * w.y, v.z * w.z, 0.5 * (v.x * w.y + v.y * w.x),
                              0.5 * (v.x * w.z + v.z * w.x), 0.5 * (v.y * w.z + v.z * w.y)};
    memcpy(to, values, sizeof values);
}

static void set_rate(bough_modal_point *at) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *f = &at->frame;
    double *rate = at->rate_eta, *c = at->coefficient;
    squares(f->spin, f->spin, c);
    bough_vec3 apparent = bough_sub(bough_cross(f->spin, f->velocity), f->gravity);
    for (int k = 0; k < 3; k++) c[6 + k] = component(apparent, k);
    memcpy(rate, at->force, (size_t)p->m * sizeof *rate);
    for (int k = 0; k < p->m; k++) rate[k] -= p->square[k] * at->q[k];
    add_product(p, -1, p->damping, at->rate_q, rate);
    for (int a = 0; a < 3; a++) {
        add_product(p, -component(f->spin, a), matrix(p, p->gyroscopic, a), at->eta, rate);
    }
    for (int j = 0; j < BOUGH_MODAL_FIELDS; j++) {
        add_product(p, c[j], matrix(p, p->field, j), at->q, rate);
    }
    for (int j = 0; j < BOUGH_MODAL_SQUARES; j++) {
        add_scaled(p->m, c[j], p->centrifugal + j * p->stride, rate);
    }
    add3(p, 1, p->rigid, f->gravity, rate);
}

// C_tᵀg − η̇
static void set_rest(const bough_modal_point *at, double *rest) {
    const bough_modal_piece *p = at->piece;
    for (int k = 0; k < p->m; k++) rest[k] = -at->rate_eta[k];
    add3(p, 1, p->rigid, at->frame.gravity, rest);
}

// Momentum (P, L) about the frame's origin.
static bough_wrench momentum(const bough_modal_point *at) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 l = bough_add(dot3(p, p->rigid + 3 * p->stride, at->eta),
                             dot3(p, at->turn_q, at->eta));
    return (bough_wrench){dot3(p, p->rigid, at->eta), l};
}

static bough_twist frame_twist(const bough_modal_frame *f) {
    return (bough_twist){f->velocity, f->spin};
}

static void set_root(bough_modal_point *at, bough_wrench loads) {
    const bough_modal_piece *p = at->piece;
    double *rest = at->rest_turn; // work, set again by the slopes
    clear(p, 3, at->turn_rate);
    for (int a = 0; a < 3; a++) {
        add_product(p, 1, matrix(p, p->turn, a), at->rate_q, at->turn_rate + a * p->stride);
    }
    set_rest(at, rest);
    bough_wrench w = {bough_add(loads.force, dot3(p, p->rigid, rest)),
                      bough_add(loads.moment, dot3(p, at->lever, at->q))};
    w.moment = bough_add(w.moment, bough_add(dot3(p, p->rigid + 3 * p->stride, rest),
                                             dot3(p, at->turn_q, rest)));
    w.moment = bough_sub(w.moment, dot3(p, at->turn_rate, at->eta));
    at->root = bough_wrench_sub(w, bough_wrench_cross(frame_twist(&at->frame), momentum(at)));
}

void bough_modal_backward(bough_modal_point *at, const double *load, int load_stride,
                          bough_wrench outer, bool root) {
    at->outer = outer;
    bough_wrench loads = gather_loads(at, load, load_stride);
    set_rate(at);
    if (root) set_root(at, loads);
}

// -- tangents ---------------------------------------------------------------------------------------

// to = Σ c_j A_j
static void combine(const bough_modal_piece *p, int count, const double *c, const double *list,
                    double *to) {
    size_t size = (size_t)p->m * p->stride;
    memset(to, 0, size * sizeof *to);
    for (int j = 0; j < count; j++) {
        if (c[j] != 0) add_scaled((int)size, c[j], matrix(p, list, j), to);
    }
}

// What a turn of the frame changes in the loads, which do not turn with it.
static void set_load_turns(bough_modal_point *at, const double *load, int stride) {
    const bough_modal_piece *p = at->piece;
    clear(p, 3, at->force_turn);
    for (int a = 0; a < 3; a++) {
        bough_vec3 sum = {0, 0, 0};
        for (int i = 1; i <= p->n; i++) {
            bough_wrench w = vertex_load(at, load, stride, i);
            w.force = bough_cross(w.force, unit[a]);
            w.moment = bough_cross(w.moment, unit[a]);
            add_force(p, i, w, at->force_turn + a * p->stride);
            bough_vec3 x = bough_add(p->rod->position0[i],
                                     bough_modal_vertex(p, i, at->q).linear);
            sum = bough_add(sum, bough_add(w.moment, bough_cross(x, w.force)));
        }
        at->moment_turn[a] = sum;
    }
}

void bough_modal_slopes(bough_modal_point *at, const double *load, int load_stride) {
    const bough_modal_piece *p = at->piece;
    const double spin[3] = {at->frame.spin.x, at->frame.spin.y, at->frame.spin.z};
    int s = p->stride;
    combine(p, 3, spin, p->turn, at->turn);
    combine(p, 3, spin, p->gyroscopic, at->gyroscopic);
    combine(p, BOUGH_MODAL_FIELDS, at->coefficient, p->field, at->field);
    clear(p, BOUGH_MODAL_FIELDS, at->field_q);
    clear(p, 3, at->gyroscopic_eta);
    clear(p, 3, at->eta_turn);
    double *rest = at->force_turn; // work, set below
    set_rest(at, rest);
    clear(p, 3, at->rest_turn);
    for (int j = 0; j < BOUGH_MODAL_FIELDS; j++) {
        add_product(p, 1, matrix(p, p->field, j), at->q, at->field_q + j * s);
    }
    for (int a = 0; a < 3; a++) {
        add_product(p, 1, matrix(p, p->gyroscopic, a), at->eta, at->gyroscopic_eta + a * s);
        add_transposed(p, matrix(p, p->turn, a), at->eta, at->eta_turn + a * s);
        add_transposed(p, matrix(p, p->turn, a), rest, at->rest_turn + a * s);
    }
    set_load_turns(at, load, load_stride);
}

// The change of the outer wrench in frame axes, added to the generalised force.
static bough_wrench outer_change(const bough_modal_point *at, const double *dq, bough_wrench d,
                                 double *to) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 psi = bough_modal_vertex(p, p->n, at->q).angular, back = bough_scale(-1, psi);
    bough_vec3 dpsi = bough_modal_vertex(p, p->n, dq).angular;
    turning j = turning_of(psi);
    bough_mat3 e = bough_rotation_matrix(bough_quaternion_exponential(psi));
    bough_vec3 turn = tangent_map(j, psi, dpsi), moment = bough_mat3_mul(e, at->outer.moment);
    bough_wrench w = {
        bough_add(bough_mat3_mul(e, d.force), bough_cross(turn, bough_mat3_mul(e, at->outer.force))),
        bough_add(bough_mat3_mul(e, d.moment), bough_cross(turn, moment))};
    bough_vec3 working =
        bough_add(tangent_map(j, back, w.moment),
                  tangent_map_change(j, back, bough_scale(-1, dpsi), moment));
    add_force(p, p->n, (bough_wrench){w.force, working}, to);
    return w;
}

// Changes of the coefficients of the fields.
static void coefficient_change(const bough_modal_point *at, const bough_modal_frame_change *d,
                               bough_vec3 force, double *c) {
    const bough_modal_frame *f = &at->frame;
    squares(f->spin, d->spin, c);
    for (int j = 0; j < BOUGH_MODAL_SQUARES; j++) c[j] *= 2;
    bough_vec3 apparent = bough_sub(bough_add(bough_cross(d->spin, f->velocity),
                                              bough_cross(f->spin, d->velocity)),
                                    d->gravity);
    for (int k = 0; k < 3; k++) {
        c[6 + k] = component(apparent, k);
        c[9 + k] = component(force, k);
    }
}

static void rate_change(const bough_modal_point *at, const double *dq, const double *deta,
                        const double *drate_q, const bough_modal_frame_change *d,
                        bough_vec3 force, double *rate) {
    const bough_modal_piece *p = at->piece;
    double c[BOUGH_MODAL_FIELDS];
    coefficient_change(at, d, force, c);
    for (int k = 0; k < p->m; k++) rate[k] -= p->square[k] * dq[k];
    add_product(p, -1, p->damping, drate_q, rate);
    add_product(p, -1, at->gyroscopic, deta, rate);
    add_product(p, 1, at->field, dq, rate);
    add3(p, -1, at->gyroscopic_eta, d->spin, rate);
    for (int j = 0; j < BOUGH_MODAL_FIELDS; j++) {
        add_scaled(p->m, c[j], at->field_q + j * p->stride, rate);
    }
    for (int j = 0; j < BOUGH_MODAL_SQUARES; j++) {
        add_scaled(p->m, c[j], p->centrifugal + j * p->stride, rate);
    }
    add3(p, 1, p->rigid, d->gravity, rate);
    add3(p, 1, at->force_turn, d->turn, rate);
}

// (C_a + G_a q)ᵀx
static bough_vec3 arms_times(const bough_modal_point *at, const double *x) {
    const bough_modal_piece *p = at->piece;
    return bough_add(dot3(p, p->rigid + 3 * p->stride, x), dot3(p, at->turn_q, x));
}

bough_wrench bough_modal_backward_tangent(const bough_modal_point *at, const double *dq,
                                          const double *deta, const double *drate_q,
                                          const bough_modal_frame_change *d, bough_wrench outer,
                                          double *rate) {
    const bough_modal_piece *p = at->piece;
    const double *turns[3] = {&d->turn.x, &d->turn.y, &d->turn.z};
    memset(rate, 0, (size_t)p->m * sizeof *rate);
    bough_wrench w = outer_change(at, dq, outer, rate);
    rate_change(at, dq, deta, drate_q, d, w.force, rate);
    bough_vec3 x = bough_add(p->rod->position0[p->n], bough_modal_vertex(p, p->n, at->q).linear);
    bough_vec3 moment = bough_add(w.moment, bough_cross(x, w.force));
    moment = bough_add(moment, dot3(p, at->lever, dq));
    for (int a = 0; a < 3; a++) moment = bough_axpy(*turns[a], at->moment_turn[a], moment);
    // of the loads' force: that of a rigid translation's share, which has the rates in it too
    bough_vec3 force = w.force;
    for (int a = 0; a < 3; a++) {
        force = bough_axpy(*turns[a], dot3(p, p->rigid, at->force_turn + a * p->stride), force);
    }
    moment = bough_sub(moment, arms_times(at, rate));
    force = bough_sub(force, dot3(p, p->rigid, rate));
    bough_vec3 weight = bough_scale(p->mass, d->gravity);
    force = bough_add(force, weight);
    double gravity[3] = {d->gravity.x, d->gravity.y, d->gravity.z};
    for (int k = 0; k < 3; k++) {
        moment = bough_axpy(gravity[k], arms_times(at, p->rigid + k * p->stride), moment);
    }
    moment = bough_add(moment, dot3(p, at->rest_turn, dq));
    moment = bough_sub(moment, bough_add(dot3(p, at->eta_turn, drate_q),
                                         dot3(p, at->turn_rate, deta)));
    bough_wrench change = {dot3(p, p->rigid, deta),
                           bough_add(arms_times(at, deta), dot3(p, at->eta_turn, dq))};
    bough_twist twist = {d->velocity, d->spin};
    bough_wrench carried = bough_wrench_add(bough_wrench_cross(frame_twist(&at->frame), change),
                                            bough_wrench_cross(twist, momentum(at)));
    return bough_wrench_sub((bough_wrench){force, moment}, carried);
}

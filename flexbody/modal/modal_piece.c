#include "flexbody/modal/modal_algebra.h"

void bough_modal_point_init(bough_modal_point *point, bough_arena *arena, const bough_modal_piece *piece) {
    size_t s = (size_t)piece->stride;
    point->piece = piece;
    point->coefficient = bough_arena_doubles(arena, BOUGH_MODAL_FIELDS);
    point->field_q = bough_arena_doubles(arena, BOUGH_MODAL_FIELDS * s);
    bough_arena_each(arena, s, &point->rate_q, &point->force, &point->rate_eta, &point->rest);
    bough_arena_each(arena, 3 * s, &point->turn_q, &point->turn_rate, &point->lever, &point->gyroscopic_eta,
                     &point->eta_turn, &point->rest_turn, &point->force_turn);
    bough_arena_each(arena, (size_t)piece->m * s, &point->turn, &point->gyroscopic, &point->field);
}

bough_twist bough_modal_vertex(const bough_modal_piece *p, int i, const double *q) {
    return vertex_of(p, i, q);
}

bough_vec3 bough_modal_spin(bough_vec3 psi, bough_vec3 rate) {
    return bough_exp_tangent(bough_exp_factors_of(psi), psi, rate);
}

// -- forward --------------------------------------------------------------------------------------

// The tip's frame: pose x̂⁰ + ξ, exp(ψ), and its twist.
static void set_tip(bough_modal_point *at) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *frame = &at->frame;
    bough_twist shift = at->tip_shift = vertex_of(p, p->n, at->q);
    bough_twist rate = at->tip_rate = vertex_of(p, p->n, at->rate_q);
    bough_mat3 e = at->tip_turn = bough_rotation_matrix(bough_quaternion_exponential(shift.angular));
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
    if (p->inner) set_tip(at);
}

// -- backward -------------------------------------------------------------------------------------

// The outer wrench in frame axes, and its moment as it works on ψ̇.
static bough_wrench outer_wrench(const bough_modal_point *at, bough_vec3 *working) {
    bough_wrench w = {bough_mat3_mul(at->tip_turn, at->outer.force),
                      bough_mat3_mul(at->tip_turn, at->outer.moment)};
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

static void set_root(bough_modal_point *at, bough_wrench loads) {
    const bough_modal_piece *p = at->piece;
    double *rest = at->rest;
    clear(p, 3, at->turn_rate);
    for (int a = 0; a < 3; a++) {
        add_product(p, 1, matrix(p, p->turn, a), at->rate_q, at->turn_rate + a * p->stride);
    }
    for (int k = 0; k < p->m; k++) rest[k] = -at->rate_eta[k];
    add3(p, 1, p->rigid, at->frame.gravity, rest);
    bough_wrench w = {bough_add(loads.force, dot3(p, p->rigid, rest)),
                      bough_add(loads.moment, arms_times(at, rest))};
    w.moment = bough_sub(w.moment, dot3(p, at->turn_rate, at->eta));
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

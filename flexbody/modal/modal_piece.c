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

// -- tangents along a direction ----------------------------------------------------------------

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
            force = bough_add(force, bough_v3(outer[0], outer[1], outer[2]));
        }
        add_lever(p, i, force, at->lever);
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
            w.force = bough_cross(w.force, bough_unit3(a));
            w.moment = bough_cross(w.moment, bough_unit3(a));
            add_force(p, i, w, at->force_turn + a * p->stride);
            bough_vec3 x = bough_add(p->rod->position0[i], vertex_of(p, i, at->q).linear);
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
    combine(p, p->inner ? BOUGH_MODAL_FIELDS : 9, at->coefficient, p->field, at->field);
    clear(p, BOUGH_MODAL_FIELDS, at->field_q);
    clear(p, 3, at->gyroscopic_eta);
    clear(p, 3, at->eta_turn);
    clear(p, 3, at->rest_turn);
    for (int j = 0; j < (p->inner ? BOUGH_MODAL_FIELDS : 9); j++) {
        add_product(p, 1, matrix(p, p->field, j), at->q, at->field_q + j * s);
    }
    for (int a = 0; a < 3; a++) {
        add_product(p, 1, matrix(p, p->gyroscopic, a), at->eta, at->gyroscopic_eta + a * s);
        add_transposed(p, matrix(p, p->turn, a), at->eta, at->eta_turn + a * s);
        add_transposed(p, matrix(p, p->turn, a), at->rest, at->rest_turn + a * s);
    }
    set_lever(at, load, load_stride);
    if (p->first > 0) set_load_turns(at, load, load_stride);
}

// -- the tip --------------------------------------------------------------------------------------

// The change of the tip's frame by those of its displacement and turn, of their rates, and of the
// piece's frame.
static void tip_change(const bough_modal_point *at, bough_twist dshift, bough_twist dmove,
                       const bough_modal_frame_change *d, bough_modal_frame_change *tip) {
    const bough_modal_piece *p = at->piece;
    bough_twist shift = at->tip_shift, move = at->tip_rate;
    bough_exp_factors j = bough_exp_factors_of(shift.angular);
    bough_mat3 e = at->tip_turn;
    bough_vec3 beta = bough_mat3_tmul(e, bough_exp_tangent(j, shift.angular, dshift.angular));
    bough_vec3 x = bough_add(p->rod->position0[p->n], shift.linear);
    bough_vec3 du = bough_add(bough_add(d->velocity, dmove.linear),
                              bough_add(bough_cross(d->spin, x), bough_cross(at->frame.spin, dshift.linear)));
    bough_vec3 dw = bough_add(bough_add(d->spin, bough_exp_tangent(j, shift.angular, dmove.angular)),
                              bough_exp_tangent_change(j, shift.angular, dshift.angular, move.angular));
    tip->velocity = bough_sub(bough_mat3_tmul(e, du), bough_cross(beta, at->tip.velocity));
    tip->spin = bough_sub(bough_mat3_tmul(e, dw), bough_cross(beta, at->tip.spin));
    tip->gravity = bough_sub(bough_mat3_tmul(e, d->gravity), bough_cross(beta, at->tip.gravity));
    tip->turn = bough_add(bough_mat3_tmul(e, d->turn), beta);
}

// The change of the outer wrench in frame axes by the tip's turn and its own change d in the tip's
// axes; and that of its moment as it works on ψ̇.
static bough_wrench outer_change(const bough_modal_point *at, bough_vec3 dpsi, bough_wrench d,
                                 bough_vec3 *working) {
    bough_vec3 psi = at->tip_shift.angular, back = bough_scale(-1, psi);
    bough_exp_factors j = bough_exp_factors_of(psi);
    bough_mat3 e = at->tip_turn;
    bough_vec3 turn = bough_exp_tangent(j, psi, dpsi), moment = bough_mat3_mul(e, at->outer.moment);
    bough_vec3 force = bough_mat3_mul(e, at->outer.force);
    bough_wrench w = {bough_add(bough_mat3_mul(e, d.force), bough_cross(turn, force)),
                      bough_add(bough_mat3_mul(e, d.moment), bough_cross(turn, moment))};
    *working = bough_add(bough_exp_tangent(j, back, w.moment),
                         bough_exp_tangent_change(j, back, bough_scale(-1, dpsi), moment));
    return w;
}

// What a change of the outer wrench, in frame axes, adds to η̇ and to the loads' resultant.
static bough_wrench add_outer(const bough_modal_point *at, bough_wrench w, bough_vec3 working, double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 x = bough_add(p->rod->position0[p->n], at->tip_shift.linear);
    add_force(p, p->n, (bough_wrench){w.force, working}, rate);
    add3(p, 1, at->field_q + (size_t)9 * p->stride, w.force, rate);
    return (bough_wrench){w.force, bough_add(w.moment, bough_cross(x, w.force))};
}

// -- along a direction ----------------------------------------------------------------------------

static const bough_modal_frame_change held;

void bough_modal_forward_tangent(const bough_modal_point *at, const double *dq, const double *deta,
                                 const bough_modal_frame_change *d, double *rate,
                                 bough_modal_frame_change *tip) {
    const bough_modal_piece *p = at->piece;
    bough_twist dshift = {{0, 0, 0}, {0, 0, 0}};
    memset(rate, 0, (size_t)p->m * sizeof *rate);
    if (dq != NULL) {
        memcpy(rate, deta, (size_t)p->m * sizeof *rate);
        add_product(p, -1, at->turn, dq, rate);
        if (p->inner) dshift = vertex_of(p, p->n, dq);
    }
    if (d != NULL) {
        add3(p, -1, p->rigid, d->velocity, rate);
        add3(p, -1, p->rigid + 3 * p->stride, d->spin, rate);
        add3(p, -1, at->turn_q, d->spin, rate);
    }
    if (p->inner) tip_change(at, dshift, vertex_of(p, p->n, rate), d ? d : &held, tip);
}

// What the frame's change adds to η̇, its share by q̇ apart.
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
    add3(p, 1, at->force_turn, d->turn, rate);
}

// The loads' and the weight's resultant by the frame's change.
static bough_wrench resultant_change(const bough_modal_point *at, const bough_modal_frame_change *d) {
    const bough_modal_piece *p = at->piece;
    bough_wrench w = {bough_scale(p->mass, d->gravity), {0, 0, 0}};
    for (int a = 0; a < 3; a++) {
        double turn = component(d->turn, a), g = component(d->gravity, a);
        w.force = bough_axpy(turn, dot3(p, p->rigid, at->force_turn + a * p->stride), w.force);
        w.moment = bough_axpy(turn, at->moment_turn[a], w.moment);
        w.moment = bough_axpy(g, arms_times(at, p->rigid + a * p->stride), w.moment);
    }
    return w;
}

// Less the rates of momentum by q̇, η̇ and the frame's twist.
static bough_wrench less_momentum(const bough_modal_point *at, bough_wrench w, const double *drate_q,
                                  const double *drate_eta, bough_twist dtwist) {
    const bough_modal_piece *p = at->piece;
    w.force = bough_sub(w.force, dot3(p, p->rigid, drate_eta));
    w.moment = bough_sub(w.moment, bough_add(arms_times(at, drate_eta), dot3(p, at->eta_turn, drate_q)));
    return bough_wrench_sub(w, bough_wrench_cross(dtwist, momentum_of(at)));
}

bough_wrench bough_modal_backward_tangent(const bough_modal_point *at, const double *dq, const double *deta,
                                          const double *drate_q, const bough_modal_frame_change *d,
                                          bough_wrench outer, double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_wrench w = {{0, 0, 0}, {0, 0, 0}};
    bough_twist dtwist = {{0, 0, 0}, {0, 0, 0}};
    memset(rate, 0, (size_t)p->m * sizeof *rate);
    if (p->inner) {
        bough_vec3 working, dpsi = {0, 0, 0};
        if (dq != NULL) dpsi = vertex_of(p, p->n, dq).angular;
        bough_wrench change = outer_change(at, dpsi, outer, &working);
        w = add_outer(at, change, working, rate);
    }
    if (d != NULL) {
        dtwist = (bough_twist){d->velocity, d->spin};
        w = bough_wrench_add(w, resultant_change(at, d));
        add_frame_change(at, d, rate);
    }
    add_product(p, -1, p->damping, drate_q, rate);
    if (dq != NULL) {
        for (int k = 0; k < p->m; k++) rate[k] -= p->square[k] * dq[k];
        add_product(p, -1, at->gyroscopic, deta, rate);
        add_product(p, 1, at->field, dq, rate);
        w.moment = bough_add(w.moment, bough_add(dot3(p, at->lever, dq), dot3(p, at->rest_turn, dq)));
        w.moment = bough_sub(w.moment, dot3(p, at->turn_rate, deta));
        bough_wrench change = {dot3(p, p->rigid, deta),
                               bough_add(arms_times(at, deta), dot3(p, at->eta_turn, dq))};
        w = bough_wrench_sub(w, bough_wrench_cross(frame_twist(&at->frame), change));
    }
    return less_momentum(at, w, drate_q, rate, dtwist);
}

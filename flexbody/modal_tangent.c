// Tangents of a modal piece: along a direction, and by its own state as matrices.
#include "flexbody/modal_algebra.h"

// -- slopes ---------------------------------------------------------------------------------------

// to = Σ c_j A_j
static void combine(const bough_modal_piece *p, int count, const double *c, const double *list,
                    double *to) {
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
        add3(p, 1, rows, bough_cross(f, unit_vector3(a)), lever + a * p->stride);
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
            w.force = bough_cross(w.force, unit_vector3(a));
            w.moment = bough_cross(w.moment, unit_vector3(a));
            add_force(p, i, w, at->force_turn + a * p->stride);
            bough_vec3 x = bough_add(p->rod->position0[i],
                                     vertex_of(p, i, at->q).linear);
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
    bough_twist shift = vertex_of(p, p->n, at->q), move = vertex_of(p, p->n, at->rate_q);
    turning j = turning_of(shift.angular);
    bough_mat3 e = bough_rotation_matrix(bough_quaternion_exponential(shift.angular));
    bough_vec3 beta = bough_mat3_tmul(e, tangent_map(j, shift.angular, dshift.angular));
    bough_vec3 x = bough_add(p->rod->position0[p->n], shift.linear);
    bough_vec3 du = bough_add(bough_add(d->velocity, dmove.linear),
                              bough_add(bough_cross(d->spin, x),
                                        bough_cross(at->frame.spin, dshift.linear)));
    bough_vec3 dw = bough_add(
        bough_add(d->spin, tangent_map(j, shift.angular, dmove.angular)),
        tangent_map_change(j, shift.angular, dshift.angular, move.angular));
    tip->velocity = bough_sub(bough_mat3_tmul(e, du), bough_cross(beta, at->tip.velocity));
    tip->spin = bough_sub(bough_mat3_tmul(e, dw), bough_cross(beta, at->tip.spin));
    tip->gravity = bough_sub(bough_mat3_tmul(e, d->gravity), bough_cross(beta, at->tip.gravity));
    tip->turn = bough_add(bough_mat3_tmul(e, d->turn), beta);
}

// The change of the outer wrench in frame axes by the tip's turn and its own change d in the tip's
// axes; and that of its moment as it works on ψ̇.
static bough_wrench outer_change(const bough_modal_point *at, bough_vec3 dpsi, bough_wrench d,
                                 bough_vec3 *working) {
    bough_vec3 psi = vertex_of(at->piece, at->piece->n, at->q).angular;
    bough_vec3 back = bough_scale(-1, psi);
    turning j = turning_of(psi);
    bough_mat3 e = bough_rotation_matrix(bough_quaternion_exponential(psi));
    bough_vec3 turn = tangent_map(j, psi, dpsi), moment = bough_mat3_mul(e, at->outer.moment);
    bough_vec3 force = bough_mat3_mul(e, at->outer.force);
    bough_wrench w = {bough_add(bough_mat3_mul(e, d.force), bough_cross(turn, force)),
                      bough_add(bough_mat3_mul(e, d.moment), bough_cross(turn, moment))};
    *working = bough_add(tangent_map(j, back, w.moment),
                         tangent_map_change(j, back, bough_scale(-1, dpsi), moment));
    return w;
}

// What a change of the outer wrench, in frame axes, adds to η̇ and to the loads' resultant.
static bough_wrench add_outer(const bough_modal_point *at, bough_wrench w, bough_vec3 working,
                              double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 x = bough_add(p->rod->position0[p->n], vertex_of(p, p->n, at->q).linear);
    add_force(p, p->n, (bough_wrench){w.force, working}, rate);
    add3(p, 1, at->field_q + (size_t)9 * p->stride, w.force, rate);
    return (bough_wrench){w.force, bough_add(w.moment, bough_cross(x, w.force))};
}

// -- along a direction ----------------------------------------------------------------------------

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
    add3(p, -1, p->rigid, d->velocity, rate);
    add3(p, -1, p->rigid + 3 * p->stride, d->spin, rate);
    add3(p, -1, at->turn_q, d->spin, rate);
    if (p->inner) tip_change(at, dshift, vertex_of(p, p->n, rate), d, tip);
}

// What the frame's change adds to η̇, its share by q̇ apart.
static void add_frame_change(const bough_modal_point *at, const bough_modal_frame_change *d,
                             double *rate) {
    const bough_modal_piece *p = at->piece;
    const bough_modal_frame *f = &at->frame;
    double c[BOUGH_MODAL_SQUARES];
    squares(f->spin, d->spin, c);
    for (int j = 0; j < BOUGH_MODAL_SQUARES; j++) {
        add_scaled(p->m, 2 * c[j], at->field_q + j * p->stride, rate);
        add_scaled(p->m, 2 * c[j], p->centrifugal + j * p->stride, rate);
    }
    bough_vec3 apparent = bough_sub(
        bough_add(bough_cross(d->spin, f->velocity), bough_cross(f->spin, d->velocity)),
        d->gravity);
    add3(p, 1, at->field_q + 6 * p->stride, apparent, rate);
    add3(p, -1, at->gyroscopic_eta, d->spin, rate);
    add3(p, 1, p->rigid, d->gravity, rate);
    add3(p, 1, at->force_turn, d->turn, rate);
}

// The loads' and the weight's resultant by the frame's change.
static bough_wrench resultant_change(const bough_modal_point *at,
                                     const bough_modal_frame_change *d) {
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
static bough_wrench less_momentum(const bough_modal_point *at, bough_wrench w,
                                  const double *drate_q, const double *drate_eta,
                                  bough_twist dtwist) {
    const bough_modal_piece *p = at->piece;
    w.force = bough_sub(w.force, dot3(p, p->rigid, drate_eta));
    w.moment = bough_sub(w.moment, bough_add(arms_times(at, drate_eta),
                                             dot3(p, at->eta_turn, drate_q)));
    return bough_wrench_sub(w, bough_wrench_cross(dtwist, momentum_of(at)));
}

bough_wrench bough_modal_backward_tangent(const bough_modal_point *at, const double *dq,
                                          const double *deta, const double *drate_q,
                                          const bough_modal_frame_change *d, bough_wrench outer,
                                          double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_wrench w = resultant_change(at, d);
    memset(rate, 0, (size_t)p->m * sizeof *rate);
    if (p->inner) {
        bough_vec3 working, dpsi = {0, 0, 0};
        if (dq != NULL) dpsi = vertex_of(p, p->n, dq).angular;
        bough_wrench change = outer_change(at, dpsi, outer, &working);
        w = bough_wrench_add(w, add_outer(at, change, working, rate));
    }
    add_frame_change(at, d, rate);
    add_product(p, -1, p->damping, drate_q, rate);
    if (dq != NULL) {
        for (int k = 0; k < p->m; k++) rate[k] -= p->square[k] * dq[k];
        add_product(p, -1, at->gyroscopic, deta, rate);
        add_product(p, 1, at->field, dq, rate);
        w.moment = bough_add(w.moment, bough_add(dot3(p, at->lever, dq),
                                                 dot3(p, at->rest_turn, dq)));
        w.moment = bough_sub(w.moment, dot3(p, at->turn_rate, deta));
        bough_wrench change = {dot3(p, p->rigid, deta),
                               bough_add(arms_times(at, deta), dot3(p, at->eta_turn, dq))};
        w = bough_wrench_sub(w, bough_wrench_cross(frame_twist(&at->frame), change));
    }
    return less_momentum(at, w, drate_q, rate, (bough_twist){d->velocity, d->spin});
}

// -- by the state ---------------------------------------------------------------------------------

static const bough_modal_frame_change held = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
static const bough_wrench no_wrench = {{0, 0, 0}, {0, 0, 0}};
static const bough_twist still = {{0, 0, 0}, {0, 0, 0}};

// What a turn of the tip about each axis changes through the outer wrench: in η̇ (3 × stride) and
// in the resultant.
static void tip_turns(const bough_modal_point *at, double *rate, bough_wrench resultant[3]) {
    clear(at->piece, 3, rate);
    for (int a = 0; a < 3; a++) {
        bough_vec3 working;
        bough_wrench w = outer_change(at, unit_vector3(a), no_wrench, &working);
        resultant[a] = add_outer(at, w, working, rate + a * at->piece->stride);
    }
}

// Column k: dq = e_k, with q̇ changing by −(turn)_k, and dη = e_k, with q̇ changing by e_k.
static bough_wrench column_of_q(const bough_modal_point *at, int k, bough_wrench resultant,
                                const double *turn, const double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 eta_turn = column3(p, at->eta_turn, k);
    resultant.moment = bough_add(resultant.moment, bough_add(column3(p, at->lever, k),
                                                             column3(p, at->rest_turn, k)));
    bough_wrench change = {{0, 0, 0}, eta_turn};
    resultant = bough_wrench_sub(resultant,
                                 bough_wrench_cross(frame_twist(&at->frame), change));
    resultant.force = bough_sub(resultant.force, dot3(p, p->rigid, rate));
    resultant.moment = bough_sub(resultant.moment, arms_times(at, rate));
    resultant.moment = bough_add(resultant.moment, dot3(p, at->eta_turn, turn));
    return resultant;
}

static bough_wrench column_of_eta(const bough_modal_point *at, int k, const double *rate) {
    const bough_modal_piece *p = at->piece;
    bough_vec3 arm = bough_add(column3(p, p->rigid + 3 * p->stride, k), column3(p, at->turn_q, k));
    bough_wrench change = {column3(p, p->rigid, k), arm};
    bough_wrench w = {{0, 0, 0}, bough_scale(-1, bough_add(column3(p, at->turn_rate, k),
                                                           column3(p, at->eta_turn, k)))};
    w = bough_wrench_sub(w, bough_wrench_cross(frame_twist(&at->frame), change));
    w.force = bough_sub(w.force, dot3(p, p->rigid, rate));
    w.moment = bough_sub(w.moment, arms_times(at, rate));
    return w;
}

static void rate_columns(const bough_modal_point *at, int k, double *by_q, double *by_eta) {
    const bough_modal_piece *p = at->piece;
    size_t column = (size_t)k * p->stride;
    memcpy(by_q, at->field + column, (size_t)p->m * sizeof *by_q);
    by_q[k] -= p->square[k];
    add_product(p, 1, p->damping, at->turn + column, by_q);
    for (int l = 0; l < p->m; l++) {
        by_eta[l] = -p->damping[column + l] - at->gyroscopic[column + l];
    }
}

// Of the tip's frame by its displacement and turn, and by their rates (12 × 6 each, by columns).
static void tip_columns(const bough_modal_point *at, double *by_shift, double *by_move) {
    for (int k = 0; k < 6; k++) {
        double unit[6] = {0};
        bough_modal_frame_change change;
        unit[k] = 1;
        tip_change(at, bough_twist_load(unit), still, &held, &change);
        memcpy(by_shift + 12 * k, &change, sizeof change);
        tip_change(at, still, bough_twist_load(unit), &held, &change);
        memcpy(by_move + 12 * k, &change, sizeof change);
    }
}

// The tip's frame by q and η: by_shift Φ − by_move Φ (turn), by_move Φ.
static void set_tip_tangents(const bough_modal_point *at, double *tip) {
    const bough_modal_piece *p = at->piece;
    const double *rows = p->shape + (size_t)6 * (p->n - 1) * p->stride;
    double by_shift[72], by_move[72];
    tip_columns(at, by_shift, by_move);
    memset(tip, 0, 24 * (size_t)p->m * sizeof *tip);
    for (int k = 0; k < p->m; k++) {
        double *by_q = tip + 12 * k, *by_eta = tip + 12 * (p->m + k);
        for (int c = 0; c < 6; c++) {
            double shape = rows[c * p->stride + k];
            double turned = dot(p->m, rows + c * p->stride, at->turn + (size_t)k * p->stride);
            add_scaled(12, shape, by_shift + 12 * c, by_q);
            add_scaled(12, -turned, by_move + 12 * c, by_q);
            add_scaled(12, shape, by_move + 12 * c, by_eta);
        }
    }
}

void bough_modal_state_tangents(const bough_modal_point *at, double *by_q, double *by_eta,
                                double *root, double *tip) {
    const bough_modal_piece *p = at->piece;
    bough_wrench turned[3] = {no_wrench, no_wrench, no_wrench};
    if (p->inner) tip_turns(at, at->tip_turn, turned);
    for (int k = 0; k < p->m; k++) {
        double *rate = by_q + (size_t)k * p->stride, *rate_eta = by_eta + (size_t)k * p->stride;
        bough_wrench resultant = no_wrench;
        rate_columns(at, k, rate, rate_eta);
        if (p->inner) {
            bough_vec3 psi = column3(p, p->shape + (size_t)(6 * p->n - 3) * p->stride, k);
            add3(p, 1, at->tip_turn, psi, rate);
            for (int a = 0; a < 3; a++) {
                resultant.force = bough_axpy(component(psi, a), turned[a].force, resultant.force);
                resultant.moment = bough_axpy(component(psi, a), turned[a].moment,
                                              resultant.moment);
            }
        }
        bough_wrench w = column_of_q(at, k, resultant, at->turn + (size_t)k * p->stride, rate);
        bough_wrench_store(w, root + 6 * k);
        bough_wrench_store(column_of_eta(at, k, rate_eta), root + 6 * (p->m + k));
    }
    if (tip != NULL) set_tip_tangents(at, tip);
}

#include "flexbody/modal/modal_chain.h"

#include "core/base/base.h"
#include "core/base/linalg.h"

#include <string.h>

// -- build ----------------------------------------------------------------------------------------

bough_status bough_modal_create(bough_arena *arena, const bough_rod_def *def, int pieces,
                                bough_modal_options options, bough_modal_model **model) {
    bough_modal_model *m = bough_arena_take(arena, sizeof *m);
    bough_modal_piece *piece = bough_arena_take(arena, (size_t)pieces * sizeof *piece);
    int *offset = bough_arena_take(arena, (size_t)pieces * sizeof *offset);
    bough_rod_model *rod = NULL;
    assert(pieces <= def->n_segment);
    bough_status status = bough_rod_create(arena, def, &rod);
    if (!bough_is_ok(&status)) return status;
    *m = (bough_modal_model){rod->name, rod, pieces, piece, offset, 0};
    for (int k = 0; k < pieces; k++) {
        // equally many segments, or one more or less
        int first = k * def->n_segment / pieces, last = (k + 1) * def->n_segment / pieces;
        status = bough_modal_piece_create(arena, def, first, last, options, &piece[k]);
        if (!bough_is_ok(&status)) return status;
        offset[k] = m->n_state;
        m->n_state += 2 * piece[k].m;
    }
    *model = m;
    return status;
}

void bough_modal_chain_init(bough_modal_chain *chain, bough_arena *arena, const bough_modal_model *m) {
    *chain = (bough_modal_chain){0};
    chain->point = bough_arena_take(arena, (size_t)m->n_piece * sizeof *chain->point);
    chain->load = bough_arena_doubles(arena, 6 * (size_t)m->rod->stride);
    chain->change = bough_arena_take(arena, ((size_t)m->n_piece + 1) * sizeof *chain->change);
    for (int k = 0; k < m->n_piece; k++) {
        bough_modal_point_init(&chain->point[k], arena, &m->piece[k]);
    }
}

// -- sweeps ---------------------------------------------------------------------------------------

// The frame of the first piece: the body's.
static bough_modal_frame body_frame(const double *input) {
    return (bough_modal_frame){{input[0], input[1], input[2]},
                               {input[3], input[4], input[5]},
                               {input[6], input[7], input[8]},
                               bough_transform_identity()};
}

static void forward(const bough_modal_model *m, const double *state, const double *input,
                    bough_modal_chain *chain) {
    bough_modal_frame frame = body_frame(input);
    for (int k = 0; k < m->n_piece; k++) {
        const double *q = state + m->offset[k];
        bough_modal_forward(&chain->point[k], &frame, q, q + m->piece[k].m);
        frame = chain->point[k].tip;
    }
}

// Vertex loads at t: the sampled parabola and the ramped loads.
static void set_loads(const bough_modal_model *m, const bough_rod_loads *loads, double t, double *load) {
    int count = 6 * m->rod->stride;
    double elapsed = t - loads->start;
    for (int k = 0; k < count; k++) {
        load[k] = loads->value[k] + elapsed * (loads->rate[k] + elapsed * loads->curve[k]);
    }
    for (const bough_rod_ramped_load *l = loads->ramped; l != NULL; l = l->next) {
        double factor = bough_schedule_at(&l->schedule, t);
        for (int k = 0; k < count; k++) load[k] += factor * l->value[k];
    }
}

// Motions outwards, then wrenches inwards; the root wrench of the first piece only if `root`.
static void evaluate(const bough_modal_model *m, const bough_rod_loads *loads, double t, const double *state,
                     const double *input, bough_modal_chain *chain, bool root) {
    bough_wrench outer = {{0, 0, 0}, {0, 0, 0}};
    set_loads(m, loads, t, chain->load);
    forward(m, state, input, chain);
    for (int k = m->n_piece - 1; k >= 0; k--) {
        bough_modal_point *at = &chain->point[k];
        bough_modal_backward(at, chain->load, m->rod->stride, outer, root || k > 0);
        outer = at->root;
    }
}

bool bough_modal_derivative(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                            const double *state, const double *input, bough_modal_chain *chain,
                            double *rate) {
    double sum = 0;
    evaluate(m, loads, t, state, input, chain, false);
    for (int k = 0; k < m->n_piece; k++) {
        const bough_modal_point *at = &chain->point[k];
        size_t size = (size_t)m->piece[k].m * sizeof *rate;
        memcpy(rate + m->offset[k], at->rate_q, size);
        memcpy(rate + m->offset[k] + m->piece[k].m, at->rate_eta, size);
    }
    for (int k = 0; k < m->n_state; k++) sum += rate[k] * rate[k];
    return isfinite(sum);
}

void bough_modal_root_wrench(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                             const double *state, const double *input, bough_modal_chain *chain,
                             double *wrench) {
    evaluate(m, loads, t, state, input, chain, true);
    bough_wrench_store(chain->point[0].root, wrench);
    for (int c = 0; c < 6; c++) wrench[c] += chain->load[c * m->rod->stride];
}

// -- states ---------------------------------------------------------------------------------------

void bough_modal_rest_state(const bough_modal_model *m, const double *input, double *state) {
    bough_vec3 u0 = {input[0], input[1], input[2]}, omega = {input[3], input[4], input[5]};
    memset(state, 0, (size_t)m->n_state * sizeof *state);
    for (int k = 0; k < m->n_piece; k++) {
        const bough_modal_piece *p = &m->piece[k];
        double *eta = state + m->offset[k] + p->m, twist[6];
        // η of the rigid motion with the frame: C times the twist there
        bough_vec3 u = bough_add(u0, bough_cross(omega, m->rod->position0[p->first]));
        bough_twist_store((bough_twist){u, omega}, twist);
        for (int c = 0; c < 6; c++) {
            for (int l = 0; l < p->m; l++) eta[l] += p->rigid[c * p->stride + l] * twist[c];
        }
    }
}

void bough_modal_ride(const bough_modal_model *m, const double *input, bough_modal_chain *chain,
                      double *state) {
    bough_modal_frame frame = body_frame(input);
    for (int k = 0; k < m->n_piece; k++) {
        bough_modal_point *at = &chain->point[k];
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

void bough_modal_expand(const bough_modal_model *m, const double *state, const double *input, int first,
                        bough_modal_chain *chain, double *rod_state) {
    forward(m, state, input, chain);
    // motions outwards
    for (int k = 0; k < m->n_piece; k++) {
        const bough_modal_piece *p = &m->piece[k];
        for (int i = first > p->first ? first - p->first : 1; i <= p->n; i++) {
            expand_vertex(&chain->point[k], i, p->first + i - 1, m->rod->n, rod_state);
        }
    }
}

// -- tangents -------------------------------------------------------------------------------------

void bough_modal_chain_slopes(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                              const double *state, const double *input, bough_modal_chain *chain) {
    evaluate(m, loads, t, state, input, chain, true);
    for (int k = 0; k < m->n_piece; k++) {
        bough_modal_slopes(&chain->point[k], chain->load, m->rod->stride);
    }
}

void bough_modal_tangent(const bough_modal_model *m, bough_modal_chain *chain, const double *state_variation,
                         const double *input_variation, double *rate, double *wrench) {
    const double *y = state_variation;
    bough_modal_frame_change *frame = chain->change;
    bough_wrench outer = {{0, 0, 0}, {0, 0, 0}};
    frame[0] = (bough_modal_frame_change){0};
    // the first frame changes with the input
    if (input_variation != NULL) {
        const double *d = input_variation;
        frame[0] =
            (bough_modal_frame_change){{d[0], d[1], d[2]}, {d[3], d[4], d[5]}, {d[6], d[7], d[8]}, {0, 0, 0}};
    }
    for (int k = 0; k < m->n_piece; k++) {
        const double *dq = y == NULL ? NULL : y + m->offset[k];
        const double *deta = y == NULL ? NULL : dq + m->piece[k].m;
        bough_modal_forward_tangent(&chain->point[k], dq, deta, &frame[k], rate + m->offset[k],
                                    &frame[k + 1]);
    }
    // wrenches inwards
    for (int k = m->n_piece - 1; k >= 0; k--) {
        const double *dq = y == NULL ? NULL : y + m->offset[k];
        const double *deta = y == NULL ? NULL : dq + m->piece[k].m;
        double *to = rate + m->offset[k];
        outer = bough_modal_backward_tangent(&chain->point[k], dq, deta, to, &frame[k], outer,
                                             to + m->piece[k].m);
    }
    bough_wrench_store(outer, wrench);
}

// -- Newton's matrix ------------------------------------------------------------------------------

void bough_modal_newton_init(bough_modal_newton *newton, bough_arena *arena, const bough_modal_model *m) {
    size_t n = (size_t)m->n_state;
    bough_arena_each(arena, n * n, &newton->jacobian, &newton->matrix);
    newton->input = bough_arena_doubles(arena, n * BOUGH_ROD_INPUTS);
    newton->wrench = bough_arena_doubles(arena, BOUGH_ROD_OUTPUTS * (n + BOUGH_ROD_INPUTS));
    newton->unit = bough_arena_doubles(arena, n);
    newton->pivot = bough_arena_take(arena, n * sizeof *newton->pivot);
}

bool bough_modal_linearise(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                           const double *state, const double *input, bough_modal_chain *chain,
                           bough_modal_newton *newton) {
    int n = m->n_state;
    double *wrench = newton->wrench, unit[BOUGH_ROD_INPUTS] = {0};
    bough_modal_chain_slopes(m, loads, t, state, input, chain);
    // columns by state
    for (int j = 0; j < n; j++, wrench += BOUGH_ROD_OUTPUTS) {
        newton->unit[j] = 1;
        bough_modal_tangent(m, chain, newton->unit, NULL, newton->jacobian + (size_t)j * (size_t)n, wrench);
        newton->unit[j] = 0;
    }
    // columns by input
    for (int j = 0; j < BOUGH_ROD_INPUTS; j++, wrench += BOUGH_ROD_OUTPUTS) {
        unit[j] = 1;
        bough_modal_tangent(m, chain, NULL, unit, newton->input + (size_t)j * (size_t)n, wrench);
        unit[j] = 0;
    }
    return bough_all_finite(n * n, newton->jacobian);
}

void bough_modal_kept_tangent(const bough_modal_model *m, const bough_modal_newton *newton,
                              const double *state_variation, const double *input_variation, double *wrench) {
    const double *const variation[] = {state_variation, input_variation};
    const int count[] = {m->n_state, BOUGH_ROD_INPUTS};
    const double *column = newton->wrench;
    memset(wrench, 0, BOUGH_ROD_OUTPUTS * sizeof *wrench);
    for (int part = 0; part < 2; part++) {
        for (int j = 0; j < count[part]; j++, column += BOUGH_ROD_OUTPUTS) {
            double factor = variation[part] == NULL ? 0 : variation[part][j];
            for (int c = 0; c < BOUGH_ROD_OUTPUTS; c++) wrench[c] += factor * column[c];
        }
    }
}

bool bough_modal_factor(const bough_modal_model *m, bough_modal_newton *newton, double gamma) {
    size_t n = (size_t)m->n_state;
    for (size_t k = 0; k < n * n; k++) newton->matrix[k] = (k % (n + 1) == 0) - gamma * newton->jacobian[k];
    return bough_dense_factor(m->n_state, newton->matrix, newton->pivot);
}

void bough_modal_solve(const bough_modal_model *m, const bough_modal_newton *newton, double *x) {
    bough_dense_solve(m->n_state, 1, newton->matrix, newton->pivot, x);
}

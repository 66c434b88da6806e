// Newton's matrix of a chain of modal pieces. With d the change of a piece's frame and w that of
// the wrench on its tip, the pieces beyond answer w = Z d' + ζ to the change d' of the tip; so
// every piece is a dense system of its own and the chain is solved from the tip to the root and
// back. Within a piece δη = ((I + γG) δq − b_q)/γ leaves (I − γE)(I + γG) − γ²Q for δq, E and Q
// the tangents of η̇ by η and q.
#include "core/base/linalg.h"
#include "flexbody/modal/modal_algebra.h"
#include "flexbody/modal/modal_chain.h"

enum { D = 12, W = 6 }; // entries of a frame's change and of a wrench

static void init_piece(bough_modal_newton_piece *p, bough_arena *arena, const bough_modal_piece *of,
                       bool first) {
    size_t m = (size_t)of->m, matrix = m * (size_t)of->stride;
    bough_arena_each(arena, matrix, &p->by_q, &p->by_eta, &p->closed_q, &p->closed_eta, &p->turn);
    p->matrix = bough_arena_doubles(arena, m * m);
    p->pivot = bough_arena_take(arena, m * sizeof *p->pivot);
    p->root_x = bough_arena_doubles(arena, W * 2 * m);
    p->wrench_x = bough_arena_doubles(arena, W * 2 * m);
    p->work = bough_arena_doubles(arena, (size_t)of->stride);
    p->unit = bough_arena_doubles(arena, 2 * m);
    if (!first) {
        p->rate_d = bough_arena_doubles(arena, 2 * m * D);
        p->answer = bough_arena_doubles(arena, 2 * m * D);
        p->root_d = bough_arena_doubles(arena, (size_t)W * D);
        p->wrench = bough_arena_doubles(arena, (size_t)W * D);
    }
    if (of->inner) {
        p->rate_w = bough_arena_doubles(arena, m * W);
        p->root_w = bough_arena_doubles(arena, (size_t)W * W);
        p->tip_x = bough_arena_doubles(arena, D * 2 * m);
        p->tip_d = bough_arena_doubles(arena, (size_t)D * D);
    }
}

void bough_modal_newton_init(bough_modal_newton *newton, bough_arena *arena, const bough_modal_model *m) {
    newton->piece = bough_arena_take(arena, (size_t)m->n_piece * sizeof *newton->piece);
    for (int k = 0; k < m->n_piece; k++) {
        init_piece(&newton->piece[k], arena, &m->piece[k], k == 0);
    }
}

// c += s · a b by columns; a (rows × inner), b (inner × columns)
static void add_matrices(int rows, int inner, int columns, double s, const double *a, const double *b,
                         double *c) {
    for (int j = 0; j < columns; j++) {
        for (int l = 0; l < inner; l++) {
            add_scaled(rows, s * b[j * inner + l], a + l * rows, c + j * rows);
        }
    }
}

// -- tangents -------------------------------------------------------------------------------------

static const bough_wrench none;

static void set_state_columns(const bough_modal_point *at, bough_modal_newton_piece *p) {
    int m = at->piece->m, stride = at->piece->stride;
    const double *dq = p->unit, *deta = p->unit + m;
    for (int j = 0; j < 2 * m; j++) {
        double *rate = j < m ? p->by_q + (size_t)j * stride : p->by_eta + (size_t)(j - m) * stride;
        bough_modal_frame_change tip;
        p->unit[j] = 1;
        bough_modal_forward_tangent(at, dq, deta, NULL, p->work, &tip);
        bough_wrench root = bough_modal_backward_tangent(at, dq, deta, p->work, NULL, none, rate);
        p->unit[j] = 0;
        bough_wrench_store(root, p->root_x + (size_t)j * W);
        if (at->piece->inner) memcpy(p->tip_x + (size_t)j * D, &tip, sizeof tip);
    }
}

static void set_frame_columns(const bough_modal_point *at, bough_modal_newton_piece *p) {
    int m = at->piece->m;
    for (int j = 0; j < D; j++) {
        double entry[D] = {0}, *rate = p->rate_d + (size_t)j * 2 * m;
        bough_modal_frame_change d, tip;
        entry[j] = 1;
        memcpy(&d, entry, sizeof d);
        bough_modal_forward_tangent(at, NULL, NULL, &d, rate, &tip);
        bough_wrench root = bough_modal_backward_tangent(at, NULL, NULL, rate, &d, none, rate + m);
        bough_wrench_store(root, p->root_d + j * W);
        if (at->piece->inner) memcpy(p->tip_d + j * D, &tip, sizeof tip);
    }
}

static void set_wrench_columns(const bough_modal_point *at, bough_modal_newton_piece *p) {
    int m = at->piece->m;
    memset(p->work, 0, (size_t)m * sizeof *p->work); // q̇ does not change
    for (int j = 0; j < W; j++) {
        double entry[W] = {0};
        entry[j] = 1;
        bough_wrench root = bough_modal_backward_tangent(at, NULL, NULL, p->work, NULL,
                                                         bough_wrench_load(entry), p->rate_w + (size_t)j * m);
        bough_wrench_store(root, p->root_w + j * W);
    }
}

bool bough_modal_linearise(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                           const double *state, const double *input, bough_modal_chain *chain,
                           bough_modal_newton *newton) {
    double sum = 0;
    bough_modal_chain_slopes(m, loads, t, state, input, chain);
    for (int k = 0; k < m->n_piece; k++) {
        const bough_modal_point *at = &chain->point[k];
        bough_modal_newton_piece *p = &newton->piece[k];
        memcpy(p->turn, at->turn, (size_t)m->piece[k].m * m->piece[k].stride * sizeof *p->turn);
        set_state_columns(at, p);
        if (k > 0) set_frame_columns(at, p);
        if (m->piece[k].inner) set_wrench_columns(at, p);
        for (int j = 0; j < m->piece[k].m * m->piece[k].stride; j++) sum += fabs(p->by_q[j]);
    }
    return isfinite(sum);
}

// -- factors --------------------------------------------------------------------------------------

// Adds what the pieces beyond answer to q and η: w = Z tip_x.
static void close_tip(const bough_modal_piece *of, bough_modal_newton_piece *p,
                      const bough_modal_newton_piece *outer) {
    int m = of->m;
    for (int j = 0; j < 2 * m; j++) {
        double w[W] = {0};
        double *to =
            j < m ? p->closed_q + (size_t)j * of->stride : p->closed_eta + (size_t)(j - m) * of->stride;
        add_matrices(W, D, 1, 1, outer->wrench, p->tip_x + j * D, w);
        add_matrices(m, W, 1, 1, p->rate_w, w, to);
        add_matrices(W, W, 1, 1, p->root_w, w, p->wrench_x + j * W);
    }
}

// (I − γE)(I + γG) − γ²Q
static void set_matrix(const bough_modal_piece *of, const bough_modal_newton_piece *p, double gamma,
                       double *matrix) {
    int m = of->m;
    for (int j = 0; j < m; j++) {
        const double *g = p->turn + (size_t)j * of->stride;
        double *to = matrix + (size_t)j * m;
        memset(to, 0, (size_t)m * sizeof *to);
        to[j] = 1;
        add_scaled(m, gamma, g, to);
        add_scaled(m, -gamma, p->closed_eta + (size_t)j * of->stride, to);
        add_scaled(m, -gamma * gamma, p->closed_q + (size_t)j * of->stride, to);
        add_product(of, -gamma * gamma, p->closed_eta, g, to);
    }
}

// q and η of one right-hand side b (2m), in place.
static void solve_piece(const bough_modal_piece *of, const bough_modal_newton_piece *p, double gamma,
                        double *b) {
    int m = of->m;
    double *q = p->work, *b_q = b, *eta = b + m;
    for (int k = 0; k < m; k++) q[k] = b_q[k] + gamma * eta[k];
    add_product(of, -gamma, p->closed_eta, b_q, q);
    bough_dense_solve(m, 1, p->matrix, p->pivot, q);
    for (int k = 0; k < m; k++) eta[k] = (q[k] - b_q[k]) / gamma;
    add_product(of, 1, p->turn, q, eta);
    memcpy(b_q, q, (size_t)m * sizeof *q);
}

// The piece's answer to its frame's change, with that of the pieces beyond.
static void set_answer(const bough_modal_piece *of, bough_modal_newton_piece *p,
                       const bough_modal_newton_piece *outer, double gamma) {
    int m = of->m;
    memcpy(p->wrench, p->root_d, (size_t)W * D * sizeof *p->wrench);
    for (int j = 0; j < D; j++) {
        double *x = p->answer + (size_t)j * 2 * m, *to = p->wrench + j * W;
        memcpy(x, p->rate_d + (size_t)j * 2 * m, 2 * (size_t)m * sizeof *x);
        if (outer != NULL) {
            double w[W] = {0};
            add_matrices(W, D, 1, 1, outer->wrench, p->tip_d + j * D, w);
            add_matrices(m, W, 1, 1, p->rate_w, w, x + m);
            add_matrices(W, W, 1, 1, p->root_w, w, to);
        }
        for (int k = 0; k < 2 * m; k++) x[k] *= gamma;
        solve_piece(of, p, gamma, x);
        add_matrices(W, 2 * m, 1, 1, p->wrench_x, x, to);
    }
}

bool bough_modal_factor(const bough_modal_model *m, bough_modal_newton *newton, double gamma) {
    newton->gamma = gamma;
    for (int k = m->n_piece - 1; k >= 0; k--) {
        const bough_modal_piece *of = &m->piece[k];
        bough_modal_newton_piece *p = &newton->piece[k];
        const bough_modal_newton_piece *outer = of->inner ? p + 1 : NULL;
        size_t matrix = (size_t)of->m * of->stride * sizeof(double);
        memcpy(p->closed_q, p->by_q, matrix);
        memcpy(p->closed_eta, p->by_eta, matrix);
        memcpy(p->wrench_x, p->root_x, 2 * W * (size_t)of->m * sizeof(double));
        if (outer != NULL) close_tip(of, p, outer);
        set_matrix(of, p, gamma, p->matrix);
        if (!bough_dense_factor(of->m, p->matrix, p->pivot)) return false;
        if (k > 0) set_answer(of, p, outer, gamma);
    }
    return true;
}

void bough_modal_solve(const bough_modal_model *m, bough_modal_newton *newton, double *b) {
    double zeta[W] = {0}, change[D] = {0}, gamma = newton->gamma;
    for (int k = m->n_piece - 1; k >= 0; k--) {
        const bough_modal_piece *of = &m->piece[k];
        bough_modal_newton_piece *p = &newton->piece[k];
        double *at = b + m->offset[k], next[W] = {0};
        if (of->inner) add_matrices(of->m, W, 1, gamma, p->rate_w, zeta, at + of->m);
        solve_piece(of, p, gamma, at);
        if (k == 0) break;
        add_matrices(W, 2 * of->m, 1, 1, p->wrench_x, at, next);
        if (of->inner) add_matrices(W, W, 1, 1, p->root_w, zeta, next);
        memcpy(zeta, next, sizeof zeta);
    }
    for (int k = 0; k < m->n_piece; k++) {
        const bough_modal_newton_piece *p = &newton->piece[k];
        int x = 2 * m->piece[k].m;
        double *at = b + m->offset[k], next[D] = {0};
        if (k > 0) add_matrices(x, D, 1, 1, p->answer, change, at);
        if (!m->piece[k].inner) break;
        add_matrices(D, x, 1, 1, p->tip_x, at, next);
        if (k > 0) add_matrices(D, D, 1, 1, p->tip_d, change, next);
        memcpy(change, next, sizeof change);
    }
}

// Newton's matrix of a chain of modal pieces. With x a piece's unknowns, d the change of its frame
// and w that of the outer wrench, the pieces beyond answer w = Z d' + ζ to the change d' of the tip;
// so every piece is a dense system of its own and the chain is solved from the tip to the root and
// back.
#include "core/linalg.h"
#include "flexbody/modal_chain.h"

#include <string.h>

enum { D = 12, W = 6 }; // entries of a frame's change and of a wrench

bool bough_modal_newton_init(bough_modal_newton *newton, bough_arena *arena,
                             const bough_modal_model *m) {
    newton->piece = bough_arena_take(arena, (size_t)m->n_piece * sizeof *newton->piece);
    newton->step = bough_arena_doubles(arena, (size_t)m->n_state);
    if (newton->piece == NULL || !bough_modal_chain_init(&newton->chain, arena, m)) return false;
    for (int k = 0; k < m->n_piece; k++) {
        bough_modal_newton_piece *p = &newton->piece[k];
        size_t x = 2 * (size_t)m->piece[k].m;
        p->rate_x = bough_arena_doubles(arena, x * x);
        p->rate_d = bough_arena_doubles(arena, x * D);
        p->rate_w = bough_arena_doubles(arena, x * W);
        p->root_x = bough_arena_doubles(arena, W * x);
        p->root_d = bough_arena_doubles(arena, (size_t)W * D);
        p->root_w = bough_arena_doubles(arena, (size_t)W * W);
        p->tip_x = bough_arena_doubles(arena, D * x);
        p->tip_d = bough_arena_doubles(arena, (size_t)D * D);
        p->matrix = bough_arena_doubles(arena, x * x);
        p->answer = bough_arena_doubles(arena, x * D);
        p->pivot = bough_arena_take(arena, x * sizeof *p->pivot);
        p->wrench_x = bough_arena_doubles(arena, W * x);
        p->wrench = bough_arena_doubles(arena, (size_t)W * D);
        p->work = bough_arena_doubles(arena, x + D + W);
    }
    return !bough_arena_exhausted(arena);
}

// -- small matrices by columns ----------------------------------------------------------------------

// c += s · a b; a (rows × inner), b (inner × columns)
static void add_product(int rows, int inner, int columns, double s, const double *a,
                        const double *b, double *c) {
    for (int j = 0; j < columns; j++) {
        for (int l = 0; l < inner; l++) {
            double factor = s * b[j * inner + l];
            for (int i = 0; i < rows; i++) c[j * rows + i] += factor * a[l * rows + i];
        }
    }
}

// -- tangents ---------------------------------------------------------------------------------------

// One column of each matrix; x (2m), d and w the direction.
static void column(const bough_modal_point *at, const double *x,
                   const bough_modal_frame_change *d, bough_wrench w, double *rate, double *root,
                   double *tip) {
    int m = at->piece->m;
    bough_modal_frame_change moved;
    bough_modal_forward_tangent(at, x, x + m, d, rate, &moved);
    bough_wrench answer = bough_modal_backward_tangent(at, x, x + m, rate, d, w, rate + m);
    bough_wrench_store(answer, root);
    if (tip != NULL) memcpy(tip, &moved, sizeof moved);
}

static void set_columns(const bough_modal_point *at, bough_modal_newton_piece *p) {
    int x = 2 * at->piece->m;
    const bough_wrench none = {{0, 0, 0}, {0, 0, 0}};
    const bough_modal_frame_change held = {0};
    double *unit = p->work;
    memset(unit, 0, (size_t)x * sizeof *unit);
    for (int j = 0; j < x; j++) {
        unit[j] = 1;
        column(at, unit, &held, none, p->rate_x + j * x, p->root_x + j * W, p->tip_x + j * D);
        unit[j] = 0;
    }
    for (int j = 0; j < D; j++) {
        double entry[D] = {0};
        bough_modal_frame_change d;
        entry[j] = 1;
        memcpy(&d, entry, sizeof d);
        column(at, unit, &d, none, p->rate_d + j * x, p->root_d + j * W, p->tip_d + j * D);
    }
    for (int j = 0; j < W; j++) {
        double entry[W] = {0};
        entry[j] = 1;
        column(at, unit, &held, bough_wrench_load(entry), p->rate_w + j * x, p->root_w + j * W,
               NULL);
    }
}

bool bough_modal_linearise(const bough_modal_model *m, const bough_rod_loads *loads, double t,
                           const double *state, const double *input, bough_modal_newton *newton) {
    double sum = 0;
    bough_modal_chain_slopes(m, loads, t, state, input, &newton->chain);
    for (int k = 0; k < m->n_piece; k++) {
        int x = 2 * m->piece[k].m;
        set_columns(&newton->chain.point[k], &newton->piece[k]);
        for (int j = 0; j < x * x; j++) sum += fabs(newton->piece[k].rate_x[j]);
    }
    return isfinite(sum);
}

// -- factors ----------------------------------------------------------------------------------------

// Adds to the piece's tangents what the pieces beyond answer: rate_w Z tip_x and the like.
static void close_tip(const bough_modal_newton_piece *p, const bough_modal_newton_piece *outer,
                      int x, double gamma) {
    double answer[W * D] = {0}, *z = outer->wrench;
    for (int j = 0; j < x; j++) {
        double w[W] = {0};
        add_product(W, D, 1, 1, z, p->tip_x + j * D, w);
        add_product(x, W, 1, -gamma, p->rate_w, w, p->matrix + j * x);
        add_product(W, W, 1, 1, p->root_w, w, p->wrench_x + j * W);
    }
    add_product(W, D, D, 1, z, p->tip_d, answer);
    add_product(x, W, D, gamma, p->rate_w, answer, p->answer);
    add_product(W, W, D, 1, p->root_w, answer, p->wrench);
}

static bool factor_piece(bough_modal_newton_piece *p, const bough_modal_newton_piece *outer, int x,
                         double gamma) {
    for (int j = 0; j < x * x; j++) p->matrix[j] = (j % (x + 1) == 0) - gamma * p->rate_x[j];
    for (int j = 0; j < x * D; j++) p->answer[j] = gamma * p->rate_d[j];
    memcpy(p->wrench_x, p->root_x, (size_t)W * x * sizeof(double));
    memcpy(p->wrench, p->root_d, (size_t)W * D * sizeof(double));
    if (outer != NULL) close_tip(p, outer, x, gamma);
    if (!bough_dense_factor(x, p->matrix, p->pivot)) return false;
    bough_dense_solve(x, D, p->matrix, p->pivot, p->answer);
    add_product(W, x, D, 1, p->wrench_x, p->answer, p->wrench);
    return true;
}

bool bough_modal_factor(const bough_modal_model *m, bough_modal_newton *newton, double gamma) {
    newton->gamma = gamma;
    for (int k = m->n_piece - 1; k >= 0; k--) {
        const bough_modal_newton_piece *outer = k < m->n_piece - 1 ? &newton->piece[k + 1] : NULL;
        if (!factor_piece(&newton->piece[k], outer, 2 * m->piece[k].m, gamma)) return false;
    }
    return true;
}

void bough_modal_solve(const bough_modal_model *m, bough_modal_newton *newton, double *b) {
    double zeta[W] = {0}, change[D] = {0};
    for (int k = m->n_piece - 1; k >= 0; k--) {
        bough_modal_newton_piece *p = &newton->piece[k];
        int x = 2 * m->piece[k].m;
        double *at = b + m->offset[k], next[W] = {0};
        add_product(x, W, 1, newton->gamma, p->rate_w, zeta, at);
        bough_dense_solve(x, 1, p->matrix, p->pivot, at);
        add_product(W, x, 1, 1, p->wrench_x, at, next);
        add_product(W, W, 1, 1, p->root_w, zeta, next);
        memcpy(zeta, next, sizeof zeta);
    }
    for (int k = 0; k < m->n_piece; k++) {
        const bough_modal_newton_piece *p = &newton->piece[k];
        int x = 2 * m->piece[k].m;
        double *at = b + m->offset[k], next[D] = {0};
        if (k > 0) add_product(x, D, 1, 1, p->answer, change, at);
        add_product(D, x, 1, 1, p->tip_x, at, next);
        add_product(D, D, 1, 1, p->tip_d, change, next);
        memcpy(change, next, sizeof change);
    }
}

// Block Gaussian elimination from both ends towards row n/2, so that two chains of dependent blocks
// run side by side. After factoring, with D' the reduced diagonal blocks,
//                  rows up to n/2             rows after it
//   lower    holds  L D'⁻¹ of the row above    D'⁻¹ L
//   diagonal holds  D'⁻¹                       D'⁻¹
//   upper    holds  D'⁻¹ U                     U D'⁻¹ of the row below
// (row n/2 takes L as the first and U as the second), so that a solution's sweeps are products only,
// with no division in their long dependence.
#include "core/base/block_tridiagonal.h"

#include "core/base/base.h"

#include <math.h>
#include <stddef.h>

enum { W = 8 }; // padded column

void bough_block_tridiagonal_init(bough_block_tridiagonal *m, bough_arena *arena, int n) {
    m->n = n;
    size_t count = (size_t)bough_padded(n) * BOUGH_BLOCK;
    bough_arena_each(arena, count, &m->lower, &m->diagonal, &m->upper);
}

// Entry i of Σ_k a_k b_k over the columns a_k, padding included.
#define COLUMN_SUM(a, b, i)                                                                                  \
    ((a[i] * b[0] + a[W + (i)] * b[1]) + (a[2 * W + (i)] * b[2] + a[3 * W + (i)] * b[3]) +                   \
     (a[4 * W + (i)] * b[4] + a[5 * W + (i)] * b[5]))

// y −= A x; two chains of three fused operations are the shortest way through.
BOUGH_INLINE void subtract_matvec(const double *restrict a, const double *restrict x, double *restrict y) {
#pragma omp simd
    for (int i = 0; i < W; i++) {
        double rest = a[3 * W + i] * x[3] + a[4 * W + i] * x[4] + a[5 * W + i] * x[5];
        y[i] = y[i] - a[i] * x[0] - a[W + i] * x[1] - a[2 * W + i] * x[2] - rest;
    }
}

// x ← A x
BOUGH_INLINE void multiply_in_place(const double *restrict a, double *restrict x) {
    const double b[6] = {x[0], x[1], x[2], x[3], x[4], x[5]};
#pragma omp simd
    for (int i = 0; i < W; i++) x[i] = COLUMN_SUM(a, b, i);
}

// c = a b
BOUGH_INLINE void product(const double *restrict a, const double *restrict b, double *restrict c) {
    for (int j = 0; j < 6; j++) {
        const double *restrict column = b + W * j;
#pragma omp simd
        for (int i = 0; i < W; i++) c[W * j + i] = COLUMN_SUM(a, column, i);
    }
}

// c −= a b
BOUGH_INLINE void subtract_product(const double *restrict a, const double *restrict b, double *restrict c) {
    for (int j = 0; j < 6; j++) subtract_matvec(a, b + W * j, c + W * j);
}

// One pivot of Gauss–Jordan elimination in place, on columns. Whole columns are stored, never single
// entries: a column loaded after a store to one of its entries would wait for the store to reach the
// cache.
BOUGH_INLINE bool eliminate_pivot(double *restrict a, int k) {
    static const double unit[6][W] = {{1},          {0, 1},          {0, 0, 1},
                                      {0, 0, 0, 1}, {0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1}};
    double pivot = 1 / a[W * k + k], r[W];
    bool ok = isfinite(pivot) && pivot != 0; // zero: of an infinite entry
#pragma omp simd
    for (int j = 0; j < W; j++) r[j] = (a[W * k + j] * (1 - unit[k][j]) + unit[k][j]) * pivot;
    for (int i = 0; i < 6; i++) {
        double factor = a[W * i + k];
#pragma omp simd
        for (int j = 0; j < W; j++) {
            a[W * i + j] = a[W * i + j] * (1 - unit[k][j]) - factor * r[j];
        }
    }
#pragma omp simd
    for (int j = 0; j < W; j++) a[W * k + j] = r[j];
    return ok;
}

// a ← a⁻¹ and, side by side, b ← b⁻¹.
static bool invert_pair(double *restrict a, double *restrict b) {
    bool ok = true;
    for (int k = 0; k < 6; k++) {
        bool first = eliminate_pivot(a, k), second = eliminate_pivot(b, k);
        ok = ok && first && second;
    }
    return ok;
}

static bool invert(double *a) {
    bool ok = true;
    for (int k = 0; k < 6; k++) ok = eliminate_pivot(a, k) && ok;
    return ok;
}

BOUGH_INLINE void copy_block(const double *restrict from, double *restrict to) {
    for (int j = 0; j < BOUGH_BLOCK; j++) to[j] = from[j];
}

static double *block(double *blocks, int i) { return blocks + (size_t)i * BOUGH_BLOCK; }

// Takes the unknowns of a neighbour, whose D'⁻¹ is `inverse`, out of a row with the diagonal block
// `diagonal`: `to` couples the row to the neighbour, `back` the neighbour to the row.
BOUGH_INLINE void eliminate(const double *inverse, double *to, double *back, double *diagonal) {
    double scratch[BOUGH_BLOCK];
    product(to, inverse, scratch);
    copy_block(scratch, to);
    subtract_product(to, back, diagonal); // `back` is still unscaled
    product(inverse, back, scratch);
    copy_block(scratch, back);
}

bool bough_block_tridiagonal_factor(bough_block_tridiagonal *m) {
    int middle = m->n / 2, last = m->n - 1;
    bool ok = true;
    for (int k = 1; ok && k <= middle; k++) { // the upper half is never the shorter one
        int up = last - k;
        double *above = block(m->diagonal, k - 1), *below = block(m->diagonal, up + 1);
        ok = up >= middle ? invert_pair(above, below) : invert(above);
        eliminate(above, block(m->lower, k), block(m->upper, k - 1), block(m->diagonal, k));
        if (up < middle) continue;
        eliminate(below, block(m->upper, up), block(m->lower, up + 1), block(m->diagonal, up));
    }
    return ok && (m->n == 0 || invert(block(m->diagonal, middle)));
}

// The products with D'⁻¹ wait for nothing that follows: they fill the time between two links of
// the chains.
void bough_block_tridiagonal_solve(const bough_block_tridiagonal *m, double *x) {
    int middle = m->n / 2, last = m->n - 1;
    for (int k = 1; k <= middle; k++) {
        int up = last - k;
        subtract_matvec(block(m->lower, k), x + W * (k - 1), x + W * k);
        multiply_in_place(block(m->diagonal, k - 1), x + W * (k - 1));
        if (up < middle) continue;
        subtract_matvec(block(m->upper, up), x + W * (up + 1), x + W * up);
        multiply_in_place(block(m->diagonal, up + 1), x + W * (up + 1));
    }
    if (m->n > 0) multiply_in_place(block(m->diagonal, middle), x + W * middle);
    for (int k = middle; k > 0; k--) {
        int up = last - k;
        subtract_matvec(block(m->upper, k - 1), x + W * k, x + W * (k - 1));
        if (up >= middle) subtract_matvec(block(m->lower, up + 1), x + W * up, x + W * (up + 1));
    }
}

void bough_block_tridiagonal_subtract(const bough_block_tridiagonal *m, const double *x, double *y) {
    for (int i = 0; i < m->n; i++) {
        size_t block = (size_t)i * BOUGH_BLOCK;
        double *row = y + (size_t)W * i;
        subtract_matvec(m->diagonal + block, x + (size_t)W * i, row);
        if (i > 0) subtract_matvec(m->lower + block, x + (size_t)W * (i - 1), row);
        if (i < m->n - 1) subtract_matvec(m->upper + block, x + (size_t)W * (i + 1), row);
    }
}

void bough_block_product(const double *a, const double *b, double *c) { product(a, b, c); }

void bough_block_subtract(const double *a, const double *x, double *y) { subtract_matvec(a, x, y); }

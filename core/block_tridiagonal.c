// Block Gaussian elimination. After factoring, with D' the reduced diagonal blocks,
//   lower    holds  L D'⁻¹ of the row above,
//   diagonal holds  D'⁻¹,
//   upper    holds  D'⁻¹ U,
// so that both sweeps of a solution are products only, with no division in their long dependence.
#include "core/block_tridiagonal.h"

#include <math.h>
#include <stddef.h>

enum { W = 8 }; // padded row

bool bough_block_tridiagonal_init(bough_block_tridiagonal *m, bough_arena *arena, int n) {
    m->n = n;
    m->lower = bough_arena_doubles(arena, (size_t)n * BOUGH_BLOCK);
    m->diagonal = bough_arena_doubles(arena, (size_t)n * BOUGH_BLOCK);
    m->upper = bough_arena_doubles(arena, (size_t)n * BOUGH_BLOCK);
    return m->lower != NULL && m->diagonal != NULL && m->upper != NULL;
}

// Row i of a product: Σ_k a_ik b_k over the padded row j.
#define ROW_PRODUCT(a, b, i, j)                                                                    \
    ((a[W * (i)] * b[j] + a[W * (i) + 1] * b[W + (j)]) +                                           \
     (a[W * (i) + 2] * b[2 * W + (j)] + a[W * (i) + 3] * b[3 * W + (j)]) +                         \
     (a[W * (i) + 4] * b[4 * W + (j)] + a[W * (i) + 5] * b[5 * W + (j)]))

// c = a b
static inline void product(const double *restrict a, const double *restrict b,
                           double *restrict c) {
    for (int i = 0; i < 6; i++) {
#pragma omp simd
        for (int j = 0; j < W; j++) c[W * i + j] = ROW_PRODUCT(a, b, i, j);
    }
}

// c −= a b
static inline void subtract_product(const double *restrict a, const double *restrict b,
                                    double *restrict c) {
    for (int i = 0; i < 6; i++) {
#pragma omp simd
        for (int j = 0; j < W; j++) c[W * i + j] -= ROW_PRODUCT(a, b, i, j);
    }
}

// a ← a⁻¹ by Gauss–Jordan elimination in place. Whole rows are stored, never single entries: a
// row loaded after a store to one of its entries would wait for the store to reach the cache.
static bool invert(double *restrict a) {
    static const double unit[6][W] = {{1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 0, 1},
                                      {0, 0, 0, 0, 0, 1}};
    for (int k = 0; k < 6; k++) {
        double pivot = 1 / a[W * k + k];
        if (!isfinite(pivot) || pivot == 0) return false; // zero: of an infinite entry
        double r[W];
#pragma omp simd
        for (int j = 0; j < W; j++) {
            r[j] = (a[W * k + j] * (1 - unit[k][j]) + unit[k][j]) * pivot;
        }
        for (int i = 0; i < 6; i++) {
            double factor = a[W * i + k];
#pragma omp simd
            for (int j = 0; j < W; j++) {
                a[W * i + j] = a[W * i + j] * (1 - unit[k][j]) - factor * r[j];
            }
        }
#pragma omp simd
        for (int j = 0; j < W; j++) a[W * k + j] = r[j];
    }
    return true;
}

static inline void copy_block(const double *restrict from, double *restrict to) {
    for (int j = 0; j < BOUGH_BLOCK; j++) to[j] = from[j];
}

bool bough_block_tridiagonal_factor(bough_block_tridiagonal *m) {
    double scratch[BOUGH_BLOCK];
    for (int i = 0; i < m->n; i++) {
        double *d = m->diagonal + (size_t)i * BOUGH_BLOCK;
        if (i > 0) {
            // L ← L D'⁻¹ and D' = D − L D'⁻¹ U of the row above, whose U is still unscaled
            double *l = m->lower + (size_t)i * BOUGH_BLOCK;
            double *u = m->upper + (size_t)(i - 1) * BOUGH_BLOCK;
            product(l, d - BOUGH_BLOCK, scratch);
            copy_block(scratch, l);
            subtract_product(l, u, d);
            product(d - BOUGH_BLOCK, u, scratch);
            copy_block(scratch, u);
        }
        if (!invert(d)) return false;
    }
    return true;
}

// y −= A x
static inline void subtract_matvec(const double *restrict a, const double *restrict x,
                                   double *restrict y) {
    for (int i = 0; i < 6; i++) {
        const double *row = a + W * i;
        double sum = ((row[0] * x[0] + row[1] * x[1]) + (row[2] * x[2] + row[3] * x[3])) +
                     (row[4] * x[4] + row[5] * x[5]);
        y[i] -= sum;
    }
}

void bough_block_tridiagonal_solve(const bough_block_tridiagonal *m, double *x) {
    for (int i = 1; i < m->n; i++) {
        subtract_matvec(m->lower + (size_t)i * BOUGH_BLOCK, x + (size_t)W * (i - 1),
                        x + (size_t)W * i);
    }
    // x ← D'⁻¹ x for all rows at once, off the sequential path
    for (int i = 0; i < m->n; i++) {
        const double *d = m->diagonal + (size_t)i * BOUGH_BLOCK;
        double y[6] = {0};
        subtract_matvec(d, x + (size_t)W * i, y);
        for (int j = 0; j < 6; j++) x[W * i + j] = -y[j];
    }
    for (int i = m->n - 2; i >= 0; i--) {
        subtract_matvec(m->upper + (size_t)i * BOUGH_BLOCK, x + (size_t)W * (i + 1),
                        x + (size_t)W * i);
    }
}

void bough_block_tridiagonal_subtract(const bough_block_tridiagonal *m, const double *x,
                                      double *y) {
    for (int i = 0; i < m->n; i++) {
        size_t block = (size_t)i * BOUGH_BLOCK;
        double *row = y + (size_t)W * i;
        subtract_matvec(m->diagonal + block, x + (size_t)W * i, row);
        if (i > 0) subtract_matvec(m->lower + block, x + (size_t)W * (i - 1), row);
        if (i < m->n - 1) subtract_matvec(m->upper + block, x + (size_t)W * (i + 1), row);
    }
}

void bough_block_product(const double *a, const double *b, double *c) {
    product(a, b, c);
}

void bough_block_subtract(const double *a, const double *x, double *y) {
    subtract_matvec(a, x, y);
}

// Block Gaussian elimination, theory (26), from both ends towards row n/2, so that two chains of dependent
// blocks run side by side. After factoring, with D' the reduced diagonal blocks,
//                  rows up to n/2             rows after it
//   lower    holds  L D'⁻¹ of the row above    D'⁻¹ L
//   diagonal holds  D'⁻¹                       D'⁻¹
//   upper    holds  D'⁻¹ U                     U D'⁻¹ of the row below
// (row n/2 takes L as the first and U as the second), so that a solution's sweeps are products only,
// with no division in their long dependence.
#include "core/base/block_tridiagonal.h"

#include "core/base/block_matrix.h"

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

bool BOUGH_AT_LEVEL(bough_block_tridiagonal_factor)(bough_block_tridiagonal *m) {
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
void BOUGH_AT_LEVEL(bough_block_tridiagonal_solve)(const bough_block_tridiagonal *m, double *x) {
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

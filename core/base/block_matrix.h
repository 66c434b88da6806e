// Products of single blocks of bough_block_tridiagonal.
#pragma once

#include "core/base/base.h"

enum { W = BOUGH_COLUMN };

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

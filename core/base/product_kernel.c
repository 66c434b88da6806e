// Products of a matrix with few columns: each entry of the matrix that is read serves several columns, which
// a library's matrix products, made for many, do slowly.
#include "core/base/linalg.h"

enum {
    COLUMNS = 4, // of a at a time
    FOUR = 4,    // columns of b at a time
    TWO = 2,     // of a product with the transpose, whose sums are kept in registers
    ROWS = 256,  // of a at a time: those of c stay in the nearest cache
};

// Four columns of a matrix with `stride` rows; where there are fewer, the last one again.
typedef struct four {
    const double *c0, *c1, *c2, *c3;
} four;

BOUGH_INLINE four columns_at(const double *a, size_t stride, int count) {
    size_t last = (size_t)count - 1;
    return (four){a, a + (last < 1 ? last : 1) * stride, a + (last < 2 ? last : 2) * stride,
                  a + (last < 3 ? last : 3) * stride};
}

// Weights of the columns of a in a column of c: 0 beyond `count`.
typedef struct weights {
    double w0, w1, w2, w3;
} weights;

BOUGH_INLINE weights weights_at(double factor, const double *b, int count) {
    return (weights){factor * b[0], count > 1 ? factor * b[1] : 0, count > 2 ? factor * b[2] : 0,
                     count > 3 ? factor * b[3] : 0};
}

#define SUM(w, i) ((w).w0 * c0[i] + (w).w1 * c1[i] + ((w).w2 * c2[i] + (w).w3 * c3[i]))

// Four columns of c, each the sum of four columns of a.
static void add_to_four(int n, four a, const weights *w, double *restrict y0, double *restrict y1,
                        double *restrict y2, double *restrict y3) {
    const double *restrict c0 = a.c0, *restrict c1 = a.c1, *restrict c2 = a.c2, *restrict c3 = a.c3;
    const weights w0 = w[0], w1 = w[1], w2 = w[2], w3 = w[3];
#pragma omp simd
    for (int i = 0; i < n; i++) {
        y0[i] += SUM(w0, i);
        y1[i] += SUM(w1, i);
        y2[i] += SUM(w2, i);
        y3[i] += SUM(w3, i);
    }
}

static void add_to_one(int n, four a, weights w, double *restrict y) {
    const double *restrict c0 = a.c0, *restrict c1 = a.c1, *restrict c2 = a.c2, *restrict c3 = a.c3;
#pragma omp simd
    for (int i = 0; i < n; i++) y[i] += SUM(w, i);
}

// Rows of c += factor a b
static void add_rows(const bough_product *p, int n, const double *a, const double *b, double *c) {
    size_t rows_a = (size_t)p->rows_a, rows_b = (size_t)p->rows_b, rows_c = (size_t)p->rows_c;
    for (int column = 0; column < p->k; column += COLUMNS) {
        int count = p->k - column < COLUMNS ? p->k - column : COLUMNS;
        // four columns of a, for all columns of c: these by fours, then one by one
        four some = columns_at(a + (size_t)column * rows_a, rows_a, count);
        const double *weight = b + column;
        int j = 0;
        for (; j + FOUR <= p->n; j += FOUR) {
            double *y = c + (size_t)j * rows_c;
            weights w[FOUR];
            for (int i = 0; i < FOUR; i++)
                w[i] = weights_at(p->factor, weight + (size_t)(j + i) * rows_b, count);
            add_to_four(n, some, w, y, y + rows_c, y + 2 * rows_c, y + 3 * rows_c);
        }
        for (; j < p->n; j++)
            add_to_one(n, some, weights_at(p->factor, weight + (size_t)j * rows_b, count),
                       c + (size_t)j * rows_c);
    }
}

// c ← keep c, then += factor a b, some rows at a time.
static void multiply(const bough_product *p, const double *a, const double *b, double *c) {
    for (int j = 0; j < p->n && p->keep != 1; j++) {
        double *column = c + (size_t)j * (size_t)p->rows_c;
        for (int i = 0; i < p->m; i++) column[i] = p->keep != 0 ? p->keep * column[i] : 0;
    }
    for (int row = 0; row < p->m; row += ROWS)
        add_rows(p, p->m - row < ROWS ? p->m - row : ROWS, a + row, b, c + row);
}

// Products of four columns with one or two: sum (2 × 4).
static void dot(int n, four a, const double *restrict x, const double *restrict y, double *sum) {
    const double *restrict c0 = a.c0, *restrict c1 = a.c1, *restrict c2 = a.c2, *restrict c3 = a.c3;
    double s0 = 0, s1 = 0, s2 = 0, s3 = 0, t0 = 0, t1 = 0, t2 = 0, t3 = 0;
#pragma omp simd reduction(+ : s0, s1, s2, s3, t0, t1, t2, t3)
    for (int i = 0; i < n; i++) {
        s0 += c0[i] * x[i];
        s1 += c1[i] * x[i];
        s2 += c2[i] * x[i];
        s3 += c3[i] * x[i];
        t0 += c0[i] * y[i];
        t1 += c1[i] * y[i];
        t2 += c2[i] * y[i];
        t3 += c3[i] * y[i];
    }
    const double sums[TWO * COLUMNS] = {s0, s1, s2, s3, t0, t1, t2, t3};
    memcpy(sum, sums, sizeof sums);
}

// Four rows of c by two of its columns at a time.
static void multiply_transposed(const bough_product *p, const double *a, const double *b, double *c) {
    size_t rows_a = (size_t)p->rows_a, rows_b = (size_t)p->rows_b;
    double sum[TWO * COLUMNS];
    for (int i = 0; i < p->m; i += COLUMNS) {
        int count = p->m - i < COLUMNS ? p->m - i : COLUMNS;
        four some = columns_at(a + (size_t)i * rows_a, rows_a, count);
        for (int j = 0; j < p->n; j += TWO) {
            int both = p->n - j < TWO ? 1 : TWO;
            dot(p->k, some, b + (size_t)j * rows_b, b + (size_t)(j + both - 1) * rows_b, sum);
            // entry (i + q % count, j + q / count) of c
            for (int q = 0; q < both * count; q++) {
                double *to = c + (size_t)(j + q / count) * (size_t)p->rows_c + (size_t)(i + q % count);
                double before = p->keep != 0 ? p->keep * *to : 0;
                *to = before + p->factor * sum[q / count * COLUMNS + q % count];
            }
        }
    }
}

void BOUGH_AT_LEVEL(bough_multiply_few)(const bough_product *p, const double *a, const double *b, double *c) {
    if (p->transposed)
        multiply_transposed(p, a, b, c);
    else
        multiply(p, a, b, c);
}

// Memory and products of block-tridiagonal matrices; factors and solutions are kernels.
#include "core/base/block_tridiagonal.h"

#include "core/base/block_matrix.h"

void bough_block_tridiagonal_init(bough_block_tridiagonal *m, bough_arena *arena, int n) {
    m->n = n;
    m->level = bough_level_chosen();
    size_t count = (size_t)bough_padded(n) * BOUGH_BLOCK;
    bough_arena_each(arena, count, &m->lower, &m->diagonal, &m->upper);
}

void bough_block_tridiagonal_subtract(const bough_block_tridiagonal *m, const double *x, double *y) {
    for (int i = 0; i < m->n; i++) {
        size_t block = (size_t)i * BOUGH_BLOCK;
        // the three blocks of row i
        double *row = y + (size_t)W * i;
        subtract_matvec(m->diagonal + block, x + (size_t)W * i, row);
        if (i > 0) subtract_matvec(m->lower + block, x + (size_t)W * (i - 1), row);
        if (i < m->n - 1) subtract_matvec(m->upper + block, x + (size_t)W * (i + 1), row);
    }
}

// The kernels' products of single blocks, for others.
void bough_block_product(const double *a, const double *b, double *c) { product(a, b, c); }

void bough_block_subtract(const double *a, const double *x, double *y) { subtract_matvec(a, x, y); }

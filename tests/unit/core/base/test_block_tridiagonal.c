// Block-tridiagonal elimination against the dense matrix solved with pivoting.

#include "core/base/block_tridiagonal.h"
#include "core/base/linalg.h"
#include "tests/unit/sample_rod.h"

enum { W = 8, MOST = 48 };

typedef struct fixture {
    bough_arena *arena;
    bough_block_tridiagonal m;
} fixture;

static fixture take(int n) {
    fixture f = {.arena = check_memory()};
    bough_block_tridiagonal_init(&f.m, f.arena, n);
    return f;
}

// Random blocks in [−size, size]² with `diagonal` added to the diagonal.
static void fill_block(double *b, unsigned *seed, double size, double diagonal) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) b[W * j + i] = size * sample_random(seed);
        b[W * i + i] += diagonal;
    }
}

static void transpose_block(const double *a, double *b) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) b[W * i + j] = a[W * j + i];
    }
}

// As a rod's: symmetric positive definite but for a part `skewed`, each row dominated by its
// diagonal without being near it.
static void fill(bough_block_tridiagonal *m, double skewed) {
    unsigned seed = 17;
    double full[BOUGH_BLOCK] = {0}, turned[BOUGH_BLOCK] = {0};
    for (int i = 0; i < m->n; i++) {
        double *lower = m->lower + i * BOUGH_BLOCK, *diagonal = m->diagonal + i * BOUGH_BLOCK;
        fill_block(full, &seed, 0.5, 10);
        transpose_block(full, turned);
        for (int k = 0; k < BOUGH_BLOCK; k++) diagonal[k] = 0.5 * (full[k] + turned[k]);
        if (i > 0) {
            fill_block(lower, &seed, 0.6, -2);
            transpose_block(lower, m->upper + (i - 1) * BOUGH_BLOCK);
        }
        fill_block(full, &seed, skewed, 0);
        for (int k = 0; k < BOUGH_BLOCK; k++) diagonal[k] += full[k];
        if (i > 0) {
            for (int k = 0; k < BOUGH_BLOCK; k++) lower[k] += full[k];
        }
    }
}

static void place(const double *block, int n, int row, int column, double *dense) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) dense[(column + j) * n + row + i] = block[W * j + i];
    }
}

// The same matrix (6 n × 6 n, column-major).
static double *dense_of(const bough_block_tridiagonal *m) {
    int n = 6 * m->n;
    double *dense = calloc((size_t)(n * n), sizeof *dense);
    assert_non_null(dense);
    for (int i = 0; i < m->n; i++) {
        place(m->diagonal + i * BOUGH_BLOCK, n, 6 * i, 6 * i, dense);
        if (i > 0) place(m->lower + i * BOUGH_BLOCK, n, 6 * i, 6 * (i - 1), dense);
        if (i < m->n - 1) place(m->upper + i * BOUGH_BLOCK, n, 6 * i, 6 * (i + 1), dense);
    }
    return dense;
}

static void random_rows(int n, unsigned seed, double *x) {
    memset(x, 0, (size_t)(W * n) * sizeof *x);
    for (int k = 0; k < 6 * n; k++) x[k / 6 * W + k % 6] = sample_random(&seed);
}

static void check_padding(const double *rows, int n) {
    for (int i = 0; i < n; i++) {
        check_near(rows[W * i + 6], 0, 0, 0);
        check_near(rows[W * i + 7], 0, 0, 0);
    }
}

static void solution_is_that_of_the_dense_matrix(int n, double skewed) {
    double x[W * MOST], b[6 * MOST];
    int pivot[6 * MOST];
    fixture f = take(n);
    fill(&f.m, skewed);
    double *dense = dense_of(&f.m);
    random_rows(n, 3, x);
    for (int k = 0; k < 6 * n; k++) b[k] = x[k / 6 * W + k % 6];
    assert_true(bough_dense_factor(6 * n, dense, pivot));
    bough_dense_solve(6 * n, 1, dense, pivot, b);
    assert_true(bough_block_tridiagonal_factor(&f.m));
    bough_block_tridiagonal_solve(&f.m, x);
    for (int k = 0; k < 6 * n; k++) check_near(x[k / 6 * W + k % 6], b[k], 1e-12, 1e-13);
    check_padding(x, n);
    check_padding(f.m.diagonal, 6 * n);
    check_padding(f.m.lower, 6 * n);
    check_padding(f.m.upper, 6 * n);
    free(dense);
    bough_arena_destroy(f.arena);
}

TEST(solves_as_the_dense_matrix_does) {
    static const int sizes[] = {1, 2, 7, MOST};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        solution_is_that_of_the_dense_matrix(sizes[k], 0.05); // nearly symmetric
        solution_is_that_of_the_dense_matrix(sizes[k], 1.0);
    }
}

TEST(subtract_takes_away_the_product) {
    static const int sizes[] = {1, 2, 7, MOST};
    double room[W + W * MOST], *x = room + W, y[W * MOST], start[W * MOST];
    for (int i = 0; i < W; i++) room[i] = 99; // row 0 couples to nothing before it
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        int n = sizes[k];
        fixture f = take(n);
        fill(&f.m, 1);
        for (int i = 0; i < BOUGH_BLOCK; i++) f.m.lower[i] = 99;
        double *dense = dense_of(&f.m);
        random_rows(n, 3, x);
        random_rows(n, 8, start);
        memcpy(y, start, sizeof y);
        bough_block_tridiagonal_subtract(&f.m, x, y);
        for (int i = 0; i < 6 * n; i++) {
            double sum = 0;
            for (int j = 0; j < 6 * n; j++) sum += dense[j * 6 * n + i] * x[j / 6 * W + j % 6];
            int at = i / 6 * W + i % 6;
            check_near(y[at], start[at] - sum, 1e-13, 1e-13);
        }
        check_padding(y, n);
        free(dense);
        bough_arena_destroy(f.arena);
    }
}

static void make_absolute(double *value, size_t count) {
    for (size_t k = 0; k < count; k++) value[k] = fabs(value[k]);
}

// The solution put back into the matrix gives the right-hand side to the rounding of |A| |x|, here
// of a rod's stiffness: far apart in magnitude, translations against rotations.
TEST(residual_vanishes_for_badly_scaled_rows) {
    double x[W * MOST], residual[W * MOST], size[W * MOST] = {0};
    fixture f = take(MOST), kept = take(MOST);
    fill(&f.m, 0.05);
    for (int i = 0; i < MOST; i++) {
        double *parts[3] = {f.m.lower + i * BOUGH_BLOCK, f.m.diagonal + i * BOUGH_BLOCK,
                            f.m.upper + i * BOUGH_BLOCK};
        for (int k = 0; k < 3 * 36; k++) {
            int row = k % 36 / 6, column = k % 6;
            double scale = (row < 3 ? 1e4 : 1e-2) * (column < 3 ? 1e4 : 1e-2);
            parts[k / 36][W * column + row] *= scale;
        }
    }
    size_t bytes = (size_t)MOST * BOUGH_BLOCK * sizeof(double);
    memcpy(kept.m.lower, f.m.lower, bytes);
    memcpy(kept.m.diagonal, f.m.diagonal, bytes);
    memcpy(kept.m.upper, f.m.upper, bytes);
    random_rows(MOST, 5, x);
    memcpy(residual, x, sizeof x);
    assert_true(bough_block_tridiagonal_factor(&f.m));
    bough_block_tridiagonal_solve(&f.m, x);
    bough_block_tridiagonal_subtract(&kept.m, x, residual);
    make_absolute(kept.m.lower, bytes / sizeof(double));
    make_absolute(kept.m.diagonal, bytes / sizeof(double));
    make_absolute(kept.m.upper, bytes / sizeof(double));
    make_absolute(x, W * MOST);
    bough_block_tridiagonal_subtract(&kept.m, x, size);
    for (int k = 0; k < W * MOST; k++) check_near(residual[k], 0, 0, 1e-13 * fabs(size[k]));
}

static bool factors_with(int n, int block, int entry, double value) {
    fixture f = take(n);
    fill(&f.m, 0.5);
    f.m.diagonal[block * BOUGH_BLOCK + entry] = value;
    bool ok = bough_block_tridiagonal_factor(&f.m);
    bough_arena_destroy(f.arena);
    return ok;
}

TEST(refuses_what_is_not_finite) {
    for (int block = 0; block < 3; block++) {
        assert_true(factors_with(3, block, W * 2 + 2, 9));
        for (int entry = 0; entry < 36; entry++) {
            assert_false(factors_with(3, block, W * (entry / 6) + entry % 6, (double)NAN));
        }
        for (int i = 0; i < 6; i++) assert_false(factors_with(3, block, 9 * i, (double)INFINITY));
    }
    for (int side = 0; side < 2; side++) {
        fixture f = take(3);
        fill(&f.m, 0.5);
        (side == 0 ? f.m.lower + BOUGH_BLOCK : f.m.upper)[W * 5] = (double)NAN;
        assert_false(bough_block_tridiagonal_factor(&f.m));
        bough_arena_destroy(f.arena);
    }
}

// The first row zero, a block of rank 5 at the end, and a reduced block that vanishes: U = D = L.
TEST(refuses_singular_pivots) {
    fixture f = take(2);
    for (int i = 0; i < 6; i++) f.m.diagonal[9 * i] = f.m.diagonal[BOUGH_BLOCK + 9 * i] = 1;
    f.m.diagonal[0] = 0;
    assert_false(bough_block_tridiagonal_factor(&f.m));
    f.m.diagonal[0] = 1;
    f.m.diagonal[BOUGH_BLOCK + 9 * 5] = 0;
    assert_false(bough_block_tridiagonal_factor(&f.m));
    fixture g = take(2);
    for (int i = 0; i < 6; i++) {
        double *entries[4] = {g.m.diagonal, g.m.diagonal + BOUGH_BLOCK, g.m.upper, g.m.lower + BOUGH_BLOCK};
        for (int k = 0; k < 4; k++) entries[k][9 * i] = 2;
    }
    assert_false(bough_block_tridiagonal_factor(&g.m));
}

TEST(single_blocks_multiply) {
    unsigned seed = 2;
    double a[BOUGH_BLOCK] = {0}, b[BOUGH_BLOCK] = {0}, c[BOUGH_BLOCK], x[W] = {0}, y[W] = {0};
    fill_block(a, &seed, 1, 0);
    fill_block(b, &seed, 1, 0);
    memset(c, 0xff, sizeof c);
    bough_block_product(a, b, c);
    random_rows(1, 4, x);
    random_rows(1, 6, y);
    double start[W];
    memcpy(start, y, sizeof y);
    bough_block_subtract(a, x, y);
    for (int i = 0; i < 6; i++) {
        double ax = 0;
        for (int k = 0; k < 6; k++) ax += a[W * k + i] * x[k];
        check_near(y[i], start[i] - ax, 1e-14, 1e-14);
        for (int j = 0; j < 6; j++) {
            double ab = 0;
            for (int k = 0; k < 6; k++) ab += a[W * k + i] * b[W * j + k];
            check_near(c[W * j + i], ab, 1e-14, 1e-14);
        }
    }
    check_padding(c, 6);
    check_padding(y, 1);
}

// Dense algebra against known solutions.
#include "tests/unit/check.h"

#include "core/base/linalg.h"

TEST(lu_solves_with_interchanges) {
    // column-major; the first pivot is zero
    double a[9] = {0, 2, 1, 1, 0, 1, 3, 1, 0};
    const double x[6] = {1, -2, 3, 0.5, 4, -1};
    double b[6] = {0};
    int pivot[3];
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < 3; c++) {
            for (int r = 0; r < 3; r++) b[3 * k + r] += a[3 * c + r] * x[3 * k + c];
        }
    }
    assert_true(bough_dense_factor(3, a, pivot));
    bough_dense_solve(3, 2, a, pivot, b);
    for (int i = 0; i < 6; i++) check_near(b[i], x[i], 1e-14, 0);
}

// Zeros on the diagonal: rows are exchanged within the band.
TEST(band_is_solved_with_interchanges) {
    enum { UNKNOWNS = 12, WIDTH = 2, ROWS = 3 * WIDTH + 1 };
    double a[ROWS * UNKNOWNS] = {0}, b[UNKNOWNS] = {0};
    int pivot[UNKNOWNS];
    for (int i = 0; i < UNKNOWNS; i++) {
        for (int j = 0; j < UNKNOWNS; j++) {
            if (abs(i - j) > WIDTH || i == j) continue;
            double entry = sin(1.7 * i * i + 3 * j) + 1.2;
            a[ROWS * j + 2 * WIDTH + i - j] = entry;
            b[i] += entry * (j - 2.5);
        }
    }
    assert_true(bough_band_solve(UNKNOWNS, WIDTH, a, pivot, b));
    for (int i = 0; i < UNKNOWNS; i++) check_near(b[i], i - 2.5, 0, 1e-11);
    memset(a, 0, sizeof a);
    assert_false(bough_band_solve(UNKNOWNS, WIDTH, a, pivot, b));
}

// By hand up to six unknowns, by a library beyond; diagonals are small, so that rows are exchanged.
TEST(lu_solves_systems_of_any_size) {
    for (int n = 1; n <= 9; n++) {
        double a[81], b[9] = {0};
        int pivot[9];
        for (int k = 0; k < n * n; k++) a[k] = sin(1.7 * k * k + n) - (k % (n + 1) == 0 ? 0.9 : 0);
        for (int c = 0; c < n; c++) {
            for (int r = 0; r < n; r++) b[r] += a[c * n + r] * (c - 2.5);
        }
        assert_true(bough_dense_factor(n, a, pivot));
        bough_dense_solve(n, 1, a, pivot, b);
        for (int i = 0; i < n; i++) check_near(b[i], i - 2.5, 0, 1e-12);
    }
}

// (2 × 3)(3 × 2), and the transpose of the first.
TEST(product_of_matrices) {
    const double a[6] = {1, 2, 3, 4, 5, 6}, b[6] = {1, 0, -1, 2, 1, 0}, at[6] = {1, 3, 5, 2, 4, 6};
    const double expected[4] = {-4, -4, 5, 8};
    double c[4] = {1, 1, 1, 1};
    bough_dense_product((bough_product){2, 2, 3, false, .factor = 1}, a, b, c);
    for (int i = 0; i < 4; i++) check_near(c[i], expected[i], 1e-15, 0);
    bough_dense_product((bough_product){2, 2, 3, true, .factor = 2, .keep = -1}, at, b, c);
    for (int i = 0; i < 4; i++) check_near(c[i], expected[i], 1e-15, 0);
}

// Both products of a matrix (m × k), at a level; all are parts of matrices with two rows more.
static void check_few(bough_level level, int m, int n, int k) {
    enum { M = 302, K = 47, N = 9 };
    static double a[M * K], b[K * N], c[M * N], bt[M * N], ct[K * N];
    int rows = m + 2, inner = k + 2;
    for (int i = 0; i < rows * k; i++) a[i] = sin(i);
    for (int i = 0; i < inner * n; i++) b[i] = cos(3 * i), ct[i] = 1;
    for (int i = 0; i < rows * n; i++) bt[i] = cos(2 * i), c[i] = 1;
    bough_product p = {m, n, k, false, 2, -3, rows, inner, rows},
                  t = {k, n, m, true, 2, -3, rows, rows, inner};
    BOUGH_OF_LEVEL(bough_multiply_few, level)(&p, a, b, c);
    BOUGH_OF_LEVEL(bough_multiply_few, level)(&t, a, bt, ct);
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < m; i++) {
            double sum = -3;
            for (int q = 0; q < k; q++) sum += 2 * a[q * rows + i] * b[j * inner + q];
            check_near(c[j * rows + i], sum, 0, 1e-12);
        }
        for (int q = 0; q < k; q++) {
            double sum = -3;
            for (int i = 0; i < m; i++) sum += 2 * a[q * rows + i] * bt[j * rows + i];
            check_near(ct[j * inner + q], sum, 0, 1e-12);
        }
        assert_true(c[j * rows + m] == 1 && ct[j * inner + k] == 1);
    }
}

// As many columns of either matrix as are worked on at once, more and fewer, and more rows.
TEST(products_with_few_columns_are_products_at_every_level) {
    for (bough_level level = BOUGH_LEVEL_V2; level < BOUGH_LEVEL_COUNT; level++) {
        if (!bough_level_runs(level)) continue;
        for (int n = 1; n <= 9; n++) {
            for (int k = 41; k <= 45; k++) check_few(level, 37, n, k);
        }
        check_few(level, 300, 5, 3);
    }
}

// A result that is not kept may be anything.
TEST(what_a_product_does_not_keep_is_not_read) {
    const double a[2] = {1, 2}, b[2] = {3, 4};
    double c[2] = {(double)NAN, (double)NAN};
    bough_dense_product((bough_product){2, 1, 1, false, .factor = 1}, a, b, c);
    assert_true(c[0] == 3 && c[1] == 6);
    c[0] = (double)NAN;
    bough_dense_product((bough_product){1, 1, 2, true, .factor = 1}, a, b, c);
    assert_true(c[0] == 11);
}

extern char *gotoblas_corename(void) __attribute__((weak));

// That OpenBLAS does not know the processor shows only on one that is newer.
TEST(no_old_kernels_on_a_new_processor) {
    if (!gotoblas_corename || getenv("OPENBLAS_CORETYPE") || !bough_level_runs(BOUGH_LEVEL_V3)) skip();
    bough_linalg_choose_kernels();
    assert_string_not_equal(gotoblas_corename(), "Prescott");
    const double a[4] = {1, 2, 3, 4};
    double b[4];
    bough_dense_product((bough_product){2, 2, 2, false, .factor = 1}, a, a, b);
    check_near(b[3], 22, 1e-15, 0);
}

TEST(lu_refuses_singular_and_nan) {
    double singular[4] = {1, 2, 2, 4}, nan[4] = {1, 0, NAN, 1};
    int pivot[2];
    assert_false(bough_dense_factor(2, singular, pivot));
    assert_false(bough_dense_factor(2, nan, pivot));
    assert_true(bough_dense_factor(0, NULL, NULL));
    bough_dense_solve(0, 1, NULL, NULL, NULL);
}

TEST(complex_lu_solves) {
    // ((0, 2 + i), (1 − i, 3)) (1 + 2i, −1) = (−2 − i, 0 + i)
    double a[8] = {0, 0, 1, -1, 2, 1, 3, 0}, b[4] = {-2, -1, 0, 1};
    const double x[4] = {1, 2, -1, 0};
    int pivot[2];
    assert_true(bough_complex_factor(2, a, pivot));
    bough_complex_solve(2, a, pivot, b);
    for (int i = 0; i < 4; i++) check_near(b[i], x[i], 0, 1e-14);
    double nan[8] = {0, NAN, 1, 0, 1, 0, 1, 0}, singular[8] = {1, 1, 2, 2, 1, 1, 2, 2};
    assert_false(bough_complex_factor(2, nan, pivot));
    assert_false(bough_complex_factor(2, singular, pivot));
    assert_true(bough_complex_factor(0, NULL, NULL));
}

// Eigenvalues 1, 2, 4 of Q diag Qᵀ with a Householder reflection Q, and the product again.
TEST(symmetric_eigenvectors_rebuild_the_matrix) {
    const double v[3] = {1, 2, -2}, expected[3] = {1, 2, 4};
    double q[3][3], a[9] = {0}, copy[9], value[3], work[24];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) q[i][j] = (i == j) - 2 * v[i] * v[j] / 9;
    }
    for (int k = 0; k < 9; k++) {
        for (int e = 0; e < 3; e++) a[k] += q[k / 3][e] * expected[e] * q[k % 3][e];
    }
    memcpy(copy, a, sizeof a);
    assert_true(bough_symmetric_eigen(3, copy, value, work));
    for (int k = 0; k < 9; k++) {
        double sum = 0;
        for (int e = 0; e < 3; e++) sum += copy[3 * e + k / 3] * value[e] * copy[3 * e + k % 3];
        check_near(sum, a[k], 0, 1e-14);
    }
    for (int e = 0; e < 3; e++) check_near(value[e], expected[e], 1e-14, 0);
    copy[0] = NAN;
    assert_false(bough_symmetric_eigen(3, copy, value, work));
    assert_true(bough_symmetric_eigen(0, NULL, NULL, NULL));
}

// A rotation scaled by 0.5 beside the number 3, seen through a change of basis.
TEST(eigenvalues_and_vectors) {
    const double a[9] = {0, 0.5, 0, -0.5, 0, 0, 1, 1, 3};
    double copy[9], value[6], v[9], work[BOUGH_EIGEN_WORK(3)];
    memcpy(copy, a, sizeof a);
    assert_true(bough_dense_eigen(3, copy, value, v, work));
    for (int k = 0; k < 3; k++) {
        bool pair = value[3 + k] != 0;
        check_near(hypot(value[k], value[3 + k]), pair ? 0.5 : 3, 1e-14, 0);
        const double *real = v + 3 * k, *imaginary = v + 3 * k + 3;
        for (int i = 0; i < 3; i++) {
            double product = 0, expected = value[k] * real[i];
            for (int j = 0; j < 3; j++) product += a[3 * j + i] * real[j];
            if (pair) expected -= value[3 + k] * imaginary[i];
            check_near(product, expected, 0, 1e-14);
        }
        if (pair) k++;
    }
    copy[0] = NAN;
    assert_false(bough_dense_eigen(3, copy, value, v, work));
}

// The second difference matrix: 2 − 2 cos(kπ/(n + 1)), its vectors sines.
TEST(smallest_eigenvalues_of_a_symmetric_matrix) {
    enum { SIZE = 6, COUNT = 3 };
    double a[SIZE * SIZE] = {0}, value[SIZE], vector[SIZE * COUNT], work[26 * SIZE];
    int index[12 * SIZE];
    for (int j = 0; j < SIZE; j++) {
        a[SIZE * j + j] = 2;
        if (j + 1 < SIZE) a[SIZE * j + j + 1] = -1;
    }
    assert_true(bough_symmetric_smallest(SIZE, a, COUNT, value, vector, work, index));
    for (int k = 0; k < COUNT; k++) {
        double angle = (k + 1) * acos(-1) / (SIZE + 1), norm = sqrt(2.0 / (SIZE + 1));
        check_near(value[k], 2 - 2 * cos(angle), 1e-14, 0);
        double sign = vector[SIZE * k] < 0 ? -1 : 1;
        for (int i = 0; i < SIZE; i++) {
            check_near(sign * vector[SIZE * k + i], norm * sin((i + 1) * angle), 0, 1e-14);
        }
    }
    a[0] = NAN;
    assert_false(bough_symmetric_smallest(SIZE, a, COUNT, value, vector, work, index));
}

// A = L Lᵀ with L known; only the lower triangle of A is given.
TEST(cholesky_finds_the_factor) {
    const double l[9] = {2, 0, 0, 1, 3, 0, -1, 0.5, 1.5};
    double a[9], b[3] = {0};
    const double x[3] = {1, 2, -3};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += l[3 * i + k] * l[3 * j + k];
            a[3 * i + j] = j <= i ? sum : (double)NAN;
            b[i] += sum * x[j];
        }
    }
    assert_true(bough_cholesky_factor(3, a));
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j <= i; j++) check_near(a[3 * i + j], l[3 * i + j], 1e-15, 1e-15);
    }
    bough_cholesky_solve(3, a, b);
    for (int i = 0; i < 3; i++) check_near(b[i], x[i], 1e-14, 0);
}

TEST(cholesky_refuses_indefinite_and_nearly_singular) {
    double indefinite[4] = {1, 0, 2, 1}, near[4] = {1, 0, 1, 1 + 1e-14}, zero[1] = {0};
    double nan[1] = {NAN}, fine[4] = {1, 0, 1, 1 + 1e-10};
    assert_false(bough_cholesky_factor(2, indefinite));
    assert_false(bough_cholesky_factor(2, near));
    assert_false(bough_cholesky_factor(1, zero));
    assert_false(bough_cholesky_factor(1, nan));
    assert_true(bough_cholesky_factor(2, fine));
}

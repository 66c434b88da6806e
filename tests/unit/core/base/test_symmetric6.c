// Symmetric 6×6 matrices kept as triangles.

#include "core/base/linalg.h"
#include "tests/unit/sample_rod.h"

// GᵀG + shift E of a random G.
static void random_matrix(unsigned seed, double shift, double a[21]) {
    double g[6][6];
    for (int k = 0; k < 36; k++) g[k / 6][k % 6] = sample_random(&seed);
    for (int i = 0, at = 0; i < 6; i++) {
        for (int j = i; j < 6; j++, at++) {
            a[at] = i == j ? shift : 0;
            for (int k = 0; k < 6; k++) a[at] += g[k][i] * g[k][j];
        }
    }
}

static void expand(const double a[21], double full[6][6]) {
    for (int i = 0, at = 0; i < 6; i++) {
        for (int j = i; j < 6; j++, at++) full[i][j] = full[j][i] = a[at];
    }
}

TEST(index_runs_through_the_triangle_by_rows) {
    for (int i = 0, at = 0; i < 6; i++) {
        for (int j = i; j < 6; j++, at++) {
            assert_int_equal(bough_symmetric6_index(i, j), at);
            assert_int_equal(bough_symmetric6_index(j, i), at);
        }
    }
    assert_int_equal(bough_symmetric6_index(5, 5), 20);
}

static void check_inverse(const double a[21], const double inverse[21], double tolerance) {
    double x[6][6], y[6][6];
    expand(a, x);
    expand(inverse, y);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            double sum = 0;
            for (int k = 0; k < 6; k++) sum += x[i][k] * y[k][j];
            check_near(sum, i == j, 0, tolerance);
        }
    }
}

TEST(inverse_times_matrix_is_the_identity) {
    double a[21], inverse[21];
    for (unsigned seed = 1; seed < 20; seed++) {
        random_matrix(seed, 0.5, a);
        assert_true(bough_symmetric6_inverse(a, inverse));
        check_inverse(a, inverse, 1e-13);
    }
}

TEST(inverse_may_be_in_place) {
    double a[21], kept[21], inverse[21];
    random_matrix(4, 0.5, a);
    memcpy(kept, a, sizeof a);
    assert_true(bough_symmetric6_inverse(a, inverse));
    assert_memory_equal(a, kept, sizeof a);
    assert_true(bough_symmetric6_inverse(a, a));
    assert_memory_equal(a, inverse, sizeof a);
}

TEST(inverse_refuses_what_is_not_positive_definite) {
    double a[21], inverse[21];
    for (int k = 0; k < 6; k++) {
        random_matrix(3, 1, a);
        assert_true(bough_symmetric6_inverse(a, inverse));
        double kept = a[bough_symmetric6_index(k, k)];
        a[bough_symmetric6_index(k, k)] = -kept;
        assert_false(bough_symmetric6_inverse(a, inverse));
        a[bough_symmetric6_index(k, k)] = (double)NAN;
        assert_false(bough_symmetric6_inverse(a, inverse));
    }
    memset(a, 0, sizeof a);
    assert_false(bough_symmetric6_inverse(a, inverse));
    // positive on the diagonal, indefinite by its coupling
    for (int i = 0; i < 6; i++) a[bough_symmetric6_index(i, i)] = 1;
    a[bough_symmetric6_index(1, 4)] = 1.1;
    assert_false(bough_symmetric6_inverse(a, inverse));
}

// Q A Qᵀ written out.
static void turned_explicitly(const double a[21], double angle, double turned[6][6]) {
    double full[6][6], q[6][6] = {{0}};
    expand(a, full);
    for (int k = 0; k < 6; k += 3) {
        q[k][k] = q[k + 1][k + 1] = cos(angle);
        q[k][k + 1] = -sin(angle);
        q[k + 1][k] = sin(angle);
        q[k + 2][k + 2] = 1;
    }
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            turned[i][j] = 0;
            for (int k = 0; k < 36; k++) {
                turned[i][j] += q[i][k / 6] * full[k / 6][k % 6] * q[j][k % 6];
            }
        }
    }
}

TEST(turn_is_a_rotation_about_z) {
    const double angles[] = {0, 0.3, -1.2, BOUGH_PI / 2, 4};
    double a[21], turned[21], back[21], expected[6][6];
    random_matrix(9, 0.1, a);
    for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
        bough_symmetric6_rotate(a, angles[k], turned);
        turned_explicitly(a, angles[k], expected);
        for (int i = 0; i < 36; i++) {
            check_near(turned[bough_symmetric6_index(i / 6, i % 6)], expected[i / 6][i % 6], 1e-14, 1e-14);
        }
        bough_symmetric6_rotate(turned, -angles[k], back);
        for (int i = 0; i < 21; i++) check_near(back[i], a[i], 1e-14, 1e-14);
        bough_symmetric6_rotate(turned, -angles[k], turned); // in place
        assert_memory_equal(turned, back, sizeof back);
    }
}

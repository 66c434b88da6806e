// Eigenvalues of block-tridiagonal systems with closed forms.
#include "tests/unit/check.h"

#include "core/base/eigen.h"

enum { N = 40, WANTED = 10 };

typedef struct chain {
    bough_arena *arena;
    double *mass;
    bough_block_tridiagonal damping, stiffness;
    bough_eigen_pair pair[WANTED];
    int found;
    bough_status status;
} chain;

static chain empty_chain(int n) {
    chain c = {.arena = check_memory()};
    c.mass = bough_arena_doubles(c.arena, (size_t)n * BOUGH_BLOCK);
    bough_block_tridiagonal_init(&c.damping, c.arena, n);
    bough_block_tridiagonal_init(&c.stiffness, c.arena, n);
    return c;
}

// Unit masses on springs k[c] in each of six directions, fixed at one end and free at the other.
static chain springs(int n, const double k[6]) {
    chain c = empty_chain(n);
    for (int i = 0; i < n; i++) {
        for (int d = 0; d < 6; d++) {
            int at = i * BOUGH_BLOCK + 9 * d;
            c.mass[at] = 1;
            c.stiffness.diagonal[at] = i < n - 1 ? 2 * k[d] : k[d];
            c.stiffness.lower[at] = c.stiffness.upper[at] = -k[d];
        }
    }
    return c;
}

static void solve(chain *c, int wanted) {
    bough_eigen_problem problem = {"chain", c->mass, &c->damping, &c->stiffness};
    c->status = bough_eigen_smallest(c->arena, &problem, wanted, c->pair, &c->found);
}

// Two directions are equal, two are three times as stiff: 2√k sin((2j − 1)π/(4n + 2)), each twice.
TEST(chain_of_masses_has_its_frequencies) {
    const double k[6] = {1, 1, 3, 3, 1000, 1000};
    chain c = springs(N, k);
    solve(&c, WANTED);
    assert_int_equal(c.status.code, BOUGH_OK);
    assert_int_equal(c.found, WANTED);
    double last = 0;
    for (int i = 0, soft = 1, stiff = 1; i < WANTED; i += 2) {
        double a = 2 * sin((2 * soft - 1) * BOUGH_PI / (4 * N + 2));
        double b = 2 * sqrt(3) * sin((2 * stiff - 1) * BOUGH_PI / (4 * N + 2));
        double expected = a < b ? a : b;
        if (a < b) {
            soft++;
        } else {
            stiff++;
        }
        for (int copy = 0; copy < 2; copy++) {
            check_near(c.pair[i + copy].imaginary, expected, 1e-10, 0);
            check_near(c.pair[i + copy].real, 0, 0, 1e-10);
            assert_true(c.pair[i + copy].imaginary >= last * (1 - 1e-10));
        }
        last = expected;
    }
}

// (λ²M + λC + K) q = 0 for what is returned, with damping and gyroscopic terms.
TEST(pairs_satisfy_the_equation) {
    const double k[6] = {1, 1, 3, 3, 10, 10};
    chain c = springs(N, k), copy = springs(N, k);
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < 6; d++) c.damping.diagonal[i * BOUGH_BLOCK + 9 * d] = 0.01 * (d + 1);
        c.damping.diagonal[i * BOUGH_BLOCK + 1] = 0.3;
        c.damping.diagonal[i * BOUGH_BLOCK + 8] = -0.3;
    }
    solve(&c, WANTED);
    assert_int_equal(c.status.code, BOUGH_OK);
    for (int p = 0; p < c.found; p++) {
        double s = c.pair[p].real, w = c.pair[p].imaginary, sum = 0, size = 0;
        double combined[2][8 * N], result[2][8 * N] = {{0}};
        const double *a = c.pair[p].shape_real, *b = c.pair[p].shape_imag;
        for (int i = 0; i < 8 * N; i++) { // λ q, then C λ q + K q, then + λ² q
            combined[0][i] = s * a[i] - w * b[i];
            combined[1][i] = s * b[i] + w * a[i];
        }
        for (int part = 0; part < 2; part++) {
            bough_block_tridiagonal_subtract(&c.damping, combined[part], result[part]);
            bough_block_tridiagonal_subtract(&copy.stiffness, part == 0 ? a : b, result[part]);
        }
        for (int i = 0; i < 8 * N; i++) {
            double x = result[0][i] - (s * combined[0][i] - w * combined[1][i]);
            double y = result[1][i] - (s * combined[1][i] + w * combined[0][i]);
            sum += x * x + y * y;
            size += a[i] * a[i] + b[i] * b[i];
        }
        check_near(sqrt(sum), 0, 0, 1e-8 * (s * s + w * w) * sqrt(size));
        assert_true(s < 0);
    }
}

TEST(small_system_gives_all_it_has) {
    const double k[6] = {1, 4, 9, 16, 25, 36};
    chain c = springs(1, k);
    solve(&c, WANTED);
    assert_int_equal(c.status.code, BOUGH_OK);
    assert_int_equal(c.found, 6);
    for (int i = 0; i < 6; i++) check_near(c.pair[i].imaginary, i + 1, 1e-10, 0);
}

// Beyond buckling a real solution grows; an overdamped one decays and is not listed.
TEST(growing_solution_is_listed) {
    const double k[6] = {-4, 1, 9, 16, 25, 36};
    chain c = springs(1, k);
    c.damping.diagonal[9] = 50;
    solve(&c, WANTED);
    assert_int_equal(c.status.code, BOUGH_OK);
    assert_int_equal(c.found, 5);
    check_near(c.pair[0].real, 2, 1e-10, 0);
    check_near(c.pair[0].imaginary, 0, 0, 0);
    check_near(c.pair[1].imaginary, 3, 1e-10, 0);
}

TEST(singular_stiffness_is_diagnosed) {
    const double k[6] = {1, 1, 0, 1, 1, 1};
    chain c = springs(3, k);
    solve(&c, WANTED);
    check_fails(c.status, BOUGH_FAILED, "chain: the stiffness");
}

// Of A⁻¹, diagonal in its first entries, the others are moved by one place in a circle: eigenvalues of equal
// modulus, of which Arnoldi's method finds none.
enum { SLOW = 12, ALL = 1000 };
static void shift_one(double circle, const double *z, double *image) {
    for (int i = 0; i < SLOW; i++) image[i] = z[i] / (1 + i);
    for (int i = SLOW; i < ALL; i++) image[i] = circle * z[i + 1 < ALL ? i + 1 : SLOW];
}

static void shift(void *self, int n, const double *z, double *image) {
    const double *circle = self;
    for (int k = 0; k < n; k++) shift_one(*circle, z + k * ALL, image + k * ALL);
}

TEST(as_many_as_converge_are_found) {
    check_arena(arena);
    double circle = 1e-3;
    bough_eigen_operator op = {.name = "circle",
                               .length = ALL,
                               .n_shape = ALL,
                               .weight = bough_arena_doubles(arena, ALL),
                               .self = &circle,
                               .apply = shift};
    bough_eigen_pair pair[20];
    bough_eigen_count count = {.wanted = 20};
    for (int i = 0; i < ALL; i++) op.weight[i] = 1;
    check_ok(bough_eigen_nearest(arena, &op, pair, &count));
    assert_int_equal(count.wanted, 20);
    assert_int_equal(count.converged, 10);
    assert_int_equal(count.found, 10);
    for (int k = 0; k < 10; k++) {
        check_near(pair[k].real, 1 + k, 1e-10, 0);
        assert_true(pair[k].residual < 1e-8);
    }
}

// A⁻¹ = H D H with a reflection H; the last entries of the diagonal D are zero, so that their eigenvalues
// come out as rounding of either sign.
enum { KEPT = 6, REFLECTED = 16 };
static void reflect(double *z) {
    double sum = 0;
    for (int i = 0; i < REFLECTED; i++) sum += (1 + i % 3) * z[i];
    for (int i = 0; i < REFLECTED; i++) z[i] -= sum * (1 + i % 3) / 35.5; // half of the sum of (1 + i % 3)²
}

static void project(void *self, int n, const double *z, double *image) {
    (void)self;
    memcpy(image, z, (size_t)n * REFLECTED * sizeof *z);
    for (int k = 0; k < n; k++) {
        double *x = image + k * REFLECTED;
        reflect(x);
        for (int i = 0; i < REFLECTED; i++) x[i] = i < KEPT ? x[i] / (1 + i) : 0;
        reflect(x);
        for (int i = 0; i < REFLECTED; i++) x[i] = (x[i] + 1e4) - 1e4; // as an ill-conditioned solution
    }
}

TEST(vectors_that_the_inverse_maps_to_zero_have_no_eigenvalue) {
    check_arena(arena);
    bough_eigen_operator op = {.name = "reflection",
                               .length = REFLECTED,
                               .n_shape = REFLECTED,
                               .weight = bough_arena_doubles(arena, REFLECTED),
                               .apply = project};
    bough_eigen_pair pair[WANTED];
    bough_eigen_count count = {.wanted = WANTED};
    for (int i = 0; i < REFLECTED; i++) op.weight[i] = 1;
    check_ok(bough_eigen_nearest(arena, &op, pair, &count));
    assert_int_equal(count.found, KEPT);
    for (int k = 0; k < KEPT; k++) check_near(pair[k].real, 1 + k, 1e-9, 0);
}

// Of x that misses an eigenvector by ε of another, y = A⁻¹ x misses it by ε λ/λ′: the residual is ε (1 −
// λ/λ′).
TEST(residual_is_the_distance_from_an_eigenvector) {
    check_arena(arena);
    double circle = 1e-3, x[2 * ALL] = {[1] = 1, [3] = 1e-3}, y[2 * ALL] = {0};
    bough_eigen_operator op = {.length = ALL, .weight = bough_arena_doubles(arena, ALL)};
    for (int i = 0; i < ALL; i++) op.weight[i] = 1;
    shift_one(circle, x, y);
    check_near(bough_eigen_residual(&op, 2, 0, x, y), 1e-3 * (1 - 2. / 4), 1e-6, 0);
    op.gamma = 0.5; // of (1 − 1/ν)/γ they are −2 and −6
    check_near(bough_eigen_residual(&op, -2, 0, x, y), 1e-3 * (6 - 2) / 4 / (2 * 0.5), 1e-6, 0);
}

#include "core/eigen.h"

#include "core/linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    W8 = 8,
    BLOCK_SIZE = 4, // starting vectors: multiplicities up to this are found
    SPARE = 60,     // vectors beyond those wanted before the first look
    LOOKS = 4,      // after the first, each with half as many vectors more
};

static const double accuracy = 1e-9;
static const double dependent = 1e-13; // share of a vector that counts as none

// Vectors are (q, λq), 16 n long.
typedef struct arnoldi {
    const bough_eigen_problem *problem;
    int n, length;   // blocks; doubles of a vector
    int capacity;    // most vectors
    int count, done; // vectors in the basis; those to which the operator was applied
    double *basis;   // (capacity × length)
    double *h;       // operator in the basis (capacity × capacity), column j of vector j
    double *weight;  // of the inner product (length)
    double *image;   // (length)
} arnoldi;

// What one look at the projected matrix gives.
typedef struct ritz {
    double *matrix, *value, *vector, *work; // of bough_dense_eigen
    int *order;                             // by falling modulus
} ritz;

static double *vector_at(const arnoldi *a, int k) {
    return a->basis + (size_t)k * a->length;
}

static double product(const arnoldi *a, const double *x, const double *y) {
    double sum = 0;
    for (int i = 0; i < a->length; i++) sum += a->weight[i] * x[i] * y[i];
    return sum;
}

// y −= M x
static void subtract_mass(const arnoldi *a, const double *x, double *y) {
    for (int i = 0; i < a->n; i++) {
        bough_block_subtract(a->problem->mass + (size_t)i * BOUGH_BLOCK, x + (size_t)W8 * i,
                             y + (size_t)W8 * i);
    }
}

// (q, v) → (−K⁻¹(C q + M v), q): its eigenvalues are 1/λ.
static void apply(const arnoldi *a, const double *z, double *image) {
    size_t half = (size_t)a->length / 2;
    memset(image, 0, half * sizeof *image);
    bough_block_tridiagonal_subtract(a->problem->damping, z, image);
    subtract_mass(a, z + half, image);
    bough_block_tridiagonal_solve(a->problem->stiffness, image);
    memcpy(image + half, z, half * sizeof *image);
}

// Makes x orthogonal to the basis, coefficients added to `column` unless NULL, and appends it of
// length 1; a vector that depends on the basis is dropped.
static void append(arnoldi *a, double *x, double *column) {
    double before = sqrt(product(a, x, x));
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < a->count; k++) {
            double *v = vector_at(a, k), share = product(a, v, x);
            for (int i = 0; i < a->length; i++) x[i] -= share * v[i];
            if (column != NULL) column[k] += share;
        }
    }
    double norm = sqrt(product(a, x, x));
    if (!(norm > dependent * before) || a->count == a->capacity) return;
    if (column != NULL) column[a->count] = norm;
    double *v = vector_at(a, a->count++);
    for (int i = 0; i < a->length; i++) v[i] = x[i] / norm;
}

// Random vectors smoothed by the operator. The first also sets the weights: displacements count
// like velocities at the frequency that it shows.
static void start(arnoldi *a) {
    unsigned seed = 1;
    int half = a->length / 2;
    double speed = 0, displacement = 0;
    for (int i = 0; i < half; i++) {
        int block = i / W8, c = i % W8;
        const double *mass = a->problem->mass + (size_t)block * BOUGH_BLOCK;
        a->weight[i] = a->weight[half + i] = c < 6 ? fabs(mass[W8 * c + c]) : 0;
    }
    for (int k = 0; k < BLOCK_SIZE; k++) {
        double *random = vector_at(a, a->capacity - 1);
        for (int i = 0; i < a->length; i++) {
            seed = seed * 1664525u + 1013904223u;
            random[i] = i % W8 < 6 ? (double)(seed >> 8) / 8388608.0 - 1 : 0;
        }
        for (int twice = 0; twice < 2; twice++) {
            apply(a, random, a->image);
            memcpy(random, a->image, (size_t)a->length * sizeof *random);
        }
        for (int i = 0; k == 0 && i < half; i++) {
            displacement += a->weight[i] * random[i] * random[i];
            speed += a->weight[i] * random[half + i] * random[half + i];
        }
        for (int i = 0; k == 0 && i < half; i++) a->weight[i] *= speed / displacement;
        append(a, a->image, NULL);
    }
}

static void extend(arnoldi *a, int target) {
    while (a->done < a->count && a->done < target) {
        apply(a, vector_at(a, a->done), a->image);
        append(a, a->image, a->h + (size_t)a->done * a->capacity);
        a->done++;
    }
}

// -- the projected problem ------------------------------------------------------------------------

static double modulus(const ritz *r, int m, int k) {
    return hypot(r->value[k], r->value[m + k]);
}

// Insertion: m is some hundred, and LAPACK's order is nearly sorted.
static void sort(ritz *r, int m) {
    for (int k = 0; k < m; k++) {
        int at = k;
        for (; at > 0 && modulus(r, m, r->order[at - 1]) < modulus(r, m, k); at--) {
            r->order[at] = r->order[at - 1];
        }
        r->order[at] = k;
    }
}

static bool project(const arnoldi *a, ritz *r) {
    int m = a->done;
    for (int j = 0; j < m; j++) {
        memcpy(r->matrix + (size_t)j * m, a->h + (size_t)j * a->capacity,
               (size_t)m * sizeof *r->matrix);
    }
    if (!bough_dense_eigen(m, r->matrix, r->value, r->vector, r->work)) return false;
    sort(r, m);
    return true;
}

// The two columns that hold an eigenvector; the second NULL for a real one.
static const double *parts_of(const ritz *r, int m, int k, const double **imaginary) {
    *imaginary = r->value[m + k] == 0 ? NULL : r->vector + (size_t)(k + 1) * m;
    return r->vector + (size_t)k * m;
}

// Length of what the operator makes of a Ritz vector outside the basis of the first m vectors.
static double residual(const arnoldi *a, const ritz *r, int k) {
    int m = a->done;
    const double *y[2];
    y[0] = parts_of(r, m, k, &y[1]);
    double sum = 0;
    for (int row = m; row < a->count; row++) {
        for (int part = 0; part < 2 && y[part] != NULL; part++) {
            double entry = 0;
            for (int j = 0; j < m; j++) entry += a->h[(size_t)j * a->capacity + row] * y[part][j];
            sum += entry * entry;
        }
    }
    return sqrt(sum);
}

// Whether a Ritz value belongs to what is listed: the first of a pair, or growing.
static bool is_listed(const ritz *r, int m, int k) {
    double real = r->value[k], imaginary = r->value[m + k];
    return imaginary > 0 || (imaginary == 0 && real > 0);
}

// The first listed ones that are accurate; *sum of their moduli. The rest of the Ritz values wander
// from look to look: the operator is far from normal in the product that is at hand.
static int select(const arnoldi *a, const ritz *r, int wanted, int *chosen, double *sum) {
    int m = a->done, found = 0;
    *sum = 0;
    for (int i = 0; i < m && found < wanted; i++) {
        int k = r->order[i];
        if (!is_listed(r, m, k) || residual(a, r, k) > accuracy * modulus(r, m, k)) continue;
        *sum += modulus(r, m, k);
        chosen[found++] = k;
    }
    return found;
}

// Looks until all that are wanted are accurate and the next look, in half as many dimensions more,
// has found no other among them.
static bool iterate(arnoldi *a, ritz *r, int wanted, int *chosen, int *found) {
    int first = 4 * wanted + SPARE;
    double before = -1, sum;
    for (int look = 0; look <= LOOKS; look++) {
        extend(a, first + first * look / 2);
        if (!project(a, r)) return false;
        *found = select(a, r, wanted, chosen, &sum);
        if (a->done == a->count) return true; // the basis holds all there is
        if (*found == wanted && fabs(sum - before) <= 10 * accuracy * sum) return true;
        before = *found == wanted ? sum : -1;
    }
    return false;
}

// q = Σ yₖ qₖ
static void combine(const arnoldi *a, const double *y, double *shape) {
    int half = a->length / 2;
    for (int k = 0; k < a->done; k++) {
        const double *v = vector_at(a, k);
        for (int i = 0; i < half; i++) shape[i] += y[k] * v[i];
    }
}

// λ = 1/μ; μ's conjugate partner is the one of the positive imaginary part.
static void fill_pair(const arnoldi *a, const ritz *r, int k, bough_eigen_pair *pair) {
    int m = a->done;
    const double *imaginary, *real = parts_of(r, m, k, &imaginary);
    double x = r->value[k], y = r->value[m + k], square = x * x + y * y;
    pair->real = x / square;
    pair->imaginary = y / square;
    combine(a, real, pair->shape_real);
    if (imaginary == NULL) return;
    combine(a, imaginary, pair->shape_imag);
    for (int i = 0; i < a->length / 2; i++) pair->shape_imag[i] *= -1;
}

// -- whole ----------------------------------------------------------------------------------------

static bool take(bough_arena *arena, int wanted, arnoldi *a, ritz *r) {
    size_t length = (size_t)a->length, m = (size_t)a->capacity;
    a->basis = bough_arena_doubles(arena, m * length);
    a->h = bough_arena_doubles(arena, m * m);
    a->weight = bough_arena_doubles(arena, length);
    a->image = bough_arena_doubles(arena, length);
    r->matrix = bough_arena_doubles(arena, m * m);
    r->vector = bough_arena_doubles(arena, m * m);
    r->value = bough_arena_doubles(arena, 2 * m);
    r->work = bough_arena_doubles(arena, 8 * m);
    r->order = bough_arena_take(arena, (m + (size_t)wanted) * sizeof *r->order);
    return !bough_arena_exhausted(arena);
}

static bool take_shapes(bough_arena *arena, const arnoldi *a, bough_eigen_pair *pair, int count) {
    for (int i = 0; i < count; i++) {
        pair[i].shape_real = bough_arena_doubles(arena, (size_t)a->length / 2);
        pair[i].shape_imag = bough_arena_doubles(arena, (size_t)a->length / 2);
    }
    return !bough_arena_exhausted(arena);
}

bough_status bough_eigen_smallest(bough_arena *arena, const bough_eigen_problem *problem,
                                  int wanted, bough_eigen_pair *pair, int *found) {
    int n = problem->stiffness->n, first = 4 * wanted + SPARE;
    int most = first + first * LOOKS / 2;
    arnoldi a = {.problem = problem, .n = n, .length = 2 * W8 * n, .capacity = most + BLOCK_SIZE};
    ritz r;
    if (!take(arena, wanted, &a, &r)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (!bough_block_tridiagonal_factor(problem->stiffness)) {
        return bough_fail(BOUGH_FAILED, "%s: the stiffness about the equilibrium is singular: it"
                          " stands at a buckling load; change the load", problem->name);
    }
    int *chosen = r.order + a.capacity;
    start(&a);
    if (!iterate(&a, &r, wanted, chosen, found)) {
        return bough_fail(BOUGH_FAILED, "%s: the %d lowest eigenvalues were not found to %g; ask"
                          " for fewer", problem->name, wanted, accuracy);
    }
    if (!take_shapes(arena, &a, pair, *found)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    }
    for (int i = 0; i < *found; i++) fill_pair(&a, &r, chosen[i], &pair[i]);
    return bough_ok();
}

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

typedef struct arnoldi {
    const bough_eigen_operator *op;
    int length;      // of a vector
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

static void apply(const arnoldi *a, const double *z, double *image) {
    a->op->apply(a->op->self, z, image);
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

// Displacements count like velocities at the frequency that a smoothed vector shows.
static void balance(arnoldi *a, const double *smooth) {
    int half = a->length / 2;
    double speed = 0, displacement = 0;
    for (int i = 0; i < half; i++) {
        displacement += a->weight[i] * smooth[i] * smooth[i];
        speed += a->weight[i] * smooth[half + i] * smooth[half + i];
    }
    for (int i = 0; i < half; i++) a->weight[i] *= speed / displacement;
}

// Random vectors smoothed by the operator.
static void start(arnoldi *a) {
    unsigned seed = 1;
    for (int k = 0; k < BLOCK_SIZE; k++) {
        double *random = vector_at(a, a->capacity - 1);
        for (int i = 0; i < a->length; i++) {
            seed = seed * 1664525u + 1013904223u;
            random[i] = a->weight[i] > 0 ? (double)(seed >> 8) / 8388608.0 - 1 : 0;
        }
        for (int twice = 0; twice < 2; twice++) {
            apply(a, random, a->image);
            memcpy(random, a->image, (size_t)a->length * sizeof *random);
        }
        if (k == 0 && a->op->balance) balance(a, random);
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

// λ of a Ritz value μ: 1/μ, or (1 − 1/μ)/γ.
static void eigenvalue(const arnoldi *a, const ritz *r, int k, double *real, double *imaginary) {
    double x = r->value[k], y = r->value[a->done + k], square = x * x + y * y;
    double gamma = a->op->gamma;
    *real = gamma > 0 ? (1 - x / square) / gamma : x / square;
    *imaginary = y / square / (gamma > 0 ? gamma : 1); // of μ or of its partner
}

// Whether a Ritz value belongs to what is listed: the first of a pair, or growing.
static bool is_listed(const arnoldi *a, const ritz *r, int k) {
    double real, imaginary;
    eigenvalue(a, r, k, &real, &imaginary);
    return imaginary > 0 || (imaginary == 0 && real > 0);
}

// The first listed ones that are accurate; *sum of their moduli. The rest of the Ritz values wander
// from look to look: the operator is far from normal in the product that is at hand.
static int select(const arnoldi *a, const ritz *r, int wanted, int *chosen, double *sum) {
    int m = a->done, found = 0;
    *sum = 0;
    for (int i = 0; i < m && found < wanted; i++) {
        int k = r->order[i];
        if (!is_listed(a, r, k) || residual(a, r, k) > accuracy * modulus(r, m, k)) continue;
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
    for (int k = 0; k < a->done; k++) {
        const double *v = vector_at(a, k);
        for (int i = 0; i < a->op->n_shape; i++) shape[i] += y[k] * v[i];
    }
}

// Of 1/μ it is μ's conjugate partner that has the positive imaginary part.
static void fill_pair(const arnoldi *a, const ritz *r, int k, bough_eigen_pair *pair) {
    const double *imaginary, *real = parts_of(r, a->done, k, &imaginary);
    eigenvalue(a, r, k, &pair->real, &pair->imaginary);
    combine(a, real, pair->shape_real);
    if (imaginary == NULL) return;
    combine(a, imaginary, pair->shape_imag);
    for (int i = 0; i < a->op->n_shape && a->op->gamma == 0; i++) pair->shape_imag[i] *= -1;
}

// -- whole ----------------------------------------------------------------------------------------

static bool take(bough_arena *arena, int wanted, arnoldi *a, ritz *r) {
    size_t length = (size_t)a->length, m = (size_t)a->capacity;
    a->basis = bough_arena_doubles(arena, m * length);
    a->h = bough_arena_doubles(arena, m * m);
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
        pair[i].shape_real = bough_arena_doubles(arena, (size_t)a->op->n_shape);
        pair[i].shape_imag = bough_arena_doubles(arena, (size_t)a->op->n_shape);
    }
    return !bough_arena_exhausted(arena);
}

bough_status bough_eigen_nearest(bough_arena *arena, const bough_eigen_operator *op, int wanted,
                                 bough_eigen_pair *pair, int *found) {
    int first = 4 * wanted + SPARE, most = first + first * LOOKS / 2;
    arnoldi a = {
        .op = op, .length = op->length, .capacity = most + BLOCK_SIZE, .weight = op->weight};
    ritz r;
    if (!take(arena, wanted, &a, &r)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    int *chosen = r.order + a.capacity;
    start(&a);
    if (!iterate(&a, &r, wanted, chosen, found)) {
        return bough_fail(BOUGH_FAILED, "%s: the %d lowest eigenvalues were not found to %g; ask"
                          " for fewer", op->name, wanted, accuracy);
    }
    if (!take_shapes(arena, &a, pair, *found)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    }
    for (int i = 0; i < *found; i++) fill_pair(&a, &r, chosen[i], &pair[i]);
    return bough_ok();
}

// -- second order ---------------------------------------------------------------------------------

// y −= M x
static void subtract_mass(const bough_eigen_problem *problem, const double *x, double *y) {
    for (int i = 0; i < problem->stiffness->n; i++) {
        bough_block_subtract(problem->mass + (size_t)i * BOUGH_BLOCK, x + (size_t)W8 * i,
                             y + (size_t)W8 * i);
    }
}

// Vectors are (q, λq), 16 n long: (q, v) → (−K⁻¹(C q + M v), q), its eigenvalues are 1/λ.
static void apply_inverse(void *self, const double *z, double *image) {
    const bough_eigen_problem *problem = self;
    size_t half = (size_t)W8 * (size_t)problem->stiffness->n;
    memset(image, 0, half * sizeof *image);
    bough_block_tridiagonal_subtract(problem->damping, z, image);
    subtract_mass(problem, z + half, image);
    bough_block_tridiagonal_solve(problem->stiffness, image);
    memcpy(image + half, z, half * sizeof *image);
}

bough_status bough_eigen_smallest(bough_arena *arena, const bough_eigen_problem *problem,
                                  int wanted, bough_eigen_pair *pair, int *found) {
    int half = W8 * problem->stiffness->n;
    bough_eigen_problem self = *problem;
    bough_eigen_operator op = {.name = problem->name,
                               .length = 2 * half,
                               .n_shape = half,
                               .weight = bough_arena_doubles(arena, 2 * (size_t)half),
                               .balance = true,
                               .self = &self,
                               .apply = apply_inverse};
    if (op.weight == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (!bough_block_tridiagonal_factor(problem->stiffness)) {
        return bough_fail(BOUGH_FAILED, "%s: the stiffness about the equilibrium is singular: it"
                          " stands at a buckling load; change the load", problem->name);
    }
    for (int i = 0; i < half; i++) {
        int c = i % W8;
        const double *mass = problem->mass + (size_t)(i / W8) * BOUGH_BLOCK;
        op.weight[i] = op.weight[half + i] = c < 6 ? fabs(mass[W8 * c + c]) : 0;
    }
    return bough_eigen_nearest(arena, &op, wanted, pair, found);
}

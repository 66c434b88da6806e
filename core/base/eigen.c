// Block Arnoldi iteration on the inverse, theory (28, 74).
#include "core/base/eigen.h"

#include "core/base/arnoldi.h"

enum {
    BLOCK_SIZE = BOUGH_EIGEN_AT_ONCE, // starting vectors: multiplicities up to this are found
    SPARE = 15,                       // vectors beyond those wanted before the first look
    LOOKS = 10,                       // after the first, each with a quarter as many vectors more
};

static const double accuracy = 1e-9;

// Eigenvalues of the inverse below this part of the largest are rounding: it maps their vectors to zero.
static const double rounding = 1e-10;

// What is sought, and the basis in which.
typedef struct search {
    const bough_eigen_operator *op;
    bough_arnoldi basis;
    int *order; // of the projected eigenvalues, by falling modulus
    unsigned seed;
} search;

static bough_status apply(void *self, int n, const double *z, double *image) {
    const bough_eigen_operator *op = ((const search *)self)->op;
    op->apply(op->self, n, z, image);
    return bough_ok();
}

// Displacements count like velocities at the frequency that a smoothed vector shows.
static void balance(bough_arnoldi *a, const double *smooth) {
    int half = a->length / 2;
    double speed = 0, displacement = 0;
    for (int i = 0; i < half; i++) {
        displacement += a->weight[i] * smooth[i] * smooth[i];
        speed += a->weight[i] * smooth[half + i] * smooth[half + i];
    }
    for (int i = 0; i < half; i++) a->weight[i] *= speed / displacement;
}

// Appends a random vector, smoothed by the operator, to the basis.
static void add_random(search *s) {
    bough_arnoldi *a = &s->basis;
    double *random = a->basis + (size_t)(a->capacity - 1) * (size_t)a->length;
    for (int i = 0; i < a->length; i++) {
        s->seed = s->seed * 1664525u + 1013904223u;
        random[i] = a->weight[i] > 0 ? (double)(s->seed >> 8) / 8388608.0 - 1 : 0;
    }
    for (int twice = 0; twice < 2; twice++) {
        apply(s, 1, random, a->image);
        memcpy(random, a->image, (size_t)a->length * sizeof *random);
    }
    if (a->count == 0 && s->op->balance) balance(a, random);
    bough_arnoldi_append(a, a->image);
}

// Extends the space to a dimension. With more equal eigenvalues than starting vectors it is invariant before:
// then it needs another one.
static void extend(search *s, int dimension) {
    bough_arnoldi *a = &s->basis;
    for (int before = -1; a->done < dimension && a->count > before;) {
        before = a->count;
        bough_arnoldi_extend(a, dimension);
        if (a->done == a->count) add_random(s);
    }
}

// -- the projected problem ------------------------------------------------------------------------

// Insertion: there are some hundred, and LAPACK's order is nearly sorted.
static void sort(search *s) {
    const bough_arnoldi *a = &s->basis;
    for (int k = 0; k < a->done; k++) {
        int at = k;
        double own = bough_arnoldi_modulus(a, k);
        for (; at > 0 && bough_arnoldi_modulus(a, s->order[at - 1]) < own; at--) {
            s->order[at] = s->order[at - 1];
        }
        s->order[at] = k;
    }
}

// λ of an eigenvalue μ of the inverse: 1/μ, or (1 − 1/μ)/γ.
static void eigenvalue(const search *s, int k, double *real, double *imaginary) {
    const bough_arnoldi *a = &s->basis;
    double x = a->value[k], y = a->value[a->done + k], square = x * x + y * y;
    double gamma = s->op->gamma;
    *real = gamma > 0 ? (1 - x / square) / gamma : x / square;
    *imaginary = y / square / (gamma > 0 ? gamma : 1); // of μ or of its partner
}

// Whether it belongs to what is listed: the first of a pair, or growing, or any real one.
static bool is_listed(const search *s, int k) {
    double real, imaginary;
    eigenvalue(s, k, &real, &imaginary);
    return imaginary > 0 || (imaginary == 0 && (real > 0 || s->op->decaying));
}

// The first of the listed ones that are accurate; *sum: of their moduli. The others change from look to look,
// because the operator is far from normal in this inner product.
static int select(const search *s, int wanted, int *chosen, double *sum) {
    const bough_arnoldi *a = &s->basis;
    int found = 0;
    *sum = 0;
    for (int i = 0; i < a->done && found < wanted; i++) {
        int k = s->order[i];
        double modulus = bough_arnoldi_modulus(a, k);
        if (modulus <= rounding * bough_arnoldi_modulus(a, s->order[0])) break;
        if (!is_listed(s, k) || bough_arnoldi_residual(a, k) > accuracy * modulus) continue;
        *sum += modulus;
        chosen[found++] = k;
    }
    return found;
}

// Looks until all that are wanted are accurate and the next look, in a quarter as many dimensions more,
// has found no other among them.
static bool iterate(search *s, int wanted, int *chosen, int *found) {
    bough_arnoldi *a = &s->basis;
    int first = 9 * wanted / 2 + SPARE;
    double before = -1, sum;
    for (int look = 0; look <= LOOKS; look++) {
        // a larger space each time, its Ritz values by falling modulus
        extend(s, first + first * look / 4);
        if (!bough_arnoldi_project(a)) return false;
        sort(s);
        *found = select(s, wanted, chosen, &sum);
        if (a->done == a->count) return true;
        if (*found == wanted && (s->op->checked || fabs(sum - before) <= 10 * accuracy * sum)) return true;
        before = *found == wanted ? sum : -1;
    }
    return false;
}

// theory (101): A y is (y − x)/γ, or x without γ.
double bough_eigen_residual(const bough_eigen_operator *op, double real, double imaginary, const double *x,
                            const double *y) {
    double sum = 0, size = 0;
    int n = op->length;
    for (int part = 0; part < 2; part++) {
        double other = part == 0 ? -imaginary : imaginary;
        for (int i = 0; i < n; i++) {
            double own = y[part * n + i], image = x[part * n + i];
            if (op->gamma > 0) image = (own - image) / op->gamma;
            double left = image - real * own - other * y[(1 - part) * n + i];
            sum += op->weight[i] * left * left;
            size += op->weight[i] * own * own;
        }
    }
    return sqrt(sum / size) / hypot(real, imaginary);
}

// The vectors of the chosen values, real before imaginary part (n × 2 × length).
static double *combine(bough_arena *arena, const bough_arnoldi *a, int n, const int *chosen) {
    size_t done = (size_t)a->done, columns = 2 * (size_t)n + 1;
    double *x = bough_arena_doubles(arena, columns * (size_t)a->length);
    double *y = bough_arena_doubles(arena, columns * done);
    for (size_t i = 0; i < (size_t)n; i++) {
        size_t k = (size_t)chosen[i], parts = a->value[done + k] != 0 ? 2 : 1;
        memcpy(y + 2 * i * done, a->vector + k * done, parts * done * sizeof *y);
    }
    bough_arnoldi_combine(a, 2 * n, y, x);
    return x;
}

// Of 1/μ it is μ's conjugate partner that has the positive imaginary part. x (2 × length): its vector; y
// (2 × length): work.
static void fill_pair(const search *s, int k, double *x, double *y, bough_eigen_pair *pair) {
    const bough_eigen_operator *op = s->op;
    size_t n = (size_t)op->length, bytes = (size_t)op->n_shape * sizeof(double);
    eigenvalue(s, k, &pair->real, &pair->imaginary);
    memset(y, 0, 2 * n * sizeof *y);
    bool oscillates = s->basis.value[s->basis.done + k] != 0;
    for (int part = 0; part <= oscillates; part++) {
        double *own = x + (size_t)part * n;
        for (size_t i = 0; i < n && part == 1 && op->gamma == 0; i++) own[i] *= -1;
        memcpy(part == 0 ? pair->shape_real : pair->shape_imag, own, bytes);
    }
    if (op->checked) return;
    op->apply(op->self, 1 + oscillates, x, y);
    pair->residual = bough_eigen_residual(op, pair->real, pair->imaginary, x, y);
}

// -- whole ----------------------------------------------------------------------------------------

static bough_status find_in(bough_arena *own, bough_arena *arena, const bough_eigen_operator *op, int wanted,
                            bough_eigen_pair *pair, int *found) {
    int first = 9 * wanted / 2 + SPARE, capacity = first + first * LOOKS / 4 + BLOCK_SIZE;
    search s = {.op = op, .basis = {.apply = apply, .self = &s}, .seed = 1};
    s.order = bough_arena_take(own, (size_t)(capacity + wanted) * sizeof *s.order);
    bough_arnoldi_create(own, op->length, capacity, BLOCK_SIZE, &s.basis);
    memcpy(s.basis.weight, op->weight, (size_t)op->length * sizeof(double));
    int *chosen = s.order + capacity;
    for (int k = 0; k < BLOCK_SIZE; k++) add_random(&s);
    if (!iterate(&s, wanted, chosen, found)) {
        return bough_fail(BOUGH_FAILED,
                          "%s: the %d lowest eigenvalues were not found to %g; ask"
                          " for fewer",
                          op->name, wanted, accuracy);
    }
    size_t length = 2 * (size_t)op->length;
    double *x = combine(own, &s.basis, *found, chosen), *y = bough_arena_doubles(own, length);
    for (int i = 0; i < *found; i++) {
        bough_arena_each(arena, (size_t)op->n_shape, &pair[i].shape_real, &pair[i].shape_imag);
        fill_pair(&s, chosen[i], x + (size_t)i * length, y, &pair[i]);
    }
    return bough_ok();
}

// Releases the basis after the search.
static bough_status find(bough_arena *arena, const bough_eigen_operator *op, int wanted,
                         bough_eigen_pair *pair, int *found) {
    bough_arena *own = bough_arena_child(arena);
    bough_status status = find_in(own, arena, op, wanted, pair, found);
    bough_arena_destroy(own);
    return status;
}

// The highest may be lost in rounding: then half as many are sought.
bough_status bough_eigen_nearest(bough_arena *arena, const bough_eigen_operator *op, bough_eigen_pair *pair,
                                 bough_eigen_count *count) {
    bough_status status;
    count->converged = 2 * count->wanted;
    do {
        count->converged /= 2;
        status = find(arena, op, count->converged, pair, &count->found);
    } while (status.code == BOUGH_FAILED && count->converged > 1);
    return status;
}

// -- second order ---------------------------------------------------------------------------------

// y −= M x
static void subtract_mass(const bough_eigen_problem *problem, const double *x, double *y) {
    for (int i = 0; i < problem->stiffness->n; i++) {
        bough_block_subtract(problem->mass + (size_t)i * BOUGH_BLOCK, x + (size_t)BOUGH_COLUMN * i,
                             y + (size_t)BOUGH_COLUMN * i);
    }
}

// Vectors are (q, λq), 16 n long: (q, v) → (−K⁻¹(C q + M v), q), its eigenvalues are 1/λ.
static void solve_one(const bough_eigen_problem *problem, const double *z, double *image) {
    size_t half = (size_t)BOUGH_COLUMN * (size_t)problem->stiffness->n;
    memset(image, 0, half * sizeof *image);
    bough_block_tridiagonal_subtract(problem->damping, z, image);
    subtract_mass(problem, z + half, image);
    bough_block_tridiagonal_solve(problem->stiffness, image);
    memcpy(image + half, z, half * sizeof *image);
}

static void apply_inverse(void *self, int n, const double *z, double *image) {
    const bough_eigen_problem *problem = self;
    size_t length = 2 * (size_t)BOUGH_COLUMN * (size_t)problem->stiffness->n;
    for (int k = 0; k < n; k++) solve_one(problem, z + (size_t)k * length, image + (size_t)k * length);
}

bough_status bough_eigen_smallest(bough_arena *arena, const bough_eigen_problem *problem, int wanted,
                                  bough_eigen_pair *pair, int *found) {
    int half = BOUGH_COLUMN * problem->stiffness->n;
    bough_eigen_problem self = *problem;
    bough_eigen_operator op = {.name = problem->name,
                               .length = 2 * half,
                               .n_shape = half,
                               .weight = bough_arena_doubles(arena, 2 * (size_t)half),
                               .balance = true,
                               .self = &self,
                               .apply = apply_inverse};
    if (!bough_block_tridiagonal_factor(problem->stiffness)) {
        return bough_fail(
            BOUGH_FAILED,
            "%s: the stiffness about the equilibrium is singular (a buckling load); change the load",
            problem->name);
    }
    for (int i = 0; i < half; i++) {
        int c = i % BOUGH_COLUMN;
        const double *mass = problem->mass + (size_t)(i / BOUGH_COLUMN) * BOUGH_BLOCK;
        op.weight[i] = op.weight[half + i] = c < 6 ? fabs(mass[BOUGH_COLUMN * c + c]) : 0;
    }
    return find(arena, &op, wanted, pair, found);
}

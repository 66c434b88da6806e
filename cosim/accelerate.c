// IQN-ILS (Degroote, Bathe, Vierendeels 2009), theory (65): with the differences V of the
// residuals and W of the images so far, newest first, c minimises |V c + r| and the next iterate is H(u) + W
// c. The QR factorisation of V is computed by Gram–Schmidt, twice, in each iteration; a column that hardly
// differs from the span of newer ones contains only noise and is dropped. Columns
// belong to one problem: those of one step of a nonlinear system do not help in the next.
//
// Newton's method does the same to u + (I − J)⁻¹ r, theory (66), so that the differences correct the
// Jacobian.
#include "cosim/accelerate.h"

enum {
    MOST_COLUMNS = 40,
    RECENT = 5, // norms kept for the contraction
};
static const double dependent = 1e-10; // part of a column outside the span of newer ones
static const double run_away = 1e10;   // residual against the smallest so far

struct bough_accelerator {
    bough_accelerator_def def;
    int evaluations;
    double norm[RECENT]; // newest first
    double smallest;
    double factor;                          // of Aitken, in use
    double *residual, *image;               // (n) of the evaluation taken
    double *residual_before, *image_before; // (n) of the one before
    int capacity, n_column;
    double *v[MOST_COLUMNS], *w[MOST_COLUMNS]; // (n each) differences, newest first
    double *q[MOST_COLUMNS];                   // (n each) orthonormal
    double r[MOST_COLUMNS][MOST_COLUMNS];      // upper triangle: r[column][row]
    double c[MOST_COLUMNS];
};

const char *const bough_acceleration_names[] = {[BOUGH_ACCELERATE_NONE] = "none",
                                                [BOUGH_ACCELERATE_RELAXATION] = "relaxation",
                                                [BOUGH_ACCELERATE_AITKEN] = "aitken",
                                                [BOUGH_ACCELERATE_IQN_ILS] = "iqn-ils",
                                                [BOUGH_ACCELERATE_NEWTON] = "interface-newton",
                                                NULL};

bough_accelerator *bough_accelerator_create(bough_arena *arena, const bough_accelerator_def *def) {
    assert(def->relaxation > 0 && def->relaxation <= 1);
    bough_accelerator *a = bough_arena_take(arena, sizeof *a);
    size_t n = (size_t)def->n;
    a->def = *def;
    bough_arena_each(arena, n, &a->residual, &a->image, &a->residual_before, &a->image_before);
    if (bough_acceleration_learns(def->kind)) {
        a->capacity = def->n < MOST_COLUMNS ? def->n : MOST_COLUMNS;
    }
    for (int k = 0; k < a->capacity; k++) {
        bough_arena_each(arena, n, &a->v[k], &a->w[k], &a->q[k]);
    }
    bough_accelerator_start(a);
    return a;
}

void bough_accelerator_start(bough_accelerator *a) {
    a->evaluations = 0;
    a->n_column = 0;
    a->smallest = INFINITY;
    a->factor = a->def.relaxation;
}

static void add(int n, double factor, const double *x, double *y) {
    for (int i = 0; i < n; i++) y[i] += factor * x[i];
}

static void swap(double **x, double **y) {
    double *kept = *x;
    *x = *y;
    *y = kept;
}

double bough_accelerator_take(bough_accelerator *a, const double *u, const double *image) {
    int n = a->def.n;
    // the last evaluation becomes the one before
    swap(&a->residual, &a->residual_before);
    swap(&a->image, &a->image_before);
    memcpy(a->image, image, (size_t)n * sizeof(double));
    for (int i = 0; i < n; i++) a->residual[i] = image[i] - u[i];
    for (int k = RECENT - 1; k > 0; k--) a->norm[k] = a->norm[k - 1];
    a->norm[0] = sqrt(bough_scalar_product(n, a->residual, a->residual));
    a->smallest = fmin(a->smallest, a->norm[0]);
    a->evaluations++;
    // Newton's correction is the residual of the iteration that is accelerated
    if (a->def.kind == BOUGH_ACCELERATE_NEWTON) {
        a->def.solve(a->def.self, a->residual);
        for (int i = 0; i < n; i++) a->image[i] = u[i] + a->residual[i];
    }
    return a->norm[0];
}

bool bough_accelerator_diverges(const bough_accelerator *a) {
    return !isfinite(a->norm[0]) || a->norm[0] > run_away * a->smallest;
}

double bough_accelerator_contraction(const bough_accelerator *a) {
    int back = a->evaluations < RECENT ? a->evaluations - 1 : RECENT - 1;
    if (back < 1 || a->norm[back] == 0) return 1;
    return pow(a->norm[0] / a->norm[back], 1.0 / back);
}

// -- Aitken ---------------------------------------------------------------------------------------

// theory (64), the secant method along the last change.
static void update_factor(bough_accelerator *a) {
    double along = 0, length = 0;
    if (a->evaluations < 2) return;
    for (int i = 0; i < a->def.n; i++) {
        double change = a->residual[i] - a->residual_before[i];
        along += a->residual_before[i] * change;
        length += change * change;
    }
    if (length > 0) a->factor *= -along / length;
}

// -- IQN-ILS --------------------------------------------------------------------------------------

// Removes column k from the list; its memory goes to the end.
static void drop(bough_accelerator *a, int k) {
    for (a->n_column--; k < a->n_column; k++) {
        swap(&a->v[k], &a->v[k + 1]);
        swap(&a->w[k], &a->w[k + 1]);
    }
}

// The newest differences in front, in place of the oldest where there is no room.
static void insert_column(bough_accelerator *a) {
    if (a->n_column < a->capacity) a->n_column++;
    for (int k = a->n_column - 1; k > 0; k--) {
        swap(&a->v[k], &a->v[k - 1]);
        swap(&a->w[k], &a->w[k - 1]);
    }
    for (int i = 0; i < a->def.n; i++) {
        a->v[0][i] = a->residual[i] - a->residual_before[i];
        a->w[0][i] = a->image[i] - a->image_before[i];
    }
}

// Column k of V made orthonormal to those before it; false when it depends on them.
static bool orthonormalise(bough_accelerator *a, int k) {
    int n = a->def.n;
    double *q = a->q[k], *r = a->r[k], before = sqrt(bough_scalar_product(n, a->v[k], a->v[k]));
    memcpy(q, a->v[k], (size_t)n * sizeof(double));
    memset(r, 0, sizeof a->r[k]);
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < k; j++) {
            double part = bough_scalar_product(n, a->q[j], q);
            r[j] += part;
            add(n, -part, a->q[j], q);
        }
    }
    r[k] = sqrt(bough_scalar_product(n, q, q));
    if (!(r[k] > dependent * before)) return false;
    for (int i = 0; i < n; i++) q[i] /= r[k];
    return true;
}

// u ← H(u) + W c, R c = −Qᵀ r
static void solve_least_squares(bough_accelerator *a, double *u) {
    int n = a->def.n;
    for (int k = 0; k < a->n_column;) {
        if (orthonormalise(a, k)) {
            k++;
        } else {
            drop(a, k);
        }
    }
    memcpy(u, a->image, (size_t)n * sizeof(double));
    for (int k = a->n_column - 1; k >= 0; k--) {
        double right = -bough_scalar_product(n, a->q[k], a->residual);
        for (int j = k + 1; j < a->n_column; j++) right -= a->r[j][k] * a->c[j];
        a->c[k] = right / a->r[k][k];
        add(n, a->c[k], a->w[k], u);
    }
}

void bough_accelerator_next(bough_accelerator *a, double *u) {
    double factor = a->def.relaxation;
    bool whole = a->def.kind == BOUGH_ACCELERATE_NONE || a->def.kind == BOUGH_ACCELERATE_NEWTON;
    if (whole) factor = 1;
    if (a->def.kind == BOUGH_ACCELERATE_AITKEN) {
        update_factor(a);
        factor = a->factor;
    }
    // quasi-Newton from the second iteration on
    if (a->capacity > 0 && a->evaluations > 1) {
        insert_column(a);
        solve_least_squares(a, u);
        return;
    }
    add(a->def.n, factor, a->residual, u);
}

#include "core/base/arnoldi.h"

#include "core/base/linalg.h"

static const double dependent = 1e-13; // norm outside the basis, relative to the whole: below it, dependent
static const double cancelled = 0.1;   // the same of one vector outside those beside it: another pass

// All memory is taken here.
void bough_arnoldi_create(bough_arena *arena, int length, int capacity, int at_once, bough_arnoldi *a) {
    size_t n = (size_t)length, m = (size_t)capacity;
    a->length = length;
    a->capacity = capacity;
    a->basis = bough_arena_doubles(arena, m * n);
    bough_arena_each(arena, m * m, &a->h, &a->vector, &a->matrix);
    a->weight = bough_arena_doubles(arena, n);
    a->at_once = at_once;
    a->image = bough_arena_doubles(arena, n * (size_t)at_once);
    a->weighted = bough_arena_doubles(arena, n * (size_t)at_once);
    a->along = bough_arena_doubles(arena, m * (size_t)at_once);
    a->value = bough_arena_doubles(arena, 2 * m);
    a->work = bough_arena_doubles(arena, BOUGH_EIGEN_WORK(m));
    for (int i = 0; i < length; i++) a->weight[i] = 1;
}

static double *vector_at(const bough_arnoldi *a, int k) { return a->basis + (size_t)k * (size_t)a->length; }

double bough_arnoldi_product(const bough_arnoldi *a, const double *x, const double *y) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < a->length; i++) sum += a->weight[i] * x[i] * y[i];
    return sum;
}

// Takes the basis from its vector `first` on out of n vectors x: h = Vᵀ W x, x −= V h; h is added to the
// column of each unless that is NULL.
static void project_out(bough_arnoldi *a, int first, int n, double *x, double *const *column) {
    int count = a->count - first, length = a->length;
    const double *basis = vector_at(a, first);
    for (int k = 0; k < n; k++) {
        for (int i = 0; i < length; i++) a->weighted[k * length + i] = a->weight[i] * x[k * length + i];
    }
    bough_dense_product((bough_product){count, n, length, true, .factor = 1}, basis, a->weighted, a->along);
    bough_dense_product((bough_product){length, n, count, false, .factor = -1, .keep = 1}, basis, a->along,
                        x);
    for (int k = 0; k < n && column[0] != NULL; k++) {
        for (int i = 0; i < count; i++) column[k][first + i] += a->along[k * count + i];
    }
}

static double length_of(const bough_arnoldi *a, const double *x) {
    return sqrt(bough_arnoldi_product(a, x, x));
}

// Appends x, orthogonal to the basis, at length 1. A dependent one is dropped: the space is invariant in it.
static void append(bough_arnoldi *a, double before, const double *x, double *column) {
    double norm = length_of(a, x);
    bool full = a->count == a->capacity || a->count == a->length;
    if (!(norm > dependent * before) || full) return;
    // normalised, a new vector of the basis
    if (column != NULL) column[a->count] = norm;
    double *v = vector_at(a, a->count++);
    for (int i = 0; i < a->length; i++) v[i] = x[i] / norm;
}

// Gram–Schmidt, twice: the second pass restores what cancellation loses.
void bough_arnoldi_append(bough_arnoldi *a, double *x) {
    double before = length_of(a, x), *none = NULL;
    for (int pass = 0; pass < 2; pass++) project_out(a, 0, 1, x, &none);
    append(a, before, x, NULL);
}

// The same for n vectors: what was in the basis before is taken out of all at once. One that is nearly a
// combination of the others loses digits that only another pass restores.
static void append_some(bough_arnoldi *a, int n, double *x, double *const *column) {
    int first = a->count;
    double before[BOUGH_ARNOLDI_AT_ONCE];
    for (int k = 0; k < n; k++) before[k] = length_of(a, x + (size_t)k * (size_t)a->length);
    for (int pass = 0; pass < 2; pass++) project_out(a, 0, n, x, column);
    for (int k = 0; k < n; k++) {
        double *own = x + (size_t)k * (size_t)a->length, size = length_of(a, own);
        for (int pass = 0; pass < 2 && a->count > first; pass++) project_out(a, first, 1, own, &column[k]);
        if (length_of(a, own) < cancelled * size) project_out(a, 0, 1, own, &column[k]);
        append(a, before[k], own, column[k]);
    }
}

// A V = V H, a column of H for each vector of the basis.
bough_status bough_arnoldi_extend(bough_arnoldi *a, int target) {
    while (a->done < a->count && a->done < target) {
        int left = (a->count < target ? a->count : target) - a->done,
            n = left < a->at_once ? left : a->at_once;
        BOUGH_TRY(a->apply(a->self, n, vector_at(a, a->done), a->image));
        double *column[BOUGH_ARNOLDI_AT_ONCE];
        for (int k = 0; k < n; k++) column[k] = a->h + (size_t)a->done++ * (size_t)a->capacity;
        append_some(a, n, a->image, column);
    }
    return bough_ok();
}

// Ritz values and vectors: the eigenvalues of the square part of H.
bool bough_arnoldi_project(bough_arnoldi *a) {
    size_t m = (size_t)a->done;
    for (size_t j = 0; j < m; j++) {
        memcpy(a->matrix + j * m, a->h + j * (size_t)a->capacity, m * sizeof *a->matrix);
    }
    return bough_dense_eigen(a->done, a->matrix, a->value, a->vector, a->work);
}

double bough_arnoldi_modulus(const bough_arnoldi *a, int k) {
    return hypot(a->value[k], a->value[a->done + k]);
}

// ‖A V y − μ V y‖ is the norm of the rows of H y below the square part.
double bough_arnoldi_residual(const bough_arnoldi *a, int k) {
    int m = a->done, parts = a->value[m + k] == 0 ? 1 : 2;
    const double *y = a->vector + (size_t)k * (size_t)m;
    double sum = 0;
    for (int row = m; row < a->count; row++) {
        for (int part = 0; part < parts; part++) {
            double entry = 0;
            for (int j = 0; j < m; j++) {
                entry += a->h[(size_t)j * (size_t)a->capacity + (size_t)row] * y[part * m + j];
            }
            sum += entry * entry;
        }
    }
    return sqrt(sum);
}

void bough_arnoldi_combine(const bough_arnoldi *a, int n, const double *y, double *x) {
    bough_dense_product((bough_product){a->length, n, a->done, false, .factor = 1}, a->basis, y, x);
}

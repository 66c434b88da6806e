#include "core/base/arnoldi.h"

#include "core/base/linalg.h"

#include <math.h>
#include <string.h>

static const double dependent = 1e-13; // norm outside the basis, relative to the whole: below it, dependent

void bough_arnoldi_create(bough_arena *arena, int length, int capacity, int at_once, bough_arnoldi *a) {
    size_t n = (size_t)length, m = (size_t)capacity;
    a->length = length;
    a->capacity = capacity;
    a->basis = bough_arena_doubles(arena, m * n);
    bough_arena_each(arena, m * m, &a->h, &a->vector, &a->matrix);
    a->weight = bough_arena_doubles(arena, n);
    a->at_once = at_once;
    a->image = bough_arena_doubles(arena, n * (size_t)at_once);
    a->weighted = bough_arena_doubles(arena, n);
    a->along = bough_arena_doubles(arena, m);
    a->value = bough_arena_doubles(arena, 2 * m);
    a->work = bough_arena_doubles(arena, 8 * m);
    for (int i = 0; i < length; i++) a->weight[i] = 1;
}

static double *vector_at(const bough_arnoldi *a, int k) { return a->basis + (size_t)k * (size_t)a->length; }

// The weighted inner product xᵀ W y.
double bough_arnoldi_product(const bough_arnoldi *a, const double *x, const double *y) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < a->length; i++) sum += a->weight[i] * x[i] * y[i];
    return sum;
}

// Gram–Schmidt, twice: the second pass restores what cancellation loses.
void bough_arnoldi_append(bough_arnoldi *a, double *x, double *column) {
    double before = sqrt(bough_arnoldi_product(a, x, x));
    for (int pass = 0; pass < 2; pass++) {
        // coefficients h = Vᵀ W x, then x −= V h
        for (int i = 0; i < a->length; i++) a->weighted[i] = a->weight[i] * x[i];
        bough_dense_product((bough_product){a->count, 1, a->length, true, 1, 0}, a->basis, a->weighted,
                            a->along);
        bough_dense_product((bough_product){a->length, 1, a->count, false, -1, 1}, a->basis, a->along, x);
        for (int k = 0; k < a->count && column != NULL; k++) column[k] += a->along[k];
    }
    // a dependent vector is dropped: the space is invariant in it
    double norm = sqrt(bough_arnoldi_product(a, x, x));
    bool full = a->count == a->capacity || a->count == a->length;
    if (!(norm > dependent * before) || full) return;
    // normalised, a new vector of the basis
    if (column != NULL) column[a->count] = norm;
    double *v = vector_at(a, a->count++);
    for (int i = 0; i < a->length; i++) v[i] = x[i] / norm;
}

// A V = V H, a column of H for each vector of the basis.
bough_status bough_arnoldi_extend(bough_arnoldi *a, int target) {
    while (a->done < a->count && a->done < target) {
        int left = (a->count < target ? a->count : target) - a->done,
            n = left < a->at_once ? left : a->at_once;
        BOUGH_TRY(a->apply(a->self, n, vector_at(a, a->done), a->image));
        for (int k = 0; k < n; k++) {
            double *column = a->h + (size_t)a->done++ * (size_t)a->capacity;
            bough_arnoldi_append(a, a->image + (size_t)k * (size_t)a->length, column);
        }
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

void bough_arnoldi_combine(const bough_arnoldi *a, int column, int n, double *x) {
    const double *y = a->vector + (size_t)column * (size_t)a->done;
    for (int k = 0; k < a->done; k++) {
        const double *v = vector_at(a, k);
        for (int i = 0; i < n; i++) x[i] += y[k] * v[i];
    }
}

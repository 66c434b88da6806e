// LU by LAPACK, and Cholesky by hand for joints of at most six speeds, where a library call would
// cost more than the work.
#include "core/linalg.h"

#include <math.h>
#include <stddef.h>
#include <threads.h>

extern void dgetrf_(const int *m, const int *n, double *a, const int *lda, int *pivot, int *info);
extern void dgetrs_(const char *trans, const int *n, const int *nrhs, const double *a,
                    const int *lda, const int *pivot, double *b, const int *ldb, int *info,
                    size_t trans_length);
// Only OpenBLAS has it; other libraries leave the symbol null.
extern void openblas_set_num_threads(int n) __attribute__((weak));

static void one_thread(void) {
    if (openblas_set_num_threads) openblas_set_num_threads(1);
}

bool bough_dense_factor(int n, double *a, int *pivot) {
    if (n == 0) return true;
    // the library's thread count is the process's, and so is this
    static once_flag prepared = ONCE_FLAG_INIT;
    call_once(&prepared, one_thread);
    double sum = 0; // a NaN may pass the pivot search
    for (size_t i = 0; i < (size_t)n * (size_t)n; i++)
        sum += fabs(a[i]);
    if (!isfinite(sum)) return false;
    int info = 0;
    dgetrf_(&n, &n, a, &n, pivot, &info);
    return info == 0;
}

void bough_dense_solve(int n, int n_right, const double *factor, const int *pivot, double *b) {
    if (n == 0 || n_right == 0) return;
    int info = 0;
    dgetrs_("N", &n, &n_right, factor, &n, pivot, b, &n, &info, 1);
}

bool bough_cholesky_factor(int n, double *a) {
    for (int j = 0; j < n; j++) {
        double diagonal = a[n * j + j], pivot = diagonal;
        for (int k = 0; k < j; k++)
            pivot -= a[n * j + k] * a[n * j + k];
        if (!(pivot > 1e-12 * diagonal) || !isfinite(pivot)) return false;
        a[n * j + j] = sqrt(pivot);
        for (int i = j + 1; i < n; i++) {
            double s = a[n * i + j];
            for (int k = 0; k < j; k++)
                s -= a[n * i + k] * a[n * j + k];
            a[n * i + j] = s / a[n * j + j];
        }
    }
    return true;
}

void bough_cholesky_solve(int n, const double *factor, double *b) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            b[i] -= factor[n * i + k] * b[k];
        b[i] /= factor[n * i + i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            b[i] -= factor[n * k + i] * b[k];
        b[i] /= factor[n * i + i];
    }
}

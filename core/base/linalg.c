// LU by LAPACK; by hand, as Cholesky, for few unknowns, where a library call would cost more than the work.
#define _DEFAULT_SOURCE // MAP_ANONYMOUS
#include "core/base/linalg.h"

#include <stdatomic.h>
#include <sys/mman.h>
#include <threads.h>

extern void dgetrf_(const int *m, const int *n, double *a, const int *lda, int *pivot, int *info);
extern void dgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
                    const int *pivot, double *b, const int *ldb, int *info, size_t trans_length);
extern void dgbsv_(const int *n, const int *below, const int *above, const int *nrhs, double *a,
                   const int *lda, int *pivot, double *b, const int *ldb, int *info);
extern void dgemm_(const char *transa, const char *transb, const int *m, const int *n, const int *k,
                   const double *alpha, const double *a, const int *lda, const double *b, const int *ldb,
                   const double *beta, double *c, const int *ldc, size_t transa_length, size_t transb_length);
extern void zgetrf_(const int *m, const int *n, double *a, const int *lda, int *pivot, int *info);
extern void zgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
                    const int *pivot, double *b, const int *ldb, int *info, size_t trans_length);
extern void dgeev_(const char *left, const char *right, const int *n, double *a, const int *lda, double *real,
                   double *imaginary, double *vl, const int *ldvl, double *vr, const int *ldvr, double *work,
                   const int *lwork, int *info, size_t left_length, size_t right_length);
extern void dsyev_(const char *vectors, const char *triangle, const int *n, double *a, const int *lda,
                   double *value, double *work, const int *lwork, int *info, size_t vectors_length,
                   size_t triangle_length);
extern void dsyevr_(const char *job, const char *range, const char *uplo, const int *n, double *a,
                    const int *lda, const double *low, const double *high, const int *first, const int *last,
                    const double *tolerance, int *found, double *value, double *vector, const int *ldz,
                    int *support, double *work, const int *lwork, int *iwork, const int *liwork, int *info,
                    size_t job_length, size_t range_length, size_t uplo_length);
extern void spotrf_(const char *triangle, const int *n, float *a, const int *lda, int *info,
                    size_t triangle_length);
// Only OpenBLAS has these; other libraries leave the symbols null.
extern void openblas_set_num_threads(int n) __attribute__((weak));
extern void *blas_memory_alloc(int unused) __attribute__((weak));
extern void blas_memory_free(void *block) __attribute__((weak));
extern char *gotoblas_corename(void) __attribute__((weak));
extern void gotoblas_dynamic_quit(void) __attribute__((weak));
extern void gotoblas_dynamic_init(void) __attribute__((weak));

static void one_thread(void) {
    if (openblas_set_num_threads) openblas_set_num_threads(1);
}

static void prepare(void) {
    // the library's thread count is the process's, and so is this
    static once_flag prepared = ONCE_FLAG_INIT;
    call_once(&prepared, one_thread);
}

void bough_linalg_choose_kernels(void) {
    const char *fitting = bough_level_runs(BOUGH_LEVEL_V4)   ? "SkylakeX"
                          : bough_level_runs(BOUGH_LEVEL_V3) ? "Haswell"
                                                             : NULL;
    // only a library that chooses its kernels as it starts, and takes those for Prescott
    bool chooses = gotoblas_corename && gotoblas_dynamic_quit && gotoblas_dynamic_init;
    if (!fitting || !chooses || strcmp(gotoblas_corename(), "Prescott") != 0) return;
    gotoblas_dynamic_quit();
    setenv("OPENBLAS_CORETYPE", fitting, 0);
    gotoblas_dynamic_init();
}

// A NaN may pass LAPACK's pivot search.
static bool finite_matrix(int n, const double *a) { return bough_all_finite((size_t)n * (size_t)n, a); }

// Up to this size the loops below are faster than a library call.
enum { SMALL = 32 };

static void swap(double *x, double *y) {
    double kept = *x;
    *x = *y;
    *y = kept;
}

// LU with row interchanges, right-looking.
static bool factor_small(int n, double *a, int *pivot) {
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            // pivot: the largest entry of the column
            if (fabs(a[k * n + i]) > fabs(a[k * n + best])) best = i;
        }
        pivot[k] = best;
        if (a[k * n + best] == 0) return false;
        // interchange rows, then subtract multiples of row k
        for (int j = 0; j < n && best != k; j++) swap(&a[j * n + k], &a[j * n + best]);
        for (int i = k + 1; i < n; i++) {
            double factor = a[k * n + i] /= a[k * n + k];
            for (int j = k + 1; j < n; j++) a[j * n + i] -= factor * a[j * n + k];
        }
    }
    return true;
}

// Interchanges, L x = b forwards, U x = b backwards.
static void solve_small(int n, const double *restrict factor, const int *pivot, double *restrict x) {
    for (int k = 0; k < n; k++) {
        if (pivot[k] != k) swap(&x[k], &x[pivot[k]]);
    }
    for (int k = 0; k < n; k++) {
        double known = x[k];
        for (int i = k + 1; i < n; i++) x[i] -= factor[k * n + i] * known;
    }
    for (int k = n - 1; k >= 0; k--) {
        double known = x[k] /= factor[k * n + k];
        for (int i = 0; i < k; i++) x[i] -= factor[k * n + i] * known;
    }
}

// -- work arrays of the library -------------------------------------------------------------------

enum { MOST_ROOMS = 64 }; // one for each concurrent call

// Whether so many work arrays of the library would find addresses: it does not say when one does not. Pages
// of the system, as the library takes them: a sanitizer would mark each block of malloc, byte by byte.
static bool has_addresses(int rooms) {
    const size_t size = (size_t)129 << 20;
    void *block[MOST_ROOMS];
    int n = 0;
    while (n < rooms) {
        block[n] = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (block[n] == MAP_FAILED) break;
        n++;
    }
    for (int i = 0; i < n; i++) munmap(block[i], size);
    return n == rooms;
}

// The library keeps work arrays once they are taken, and takes one more only when all are in use.
static void take_rooms(int rooms) {
    void *block[MOST_ROOMS];
    double a = 1;
    int n = 1, pivot, info = 0;
    prepare();
    dgetrf_(&n, &n, &a, &n, &pivot, &info);
    if (!blas_memory_alloc || !blas_memory_free) return;
    for (int i = 0; i < rooms; i++) block[i] = blas_memory_alloc(0);
    for (int i = 0; i < rooms; i++) blas_memory_free(block[i]);
}

// The work arrays belong to the process, and so do these counts.
static atomic_int users, rooms_taken; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

static void leave(void *threads) { atomic_fetch_sub(&users, *(int *)threads); }

void bough_linalg_room(bough_arena *arena, int threads) {
    int *own = bough_arena_take(arena, sizeof *own);
    *own = threads;
    // threads of all arenas that live
    int rooms = atomic_fetch_add(&users, threads) + threads;
    bough_arena_on_destroy(arena, leave, own);
    if (rooms > MOST_ROOMS) rooms = MOST_ROOMS;
    int taken = atomic_load(&rooms_taken);
    if (rooms <= taken) return;
    if (!has_addresses(rooms - taken)) bough_arena_leave(arena);
    take_rooms(rooms);
    atomic_store(&rooms_taken, rooms);
}

// -- LU -------------------------------------------------------------------------------------------

bool bough_dense_factor(int n, double *a, int *pivot) {
    if (n == 0) return true;
    if (!finite_matrix(n, a)) return false;
    if (n <= SMALL) return factor_small(n, a, pivot);
    // by the library, on one thread
    prepare();
    int info = 0;
    dgetrf_(&n, &n, a, &n, pivot, &info);
    return info == 0;
}

// Banded LU with row interchanges, which need `width` more diagonals above.
bool bough_band_solve(int n, int width, double *a, int *pivot, double *b) {
    const int rows = 3 * width + 1, one = 1;
    int info;
    prepare();
    if (!bough_all_finite((size_t)rows * (size_t)n, a)) return false;
    dgbsv_(&n, &width, &width, &one, a, &rows, pivot, b, &n, &info);
    return info == 0;
}

void bough_dense_solve(int n, int n_right, const double *factor, const int *pivot, double *b) {
    if (n == 0 || n_right == 0) return;
    if (n <= SMALL) {
        for (int j = 0; j < n_right; j++) solve_small(n, factor, pivot, b + j * n);
        return;
    }
    int info = 0;
    dgetrs_("N", &n, &n_right, factor, &n, pivot, b, &n, &info, 1);
}

bool bough_dense_divide(bough_arena *arena, int n, int n_right, const double *a, double *b) {
    size_t size = (size_t)n;
    double *factor = bough_arena_copy(arena, a, size * size * sizeof *a);
    int *pivot = bough_arena_take(arena, size * sizeof *pivot);
    if (!bough_dense_factor(n, factor, pivot)) return false;
    bough_dense_solve(n, n_right, factor, pivot, b);
    return true;
}

enum { FEW = 8 }; // columns of a product

void bough_dense_product(bough_product p, const double *a, const double *b, double *c) {
    if (p.m == 0 || p.n == 0) return;
    int inner = p.k > 0 ? p.k : 1; // leading dimensions are at least 1
    if (p.rows_a == 0) p.rows_a = p.transposed ? inner : p.m;
    if (p.rows_b == 0) p.rows_b = inner;
    if (p.rows_c == 0) p.rows_c = p.m;
    if (p.n <= FEW && p.k > 0) {
        BOUGH_OF_LEVEL(bough_multiply_few, bough_level_chosen())(&p, a, b, c);
        return;
    }
    prepare();
    dgemm_(p.transposed ? "T" : "N", "N", &p.m, &p.n, &p.k, &p.factor, a, &p.rows_a, b, &p.rows_b, &p.keep, c,
           &p.rows_c, 1, 1);
}

bool bough_complex_factor(int n, double *a, int *pivot) {
    if (n == 0) return true;
    prepare();
    if (!bough_all_finite(2 * (size_t)n * (size_t)n, a)) return false;
    int info = 0;
    zgetrf_(&n, &n, a, &n, pivot, &info);
    return info == 0;
}

void bough_complex_solve(int n, const double *factor, const int *pivot, double *b) {
    if (n == 0) return;
    int info = 0, one = 1;
    zgetrs_("N", &n, &one, factor, &n, pivot, b, &n, &info, 1);
}

bool bough_dense_eigen(int n, double *a, double *value, double *vector, double *work) {
    if (n == 0) return true;
    prepare();
    if (!finite_matrix(n, a)) return false;
    // right eigenvectors only
    int info = 0, one = 1, n_work = BOUGH_EIGEN_WORK(n);
    dgeev_("N", "V", &n, a, &n, value, value + n, NULL, &one, vector, &n, work, &n_work, &info, 1, 1);
    return info == 0;
}

bool bough_symmetric_eigen(int n, double *a, double *value, double *work) {
    if (n == 0) return true;
    prepare();
    if (!finite_matrix(n, a)) return false;
    // LAPACK's upper triangle is the lower one by rows
    int info = 0, n_work = 8 * n;
    dsyev_("V", "U", &n, a, &n, value, work, &n_work, &info, 1, 1);
    return info == 0;
}

bool bough_symmetric_smallest(int n, double *a, int count, double *value, double *vector, double *work,
                              int *index) {
    if (n == 0 || count == 0) return true;
    prepare();
    if (!finite_matrix(n, a)) return false;
    // relatively robust representations (dsyevr), eigenvalues 1 … count
    int info = 0, one = 1, found = 0, n_work = 26 * n, n_index = 10 * n;
    double none = 0;
    dsyevr_("V", "I", "L", &n, a, &n, &none, &none, &one, &count, &none, &found, value, vector, &n, index,
            work, &n_work, index + 2 * n, &n_index, &info, 1, 1, 1);
    return info == 0 && found == count;
}

// Row by row; a pivot that cancels to rounding is not positive.
bool bough_cholesky_factor(int n, double *a) {
    for (int j = 0; j < n; j++) {
        double diagonal = a[n * j + j], pivot = diagonal;
        for (int k = 0; k < j; k++) pivot -= a[n * j + k] * a[n * j + k];
        if (!(pivot > 1e-12 * diagonal) || !isfinite(pivot)) return false;
        a[n * j + j] = sqrt(pivot);
        for (int i = j + 1; i < n; i++) {
            double s = a[n * i + j];
            for (int k = 0; k < j; k++) s -= a[n * i + k] * a[n * j + k];
            a[n * i + j] = s / a[n * j + j];
        }
    }
    return true;
}

bool bough_cholesky_lower(int n, float *a) {
    if (n == 0) return true;
    prepare();
    int info = 0;
    spotrf_("L", &n, a, &n, &info, 1);
    // a NaN anywhere enters all later rows
    return info == 0 && isfinite(a[(size_t)n * (size_t)n - 1]);
}

// L y = b forwards, Lᵀ x = y backwards.
void bough_cholesky_solve(int n, const double *factor, double *b) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) b[i] -= factor[n * i + k] * b[k];
        b[i] /= factor[n * i + i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) b[i] -= factor[n * k + i] * b[k];
        b[i] /= factor[n * i + i];
    }
}

// -- symmetric 6x6 --------------------------------------------------------------------------------

// Symmetric 6×6 matrices: inverse and rotation.

void bough_symmetric6_unpack(const double a[21], double full[6][6]) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) full[i][j] = a[bough_symmetric6_index(i, j)];
    }
}

bool bough_symmetric6_inverse(const double a[21], double inverse[21]) {
    double l[6][6];
    bough_symmetric6_unpack(a, l);
    if (!bough_cholesky_factor(6, l[0])) return false;
    // column by column
    for (int j = 0; j < 6; j++) {
        double x[6] = {0};
        x[j] = 1;
        bough_cholesky_solve(6, l[0], x);
        for (int i = 0; i <= j; i++) inverse[bough_symmetric6_index(i, j)] = x[i];
    }
    return true;
}

// Rotates rows (or columns) k and k + 1 of a full matrix, k = 0 and 3.
static void rotate_pairs(double full[6][6], double c, double s, bool rows) {
    for (int k = 0; k < 6; k += 3) {
        for (int j = 0; j < 6; j++) {
            double *x = rows ? &full[k][j] : &full[j][k];
            double *y = rows ? &full[k + 1][j] : &full[j][k + 1];
            double first = c * *x - s * *y;
            *y = s * *x + c * *y;
            *x = first;
        }
    }
}

void bough_symmetric6_rotate(const double a[21], double angle, double rotated[21]) {
    double full[6][6], c = cos(angle), s = sin(angle);
    bough_symmetric6_unpack(a, full);
    // Q A Qᵀ: rows, then columns
    rotate_pairs(full, c, s, true);
    rotate_pairs(full, c, s, false);
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) rotated[bough_symmetric6_index(i, j)] = full[i][j];
    }
}

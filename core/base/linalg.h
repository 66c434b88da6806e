// Dense linear algebra for small systems; the only user of LAPACK, kept to one thread because the
// callers run in parallel themselves.
#pragma once

#include "core/base/arena.h"
#include "core/base/level.h"

// For a program, before its first thread: OpenBLAS takes its slowest kernels, those for Prescott, on a
// processor that is newer than itself. Names it the ones for this processor's level, unless OPENBLAS_CORETYPE
// does.
void bough_linalg_choose_kernels(void);

// Lets the library take its work arrays for so many threads, in addition to those of all other arenas, when a
// model is built; steps then take none. OpenBLAS needs 128 MB of address space for each thread and, without
// it, tries for ever.
void bough_linalg_room(bough_arena *arena, int threads);

// LU factors of a (n × n, column-major) in place, with row interchanges in pivot (n). False when a
// is singular or not finite.
bool bough_dense_factor(int n, double *a, int *pivot);

// Solves A x = b with pivoting, in place in b, for a matrix with `width` entries on either side of the
// diagonal. a is destroyed: (3 width + 1) × n by columns, entry (i, j) at [(3 width + 1) j + 2 width + i −
// j], the first `width` of a column free; pivot (n). False when A is singular or not finite.
bool bough_band_solve(int n, int width, double *a, int *pivot, double *b);

// Solves a x = b in place with those factors: b (n × n_right, column-major).
void bough_dense_solve(int n, int n_right, const double *factor, const int *pivot, double *b);

// b ← a⁻¹ b, likewise; a stays as it is. False when a is singular or not finite.
bool bough_dense_divide(bough_arena *arena, int n, int n_right, const double *a, double *b);

// c ← factor a b + keep c, all column-major: a (m × k), or its transpose where a is given (k × m), b (k × n),
// c (m × n).
typedef struct bough_product {
    int m, n, k;
    bool transposed; // a
    double factor, keep;
    // rows of larger matrices that a, b and c are part of, in memory from column to column; 0: they are not
    int rows_a, rows_b, rows_c;
} bough_product;
void bough_dense_product(bough_product p, const double *a, const double *b, double *c);

// The same for few columns of b; rows_a, rows_b and rows_c are given.
void bough_multiply_few(const bough_product *p, const double *a, const double *b, double *c);

BOUGH_DECLARE_LEVELS(bough_multiply_few);

// bough_dense_factor and bough_dense_solve for complex matrices and one right side, real and imaginary parts
// next to each other: a (n × n × 2, column-major), b (n × 2).
bool bough_complex_factor(int n, double *a, int *pivot);
void bough_complex_solve(int n, const double *factor, const int *pivot, double *b);

// Eigenvalues of a (n × n, column-major; overwritten): value (2 × n), real parts before imaginary
// ones, conjugate pairs in sequence. vector (n × n, column-major): the right eigenvectors of length
// 1, of a pair its real and imaginary part in two columns. work (BOUGH_EIGEN_WORK(n)): of many rows LAPACK
// works on several columns at once. False when a is not finite or the iteration does not converge.
#define BOUGH_EIGEN_WORK(n) ((n) > 100 ? 34 * (n) + 4160 : 8 * (n))
bool bough_dense_eigen(int n, double *a, double *value, double *vector, double *work);

// Eigenvalues of a symmetric matrix (n × n; its lower triangle), rising, into value (n), and its
// orthonormal eigenvectors in place, the k-th in a[n k] and on. work (8 n). False when a is not
// finite or the iteration does not converge.
bool bough_symmetric_eigen(int n, double *a, double *value, double *work);

// The `count` smallest eigenvalues of a symmetric matrix (n × n, its lower triangle by columns;
// overwritten), ascending, in value (n, the rest is scratch), and their orthonormal eigenvectors in
// vector (n × count, column-major). work (26 n), index (12 n). False as above.
bool bough_symmetric_smallest(int n, double *a, int count, double *value, double *vector, double *work,
                              int *index);

// The Cholesky factor L of a symmetric matrix (n × n, row-major; its lower triangle) in place,
// a = L Lᵀ. False unless it is positive definite, with every pivot above 1e-12 of its diagonal.
bool bough_cholesky_factor(int n, double *a);

// The same of a large matrix in single precision by LAPACK, column-major, its lower triangle; the upper one
// is left as it is.
bool bough_cholesky_lower(int n, float *a);

// Solves L Lᵀ x = b in place.
void bough_cholesky_solve(int n, const double *factor, double *b);

// Products with matrices stored by columns, for vectors of some hundred entries.

// sum (n) += factor Σ_j weight_j column_j in this order; column (count × n), weight (count). A column whose
// weight is 0 is not read.
void bough_add_columns(int n, int count, const double *column, double factor, const double *weight,
                       double *sum);

BOUGH_DECLARE_LEVELS(bough_add_columns);

// -- symmetric 6x6 --------------------------------------------------------------------------------

// Symmetric 6×6 matrices as upper triangles by rows (21): stiffness, mass, compliance.

// Index of entry (i, j) in the triangle.
static inline int bough_symmetric6_index(int i, int j) {
    int low = i <= j ? i : j, high = i <= j ? j : i;
    return low * 6 - low * (low - 1) / 2 + (high - low);
}

// The full matrix by rows.
void bough_symmetric6_unpack(const double a[21], double full[6][6]);

// The inverse by bough_cholesky_factor, which decides whether there is one. a and inverse may be the same.
bool bough_symmetric6_inverse(const double a[21], double inverse[21]);

// Q A Qᵀ with Q = diag(R, R) for the rotation R by `angle` about z.
void bough_symmetric6_rotate(const double a[21], double angle, double rotated[21]);

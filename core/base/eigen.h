// Eigenvalues nearest to a point, and their vectors, by block Arnoldi on an inverse: the projected
// matrix is solved densely, and starting with several vectors finds multiple eigenvalues.
#pragma once

#include "core/base/block_tridiagonal.h"

enum { BOUGH_EIGEN_AT_ONCE = 4 };

// λ are the eigenvalues of a real matrix A, given by the action of its inverse about a point: z ←
// A⁻¹z, or, with γ > 0, (I − γA)⁻¹z, whose point is 1/γ.
typedef struct bough_eigen_operator {
    const char *name; // for messages
    int length;       // of a vector
    int n_shape;      // entries of a vector that are its shape, the first
    double gamma;     // γ; 0: A⁻¹
    double *weight;   // of the entries in the inner product (length); 0: unused entry
    bool balance;     // the second half of a vector is the rate of the first: scales the weights of
                      // the first half so that both count alike
    bool decaying;    // real decaying solutions are listed too
    bool checked;     // the caller checks itself whether pairs are missing and how exact they are: neither a
                      // second search nor residuals
    void *self;
    // Images of n ≤ BOUGH_EIGEN_AT_ONCE vectors, one after the other.
    void (*apply)(void *self, int n, const double *z, double *image);
} bough_eigen_operator;

// One of each conjugate pair (λ with positive imaginary part), and growing real solutions; decaying
// real ones, which do not oscillate, are left out unless they are asked for. In the order of their distance
// from the point.
typedef struct bough_eigen_pair {
    double real, imaginary;          // λ [rad/s]
    double residual;                 // bough_eigen_residual of it
    double *shape_real, *shape_imag; // (n_shape), of any length and phase
} bough_eigen_pair;

// How many pairs a search has found.
typedef struct bough_eigen_count {
    int wanted;    // room for them
    int converged; // number for which the iteration converged: `wanted`, halved until it did
    int found;     // fewer than `converged`: there are no more
} bough_eigen_count;

// Finds the pairs, count->wanted of them or as many as converge, each with a residual below 1e-9 of the
// inverse's eigenvalue. BOUGH_FAILED when the iteration does not converge even for one.
bough_status bough_eigen_nearest(bough_arena *arena, const bough_eigen_operator *op, bough_eigen_pair *pair,
                                 bough_eigen_count *count);

// ‖A y − λ y‖/(|λ| ‖y‖) in the operator's inner product, y the operator's image of a vector x near the
// eigenvector, by theory (101). Both are complex, real before imaginary part (2 × length).
double bough_eigen_residual(const bough_eigen_operator *op, double real, double imaginary, const double *x,
                            const double *y);

// A damped, possibly gyroscopic or unsymmetric system
//     (λ² M + λ C + K) q = 0
// with 6×6 blocks, M block diagonal, C and K block tridiagonal, so that the inverse costs one O(n)
// solution with K's factors.
typedef struct bough_eigen_problem {
    const char *name;                       // for messages
    const double *mass;                     // M (n × block)
    const bough_block_tridiagonal *damping; // C
    bough_block_tridiagonal *stiffness;     // K, factored in place
} bough_eigen_problem;

// The pairs of smallest modulus, shapes q (n × 8). BOUGH_FAILED when K is singular or the iteration
// does not converge.
bough_status bough_eigen_smallest(bough_arena *arena, const bough_eigen_problem *problem, int wanted,
                                  bough_eigen_pair *pair, int *found);

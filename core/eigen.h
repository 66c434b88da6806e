// Eigenvalues of smallest modulus of a damped, possibly gyroscopic or unsymmetric system
//     (λ² M + λ C + K) q = 0
// with 6×6 blocks, M block diagonal, C and K block tridiagonal. Method: block Arnoldi on the
// inverse of the linearised pencil, whose application costs one O(n) solution with K's factors; the
// projected matrix is solved densely. Starting with several vectors finds multiple eigenvalues.
#ifndef BOUGH_CORE_EIGEN_H
#define BOUGH_CORE_EIGEN_H

#include "core/block_tridiagonal.h"
#include "core/status.h"

typedef struct bough_eigen_problem {
    const char *name;                     // for messages
    const double *mass;                   // M (n × block)
    const bough_block_tridiagonal *damping; // C
    bough_block_tridiagonal *stiffness;   // K, factored in place
} bough_eigen_problem;

// One of each conjugate pair (λ with positive imaginary part), and growing real solutions; decaying
// real ones, which do not oscillate, are left out. Ascending in modulus.
typedef struct bough_eigen_pair {
    double real, imaginary;          // λ [rad/s]
    double *shape_real, *shape_imag; // q (n × 8), of any length and phase
} bough_eigen_pair;

// Finds `wanted` pairs, or all if there are fewer (*found), each with a residual below 1e-9 of the
// eigenvalue. BOUGH_FAILED when K is singular or the iteration does not converge.
bough_status bough_eigen_smallest(bough_arena *arena, const bough_eigen_problem *problem,
                                  int wanted, bough_eigen_pair *pair, int *found);

#endif

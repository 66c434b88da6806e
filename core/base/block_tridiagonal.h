// Factorisation and solution of block-tridiagonal systems with 6×6 blocks, in O(n), without
// pivoting: the Newton matrices of a rod are close to symmetric positive definite (docs/theory.md,
// "Newton matrix").
//
// Columns of a block are padded to 8 doubles so that one column is one vector register. A block at
// `b` has entry (i, j) at b[8 j + i]; rows 6 and 7 are zero. Arrays of blocks have room for a
// multiple of 8 blocks.
#pragma once

#include "core/base/arena.h"
#include "core/base/level.h"

enum { BOUGH_BLOCK = 6 * BOUGH_COLUMN }; // doubles of a padded 6×6 block

typedef struct bough_block_tridiagonal {
    int n;
    bough_level level; // of the kernels
    double *lower;     // (n × block) row i couples to i − 1; lower[0] unused
    double *diagonal;  // (n × block)
    double *upper;     // (n × block) row i couples to i + 1; upper[n − 1] unused
} bough_block_tridiagonal;

// Takes the matrix' memory.
void bough_block_tridiagonal_init(bough_block_tridiagonal *m, bough_arena *arena, int n);

// Factors in place. False when a pivot is zero or not finite.
bool bough_block_tridiagonal_factor(bough_block_tridiagonal *m);

// Solves with the factors, in place: x (n × 8), rows padded to 8, the last two zero.
void bough_block_tridiagonal_solve(const bough_block_tridiagonal *m, double *x);

// Both at their levels.
BOUGH_DECLARE_LEVELS(bough_block_tridiagonal_factor);
BOUGH_DECLARE_LEVELS(bough_block_tridiagonal_solve);
#define bough_block_tridiagonal_factor(m) BOUGH_OF_LEVEL(bough_block_tridiagonal_factor, (m)->level)(m)
#define bough_block_tridiagonal_solve(m, x) BOUGH_OF_LEVEL(bough_block_tridiagonal_solve, (m)->level)(m, x)

// y −= A x for a matrix that is not factored; lower[0] is not used. x, y (n × 8).
void bough_block_tridiagonal_subtract(const bough_block_tridiagonal *m, const double *x, double *y);

// c = a b and y −= a x for single padded blocks; y and x have 8 entries.
void bough_block_product(const double *a, const double *b, double *c);
void bough_block_subtract(const double *a, const double *x, double *y);

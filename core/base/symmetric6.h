// Symmetric 6×6 matrices as upper triangles by rows (21): stiffness, mass, compliance.
#ifndef BOUGH_CORE_BASE_SYMMETRIC6_H
#define BOUGH_CORE_BASE_SYMMETRIC6_H

#include <stdbool.h>

// Index of entry (i, j) in the triangle.
static inline int bough_symmetric6_index(int i, int j) {
    int low = i <= j ? i : j, high = i <= j ? j : i;
    return low * 6 - low * (low - 1) / 2 + (high - low);
}

// The full matrix by rows.
void bough_symmetric6_unpack(const double a[21], double full[6][6]);

// The inverse by Cholesky's method; false unless a is positive definite. a and inverse may be one.
bool bough_symmetric6_inverse(const double a[21], double inverse[21]);

// Q A Qᵀ with Q = diag(R, R) for the rotation R by `angle` about z.
void bough_symmetric6_rotate(const double a[21], double angle, double rotated[21]);

#endif

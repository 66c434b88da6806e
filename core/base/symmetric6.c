// Symmetric 6×6 matrices: inverse and rotation.
#include "core/base/symmetric6.h"

#include <math.h>

void bough_symmetric6_unpack(const double a[21], double full[6][6]) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) full[i][j] = a[bough_symmetric6_index(i, j)];
    }
}

// A = L Lᵀ; false at a pivot that is not positive.
static bool cholesky(const double *upper, double l[6][6]) {
    for (int j = 0; j < 6; j++) {
        for (int i = j; i < 6; i++) {
            double sum = upper[bough_symmetric6_index(j, i)];
            for (int k = 0; k < j; k++) sum -= l[i][k] * l[j][k];
            if (i == j && !(sum > 0)) return false;
            l[i][j] = i == j ? sqrt(sum) : sum / l[j][j];
        }
    }
    return true;
}

bool bough_symmetric6_inverse(const double a[21], double inverse[21]) {
    double l[6][6], x[6];
    if (!cholesky(a, l)) return false;
    for (int j = 0; j < 6; j++) {
        for (int i = 0; i < 6; i++) {
            // column j of the inverse: L y = e_j, then Lᵀ x = y
            x[i] = i == j;
            for (int k = 0; k < i; k++) x[i] -= l[i][k] * x[k];
            x[i] /= l[i][i];
        }
        for (int i = 5; i >= 0; i--) {
            for (int k = i + 1; k < 6; k++) x[i] -= l[k][i] * x[k];
            x[i] /= l[i][i];
        }
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

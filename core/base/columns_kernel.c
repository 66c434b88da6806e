// Sums of columns, as many at a time as there are registers for their weights: the sum is read and written
// once for all of them.
#include "core/base/linalg.h"

enum { AT_ONCE = 8 };

// sum += Σ_j weight_j column_j, `count` known where this is inlined
BOUGH_INLINE void add(int count, int n, const double *restrict weight, const double *const *restrict column,
                      double *restrict sum) {
#pragma omp simd
    for (int i = 0; i < n; i++) {
        double x = sum[i];
        for (int j = 0; j < count; j++) x += weight[j] * column[j][i];
        sum[i] = x;
    }
}

// `count` becomes a constant of each loop.
static void add_some(int count, int n, const double *weight, const double *const *column, double *sum) {
    switch (count) {
    case 1: add(1, n, weight, column, sum); break;
    case 2: add(2, n, weight, column, sum); break;
    case 3: add(3, n, weight, column, sum); break;
    case 4: add(4, n, weight, column, sum); break;
    case 5: add(5, n, weight, column, sum); break;
    case 6: add(6, n, weight, column, sum); break;
    case 7: add(7, n, weight, column, sum); break;
    case 8: add(8, n, weight, column, sum); break;
    default: break;
    }
}

void BOUGH_AT_LEVEL(bough_add_columns)(int n, int count, const double *column, double factor,
                                       const double *weight, double *sum) {
    const double *some[AT_ONCE];
    double scaled[AT_ONCE];
    int k = 0;
    for (int j = 0; j < count; j++, column += n) {
        if (weight[j] == 0) continue;
        // collected until there are enough for one pass
        scaled[k] = factor * weight[j];
        some[k++] = column;
        if (k < AT_ONCE) continue;
        add_some(k, n, scaled, some, sum);
        k = 0;
    }
    add_some(k, n, scaled, some, sum);
}

// Products with matrices stored by columns, for vectors of some hundred entries.
#ifndef BOUGH_CORE_BASE_COLUMNS_H
#define BOUGH_CORE_BASE_COLUMNS_H

#include "core/base/level.h"

// sum (n) += factor Σ_j weight_j column_j in this order; column (count × n), weight (count). A column whose
// weight is 0 is not read.
void bough_add_columns(int n, int count, const double *column, double factor, const double *weight,
                       double *sum);

BOUGH_DECLARE_LEVELS(bough_add_columns);

#endif

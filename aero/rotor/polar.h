// Airfoil coefficients: tables over the angle of attack, periodic over a full circle, interpolated
// linearly or by monotone cubics.
#pragma once

#include "core/base/arena.h"
#include "core/base/base.h"

// Rows of (α [deg], Cl, Cd, Cm) with α strictly increasing over at most 360°. Between the last
// row and the first, 360° later, values are interpolated, too.
typedef struct bough_polar_def {
    int n;
    const double *row; // (n × 4)
    // A₁, A₂, b₁, b₂ of the indicial lift 1 − Σ A exp(−b s), s in semi-chords; NULL: Jones' values for a flat
    // plate.
    const double *indicial; // (4) [-]
} bough_polar_def;

typedef struct bough_coefficients {
    double lift, drag, moment; // Cl, Cd, Cm about the aerodynamic centre, positive nose up [-]
} bough_coefficients;

enum { BOUGH_POLAR_ROW = 8 }; // doubles per knot: one cache line

typedef struct bough_polar {
    int n;       // knots, both ends of the circle included
    double *row; // (n + 1 × 8): α [rad], Cl, Cd, Cm, their slopes to the next knot, unused; ∞ ends
    const double *curve; // (n × 6) of each: quadratic and cubic coefficient; NULL: linear
    int n_bin;
    double bin_per_rad;
    const int *bin;   // (n_bin): last knot at or below the bin's start
    int most;         // knots within a bin
    double low, high; // range of its rows, high at most 2π above low [rad]
    // Of attached flow; slope 0: the polar has no lift.
    double slope;                        // the steepest line through zero lift that touches the polar [1/rad]
    double zero_lift;                    // where the lift grows through zero, nearest to 0 [rad]
    double least_drag;                   // there [-]
    double wake_weight[2], wake_rate[2]; // A and b of the indicial lift [-]
} bough_polar;

// From rows of finite numbers whose angles increase over 360 degrees at most.
void bough_polar_build(bough_arena *arena, const bough_polar_def *def, bough_polar *polar);

// The mixture (1 − weight)·a + weight·b of two linear polars, exactly: with the knots of both.
void bough_polar_blend(bough_arena *arena, const bough_polar *a, const bough_polar *b, double weight,
                       bough_polar *polar);

// Makes a linear polar smooth: continuous slopes, between knots as monotone as the knots are.
// F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984).
void bough_polar_smoothen(bough_arena *arena, bough_polar *polar);

// The last knot at or below an angle; `alpha` is moved into the table's range. Besides that move there is no
// branch, because the processor could not predict it. A NaN remains and takes the first knot.
BOUGH_INLINE int bough_polar_knot(const bough_polar *polar, double *alpha) {
    const double circle = 2 * BOUGH_PI;
    double x = *alpha - polar->row[0];
    if (x < 0 || x >= circle) {
        x = fmod(x, circle); // exact at any size
        x += x < 0 ? circle : 0;
    }
    int j = (int)((x > 0 ? x : 0) * polar->bin_per_rad);
    int knot = polar->bin[j < polar->n_bin ? j : polar->n_bin - 1];
    *alpha = x + polar->row[0];
    for (int k = 0; k < polar->most; k++) knot += polar->row[BOUGH_POLAR_ROW * (knot + 1)] <= *alpha;
    return knot;
}

// The coefficients at any finite angle of attack [rad].
BOUGH_INLINE bough_coefficients bough_polar_at(const bough_polar *polar, double alpha) {
    int knot = bough_polar_knot(polar, &alpha);
    const double *r = polar->row + BOUGH_POLAR_ROW * knot;
    double d = alpha - r[0];
    bough_coefficients k = {r[1] + d * r[4], r[2] + d * r[5], r[3] + d * r[6]};
    if (!polar->curve) return k;
    const double *c = polar->curve + 6 * knot;
    return (bough_coefficients){k.lift + d * d * (c[0] + d * c[1]), k.drag + d * d * (c[2] + d * c[3]),
                                k.moment + d * d * (c[4] + d * c[5])};
}

// Their derivatives by the angle there [1/rad]; at a knot those of the side above.
BOUGH_INLINE bough_coefficients bough_polar_slope(const bough_polar *polar, double alpha) {
    int knot = bough_polar_knot(polar, &alpha);
    const double *r = polar->row + BOUGH_POLAR_ROW * knot;
    bough_coefficients k = {r[4], r[5], r[6]};
    if (!polar->curve) return k;
    const double *c = polar->curve + 6 * knot;
    double d = alpha - r[0];
    return (bough_coefficients){k.lift + d * (2 * c[0] + 3 * d * c[1]),
                                k.drag + d * (2 * c[2] + 3 * d * c[3]),
                                k.moment + d * (2 * c[4] + 3 * d * c[5])};
}

// Whether an angle of attack lies in the gap between the last row and the first.
BOUGH_INLINE bool bough_polar_outside_table(const bough_polar *polar, double alpha) {
    if (alpha >= polar->low && alpha <= polar->high) return false;
    double above = remainder(alpha - polar->low, 2 * BOUGH_PI);
    return (above < 0 ? above + 2 * BOUGH_PI : above) > polar->high - polar->low;
}

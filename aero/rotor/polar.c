// Tables of airfoil coefficients: knots in radians around the whole circle, bins for lookups, attached flow.
#include "aero/rotor/polar.h"

#include "core/base/base.h"

enum { ROW = BOUGH_POLAR_ROW };

static const double circle = 2 * BOUGH_PI;

// The knots in radians, with the first one again at the end, and the slopes between them.
static void fill_rows(const bough_polar_def *def, int n, double *row) {
    for (int i = 0; i < n; i++) {
        const double *from = def->row + 4 * (i % def->n);
        double *to = row + ROW * i;
        to[0] = from[0] * BOUGH_DEGREE + (i < def->n ? 0 : circle);
        for (int c = 1; c < 4; c++) to[c] = from[c];
    }
    for (int i = 0; i + 1 < n; i++) {
        double *here = row + ROW * i, *next = here + ROW;
        for (int c = 1; c < 4; c++) here[3 + c] = (next[c] - here[c]) / (next[0] - here[0]);
    }
}

// bin[j]: the last knot at or below the start of bin j. A lookup begins there.
static void fill_bins(bough_polar *polar, int *bin) {
    int knot = 0;
    for (int j = 0; j < polar->n_bin; j++) {
        double start = polar->row[0] + j / polar->bin_per_rad;
        while (knot + 2 < polar->n && polar->row[ROW * (knot + 1)] <= start) knot++;
        bin[j] = knot;
        if (j > 0 && knot - bin[j - 1] > polar->most) polar->most = knot - bin[j - 1];
    }
    if (polar->n - 1 - knot > polar->most) polar->most = polar->n - 1 - knot;
}

// The range of the rows; a table whose gap is as wide as two of its own steps covers the circle.
static void find_range(const bough_polar_def *def, bough_polar *polar) {
    const double gap = 360 - (def->row[4 * (def->n - 1)] - def->row[0]);
    double widest = 0;
    for (int i = 1; i < def->n; i++) {
        widest = fmax(widest, def->row[4 * i] - def->row[4 * (i - 1)]);
    }
    polar->low = def->row[0] * BOUGH_DEGREE;
    polar->high = gap <= 2 * widest ? polar->low + circle : def->row[4 * (def->n - 1)] * BOUGH_DEGREE;
}

// -- attached flow --------------------------------------------------------------------------------

static double lift_at(const bough_polar *polar, double alpha) { return bough_polar_at(polar, alpha).lift; }

// The angle nearest to zero, within 20°, at which the lift increases through zero; false: there is none.
static bool find_zero_lift(const bough_polar *polar, double *zero) {
    const double step = 0.25 * BOUGH_DEGREE;
    bool found = false;
    for (int k = -80; k < 80; k++) {
        double a = k * step, b = a + step, fa = lift_at(polar, a), fb = lift_at(polar, b);
        if (!(fa <= 0 && fb > 0)) continue;
        // bisection
        for (int i = 0; i < 50; i++) {
            double middle = (a + b) / 2;
            if (lift_at(polar, middle) > 0) {
                b = middle;
            } else {
                a = middle;
            }
        }
        if (!found || fabs(a) < fabs(*zero)) *zero = a;
        found = true;
    }
    return found;
}

// The steepest line through zero lift that touches the polar: so f never exceeds one, and the
// static polar is met exactly. Between knots the ratio has no maximum if they are joined linearly.
static double steepest(const bough_polar *polar, double zero) {
    const double near_zero = 1e-4; // closer to it the ratio is that of small numbers [rad]
    enum { FINE = 1200 };
    const double reach = 30 * BOUGH_DEGREE;
    double slope = 0;
    for (int k = 0; k < polar->n + 2 * FINE; k++) {
        int j = k - polar->n - FINE;
        double d = k < polar->n ? remainder(polar->row[ROW * k] - zero, circle) : j * reach / FINE;
        if (fabs(d) < near_zero || fabs(d) > reach) continue;
        slope = fmax(slope, lift_at(polar, zero + d) / d);
    }
    return slope;
}

static void fit_attached(bough_polar *polar) {
    if (find_zero_lift(polar, &polar->zero_lift)) polar->slope = steepest(polar, polar->zero_lift);
    polar->least_drag = bough_polar_at(polar, polar->zero_lift).drag;
}

void bough_polar_build(bough_arena *arena, const bough_polar_def *def, bough_polar *polar) {
    bool closed = def->row[4 * (def->n - 1)] - def->row[0] >= 360 * (1 - 1e-12);
    int n = closed ? def->n : def->n + 1;
    // Bins of half a degree: at most two knots to pass in the tables of the field.
    enum { N_BIN = 720 };
    double *row = bough_arena_doubles(arena, (size_t)(ROW * (n + 1)));
    int *bin = bough_arena_take(arena, N_BIN * sizeof *bin);
    fill_rows(def, n, row);
    // ends the search for a knot at any angle
    row[ROW * n] = INFINITY;
    // indicial lift of a flat plate after R. T. Jones
    static const double jones[] = {0.165, 0.335, 0.0455, 0.3};
    const double *k = def->indicial ? def->indicial : jones;
    *polar = (bough_polar){.n = n,
                           .row = row,
                           .n_bin = N_BIN,
                           .bin_per_rad = N_BIN / circle,
                           .bin = bin,
                           .wake_weight = {k[0], k[1]},
                           .wake_rate = {k[2], k[3]}};
    fill_bins(polar, bin);
    find_range(def, polar);
    fit_attached(polar);
}

// -- blending and smoothing -----------------------------------------------------------------------

void bough_polar_blend(bough_arena *arena, const bough_polar *a, const bough_polar *b, double weight,
                       bough_polar *polar) {
    int most = a->n + b->n, n = 0;
    double *angle = bough_arena_doubles(arena, (size_t)most);
    double *row = bough_arena_doubles(arena, 4 * (size_t)most);
    for (int k = 0; k < most; k++)
        angle[k] = k < a->n ? a->row[ROW * k] : remainder(b->row[ROW * (k - a->n)], circle);
    // knots of both tables within one circle
    qsort(angle, (size_t)most, sizeof *angle, bough_ascending);
    for (int k = 0; k < most && angle[k] < angle[0] + circle - 1e-9; k++) {
        if (n > 0 && angle[k] * (1 / BOUGH_DEGREE) - row[4 * (n - 1)] < 1e-9) continue;
        bough_coefficients x = bough_polar_at(a, angle[k]), y = bough_polar_at(b, angle[k]);
        double *to = row + 4 * n++;
        to[0] = angle[k] * (1 / BOUGH_DEGREE);
        to[1] = (1 - weight) * x.lift + weight * y.lift;
        to[2] = (1 - weight) * x.drag + weight * y.drag;
        to[3] = (1 - weight) * x.moment + weight * y.moment;
    }
    double indicial[4];
    for (int i = 0; i < 2; i++) {
        indicial[i] = (1 - weight) * a->wake_weight[i] + weight * b->wake_weight[i];
        indicial[2 + i] = (1 - weight) * a->wake_rate[i] + weight * b->wake_rate[i];
    }
    bough_polar_def def = {.n = n, .row = row, .indicial = indicial};
    bough_polar_build(arena, &def, polar);
    bool a_whole = a->high - a->low >= circle, b_whole = b->high - b->low >= circle;
    polar->low = a_whole ? b->low : b_whole ? a->low : fmax(a->low, b->low);
    polar->high = a_whole ? b->high : b_whole ? a->high : fmin(a->high, b->high);
}

void bough_polar_smoothen(bough_arena *arena, bough_polar *polar) {
    int last = polar->n - 1;
    double *curve = bough_arena_doubles(arena, 6 * (size_t)polar->n);
    double *slope = bough_arena_doubles(arena, 3 * (size_t)polar->n);
    for (int k = 0; k <= last; k++) {
        const double *here = polar->row + ROW * (k % last); // periodic: the last knot is the first
        const double *before = polar->row + ROW * (k % last == 0 ? last - 1 : k % last - 1);
        for (int c = 0; c < 3; c++)
            slope[3 * k + c] =
                bough_cubic_slope(before[ROW] - before[0], before[4 + c], here[ROW] - here[0], here[4 + c]);
    }
    for (int k = 0; k < last; k++) {
        double *row = polar->row + ROW * k, h = row[ROW] - row[0];
        for (int c = 0; c < 3; c++) {
            double s0 = slope[3 * k + c], s1 = slope[3 * (k + 1) + c];
            bough_cubic_bend(row[4 + c], s0, s1, h, curve + 6 * k + 2 * c);
            row[4 + c] = s0;
        }
    }
    polar->curve = curve;
    fit_attached(polar);
}

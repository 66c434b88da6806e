#include "tests/verification/modal_static.h"

#include "core/base/linalg.h"

static const double long_time = 1e8;   // γ at which I − γ ∂f/∂y is −γ ∂f/∂y [s]
static const double tolerance = 1e-11; // of a step, in the shapes' scales
static const double longest = 5;       // step, in those scales: half a radian

enum { ITERATIONS = 100 };

// The largest q of a change in the shapes' scales.
static double size_of(const bough_modal_model *m, const double *change) {
    double largest = 0;
    for (int k = 0; k < m->n_piece; k++) {
        for (int l = 0; l < m->piece[k].m; l++) {
            double part = fabs(change[m->offset[k] + l]) / m->piece[k].scale[l];
            largest = part > largest || isnan(part) ? part : largest;
        }
    }
    return largest;
}

bough_status bough_modal_steady(bough_modal_body *body, double t, const double *input, bough_arena *arena,
                                double *state) {
    const bough_modal_model *m = bough_modal_body_model(body);
    bough_system s = bough_modal_body_system(body);
    void *factors = s.ops->factors(body, arena);
    double *step = bough_arena_doubles(arena, (size_t)m->n_state), before = HUGE_VAL;
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        bool ok = s.ops->linearise(body, t, state, input, factors) &&
                  s.ops->factor(body, factors, long_time) && s.ops->derivative(body, t, state, input, step);
        if (!ok) break;
        for (int k = 0; k < m->n_state; k++) step[k] *= long_time;
        s.ops->solve(body, factors, step);
        double size = size_of(m, step);
        if (!isfinite(size)) break;
        double share = size > longest ? longest / size : 1;
        for (int k = 0; k < m->n_state; k++) state[k] += share * step[k];
        // at the end rounding keeps the steps from shrinking further
        if (size < tolerance || (size < 1e3 * tolerance && size > 0.5 * before)) return bough_ok();
        before = size;
    }
    return bough_fail(BOUGH_FAILED,
                      "%s: no equilibrium found; the loads may be beyond what its"
                      " linear pieces can bear",
                      m->name);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bough_status bough_modal_frequencies(bough_arena *arena, bough_modal_body *body, double t,
                                     const double *input, const double *state, int wanted, double *frequency,
                                     int *found) {
    bough_system s = bough_modal_body_system(body);
    size_t n = (size_t)s.n_state;
    void *factors = s.ops->factors(body, arena);
    double *inverse = bough_arena_doubles(arena, n * n), *value = bough_arena_doubles(arena, 2 * n);
    double *vector = bough_arena_doubles(arena, n * n),
           *work = bough_arena_doubles(arena, BOUGH_EIGEN_WORK(n));
    // eigenvalues μ of (I − γ ∂f/∂y)⁻¹, and λ = (1 − 1/μ)/γ of ∂f/∂y
    const double gamma = 0.1;
    bool ok = s.ops->linearise(body, t, state, input, factors) && s.ops->factor(body, factors, gamma);
    for (size_t k = 0; k < n; k++) {
        inverse[k * n + k] = 1;
        s.ops->solve(body, factors, inverse + k * n);
    }
    if (!ok || !bough_dense_eigen(s.n_state, inverse, value, vector, work)) {
        return bough_fail(BOUGH_FAILED, "%s: its eigenvalues cannot be found", s.name);
    }
    size_t count = 0;
    for (size_t k = 0; k < n; k++) {
        double x = value[k], y = value[n + k], square = x * x + y * y;
        if (y > 0) work[count++] = hypot(1 - x / square, y / square) / gamma / (2 * BOUGH_PI);
    }
    qsort(work, count, sizeof *work, ascending);
    *found = (int)count < wanted ? (int)count : wanted;
    memcpy(frequency, work, (size_t)*found * sizeof *work);
    return bough_ok();
}

// The generalised-α method for first-order systems (Jansen, Whiting, Hulbert 2000), theory (50):
// second order, unconditionally stable, the highest frequencies damped by ρ∞ per step, equal steps
// with one factorisation for as long as Newton's method converges with it.
// Momentum that is not linear in the states, as that of a spinning body whose velocity is resolved in its own
// axes, is kept to second order only: docs/coupling.md.
#include "core/solve/integrator.h"

enum { MOST_ITERATIONS = 10, MOST_HALVINGS = 8 };

static const double slow = 0.1;         // contraction beyond which the tangents are renewed
static const double forget = 0.3;       // of an earlier step's contraction, kept beside a better one
static const double newton_error = 0.1; // of Newton's method, relative to rtol
static const double rounding = 1e-9;    // of times and steps that are meant to be equal, relative

typedef struct alpha {
    bough_ode ode;
    double *weight;       // 1/scale (n)
    double step;          // longest [s]
    double rtol;          // Newton's method ends below rtol · scale
    double am, af, gamma; // α_m, α_f, γ
    double factored;      // γ of I − γ ∂f/∂y in the factors; 0: none
    bool stale;           // the tangents are to be renewed
    double contraction;   // per iteration with these factors, 1 until it is seen
    bool started;
    double *rate;                                 // ẏ₀ (n)
    double *next, *next_rate, *middle, *residual; // y₁, ẏ₁, y_f, work (n)
    bough_statistics sum;
} alpha;

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    alpha *m = bough_arena_take(arena, sizeof *m);
    size_t n = (size_t)ode->n;
    m->ode = *ode;
    m->step = options->step > 0 ? options->step : (double)INFINITY;
    m->rtol = options->rtol;
    // second order, the damping ρ∞ at infinite frequency
    m->am = 0.5 * (3 - options->rho) / (1 + options->rho);
    m->af = 1 / (1 + options->rho);
    m->gamma = 0.5 + m->am - m->af;
    bough_arena_each(arena, n, &m->weight, &m->rate, &m->next, &m->next_rate, &m->middle, &m->residual);
    for (size_t i = 0; i < n; i++) m->weight[i] = 1 / ode->scale[i];
    return m;
}

// y₁ and ẏ₁ with ẏ unchanged over the step.
static void predict(alpha *m, const double *restrict y, double h) {
    double *restrict next = m->next, *restrict next_rate = m->next_rate;
    const double *restrict rate = m->rate;
#pragma omp simd
    for (int i = 0; i < m->ode.n; i++) {
        next_rate[i] = rate[i];
        next[i] = y[i] + h * rate[i];
    }
}

static bool renew_factors(alpha *m, double t, const double *y, double gamma) {
    if (m->stale) {
        m->sum.jacobians++;
        if (!m->ode.linearise(m->ode.self, t, y)) return false;
        m->stale = false;
        m->factored = 0;
    }
    // equal steps differ by rounding of the time
    if (fabs(m->factored - gamma) <= rounding * gamma) return true;
    m->sum.factorisations++;
    m->factored = gamma;
    m->contraction = 1;
    return m->ode.factor(m->ode.self, gamma);
}

// f(t + α_f h, y_f) − ẏ_m into residual
static bool balance(alpha *m, double t, const double *restrict y, double h) {
    double *restrict middle = m->middle, *restrict residual = m->residual;
    const double *restrict next = m->next, *restrict rate = m->rate;
    const double *restrict next_rate = m->next_rate;
    double af = m->af, am = m->am;
#pragma omp simd
    for (int i = 0; i < m->ode.n; i++) middle[i] = y[i] + af * (next[i] - y[i]);
    m->sum.derivatives++;
    if (!m->ode.derivative(m->ode.self, t + af * h, middle, residual)) return false;
#pragma omp simd
    for (int i = 0; i < m->ode.n; i++) residual[i] -= rate[i] + am * (next_rate[i] - rate[i]);
    return true;
}

// Adds the solved step to ẏ₁ and y₁; returns its size against scale, root mean square.
static double correct(alpha *m, double h) {
    double *restrict next = m->next, *restrict next_rate = m->next_rate;
    const double *restrict step = m->residual, *restrict weight = m->weight;
    double inverse = 1 / m->am, step_factor = m->gamma * h, sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < m->ode.n; i++) {
        double d = inverse * step[i];
        next_rate[i] += d;
        // Newmark's relation: y₁ follows ẏ₁ by γh
        next[i] += step_factor * d;
        double relative = step_factor * d * weight[i];
        sum += relative * relative;
    }
    return sqrt(sum / m->ode.n);
}

// What all further iterations would add, against the last one.
static double remainder_share(double contraction) {
    return contraction < 0.5 ? contraction / (1 - contraction) : 1;
}

// Newton's method for one step: it ends when the remaining error, by the contraction seen with these
// factors, is small; so most steps take one iteration. False when it does not converge.
static bool converge(alpha *m, double t, const double *y, double h) {
    double limit = newton_error * m->rtol, before = 0;
    for (int k = 0; k < MOST_ITERATIONS; k++) {
        m->sum.iterations++;
        if (!balance(m, t, y, h)) return false;
        m->ode.solve(m->ode.self, m->residual);
        double size = correct(m, h);
        if (!isfinite(size)) return false;
        if (k > 0) {
            double contraction = size / before;
            // slow convergence renews the tangents before the next step
            if (contraction > 2) return false;
            if (contraction > slow) m->stale = true;
            m->contraction = fmax(forget * m->contraction, contraction);
        }
        if (size * remainder_share(m->contraction) < limit) return true;
        before = size;
    }
    return false;
}

// y, ẏ₀ ← y₁, ẏ₁
static void accept(alpha *m, double *restrict y) {
    const double *restrict next = m->next, *restrict next_rate = m->next_rate;
    double *restrict rate = m->rate;
#pragma omp simd
    for (int i = 0; i < m->ode.n; i++) {
        y[i] = next[i];
        rate[i] = next_rate[i];
    }
    m->sum.steps++;
}

// One step from y at t; y receives y₁. With stale tangents a failed step is tried once more.
static bool take_step(alpha *m, double t, double h, double *y) {
    double gamma = m->af * m->gamma * h / m->am;
    for (int attempt = 0; attempt < 2; attempt++) {
        if (attempt > 0) m->stale = true;
        bool fresh = m->stale;
        predict(m, y, h);
        if (!renew_factors(m, t, y, gamma)) return false;
        if (converge(m, t, y, h)) {
            accept(m, y);
            return true;
        }
        m->sum.failed_steps++;
        if (fresh) return false;
    }
    return false;
}

static bool start(alpha *m, double t, const double *y) {
    m->sum.starts++;
    m->started = true;
    m->stale = true;
    m->sum.derivatives++;
    return m->ode.derivative(m->ode.self, t, y, m->rate);
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    alpha *m = self;
    double longest = m->step;
    bool ok = (!restart && m->started) || start(m, *t, y);
    for (int halvings = 0; ok && *t < t1;) {
        // equal steps to t1; halved where Newton's method fails
        double parts = fmax(1, ceil((t1 - *t) / longest * (1 - rounding)));
        double h = (t1 - *t) / parts;
        if (take_step(m, *t, h, y)) {
            *t = parts <= 1 ? t1 : *t + h;
        } else {
            ok = ++halvings <= MOST_HALVINGS;
            longest = 0.5 * h;
        }
    }
    if (ok) return bough_ok();
    m->started = false;
    return bough_fail(BOUGH_FAILED,
                      "%s at t = %.6g s: generalised-α cannot go on: Newton's method"
                      " does not converge with steps of %.2g s; try a shorter micro step",
                      m->ode.name, *t, longest);
}

static void statistics(const void *self, bough_statistics *sum) {
    const alpha *m = self;
    bough_statistics_add(sum, 1, &m->sum);
}

const bough_integrator_ops bough_integrator_alpha = {
    .name = "generalized-alpha",
    .title = "generalised-α",
    .reads = BOUGH_METHOD_READS_STEP | BOUGH_METHOD_READS_RHO,
    .create = create,
    .advance = advance,
    .statistics = statistics,
};

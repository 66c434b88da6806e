// Radau IIA of order 5. A one-step method: an input that jumps costs it nothing but a Jacobian, and a
// copy of it is complete. Dense algebra, the Jacobian by differences: for small systems.
// theory (51). Method: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.8:
// simplified Newton iterations on the stages, transformed to one real and one complex system; step
// size by the predictive controller; the Jacobian is kept while the iterations converge fast.
// Notation of Hairer and Wanner: stages z_i = Y_i − y, w = T⁻¹ z, and
// T⁻¹ A⁻¹ T = diag(γ, (α −β; β α)).
#include "core/solve/integrator.h"

#include "core/base/linalg.h"

enum { STAGES = 3, MOST_ITERATIONS = 7, MOST_STEPS = 200000 }; // steps per call
enum { MOST_STATES = 400 };

static const double root6 = 2.4494897427831781;
static const double node[STAGES] = {0.15505102572168219, 0.64494897427831781, 1};

static const double gamma_ = 3.6378342527444957, alpha = 2.6810828736277521, beta = 3.0504301992474105;
static const double transform[STAGES][STAGES] = {
    {9.1232394870892942792e-02, -0.14125529502095420843, -3.0029194105147424492e-02},
    {0.24171793270710701896, 0.20412935229379993199, 0.38294211275726193779},
    {0.96604818261509293619, 1, 0}};
static const double inverse[STAGES][STAGES] = {
    {4.3255798900631553510, 0.33919925181580986954, 0.54177053993587487119},
    {-4.1787185915519047273, -0.32768282076106238708, 0.47662355450055045196},
    {-0.50287263494578687595, 2.5719269498556054292, -0.59603920482822492497}};

// Newton's iteration: convergence so fast that the Jacobian is kept
static const double fast = 1e-3;
// Step sizes: safety, and how much a step may shrink or grow
static const double safety = 0.9, most_shrinking = 5, most_growing = 8;
// A step that would grow by less keeps its size and with it the factors.
static const double worthwhile = 1.2;

// What the next step depends on, beside the stages of the last one and the Jacobian.
typedef struct history {
    double time, step;             // step: the next to try; 0: to be guessed
    double length;                 // of the last step; 0: no stages to start from
    double factored;               // the step size the matrices are factored for; 0: none
    double accepted, error;        // of the last accepted step; 0: none yet
    double convergence, remainder; // of Newton's iteration: θ, θ/(1 − θ)
    bool jacobian;                 // it may be used
    bool current;                  // it was taken at the present time
    bool rejected;                 // the last attempt was
    bool started;                  // all this belongs to the state
} history;

typedef struct radau {
    bough_ode ode;
    double *weight;          // 1/tolerance (n)
    double newton_tolerance; // in units of the tolerance
    history past;
    double *z, *matrix;     // (3 × n) stages of the last step, (n × n) Jacobian
    double *y, *rate;       // (n) state and f at the step's start
    double *trial, *w, *f;  // (3 × n) each
    double *error, *point;  // (n)
    double *real, *complex; // factors (n × n), (n × n × 2)
    double *pair;           // (n × 2)
    int *real_pivot, *complex_pivot;
    double present; // the step size of the factors in memory; 0: none
    bool coarse;    // its steps shall not be those of the run beside it
    bough_statistics count;
} radau;

// -- construction ----------------------------------------------------------------------------

static void take(bough_arena *arena, radau *r) {
    size_t n = (size_t)r->ode.n;
    bough_arena_each(arena, n, &r->weight, &r->y, &r->rate, &r->error, &r->point);
    bough_arena_each(arena, STAGES * n, &r->z, &r->trial, &r->w, &r->f);
    bough_arena_each(arena, n * n, &r->matrix, &r->real);
    r->complex = bough_arena_doubles(arena, 2 * n * n);
    r->pair = bough_arena_doubles(arena, 2 * n);
    r->real_pivot = bough_arena_take(arena, n * sizeof(int));
    r->complex_pivot = bough_arena_take(arena, n * sizeof(int));
}

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    double rtol = options->rtol;
    radau *r = bough_arena_take(arena, sizeof *r);
    r->ode = *ode;
    take(arena, r);
    // The error estimate is of order 3, the solution of order 5: this makes the error of the latter
    // follow rtol.
    double inner = 0.1 * pow(rtol, 2.0 / 3);
    for (int i = 0; i < ode->n; i++) r->weight[i] = 1 / (inner * ode->scale[i]);
    r->coarse = options->coarse;
    r->newton_tolerance = fmax(10 * 2.3e-16 / inner, fmin(0.03, sqrt(inner)));
    return r;
}

// -- norms and vectors -----------------------------------------------------------------------

static double square(const radau *r, const double *x) {
    double sum = 0;
    for (int i = 0; i < r->ode.n; i++) sum += x[i] * r->weight[i] * (x[i] * r->weight[i]);
    return sum;
}

// Infinite where a value is not finite.
static double norm(const radau *r, const double *x) {
    double size = sqrt(square(r, x) / r->ode.n);
    return isnan(size) ? HUGE_VAL : size;
}

static bool evaluate(radau *r, double t, const double *y, double *rate) {
    r->count.derivatives++;
    return r->ode.derivative(r->ode.self, t, y, rate) && bough_all_finite(r->ode.n, rate);
}

// to = m from by stages: to and from (3 × n), different
static void mix(int n, const double m[STAGES][STAGES], const double *from, double *to) {
    for (int i = 0; i < n; i++) {
        for (int s = 0; s < STAGES; s++) {
            to[s * n + i] = m[s][0] * from[i] + m[s][1] * from[n + i] + m[s][2] * from[2 * n + i];
        }
    }
}

// The values at s (0 at the step's start, 1 at its end) of the cubics that are 1 at one node and 0
// at the others and at the start
static void cubics(double s, double value[STAGES]) {
    for (int i = 0; i < STAGES; i++) {
        value[i] = s / node[i];
        for (int j = 0; j < STAGES; j++) {
            if (j != i) value[i] *= (s - node[j]) / (node[i] - node[j]);
        }
    }
}

// -- one step --------------------------------------------------------------------------------

// (γ/h) E − J and ((α + iβ)/h) E − J
static bool factor(radau *r, double h) {
    int n = r->ode.n;
    size_t square_size = (size_t)n * (size_t)n;
    for (size_t k = 0; k < square_size; k++) {
        r->real[k] = -r->matrix[k];
        r->complex[2 * k] = -r->matrix[k];
        r->complex[2 * k + 1] = 0;
    }
    for (size_t i = 0, k = 0; i < (size_t)n; i++, k += (size_t)n + 1) {
        r->real[k] += gamma_ / h;
        r->complex[2 * k] += alpha / h;
        r->complex[2 * k + 1] = beta / h;
    }
    r->count.factorisations++;
    r->present = h;
    return bough_dense_factor(n, r->real, r->real_pivot) &&
           bough_complex_factor(n, r->complex, r->complex_pivot);
}

// ∂f/∂y at (t, y) by one-sided differences, whose increments balance truncation against cancellation
static bool differentiate(radau *r, double t) {
    static const double increment = 1.5e-8;
    int n = r->ode.n;
    if (!evaluate(r, t, r->y, r->point)) return false;
    for (int j = 0; j < n; j++) {
        double kept = r->y[j], *column = r->matrix + (size_t)n * (size_t)j;
        r->y[j] = kept + increment * r->ode.scale[j];
        double d = r->y[j] - kept;
        bool ok = evaluate(r, t, r->y, column);
        r->y[j] = kept;
        if (!ok) return false;
        for (int i = 0; i < n; i++) column[i] = (column[i] - r->point[i]) / d;
    }
    return true;
}

// The Jacobian and factors for a step of h. Both may be older: they only steer the iteration.
static bool prepare(radau *r, double h) {
    history *past = &r->past;
    if (!past->jacobian) {
        r->count.jacobians++;
        if (!differentiate(r, past->time)) return false;
        past->jacobian = past->current = true;
        past->factored = r->present = 0;
    }
    if (fabs(past->factored - h) > 1e-10 * h) past->factored = h;
    return r->present == past->factored || factor(r, past->factored);
}

// The last step's polynomial, carried on, starts the iteration; without one the stages start at 0.
static void guess_stages(radau *r, double h) {
    int n = r->ode.n;
    const history *past = &r->past;
    memset(r->trial, 0, STAGES * (size_t)n * sizeof(double));
    for (int s = 0; s < STAGES && past->length > 0; s++) {
        double value[STAGES];
        cubics(1 + node[s] * h / past->length, value);
        value[2] -= 1; // stages count from the last step's end
        for (int i = 0; i < n; i++) {
            r->trial[s * n + i] = value[0] * r->z[i] + value[1] * r->z[n + i] + value[2] * r->z[2 * n + i];
        }
    }
    mix(n, inverse, r->trial, r->w);
}

static bool evaluate_stages(radau *r, double t, double h) {
    int n = r->ode.n;
    for (int s = 0; s < STAGES; s++) {
        for (int i = 0; i < n; i++) r->point[i] = r->y[i] + r->trial[s * n + i];
        if (!evaluate(r, t + node[s] * h, r->point, r->f + s * n)) return false;
    }
    return true;
}

// The increments of w, in place of the right sides T⁻¹ f − (T⁻¹ A⁻¹ T / h) w; their norm
static double improve(radau *r, double h, double *increment) {
    int n = r->ode.n;
    const double *w1 = r->w, *w2 = r->w + n, *w3 = r->w + 2 * n;
    double *d1 = increment, *d2 = increment + n, *d3 = increment + 2 * n;
    mix(n, inverse, r->f, increment);
    for (int i = 0; i < n; i++) {
        d1[i] -= gamma_ / h * w1[i];
        r->pair[2 * i] = d2[i] - (alpha * w2[i] - beta * w3[i]) / h;
        r->pair[2 * i + 1] = d3[i] - (beta * w2[i] + alpha * w3[i]) / h;
    }
    bough_dense_solve(n, 1, r->real, r->real_pivot, d1);
    bough_complex_solve(n, r->complex, r->complex_pivot, r->pair);
    for (int i = 0; i < n; i++) {
        d2[i] = r->pair[2 * i];
        d3[i] = r->pair[2 * i + 1];
    }
    for (int i = 0; i < STAGES * n; i++) r->w[i] += increment[i];
    return sqrt((square(r, d1) + square(r, d2) + square(r, d3)) / (STAGES * n));
}

// Newton's iteration on the stages, into r->trial. Where it does not converge, *shrink is by what
// factor to shorten the step.
static bool solve_stages(radau *r, double h, double *shrink) {
    history *past = &r->past;
    double last = 0, ratio = 0;
    *shrink = 0.5;
    past->remainder = pow(fmax(past->remainder, 2.3e-16), 0.8);
    past->convergence = fast;
    guess_stages(r, h);
    for (int k = 1; k <= MOST_ITERATIONS; k++) {
        if (!evaluate_stages(r, past->time, h)) return false;
        // increments in place of the stages' values, which are not needed any more
        double size = improve(r, h, r->trial);
        r->count.iterations++;
        if (!isfinite(size)) return false;
        if (k > 1) {
            double now = size / last;
            past->convergence = k == 2 ? now : sqrt(now * ratio);
            ratio = now;
            if (past->convergence >= 0.99) return false;
            past->remainder = past->convergence / (1 - past->convergence);
            int left = MOST_ITERATIONS - k;
            double reach = past->remainder * size * pow(past->convergence, left - 1) / r->newton_tolerance;
            if (left > 0 && reach >= 1) { // it would not converge in time
                *shrink = 0.8 * pow(bough_clamp(reach, 1e-4, 20), -1.0 / (3 + left));
                return false;
            }
        }
        last = fmax(size, 2.3e-16);
        mix(r->ode.n, transform, r->w, r->trial);
        if (past->remainder * size <= r->newton_tolerance) {
            *shrink = (2.0 * MOST_ITERATIONS + 1) / (k + 2.0 * MOST_ITERATIONS);
            return true;
        }
    }
    return false;
}

// The difference to the embedded solution of order 3, in units of the tolerance:
// ((γ/h) E − J)⁻¹ (f(t, y) + Σ e_i z_i / h); of a first or repeated step filtered once more.
static double estimate_error(radau *r, double h) {
    int n = r->ode.n;
    const double e[STAGES] = {-(13 + 7 * root6) / 3, (-13 + 7 * root6) / 3, -1.0 / 3};
    double *sum = r->f, *filtered = r->f + n;
    for (int i = 0; i < n; i++) {
        sum[i] = (e[0] * r->trial[i] + e[1] * r->trial[n + i] + e[2] * r->trial[2 * n + i]) / h;
        r->error[i] = sum[i] + r->rate[i];
    }
    bough_dense_solve(n, 1, r->real, r->real_pivot, r->error);
    double size = norm(r, r->error);
    if (!(size >= 1) || (r->past.accepted > 0 && !r->past.rejected)) return size;
    for (int i = 0; i < n; i++) r->point[i] = r->y[i] + r->error[i];
    if (!evaluate(r, r->past.time, r->point, filtered)) return size;
    for (int i = 0; i < n; i++) filtered[i] += sum[i];
    bough_dense_solve(n, 1, r->real, r->real_pivot, filtered);
    return norm(r, filtered);
}

// -- step sizes ------------------------------------------------------------------------------

// The shorter step of two controllers: the elementary one, and the one that predicts
// the error from how it changed over the last two steps.
static double next_step(radau *r, double h, double error, double effort) {
    history *past = &r->past;
    double quotient = pow(error, 0.25) / (safety * effort);
    quotient = bough_clamp(quotient, 1 / most_growing, most_shrinking);
    if (error < 1 && past->accepted > 0) {
        double predicted = past->accepted / h * pow(error * error / past->error, 0.25) / safety;
        quotient = fmax(quotient, bough_clamp(predicted, 1 / most_growing, most_shrinking));
    }
    return h / quotient;
}

static void accept(radau *r, double t1, double h, double error, double next) {
    history *past = &r->past;
    int n = r->ode.n;
    memcpy(r->z, r->trial, STAGES * (size_t)n * sizeof(double));
    for (int i = 0; i < n; i++) r->y[i] += r->z[2 * n + i];
    past->length = h;
    past->time = t1;
    past->accepted = h;
    past->error = fmax(1e-2, error);
    if (past->rejected) next = fmin(next, h); // not back to what failed
    past->rejected = past->current = false;
    past->jacobian = past->convergence <= fast;
    bool alike = next >= h && next <= worthwhile * h;
    if (past->jacobian && alike) next = h;
    past->step = past->step > h ? fmax(next, past->step) : next; // cut short by the end
    r->count.steps++;
}

// From time to `end`, a step of h; on failure a shorter one is proposed.
static void attempt(radau *r, double end, double h) {
    history *past = &r->past;
    double effort = 0.5, error = NAN;
    bool solved = evaluate(r, past->time, r->y, r->rate) && prepare(r, h) && solve_stages(r, h, &effort);
    if (solved) error = fmax(estimate_error(r, h), 1e-10);
    double next = isfinite(error) ? next_step(r, h, error, effort) : effort * h;
    if (error < 1) {
        accept(r, end, h, error, next);
        return;
    }
    r->count.failed_steps++;
    past->rejected = true;
    past->step = solved && past->accepted == 0 ? 0.1 * h : next;
    if (!solved && !past->current) past->jacobian = false;
}

// A first step after the size of y, f and the change of f along an Euler step
static double first_step(radau *r, double span) {
    const history *past = &r->past;
    int n = r->ode.n;
    if (!evaluate(r, past->time, r->y, r->rate)) return 1e-6 * span;
    double size = norm(r, r->y), slope = norm(r, r->rate);
    double h = fmin(span, size > 1e-5 && slope > 1e-5 ? 0.01 * size / slope : 1e-6 * span);
    for (int i = 0; i < n; i++) r->point[i] = r->y[i] + h * r->rate[i];
    if (!evaluate(r, past->time + h, r->point, r->error)) return 0.1 * h;
    for (int i = 0; i < n; i++) r->error[i] = (r->error[i] - r->rate[i]) / h;
    double steepest = fmax(slope, norm(r, r->error));
    return steepest > 0 ? fmin(span, fmin(100 * h, pow(0.01 / steepest, 0.25))) : span;
}

// -- calls -----------------------------------------------------------------------------------

// The step size is kept where f jumps.
static void start(radau *r, double t) {
    double step = r->past.started ? r->past.step : 0;
    r->past = (history){.time = t, .step = step, .remainder = 1, .started = true};
    r->present = 0;
    r->count.starts++;
}

static bough_status failure(const radau *r, const char *what) {
    return bough_fail(BOUGH_FAILED, "%s at t = %.9g s: Radau IIA %s", r->ode.name, r->past.time, what);
}

// Integrates to exactly t1, never evaluating f beyond it.
static bough_status cross(radau *r, double t1) {
    history *past = &r->past;
    double shortest = 1e-14 * fmax(fabs(t1), t1 - past->time);
    for (int k = 0; past->time < t1; k++) {
        double left = t1 - past->time, h = past->step;
        if (!(h > 0)) h = first_step(r, left);
        if (k >= MOST_STEPS) return failure(r, "does not reach the end of the macro step");
        if (h < shortest) return failure(r, "finds no step that is short enough");
        bool last = 1.0001 * h >= left;
        if (last) h = left;
        if (!last && 2 * h > left && !r->coarse) h = 0.5 * left; // no tiny last step
        attempt(r, last ? t1 : past->time + h, h);
    }
    return bough_ok();
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    radau *r = self;
    history *past = &r->past;
    if (restart || !past->started) start(r, *t);
    memcpy(r->y, y, (size_t)r->ode.n * sizeof(double));
    bough_status status = cross(r, t1);
    *t = past->time;
    past->started = bough_is_ok(&status);
    memcpy(y, r->y, (size_t)r->ode.n * sizeof(double));
    return status;
}

// Without the factors, which follow from Jacobian and step size.
static void transfer(void *self, bough_snapshot *s) {
    radau *r = self;
    BOUGH_SNAPSHOT(s, r->past);
    bough_snapshot_doubles(s, r->z, STAGES * r->ode.n);
    bough_snapshot_doubles(s, r->matrix, r->ode.n * r->ode.n);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) r->present = 0;
}

static void statistics(const void *self, bough_statistics *sum) {
    const radau *r = self;
    bough_statistics_add(sum, 1, &r->count);
}

const bough_integrator_ops bough_integrator_radau = {
    .name = "radau5",
    .title = "Radau IIA",
    .most_states = MOST_STATES,
    .create = create,
    .advance = advance,
    .statistics = statistics,
    .transfer = transfer,
};

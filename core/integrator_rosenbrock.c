// A linearly implicit Runge–Kutta method, ROS34PW2 (Rang and Angermann 2005): four
// stages of one evaluation and one solution each, no iteration, order 3 with error control, L-stable,
// stiffly accurate. It is a W-method: its order needs no exact tangents, so that one linearisation
// serves many steps.
//
//     (I − γhJ) u_i = γh [ f(t + α_i h, y + Σ_j a_ij u_j) + γ_i h ∂f/∂t ] + Σ_j c_ij u_j,   j < i,
//     y₁ = y + Σ_i m_i u_i,   error ≈ Σ_i e_i u_i
#include "core/integrator.h"

#include <math.h>
#include <string.h>

enum { STAGES = 4, MOST_STEPS = 100000 };
enum { YOUNG = 8 };     // age of tangents [steps] up to which a failed step keeps them
enum { MOST_DRIFTED = 4 }; // the same of ∂f/∂t, and anew in every macro step
enum { MOST_AGE = 24 }; // steps with the same tangents; on a blade, up to 64 cost no accuracy

// The published coefficients α, Γ, b, b̂ in the form that needs no product with J: a = A Γ⁻¹,
// c = E − γ Γ⁻¹, m = bᵀ Γ⁻¹, e = (b − b̂)ᵀ Γ⁻¹. The last row of a is m without its last entry, 1.
static const double gamma_h = 0.4358665215084590;
static const double alpha[STAGES] = {0, 0.8717330430169180, 0.7315799577888524, 1};
static const double slope[STAGES] = {0.4358665215084590, -0.4358665215084590,
                                     -0.4133333762338865, 0};
static const double a[STAGES][3] = {
    {0, 0, 0},
    {2, 0, 0},
    {1.4192173174557647, -0.2592322116729697, 0},
    {4.1847604823191600, -0.2851920173554959, 2.2942803602790420}};
static const double c[STAGES][3] = {
    {0, 0, 0},
    {-2, 0, 0},
    {-1.8239969947745136, 0.1243056525667201, 0},
    {-2.7756761163024684, -2.9619836625547890, 1.2509798950560604}};
static const double e[STAGES] = {0.2777499476479672, -1.4032398951759988, 1.7726301276675507, 0.5};

static const double own_share = 0.05; // of the embedded error that the
// method makes: measured on blades, whose stiffness takes both orders down, the run errs by 0.04 to
// 0.1 of it at steps of 2.5 to 20 ms

typedef struct rosenbrock {
    bough_ode ode;
    double *weight; // 1/tolerance of each state (n)
    double step;    // longest [s]
    int most_steps; // in a macro step, and after a fifth of them their number is foreseen
    double longest;  // step allowed next [s]
    double factored; // γh of the factors; 0: none
    int age;         // steps since the tangents were found
    bool started;
    double *drift;              // ∂f/∂t (n)
    int drifted;                // steps since it was found
    bool drifts;                // it is found in the step in progress
    double end;                 // of the macro step in progress [s]
    double *error;              // (n)
    double *stage[STAGES];      // u_i (n)
    double *at;                 // argument of f, then y₁ (n)
    int now;                    // the stage in progress
    const double *from;         // (n) y of the step in progress
    double now_step;            // of the step in progress [s]
    double *to;                 // (n) where y₁ goes
    int n_part;                 // of the states
    double *square;             // (n_part) sums of squares
    double *own_error;          // (n)
    bough_statistics sum;
} rosenbrock;

static void *create(bough_arena *arena, const bough_ode *ode,
                    const bough_integrator_options *options) {
    rosenbrock *m = bough_arena_take(arena, sizeof *m);
    size_t n = (size_t)ode->n;
    m->ode = *ode;
    if (m->ode.derivative_again == NULL) m->ode.derivative_again = ode->derivative;
    m->step = options->step > 0 ? options->step : (double)INFINITY;
    m->most_steps = options->most_steps > 0 ? options->most_steps : MOST_STEPS;
    bough_arena_each(arena, n, &m->weight, &m->drift, &m->error, &m->at, &m->own_error);
    m->n_part = ode->stage ? ode->n_part : 1;
    m->square = bough_arena_doubles(arena, (size_t)m->n_part);
    for (int i = 0; i < STAGES; i++) m->stage[i] = bough_arena_doubles(arena, n);
    for (size_t k = 0; k < n; k++) m->weight[k] = 1 / (options->rtol * ode->scale[k]);
    return m;
}

// -- one step -------------------------------------------------------------------------------------

static bool renew_factors(rosenbrock *m, double t, const double *y, double h) {
    double gamma = gamma_h * h;
    if (m->age >= MOST_AGE) {
        m->sum.jacobians++;
        if (!m->ode.linearise(m->ode.self, t, y)) return false;
        m->age = 0;
        m->factored = 0;
    }
    // equal steps differ by rounding of the time
    if (fabs(m->factored - gamma) <= 1e-9 * gamma) return true;
    m->sum.factorisations++;
    m->factored = gamma;
    return m->ode.factor(m->ode.self, gamma);
}

// ∂f/∂t as its mean over the step, because the inputs move; like the tangents it is used for several steps.
// Here f at the step's end, from which the first stage takes f at its start.
static bool renew_drift(rosenbrock *m, double t, double h, const double *y) {
    m->drifts = m->drifted >= MOST_DRIFTED;
    if (!m->drifts) return true;
    m->sum.derivatives++;
    return m->ode.derivative(m->ode.self, t + h, y, m->drift);
}

// u_0 = γh [f + γ₁h ∂f/∂t], f standing in u_0
static void set_first_right_side(rosenbrock *m, int first, int last) {
    double *restrict u = m->stage[0], *restrict drift = m->drift;
    double h = m->now_step, f = gamma_h * h, d = slope[0] * h;
    if (m->drifts) {
#pragma omp simd
        for (int k = first; k < last; k++) drift[k] = (drift[k] - u[k]) / h;
    }
#pragma omp simd
    for (int k = first; k < last; k++) u[k] = f * (u[k] + d * drift[k]);
}

// Σ_j weight_j u_j over the stages before stage i; loops take what does not change out of them.
static inline double stages_before(const rosenbrock *m, int i, const double weight[3],
                                   int k) {
    double sum = weight[0] * m->stage[0][k];
    if (i > 1) sum += weight[1] * m->stage[1][k];
    if (i > 2) sum += weight[2] * m->stage[2][k];
    return sum;
}

// at = y + Σ_j a_ij u_j
static inline void set_argument(rosenbrock *m, int i, int first, int last) {
    double *restrict at = m->at;
    const double *restrict y = m->from;
#pragma omp simd
    for (int k = first; k < last; k++) at[k] = y[k] + stages_before(m, i, a[i], k);
}

// u_i = γh [f + γ_i h ∂f/∂t] + Σ_j c_ij u_j, f standing in u_i
static inline void set_right_side(rosenbrock *m, int i, int first, int last) {
    double *restrict u = m->stage[i], h = m->now_step;
    const double *restrict drift = m->drift;
    double f = gamma_h * h, d = gamma_h * h * slope[i] * h;
#pragma omp simd
    for (int k = first; k < last; k++) u[k] = f * u[k] + d * drift[k] + stages_before(m, i, c[i], k);
}

// Inlined with the stage known, each has a loop of its own.
static void set_present_argument(void *self, int first, int last) {
    rosenbrock *m = self;
    switch (m->now) {
    case 0: break;
    case 1: set_argument(m, 1, first, last); break;
    case 2: set_argument(m, 2, first, last); break;
    default: set_argument(m, 3, first, last);
    }
}

static void set_present_right_side(void *self, int first, int last) {
    rosenbrock *m = self;
    switch (m->now) {
    case 0: set_first_right_side(m, first, last); break;
    case 1: set_right_side(m, 1, first, last); break;
    case 2: set_right_side(m, 2, first, last); break;
    default: set_right_side(m, 3, first, last);
    }
}

static bool find_stage(rosenbrock *m, int i, double t) {
    const bough_ode *ode = &m->ode;
    const bough_stage_terms terms = {m, set_present_argument, set_present_right_side, i == 0 && m->drifts};
    const double *state = i == 0 ? m->from : m->at;
    double at = t + alpha[i] * m->now_step;
    m->now = i;
    m->sum.derivatives++;
    if (ode->stage) return ode->stage(ode->self, at, state, terms, m->stage[i]);
    set_present_argument(m, 0, ode->n);
    bool finite = terms.again ? ode->derivative_again(ode->self, at, state, m->stage[i])
                              : ode->derivative(ode->self, at, state, m->stage[i]);
    if (!finite) return false;
    set_present_right_side(m, 0, ode->n);
    ode->solve(ode->self, m->stage[i]);
    return true;
}

static bool find_stages(rosenbrock *m, double t, double h, const double *y) {
    m->from = y;
    m->now_step = h;
    for (int i = 0; i < STAGES; i++) {
        if (!find_stage(m, i, t)) return false;
    }
    if (m->drifts) m->drifted = 0;
    return true;
}

static void work_on_each(rosenbrock *m, bough_part_work work) {
    if (m->ode.stage) {
        m->ode.each(m->ode.self, work, m);
    } else {
        work(m, 0, 0, m->ode.n);
    }
}

// y₁ into `at`, whose last argument lacks the last stage only; the sum of squares of the error against the
// tolerance.
static void finish_part(void *self, int part, int first, int last) {
    rosenbrock *m = self;
    double *restrict at = m->at;
    const double *restrict u0 = m->stage[0], *restrict u1 = m->stage[1], *restrict u2 = m->stage[2];
    const double *restrict u3 = m->stage[3], *restrict weight = m->weight;
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int k = first; k < last; k++) {
        at[k] += u3[k];
        double error = e[0] * u0[k] + e[1] * u1[k] + e[2] * u2[k] + e[3] * u3[k];
        sum += (weight[k] * error) * (weight[k] * error);
    }
    m->square[part] = sum;
}

// Returns the error's root mean square.
static double finish(rosenbrock *m) {
    work_on_each(m, finish_part);
    double sum = 0;
    for (int part = 0; part < m->n_part; part++) sum += m->square[part];
    return sqrt(sum / m->ode.n);
}

// The same for (I − γhJ)⁻¹ error: without the stiff part, which the method damps and the estimate
// overestimates where an input jumps (Hairer and Wanner, section IV.8).
static double filter(rosenbrock *m) {
    double *restrict error = m->error;
    const double *restrict u0 = m->stage[0], *restrict u1 = m->stage[1], *restrict u2 = m->stage[2];
    const double *restrict u3 = m->stage[3], *restrict weight = m->weight;
    double sum = 0;
#pragma omp simd
    for (int k = 0; k < m->ode.n; k++)
        error[k] = e[0] * u0[k] + e[1] * u1[k] + e[2] * u2[k] + e[3] * u3[k];
    m->ode.solve(m->ode.self, error);
#pragma omp simd reduction(+ : sum)
    for (int k = 0; k < m->ode.n; k++) sum += (weight[k] * error[k]) * (weight[k] * error[k]);
    return sqrt(sum / m->ode.n);
}

// The error of a step against the tolerance; infinite where f has no value.
static double try_step(rosenbrock *m, double t, double h, const double *y) {
    if (!renew_factors(m, t, y, h) || !renew_drift(m, t, h, y)) return (double)INFINITY;
    if (!find_stages(m, t, h, y)) return (double)INFINITY;
    double error = finish(m);
    if (error > 1 && isfinite(error)) error = filter(m);
    return isfinite(error) ? error : (double)INFINITY;
}

// -- steps ----------------------------------------------------------------------------------------

// y ← y₁
static void accept_part(void *self, int part, int first, int last) {
    (void)part;
    rosenbrock *m = self;
    double *restrict y = m->to;
    const double *restrict at = m->at;
    const double *restrict u0 = m->stage[0], *restrict u1 = m->stage[1], *restrict u2 = m->stage[2];
    const double *restrict u3 = m->stage[3];
    double *restrict sum = m->own_error;
    double e0 = own_share * e[0], e1 = own_share * e[1], e2 = own_share * e[2];
    double e3 = own_share * e[3];
#pragma omp simd
    for (int k = first; k < last; k++) {
        y[k] = at[k];
        sum[k] += e0 * u0[k] + e1 * u1[k] + e2 * u2[k] + e3 * u3[k];
    }
}

// Equal steps over the remaining time, none longer than allowed. A step that fails with old tangents is
// first repeated with new ones. Returns NULL, or the reason of a failure.
static const char *cross(rosenbrock *m, double *t, double pause, double t1, double *y) {
    double begun = *t;
    for (int n = 0; *t < pause; n++) {
        double parts = ceil((t1 - *t) / m->longest * (1 - 1e-12));
        double h = (t1 - *t) / fmax(parts, 1);
        bool known = n >= m->most_steps / 5;
        if (known && n * (t1 - begun) >= m->most_steps * (*t - begun)) {
            return "too many steps to the end of the macro step: it follows vibrations that fast, which"
                   " damping of rods or a larger rtol would end";
        }
        double error = try_step(m, *t, h, y);
        if (error > 1 && h < 1e-12 * (fabs(*t) + 1e-3)) {
            return "the error test fails down to the smallest step (a segment that turns by more than"
                   " 120°, or a value that overflows)";
        }
        if (error > 1) {
            m->sum.failed_steps++;
            m->longest = h * fmax(0.1, 0.9 * cbrt(1 / error));
            if (m->age > YOUNG || !isfinite(error)) m->age = MOST_AGE;
            continue;
        }
        m->to = y;
        work_on_each(m, accept_part);
        m->sum.steps++;
        m->age++;
        m->drifted++;
        double grown = 0.9 * h * fmin(5, cbrt(1 / fmax(error, 1e-6)));
        m->longest = fmin(m->step, fmax(h, grown));
        *t = parts <= 1 ? t1 : *t + h;
    }
    return NULL;
}

static bough_status advance(void *self, double *t, double pause, double t1, bool restart,
                            double *y) {
    rosenbrock *m = self;
    if (restart || !m->started) {
        m->sum.starts++;
        m->started = true;
        m->age = MOST_AGE;
        m->drifted = MOST_DRIFTED;
        m->longest = m->step;
    }
    if (t1 != m->end) m->drifted = MOST_DRIFTED; // not paused on the way
    m->end = t1;
    const char *reason = cross(m, t, pause, t1, y);
    if (reason == NULL) return bough_ok();
    m->started = false;
    return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: the Rosenbrock method cannot go on: %s",
                      m->ode.name, *t, reason);
}

static double *own_error(void *self) {
    rosenbrock *m = self;
    return m->own_error;
}

static void statistics(const void *self, bough_statistics *sum) {
    const rosenbrock *m = self;
    bough_statistics_add(sum, &m->sum);
}

const bough_integrator_ops bough_integrator_rosenbrock = {
    .name = "rosenbrock",
    .title = "Rosenbrock",
    .reads = BOUGH_METHOD_READS_STEP,
    .create = create,
    .advance = advance,
    .statistics = statistics,
    .own_error = own_error,
};

// A linearly implicit Runge–Kutta method, ROS34PW2 (Rang and Angermann 2005): four
// stages of one evaluation and one solution each, no iteration, order 3 with error control, L-stable,
// stiffly accurate. It is a W-method: its order needs no exact tangents, so that one linearisation
// serves many steps. theory (52, 53)
#include "core/solve/rosenbrock.h"

enum { STAGES = BOUGH_ROSENBROCK_STAGES, MOST_STEPS = 100000 };
enum { YOUNG = 8 };        // age of tangents [steps] up to which a failed step keeps them
enum { MOST_DRIFTED = 4 }; // steps with the same ∂f/∂t; every macro step finds it anew
enum { MOST_AGE = 24 };    // steps with the same tangents; on a blade, up to 64 cost no accuracy
enum { COARSE_AGE = 20 };  // the same of long steps
enum { UNDAMPED_AGE = 2 }; // without damping, until the age is chosen by its effect
// After a start the age is at most FIRST_AGE, and one more after each SETTLING steps: while a motion sets in,
// old tangents of blades drive tower and hub.
enum { FIRST_AGE = 2, SETTLING = 8 };

static const double gamma_h = 0.4358665215084590; // γ
static const double alpha[STAGES] = {0, 0.8717330430169180, 0.7315799577888524, 1};

// Old tangents let vibrations of stiff bodies grow, by damping ratios down to −9e-4. A viscosity, as a time,
// of more than `least_viscosity` steps damps these by more. With less, the age of the tangents is chosen so
// that renewed ones change a step by `most_change` of it: −2e-5 for a rod whose tip moves by 1/1000 of its
// length, −2e-4 for three times as much, which tangents of every step have too.
static const double least_viscosity = 0.03; // [-]
static const double most_change = 0.002;    // [-]
// The age of its tangents is the cause of a failed step whose error exceeds this multiple of the last one
// with new tangents, both over the third power of the length: a member that rotates fast soon needs new ones.
static const double too_old = 3;
// Tangents are renewed also after a successful step whose error exceeds this multiple of the least error with
// them, and this part of the tolerance: with old ones a stiff body that rotates moves its carrier.
static const double turned = 10, noticed = 0.03;
// If the first step with new tangents has more than this part of the error for which they were renewed, both
// over the third power of the length, the motion is the cause and not the tangents.
static const double by_motion = 0.5;
// A companion's longest first step, over its macro step: a longer one passes over the vibrations of the
// start and errs most in stiff forces.
static const double short_start = 0.05;
static const double older = 1.1;     // growth of the useful age at each renewal, until a step fails again
static const double rounding = 1e-9; // of times and steps that are meant to be equal, relative

typedef struct rosenbrock {
    bough_ode ode;
    bough_rosenbrock_find find; // of the stages
    void *finder;               // its self
    double *weight;             // 1/tolerance of each state (n)
    double step;                // longest [s]
    double first;               // longest after a start, over the macro step
    int most_steps;             // in a macro step, and after a fifth of them their number is foreseen
    double longest;             // the next step may have [s]
    double factored;            // γh of the factors; 0: none
    int kept;                   // most steps with the same tangents
    double useful;        // useful age of tangents: less than `kept` after steps that failed by their age
    double renewed_for;   // error over h³ for which tangents were renewed before that age [s⁻³]; 0: none
    double useful_before; // the useful age until then
    double new_error;     // of the last step with new tangents, over h³ [s⁻³]
    double least;         // error of the steps since the tangents were found
    int age, most_age;    // steps since the tangents were found, and after which they are renewed
    int since;            // steps since the last start
    bool kept_twice;      // those of deforming members are older
    bool started;
    int drifted;               // steps since ∂f/∂t was found
    bough_rosenbrock_step now; // the step in progress
    double *error;             // (n)
    double *last;              // (n) y before the last step
    double last_step;          // its length [s]; 0: none yet
    double *ahead;             // (n) where rigid bodies are linearised
    double *old, *fresh;       // (n) the last increment under old and under renewed tangents
    bough_statistics sum;
} rosenbrock;

// -- one step of one system -----------------------------------------------------------------------

double bough_rosenbrock_time(const bough_rosenbrock_step *s, int i) { return s->t + alpha[i] * s->h; }

// f into u_i, and for the first stage at the step's end too where ∂f/∂t is to be found.
static bool evaluate(rosenbrock *m, int i) {
    const bough_ode *ode = &m->ode;
    bough_rosenbrock_step *s = &m->now;
    const double *state = i == 0 ? s->y : s->at, end = s->t + s->h, at = bough_rosenbrock_time(s, i);
    if (i > 0 || !s->drifts) return ode->derivative(ode->self, at, state, s->u[i]);
    if (ode->derivative_twice) {
        return ode->derivative_twice(ode->self, (double[]){end, at}, state, (double *[]){s->drift, s->u[i]});
    }
    return ode->derivative(ode->self, end, state, s->drift) && ode->derivative(ode->self, at, state, s->u[i]);
}

static double find_alone(void *self, bough_rosenbrock_step *s) {
    rosenbrock *m = self;
    int n = m->ode.n;
    for (int i = 0; i < STAGES; i++) {
        if (i > 0) bough_rosenbrock_argument(s, i, 0, n);
        if (!evaluate(m, i)) return (double)NAN;
        bough_rosenbrock_right_side(s, i, 0, n);
        m->ode.solve(m->ode.self, s->u[i]);
    }
    return bough_rosenbrock_end(s, 0, n);
}

void bough_rosenbrock_find_by(bough_integrator *integrator, bough_rosenbrock_find work, void *self) {
    rosenbrock *m = integrator->self;
    m->find = work;
    m->finder = self;
}

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    rosenbrock *m = bough_arena_take(arena, sizeof *m);
    size_t n = (size_t)ode->n;
    m->ode = *ode;
    m->kept = options->coarse ? COARSE_AGE : MOST_AGE;
    if (options->coarse) m->ode.elastic_rate /= 3;
    m->find = find_alone;
    m->finder = m;
    m->step = options->step > 0 ? options->step : (double)INFINITY;
    m->first = options->coarse ? short_start : 1;
    m->most_steps = options->most_steps > 0 ? options->most_steps : MOST_STEPS;
    bough_arena_each(arena, n, &m->weight, &m->now.drift, &m->error, &m->now.at);
    bough_arena_each(arena, n, &m->last, &m->ahead, &m->old, &m->fresh);
    for (int i = 0; i < STAGES; i++) m->now.u[i] = bough_arena_doubles(arena, n);
    for (size_t k = 0; k < n; k++) m->weight[k] = 1 / (options->rtol * ode->scale[k]);
    m->now.weight = m->weight;
    m->now.level = bough_level_chosen();
    return m;
}

// -- the error of a step --------------------------------------------------------------------------

static bool undamped(const rosenbrock *m, double h) { return m->ode.elastic_rate * h * least_viscosity > 1; }

// (I − γhJ)⁻¹ (y₁ − y₀) of the last step
static void filter_increment(rosenbrock *m, double *x) {
    bough_rosenbrock_increment(&m->now, m->ode.n, x);
    m->ode.solve(m->ode.self, x);
}

// The age of tangents at which a step changes by `most_change`: its change is proportional to the age.
static void choose_age(rosenbrock *m) {
    double change = 0, whole = 0;
    for (int k = 0; k < m->ode.n; k++) {
        double difference = m->weight[k] * (m->fresh[k] - m->old[k]), fresh = m->weight[k] * m->fresh[k];
        change += difference * difference;
        whole += fresh * fresh;
    }
    double wanted = m->age * most_change * sqrt(whole / fmax(change, 1e-300));
    m->most_age = (int)fmax(1, fmin(fmin(m->kept, m->age + 1), wanted));
}

// The age at which tangents are renewed though no step has failed.
static int oldest(const rosenbrock *m) {
    return (int)fmin(FIRST_AGE + m->since / SETTLING, fmin(m->most_age, m->useful));
}

// theory (115): what turns is linearised where it will be, by the last step, in the middle of those to come.
static bool linearise(rosenbrock *m, double t, const double *y, double h) {
    const bough_ode *ode = &m->ode;
    if (!ode->linearise_ahead) return ode->linearise(ode->self, t, y);
    double by = m->last_step > 0 ? oldest(m) / 2.0 * fmin(h / m->last_step, 1) : 0;
    for (int k = 0; k < ode->n; k++) m->ahead[k] = y[k] + by * (y[k] - m->last[k]);
    return ode->linearise_ahead(ode->self, t, y, m->ahead, m->kept_twice);
}

static bool renew_tangents(rosenbrock *m, double t, const double *y, double gamma) {
    bool due = m->age == oldest(m), compare = undamped(m, gamma / gamma_h) && due && m->factored > 0;
    bool same = fabs(m->factored - gamma) <= rounding * gamma;
    // tangents of deforming members are kept for the same number of steps once more
    m->kept_twice = due && same && !compare && !m->kept_twice && m->age == m->kept;
    if (due) m->useful = fmin(older * m->useful, m->kept);
    // the last increment under old tangents, for comparison with renewed ones
    if (compare) filter_increment(m, m->old);
    m->sum.jacobians++;
    m->sum.factorisations++;
    if (!linearise(m, t, y, gamma / gamma_h) || !m->ode.factor(m->ode.self, gamma)) return false;
    if (!undamped(m, gamma / gamma_h)) m->most_age = m->kept;
    if (compare && same) {
        filter_increment(m, m->fresh);
        choose_age(m);
    }
    m->age = 0;
    m->factored = gamma;
    return true;
}

static bool renew_factors(rosenbrock *m, double t, const double *y, double h) {
    double gamma = gamma_h * h;
    if (m->age >= oldest(m)) return renew_tangents(m, t, y, gamma);
    // equal steps differ by rounding of the time
    if (fabs(m->factored - gamma) <= rounding * gamma) return true;
    m->sum.factorisations++;
    m->factored = gamma;
    return m->ode.factor(m->ode.self, gamma);
}

// The root mean square of (I − γhJ)⁻¹ error: without the stiff part, which the method damps and the estimate
// overestimates where an input jumps (Hairer and Wanner, section IV.8).
static double filter(rosenbrock *m) {
    double *restrict error = m->error;
    const bough_rosenbrock_step *s = &m->now;
    const double *restrict weight = m->weight;
    double sum = 0;
    bough_rosenbrock_error(s, m->ode.n, error);
    m->ode.solve(m->ode.self, error);
#pragma omp simd reduction(+ : sum)
    for (int k = 0; k < m->ode.n; k++) sum += (weight[k] * error[k]) * (weight[k] * error[k]);
    return sqrt(sum / m->ode.n);
}

// The root mean square of a step's error against the tolerance; infinite where f has no value. ∂f/∂t is taken
// as its mean over the step, because the inputs move, and used for several steps, as the tangents are.
static double try_step(rosenbrock *m, double t, double h, const double *y) {
    bough_rosenbrock_step *s = &m->now;
    if (!renew_factors(m, t, y, h)) return (double)INFINITY;
    s->t = t, s->h = h, s->gamma = gamma_h * h, s->y = y;
    s->drifts = m->drifted >= MOST_DRIFTED;
    m->sum.derivatives += STAGES + s->drifts;
    double error = sqrt(m->find(m->finder, s) / m->ode.n);
    if (!isfinite(error)) return (double)INFINITY;
    if (s->drifts) m->drifted = 0;
    if (error > 1) error = filter(m);
    return isfinite(error) ? error : (double)INFINITY;
}

// -- steps ----------------------------------------------------------------------------------------

// y ← y₁
static void accept(rosenbrock *m, double *restrict y) {
    size_t size = (size_t)m->ode.n * sizeof *y;
    memcpy(m->last, y, size);
    memcpy(y, m->now.at, size);
    m->last_step = m->now.h;
}

// Tangents are renewed at this age from now on, because of the error of a step of length h.
static void renew_earlier(rosenbrock *m, double error, double h) {
    m->renewed_for = error / (h * h * h);
    m->useful_before = m->useful;
    m->useful = m->age;
}

// The first step under new tangents shows whether the old ones were the cause.
static void check_renewal(rosenbrock *m, double error, double h) {
    if (m->age > 0 || m->renewed_for == 0) return;
    if (error > by_motion * m->renewed_for * h * h * h) m->useful = m->useful_before;
    m->renewed_for = 0;
}

// After a failed step of length h: new tangents where the old ones are the cause, else a shorter step.
static void shorten(rosenbrock *m, double h, double error) {
    double by_new = m->age > 0 ? m->new_error * h * h * h : error;
    bool old = isfinite(error) && error > too_old * by_new;
    m->sum.failed_steps++;
    m->longest = h * fmax(0.1, fmin(1, 0.9 * cbrt(1 / (old ? by_new : error))));
    if (old) renew_earlier(m, error, h);
    if (old || m->age > YOUNG || !isfinite(error)) m->age = MOST_AGE;
}

// All steps to t1. Returns NULL, or the reason of a failure.
static const char *cross(rosenbrock *m, double *t, double t1, double *y) {
    double begun = *t;
    for (int n = 0; *t < t1; n++) {
        // equal steps, none longer than allowed; times are rounded
        double parts = ceil((t1 - *t) / m->longest * (1 - rounding));
        double h = (t1 - *t) / fmax(parts, 1);
        bool known = n >= m->most_steps / 5;
        if (known && n * (t1 - begun) >= m->most_steps * (*t - begun)) {
            return "too many steps in one macro step, because the vibrations are so fast; damp the rods or take a larger rtol";
        }
        // a step that fails with old tangents is repeated with new ones
        double error = try_step(m, *t, h, y);
        check_renewal(m, error, h);
        if (error > 1 && h < 1e-12 * (fabs(*t) + 1e-3)) {
            return "the error test fails down to the smallest step (a segment that turns by more than"
                   " 120°, or a value that overflows)";
        }
        if (error > 1) {
            shorten(m, h, error);
            continue;
        }
        accept(m, y);
        m->sum.steps++;
        if (m->age == 0) m->new_error = error / (h * h * h);
        m->least = m->age > 0 ? fmin(m->least, error) : error;
        m->age++, m->since++;
        bool late = error > noticed && error > turned * m->least;
        if (late && m->ode.elastic_rate > 0) renew_earlier(m, error, h);
        m->drifted++;
        // elementary controller of an error of order 3
        double grown = 0.9 * h * fmin(5, cbrt(1 / fmax(error, 1e-6)));
        m->longest = fmin(m->step, fmax(h, grown));
        *t = parts <= 1 ? t1 : *t + h;
    }
    return NULL;
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    rosenbrock *m = self;
    if (restart || !m->started) {
        m->sum.starts++;
        m->since = 0;
        m->started = true;
        m->last_step = 0;
        m->age = MOST_AGE;
        m->most_age = UNDAMPED_AGE;
        m->useful = m->kept;
        m->renewed_for = 0;
        m->longest = fmin(m->step, m->first * (t1 - *t));
    }
    m->drifted = MOST_DRIFTED;
    const char *reason = cross(m, t, t1, y);
    if (reason == NULL) return bough_ok();
    m->started = false;
    return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: the Rosenbrock method cannot go on: %s", m->ode.name,
                      *t, reason);
}

static void limit(void *self, int most_steps) {
    rosenbrock *m = self;
    m->most_steps = most_steps;
}

static void statistics(const void *self, bough_statistics *sum) {
    const rosenbrock *m = self;
    bough_statistics_add(sum, 1, &m->sum);
}

const bough_integrator_ops bough_integrator_rosenbrock = {
    .name = "rosenbrock",
    .title = "Rosenbrock",
    .reads = BOUGH_METHOD_READS_STEP,
    .create = create,
    .advance = advance,
    .limit = limit,
    .statistics = statistics,
};

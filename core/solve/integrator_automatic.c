// The default method: the Rosenbrock method, and IDA where that is cheaper.
// The former's steps are long where motion is slow or stiff and damped. Where stiff members vibrate without
// damping every method must follow them, and IDA then takes an evaluation a step and order 5: a tenth of the
// cost at a tenth of the tolerance. So IDA is tried after a macro step of many steps, and stays where it
// is cheaper; it also takes over where the Rosenbrock method stops. Where IDA stops as well, the Rosenbrock
// method goes on with as many steps: it damps what vibrates fast, and its steps then grow.
// Orders above 2 are unstable near the imaginary axis. Where vibrations are small beside a loose tolerance,
// this limits their steps, and not the error. So a coarse solution also has IDA of order 2, at its whole
// tolerance. Beside a run whose rods are by BDF it begins with CVODE, until a macro step takes many steps.
// The methods that it does not use are tried after 2 macro steps of IDA or CVODE, 6 more, 18 more, ...
#include "core/solve/integrator.h"

enum { ROSENBROCK, IDA, IDA_OF_ORDER_2, CVODE, METHODS };

static const bough_integrator_kind kind_of[METHODS] = {BOUGH_ROSENBROCK, BOUGH_IDA, BOUGH_IDA,
                                                       BOUGH_CVODE_BDF};

enum { ROSENBROCK_STEPS = 1000, IDA_STEPS = 60000, LEAST_IDA_STEPS = 5000 }; // most in a macro step
// In a macro step: the start of IDA costs little beside as many, and CVODE takes no more.
enum { MANY_STEPS = 100 };
enum { FIRST_WAIT = 2, LONGER = 3 }; // macro steps before the first trial; factor of each further wait
static const double most_work = 2e7; // of IDA in a macro step: steps times states
// Tolerance of IDA and CVODE, relative: their errors add up over many short steps.
static const double tighter = 0.1;
static const double cheaper = 0.7; // cost of a method that takes over from IDA, relative

typedef struct automatic {
    int n, n_method, first; // first: method after a start
    bough_integrator method[METHODS];
    int most_steps[METHODS]; // in a macro step
    int now;                 // method of the last macro step
    bool goes_on;            // it can go on without a start
    double cost;             // its cost per time there; 0: few steps of the Rosenbrock method [1/s]
    double lost;             // cost of the Rosenbrock method when no other was cheaper [1/s]
    int taken, wait;         // macro steps by `now` in a row; how many before another is tried
    int tried;               // the last of these
    double *kept;            // (n) state before a trial
} automatic;

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    automatic *m = bough_arena_take(arena, sizeof *m);
    int ida_steps = (int)fmax(LEAST_IDA_STEPS, fmin(IDA_STEPS, most_work / ode->n));
    m->n = ode->n;
    m->first = options->by_bdf ? CVODE : ROSENBROCK;
    m->n_method = options->by_bdf ? METHODS : options->coarse ? CVODE : IDA_OF_ORDER_2;
    m->kept = bough_arena_doubles(arena, (size_t)ode->n);
    for (int k = 0; k < m->n_method; k++) {
        bough_integrator_options own = *options;
        own.kind = kind_of[k];
        own.most_steps = m->most_steps[k] = k == ROSENBROCK ? ROSENBROCK_STEPS
                                            : k == CVODE    ? MANY_STEPS
                                                            : ida_steps;
        if (k == IDA || k == CVODE) own.rtol *= tighter;
        if (k == IDA_OF_ORDER_2) own.most_order = 2;
        bough_integrator_create(arena, ode, &own, &m->method[k]); // of any size
    }
    return m;
}

static bough_statistics work_of(const bough_integrator *integrator) {
    bough_statistics sum = {0};
    integrator->ops->statistics(integrator->self, &sum);
    return sum;
}

// Advances by method k from the last good step on, and finds its cost.
static bough_status take(automatic *m, int k, double *t, double t1, bool restart, double *y) {
    const bough_integrator *x = &m->method[k];
    bough_statistics before = work_of(x);
    double begun = *t;
    bough_status status = x->ops->advance(x->self, t, t1, restart, y);
    bough_statistics work = work_of(x);
    bough_statistics_add(&work, -1, &before);
    // tangents and factors take as long as two evaluations each
    double cost = (double)(work.derivatives + 2 * (work.jacobians + work.factorisations)) / (t1 - begun);
    m->cost = k != ROSENBROCK || work.steps > MANY_STEPS ? cost : 0;
    m->taken = k == m->now ? m->taken + 1 : 1;
    m->now = k;
    m->goes_on = bough_is_ok(&status);
    return status;
}

// A macro step by method k in place of the present one. False: it is not cheaper, and the state is as before.
static bool try_other(automatic *m, int k, double *t, double t1, double *y) {
    const bough_integrator *x = &m->method[k];
    const automatic present = *m;
    double begun = *t, most = m->cost * (t1 - begun); // evaluations
    if (m->now != ROSENBROCK) most *= cheaper;
    size_t size = (size_t)m->n * sizeof *y;
    memcpy(m->kept, y, size);
    x->ops->limit(x->self, (int)fmin(k == ROSENBROCK ? most / 4 : most, m->most_steps[k]));
    bough_status status = take(m, k, t, t1, true, y);
    x->ops->limit(x->self, m->most_steps[k]);
    if (bough_is_ok(&status) && m->cost * (t1 - begun) < most) return true;
    *m = present;
    m->goes_on = false; // the factors are of the other
    *t = begun;
    memcpy(y, m->kept, size);
    return false;
}

// One after another, beside IDA; beside the Rosenbrock method IDA.
static bool try_next(automatic *m, double *t, double t1, double *y) {
    bool by_ida = m->now != ROSENBROCK;
    if (by_ida) m->wait *= LONGER;
    m->tried = by_ida ? (m->tried + 1) % m->n_method : IDA;
    if (m->tried == m->now) m->tried = (m->tried + 1) % m->n_method;
    bool taken = try_other(m, m->tried, t, t1, y);
    if (m->now == ROSENBROCK) m->lost = m->cost;
    if (!taken) m->taken = 0;
    return taken;
}

static void limit_rosenbrock(automatic *m, int most_steps) {
    m->most_steps[ROSENBROCK] = most_steps;
    m->method[ROSENBROCK].ops->limit(m->method[ROSENBROCK].self, most_steps);
}

static bool is_due(const automatic *m) {
    if (m->now == ROSENBROCK) return m->cost > 2 * m->lost;
    return m->n_method > IDA_OF_ORDER_2 && m->taken >= m->wait;
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    automatic *m = self;
    if (restart) {
        m->now = m->first;
        m->tried = m->now == CVODE ? CVODE : IDA; // the Rosenbrock method is next to CVODE
        m->taken = 0;
        m->goes_on = false;
        m->cost = m->lost = 0;
        m->wait = FIRST_WAIT;
        limit_rosenbrock(m, ROSENBROCK_STEPS);
    }
    if (is_due(m) && try_next(m, t, t1, y)) return bough_ok();
    double begun = *t;
    bough_status status = take(m, m->now, t, t1, !m->goes_on, y);
    if (!bough_is_ok(&status) && m->now == CVODE) {
        *t = begun; // that of y
        status = take(m, ROSENBROCK, t, t1, true, y);
    }
    if (!bough_is_ok(&status) && m->now == ROSENBROCK) {
        begun = *t;
        status = take(m, IDA, t, t1, true, y);
    }
    if (bough_is_ok(&status)) return status;
    *t = begun;
    limit_rosenbrock(m, m->most_steps[IDA]);
    status = take(m, ROSENBROCK, t, t1, true, y);
    m->lost = m->cost;
    return status;
}

static void statistics(const void *self, bough_statistics *sum) {
    const automatic *m = self;
    for (int k = 0; k < m->n_method; k++) m->method[k].ops->statistics(m->method[k].self, sum);
}

const bough_integrator_ops bough_integrator_automatic = {
    .name = "automatic",
    .title = "Rosenbrock or IDA",
    .reads = BOUGH_METHOD_READS_STEP,
    .create = create,
    .advance = advance,
    .statistics = statistics,
};

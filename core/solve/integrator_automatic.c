// The default method: the Rosenbrock method, and IDA where it takes fewer evaluations.
// The former's steps are long where motion is slow or stiff and damped. Where stiff members vibrate without
// damping every method must follow them, and IDA then takes an evaluation a step and order 5: a tenth of the
// cost at a tenth of the tolerance. So IDA is tried after a macro step of many steps, and stays where it
// takes fewer evaluations for the same time; it also takes over where the Rosenbrock method stops.
#include "core/solve/integrator.h"

#include <math.h>

enum { ROSENBROCK_STEPS = 1000, IDA_STEPS = 60000, LEAST_IDA_STEPS = 5000 }; // most in a macro step
enum { MANY_STEPS = 100 };           // in a macro step: beside as many the start of IDA costs little
static const double most_work = 2e7; // of IDA in a macro step: steps times states
static const double tighter = 0.1;   // tolerance of IDA, relative: its errors add up over many short steps

typedef struct automatic {
    bough_integrator rosenbrock, ida;
    bool fast;   // IDA took the last macro step: its history goes on
    bool stays;  // IDA takes the next one
    double work; // evaluations of the Rosenbrock method per time, where it takes many steps; else 0 [1/s]
    double lost; // `work` when IDA last took no fewer [1/s]
} automatic;

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    automatic *m = bough_arena_take(arena, sizeof *m);
    bough_integrator_options own = *options;
    own.kind = BOUGH_ROSENBROCK;
    own.most_steps = ROSENBROCK_STEPS;
    bough_integrator_create(arena, ode, &own, &m->rosenbrock); // of any size
    own.kind = BOUGH_IDA;
    own.most_steps = (int)fmax(LEAST_IDA_STEPS, fmin(IDA_STEPS, most_work / ode->n));
    own.rtol *= tighter;
    bough_integrator_create(arena, ode, &own, &m->ida);
    return m;
}

static bough_statistics work_of(const bough_integrator *integrator) {
    bough_statistics sum = {0};
    integrator->ops->statistics(integrator->self, &sum);
    return sum;
}

// Advances from the last good step on, and counts the work of it.
static bough_status take(bough_integrator *integrator, double *t, double t1, bool restart, double *y,
                         bough_statistics *work) {
    bough_statistics before = work_of(integrator);
    bough_status status = integrator->ops->advance(integrator->self, t, t1, restart, y);
    *work = work_of(integrator);
    bough_statistics_add(work, -1, &before);
    return status;
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    automatic *m = self;
    bough_statistics work;
    double begun = *t;
    bool anew = restart || m->fast;
    if (restart) m->stays = false;
    if (restart) m->work = m->lost = 0;
    // IDA: it took the last macro step, or the Rosenbrock method took many steps
    if (m->stays || m->work > 2 * m->lost) {
        bough_status status = take(&m->ida, t, t1, !m->stays, y, &work);
        m->fast = bough_is_ok(&status);
        bool left = m->stays && !m->fast;
        // it stays if it was cheaper; otherwise twice the work is needed before the next trial
        m->stays = m->fast && (m->stays || (double)work.derivatives < m->work * (t1 - begun));
        if (!m->stays) m->lost = m->work;
        if (m->fast || left) return status;
        // it failed: the macro step is repeated
        *t = begun;
        anew = true;
    }
    // the Rosenbrock method; where it stops, IDA from there on
    bough_status stopped = take(&m->rosenbrock, t, t1, anew, y, &work);
    m->work = work.steps > MANY_STEPS ? (double)work.derivatives / (t1 - begun) : 0;
    m->fast = m->stays = !bough_is_ok(&stopped);
    if (!m->fast) return stopped;
    begun = *t;
    bough_status status = take(&m->ida, t, t1, true, y, &work);
    m->fast = m->stays = bough_is_ok(&status);
    return m->fast || *t > begun ? status : stopped;
}

static void statistics(const void *self, bough_statistics *sum) {
    const automatic *m = self;
    m->rosenbrock.ops->statistics(m->rosenbrock.self, sum);
    m->ida.ops->statistics(m->ida.self, sum);
}

const bough_integrator_ops bough_integrator_automatic = {
    .name = "automatic",
    .title = "Rosenbrock or IDA",
    .reads = BOUGH_METHOD_READS_STEP,
    .create = create,
    .advance = advance,
    .statistics = statistics,
};

// What a scene gets that names no method: the Rosenbrock method, and IDA for macro steps that it would
// cut into more than some hundreds. Its steps are long where motion is slow or stiff and damped. Where
// stiff members vibrate without damping every method must follow them, and IDA then takes an
// evaluation a step and order 5: a tenth of the cost at a tenth of the tolerance.
#include "core/integrator.h"

#include <math.h>

enum { ROSENBROCK_STEPS = 1000, IDA_STEPS = 60000, LEAST_IDA_STEPS = 5000 }; // most in a macro step
static const double most_work = 2e7; // of IDA in a macro step: steps times states
static const double share = 0.1; // of the tolerance, for IDA: its errors add up over many short steps

typedef struct automatic {
    bough_integrator rosenbrock, ida;
    bool fast; // IDA is at work, and its history goes on
} automatic;

static bough_integrator make(const bough_integrator_ops *ops, bough_arena *arena,
                             const bough_ode *ode, const bough_integrator_options *options) {
    return (bough_integrator){.ops = ops, .self = ops->create(arena, ode, options)};
}

static void *create(bough_arena *arena, const bough_ode *ode,
                    const bough_integrator_options *options) {
    automatic *m = bough_arena_take(arena, sizeof *m);
    bough_integrator_options own = *options;
    own.kind = BOUGH_ROSENBROCK;
    own.most_steps = ROSENBROCK_STEPS;
    m->rosenbrock = make(&bough_integrator_rosenbrock, arena, ode, &own);
    own.kind = BOUGH_IDA;
    own.most_steps = (int)fmax(LEAST_IDA_STEPS, fmin(IDA_STEPS, most_work / ode->n));
    own.rtol *= share;
    m->ida = make(&bough_integrator_ida, arena, ode, &own);
    return m;
}

// What stops the Rosenbrock method is left to IDA, from the last good step on.
static bough_status advance(void *self, double *t, double pause, double t1, bool restart,
                            double *y) {
    (void)pause;
    automatic *m = self;
    bough_status stopped = bough_ok();
    if (!m->fast || restart) {
        stopped = m->rosenbrock.ops->advance(m->rosenbrock.self, t, t1, t1, restart || m->fast, y);
        m->fast = !bough_is_ok(&stopped);
        if (!m->fast) return stopped;
        restart = true;
    }
    double begun = *t;
    bough_status status = m->ida.ops->advance(m->ida.self, t, t1, t1, restart, y);
    m->fast = bough_is_ok(&status);
    return m->fast || *t > begun || bough_is_ok(&stopped) ? status : stopped;
}

static void statistics(const void *self, bough_statistics *sum) {
    const automatic *m = self;
    m->rosenbrock.ops->statistics(m->rosenbrock.self, sum);
    m->ida.ops->statistics(m->ida.self, sum);
}

const bough_integrator_ops bough_integrator_automatic = {
    .name = "automatic",
    .title = "Rosenbrock or IDA",
    .create = create,
    .advance = advance,
    .statistics = statistics,
};

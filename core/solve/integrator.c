// The table of integrators.
#include "core/solve/integrator.h"

// By their kinds; scenes name a method as its operations do.
static const bough_integrator_ops *const methods[] = {
    [BOUGH_IDA] = &bough_integrator_ida,
    [BOUGH_CVODE_BDF] = &bough_integrator_cvode,
    [BOUGH_ARKODE_ESDIRK] = &bough_integrator_arkode,
    [BOUGH_RADAU5] = &bough_integrator_radau,
    [BOUGH_GENERALIZED_ALPHA] = &bough_integrator_alpha,
    [BOUGH_ROSENBROCK] = &bough_integrator_rosenbrock,
    [BOUGH_AUTOMATIC] = &bough_integrator_automatic,
};

const bough_integrator_ops *bough_integrator_find(bough_integrator_kind kind) { return methods[kind]; }

const char *bough_integrator_name(int index) {
    return index < (int)(sizeof methods / sizeof *methods) ? methods[index]->name : NULL;
}

// A dense method refuses systems beyond its size.
bough_status bough_integrator_create(bough_arena *arena, const bough_ode *ode,
                                     const bough_integrator_options *options, bough_integrator *integrator) {
    const bough_integrator_ops *ops = methods[options->kind];
    *integrator = (bough_integrator){.ops = ops};
    assert(options->rtol > 0);
    if (ops->most_states > 0 && ode->n > ops->most_states) {
        return bough_fail(BOUGH_INVALID,
                          "%s: %s works with dense matrices and suits up to %d states, not %d; "
                          "try rosenbrock",
                          ode->name, ops->title, ops->most_states, ode->n);
    }
    integrator->self = ops->create(arena, ode, options);
    return bough_ok();
}

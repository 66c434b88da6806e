// SUNDIALS ARKODE: a singly diagonally implicit Runge–Kutta method with an explicit
// first stage (ESDIRK), order 4 with error control, L-stable, with the system's own Newton solver. One
// step at a time, so that a jump of the inputs costs a start, not an order. The only user of ARKODE.
#include "core/solve/newton_handle.h"

#include <arkode/arkode_arkstep.h>

#include <string.h>

static int linear_system(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix m, SUNMatrix mass,
                         sunbooleantype jok, sunbooleantype *jcur, sunrealtype gamma, void *user, N_Vector a,
                         N_Vector b, N_Vector c) {
    (void)fy, (void)m, (void)mass, (void)a, (void)b, (void)c;
    return bough_newton_handle_system(user, t, y, jok, jcur, gamma);
}

static int restart(bough_newton_run *run, double t) {
    return ARKStepReInit(run->memory, NULL, bough_newton_handle_rate, t, run->newton.y);
}

static int step(bough_newton_run *run, double t1, double *reached) {
    return ARKStepEvolve(run->memory, t1, run->newton.y, reached, ARK_ONE_STEP);
}

static void count(void *memory, bough_statistics *sum) {
    long steps = 0, errors = 0, solves = 0, none = 0, rates = 0, iterations = 0;
    ARKStepGetNumSteps(memory, &steps);
    ARKStepGetNumErrTestFails(memory, &errors);
    ARKStepGetNumStepSolveFails(memory, &solves);
    ARKStepGetNumRhsEvals(memory, &none, &rates);
    ARKStepGetNumNonlinSolvIters(memory, &iterations);
    sum->steps += steps;
    sum->failed_steps += errors + solves;
    sum->derivatives += rates;
    sum->iterations += iterations;
}

static const bough_newton_library library = {
    .name = "ARKODE",
    .title = "ARKODE ESDIRK",
    .restart = restart,
    .stop_at = ARKStepSetStopTime,
    .step = step,
    .current_time = ARKStepGetCurrentTime,
    .count = count,
};

static void destroy(void *object) {
    bough_newton_run *run = object;
    if (run->memory != NULL) ARKStepFree(&run->memory);
    bough_newton_run_destroy(run);
}

static bool configure(bough_newton_run *run) {
    void *arkode = run->memory;
    bough_newton_handle *newton = &run->newton;
    int bad = ARKStepSetErrHandlerFn(arkode, bough_newton_handle_message, newton);
    bad |= ARKStepSetUserData(arkode, newton);
    bad |= ARKStepWFtolerances(arkode, bough_newton_handle_weights);
    bad |= ARKStepSetTableNum(arkode, ARKODE_ARK436L2SA_DIRK_6_3_4, ARKODE_ERK_NONE);
    bad |= ARKStepSetLinearSolver(arkode, newton->solver, newton->matrix);
    bad |= ARKStepSetLinSysFn(arkode, linear_system);
    // the rate of a stage is what gave its value, not f of it, which would amplify a stiff error
    bad |= ARKStepSetDeduceImplicitRhs(arkode, SUNTRUE);
    // ARKODE carries the convergence rate of exact factors over to steps of another length and
    // then stops after one iteration: a wrong stiff state without a sign. Factors are cheap.
    bad |= ARKStepSetDeltaGammaMax(arkode, 1e-9);
    return bad == 0;
}

typedef struct trial {
    int n, calls;
} trial;

static bool rate_once(void *self, double t, const double *y, double *rate) {
    (void)t, (void)y;
    trial *one = self;
    memset(rate, 0, (size_t)one->n * sizeof *rate);
    return one->calls++ == 0;
}

// ARKODE takes its memory in its first step: one that ends at the second rate, when all is taken.
static bool take_memory(bough_newton_run *run) {
    bough_newton_handle *newton = &run->newton;
    bough_ode ode = newton->ode;
    trial one = {.n = ode.n};
    double reached;
    newton->ode.self = &one;
    newton->ode.derivative = rate_once;
    int flag = ARKStepEvolve(run->memory, 1, newton->y, &reached, ARK_ONE_STEP);
    newton->ode = ode;
    newton->text[0] = '\0';
    return flag < 0 && flag != ARK_MEM_FAIL && one.calls > 1;
}

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    bough_newton_run *run = bough_newton_run_create(arena, ode, options->rtol, &library, destroy);
    bough_newton_handle *newton = &run->newton;
    run->memory = ARKStepCreate(NULL, bough_newton_handle_rate, 0, newton->y, newton->context);
    if (run->memory == NULL || !configure(run) || !take_memory(run)) bough_arena_leave(arena);
    return run;
}

const bough_integrator_ops bough_integrator_arkode = {
    .name = "arkode-esdirk",
    .title = "ARKODE ESDIRK",
    .create = create,
    .advance = bough_newton_run_advance,
    .statistics = bough_newton_run_statistics,
};

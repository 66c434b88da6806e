// SUNDIALS ARKODE: a singly diagonally implicit Runge–Kutta method with an explicit
// first stage (ESDIRK), order 4 with error control, L-stable, with the system's own Newton solver. One
// step at a time, so that a jump of the inputs costs a start, not an order. The only user of ARKODE.
#include "core/newton_handle.h"
#include "core/vector.h"

#include <arkode/arkode_arkstep.h>

#include <string.h>

typedef struct arkode_run {
    bough_newton_handle newton;
    void *arkode;
    bool started;
    bough_statistics past; // of the integrations before the last restart
} arkode_run;

static int linear_system(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix m, SUNMatrix mass,
                         sunbooleantype jok, sunbooleantype *jcur, sunrealtype gamma, void *user,
                         N_Vector a, N_Vector b, N_Vector c) {
    (void)fy, (void)m, (void)mass, (void)a, (void)b, (void)c;
    return bough_newton_handle_system(user, t, y, jok, jcur, gamma);
}

// -- life -----------------------------------------------------------------------------------------

static void destroy(void *object) {
    arkode_run *run = object;
    if (run->arkode != NULL) ARKStepFree(&run->arkode);
    bough_newton_handle_destroy(&run->newton);
}

enum { MOST_STEPS = 20000 }; // per macro step, as of the other sub-solvers

static bool configure(arkode_run *run) {
    void *arkode = run->arkode;
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
static bool take_memory(arkode_run *run) {
    bough_newton_handle *newton = &run->newton;
    bough_ode ode = newton->ode;
    trial one = {.n = ode.n};
    double reached;
    newton->ode.self = &one;
    newton->ode.derivative = rate_once;
    int flag = ARKStepEvolve(run->arkode, 1, newton->y, &reached, ARK_ONE_STEP);
    newton->ode = ode;
    newton->text[0] = '\0';
    return flag < 0 && flag != ARK_MEM_FAIL && one.calls > 1;
}

static void *create(bough_arena *arena, const bough_ode *ode,
                    const bough_integrator_options *options) {
    arkode_run *m = bough_arena_take(arena, sizeof *m);
    bough_arena_on_destroy(arena, destroy, m);
    bough_newton_handle *newton = &m->newton;
    if (!bough_newton_handle_create(newton, ode, options->rtol)) bough_arena_leave(arena);
    m->arkode = ARKStepCreate(NULL, bough_newton_handle_rate, 0, newton->y, newton->context);
    if (m->arkode == NULL || !configure(m) || !take_memory(m)) bough_arena_leave(arena);
    return m;
}

// -- steps ----------------------------------------------------------------------------------------

static void collect(const arkode_run *run, bough_statistics *sum) {
    long steps = 0, errors = 0, solves = 0, none = 0, rates = 0, iterations = 0;
    ARKStepGetNumSteps(run->arkode, &steps);
    ARKStepGetNumErrTestFails(run->arkode, &errors);
    ARKStepGetNumStepSolveFails(run->arkode, &solves);
    ARKStepGetNumRhsEvals(run->arkode, &none, &rates);
    ARKStepGetNumNonlinSolvIters(run->arkode, &iterations);
    sum->steps += steps;
    sum->failed_steps += errors + solves;
    sum->derivatives += rates;
    sum->iterations += iterations;
}

static bough_status start(arkode_run *run, double t) {
    bough_newton_handle *newton = &run->newton;
    if (run->started) collect(run, &run->past); // ARKODE's counters restart from zero
    int flag = ARKStepReInit(run->arkode, NULL, bough_newton_handle_rate, t, newton->y);
    if (flag != ARK_SUCCESS) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: ARKODE cannot start: %s",
                          newton->ode.name, t, newton->text);
    }
    if (run->started) run->past.restarts++;
    run->started = true;
    return bough_ok();
}

static const char *reason(const bough_newton_handle *newton, int flag) {
    // ever smaller steps towards a state without forces end in several ways
    if (newton->refused) flag = ARK_RHSFUNC_FAIL;
    switch (flag) {
    case ARK_TOO_MUCH_WORK: return "it took 20000 steps in one macro step";
    case ARK_TOO_MUCH_ACC: return "the tolerance is below rounding error";
    case ARK_ERR_FAILURE: return "the error test failed down to the smallest step";
    case ARK_CONV_FAILURE: return "Newton's method did not converge down to the smallest step";
    case ARK_LSETUP_FAIL:
    case ARK_LSOLVE_FAIL: return "the Newton matrix is singular";
    case ARK_RHSFUNC_FAIL:
    case ARK_FIRST_RHSFUNC_ERR:
    case ARK_REPTD_RHSFUNC_ERR:
    case ARK_UNREC_RHSFUNC_ERR:
        return "the deformation has no finite forces (a segment turned by more than 120°, or a"
               " value overflowed)";
    default: return newton->text[0] ? newton->text : "ARKODE gave up";
    }
}

static bough_status advance(void *self, double *t, double pause, double t1, bool restart,
                            double *y) {
    (void)pause;
    arkode_run *run = self;
    bough_newton_handle *newton = &run->newton;
    double *own = bough_vector_data(newton->y), reached = *t;
    memcpy(own, y, (size_t)newton->ode.n * sizeof *own);
    if (restart || !run->started) {
        bough_status status = start(run, *t);
        if (!bough_is_ok(&status)) return status;
    }
    newton->refused = false;
    ARKStepSetStopTime(run->arkode, t1);
    int flag = ARK_SUCCESS;
    // one step a call: the interpolant of a call to the end may miss a stiff state there
    for (int n = 0; flag >= 0 && reached < t1; n++) {
        flag = n == MOST_STEPS ? ARK_TOO_MUCH_WORK
                               : ARKStepEvolve(run->arkode, t1, newton->y, &reached,
                                               ARK_ONE_STEP);
    }
    if (flag < 0) {
        ARKStepGetCurrentTime(run->arkode, &reached);
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: ARKODE ESDIRK cannot go on: %s",
                          newton->ode.name, reached, reason(newton, flag));
    }
    *t = t1;
    memcpy(y, own, (size_t)newton->ode.n * sizeof *own);
    return bough_ok();
}

static void statistics(const void *self, bough_statistics *sum) {
    const arkode_run *run = self;
    bough_statistics_add(sum, &run->past);
    sum->jacobians += run->newton.jacobians;
    sum->factorisations += run->newton.factorisations;
    if (run->started) collect(run, sum);
}

const bough_integrator_ops bough_integrator_arkode = {
    .name = "arkode-esdirk",
    .title = "ARKODE ESDIRK",
    .create = create,
    .advance = advance,
    .statistics = statistics,
};

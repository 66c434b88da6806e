// SUNDIALS CVODE (variable-order BDF) with the system's own Newton solver.
#include "core/solve/newton_handle.h"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>

static int linear_system(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix m, sunbooleantype jok,
                         sunbooleantype *jcur, sunrealtype gamma, void *user, N_Vector a, N_Vector b,
                         N_Vector c) {
    (void)fy, (void)m, (void)a, (void)b, (void)c;
    return bough_newton_handle_system(user, t, y, jok, jcur, gamma);
}

static void count(void *memory, bough_statistics *sum) {
    long steps, rhs, setups, failed, iterations, convergence;
    int last, next;
    double first, previous, h, now;
    CVodeGetIntegratorStats(memory, &steps, &rhs, &setups, &failed, &last, &next, &first, &previous, &h,
                            &now);
    CVodeGetNonlinSolvStats(memory, &iterations, &convergence);
    sum->steps += steps;
    sum->derivatives += rhs;
    sum->failed_steps += failed + convergence;
    sum->iterations += iterations;
}

static int restart(bough_newton_run *run, double t) { return CVodeReInit(run->memory, t, run->newton.y); }

static int step(bough_newton_run *run, double t1, double *reached) {
    return CVode(run->memory, t1, run->newton.y, reached, CV_ONE_STEP);
}

static const bough_newton_library library = {
    .name = "CVODE",
    .title = "CVODE BDF",
    .restart = restart,
    .stop_at = CVodeSetStopTime,
    .step = step,
    .current_time = CVodeGetCurrentTime,
    .count = count,
};

static void destroy(void *object) {
    bough_newton_run *run = object;
    if (run->memory != NULL) CVodeFree(&run->memory);
    bough_newton_run_destroy(run);
}

static bool configure(bough_newton_run *run) {
    void *cvode = run->memory;
    bough_newton_handle *newton = &run->newton;
    int bad = CVodeSetErrHandlerFn(cvode, bough_newton_handle_message, newton);
    bad |= CVodeInit(cvode, bough_newton_handle_rate, 0, newton->y);
    bad |= CVodeSetUserData(cvode, newton);
    bad |= CVodeWFtolerances(cvode, bough_newton_handle_weights);
    bad |= CVodeSetLinearSolver(cvode, newton->solver, newton->matrix);
    bad |= CVodeSetLinSysFn(cvode, linear_system);
    // a looser corrector costs no accuracy here and saves a fifth of the time
    bad |= CVodeSetNonlinConvCoef(cvode, 0.3);
    return bad == 0;
}

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    bough_newton_run *run = bough_newton_run_create(arena, ode, options->rtol, &library, destroy);
    run->memory = CVodeCreate(CV_BDF, run->newton.context);
    if (run->memory == NULL || !configure(run)) bough_arena_leave(arena);
    return run;
}

const bough_integrator_ops bough_integrator_cvode = {
    .name = "cvode-bdf",
    .title = "CVODE BDF",
    .create = create,
    .advance = bough_newton_run_advance,
    .statistics = bough_newton_run_statistics,
};

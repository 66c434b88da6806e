// SUNDIALS CVODE (variable-order BDF) with the system's own Newton solver. The only
// user of CVODE.
#include "core/newton_handle.h"
#include "core/vector.h"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>

#include <string.h>

typedef struct cvode_run {
    bough_newton_handle newton;
    void *cvode;
    bool started;
    double *own_error;     // (n)
    N_Vector step_error;   // (n)
    bough_statistics past; // of the integrations before the last restart
} cvode_run;

static int linear_system(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix m, sunbooleantype jok,
                         sunbooleantype *jcur, sunrealtype gamma, void *user, N_Vector a,
                         N_Vector b, N_Vector c) {
    (void)fy, (void)m, (void)a, (void)b, (void)c;
    return bough_newton_handle_system(user, t, y, jok, jcur, gamma);
}

// -- life -----------------------------------------------------------------------------------------

static void destroy(void *object) {
    cvode_run *run = object;
    if (run->cvode != NULL) CVodeFree(&run->cvode);
    if (run->step_error != NULL) N_VDestroy(run->step_error);
    bough_newton_handle_destroy(&run->newton);
}

enum { MOST_STEPS = 20000 }; // per macro step; CVODE's own 500 would stop a long macro step

static bool configure(cvode_run *run) {
    void *cvode = run->cvode;
    bough_newton_handle *newton = &run->newton;
    int bad = CVodeSetErrHandlerFn(cvode, bough_newton_handle_message, newton);
    bad |= CVodeInit(cvode, bough_newton_handle_rate, 0, newton->y);
    bad |= CVodeSetUserData(cvode, newton);
    bad |= CVodeWFtolerances(cvode, bough_newton_handle_weights);
    bad |= CVodeSetLinearSolver(cvode, newton->solver, newton->matrix);
    bad |= CVodeSetLinSysFn(cvode, linear_system);
    bad |= CVodeSetMaxNumSteps(cvode, MOST_STEPS);
    // a looser corrector costs no accuracy here and saves a fifth of the time
    bad |= CVodeSetNonlinConvCoef(cvode, 0.3);
    return bad == 0;
}

static void *create(bough_arena *arena, const bough_ode *ode,
                    const bough_integrator_options *options) {
    cvode_run *m = bough_arena_take(arena, sizeof *m);
    bough_arena_on_destroy(arena, destroy, m);
    m->own_error = bough_arena_doubles(arena, (size_t)ode->n);
    if (!bough_newton_handle_create(&m->newton, ode, options->rtol)) bough_arena_leave(arena);
    m->cvode = CVodeCreate(CV_BDF, m->newton.context);
    m->step_error = bough_vector_create(ode->n, m->newton.context);
    if (m->cvode == NULL || m->step_error == NULL || !configure(m)) bough_arena_leave(arena);
    return m;
}

// -- steps ----------------------------------------------------------------------------------------

static void collect(const cvode_run *run, bough_statistics *s) {
    long steps, rhs, setups, failed, iterations, convergence;
    int last, next;
    double first, previous, h, now;
    CVodeGetIntegratorStats(run->cvode, &steps, &rhs, &setups, &failed, &last, &next, &first,
                            &previous, &h, &now);
    CVodeGetNonlinSolvStats(run->cvode, &iterations, &convergence);
    s->steps += steps;
    s->derivatives += rhs;
    s->failed_steps += failed + convergence;
    s->iterations += iterations;
}

static bough_status start(cvode_run *run, double t) {
    if (run->started) collect(run, &run->past); // CVODE's counters restart from zero
    if (CVodeReInit(run->cvode, t, run->newton.y) != CV_SUCCESS) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: CVODE cannot start: %s",
                          run->newton.ode.name, t, run->newton.text);
    }
    if (run->started) run->past.restarts++;
    run->started = true;
    return bough_ok();
}

static const char *reason(const cvode_run *run, int flag) {
    // ever smaller steps towards a state without forces end as too much work
    if (flag == CV_TOO_MUCH_WORK && run->newton.refused) flag = CV_RHSFUNC_FAIL;
    switch (flag) {
    case CV_TOO_MUCH_WORK: return "it took 20000 steps in one macro step";
    case CV_TOO_MUCH_ACC: return "the tolerance is below rounding error";
    case CV_ERR_FAILURE: return "the error test failed down to the smallest step";
    case CV_CONV_FAILURE: return "Newton's method did not converge down to the smallest step";
    case CV_LSETUP_FAIL:
    case CV_LSOLVE_FAIL: return "the Newton matrix is singular";
    case CV_RHSFUNC_FAIL:
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
        return "the deformation has no finite forces (a segment turned by more than 120°, or a"
               " value overflowed)";
    default: return run->newton.text[0] ? run->newton.text : "CVODE gave up";
    }
}

// All steps to t1, CVODE's to the last bit, with their local errors.
static int cross(cvode_run *run, double t1, double *reached) {
    int n = run->newton.ode.n, flag = CV_SUCCESS;
    const double *error = bough_vector_data(run->step_error);
    for (int k = 0; flag >= 0 && *reached < t1; k++) {
        if (k == MOST_STEPS) return CV_TOO_MUCH_WORK;
        flag = CVode(run->cvode, t1, run->newton.y, reached, CV_ONE_STEP);
        if (flag < 0 || CVodeGetEstLocalErrors(run->cvode, run->step_error) != 0) break;
        for (int i = 0; i < n; i++) run->own_error[i] += error[i];
    }
    return flag;
}

static bough_status advance(void *self, double *t, double pause, double t1, bool restart,
                            double *y) {
    (void)pause;
    cvode_run *run = self;
    double *own = bough_vector_data(run->newton.y), reached = *t;
    memcpy(own, y, (size_t)run->newton.ode.n * sizeof *own);
    if (restart || !run->started) {
        bough_status status = start(run, *t);
        if (!bough_is_ok(&status)) return status;
    }
    run->newton.refused = false;
    CVodeSetStopTime(run->cvode, t1);
    int flag = cross(run, t1, &reached);
    if (flag < 0) {
        CVodeGetCurrentTime(run->cvode, &reached);
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: CVODE BDF cannot go on: %s",
                          run->newton.ode.name, reached, reason(run, flag));
    }
    *t = t1;
    memcpy(y, own, (size_t)run->newton.ode.n * sizeof *own);
    return bough_ok();
}

static void statistics(const void *self, bough_statistics *sum) {
    const cvode_run *run = self;
    bough_statistics_add(sum, &run->past);
    sum->jacobians += run->newton.jacobians;
    sum->factorisations += run->newton.factorisations;
    if (run->started) collect(run, sum);
}

static double *own_error(void *self) {
    cvode_run *run = self;
    return run->own_error;
}

const bough_integrator_ops bough_integrator_cvode = {
    .name = "cvode-bdf",
    .title = "CVODE BDF",
    .create = create,
    .advance = advance,
    .statistics = statistics,
    .own_error = own_error,
};

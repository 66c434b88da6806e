#include "flexbody/micro_cvode.h"

#include "core/vector.h"
#include "flexbody/newton_handle.h"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>

#include <string.h>

struct bough_micro_cvode {
    bough_newton_handle newton;
    void *cvode;
    bool started;
    double *own_error;     // (n)
    N_Vector step_error;   // (n)
    bough_statistics past; // of the integrations before the last restart
};

static int linear_system(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix m, sunbooleantype jok,
                         sunbooleantype *jcur, sunrealtype gamma, void *user, N_Vector a,
                         N_Vector b, N_Vector c) {
    (void)fy, (void)m, (void)a, (void)b, (void)c;
    return bough_newton_handle_system(user, t, y, jok, jcur, gamma);
}

// -- life -----------------------------------------------------------------------------------------

static void destroy(void *object) {
    bough_micro_cvode *micro = object;
    if (micro->cvode != NULL) CVodeFree(&micro->cvode);
    if (micro->step_error != NULL) N_VDestroy(micro->step_error);
    bough_newton_handle_destroy(&micro->newton);
}

enum { MOST_STEPS = 20000 }; // per macro step; CVODE's own 500 would stop a long macro step

static bool configure(bough_micro_cvode *micro) {
    void *cvode = micro->cvode;
    bough_newton_handle *newton = &micro->newton;
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

bough_status bough_micro_cvode_create(bough_arena *arena, const bough_ode *ode,
                                      const double *scale, double rtol,
                                      bough_micro_cvode **micro) {
    bough_micro_cvode *m = bough_arena_take(arena, sizeof *m);
    if (m == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: out of memory", ode->name);
    bough_arena_on_destroy(arena, destroy, m);
    m->own_error = bough_arena_doubles(arena, (size_t)ode->n);
    bool ok = !bough_arena_exhausted(arena) &&
              bough_newton_handle_create(&m->newton, ode, scale, rtol);
    if (ok) m->cvode = CVodeCreate(CV_BDF, m->newton.context);
    if (ok) m->step_error = bough_vector_create(ode->n, m->newton.context);
    if (!ok || m->cvode == NULL || m->step_error == NULL) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: out of memory for CVODE", ode->name);
    }
    if (!configure(m)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: no memory for CVODE: %s", ode->name,
                          m->newton.text);
    }
    *micro = m;
    return bough_ok();
}

// -- steps ----------------------------------------------------------------------------------------

static void collect(const bough_micro_cvode *micro, bough_statistics *s) {
    long steps, rhs, setups, failed, iterations, convergence;
    int last, next;
    double first, previous, h, now;
    CVodeGetIntegratorStats(micro->cvode, &steps, &rhs, &setups, &failed, &last, &next, &first,
                            &previous, &h, &now);
    CVodeGetNonlinSolvStats(micro->cvode, &iterations, &convergence);
    s->steps += steps;
    s->derivatives += rhs;
    s->failed_steps += failed + convergence;
    s->iterations += iterations;
}

static bough_status start(bough_micro_cvode *micro, double t) {
    if (micro->started) collect(micro, &micro->past); // CVODE's counters restart from zero
    if (CVodeReInit(micro->cvode, t, micro->newton.y) != CV_SUCCESS) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: CVODE cannot start: %s",
                          micro->newton.ode.name, t, micro->newton.text);
    }
    if (micro->started) micro->past.restarts++;
    micro->started = true;
    return bough_ok();
}

static const char *reason(const bough_micro_cvode *micro, int flag) {
    // ever smaller steps towards a state without forces end as too much work
    if (flag == CV_TOO_MUCH_WORK && micro->newton.refused) flag = CV_RHSFUNC_FAIL;
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
    default: return micro->newton.text[0] ? micro->newton.text : "CVODE gave up";
    }
}

// All steps to t1, CVODE's to the last bit, with their local errors.
static int cross(bough_micro_cvode *micro, double t1, double *reached) {
    int n = micro->newton.ode.n, flag = CV_SUCCESS;
    const double *error = bough_vector_data(micro->step_error);
    for (int k = 0; flag >= 0 && *reached < t1; k++) {
        if (k == MOST_STEPS) return CV_TOO_MUCH_WORK;
        flag = CVode(micro->cvode, t1, micro->newton.y, reached, CV_ONE_STEP);
        if (flag < 0 || CVodeGetEstLocalErrors(micro->cvode, micro->step_error) != 0) break;
        for (int i = 0; i < n; i++) micro->own_error[i] += error[i];
    }
    return flag;
}

double *bough_micro_cvode_error(const bough_micro_cvode *micro) {
    return micro != NULL ? micro->own_error : NULL;
}

bough_status bough_micro_cvode_advance(bough_micro_cvode *micro, double t, double t1, bool restart,
                                       double *y) {
    double *own = bough_vector_data(micro->newton.y), reached = t;
    memcpy(own, y, (size_t)micro->newton.ode.n * sizeof *own);
    if (restart || !micro->started) {
        bough_status status = start(micro, t);
        if (!bough_is_ok(&status)) return status;
    }
    micro->newton.refused = false;
    CVodeSetStopTime(micro->cvode, t1);
    int flag = cross(micro, t1, &reached);
    if (flag < 0) {
        CVodeGetCurrentTime(micro->cvode, &reached);
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: CVODE BDF cannot go on: %s",
                          micro->newton.ode.name, reached, reason(micro, flag));
    }
    memcpy(y, own, (size_t)micro->newton.ode.n * sizeof *own);
    return bough_ok();
}

void bough_micro_cvode_statistics(const bough_micro_cvode *micro, bough_statistics *sum) {
    bough_statistics_add(sum, &micro->past);
    sum->jacobians += micro->newton.jacobians;
    sum->factorisations += micro->newton.factorisations;
    if (micro->started) collect(micro, sum);
}

#include "flexbody/micro_cvode.h"

#include "core/vector.h"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

struct bough_micro_cvode {
    bough_ode ode;
    SUNContext context;
    N_Vector y, weight;
    SUNMatrix matrix; // a handle only: the body keeps its own blocks
    SUNLinearSolver solver;
    void *cvode;
    double gamma;
    bool started;
    bool refused; // f had no value somewhere during the last advance
    char text[200]; // CVODE's last complaint
    bough_statistics past; // of the integrations before the last restart
};

// -- the handles CVODE wants ----------------------------------------------------------------------

static SUNMatrix_ID matrix_id(SUNMatrix a) {
    (void)a;
    return SUNMATRIX_CUSTOM;
}

static SUNMatrix matrix_create(bough_micro_cvode *micro);

static SUNMatrix matrix_clone(SUNMatrix a) {
    return matrix_create(a->content);
}

static void matrix_destroy(SUNMatrix a) {
    SUNMatFreeEmpty(a);
}

static SUNMatrix matrix_create(bough_micro_cvode *micro) {
    SUNMatrix a = SUNMatNewEmpty(micro->context);
    if (a == NULL) return NULL;
    a->content = micro;
    a->ops->getid = matrix_id;
    a->ops->clone = matrix_clone;
    a->ops->destroy = matrix_destroy;
    return a;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver s) {
    (void)s;
    return SUNLINEARSOLVER_DIRECT;
}

static int solver_setup(SUNLinearSolver s, SUNMatrix a) {
    (void)a;
    bough_micro_cvode *micro = s->content;
    micro->past.factorisations++;
    return micro->ode.factor(micro->ode.self, micro->gamma) ? 0 : 1;
}

static int solver_solve(SUNLinearSolver s, SUNMatrix a, N_Vector x, N_Vector b, sunrealtype tol) {
    (void)a;
    (void)tol;
    bough_micro_cvode *micro = s->content;
    if (x != b) N_VScale(1.0, b, x);
    micro->ode.solve(micro->ode.self, bough_vector_data(x));
    return 0;
}

static int solver_free(SUNLinearSolver s) {
    SUNLinSolFreeEmpty(s);
    return 0;
}

static SUNLinearSolver solver_create(bough_micro_cvode *micro) {
    SUNLinearSolver s = SUNLinSolNewEmpty(micro->context);
    if (s == NULL) return NULL;
    s->content = micro;
    s->ops->gettype = solver_type;
    s->ops->setup = solver_setup;
    s->ops->solve = solver_solve;
    s->ops->free = solver_free;
    return s;
}

// -- callbacks ------------------------------------------------------------------------------------

static int right_hand_side(sunrealtype t, N_Vector y, N_Vector rate, void *user) {
    bough_micro_cvode *micro = user;
    bool ok = micro->ode.derivative(micro->ode.self, t, bough_vector_data(y),
                                    bough_vector_data(rate));
    micro->refused = micro->refused || !ok;
    return ok ? 0 : 1;
}

static int linear_system(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix m, sunbooleantype jok,
                         sunbooleantype *jcur, sunrealtype gamma, void *user, N_Vector a,
                         N_Vector b, N_Vector c) {
    (void)fy, (void)m, (void)a, (void)b, (void)c;
    bough_micro_cvode *micro = user;
    micro->gamma = gamma;
    *jcur = !jok;
    if (jok) return 0;
    micro->past.jacobians++;
    return micro->ode.linearise(micro->ode.self, t, bough_vector_data(y)) ? 0 : 1;
}

static int constant_weights(N_Vector y, N_Vector weight, void *user) {
    (void)y;
    const bough_micro_cvode *micro = user;
    N_VScale(1.0, micro->weight, weight);
    return 0;
}

static void keep_message(int code, const char *module, const char *function, char *message,
                         void *user) {
    (void)module, (void)function;
    bough_micro_cvode *micro = user;
    if (code < 0) snprintf(micro->text, sizeof micro->text, "%s", message);
}

// -- life -----------------------------------------------------------------------------------------

static void destroy(void *object) {
    bough_micro_cvode *micro = object;
    if (micro->cvode != NULL) CVodeFree(&micro->cvode);
    if (micro->solver != NULL) SUNLinSolFree(micro->solver);
    if (micro->matrix != NULL) SUNMatDestroy(micro->matrix);
    if (micro->y != NULL) N_VDestroy(micro->y);
    if (micro->weight != NULL) N_VDestroy(micro->weight);
    if (micro->context != NULL) SUNContext_Free(&micro->context);
}

static bool create_parts(bough_micro_cvode *micro) {
    if (SUNContext_Create(NULL, &micro->context) != 0) return false;
    micro->y = bough_vector_create(micro->ode.n, micro->context);
    micro->weight = bough_vector_create(micro->ode.n, micro->context);
    micro->matrix = matrix_create(micro);
    micro->solver = solver_create(micro);
    micro->cvode = CVodeCreate(CV_BDF, micro->context);
    return micro->y != NULL && micro->weight != NULL && micro->matrix != NULL &&
           micro->solver != NULL && micro->cvode != NULL;
}

enum { MOST_STEPS = 20000 }; // per macro step; CVODE's own 500 would stop a long macro step

static bool configure(bough_micro_cvode *micro) {
    void *cvode = micro->cvode;
    int bad = CVodeSetErrHandlerFn(cvode, keep_message, micro);
    bad |= CVodeInit(cvode, right_hand_side, 0, micro->y);
    bad |= CVodeSetUserData(cvode, micro);
    bad |= CVodeWFtolerances(cvode, constant_weights);
    bad |= CVodeSetLinearSolver(cvode, micro->solver, micro->matrix);
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
    m->ode = *ode;
    bough_arena_on_destroy(arena, destroy, m);
    if (bough_arena_exhausted(arena) || !create_parts(m)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: out of memory for CVODE", ode->name);
    }
    double *weight = bough_vector_data(m->weight);
    for (int i = 0; i < ode->n; i++) weight[i] = 1 / (rtol * scale[i]);
    if (!configure(m)) {
        return bough_fail(BOUGH_FAILED, "%s: CVODE cannot be set up: %s", ode->name, m->text);
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
    if (CVodeReInit(micro->cvode, t, micro->y) != CV_SUCCESS) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: CVODE cannot start: %s",
                          micro->ode.name, t, micro->text);
    }
    if (micro->started) micro->past.restarts++;
    micro->started = true;
    return bough_ok();
}

static const char *reason(const bough_micro_cvode *micro, int flag) {
    // ever smaller steps towards a state without forces end as too much work
    if (flag == CV_TOO_MUCH_WORK && micro->refused) flag = CV_RHSFUNC_FAIL;
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
    default: return micro->text[0] ? micro->text : "CVODE gave up";
    }
}

bough_status bough_micro_cvode_advance(bough_micro_cvode *micro, double t, double t1, bool restart,
                                       double *y) {
    double *own = bough_vector_data(micro->y), reached = t;
    memcpy(own, y, (size_t)micro->ode.n * sizeof *own);
    if (restart || !micro->started) {
        bough_status status = start(micro, t);
        if (!bough_is_ok(&status)) return status;
    }
    micro->refused = false;
    CVodeSetStopTime(micro->cvode, t1);
    int flag = CVode(micro->cvode, t1, micro->y, &reached, CV_NORMAL);
    if (flag < 0) {
        CVodeGetCurrentTime(micro->cvode, &reached);
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: CVODE BDF cannot go on: %s",
                          micro->ode.name, reached, reason(micro, flag));
    }
    memcpy(y, own, (size_t)micro->ode.n * sizeof *own);
    return bough_ok();
}

void bough_micro_cvode_statistics(const bough_micro_cvode *micro, bough_statistics *sum) {
    sum->jacobians += micro->past.jacobians;
    sum->factorisations += micro->past.factorisations;
    sum->restarts += micro->past.restarts;
    sum->steps += micro->past.steps;
    sum->derivatives += micro->past.derivatives;
    sum->failed_steps += micro->past.failed_steps;
    sum->iterations += micro->past.iterations;
    if (micro->started) collect(micro, sum);
}

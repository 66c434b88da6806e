#include "core/solve/newton_handle.h"

#include "core/solve/vector.h"

#include <cvode/cvode.h>
#include <stdio.h>
#include <string.h>

static SUNMatrix_ID matrix_id(SUNMatrix a) {
    (void)a;
    return SUNMATRIX_CUSTOM;
}

static int matrix_zero(SUNMatrix a) {
    (void)a;
    return 0;
}

static SUNMatrix matrix_create(bough_newton_handle *handle);

static SUNMatrix matrix_clone(SUNMatrix a) { return matrix_create(a->content); }

static void matrix_destroy(SUNMatrix a) { SUNMatFreeEmpty(a); }

static SUNMatrix matrix_create(bough_newton_handle *handle) {
    SUNMatrix a = SUNMatNewEmpty(handle->context);
    if (a == NULL) return NULL;
    a->content = handle;
    a->ops->getid = matrix_id;
    a->ops->zero = matrix_zero;
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
    bough_newton_handle *handle = s->content;
    handle->factorisations++;
    return handle->ode.factor(handle->ode.self, handle->gamma) ? 0 : 1;
}

static int solver_solve(SUNLinearSolver s, SUNMatrix a, N_Vector x, N_Vector b, sunrealtype tol) {
    (void)a;
    (void)tol;
    bough_newton_handle *handle = s->content;
    if (handle->scaled) {
        N_VScale(handle->gamma, b, x);
    } else if (x != b) {
        N_VScale(1.0, b, x);
    }
    handle->ode.solve(handle->ode.self, bough_vector_data(x));
    return 0;
}

static int solver_free(SUNLinearSolver s) {
    SUNLinSolFreeEmpty(s);
    return 0;
}

static SUNLinearSolver solver_create(bough_newton_handle *handle) {
    SUNLinearSolver s = SUNLinSolNewEmpty(handle->context);
    if (s == NULL) return NULL;
    s->content = handle;
    s->ops->gettype = solver_type;
    s->ops->setup = solver_setup;
    s->ops->solve = solver_solve;
    s->ops->free = solver_free;
    return s;
}

bool bough_newton_handle_create(bough_newton_handle *handle, const bough_ode *ode, double rtol) {
    handle->ode = *ode;
    if (!bough_vector_room(ode->n)) return false;
    if (SUNContext_Create(NULL, &handle->context) != 0) return false;
    handle->y = bough_vector_create(ode->n, handle->context);
    handle->weight = bough_vector_create(ode->n, handle->context);
    handle->matrix = matrix_create(handle);
    handle->solver = solver_create(handle);
    bool ok = handle->y != NULL && handle->weight != NULL && handle->matrix != NULL && handle->solver != NULL;
    if (!ok) return false;
    double *weight = bough_vector_data(handle->weight);
    for (int i = 0; i < ode->n; i++) weight[i] = 1 / (rtol * ode->scale[i]);
    return true;
}

void bough_newton_handle_destroy(bough_newton_handle *handle) {
    if (handle->solver != NULL) SUNLinSolFree(handle->solver);
    if (handle->matrix != NULL) SUNMatDestroy(handle->matrix);
    if (handle->y != NULL) N_VDestroy(handle->y);
    if (handle->weight != NULL) N_VDestroy(handle->weight);
    if (handle->context != NULL) SUNContext_Free(&handle->context);
}

int bough_newton_handle_rate(sunrealtype t, N_Vector y, N_Vector rate, void *user) {
    bough_newton_handle *handle = user;
    bool ok = handle->ode.derivative(handle->ode.self, t, bough_vector_data(y), bough_vector_data(rate));
    handle->refused = handle->refused || !ok;
    return ok ? 0 : 1;
}

int bough_newton_handle_weights(N_Vector y, N_Vector weight, void *user) {
    (void)y;
    const bough_newton_handle *handle = user;
    N_VScale(1.0, handle->weight, weight);
    return 0;
}

void bough_newton_handle_message(int code, const char *module, const char *function, char *message,
                                 void *user) {
    (void)module, (void)function;
    bough_newton_handle *handle = user;
    if (code < 0) snprintf(handle->text, sizeof handle->text, "%s", message);
}

int bough_newton_handle_system(bough_newton_handle *handle, double t, N_Vector y, sunbooleantype jok,
                               sunbooleantype *jcur, double gamma) {
    handle->gamma = gamma;
    *jcur = !jok;
    if (jok) return 0;
    handle->jacobians++;
    return handle->ode.linearise(handle->ode.self, t, bough_vector_data(y)) ? 0 : 1;
}

// -- integrators that take one step a call --------------------------------------------------------

enum { MOST_STEPS = 20000 };

bough_newton_run *bough_newton_run_create(bough_arena *arena, const bough_ode *ode, double rtol,
                                          const bough_newton_library *library, void (*destroy)(void *run)) {
    bough_newton_run *run = bough_arena_take(arena, sizeof *run);
    bough_arena_on_destroy(arena, destroy, run);
    run->library = library;
    run->most_steps = MOST_STEPS;
    if (!bough_newton_handle_create(&run->newton, ode, rtol)) bough_arena_leave(arena);
    run->beside = bough_vector_create(ode->n, run->newton.context);
    if (run->beside == NULL) bough_arena_leave(arena);
    return run;
}

void bough_newton_run_destroy(bough_newton_run *run) {
    if (run->beside != NULL) N_VDestroy(run->beside);
    bough_newton_handle_destroy(&run->newton);
}

static bough_status start(bough_newton_run *run, double t) {
    const bough_newton_handle *newton = &run->newton;
    if (run->started) run->library->count(run->memory, &run->past); // counters restart from zero
    run->started = run->library->restart(run, t) == CV_SUCCESS;
    if (!run->started) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: %s cannot start: %s", newton->ode.name, t,
                          run->library->name, newton->text);
    }
    run->past.starts++;
    return bough_ok();
}

static const char *reason(bough_newton_run *run, int flag) {
    bough_newton_handle *newton = &run->newton;
    // ever smaller steps towards a state without forces end in several ways
    if (newton->refused) flag = CV_RHSFUNC_FAIL;
    switch (flag) {
    case CV_TOO_MUCH_WORK:
        snprintf(newton->text, sizeof newton->text,
                 "%d steps do not reach the end of the macro step: it follows vibrations that fast, which"
                 " damping of rods or a larger rtol would end",
                 run->most_steps);
        return newton->text;
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
    default: return newton->text[0] ? newton->text : "it gave up";
    }
}

// All steps to t1, the integrator's to the last bit. One step a call: the
// interpolant of a call to the end may miss a stiff state there.
static int cross(bough_newton_run *run, double t1, double *reached) {
    const bough_newton_library *library = run->library;
    int flag = CV_SUCCESS;
    for (int k = 0; flag >= 0 && *reached < t1; k++) {
        if (k == run->most_steps) return CV_TOO_MUCH_WORK;
        flag = library->step(run, t1, reached);
    }
    return flag;
}

bough_status bough_newton_run_advance(void *self, double *t, double pause, double t1, bool restart,
                                      double *y) {
    (void)pause;
    bough_newton_run *run = self;
    bough_newton_handle *newton = &run->newton;
    double *own = bough_vector_data(newton->y), reached = *t;
    memcpy(own, y, (size_t)newton->ode.n * sizeof *own);
    if (restart || !run->started) {
        bough_status status = start(run, *t);
        if (!bough_is_ok(&status)) return status;
    }
    newton->refused = false;
    newton->text[0] = 0;
    run->library->stop_at(run->memory, t1);
    int flag = cross(run, t1, &reached);
    if (flag < 0) {
        run->library->current_time(run->memory, t);
        run->library->count(run->memory, &run->past);
        run->started = false;
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: %s cannot go on: %s", newton->ode.name, *t,
                          run->library->title, reason(run, flag));
    }
    *t = t1;
    memcpy(y, own, (size_t)newton->ode.n * sizeof *own);
    return bough_ok();
}

void bough_newton_run_statistics(const void *self, bough_statistics *sum) {
    const bough_newton_run *run = self;
    bough_statistics_add(sum, &run->past);
    sum->jacobians += run->newton.jacobians;
    sum->factorisations += run->newton.factorisations;
    if (run->started) run->library->count(run->memory, sum);
}

#include "core/newton_handle.h"

#include "core/vector.h"

#include <stdio.h>

static SUNMatrix_ID matrix_id(SUNMatrix a) {
    (void)a;
    return SUNMATRIX_CUSTOM;
}

static SUNMatrix matrix_create(bough_newton_handle *handle);

static SUNMatrix matrix_clone(SUNMatrix a) {
    return matrix_create(a->content);
}

static void matrix_destroy(SUNMatrix a) {
    SUNMatFreeEmpty(a);
}

static SUNMatrix matrix_create(bough_newton_handle *handle) {
    SUNMatrix a = SUNMatNewEmpty(handle->context);
    if (a == NULL) return NULL;
    a->content = handle;
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
    bough_newton_handle *handle = s->content;
    handle->factorisations++;
    return handle->ode.factor(handle->ode.self, handle->gamma) ? 0 : 1;
}

static int solver_solve(SUNLinearSolver s, SUNMatrix a, N_Vector x, N_Vector b, sunrealtype tol) {
    (void)a;
    (void)tol;
    bough_newton_handle *handle = s->content;
    if (x != b) N_VScale(1.0, b, x);
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
    bool ok = handle->y != NULL && handle->weight != NULL && handle->matrix != NULL &&
              handle->solver != NULL;
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
    bool ok = handle->ode.derivative(handle->ode.self, t, bough_vector_data(y),
                                     bough_vector_data(rate));
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

int bough_newton_handle_system(bough_newton_handle *handle, double t, N_Vector y,
                               sunbooleantype jok, sunbooleantype *jcur, double gamma) {
    handle->gamma = gamma;
    *jcur = !jok;
    if (jok) return 0;
    handle->jacobians++;
    return handle->ode.linearise(handle->ode.self, t, bough_vector_data(y)) ? 0 : 1;
}

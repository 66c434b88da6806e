// What SUNDIALS wants of a matrix and a linear solver, for a system that factors and solves its own
// Newton matrix I − γ ∂f/∂y: handles only. Shared by the methods that are SUNDIALS integrators.
#ifndef BOUGH_CORE_NEWTON_HANDLE_H
#define BOUGH_CORE_NEWTON_HANDLE_H

#include "core/integrator.h"

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

typedef struct bough_newton_handle {
    bough_ode ode;
    SUNContext context;
    N_Vector y, weight; // state, and 1/tolerance of each component
    SUNMatrix matrix;
    SUNLinearSolver solver;
    double gamma;   // of the next factorisation
    bool refused;   // f had no value somewhere since this was cleared
    char text[200]; // the integrator's last complaint
    long jacobians, factorisations;
} bough_newton_handle;

// False when memory is exhausted; destroy in any case. Tolerance rtol · scale per state.
bool bough_newton_handle_create(bough_newton_handle *handle, const bough_ode *ode, double rtol);
void bough_newton_handle_destroy(bough_newton_handle *handle);

// Callbacks of an integrator whose user data is the handle.
int bough_newton_handle_rate(sunrealtype t, N_Vector y, N_Vector rate, void *handle);
int bough_newton_handle_weights(N_Vector y, N_Vector weight, void *handle);
void bough_newton_handle_message(int code, const char *module, const char *function, char *message,
                                 void *handle);

// Linearises unless `jok` says that the last tangents serve, and notes γ: 0, or 1 without a value.
int bough_newton_handle_system(bough_newton_handle *handle, double t, N_Vector y,
                               sunbooleantype jok, sunbooleantype *jcur, double gamma);

#endif

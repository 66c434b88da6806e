// What SUNDIALS wants of a matrix and a linear solver, for a system that factors and solves its own
// Newton matrix I − γ ∂f/∂y: handles only, for IDA, CVODE and ARKODE, and their steps, which are asked
// for alike.
#ifndef BOUGH_CORE_NEWTON_HANDLE_H
#define BOUGH_CORE_NEWTON_HANDLE_H

#include "core/solve/integrator.h"

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

// Of the tangents, for an integrator that does not say itself whether old ones serve.
typedef struct bough_newton_age {
    bool known;    // there have been tangents since the last start
    double setup;  // time of the last setup [s]
    long step;     // steps when they were found
    long failures; // of Newton's method when the last setup was made
} bough_newton_age;

typedef struct bough_newton_handle {
    bough_ode ode;
    SUNContext context;
    N_Vector y, weight; // state, and 1/tolerance of each component
    SUNMatrix matrix;
    SUNLinearSolver solver;
    double gamma;   // of the next factorisation
    bool scaled;    // solutions are those of (1/γ − ∂f/∂y) x = b
    bool refused;   // f had no value somewhere since this was cleared
    char text[200]; // the integrator's last complaint
    long jacobians, factorisations;
    bough_newton_age age;
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
int bough_newton_handle_system(bough_newton_handle *handle, double t, N_Vector y, sunbooleantype jok,
                               sunbooleantype *jcur, double gamma);

// -- integrators that take one step a call --------------------------------------------------------

typedef struct bough_newton_run bough_newton_run;

// CVODE, ARKODE and IDA, whose flags are the same numbers.
typedef struct bough_newton_library {
    const char *name, *title; // in messages
    int (*restart)(bough_newton_run *run, double t);
    int (*stop_at)(void *memory, double t);
    int (*step)(bough_newton_run *run, double t1, double *reached); // one, to t1 at most
    int (*current_time)(void *memory, double *t);
    void (*count)(void *memory, bough_statistics *sum); // since the last start, added
} bough_newton_library;

struct bough_newton_run {
    bough_newton_handle newton; // first
    const bough_newton_library *library;
    void *memory;
    int most_steps; // in a macro step
    bool started;
    N_Vector beside;       // (n) errors of the last step; of IDA ẏ
    bough_statistics past; // of the integrations before the last start
};

// A run without the library's memory, which the caller creates and destroys.
bough_newton_run *bough_newton_run_create(bough_arena *arena, const bough_ode *ode, double rtol,
                                          const bough_newton_library *library, void (*destroy)(void *run));
void bough_newton_run_destroy(bough_newton_run *run);

// As in bough_integrator_ops.
bough_status bough_newton_run_advance(void *run, double *t, double pause, double t1, bool restart, double *y);
void bough_newton_run_statistics(const void *run, bough_statistics *sum);

#endif

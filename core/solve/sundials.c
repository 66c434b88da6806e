// The integrators of SUNDIALS: CVODE (variable-order BDF), ARKODE (ESDIRK of order 4) and IDA (variable-order
// BDF of the DASSL family). They take one step a call, and their Newton matrix I − γ ∂f/∂y is the system's:
// SUNDIALS gets a matrix without content, a call for which the system linearises, and a linear solver whose
// setup and solution are the system's. Only this file and vector.c use SUNDIALS.
#include "core/solve/integrator.h"
#include "core/solve/vector.h"

#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

// -- a run of an integrator ------------------------------------------------------------------------

typedef struct run run;

// CVODE, ARKODE and IDA, whose flags are the same numbers and whose settings have the same parameters.
typedef struct library {
    int most_steps; // in a macro step
    bool scaled;    // its linear systems are (1/γ − ∂f/∂y) x = b
    void *(*create)(run *r);
    void (*destroy)(void **memory);
    int (*set_messages)(void *memory, void (*message)(int, const char *, const char *, char *, void *),
                        void *r);
    int (*set_user)(void *memory, void *r);
    int (*set_weights)(void *memory, int (*weights)(N_Vector, N_Vector, void *));
    int (*set_solver)(void *memory, SUNLinearSolver solver, SUNMatrix matrix);
    int (*begin_settings)(run *r), (*end_settings)(run *r); // what is its own, before and after the solver's
    int (*restart)(run *r, double t);
    int (*stop_at)(void *memory, double t);
    int (*step)(run *r, double t1, double *reached); // one, to t1 at most
    int (*current_time)(void *memory, double *t);
    void (*count)(void *memory, bough_statistics *sum); // since the last start, added
} library;

// The operations of a library whose names begin with `its`; those of this file begin with `own`.
#define LIBRARY(own, its)                                                                                    \
    .create = own##_memory, .destroy = its##Free, .set_messages = its##SetErrHandlerFn,                      \
    .set_user = its##SetUserData, .set_weights = its##WFtolerances, .set_solver = its##SetLinearSolver,      \
    .begin_settings = own##_begin, .end_settings = own##_end, .restart = own##_restart,                      \
    .stop_at = its##SetStopTime, .step = own##_step, .current_time = its##GetCurrentTime,                    \
    .count = own##_count

struct run {
    const library *library;
    const char *title; // in messages
    bough_ode ode;
    SUNContext context;
    N_Vector y, weight; // state, and 1/tolerance of each component
    N_Vector slope;     // of IDA: ẏ
    SUNMatrix matrix;
    SUNLinearSolver solver;
    void *memory; // the library's
    int most_steps;
    int most_order; // of IDA; 0: 5
    bool started;
    // written by the callbacks
    double gamma;   // of the next factorisation
    bool refused;   // f had no value somewhere since this was cleared
    char text[200]; // the integrator's last complaint
    long jacobians, factorisations;
    struct {           // age of the tangents, for IDA, which does not say whether old ones serve
        bool known;    // there have been tangents since the last start
        double setup;  // time of the last setup [s]
        long step;     // steps when they were found
        long failures; // of Newton's method when the last setup was made
    } age;
    bough_statistics past; // of the integrations before the last start
};

// Of the error test in a step. The first step is guessed from the present rates: of a body at rest it is
// too long by as many decades as its fastest vibration is faster than the macro step.
static const int most_failures = 30;

// f; 1 makes the library try a smaller step.
static int rate(double t, N_Vector y, N_Vector out, void *user) {
    run *r = user;
    bool ok = r->ode.derivative(r->ode.self, t, bough_vector_data(y), bough_vector_data(out));
    r->refused = r->refused || !ok;
    return ok ? 0 : 1;
}

// Absolute tolerances: 1/(rtol · scale) whatever the state.
static int weights(N_Vector y, N_Vector weight, void *user) {
    (void)y;
    N_VScale(1.0, ((const run *)user)->weight, weight);
    return 0;
}

static void message(int code, const char *module, const char *function, char *text, void *user) {
    (void)module, (void)function;
    run *r = user;
    if (code < 0) snprintf(r->text, sizeof r->text, "%s", text);
}

// Linearises unless the last tangents serve (`jok`), and keeps γ for the factorisation. 0, or 1 without a
// value.
static int set_tangents(run *r, double t, N_Vector y, sunbooleantype jok, sunbooleantype *jcur,
                        double gamma) {
    r->gamma = gamma;
    *jcur = !jok;
    if (jok) return 0;
    r->jacobians++;
    return r->ode.linearise(r->ode.self, t, bough_vector_data(y)) ? 0 : 1;
}

// -- the Newton matrix and its solver --------------------------------------------------------------

static SUNMatrix matrix_create(run *r);

static SUNMatrix_ID matrix_id(SUNMatrix a) {
    (void)a;
    return SUNMATRIX_CUSTOM;
}

static int matrix_zero(SUNMatrix a) {
    (void)a;
    return 0;
}

static SUNMatrix matrix_clone(SUNMatrix a) { return matrix_create(a->content); }

static SUNMatrix matrix_create(run *r) {
    SUNMatrix a = SUNMatNewEmpty(r->context);
    if (a == NULL) return NULL;
    a->content = r;
    a->ops->getid = matrix_id;
    a->ops->zero = matrix_zero;
    a->ops->clone = matrix_clone;
    a->ops->destroy = SUNMatFreeEmpty;
    return a;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver s) {
    (void)s;
    return SUNLINEARSOLVER_DIRECT;
}

static int solver_setup(SUNLinearSolver s, SUNMatrix a) {
    (void)a;
    run *r = s->content;
    r->factorisations++;
    return r->ode.factor(r->ode.self, r->gamma) ? 0 : 1;
}

static int solver_solve(SUNLinearSolver s, SUNMatrix a, N_Vector x, N_Vector b, sunrealtype tol) {
    (void)a, (void)tol;
    run *r = s->content;
    // IDA solves (1/γ − ∂f/∂y) x = b
    if (r->library->scaled) {
        N_VScale(r->gamma, b, x);
    } else if (x != b) {
        N_VScale(1.0, b, x);
    }
    r->ode.solve(r->ode.self, bough_vector_data(x));
    return 0;
}

static int solver_free(SUNLinearSolver s) {
    SUNLinSolFreeEmpty(s);
    return 0;
}

static SUNLinearSolver solver_create(run *r) {
    SUNLinearSolver s = SUNLinSolNewEmpty(r->context);
    if (s == NULL) return NULL;
    s->content = r;
    s->ops->gettype = solver_type;
    s->ops->setup = solver_setup;
    s->ops->solve = solver_solve;
    s->ops->free = solver_free;
    return s;
}

// -- construction ----------------------------------------------------------------------------------

static void destroy(void *object) {
    run *r = object;
    if (r->memory != NULL) r->library->destroy(&r->memory);
    if (r->slope != NULL) N_VDestroy(r->slope);
    if (r->solver != NULL) SUNLinSolFree(r->solver);
    if (r->matrix != NULL) SUNMatDestroy(r->matrix);
    if (r->y != NULL) N_VDestroy(r->y);
    if (r->weight != NULL) N_VDestroy(r->weight);
    if (r->context != NULL) SUNContext_Free(&r->context);
}

// False when memory is exhausted. Tolerance rtol · scale per state.
static bool take(run *r, double rtol) {
    int n = r->ode.n;
    if (!bough_vector_room(n) || SUNContext_Create(NULL, &r->context) != 0) return false;
    r->y = bough_vector_create(n, r->context);
    r->weight = bough_vector_create(n, r->context);
    r->matrix = matrix_create(r);
    r->solver = solver_create(r);
    if (!r->y || !r->weight || !r->matrix || !r->solver) return false;
    double *weight = bough_vector_data(r->weight);
    for (int i = 0; i < n; i++) weight[i] = 1 / (rtol * r->ode.scale[i]);
    r->memory = r->library->create(r);
    return r->memory != NULL;
}

// Settings in an order that all three libraries accept.
static bool configure(run *r) {
    const library *of = r->library;
    // messages first, so that failures of the other settings have a text
    int bad = of->set_messages(r->memory, message, r);
    bad |= of->set_user(r->memory, r);
    bad |= of->begin_settings(r);
    bad |= of->set_weights(r->memory, weights);
    bad |= of->set_solver(r->memory, r->solver, r->matrix);
    bad |= of->end_settings(r);
    return bad == 0;
}

static const library *library_of(bough_integrator_kind kind);

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    run *r = bough_arena_take(arena, sizeof *r);
    bough_arena_on_destroy(arena, destroy, r);
    r->library = library_of(options->kind);
    r->title = bough_integrator_find(options->kind)->title;
    r->ode = *ode;
    bool limited = options->kind != BOUGH_ARKODE_ESDIRK && options->most_steps > 0;
    r->most_steps = limited ? options->most_steps : r->library->most_steps;
    r->most_order = options->most_order;
    if (!take(r, options->rtol) || !configure(r)) bough_arena_leave(arena);
    return r;
}

// -- steps -----------------------------------------------------------------------------------------

// A start of the method from order 1; statistics of the run before are kept.
static bough_status start(run *r, double t) {
    if (r->started) r->library->count(r->memory, &r->past); // counters restart from zero
    r->started = r->library->restart(r, t) == CV_SUCCESS;
    if (!r->started) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: %s cannot start: %s", r->ode.name, t, r->title,
                          r->text);
    }
    r->past.starts++;
    return bough_ok();
}

static const char *reason(run *r, int flag) {
    // steps that shrink towards a state without forces end with several flags
    if (r->refused) flag = CV_RHSFUNC_FAIL;
    switch (flag) {
    case CV_TOO_MUCH_WORK:
        snprintf(
            r->text, sizeof r->text,
            "%d steps would not reach the end of the macro step, because the vibrations are so fast; damp the rods or take a larger rtol",
            r->most_steps);
        return r->text;
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
    default: return r->text[0] ? r->text : "it gave up";
    }
}

// All steps to t1, the integrator's to the last bit. One step a call: the interpolant of a call to the end
// may miss a stiff state there.
static int cross(run *r, double t1, double *reached) {
    double begun = *reached;
    int flag = CV_SUCCESS;
    // one step a call
    for (int k = 0; flag >= 0 && *reached < t1; k++) {
        bool known = k >= r->most_steps / 5; // how many it will be
        if (known && k * (t1 - begun) >= r->most_steps * (*reached - begun)) return CV_TOO_MUCH_WORK;
        flag = r->library->step(r, t1, reached);
    }
    return flag;
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    run *r = self;
    double *own = bough_vector_data(r->y), reached = *t;
    memcpy(own, y, (size_t)r->ode.n * sizeof *own);
    if (restart || !r->started) BOUGH_TRY(start(r, *t));
    r->refused = false;
    r->text[0] = 0;
    // no evaluation beyond t1, where inputs are not known
    r->library->stop_at(r->memory, t1);
    int flag = cross(r, t1, &reached);
    if (flag < 0) {
        // the library may have passed some steps
        r->library->current_time(r->memory, t);
        r->library->count(r->memory, &r->past);
        r->started = false;
        return bough_fail(BOUGH_FAILED, "%s at t = %.6g s: %s cannot go on: %s", r->ode.name, *t, r->title,
                          reason(r, flag));
    }
    *t = t1;
    memcpy(y, own, (size_t)r->ode.n * sizeof *own);
    return bough_ok();
}

static void limit(void *self, int most_steps) {
    run *r = self;
    r->most_steps = most_steps;
}

static void statistics(const void *self, bough_statistics *sum) {
    const run *r = self;
    bough_statistics_add(sum, 1, &r->past);
    sum->jacobians += r->jacobians;
    sum->factorisations += r->factorisations;
    if (r->started) r->library->count(r->memory, sum);
}

// -- CVODE -----------------------------------------------------------------------------------------

static void *cvode_memory(run *r) { return CVodeCreate(CV_BDF, r->context); }

// NOLINTNEXTLINE(readability-function-size): SUNDIALS fixes the parameters
static int cvode_tangents(double t, N_Vector y, N_Vector fy, SUNMatrix m, sunbooleantype jok,
                          sunbooleantype *jcur, double gamma, void *user, N_Vector a, N_Vector b,
                          N_Vector c) {
    (void)fy, (void)m, (void)a, (void)b, (void)c;
    return set_tangents(user, t, y, jok, jcur, gamma);
}

static int cvode_begin(run *r) { return CVodeInit(r->memory, rate, 0, r->y); }

static int cvode_end(run *r) {
    // a looser corrector costs no accuracy here and saves a fifth of the time
    return CVodeSetLinSysFn(r->memory, cvode_tangents) | CVodeSetNonlinConvCoef(r->memory, 0.3) |
           CVodeSetMaxErrTestFails(r->memory, most_failures);
}

static int cvode_restart(run *r, double t) { return CVodeReInit(r->memory, t, r->y); }

static int cvode_step(run *r, double t1, double *reached) {
    return CVode(r->memory, t1, r->y, reached, CV_ONE_STEP);
}

static void cvode_count(void *memory, bough_statistics *sum) {
    long steps, rhs, setups, failed, iterations, convergence;
    int last, next;
    double first, previous, h, now;
    // failures of the error test and of Newton's method count alike
    CVodeGetIntegratorStats(memory, &steps, &rhs, &setups, &failed, &last, &next, &first, &previous, &h,
                            &now);
    CVodeGetNonlinSolvStats(memory, &iterations, &convergence);
    sum->steps += steps;
    sum->derivatives += rhs;
    sum->failed_steps += failed + convergence;
    sum->iterations += iterations;
}

static const library cvode = {LIBRARY(cvode, CVode), .most_steps = 20000};

// -- ARKODE ----------------------------------------------------------------------------------------

// A singly diagonally implicit Runge–Kutta method with an explicit first stage, L-stable. A jump of the
// inputs costs a start, not an order.
static void *arkode_memory(run *r) { return ARKStepCreate(NULL, rate, 0, r->y, r->context); }

// NOLINTNEXTLINE(readability-function-size): SUNDIALS fixes the parameters
static int arkode_tangents(double t, N_Vector y, N_Vector fy, SUNMatrix m, SUNMatrix mass, sunbooleantype jok,
                           sunbooleantype *jcur, double gamma, void *user, N_Vector a, N_Vector b,
                           N_Vector c) {
    (void)fy, (void)m, (void)mass, (void)a, (void)b, (void)c;
    return set_tangents(user, t, y, jok, jcur, gamma);
}

static int arkode_begin(run *r) {
    return ARKStepSetTableNum(r->memory, ARKODE_ARK436L2SA_DIRK_6_3_4, ARKODE_ERK_NONE);
}

static int arkode_step(run *r, double t1, double *reached) {
    return ARKStepEvolve(r->memory, t1, r->y, reached, ARK_ONE_STEP);
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
static bool take_arkode_memory(run *r) {
    bough_ode ode = r->ode;
    trial one = {.n = ode.n};
    double reached;
    // a system that has a rate only once
    r->ode.self = &one;
    r->ode.derivative = rate_once;
    int flag = arkode_step(r, 1, &reached);
    r->ode = ode;
    r->text[0] = '\0';
    return flag < 0 && flag != ARK_MEM_FAIL && one.calls > 1;
}

static int arkode_end(run *r) {
    int bad =
        ARKStepSetLinSysFn(r->memory, arkode_tangents) | ARKStepSetMaxErrTestFails(r->memory, most_failures);
    // the rate of a stage follows from its value; f at that value would amplify a stiff error
    bad |= ARKStepSetDeduceImplicitRhs(r->memory, SUNTRUE);
    // with the default of 0.1 a stage at a loose tolerance ends after one iteration: an error that the
    // estimate of a step does not see
    bad |= ARKStepSetNonlinConvCoef(r->memory, 0.01);
    // ARKODE carries the convergence rate of exact factors over to steps of another length and
    // then stops after one iteration: a wrong stiff state without a sign. Factors are cheap.
    bad |= ARKStepSetDeltaGammaMax(r->memory, 1e-9);
    return bad != 0 || !take_arkode_memory(r);
}

static int arkode_restart(run *r, double t) { return ARKStepReInit(r->memory, NULL, rate, t, r->y); }

static void arkode_count(void *memory, bough_statistics *sum) {
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

static const library arkode = {LIBRARY(arkode, ARKStep), .most_steps = 20000};

// -- IDA -------------------------------------------------------------------------------------------

enum { MOST_AGE = 51 }; // steps with the same tangents, as many as CVODE takes

static void *ida_memory(run *r) {
    r->slope = bough_vector_create(r->ode.n, r->context);
    return r->slope == NULL ? NULL : IDACreate(r->context);
}

// ẏ − f(t, y); 1 makes IDA try a smaller step
static int ida_residual(double t, N_Vector y, N_Vector of, N_Vector out, void *user) {
    run *r = user;
    int n = r->ode.n;
    // ẏ − f, finite
    const double *rate_of = bough_vector_data(of);
    double *residual = bough_vector_data(out);
    if (rate(t, y, out, r) != 0) return 1;
    for (int i = 0; i < n; i++) residual[i] = rate_of[i] - residual[i];
    bool finite = bough_all_finite(n, residual);
    r->refused = r->refused || !finite;
    return finite ? 0 : 1;
}

// Whether a setup may keep the tangents of an earlier one: they are young, and Newton's method has not failed
// since the last setup, neither in this step, which is then set up again at the same time, nor so that the
// step was made shorter. Changes of cj alone need factors only. CVODE decides in the same way for itself.
static bool tangents_serve(run *r, double t) {
    long steps = 0, failures = 0;
    IDAGetNumSteps(r->memory, &steps);
    IDAGetNumNonlinSolvConvFails(r->memory, &failures);
    bool serve =
        r->age.known && t != r->age.setup && failures == r->age.failures && steps < r->age.step + MOST_AGE;
    if (!serve) r->age.step = steps;
    r->age.known = true;
    r->age.setup = t;
    r->age.failures = failures;
    return serve;
}

// NOLINTNEXTLINE(readability-function-size): SUNDIALS fixes the parameters
static int ida_tangents(double t, double cj, N_Vector y, N_Vector of, N_Vector residual, SUNMatrix j,
                        void *user, N_Vector a, N_Vector b, N_Vector c) {
    (void)of, (void)residual, (void)j, (void)a, (void)b, (void)c;
    sunbooleantype current;
    return set_tangents(user, t, y, tangents_serve(user, t), &current, 1 / cj);
}

static int ida_begin(run *r) { return IDAInit(r->memory, ida_residual, 0, r->y, r->slope); }

static int ida_end(run *r) {
    int bad = r->most_order > 0 ? IDASetMaxOrd(r->memory, r->most_order) : IDA_SUCCESS;
    return bad | IDASetJacFn(r->memory, ida_tangents) | IDASetMaxErrTestFails(r->memory, most_failures);
}

// With order 1 from y, whose rate is f.
static int ida_restart(run *r, double t) {
    r->age.known = false;
    r->past.derivatives++;
    if (rate(t, r->y, r->slope, r) != 0 || !bough_all_finite(r->ode.n, bough_vector_data(r->slope))) {
        snprintf(r->text, sizeof r->text, "the accelerations are not finite");
        return IDA_FIRST_RES_FAIL;
    }
    return IDAReInit(r->memory, t, r->y, r->slope);
}

static int ida_step(run *r, double t1, double *reached) {
    return IDASolve(r->memory, t1, reached, r->y, r->slope, IDA_ONE_STEP);
}

static void ida_count(void *memory, bough_statistics *sum) {
    long steps = 0, residuals = 0, failed = 0, iterations = 0, not_converged = 0;
    IDAGetNumSteps(memory, &steps);
    IDAGetNumResEvals(memory, &residuals);
    IDAGetNumErrTestFails(memory, &failed);
    IDAGetNumNonlinSolvIters(memory, &iterations);
    IDAGetNumNonlinSolvConvFails(memory, &not_converged);
    sum->steps += steps;
    sum->derivatives += residuals;
    sum->failed_steps += failed + not_converged;
    sum->iterations += iterations;
}

static const library ida = {LIBRARY(ida, IDA), .most_steps = 200000, .scaled = true};

// -- the table ----------------------------------------------------------------------------------------

static const library *library_of(bough_integrator_kind kind) {
    return kind == BOUGH_IDA ? &ida : kind == BOUGH_CVODE_BDF ? &cvode : &arkode;
}

#define OPERATIONS .create = create, .advance = advance, .limit = limit, .statistics = statistics

const bough_integrator_ops bough_integrator_ida = {.name = "ida", .title = "IDA", OPERATIONS};

const bough_integrator_ops bough_integrator_cvode = {.name = "cvode-bdf", .title = "CVODE BDF", OPERATIONS};

const bough_integrator_ops bough_integrator_arkode = {
    .name = "arkode-esdirk", .title = "ARKODE ESDIRK", OPERATIONS};

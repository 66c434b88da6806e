// SUNDIALS IDA, variable-order BDF of the DASSL family, on ẏ − f(t, y) = 0. The Newton matrix is the
// system's: an empty matrix object whose "Jacobian" call linearises and factors, and a linear solver
// whose solve is the system's. The only user of IDA.
#include "core/integrator.h"

#include "core/vector.h"

#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MESSAGE = 160, MOST_STEPS = 200000 };

typedef struct ida_run {
    bough_ode ode;
    double gamma;         // of the factors: 1/cj
    bool started;
    int most_steps;       // per call
    const double *weight; // 1/(rtol·scale) (n)
    SUNContext context;
    void *memory;
    N_Vector y, rate;
    SUNMatrix matrix;
    SUNLinearSolver solver;
    long jacobians;
    bough_statistics before; // of the runs before the last start
    char message[MESSAGE];   // of IDA
} ida_run;

// -- callbacks -------------------------------------------------------------------------------

static bool all_finite(const double *x, int n) {
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return false;
    }
    return true;
}

// ẏ − f; 1 makes IDA try a smaller step
static int residual(double t, N_Vector y, N_Vector rate, N_Vector out, void *self) {
    ida_run *ida = self;
    const double *of = bough_vector_data(rate);
    double *r = bough_vector_data(out);
    if (!ida->ode.derivative(ida->ode.self, t, bough_vector_data(y), r)) return 1;
    for (int i = 0; i < ida->ode.n; i++)
        r[i] = of[i] - r[i];
    return all_finite(r, ida->ode.n) ? 0 : 1;
}

// NOLINTNEXTLINE(readability-function-size): SUNDIALS fixes the parameters
static int jacobian(double t, double cj, N_Vector y, N_Vector rate, N_Vector r, SUNMatrix j,
                    void *self, N_Vector t1, N_Vector t2, N_Vector t3) {
    (void)rate, (void)r, (void)j, (void)t1, (void)t2, (void)t3;
    ida_run *ida = self;
    ida->jacobians++;
    ida->gamma = 1 / cj;
    return ida->ode.linearise(ida->ode.self, t, bough_vector_data(y)) &&
                   ida->ode.factor(ida->ode.self, ida->gamma)
               ? 0
               : 1;
}

static int weights(N_Vector y, N_Vector out, void *self) {
    (void)y;
    ida_run *ida = self;
    memcpy(bough_vector_data(out), ida->weight, (size_t)ida->ode.n * sizeof(double));
    return 0;
}

static void remember(int code, const char *module, const char *function, char *text, void *self) {
    (void)code, (void)module, (void)function;
    ida_run *ida = self;
    snprintf(ida->message, MESSAGE, "%s", text);
}

// -- the empty matrix and the solver --------------------------------------------------------------

static SUNMatrix_ID matrix_id(SUNMatrix m) {
    (void)m;
    return SUNMATRIX_CUSTOM;
}

static int matrix_zero(SUNMatrix m) {
    (void)m;
    return 0;
}

static void matrix_destroy(SUNMatrix m) { SUNMatFreeEmpty(m); }

static SUNLinearSolver_Type solver_type(SUNLinearSolver s) {
    (void)s;
    return SUNLINEARSOLVER_DIRECT;
}

static SUNLinearSolver_ID solver_id(SUNLinearSolver s) {
    (void)s;
    return SUNLINEARSOLVER_CUSTOM;
}

static int solver_setup(SUNLinearSolver s, SUNMatrix m) {
    (void)s, (void)m;
    return 0; // the Jacobian call has factored already
}

// (cj − J)⁻¹ b
static int solver_solve(SUNLinearSolver s, SUNMatrix m, N_Vector x, N_Vector b, double tolerance) {
    (void)m, (void)tolerance;
    ida_run *ida = s->content;
    double *to = bough_vector_data(x);
    const double *from = bough_vector_data(b);
    for (int i = 0; i < ida->ode.n; i++)
        to[i] = ida->gamma * from[i];
    ida->ode.solve(ida->ode.self, to);
    return 0;
}

static int solver_free(SUNLinearSolver s) {
    s->content = NULL;
    SUNLinSolFreeEmpty(s);
    return 0;
}

static bool create_algebra(ida_run *ida) {
    ida->matrix = SUNMatNewEmpty(ida->context);
    ida->solver = SUNLinSolNewEmpty(ida->context);
    if (ida->matrix == NULL || ida->solver == NULL) return false;
    ida->matrix->ops->getid = matrix_id;
    ida->matrix->ops->zero = matrix_zero;
    ida->matrix->ops->destroy = matrix_destroy;
    ida->solver->content = ida;
    ida->solver->ops->gettype = solver_type;
    ida->solver->ops->getid = solver_id;
    ida->solver->ops->setup = solver_setup;
    ida->solver->ops->solve = solver_solve;
    ida->solver->ops->free = solver_free;
    return true;
}

// -- construction ----------------------------------------------------------------------------

static void release(void *object) {
    ida_run *ida = object;
    if (ida->memory != NULL) IDAFree(&ida->memory);
    if (ida->solver != NULL) SUNLinSolFree(ida->solver);
    if (ida->matrix != NULL) SUNMatDestroy(ida->matrix);
    if (ida->rate != NULL) N_VDestroy(ida->rate);
    if (ida->y != NULL) N_VDestroy(ida->y);
    if (ida->context != NULL) SUNContext_Free(&ida->context);
}

static bool create_objects(ida_run *ida) {
    if (!bough_vector_room(ida->ode.n)) return false;
    if (SUNContext_Create(NULL, &ida->context) != 0) return false;
    ida->y = bough_vector_create(ida->ode.n, ida->context);
    ida->rate = bough_vector_create(ida->ode.n, ida->context);
    ida->memory = IDACreate(ida->context);
    return ida->y != NULL && ida->rate != NULL && ida->memory != NULL && create_algebra(ida);
}

static bool configure(ida_run *ida) {
    void *m = ida->memory;
    return IDASetErrHandlerFn(m, remember, ida) == IDA_SUCCESS &&
           IDASetUserData(m, ida) == IDA_SUCCESS &&
           IDAInit(m, residual, 0, ida->y, ida->rate) == IDA_SUCCESS &&
           IDAWFtolerances(m, weights) == IDA_SUCCESS &&
           IDASetLinearSolver(m, ida->solver, ida->matrix) == IDA_SUCCESS &&
           IDASetJacFn(m, jacobian) == IDA_SUCCESS &&
           IDASetMaxNumSteps(m, ida->most_steps) == IDA_SUCCESS;
}

static void *create(bough_arena *arena, const bough_ode *ode,
                    const bough_integrator_options *options) {
    ida_run *ida = bough_arena_take(arena, sizeof *ida);
    double *weight = bough_arena_doubles(arena, (size_t)ode->n);
    for (int i = 0; i < ode->n; i++)
        weight[i] = 1 / (options->rtol * ode->scale[i]);
    ida->ode = *ode;
    ida->most_steps = options->most_steps > 0 ? options->most_steps : MOST_STEPS;
    ida->weight = weight;
    bough_arena_on_destroy(arena, release, ida);
    if (!create_objects(ida) || !configure(ida)) bough_arena_leave(arena);
    return ida;
}

// -- stepping --------------------------------------------------------------------------------

static void add_counts(const ida_run *ida, bough_statistics *sum) {
    long steps = 0, residuals = 0, setups = 0, failed = 0, iterations = 0, not_converged = 0;
    IDAGetNumSteps(ida->memory, &steps);
    IDAGetNumResEvals(ida->memory, &residuals);
    IDAGetNumLinSolvSetups(ida->memory, &setups);
    IDAGetNumErrTestFails(ida->memory, &failed);
    IDAGetNumNonlinSolvIters(ida->memory, &iterations);
    IDAGetNumNonlinSolvConvFails(ida->memory, &not_converged);
    sum->steps += steps;
    sum->derivatives += residuals;
    sum->factorisations += setups;
    sum->failed_steps += failed + not_converged;
    sum->iterations += iterations;
}

static bough_status failure(ida_run *ida, double t, int flag) {
    if (flag == IDA_TOO_MUCH_WORK) {
        return bough_fail(BOUGH_FAILED,
                          "%s at t = %.9g s: %d steps of IDA do not reach the end of the macro step: it "
                          "follows vibrations that fast, which damping of rods or a larger rtol would "
                          "end",
                          ida->ode.name, t, ida->most_steps);
    }
    return bough_fail(BOUGH_FAILED,
                      "%s at t = %.9g s: IDA failed (code %d: %s; a segment may turn by more than "
                      "120°, or a value overflow)",
                      ida->ode.name, t, flag, ida->message);
}

// With order 1 from y, whose rate is f.
static bough_status start(ida_run *ida, double t, const double *y) {
    double *rate = bough_vector_data(ida->rate);
    memcpy(bough_vector_data(ida->y), y, (size_t)ida->ode.n * sizeof *y);
    if (!ida->ode.derivative(ida->ode.self, t, y, rate) || !all_finite(rate, ida->ode.n)) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.9g s: the accelerations are not finite", ida->ode.name, t);
    }
    add_counts(ida, &ida->before);
    ida->before.restarts++;
    ida->before.derivatives++;
    int flag = IDAReInit(ida->memory, t, ida->y, ida->rate);
    ida->started = flag == IDA_SUCCESS;
    return ida->started ? bough_ok() : failure(ida, t, flag);
}

static bough_status advance(void *self, double *t, double pause, double t1, bool restart,
                            double *y) {
    (void)pause;
    ida_run *ida = self;
    ida->message[0] = 0;
    if (restart || !ida->started) {
        bough_status status = start(ida, *t, y);
        if (!bough_is_ok(&status)) return status;
    }
    int flag = IDASetStopTime(ida->memory, t1);
    if (flag >= 0) flag = IDASolve(ida->memory, t1, t, ida->y, ida->rate, IDA_NORMAL);
    if (flag < 0) {
        IDAGetCurrentTime(ida->memory, t);
        ida->started = false;
        return failure(ida, *t, flag);
    }
    *t = t1;
    memcpy(y, bough_vector_data(ida->y), (size_t)ida->ode.n * sizeof *y);
    return bough_ok();
}

static void statistics(const void *self, bough_statistics *sum) {
    const ida_run *ida = self;
    bough_statistics_add(sum, &ida->before);
    sum->jacobians += ida->jacobians;
    add_counts(ida, sum);
}

const bough_integrator_ops bough_integrator_ida = {
    .name = "ida",
    .title = "IDA",
    .create = create,
    .advance = advance,
    .statistics = statistics,
};

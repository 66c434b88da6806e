// SUNDIALS IDA behind integrator_ida.h. The Newton matrix is the caller's: an empty matrix object
// whose "Jacobian" call is dae->setup, and a linear solver whose solve is dae->solve.
#include "core/integrator_ida.h"

#include "core/vector.h"

#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MESSAGE = 160, MOST_STEPS = 200000 }; // per call

struct bough_ida {
    bough_dae dae;
    const double *weight; // 1/(rtol·scale) (n)
    SUNContext context;
    void *memory;
    N_Vector y, rate;
    SUNMatrix matrix;
    SUNLinearSolver solver;
    long jacobians;
    bough_statistics before; // of the runs before the last start
    char message[MESSAGE];   // of IDA
};

// -- callbacks -------------------------------------------------------------------------------

static bool all_finite(const double *x, int n) {
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return false;
    }
    return true;
}

static int residual(double t, N_Vector y, N_Vector rate, N_Vector out, void *self) {
    bough_ida *ida = self;
    double *r = bough_vector_data(out);
    bool ok = ida->dae.residual(ida->dae.self, t, bough_vector_data(y), bough_vector_data(rate), r);
    return ok && all_finite(r, ida->dae.n) ? 0 : 1; // 1: IDA tries a smaller step
}

// NOLINTNEXTLINE(readability-function-size): SUNDIALS fixes the parameters
static int jacobian(double t, double cj, N_Vector y, N_Vector rate, N_Vector r, SUNMatrix j,
                    void *self, N_Vector t1, N_Vector t2, N_Vector t3) {
    (void)r, (void)j, (void)t1, (void)t2, (void)t3;
    bough_ida *ida = self;
    ida->jacobians++;
    return ida->dae.setup(ida->dae.self, t, bough_vector_data(y), bough_vector_data(rate), cj) ? 0
                                                                                               : 1;
}

static int weights(N_Vector y, N_Vector out, void *self) {
    (void)y;
    bough_ida *ida = self;
    memcpy(bough_vector_data(out), ida->weight, (size_t)ida->dae.n * sizeof(double));
    return 0;
}

static void remember(int code, const char *module, const char *function, char *text, void *self) {
    (void)code, (void)module, (void)function;
    bough_ida *ida = self;
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

static int solver_solve(SUNLinearSolver s, SUNMatrix m, N_Vector x, N_Vector b, double tolerance) {
    (void)m, (void)tolerance;
    bough_ida *ida = s->content;
    double *to = bough_vector_data(x), *from = bough_vector_data(b);
    if (to != from) memcpy(to, from, (size_t)ida->dae.n * sizeof(double));
    ida->dae.solve(ida->dae.self, to);
    return 0;
}

static int solver_free(SUNLinearSolver s) {
    s->content = NULL;
    SUNLinSolFreeEmpty(s);
    return 0;
}

static bool create_algebra(bough_ida *ida) {
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
    bough_ida *ida = object;
    if (ida->memory != NULL) IDAFree(&ida->memory);
    if (ida->solver != NULL) SUNLinSolFree(ida->solver);
    if (ida->matrix != NULL) SUNMatDestroy(ida->matrix);
    if (ida->rate != NULL) N_VDestroy(ida->rate);
    if (ida->y != NULL) N_VDestroy(ida->y);
    if (ida->context != NULL) SUNContext_Free(&ida->context);
}

static bool create_objects(bough_ida *ida) {
    if (!bough_vector_room(ida->dae.n)) return false;
    if (SUNContext_Create(NULL, &ida->context) != 0) return false;
    ida->y = bough_vector_create(ida->dae.n, ida->context);
    ida->rate = bough_vector_create(ida->dae.n, ida->context);
    ida->memory = IDACreate(ida->context);
    return ida->y != NULL && ida->rate != NULL && ida->memory != NULL && create_algebra(ida);
}

static bool configure(bough_ida *ida) {
    void *m = ida->memory;
    return IDASetErrHandlerFn(m, remember, ida) == IDA_SUCCESS &&
           IDASetUserData(m, ida) == IDA_SUCCESS &&
           IDAInit(m, residual, 0, ida->y, ida->rate) == IDA_SUCCESS &&
           IDAWFtolerances(m, weights) == IDA_SUCCESS &&
           IDASetLinearSolver(m, ida->solver, ida->matrix) == IDA_SUCCESS &&
           IDASetJacFn(m, jacobian) == IDA_SUCCESS &&
           IDASetMaxNumSteps(m, MOST_STEPS) == IDA_SUCCESS;
}

bough_status bough_ida_create(bough_arena *arena, const bough_dae *dae, const double *scale,
                              double rtol, bough_ida **out) {
    if (!(rtol > 0)) {
        return bough_fail(BOUGH_INVALID, "%s: IDA's relative tolerance must be positive, not %g",
                          dae->name, rtol);
    }
    bough_ida *ida = bough_arena_take(arena, sizeof *ida);
    double *weight = bough_arena_doubles(arena, (size_t)dae->n);
    if (ida == NULL || weight == NULL) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: no memory for IDA", dae->name);
    }
    for (int i = 0; i < dae->n; i++)
        weight[i] = 1 / (rtol * scale[i]);
    ida->dae = *dae;
    ida->weight = weight;
    *out = ida;
    bool created = create_objects(ida) && configure(ida);
    bough_arena_on_destroy(arena, release, ida);
    if (created && !bough_arena_exhausted(arena)) return bough_ok();
    return bough_fail(BOUGH_OUT_OF_MEMORY, "%s: no memory for IDA. %s", dae->name, ida->message);
}

// -- stepping --------------------------------------------------------------------------------

static void add_counts(const bough_ida *ida, bough_statistics *sum) {
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

static bough_status failure(bough_ida *ida, double t, int flag) {
    const char *advice = "try a smaller macro step, another tolerance or another coupling scheme";
    if (flag == IDA_TOO_MUCH_WORK) {
        return bough_fail(BOUGH_FAILED,
                          "%s at t = %.9g s: IDA took %d steps without reaching the end of the "
                          "macro step; %s",
                          ida->dae.name, t, (int)MOST_STEPS, advice);
    }
    return bough_fail(BOUGH_FAILED, "%s at t = %.9g s: IDA failed (code %d: %s); %s", ida->dae.name,
                      t, flag, ida->message, advice);
}

bough_status bough_ida_start(bough_ida *ida, double t, const double *y, const double *rate) {
    size_t size = (size_t)ida->dae.n * sizeof(double);
    memcpy(bough_vector_data(ida->y), y, size);
    memcpy(bough_vector_data(ida->rate), rate, size);
    add_counts(ida, &ida->before);
    ida->before.restarts++;
    ida->message[0] = 0;
    int flag = IDAReInit(ida->memory, t, ida->y, ida->rate);
    return flag == IDA_SUCCESS ? bough_ok() : failure(ida, t, flag);
}

bough_status bough_ida_advance(bough_ida *ida, double t1, double *y, double *rate) {
    double reached = t1;
    ida->message[0] = 0;
    int flag = IDASetStopTime(ida->memory, t1);
    if (flag >= 0) flag = IDASolve(ida->memory, t1, &reached, ida->y, ida->rate, IDA_NORMAL);
    if (flag < 0) {
        IDAGetCurrentTime(ida->memory, &reached);
        return failure(ida, reached, flag);
    }
    size_t size = (size_t)ida->dae.n * sizeof(double);
    memcpy(y, bough_vector_data(ida->y), size);
    memcpy(rate, bough_vector_data(ida->rate), size);
    return bough_ok();
}

bough_status bough_ida_dense(bough_ida *ida, double t, double *y, double *rate) {
    size_t size = (size_t)ida->dae.n * sizeof(double);
    int flag = IDAGetDky(ida->memory, t, 0, ida->y);
    if (flag == IDA_SUCCESS) flag = IDAGetDky(ida->memory, t, 1, ida->rate);
    if (flag != IDA_SUCCESS) return failure(ida, t, flag);
    memcpy(y, bough_vector_data(ida->y), size);
    memcpy(rate, bough_vector_data(ida->rate), size);
    return bough_ok();
}

void bough_ida_statistics(const bough_ida *ida, bough_statistics *sum) {
    *sum = ida->before;
    sum->jacobians = ida->jacobians;
    add_counts(ida, sum);
}

// SUNDIALS IDA, variable-order BDF of the DASSL family, on ẏ − f(t, y) = 0. The Newton matrix is the
// system's: an empty matrix object whose "Jacobian" call linearises, and a linear solver whose setup
// and solution are the system's. The only user of IDA.
#include "core/base.h"
#include "core/newton_handle.h"
#include "core/vector.h"

#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <string.h>

enum { MOST_STEPS = 200000 };

typedef struct ida_run {
    bough_newton_handle newton;
    bool started;
    int most_steps; // per call
    void *memory;
    N_Vector rate;
    bough_statistics before; // of the runs before the last start
} ida_run;

// -- callbacks -------------------------------------------------------------------------------

// ẏ − f; 1 makes IDA try a smaller step
static int residual(double t, N_Vector y, N_Vector rate, N_Vector out, void *newton) {
    const bough_ode *ode = &((bough_newton_handle *)newton)->ode;
    const double *of = bough_vector_data(rate);
    double *r = bough_vector_data(out);
    if (!ode->derivative(ode->self, t, bough_vector_data(y), r)) return 1;
    for (int i = 0; i < ode->n; i++)
        r[i] = of[i] - r[i];
    return bough_all_finite(ode->n, r) ? 0 : 1;
}

// NOLINTNEXTLINE(readability-function-size): SUNDIALS fixes the parameters
static int jacobian(double t, double cj, N_Vector y, N_Vector rate, N_Vector r, SUNMatrix j,
                    void *newton, N_Vector t1, N_Vector t2, N_Vector t3) {
    (void)rate, (void)r, (void)j, (void)t1, (void)t2, (void)t3;
    sunbooleantype current;
    return bough_newton_handle_system(newton, t, y, SUNFALSE, &current, 1 / cj);
}

// -- construction ----------------------------------------------------------------------------

static void release(void *object) {
    ida_run *ida = object;
    if (ida->memory != NULL) IDAFree(&ida->memory);
    if (ida->rate != NULL) N_VDestroy(ida->rate);
    bough_newton_handle_destroy(&ida->newton);
}

static bool configure(ida_run *ida) {
    void *m = ida->memory;
    bough_newton_handle *newton = &ida->newton;
    int bad = IDASetErrHandlerFn(m, bough_newton_handle_message, newton);
    bad |= IDASetUserData(m, newton);
    bad |= IDAInit(m, residual, 0, newton->y, ida->rate);
    bad |= IDAWFtolerances(m, bough_newton_handle_weights);
    bad |= IDASetLinearSolver(m, newton->solver, newton->matrix);
    bad |= IDASetJacFn(m, jacobian);
    bad |= IDASetMaxNumSteps(m, ida->most_steps);
    return bad == 0;
}

static void *create(bough_arena *arena, const bough_ode *ode,
                    const bough_integrator_options *options) {
    ida_run *ida = bough_arena_take(arena, sizeof *ida);
    bough_newton_handle *newton = &ida->newton;
    bough_arena_on_destroy(arena, release, ida);
    newton->scaled = true; // (cj − J)⁻¹ b
    ida->most_steps = options->most_steps > 0 ? options->most_steps : MOST_STEPS;
    if (!bough_newton_handle_create(newton, ode, options->rtol)) bough_arena_leave(arena);
    ida->rate = bough_vector_create(ode->n, newton->context);
    ida->memory = IDACreate(newton->context);
    if (ida->rate == NULL || ida->memory == NULL || !configure(ida)) bough_arena_leave(arena);
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
                          ida->newton.ode.name, t, ida->most_steps);
    }
    return bough_fail(BOUGH_FAILED,
                      "%s at t = %.9g s: IDA failed (code %d: %s; a segment may turn by more than "
                      "120°, or a value overflow)",
                      ida->newton.ode.name, t, flag, ida->newton.text);
}

// With order 1 from y, whose rate is f.
static bough_status start(ida_run *ida, double t, const double *y) {
    double *rate = bough_vector_data(ida->rate);
    memcpy(bough_vector_data(ida->newton.y), y, (size_t)ida->newton.ode.n * sizeof *y);
    if (!ida->newton.ode.derivative(ida->newton.ode.self, t, y, rate) ||
        !bough_all_finite(ida->newton.ode.n, rate)) {
        return bough_fail(BOUGH_FAILED, "%s at t = %.9g s: the accelerations are not finite",
                          ida->newton.ode.name, t);
    }
    add_counts(ida, &ida->before);
    ida->before.restarts++;
    ida->before.derivatives++;
    int flag = IDAReInit(ida->memory, t, ida->newton.y, ida->rate);
    ida->started = flag == IDA_SUCCESS;
    return ida->started ? bough_ok() : failure(ida, t, flag);
}

static bough_status advance(void *self, double *t, double pause, double t1, bool restart,
                            double *y) {
    (void)pause;
    ida_run *ida = self;
    ida->newton.text[0] = 0;
    if (restart || !ida->started) {
        bough_status status = start(ida, *t, y);
        if (!bough_is_ok(&status)) return status;
    }
    int flag = IDASetStopTime(ida->memory, t1);
    if (flag >= 0) flag = IDASolve(ida->memory, t1, t, ida->newton.y, ida->rate, IDA_NORMAL);
    if (flag < 0) {
        IDAGetCurrentTime(ida->memory, t);
        ida->started = false;
        return failure(ida, *t, flag);
    }
    *t = t1;
    memcpy(y, bough_vector_data(ida->newton.y), (size_t)ida->newton.ode.n * sizeof *y);
    return bough_ok();
}

static void statistics(const void *self, bough_statistics *sum) {
    const ida_run *ida = self;
    bough_statistics_add(sum, &ida->before);
    sum->jacobians += ida->newton.jacobians;
    add_counts(ida, sum);
}

const bough_integrator_ops bough_integrator_ida = {
    .name = "ida",
    .title = "IDA",
    .create = create,
    .advance = advance,
    .statistics = statistics,
};

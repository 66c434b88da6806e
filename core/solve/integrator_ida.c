// SUNDIALS IDA, variable-order BDF of the DASSL family, on ẏ − f(t, y) = 0. The Newton matrix is the
// system's: an empty matrix object whose "Jacobian" call linearises, and a linear solver whose setup
// and solution are the system's. The only user of IDA.
#include "core/base/base.h"
#include "core/solve/newton_handle.h"
#include "core/solve/vector.h"

#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <stdio.h>

enum { MOST_STEPS = 200000 };
enum { MOST_AGE = 51 }; // steps with the same tangents, as many as CVODE takes

// ẏ − f; 1 makes IDA try a smaller step
static int residual(double t, N_Vector y, N_Vector rate, N_Vector out, void *handle) {
    bough_newton_handle *newton = handle;
    int n = newton->ode.n;
    const double *of = bough_vector_data(rate);
    double *r = bough_vector_data(out);
    if (bough_newton_handle_rate(t, y, out, newton) != 0) return 1;
    for (int i = 0; i < n; i++) r[i] = of[i] - r[i];
    bool finite = bough_all_finite(n, r);
    newton->refused = newton->refused || !finite;
    return finite ? 0 : 1;
}

// Whether a setup may keep the tangents of an earlier one: they are young, and Newton's method has not failed
// since the last setup, neither in this step, which is then set up again at the same time, nor so that the
// step was made shorter. Changes of cj alone need factors only. CVODE decides in the same way for itself.
static bool tangents_serve(bough_newton_handle *newton, double t) {
    const bough_newton_run *run = (const bough_newton_run *)newton; // its first member
    bough_newton_age *age = &newton->age;
    long steps = 0, failures = 0;
    IDAGetNumSteps(run->memory, &steps);
    IDAGetNumNonlinSolvConvFails(run->memory, &failures);
    bool serve = age->known && t != age->setup && failures == age->failures && steps < age->step + MOST_AGE;
    if (!serve) age->step = steps;
    age->known = true;
    age->setup = t;
    age->failures = failures;
    return serve;
}

// NOLINTNEXTLINE(readability-function-size): SUNDIALS fixes the parameters
static int jacobian(double t, double cj, N_Vector y, N_Vector rate, N_Vector r, SUNMatrix j, void *newton,
                    N_Vector t1, N_Vector t2, N_Vector t3) {
    (void)rate, (void)r, (void)j, (void)t1, (void)t2, (void)t3;
    sunbooleantype current;
    return bough_newton_handle_system(newton, t, y, tangents_serve(newton, t), &current, 1 / cj);
}

// With order 1 from y, whose rate is f.
static int restart(bough_newton_run *run, double t) {
    bough_newton_handle *newton = &run->newton;
    newton->age.known = false;
    run->past.derivatives++;
    if (bough_newton_handle_rate(t, newton->y, run->beside, newton) != 0 ||
        !bough_all_finite(newton->ode.n, bough_vector_data(run->beside))) {
        snprintf(newton->text, sizeof newton->text, "the accelerations are not finite");
        return IDA_FIRST_RES_FAIL;
    }
    return IDAReInit(run->memory, t, newton->y, run->beside);
}

static int step(bough_newton_run *run, double t1, double *reached) {
    return IDASolve(run->memory, t1, reached, run->newton.y, run->beside, IDA_ONE_STEP);
}

static void count(void *memory, bough_statistics *sum) {
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

static const bough_newton_library library = {
    .name = "IDA",
    .title = "IDA",
    .restart = restart,
    .stop_at = IDASetStopTime,
    .step = step,
    .current_time = IDAGetCurrentTime,
    .count = count,
};

static void destroy(void *object) {
    bough_newton_run *run = object;
    if (run->memory != NULL) IDAFree(&run->memory);
    bough_newton_run_destroy(run);
}

static bool configure(bough_newton_run *run) {
    void *ida = run->memory;
    bough_newton_handle *newton = &run->newton;
    int bad = IDASetErrHandlerFn(ida, bough_newton_handle_message, newton);
    bad |= IDASetUserData(ida, newton);
    bad |= IDAInit(ida, residual, 0, newton->y, run->beside);
    bad |= IDAWFtolerances(ida, bough_newton_handle_weights);
    bad |= IDASetLinearSolver(ida, newton->solver, newton->matrix);
    bad |= IDASetJacFn(ida, jacobian);
    return bad == 0;
}

static void *create(bough_arena *arena, const bough_ode *ode, const bough_integrator_options *options) {
    bough_newton_run *run = bough_newton_run_create(arena, ode, options->rtol, &library, destroy);
    run->newton.scaled = true; // (cj − J)⁻¹ b
    run->most_steps = options->most_steps > 0 ? options->most_steps : MOST_STEPS;
    run->memory = IDACreate(run->newton.context);
    if (run->memory == NULL || !configure(run)) bough_arena_leave(arena);
    return run;
}

const bough_integrator_ops bough_integrator_ida = {
    .name = "ida",
    .title = "IDA",
    .create = create,
    .advance = bough_newton_run_advance,
    .statistics = bough_newton_run_statistics,
};

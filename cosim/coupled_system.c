// The coupled members behind the contract of core/solve/system.h. It has no ports.
#include "cosim/coupled.h"

#include <math.h>

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    (void)input;
    bough_status status = bough_coupled_rate(self, t, state, rate);
    return bough_is_ok(&status);
}

static void output(void *self, double t, const double *state, const double *input, double *out) {
    (void)self, (void)t, (void)state, (void)input, (void)out;
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    (void)self, (void)t, (void)state, (void)input, (void)state_rate, (void)input_rate, (void)rate;
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    (void)self, (void)t, (void)state, (void)input, (void)column;
}

static void *factors(void *self, bough_arena *arena) {
    const bough_coupled *coupled = self;
    return bough_coupled_create(arena, coupled->assembly, coupled->pool);
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
    (void)self, (void)input;
    bough_coupled *own = factors;
    bough_coupled_inputs(own, t, state);
    bough_coupled_linearise(own, t, state, own->input);
    return true;
}

static bool factor(void *self, void *factors, double gamma) {
    (void)self;
    bough_status status = bough_coupled_factor(factors, gamma);
    return bough_is_ok(&status);
}

static void solve(void *self, void *factors, double *x) {
    (void)self;
    bough_coupled_solve(factors, x);
}

static bool constrain(void *self, double t, double *state) {
    const bough_assembly *a = ((const bough_coupled *)self)->assembly;
    bool far = false;
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        if (s->ops->constrain == NULL) continue;
        far = s->ops->constrain(s->self, t, state + a->state_offset[i]) || far;
    }
    return far;
}

static void project(void *self, const double *state, double *x) { bough_coupled_project(self, state, x); }

static const bough_system_ops operations = {
    BOUGH_SYSTEM_REQUIRED,
    .constrain = constrain,
    .project = project,
};

bough_system bough_coupled_system(bough_arena *arena, const bough_assembly *a, bough_pool *pool,
                                  const char *name) {
    bough_coupled *evaluation = bough_coupled_create_evaluation(arena, a, pool);
    double *scale = bough_arena_doubles(arena, (size_t)a->n_state);
    double *initial = bough_arena_doubles(arena, (size_t)a->n_state);
    bough_assembly_scales(a, scale);
    bough_assembly_states(a, initial);
    double elastic_rate = 0;
    for (int i = 0; i < a->n_member; i++)
        elastic_rate = fmax(elastic_rate, a->member[i]->system.elastic_rate);
    return (bough_system){.name = name,
                          .kind = "coupled",
                          .n_state = a->n_state,
                          .scale = scale,
                          .initial = initial,
                          .elastic_rate = elastic_rate,
                          .ops = &operations,
                          .self = evaluation};
}

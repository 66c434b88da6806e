#include "apps/bough/model/build_internal.h"

#include "apps/bough/model/fmu_instance.h"

enum { MOST_STATES = 8 };

typedef struct fmu_member {
    const bough_scene_body *body;
    const bough_member *member;
    bough_fmu_instance fmu;
    double motion[BOUGH_SCENE_MOTION], wrench[BOUGH_SCENE_WRENCH];

    int n_state;
    fmi3_state state[MOST_STATES]; // to which copies of this member refer
    bool lost;                     // a copy of the state could not be made or restored
    long steps;
} fmu_member;

// -- own steps ------------------------------------------------------------------------------------

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    (void)restart, (void)y;
    fmu_member *x = self;
    const bough_signal *signal = x->member->signal;
    int n = x->body->fmu.steps;
    double t0 = *t, h = (t1 - t0) / n;
    double fraction = x->body->fmu.hold == BOUGH_SCENE_FMU_HELD ? 0.5 : 1;
    if (x->lost) {
        return bough_fail(BOUGH_FAILED, "%s: the FMU could not store or restore its state at %.6g s%s%s",
                          x->body->name, t0, x->fmu.message[0] ? ": " : "", x->fmu.message);
    }
    for (int k = 0; k < n; k++) {
        double from = t0 + k * h;
        x->steps++;
        bough_signal_value(signal, from + fraction * h, x->motion);
        BOUGH_TRY(bough_fmu_set(&x->fmu, from, &x->body->fmu.input, x->motion));
        BOUGH_TRY(bough_fmu_step(&x->fmu, from, k < n - 1 ? h : t1 - from));
    }
    bough_signal_value(signal, t1, x->motion);
    BOUGH_TRY(bough_fmu_set(&x->fmu, t1, &x->body->fmu.input, x->motion));
    BOUGH_TRY(bough_fmu_get(&x->fmu, t1, &x->body->fmu.output, x->wrench));
    *t = t1;
    return bough_ok();
}

static void statistics(const void *self, bough_statistics *sum) {
    const fmu_member *x = self;
    sum->steps += x->steps;
}

// A copy holds the number of a state of the FMU, from 1; saving to the same copy replaces that state.
static void transfer(void *self, bough_snapshot *s) {
    fmu_member *x = self;
    int *number = bough_snapshot_room(s, sizeof *number);
    bough_snapshot_doubles(s, x->wrench, BOUGH_SCENE_WRENCH);
    if (s->move == BOUGH_SNAPSHOT_MEASURE) return;
    bool known = *number >= 1 && *number <= x->n_state;
    if (s->move == BOUGH_SNAPSHOT_SAVE && !known && x->n_state < MOST_STATES) {
        *number = ++x->n_state;
        known = true;
    }
    if (!known) {
        x->lost = true;
        return;
    }
    fmi3_state *state = &x->state[*number - 1];
    fmi3_status status = s->move == BOUGH_SNAPSHOT_SAVE ? x->fmu.get_state(x->fmu.instance, state)
                                                        : x->fmu.set_state(x->fmu.instance, *state);
    if (!bough_fmu_is_good(status)) x->lost = true;
}

static const bough_integrator_ops steps = {.title = "FMU", .advance = advance, .statistics = statistics};
static const bough_integrator_ops steps_and_states = {
    .title = "FMU", .advance = advance, .statistics = statistics, .transfer = transfer};

// -- the system -----------------------------------------------------------------------------------

static void output(void *self, double t, const double *state, const double *input, double *out) {
    (void)t, (void)state, (void)input;
    const fmu_member *x = self;
    memcpy(out, x->wrench, sizeof x->wrench);
}

// There are no states, and the outputs do not depend on the inputs at the same time.
static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    (void)self, (void)t, (void)state, (void)input, (void)rate;
    return true;
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    (void)self, (void)t, (void)state, (void)input, (void)state_rate, (void)input_rate;
    memset(rate, 0, BOUGH_SCENE_WRENCH * sizeof *rate);
}

static const bough_system_ops operations = {
    .derivative = derivative, .output = output, .output_tangent = output_tangent};

// -- building -------------------------------------------------------------------------------------

static void free_states(void *self) {
    fmu_member *x = self;
    for (int k = 0; k < x->n_state && x->fmu.instance; k++) x->fmu.free_state(x->fmu.instance, &x->state[k]);
}

bough_status bough_fmu_member_create(bough_arena *arena, const bough_scene_body *body, const double *motion,
                                     double duration, bough_member *member) {
    fmu_member *x = bough_arena_take(arena, sizeof *x);
    *x = (fmu_member){.body = body, .member = member};
    BOUGH_TRY(bough_fmu_open(arena, &body->fmu.model, body->name, &x->fmu));
    bough_arena_on_destroy(arena, free_states, x);
    BOUGH_TRY(bough_fmu_initialise(&x->fmu, 0, duration, &x->body->fmu.input, motion));
    BOUGH_TRY(bough_fmu_get(&x->fmu, 0, &x->body->fmu.output, x->wrench));
    bool restores = body->fmu.model.description.restores;
    *member = (bough_member){.system = {.name = body->name,
                                        .kind = "FMU",
                                        .n_input = BOUGH_SCENE_MOTION,
                                        .n_output = BOUGH_SCENE_WRENCH,
                                        .ops = &operations,
                                        .self = x},
                             .solver = "FMU",
                             .opaque = true,
                             .state = bough_arena_doubles(arena, 1),
                             .integrated = bough_arena_doubles(arena, 1),
                             .input = bough_arena_doubles(arena, BOUGH_SCENE_MOTION),
                             .integrator = {.ops = restores ? &steps_and_states : &steps, .self = x}};
    return bough_ok();
}

// All members as one system ẏ = F(t, y), theory (54), integrated by one method across macro steps: no
// coupling error. By the Rosenbrock method the members are coupled at its stages, each of which costs
// a member what its own sub-solver would; an implicit multistep method at a tight tolerance is the
// reference of every error figure.
#include "core/solve/rosenbrock.h"
#include "cosim/scheme.h"
#include "cosim/whole.h"

// -- steps coupled at the stages --------------------------------------------------------------------

typedef struct stages {
    const bough_assembly *assembly;
    const bough_member *whole;
    bough_whole *end, *now; // evaluations of F: at the step's end, for ∂F/∂t, and in the stage
    bough_whole *factors;   // of I − γhJ
    double *square;         // (n_member) sums of squares of the step's error

    // in progress
    bough_rosenbrock_step *step;
    int stage;
    bough_whole *evaluation[BOUGH_WHOLE_TIMES]; // `end` where it is asked for, and `now`
    int n_evaluation;
} stages;

// Completes the member's u of the last stage by its response to the others, and forms the argument of this
// stage.
static void set_argument(const stages *s, int i) {
    const int *offset = s->assembly->state_offset + i;
    if (s->stage == 0) return;
    bough_whole_respond(s->factors, i, s->step->u[s->stage - 1]);
    bough_rosenbrock_argument(s->step, s->stage, offset[0], offset[1]);
}

// The member's argument, unless it was formed for the member's outputs, its rate and its right side.
static void find_right_side(const stages *s, int i) {
    const int *offset = s->assembly->state_offset + i;
    if (!bough_whole_outputs_first(s->now, i)) set_argument(s, i);
    bough_pool_await(s->factors->pool, 0);
    bough_whole_rates_of(s->evaluation, s->n_evaluation, i);
    bough_rosenbrock_right_side(s->step, s->stage, offset[0], offset[1]);
}

// Outputs that the inputs of other members need. In the first stage F is evaluated at the step's end, too, if
// the step asks for ∂F/∂t.
static void begin_rates(stages *s) {
    const bough_rosenbrock_step *step = s->step;
    const double *state = s->stage == 0 ? step->y : step->at;
    for (int i = 0; i < s->assembly->n_member; i++)
        if (bough_whole_outputs_first(s->now, i)) set_argument(s, i);
    s->n_evaluation = 0;
    if (s->stage == 0 && step->drifts) {
        s->evaluation[s->n_evaluation++] = s->end;
        bough_whole_begin_rates(s->end, step->t + step->h, state, step->drift);
    }
    s->evaluation[s->n_evaluation++] = s->now;
    bough_whole_begin_rates(s->now, bough_rosenbrock_time(step, s->stage), state, step->u[s->stage]);
}

// The tasks of a stage: outputs of the leaders, right sides of the followers, their solutions, then the
// leaders, whose inputs wait for the outputs of all followers.
static void find_and_solve(void *self, int k) {
    stages *s = self;
    const int *member = s->assembly->by_role, n = s->assembly->n_follower;
    if (k == 0) {
        begin_rates(s);
    } else if (k <= n) {
        find_right_side(s, member[k - 1]);
    } else if (k <= 2 * n) {
        bough_pool_await(s->factors->pool, k - n);
        bough_whole_solve_of(s->factors, member[k - n - 1]);
    } else {
        int leader = member[k - n - 1];
        for (int j = 1; j <= n; j++) bough_pool_await(s->factors->pool, j);
        find_right_side(s, leader);
        bough_whole_solve_of(s->factors, leader);
    }
}

static void finish_member(void *self, int k) {
    const stages *s = self;
    int i = s->assembly->by_role[k];
    const int *offset = s->assembly->state_offset + i;
    bough_whole_respond(s->factors, i, s->step->u[BOUGH_ROSENBROCK_STAGES - 1]);
    s->square[i] = bough_rosenbrock_end(s->step, offset[0], offset[1]);
}

// One stage of all members. False where a rate is not finite.
static bool take_stage(stages *s) {
    int n_member = s->assembly->n_member, n_follower = s->assembly->n_follower;
    // every member by itself
    bough_whole_begin_solution(s->factors, s->step->u[s->stage]);
    bough_pool_run_pairs(s->factors->pool, 1, n_follower, 1 + n_follower + n_member, find_and_solve, s);
    // the interface; the members' responses to it follow with the next stage
    bough_whole_solve_interface(s->factors);
    bough_status status = bough_whole_failure(s->evaluation[0]);
    return bough_is_ok(&status);
}

static double find(void *self, bough_rosenbrock_step *step) {
    stages *s = self;
    double sum = 0;
    s->step = step;
    for (s->stage = 0; s->stage < BOUGH_ROSENBROCK_STAGES; s->stage++) {
        if (s->whole->stop && s->whole->stop()) return (double)NAN;
        if (!take_stage(s)) return (double)NAN;
    }
    const bough_assembly *a = s->assembly;
    bough_pool_run_pairs(s->factors->pool, 0, a->n_follower, a->n_member, finish_member, s);
    for (int i = 0; i < s->assembly->n_member; i++) sum += s->square[i];
    return sum;
}

static void couple_at_stages(bough_arena *arena, const bough_coupling *c, bough_member *whole) {
    stages *s = bough_arena_take(arena, sizeof *s);
    *s = (stages){.assembly = c->assembly,
                  .whole = whole,
                  .now = whole->system.self,
                  .end = bough_whole_create_evaluation(arena, c->assembly, c->pool),
                  .factors = whole->factors,
                  .square = bough_arena_doubles(arena, (size_t)c->assembly->n_member)};
    bough_rosenbrock_find_by(&whole->integrator, find, s);
}

// -- the scheme -------------------------------------------------------------------------------------

static bough_status create(bough_coupling *c, bough_arena *arena) {
    bough_member *whole = c->scheme_data = bough_arena_take(arena, sizeof *whole);
    bough_system system = bough_whole_system(arena, c->assembly, c->pool, "monolithic system");
    bough_status status = bough_member_create(arena, &system, c->t0, &c->options.integrator, whole);
    bool stagewise = c->options.integrator.kind == BOUGH_ROSENBROCK && whole->integrator.ops != NULL;
    if (bough_is_ok(&status) && stagewise) couple_at_stages(arena, c, whole);
    return status;
}

// The members' states are set for queries; only the integrator of the whole system runs.
static bough_status step(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_member *whole = c->scheme_data;
    // a start: the members' states are those of the whole
    if (!whole->started) {
        bough_assembly_states(a, whole->state);
        bough_member_set(whole, c->t0, whole->state);
    }
    assert(whole->time == c->t0);
    // the step
    BOUGH_TRY(bough_member_advance(whole, c->t1, NULL, c->restart));
    // the members' states, brought back to their constraints
    for (int i = 0; i < a->n_member; i++) {
        bough_member_set(a->member[i], c->t1, whole->state + a->state_offset[i]);
    }
    bough_assembly_states(a, whole->state);
    bough_coupling_begin(c);
    return bough_ok();
}

// The members have exchanged their values at all times: what is applied is what is obtained.
static void obtained(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int j = 0; j < a->n_input; j++) {
        int i = a->receiver[j];
        bough_signal_linear(&c->signal[i], j - a->input_offset[i], c->past.input[0][j], c->input[j]);
    }
}

static void snapshot(bough_coupling *c, bough_snapshot *s) { bough_member_snapshot(c->scheme_data, s); }

static bough_member *whole(const bough_coupling *c) { return c->scheme_data; }

const bough_scheme bough_scheme_monolithic = {
    .name = "monolithic",
    .summary = "all bodies in one system, coupled at the stages of the master's method: no coupling "
               "error",
    .one_system = true,
    .create = create,
    .step = step,
    .obtained = obtained,
    .snapshot = snapshot,
    .whole = whole,
};

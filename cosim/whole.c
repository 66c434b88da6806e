// The arrowhead matrix of theory (55): members are factored by themselves, the interface closes
// them.
#include "cosim/whole.h"

#include "core/base/linalg.h"

enum { FOLLOWERS, LEADERS, ALL };

typedef struct member_work {
    bough_whole *whole;
    const int *member;
    void (*work)(bough_whole *whole, int member);
} member_work;

static void run_member(void *data, int k) {
    const member_work *w = data;
    int i = w->member[k];
    w->whole->status[i].code = BOUGH_OK;
    w->work(w->whole, i);
}

static bough_status failure_among(const bough_whole *whole, int first, int last) {
    for (int k = first; k < last; k++) {
        const bough_status *status = &whole->status[whole->assembly->by_role[k]];
        if (!bough_is_ok(status)) return *status;
    }
    return bough_ok();
}

bough_status bough_whole_failure(const bough_whole *whole) {
    return failure_among(whole, 0, whole->assembly->n_member);
}

// work(whole, member) for the followers, the leaders or all, in parallel. Gives the first failure among these
// alone: the status of another member is that of an earlier call.
static bough_status each(bough_whole *whole, int whom, void (*work)(bough_whole *whole, int member)) {
    const bough_assembly *a = whole->assembly;
    int first = whom == LEADERS ? a->n_follower : 0, last = whom == FOLLOWERS ? a->n_follower : a->n_member;
    member_work w = {whole, a->by_role + first, work};
    bough_pool_run_pairs(whole->pool, 0, whom == LEADERS ? 0 : a->n_follower, last - first, run_member, &w);
    return failure_among(whole, first, last);
}

// -- evaluation -----------------------------------------------------------------------------------

// o_i = h_i(t, y_i, u_i)
static void find_output(bough_whole *whole, int i) {
    const bough_assembly *a = whole->assembly;
    const bough_system *s = &a->member[i]->system;
    s->ops->output(s->self, whole->time, whole->at + a->state_offset[i], whole->input + a->input_offset[i],
                   whole->output + a->output_offset[i]);
}

// Outputs of the leaders only, or of all members, in an order that needs no iteration.
static void find_outputs(bough_whole *whole, bool all) {
    const bough_assembly *a = whole->assembly;
    for (int n = 0; n < a->n_member; n++) {
        int i = a->order[n];
        if (!all && !a->leads[i]) continue;
        bough_assembly_gather(a, i, whole->output, whole->input);
        find_output(whole, i);
    }
}

void bough_whole_inputs(bough_whole *whole, double t, const double *state) {
    whole->time = t;
    whole->at = state;
    find_outputs(whole, true);
    for (int i = 0; i < whole->assembly->n_member; i++)
        bough_assembly_gather(whole->assembly, i, whole->output, whole->input);
}

void bough_whole_begin_rates(bough_whole *whole, double t, const double *state, double *rate) {
    whole->time = t;
    whole->at = state;
    whole->x = rate;
    find_outputs(whole, !whole->assembly->followers_last);
}

bool bough_whole_outputs_first(const bough_whole *whole, int i) {
    return !whole->assembly->followers_last || whole->assembly->leads[i];
}

// Rates and outputs of a system that has no call for both.
static bool evaluate_separately(const bough_system *s, const double *state, int n,
                                const bough_evaluation *at) {
    for (int k = 0; k < n; k++) {
        if (!s->ops->derivative(s->self, at[k].t, state, at[k].input, at[k].rate)) return false;
        if (at[k].output) s->ops->output(s->self, at[k].t, state, at[k].input, at[k].output);
    }
    return true;
}

void bough_whole_rates_of(bough_whole *const *evaluation, int n, int i) {
    bough_whole *first = evaluation[0];
    const bough_assembly *a = first->assembly;
    const bough_member *m = a->member[i];
    const double *state = first->at + a->state_offset[i];
    bool outputs_known = bough_whole_outputs_first(first, i);
    bough_evaluation at[BOUGH_WHOLE_TIMES];
    // its inputs at each time
    for (int k = 0; k < n; k++) {
        bough_whole *e = evaluation[k];
        bough_assembly_gather(a, i, e->output, e->input);
        at[k] = (bough_evaluation){e->time, e->input + a->input_offset[i], e->x + a->state_offset[i],
                                   outputs_known ? NULL : e->output + a->output_offset[i]};
        e->status[i].code = BOUGH_OK;
    }
    // its rates, and its outputs unless they were needed before
    bool finite = m->system.ops->evaluate ? m->system.ops->evaluate(m->system.self, state, n, at)
                                          : evaluate_separately(&m->system, state, n, at);
    if (finite) return;
    first->status[i] =
        bough_fail(BOUGH_FAILED, "%s: no finite rate of change at %.6g s", m->system.name, m->time);
}

static void rate_of(bough_whole *whole, int i) { bough_whole_rates_of(&whole, 1, i); }

bough_status bough_whole_rate(bough_whole *whole, double t, const double *state, double *rate) {
    bough_whole_begin_rates(whole, t, state, rate);
    // the inputs of leaders follow from the outputs of followers
    BOUGH_TRY(each(whole, FOLLOWERS, rate_of));
    return each(whole, LEADERS, rate_of);
}

// -- factors --------------------------------------------------------------------------------------

static bough_operating_point operating_point(const bough_whole *whole, int i) {
    const bough_assembly *a = whole->assembly;
    return (bough_operating_point){whole->setup_time, whole->setup_state + a->state_offset[i],
                                   whole->setup_input + a->input_offset[i], whole->gamma};
}

static bool keeps_factors(const bough_whole *whole, int i) {
    return whole->keeps && whole->assembly->member[i]->system.ops->kept_tangent != NULL;
}

// Leaders first: their responses take long, and the responses of followers need them.
static void factor_member(void *self, int place) {
    bough_whole *whole = self;
    const bough_assembly *a = whole->assembly;
    bough_interface *k = whole->interface;
    int i = a->by_role[(place + a->n_follower) % a->n_member];
    bough_operating_point at = operating_point(whole, i);
    whole->status[i].code = BOUGH_OK;
    if (keeps_factors(whole, i)) return;
    bool good = whole->linearised || bough_interface_linearise(k, i, &at);
    if (good && bough_interface_factor(k, i, &at)) return;
    whole->status[i] = bough_fail(BOUGH_RETRY, "%s: singular Newton matrix", a->member[i]->system.name);
}

// The follower's response to the coordinates of the interface.
static void respond(bough_whole *whole, int i) {
    bough_operating_point at = operating_point(whole, i);
    if (!keeps_factors(whole, i)) bough_interface_respond(whole->interface, i, &at);
}

static bool factor_border(bough_whole *whole);

// The next factors are those about this point.
static void set_point(bough_whole *whole, double t, const double *state, const double *input) {
    const bough_assembly *a = whole->assembly;
    memcpy(whole->setup_state, state, (size_t)a->n_state * sizeof(double));
    memcpy(whole->setup_input, input, (size_t)a->n_input * sizeof(double));
    whole->setup_time = t;
    whole->linearised = whole->keeps = false;
}

// Factors I − γJ there.
static bough_status factor_there(bough_whole *whole, double gamma) {
    assert(whole->interface != NULL);
    whole->gamma = gamma;
    int n = whole->assembly->n_member, n_follower = whole->assembly->n_follower;
    bough_pool_run_pairs(whole->pool, n - n_follower, n_follower, n, factor_member, whole);
    BOUGH_TRY(bough_whole_failure(whole));
    whole->linearised = true;
    // responses of the followers to the leaders, then the interface
    each(whole, FOLLOWERS, respond);
    whole->keeps = false;
    if (bough_interface_close(whole->interface) && factor_border(whole)) return bough_ok();
    return bough_fail(BOUGH_RETRY, "the interface's Newton matrix is singular");
}

bough_status bough_whole_setup(bough_whole *whole, double t, const double *state, const double *input,
                               double gamma) {
    set_point(whole, t, state, input);
    return factor_there(whole, gamma);
}

// -- solution -------------------------------------------------------------------------------------

// Until a leader is solved, its coordinates are those of the last solution: others may still respond to them.
void bough_whole_begin_solution(bough_whole *whole, double *x) { whole->x = x; }

// x_i = (I − γJ_i)⁻¹ r_i and the outputs' change with it, the inputs held. A member whose states are
// coordinates of the interface leaves r_i to the interface, which solves for them.
void bough_whole_solve_of(bough_whole *whole, int i) {
    const bough_assembly *a = whole->assembly;
    const bough_system *s = &a->member[i]->system;
    const bough_interface_member *part = &whole->interface->part[i];
    double *x = whole->x + a->state_offset[i], *moved = whole->output_change + a->output_offset[i];
    double *coordinate = whole->interface->coordinate + part->first;
    if (part->is_leader) memset(coordinate, 0, (size_t)part->n * sizeof(double));
    if (part->by_state) {
        memcpy(coordinate, x, (size_t)s->n_state * sizeof(double));
        memset(x, 0, (size_t)s->n_state * sizeof(double));
    }
    if (bough_all_zero(s->n_state, x)) { // as of all members but one in a column of the inverse
        memset(moved, 0, (size_t)s->n_output * sizeof(double));
        return;
    }
    bough_operating_point at = operating_point(whole, i);
    bough_interface_solve_member(whole->interface, i, x);
    bough_interface_output_change(whole->interface, i, &at, x, NULL, moved);
}

// The followers' inputs change with the leaders' outputs, then the leaders' with the followers'.
void bough_whole_solve_interface(bough_whole *whole) {
    const bough_assembly *a = whole->assembly;
    for (int k = 0; k < a->n_member; k++) {
        int i = a->by_role[k];
        bough_assembly_gather(a, i, whole->output_change, whole->change);
        if (k >= a->n_follower) continue;
        bough_interface_add_output_response(whole->interface, i, whole->change + a->input_offset[i],
                                            whole->output_change + a->output_offset[i]);
    }
    // w and the inputs' change with it
    bough_interface_solve(whole->interface, whole->change);
}

void bough_whole_respond(const bough_whole *whole, int i, double *x) {
    const bough_assembly *a = whole->assembly;
    bough_interface_add_response(whole->interface, i, whole->change + a->input_offset[i],
                                 x + a->state_offset[i]);
}

// x_i with the response to the interface.
static void complete(bough_whole *whole, int i) { bough_whole_respond(whole, i, whole->x); }

// The interface, members with their response to it.
static void solve_coupling(bough_whole *whole) {
    bough_whole_solve_interface(whole);
    each(whole, ALL, complete);
}

// As if no states were held: first the members by themselves.
static void solve_free(bough_whole *whole, double *x) {
    bough_whole_begin_solution(whole, x);
    each(whole, ALL, bough_whole_solve_of);
    solve_coupling(whole);
}

void bough_whole_close(bough_whole *whole, double *change) {
    memset(whole->interface->coordinate, 0, (size_t)whole->interface->n * sizeof(double));
    bough_interface_solve(whole->interface, change);
}

// Member by member; without quaternions there is nothing to remove.
void bough_whole_project(const bough_whole *whole, const double *state, double *x) {
    const bough_assembly *a = whole->assembly;
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        int at = a->state_offset[i];
        if (s->ops->project) s->ops->project(s->self, state + at, x + at);
    }
}

// The border: responses of all states to a force on each held one; its rows of held states are factored.
static bool factor_border(bough_whole *whole) {
    int n = whole->assembly->n_state, held = whole->n_held;
    for (int j = 0; j < held; j++) {
        double *column = whole->border + (size_t)j * n;
        memset(column, 0, (size_t)n * sizeof *column);
        column[whole->held[j]] = 1;
        solve_free(whole, column);
        for (int i = 0; i < held; i++) {
            whole->multiplier[j * held + i] = column[whole->held[i]];
        }
    }
    return held == 0 || bough_dense_factor(held, whole->multiplier, whole->held_pivot);
}

// Subtracts the response to the forces that hold the held states, so that these are zero.
static void hold(bough_whole *whole, double *x) {
    int n = whole->assembly->n_state, held = whole->n_held;
    if (held == 0) return;
    // the forces, then the response of all states to them
    for (int i = 0; i < held; i++) whole->held_force[i] = x[whole->held[i]];
    bough_dense_solve(held, 1, whole->multiplier, whole->held_pivot, whole->held_force);
    for (int j = 0; j < held; j++) {
        const double *column = whole->border + (size_t)j * n;
        for (int k = 0; k < n; k++) x[k] -= whole->held_force[j] * column[k];
    }
    for (int i = 0; i < held; i++) x[whole->held[i]] = 0;
}

void bough_whole_solve(bough_whole *whole, double *x) {
    solve_free(whole, x);
    hold(whole, x);
}

void bough_whole_follow(bough_whole *whole, int output, double *x) {
    const bough_assembly *a = whole->assembly;
    memset(x, 0, (size_t)a->n_state * sizeof *x);
    memset(whole->output_change, 0, (size_t)a->n_output * sizeof(double));
    memset(whole->interface->coordinate, 0, (size_t)whole->interface->n * sizeof(double));
    whole->output_change[output] = 1;
    bough_whole_begin_solution(whole, x);
    solve_coupling(whole);
    hold(whole, x);
}

// -- memory ---------------------------------------------------------------------------------------

bough_whole *bough_whole_create_evaluation(bough_arena *arena, const bough_assembly *assembly,
                                           bough_pool *pool) {
    bough_whole *whole = bough_arena_take(arena, sizeof *whole);
    whole->assembly = assembly;
    whole->pool = pool;
    whole->status = bough_arena_take(arena, (size_t)assembly->n_member * sizeof *whole->status);
    whole->input = bough_arena_doubles(arena, (size_t)assembly->n_input);
    whole->output = bough_arena_doubles(arena, (size_t)assembly->n_output);
    return whole;
}

bough_whole *bough_whole_create(bough_arena *arena, const bough_assembly *assembly, bough_pool *pool) {
    bough_whole *whole = bough_whole_create_evaluation(arena, assembly, pool);
    whole->setup_state = bough_arena_doubles(arena, (size_t)assembly->n_state);
    bough_arena_each(arena, (size_t)assembly->n_input, &whole->setup_input, &whole->change);
    whole->output_change = bough_arena_doubles(arena, (size_t)assembly->n_output);
    whole->interface = bough_interface_create(arena, assembly);
    return whole;
}

void bough_whole_hold(bough_arena *arena, bough_whole *whole, int n, const int *held) {
    size_t count = (size_t)n;
    whole->n_held = n;
    whole->held = held;
    whole->border = bough_arena_doubles(arena, count * (size_t)whole->assembly->n_state);
    whole->multiplier = bough_arena_doubles(arena, count * count);
    whole->held_force = bough_arena_doubles(arena, count);
    whole->held_pivot = bough_arena_take(arena, (count + 1) * sizeof(int));
}

// -- as a system without ports (core/solve/system.h) ------------------------------------------------

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    (void)input;
    bough_status status = bough_whole_rate(self, t, state, rate);
    return bough_is_ok(&status);
}

static void *factors(void *self, bough_arena *arena) {
    const bough_whole *whole = self;
    return bough_whole_create(arena, whole->assembly, whole->pool);
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
    (void)self, (void)input;
    bough_whole *own = factors;
    bough_whole_inputs(own, t, state);
    set_point(own, t, state, own->input);
    return true;
}

static bool linearise_ahead(void *self, double t, const double *state, const double *ahead, bool keep,
                            void *factors) {
    bough_whole *own = factors;
    const bough_assembly *a = own->assembly;
    linearise(self, t, state, NULL, factors);
    own->keeps = keep;
    // those whose tangents may be ahead are linearised where they will be, theory (115)
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        int first = a->state_offset[i];
        if (!s->ahead || a->n_follower == 0) continue;
        memcpy(own->setup_state + first, ahead + first, (size_t)s->n_state * sizeof *ahead);
    }
    return true;
}

static bool factor(void *self, void *factors, double gamma) {
    (void)self;
    bough_status status = factor_there(factors, gamma);
    return bough_is_ok(&status);
}

static void solve(void *self, void *factors, double *x) {
    (void)self;
    bough_whole_solve(factors, x);
}

// Brings every member to its constraints; true where one was far from them.
static bool constrain(void *self, double t, double *state) {
    const bough_assembly *a = ((const bough_whole *)self)->assembly;
    bool far = false;
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        if (s->ops->constrain == NULL) continue;
        far = s->ops->constrain(s->self, t, state + a->state_offset[i]) || far;
    }
    return far;
}

static const bough_system_ops operations = {
    .derivative = derivative,
    .factors = factors,
    .linearise = linearise,
    .factor = factor,
    .solve = solve,
    .linearise_ahead = linearise_ahead,
    .constrain = constrain,
};

bough_system bough_whole_system(bough_arena *arena, const bough_assembly *a, bough_pool *pool,
                                const char *name) {
    bough_whole *evaluation = bough_whole_create_evaluation(arena, a, pool);
    double *scale = bough_arena_doubles(arena, (size_t)a->n_state);
    double *initial = bough_arena_doubles(arena, (size_t)a->n_state);
    bough_assembly_scales(a, scale);
    bough_assembly_states(a, initial);
    // of the body that is least damped for its stiffness
    double elastic_rate = 0;
    for (int i = 0; i < a->n_member; i++)
        elastic_rate = fmax(elastic_rate, a->member[i]->system.elastic_rate);
    return (bough_system){.name = name,
                          .kind = "assembly",
                          .n_state = a->n_state,
                          .scale = scale,
                          .initial = initial,
                          .elastic_rate = elastic_rate,
                          .ops = &operations,
                          .self = evaluation};
}

#include "cosim/coupled.h"

#include "core/base/linalg.h"

#include <assert.h>
#include <string.h>

enum { FOLLOWERS, LEADERS, ALL };

typedef struct member_work {
    bough_coupled *coupled;
    const int *member;
    void (*work)(bough_coupled *coupled, int member);
} member_work;

static void run_member(void *data, int k) {
    const member_work *w = data;
    int i = w->member[k];
    w->coupled->status[i].code = BOUGH_OK;
    w->work(w->coupled, i);
}

bough_status bough_coupled_failure(const bough_coupled *coupled) {
    for (int k = 0; k < coupled->assembly->n_member; k++) {
        const bough_status *status = &coupled->status[coupled->order[k]];
        if (!bough_is_ok(status)) return *status;
    }
    return bough_ok();
}

// work(coupled, member) for every one of them, in parallel; the first failure.
static bough_status each(bough_coupled *a, int whom, void (*work)(bough_coupled *a, int member)) {
    int n_member = a->assembly->n_member, n_leader = n_member - a->n_follower;
    int n = whom == ALL ? n_member : whom == LEADERS ? n_leader : a->n_follower;
    member_work w = {a, whom == LEADERS ? a->order + a->n_follower : a->order, work};
    bough_pool_run(a->pool, n, run_member, &w);
    return bough_coupled_failure(a);
}

// -- evaluation -----------------------------------------------------------------------------------

static void find_output(bough_coupled *coupled, int i) {
    const bough_assembly *a = coupled->assembly;
    const bough_system *s = &a->member[i]->system;
    s->ops->output(s->self, coupled->time, coupled->at + a->state_offset[i],
                   coupled->input + a->input_offset[i], coupled->output + a->output_offset[i]);
}

// In an order that needs no iteration: of the leaders only, or of all.
static void find_outputs(bough_coupled *coupled, bool all) {
    const bough_assembly *a = coupled->assembly;
    for (int n = 0; n < a->n_member; n++) {
        int i = a->order[n];
        if (!all && !a->leads[i]) continue;
        bough_assembly_gather(a, i, coupled->output, coupled->input);
        find_output(coupled, i);
    }
}

void bough_coupled_inputs(bough_coupled *coupled, double t, const double *state) {
    coupled->time = t;
    coupled->at = state;
    find_outputs(coupled, true);
    for (int i = 0; i < coupled->assembly->n_member; i++)
        bough_assembly_gather(coupled->assembly, i, coupled->output, coupled->input);
}

void bough_coupled_begin_rates(bough_coupled *coupled, double t, const double *state, double *rate) {
    coupled->time = t;
    coupled->at = state;
    coupled->x = rate;
    find_outputs(coupled, !coupled->assembly->followers_last);
}

bool bough_coupled_outputs_first(const bough_coupled *coupled, int i) {
    return !coupled->assembly->followers_last || coupled->assembly->leads[i];
}

// Both by one call where the system has one.
static bool evaluate_separately(const bough_system *s, const double *state, int n,
                                const bough_evaluation *at) {
    for (int k = 0; k < n; k++) {
        if (!s->ops->derivative(s->self, at[k].t, state, at[k].input, at[k].rate)) return false;
        if (at[k].output) s->ops->output(s->self, at[k].t, state, at[k].input, at[k].output);
    }
    return true;
}

void bough_coupled_rates_of(bough_coupled *const *which, int n, int i) {
    const bough_assembly *a = which[0]->assembly;
    const bough_member *m = a->member[i];
    const double *state = which[0]->at + a->state_offset[i];
    bool waited_for = !bough_coupled_outputs_first(which[0], i);
    bough_evaluation at[BOUGH_COUPLED_TIMES];
    for (int k = 0; k < n; k++) {
        bough_coupled *c = which[k];
        bough_assembly_gather(a, i, c->output, c->input);
        at[k] = (bough_evaluation){c->time, c->input + a->input_offset[i], c->x + a->state_offset[i],
                                   waited_for ? c->output + a->output_offset[i] : NULL};
        c->status[i].code = BOUGH_OK;
    }
    bool finite = m->system.ops->evaluate ? m->system.ops->evaluate(m->system.self, state, n, at)
                                          : evaluate_separately(&m->system, state, n, at);
    if (finite) return;
    which[0]->status[i] =
        bough_fail(BOUGH_FAILED, "%s: no finite rate of change at %.6g s", m->system.name, m->time);
}

static void rate_of(bough_coupled *coupled, int i) { bough_coupled_rates_of(&coupled, 1, i); }

bough_status bough_coupled_rate(bough_coupled *coupled, double t, const double *state, double *rate) {
    bough_coupled_begin_rates(coupled, t, state, rate);
    bough_status status = each(coupled, FOLLOWERS, rate_of);
    return bough_is_ok(&status) ? each(coupled, LEADERS, rate_of) : status;
}

// -- factors --------------------------------------------------------------------------------------

static bough_operating_point operating_point(const bough_coupled *coupled, int i) {
    const bough_assembly *a = coupled->assembly;
    return (bough_operating_point){coupled->setup_time, coupled->setup_state + a->state_offset[i],
                                   coupled->setup_input + a->input_offset[i], coupled->gamma};
}

static void check(bough_coupled *coupled, int i, bool good) {
    if (good) return;
    coupled->status[i] =
        bough_fail(BOUGH_RETRY, "%s: singular Newton matrix", coupled->assembly->member[i]->system.name);
}

// Leaders first, whose responses take long; those of followers wait for them.
static void factor(void *self, int place) {
    bough_coupled *coupled = self;
    const bough_assembly *a = coupled->assembly;
    bough_condensed *k = coupled->interface;
    int i = coupled->order[(place + coupled->n_follower) % a->n_member];
    bough_operating_point at = operating_point(coupled, i);
    coupled->status[i].code = BOUGH_OK;
    bool good = coupled->linearised || bough_condensed_linearise(k, i, &at);
    if (a->leads[i]) {
        check(coupled, i, good && bough_condensed_factor_leader(k, i, &at));
    } else {
        check(coupled, i, good && bough_condensed_factor_follower(k, i, &at));
    }
}

static void respond(bough_coupled *coupled, int i) {
    bough_operating_point at = operating_point(coupled, i);
    bough_condensed_respond(coupled->interface, i, &at);
}

static bool factor_border(bough_coupled *coupled);

void bough_coupled_linearise(bough_coupled *coupled, double t, const double *state, const double *input) {
    const bough_assembly *a = coupled->assembly;
    memcpy(coupled->setup_state, state, (size_t)a->n_state * sizeof(double));
    memcpy(coupled->setup_input, input, (size_t)a->n_input * sizeof(double));
    coupled->setup_time = t;
    coupled->linearised = false;
}

bough_status bough_coupled_factor(bough_coupled *coupled, double gamma) {
    assert(coupled->interface != NULL);
    coupled->gamma = gamma;
    bough_pool_run(coupled->pool, coupled->assembly->n_member, factor, coupled);
    bough_status status = bough_coupled_failure(coupled);
    if (!bough_is_ok(&status)) return status;
    coupled->linearised = true;
    each(coupled, FOLLOWERS, respond);
    if (bough_condensed_close(coupled->interface) && factor_border(coupled)) return status;
    return bough_fail(BOUGH_RETRY, "the interface's Newton matrix is singular");
}

bough_status bough_coupled_setup(bough_coupled *coupled, double t, const double *state, const double *input,
                                 double gamma) {
    bough_coupled_linearise(coupled, t, state, input);
    return bough_coupled_factor(coupled, gamma);
}

// -- solution -------------------------------------------------------------------------------------

// The outputs' change with x and the inputs' change δu, which may be NULL.
static void find_output_change(bough_coupled *coupled, int i, const double *x, const double *change) {
    bough_operating_point at = operating_point(coupled, i);
    bough_condensed_output_change(coupled->interface, i, &at, x, change,
                                  coupled->output_change + coupled->assembly->output_offset[i]);
}

// x_i = (I − γJ_i)⁻¹ r_i and the outputs' change with it, the inputs held; where the states are the
// coordinates, the interface does that.
static void solve_leader(bough_coupled *coupled, int i) {
    const bough_assembly *a = coupled->assembly;
    const bough_system *s = &a->member[i]->system;
    const bough_condensed_member *w = &coupled->interface->part[i];
    double *x = coupled->x + a->state_offset[i];
    double *coordinate = coupled->interface->coordinate + w->first;
    if (!w->by_state) {
        memset(coordinate, 0, (size_t)w->n * sizeof(double));
        bough_condensed_solve_member(coupled->interface, i, x);
        find_output_change(coupled, i, x, NULL);
        return;
    }
    memcpy(coordinate, x, (size_t)s->n_state * sizeof(double));
    memset(x, 0, (size_t)s->n_state * sizeof(double));
    memset(coupled->output_change + a->output_offset[i], 0, (size_t)s->n_output * sizeof(double));
}

// The same of a follower under the changes from outside.
static void solve_follower(bough_coupled *coupled, int i) {
    const bough_assembly *a = coupled->assembly;
    const double *outside = coupled->outside ? coupled->outside + a->input_offset[i] : NULL;
    double *x = coupled->x + a->state_offset[i];
    if (outside) bough_condensed_add_columns(coupled->interface, i, coupled->gamma, outside, x);
    bough_condensed_solve_member(coupled->interface, i, x);
    find_output_change(coupled, i, x, outside);
}

void bough_coupled_begin_solution(bough_coupled *coupled, const double *outside, double *x) {
    coupled->x = x;
    coupled->outside = outside;
}

void bough_coupled_solve_of(bough_coupled *coupled, int i) {
    if (coupled->assembly->leads[i]) {
        solve_leader(coupled, i);
    } else {
        solve_follower(coupled, i);
    }
}

// What the outputs so far change of the inputs.
static void gather_changes(bough_coupled *coupled, int i) {
    const bough_assembly *a = coupled->assembly;
    for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
        coupled->led[j] = coupled->output_change[a->source[j]];
        coupled->change[j] = coupled->led[j] + (coupled->outside ? coupled->outside[j] : 0);
    }
}

// Followers under what the leaders do by themselves, then the leaders.
static void gather_all_changes(bough_coupled *coupled) {
    const bough_assembly *a = coupled->assembly;
    for (int k = 0; k < a->n_member; k++) {
        int i = coupled->order[k];
        gather_changes(coupled, i);
        if (k >= coupled->n_follower) continue;
        bough_condensed_add_output_response(coupled->interface, i, coupled->led + a->input_offset[i],
                                            coupled->output_change + a->output_offset[i]);
    }
}

void bough_coupled_solve_interface(bough_coupled *coupled) {
    gather_all_changes(coupled);
    bough_condensed_solve(coupled->interface, coupled->change);
    for (int j = 0; j < coupled->assembly->n_input; j++)
        coupled->led[j] = coupled->change[j] - (coupled->outside ? coupled->outside[j] : 0);
}

void bough_coupled_respond(const bough_coupled *coupled, int i, double *x) {
    const bough_assembly *a = coupled->assembly;
    bough_condensed_add_response(coupled->interface, i, coupled->led + a->input_offset[i],
                                 x + a->state_offset[i]);
}

static void complete(bough_coupled *coupled, int i) { bough_coupled_respond(coupled, i, coupled->x); }

void bough_coupled_solve_driven(bough_coupled *coupled, const double *outside, double *x) {
    bough_coupled_begin_solution(coupled, outside, x);
    each(coupled, ALL, bough_coupled_solve_of);
    bough_coupled_solve_interface(coupled);
    each(coupled, ALL, complete);
}

void bough_coupled_close(bough_coupled *coupled, double *outside) {
    memset(coupled->interface->coordinate, 0, (size_t)coupled->interface->n * sizeof(double));
    bough_condensed_solve(coupled->interface, outside);
}

void bough_coupled_project(const bough_coupled *coupled, const double *state, double *x) {
    const bough_assembly *a = coupled->assembly;
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        int at = a->state_offset[i];
        if (s->ops->project) s->ops->project(s->self, state + at, x + at);
    }
}

// The border's multipliers make the held entries of its solutions vanish.
static bool factor_border(bough_coupled *coupled) {
    int n = coupled->assembly->n_state, held = coupled->n_held;
    for (int j = 0; j < held; j++) {
        double *column = coupled->border + (size_t)j * n;
        memset(column, 0, (size_t)n * sizeof *column);
        column[coupled->held[j]] = 1;
        bough_coupled_solve_driven(coupled, NULL, column);
        for (int i = 0; i < held; i++) {
            coupled->multiplier[j * held + i] = column[coupled->held[i]];
        }
    }
    return held == 0 || bough_dense_factor(held, coupled->multiplier, coupled->held_pivot);
}

void bough_coupled_solve(bough_coupled *coupled, double *x) {
    int n = coupled->assembly->n_state, held = coupled->n_held;
    bough_coupled_solve_driven(coupled, NULL, x);
    if (held == 0) return;
    for (int i = 0; i < held; i++) coupled->share[i] = x[coupled->held[i]];
    bough_dense_solve(held, 1, coupled->multiplier, coupled->held_pivot, coupled->share);
    for (int j = 0; j < held; j++) {
        const double *column = coupled->border + (size_t)j * n;
        for (int k = 0; k < n; k++) x[k] -= coupled->share[j] * column[k];
    }
    for (int i = 0; i < held; i++) x[coupled->held[i]] = 0;
}

// -- memory ---------------------------------------------------------------------------------------

static void take(bough_coupled *coupled, bough_arena *arena) {
    const bough_assembly *a = coupled->assembly;
    size_t n_input = (size_t)a->n_input, n_output = (size_t)a->n_output;
    coupled->status = bough_arena_take(arena, (size_t)a->n_member * sizeof *coupled->status);
    coupled->order = bough_arena_take(arena, (size_t)a->n_member * sizeof *coupled->order);
    coupled->input = bough_arena_doubles(arena, n_input);
    coupled->output = bough_arena_doubles(arena, n_output);
    for (int i = 0; i < a->n_member; i++) {
        if (!a->leads[i]) coupled->order[coupled->n_follower++] = i;
    }
    for (int i = 0, n = coupled->n_follower; i < a->n_member; i++) {
        if (a->leads[i]) coupled->order[n++] = i;
    }
}

static void take_solution(bough_coupled *coupled, bough_arena *arena) {
    const bough_assembly *a = coupled->assembly;
    coupled->setup_state = bough_arena_doubles(arena, (size_t)a->n_state);
    bough_arena_each(arena, (size_t)a->n_input, &coupled->setup_input, &coupled->change, &coupled->led);
    coupled->output_change = bough_arena_doubles(arena, (size_t)a->n_output);
}

bough_coupled *bough_coupled_create_evaluation(bough_arena *arena, const bough_assembly *assembly,
                                               bough_pool *pool) {
    bough_coupled *a = bough_arena_take(arena, sizeof *a);
    a->assembly = assembly;
    a->pool = pool;
    take(a, arena);
    return a;
}

bough_coupled *bough_coupled_create(bough_arena *arena, const bough_assembly *assembly, bough_pool *pool) {
    bough_coupled *a = bough_coupled_create_evaluation(arena, assembly, pool);
    take_solution(a, arena);
    a->interface = bough_condensed_create(arena, assembly);
    return a;
}

void bough_coupled_hold(bough_arena *arena, bough_coupled *coupled, int n, const int *held) {
    size_t count = (size_t)n;
    coupled->n_held = n;
    coupled->held = held;
    coupled->border = bough_arena_doubles(arena, count * (size_t)coupled->assembly->n_state);
    coupled->multiplier = bough_arena_doubles(arena, count * count);
    coupled->share = bough_arena_doubles(arena, count);
    coupled->held_pivot = bough_arena_take(arena, (count + 1) * sizeof(int));
}

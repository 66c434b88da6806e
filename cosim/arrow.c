#include "cosim/arrow.h"

#include "core/linalg.h"

#include <string.h>

enum { FOLLOWERS, LEADERS, ALL };

typedef struct member_work {
    bough_arrow *arrow;
    const int *member;
    void (*work)(bough_arrow *arrow, int member);
} member_work;

static void run_member(void *data, int k) {
    const member_work *w = data;
    int i = w->member[k];
    w->arrow->status[i].code = BOUGH_OK;
    w->work(w->arrow, i);
}

// work(arrow, member) for every one of them, in parallel; the first failure in member order.
static bough_status each(bough_arrow *a, int whom, void (*work)(bough_arrow *a, int member)) {
    int n_member = a->assembly->n_member, n_leader = n_member - a->n_follower;
    int n = whom == ALL ? n_member : whom == LEADERS ? n_leader : a->n_follower;
    member_work w = {a, whom == LEADERS ? a->order + a->n_follower : a->order, work};
    bough_pool_run(a->pool, n, run_member, &w);
    for (int i = 0; i < n_member; i++) {
        if (!bough_is_ok(&a->status[i])) return a->status[i];
    }
    return bough_ok();
}

// -- evaluation -----------------------------------------------------------------------------------

void bough_arrow_inputs(bough_arrow *arrow, double t, const double *state) {
    const bough_assembly *a = arrow->assembly;
    for (int n = 0; n < a->n_member; n++) {
        int i = a->order[n];
        const bough_subsystem *s = a->member[i];
        bough_assembly_gather(a, i, arrow->output, arrow->input);
        s->ops->output(s->self, t, state + a->state_offset[i], arrow->input + a->input_offset[i],
                       arrow->output + a->output_offset[i]);
    }
    for (int i = 0; i < a->n_member; i++)
        bough_assembly_gather(a, i, arrow->output, arrow->input);
}

static void evaluate(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    const bough_subsystem *s = a->member[i];
    if (!s->ops->derivative(s->self, arrow->time, arrow->at + a->state_offset[i],
                            arrow->input + a->input_offset[i], arrow->x + a->state_offset[i])) {
        arrow->status[i] =
            bough_fail(BOUGH_FAILED, "%s: no finite rate of change at %.6g s", s->name, *s->time);
    }
}

bough_status bough_arrow_rate(bough_arrow *arrow, double t, const double *state, double *rate) {
    bough_arrow_inputs(arrow, t, state);
    arrow->time = t;
    arrow->at = state;
    arrow->x = rate;
    return each(arrow, ALL, evaluate);
}

// -- factors --------------------------------------------------------------------------------------

static bough_operating_point operating_point(const bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    return (bough_operating_point){arrow->setup_time, arrow->setup_state + a->state_offset[i],
                                   arrow->setup_input + a->input_offset[i], arrow->gamma};
}

static void factored(bough_arrow *arrow, int i, bool good) {
    if (good) return;
    arrow->status[i] =
        bough_fail(BOUGH_RETRY, "%s: singular Newton matrix", arrow->assembly->member[i]->name);
}

static void factor_leader(bough_arrow *arrow, int i) {
    bough_operating_point at = operating_point(arrow, i);
    factored(arrow, i, bough_condensed_factor_leader(arrow->interface, i, &at));
}

static void factor_follower(bough_arrow *arrow, int i) {
    bough_operating_point at = operating_point(arrow, i);
    factored(arrow, i, bough_condensed_factor_follower(arrow->interface, i, &at));
}

static bool factor_border(bough_arrow *arrow);

void bough_arrow_adopt(bough_arrow *arrow, bough_condensed *interface, double t,
                       const double *state, const double *input, double gamma) {
    const bough_assembly *a = arrow->assembly;
    memcpy(arrow->setup_state, state, (size_t)a->n_state * sizeof(double));
    memcpy(arrow->setup_input, input, (size_t)a->n_input * sizeof(double));
    arrow->setup_time = t;
    arrow->gamma = gamma;
    arrow->interface = interface;
}

bough_status bough_arrow_setup(bough_arrow *arrow, double t, const double *state,
                               const double *input, double gamma) {
    bough_arrow_adopt(arrow, arrow->own, t, state, input, gamma);
    bough_status status = each(arrow, LEADERS, factor_leader);
    if (!bough_is_ok(&status)) return status;
    status = each(arrow, FOLLOWERS, factor_follower);
    if (!bough_is_ok(&status)) return status;
    if (bough_condensed_close(arrow->interface) && factor_border(arrow)) return status;
    return bough_fail(BOUGH_RETRY, "the interface's Newton matrix is singular");
}

// -- solution -------------------------------------------------------------------------------------

// The outputs' change with x and the inputs' change δu, which may be NULL.
static void find_output_change(bough_arrow *arrow, int i, const double *x, const double *change) {
    const bough_assembly *a = arrow->assembly;
    const bough_subsystem *s = a->member[i];
    s->ops->output_tangent(s->self, arrow->setup_time, arrow->setup_state + a->state_offset[i],
                           arrow->setup_input + a->input_offset[i], x, change,
                           arrow->output_change + a->output_offset[i]);
}

// x_i = (I − γJ_i)⁻¹ r_i and the outputs' change with it, the inputs held; where the states are the
// coordinates they take part in the interface as a whole.
static void solve_leader(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    const bough_subsystem *s = a->member[i];
    const bough_answer *w = &arrow->interface->of[i];
    double *x = arrow->x + a->state_offset[i];
    double *coordinate = arrow->interface->coordinate + w->first;
    if (arrow->user.before) arrow->user.before(arrow->user.self, i);
    s->ops->newton_solve(s->self, x);
    memset(coordinate, 0, (size_t)w->n * sizeof(double));
    if (!w->by_state) {
        find_output_change(arrow, i, x, NULL);
        return;
    }
    memcpy(coordinate, x, (size_t)s->n_state * sizeof(double));
    memset(x, 0, (size_t)s->n_state * sizeof(double));
    memset(arrow->output_change + a->output_offset[i], 0, (size_t)s->n_output * sizeof(double));
}

static void gather_changes(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
        arrow->change[j] = arrow->output_change[a->source[j]];
        if (arrow->outside) arrow->change[j] += arrow->outside[j];
    }
}

// The same of a follower, under what the leaders do by themselves.
static void solve_follower(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    const bough_subsystem *s = a->member[i];
    double *x = arrow->x + a->state_offset[i], *change = arrow->change + a->input_offset[i];
    if (arrow->user.before) arrow->user.before(arrow->user.self, i);
    gather_changes(arrow, i);
    bough_condensed_add_columns(arrow->interface, i, arrow->gamma, change, x);
    s->ops->newton_solve(s->self, x);
    find_output_change(arrow, i, x, change);
}

static void finish(bough_arrow *arrow, int i) {
    bough_condensed_add_answer(arrow->interface, i, arrow->x + arrow->assembly->state_offset[i]);
    if (arrow->user.after) arrow->user.after(arrow->user.self, i);
}

static void solve_free(bough_arrow *arrow, double *x) {
    bough_arrow_solve_driven(arrow, NULL, x, (bough_arrow_user){0});
}

void bough_arrow_solve_driven(bough_arrow *arrow, const double *outside, double *x,
                              bough_arrow_user user) {
    arrow->x = x;
    arrow->outside = outside;
    arrow->user = user;
    each(arrow, LEADERS, solve_leader);
    each(arrow, FOLLOWERS, solve_follower);
    for (int i = 0; i < arrow->assembly->n_member; i++) {
        if (arrow->interface->of[i].leads) gather_changes(arrow, i);
    }
    bough_condensed_solve(arrow->interface, arrow->change);
    each(arrow, ALL, finish);
}

void bough_arrow_close(bough_arrow *arrow, double *outside) {
    memset(arrow->interface->coordinate, 0, (size_t)arrow->interface->n * sizeof(double));
    bough_condensed_solve(arrow->interface, outside);
}

// The border's multipliers make the held entries of its solutions vanish.
static bool factor_border(bough_arrow *arrow) {
    int n = arrow->assembly->n_state, held = arrow->n_held;
    for (int j = 0; j < held; j++) {
        double *column = arrow->border + (size_t)j * n;
        memset(column, 0, (size_t)n * sizeof *column);
        column[arrow->held[j]] = 1;
        solve_free(arrow, column);
        for (int i = 0; i < held; i++) {
            arrow->multiplier[j * held + i] = column[arrow->held[i]];
        }
    }
    return held == 0 || bough_dense_factor(held, arrow->multiplier, arrow->held_pivot);
}

void bough_arrow_solve(bough_arrow *arrow, double *x) {
    int n = arrow->assembly->n_state, held = arrow->n_held;
    solve_free(arrow, x);
    if (held == 0) return;
    for (int i = 0; i < held; i++)
        arrow->share[i] = x[arrow->held[i]];
    bough_dense_solve(held, 1, arrow->multiplier, arrow->held_pivot, arrow->share);
    for (int j = 0; j < held; j++) {
        const double *column = arrow->border + (size_t)j * n;
        for (int k = 0; k < n; k++)
            x[k] -= arrow->share[j] * column[k];
    }
    for (int i = 0; i < held; i++)
        x[arrow->held[i]] = 0;
}

// -- memory ---------------------------------------------------------------------------------------

static bool take(bough_arrow *arrow, bough_arena *arena) {
    const bough_assembly *a = arrow->assembly;
    size_t n_input = (size_t)a->n_input, n_output = (size_t)a->n_output;
    arrow->status = bough_arena_take(arena, (size_t)a->n_member * sizeof *arrow->status);
    arrow->order = bough_arena_take(arena, (size_t)a->n_member * sizeof *arrow->order);
    arrow->setup_state = bough_arena_doubles(arena, (size_t)a->n_state);
    arrow->setup_input = bough_arena_doubles(arena, n_input);
    arrow->input = bough_arena_doubles(arena, n_input);
    arrow->change = bough_arena_doubles(arena, n_input);
    arrow->output = bough_arena_doubles(arena, n_output);
    arrow->output_change = bough_arena_doubles(arena, n_output);
    return !bough_arena_exhausted(arena);
}

static void order_members(bough_arrow *arrow) {
    int n = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < arrow->assembly->n_member; i++) {
            if (arrow->own->of[i].leads == (pass > 0)) arrow->order[n++] = i;
        }
        if (pass == 0) arrow->n_follower = n;
    }
}

bough_status bough_arrow_create(bough_arena *arena, const bough_assembly *assembly,
                                bough_pool *pool, bough_arrow **arrow) {
    bough_arrow *a = bough_arena_take(arena, sizeof *a);
    if (!a) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    a->assembly = assembly;
    a->pool = pool;
    if (!take(a, arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    *arrow = a;
    bough_status status = bough_condensed_create(arena, assembly, &a->own);
    a->interface = a->own;
    if (bough_is_ok(&status)) order_members(a);
    return status;
}

bough_status bough_arrow_hold(bough_arena *arena, bough_arrow *arrow, int n, const int *held) {
    size_t count = (size_t)n;
    arrow->n_held = n;
    arrow->held = held;
    arrow->border = bough_arena_doubles(arena, count * (size_t)arrow->assembly->n_state);
    arrow->multiplier = bough_arena_doubles(arena, count * count);
    arrow->share = bough_arena_doubles(arena, count);
    arrow->held_pivot = bough_arena_take(arena, (count + 1) * sizeof(int));
    return bough_arena_exhausted(arena) ? bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory")
                                        : bough_ok();
}

#include "cosim/coupling.h"

#include "cosim/signal.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static void take(bough_coupling *c, bough_arena *arena) {
    const bough_assembly *a = c->assembly;
    size_t n_input = (size_t)a->n_input, n_output = (size_t)a->n_output;
    size_t n_member = (size_t)a->n_member;
    c->output = bough_arena_doubles(arena, n_output);
    c->input = bough_arena_doubles(arena, n_input);
    c->applied = bough_arena_doubles(arena, n_input);
    for (int p = 0; p < BOUGH_PAST; p++) c->past[p] = bough_arena_doubles(arena, n_input);
    bough_arena_each(arena, n_output, &c->start_rate, &c->end_output, &c->output_drift, &c->end_rate);
    c->state_rate = bough_arena_doubles(arena, (size_t)a->n_state);
    c->seen = bough_arena_doubles(arena, n_input);
    c->seen_rate = bough_arena_doubles(arena, n_input);
    c->status = bough_arena_take(arena, n_member * sizeof *c->status);
    c->turn = bough_arena_take(arena, n_member * sizeof *c->turn);
    c->followed = bough_arena_take(arena, n_input * sizeof *c->followed);
    c->signal = bough_arena_take(arena, n_member * sizeof *c->signal);
    for (int i = 0; i < a->n_member && c->signal; i++) {
        c->signal[i].n = a->member[i]->system.n_input;
        c->signal[i].coefficient = bough_arena_doubles(arena, 4 * (size_t)c->signal[i].n);
    }
}

bough_coupling *bough_coupling_create(bough_arena *arena, const bough_assembly *assembly,
                                      const bough_scheme_options *options, bough_pool *pool) {
    bough_coupling *c = bough_arena_take(arena, sizeof *c);
    c->assembly = assembly;
    c->options = *options;
    c->interface_ratio = (double)NAN;
    c->pool = pool;
    c->failed_member = -1;
    take(c, arena);
    c->t0 = c->t1 = assembly->member[0]->time;
    bough_assembly_outputs(assembly, c->t0, c->output, c->input);
    memcpy(c->applied, c->input, (size_t)assembly->n_input * sizeof(double));
    memcpy(c->past[0], c->input, (size_t)assembly->n_input * sizeof(double));
    c->past_time[0] = c->t0;
    c->n_past = 1;
    return c;
}

static bool in_level(const bough_coupling *c, int level, int member) {
    return level == BOUGH_ALL_LEVELS || c->assembly->level[member] == level;
}

// Lists the members of a level in c->turn, and clears failures.
static int list_level(bough_coupling *c, int level) {
    int n = 0;
    for (int i = 0; i < c->assembly->n_member; i++) {
        c->status[i].code = BOUGH_OK;
        if (in_level(c, level, i)) c->turn[n++] = i;
    }
    return n;
}

typedef struct member_work {
    bough_coupling *coupling;
    void (*work)(bough_coupling *c, int member);
} member_work;

static void run_member(void *data, int k) {
    const member_work *w = data;
    w->work(w->coupling, w->coupling->turn[k]);
}

static bough_status first_failure(bough_coupling *c) {
    for (int i = 0; i < c->assembly->n_member; i++) {
        if (bough_is_ok(&c->status[i])) continue;
        c->failed_member = i;
        return c->status[i];
    }
    return bough_ok();
}

bough_status bough_coupling_each(bough_coupling *c, int level, void (*work)(bough_coupling *c, int member)) {
    member_work w = {c, work};
    bough_pool_run(c->pool, list_level(c, level), run_member, &w);
    return first_failure(c);
}

typedef struct staged_list {
    bough_coupling *coupling;
    bough_staged_work work;
    int n_leader, n_follow, shift;
} staged_list;

// Leaders; what followers prepare, gone round by as many, so that with one leader each keeps the
// thread that it has in a list without leaders; followers.
static void run_staged(void *data, int k) {
    const staged_list *w = data;
    bough_coupling *c = w->coupling;
    const int *follower = c->turn + w->n_leader;
    int place = k - w->n_leader, follow = place - w->n_follow;
    if (place < 0) {
        w->work.advance_leader(c, c->turn[k]);
    } else if (follow < 0) {
        w->work.prepare(c, follower[(place + w->shift) % w->n_follow]);
    } else {
        int prepared = (follow + w->n_follow - w->shift) % w->n_follow;
        for (int l = 0; l < w->n_leader; l++) bough_pool_await(c->pool, l);
        bough_pool_await(c->pool, w->n_leader + prepared);
        if (bough_is_ok(&c->status[follower[follow]])) w->work.advance_follower(c, follower[follow]);
    }
}

bough_status bough_coupling_each_staged(bough_coupling *c, bough_staged_work work) {
    int n = c->assembly->n_member;
    staged_list w = {.coupling = c, .work = work, .n_leader = list_level(c, 0)};
    for (int i = 0; i < n; i++) {
        if (!in_level(c, 0, i)) c->turn[w.n_leader + w.n_follow++] = i;
    }
    if (w.n_follow > 0) w.shift = w.n_leader % w.n_follow;
    bough_pool_run(c->pool, w.n_leader + 2 * w.n_follow, run_staged, &w);
    return first_failure(c);
}

void bough_coupling_begin(bough_coupling *c) {
    assert(c->t0 < c->t1);
    memset(c->followed, 0, (size_t)c->assembly->n_input * sizeof *c->followed);
    for (int i = 0; i < c->assembly->n_member; i++) {
        c->signal[i].t0 = c->t0;
        c->signal[i].t1 = c->t1;
    }
}

bool bough_coupling_output_rate(bough_coupling *c, int member, double t, const double *input,
                                const double *input_rate, double *rate) {
    const bough_system *s = &c->assembly->member[member]->system;
    double *state_rate = c->state_rate + c->assembly->state_offset[member];
    if (!s->ops->derivative(s->self, t, c->assembly->member[member]->state, input, state_rate)) return false;
    s->ops->output_tangent(s->self, t, c->assembly->member[member]->state, input, state_rate, input_rate,
                           rate);
    if (s->ops->output_drift == NULL) return true;
    double *drift = c->output_drift + c->assembly->output_offset[member];
    s->ops->output_drift(s->self, t, c->assembly->member[member]->state, input, drift);
    for (int k = 0; k < s->n_output; k++) rate[k] += drift[k];
    return true;
}

bough_status bough_coupling_not_finite(const bough_coupling *c, int member) {
    const bough_system *s = &c->assembly->member[member]->system;
    return bough_fail(BOUGH_RETRY, "%s: no finite rate of change at %.6g s", s->name,
                      c->assembly->member[member]->time);
}

// A failure of the integrator may be due to the signal; a shorter macro step gives another signal.
static void ask_for_retry(bough_status *status) {
    if (status->code == BOUGH_FAILED) status->code = BOUGH_RETRY;
}

void bough_coupling_advance_to(bough_coupling *c, int member, double t, bool restart) {
    bough_member *m = c->assembly->member[member];
    assert(t >= m->time && c->t0 < c->t1 && c->signal[member].t0 == c->t0);
    c->status[member] = bough_member_advance(m, t, &c->signal[member], restart);
    assert(!bough_is_ok(&c->status[member]) || m->time == t);
    ask_for_retry(&c->status[member]);
}

static void advance(bough_coupling *c, int member, bool restart) {
    bough_coupling_advance_to(c, member, c->t1, restart);
}

static void advance_first_half(bough_coupling *c, int member, bool restart) {
    double middle = 0.5 * (c->t0 + c->t1) - 1e-9 * (c->t1 - c->t0);
    c->status[member] =
        bough_member_advance_part(c->assembly->member[member], middle, c->t1, &c->signal[member], restart);
    ask_for_retry(&c->status[member]);
}

static void advance_second_half(bough_coupling *c, int member) {
    bool arrived = c->assembly->member[member]->time >= c->t1;
    if (bough_is_ok(&c->status[member]) && !arrived) advance(c, member, false);
}

typedef struct level_work {
    bough_coupling *coupling;
    bool restart;
} level_work;

static void advance_turn(void *data, int k, bough_part part) {
    const level_work *w = data;
    int member = w->coupling->turn[k];
    switch (part) {
    case BOUGH_WHOLE: advance(w->coupling, member, w->restart); break;
    case BOUGH_FIRST_HALF: advance_first_half(w->coupling, member, w->restart); break;
    case BOUGH_SECOND_HALF: advance_second_half(w->coupling, member); break;
    }
}

bough_status bough_coupling_advance(bough_coupling *c, int level, bool restart) {
    level_work w = {c, restart};
    bough_pool_run_turns(c->pool, list_level(c, level), advance_turn, &w);
    return first_failure(c);
}

// Rates of a member's outputs at a time of the step under the signal it sees.
static bool signal_rate(bough_coupling *c, int member, double t, double *output_rate) {
    const bough_assembly *a = c->assembly;
    double *seen = c->seen + a->input_offset[member];
    double *seen_rate = c->seen_rate + a->input_offset[member];
    bough_signal_value(&c->signal[member], t, seen);
    bough_signal_rate(&c->signal[member], t, seen_rate);
    return bough_coupling_output_rate(c, member, t, seen, seen_rate, output_rate + a->output_offset[member]);
}

static void advance_leader(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const bough_system *s = &a->member[member]->system;
    if (!signal_rate(c, member, c->t0, c->start_rate)) {
        c->status[member] = bough_coupling_not_finite(c, member);
        return;
    }
    advance(c, member, c->leaders_restart);
    if (!bough_is_ok(&c->status[member])) return;
    if (!signal_rate(c, member, c->t1, c->end_rate)) {
        c->status[member] = bough_coupling_not_finite(c, member);
        return;
    }
    s->ops->output(s->self, c->t1, a->member[member]->state, c->seen + a->input_offset[member],
                   c->end_output + a->output_offset[member]);
}

bough_status bough_coupling_advance_leaders(bough_coupling *c, int level, bool restart) {
    c->leaders_restart = restart;
    return bough_coupling_each(c, level, advance_leader);
}

static void interpolate_polynomial(bough_coupling *c, bough_signal *s, int local, int j) {
    int source = c->assembly->source[j];
    int degree = c->options.order < c->n_past ? c->options.order : c->n_past;
    double time[BOUGH_HISTORY + 1] = {c->t1};
    const double *value[BOUGH_HISTORY + 1] = {c->end_output + source};
    for (int p = 0; p < degree; p++) {
        time[p + 1] = c->past_time[p];
        value[p + 1] = c->past[p] + j;
    }
    bough_signal_polynomial(s, local, 1, degree + 1, time, value);
}

void bough_coupling_interpolate(bough_coupling *c, int member, int j) {
    const bough_assembly *a = c->assembly;
    int source = a->source[j], local = j - a->input_offset[member];
    if (c->options.interpolation == BOUGH_POLYNOMIAL) {
        interpolate_polynomial(c, &c->signal[member], local, j);
        return;
    }
    c->followed[j] = true;
    bough_signal_hermite(&c->signal[member], local, 1,
                         (bough_signal_end){c->input + j, c->start_rate + source},
                         (bough_signal_end){c->end_output + source, c->end_rate + source});
}

double bough_coupling_curvature(const bough_coupling *c, int j, double end) {
    if (c->n_past < 2 || c->restart) return 0;
    double h = c->t1 - c->t0, before = c->t0 - c->past_time[1];
    double now = c->past[0][j], last = c->past[1][j];
    return 2 * ((end - now) / h - (now - last) / before) / (h + before);
}

// Integral of the obtained value, by that parabola, minus the applied value.
static void add_deficit(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const bough_signal *s = &c->signal[member];
    double h = c->t1 - c->t0;
    for (int k = 0; k < s->n; k++) {
        const double *seen = s->coefficient + k;
        int j = a->input_offset[member] + k, n = s->n;
        double curvature = bough_coupling_curvature(c, j, c->input[j]);
        double was = 0.5 * (c->past[0][j] + c->input[j]) - h * h / 12 * curvature;
        c->deficit[j] += h * (was - seen[0] - seen[n] / 2 - seen[2 * n] / 3 - seen[3 * n] / 4);
    }
}

// Members of one system have seen each other: what was applied is what is obtained.
static void apply_obtained(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        int first = a->input_offset[i], count = a->member[i]->system.n_input;
        bough_signal_linear(&c->signal[i], 0, count, c->past[0] + first, c->input + first);
    }
}

void bough_coupling_exchange(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_assembly_outputs(a, c->t1, c->output, c->input);
    if (c->whole) apply_obtained(c);
    for (int i = 0; i < a->n_member && c->deficit != NULL; i++) {
        if (a->level[i] == 0) add_deficit(c, i);
    }
    for (int i = 0; i < a->n_member; i++) {
        bough_signal_value(&c->signal[i], c->t1, c->applied + a->input_offset[i]);
    }
    double *oldest = c->past[BOUGH_PAST - 1];
    for (int p = BOUGH_PAST - 1; p > 0; p--) {
        c->past[p] = c->past[p - 1];
        c->past_time[p] = c->past_time[p - 1];
    }
    c->past[0] = oldest;
    c->past_time[0] = c->t1;
    memcpy(oldest, c->input, (size_t)a->n_input * sizeof(double));
    if (c->n_past < BOUGH_HISTORY) c->n_past++;
}

// Its rows after the states; their number.
static int memory_rows(const bough_coupling *c, double *row[4]) {
    row[0] = c->past[1];
    row[1] = c->past[2];
    row[2] = c->applied;
    row[3] = c->deficit;
    return c->deficit != NULL ? 4 : 3;
}

int bough_coupling_n_memory(const bough_coupling *c) {
    double *row[4];
    return c->assembly->n_state + memory_rows(c, row) * c->assembly->n_input;
}

void bough_coupling_load(bough_coupling *c, double h, const double *z) {
    const bough_assembly *a = c->assembly;
    size_t size = (size_t)a->n_input * sizeof(double);
    double *row[4];
    int n = memory_rows(c, row);
    for (int i = 0; i < a->n_member; i++) {
        bough_member_set(a->member[i], 0, z + a->state_offset[i]);
    }
    for (int p = 0; p < n; p++) memcpy(row[p], z + a->n_state + p * a->n_input, size);
    for (int i = 0; i < a->n_member && c->deficit != NULL; i++) { // of leaders only
        size_t own = (size_t)a->member[i]->system.n_input * sizeof(double);
        if (a->level[i] != 0) memset(c->deficit + a->input_offset[i], 0, own);
    }
    bough_assembly_outputs(a, 0, c->output, c->input);
    memcpy(c->past[0], c->input, size);
    for (int p = 0; p < BOUGH_HISTORY; p++) c->past_time[p] = -p * h;
    c->n_past = BOUGH_HISTORY;
    c->t1 = 0;
}

void bough_coupling_store(const bough_coupling *c, double *z) {
    const bough_assembly *a = c->assembly;
    double *row[4];
    int n = memory_rows(c, row);
    bough_assembly_states(a, z);
    for (int p = 0; p < n; p++) {
        memcpy(z + a->n_state + p * a->n_input, row[p], (size_t)a->n_input * sizeof(double));
    }
}

void bough_coupling_snapshot(bough_coupling *c, bough_snapshot *s) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        bough_member_snapshot(a->member[i], s);
    }
    bough_snapshot_doubles(s, c->output, a->n_output);
    bough_snapshot_doubles(s, c->input, a->n_input);
    bough_snapshot_doubles(s, c->applied, a->n_input);
    if (c->deficit) bough_snapshot_doubles(s, c->deficit, a->n_input);
    for (int p = 0; p < BOUGH_PAST; p++) bough_snapshot_doubles(s, c->past[p], a->n_input);
    bough_snapshot_doubles(s, c->past_time, BOUGH_PAST);
    bough_snapshot_take(s, &c->n_past, sizeof c->n_past);
}

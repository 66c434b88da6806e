// Moves of members over a macro step, the polynomials of theory (58), and the exchange at its end.
#include "cosim/coupling.h"

struct bough_coupling_scratch {
    int *listed;              // (n_member) the members of the level in progress
    bool restart;             // their integrators start anew
    double *state_rate;       // (n_state)
    double *output_drift;     // (n_output)
    double *seen, *seen_rate; // (n_input) values and rates of the signals
};

// A signal for the inputs of each member.
static bough_signal *create_signals(bough_arena *arena, const bough_assembly *a) {
    bough_signal *signal = bough_arena_take(arena, (size_t)a->n_member * sizeof *signal);
    for (int i = 0; i < a->n_member; i++)
        signal[i] = bough_signal_create(arena, a->member[i]->system.n_input);
    return signal;
}

static bough_coupling_scratch *create_scratch(bough_arena *arena, const bough_assembly *a) {
    bough_coupling_scratch *s = bough_arena_take(arena, sizeof *s);
    s->listed = bough_arena_take(arena, (size_t)a->n_member * sizeof *s->listed);
    s->state_rate = bough_arena_doubles(arena, (size_t)a->n_state);
    s->output_drift = bough_arena_doubles(arena, (size_t)a->n_output);
    bough_arena_each(arena, (size_t)a->n_input, &s->seen, &s->seen_rate);
    return s;
}

bough_coupling *bough_coupling_create(bough_arena *arena, const bough_assembly *assembly,
                                      const bough_scheme_options *options, bough_pool *pool) {
    size_t n_input = (size_t)assembly->n_input, n_output = (size_t)assembly->n_output;
    size_t n_member = (size_t)assembly->n_member;
    bough_coupling *c = bough_arena_take(arena, sizeof *c);
    c->assembly = assembly;
    c->options = *options;
    c->pool = pool;
    c->output = bough_arena_doubles(arena, n_output);
    bough_arena_each(arena, n_input, &c->input, &c->applied);
    for (int p = 0; p < BOUGH_PAST; p++) c->past.input[p] = bough_arena_doubles(arena, n_input);
    c->signal = create_signals(arena, assembly);
    c->followed = bough_arena_take(arena, n_input * sizeof *c->followed);
    bough_arena_each(arena, n_output, &c->advanced.start_rate, &c->advanced.value, &c->advanced.end_rate);
    c->status = bough_arena_take(arena, n_member * sizeof *c->status);
    c->scratch = create_scratch(arena, assembly);
    // the first synchronisation point: what is obtained is applied
    c->t0 = c->t1 = assembly->member[0]->time;
    bough_assembly_outputs(assembly, c->t0, c->output, c->input);
    memcpy(c->applied, c->input, n_input * sizeof(double));
    memcpy(c->past.input[0], c->input, n_input * sizeof(double));
    c->past.time[0] = c->t0;
    c->past.n = 1;
    return c;
}

// -- moves of several members ---------------------------------------------------------------------

void bough_coupling_clear(bough_coupling *c) {
    for (int i = 0; i < c->assembly->n_member; i++) c->status[i].code = BOUGH_OK;
}

bough_status bough_coupling_failure(const bough_coupling *c) {
    for (int i = 0; i < c->assembly->n_member; i++) {
        if (!bough_is_ok(&c->status[i])) return c->status[i];
    }
    return bough_ok();
}

// Lists the members of a level; their number.
static int list_level(bough_coupling *c, int level) {
    const bough_assembly *a = c->assembly;
    int n = 0;
    for (int i = 0; i < a->n_member; i++) {
        if (level == BOUGH_ALL_LEVELS || a->level[i] == level) c->scratch->listed[n++] = i;
    }
    return n;
}

typedef struct member_work {
    bough_coupling *coupling;
    void (*work)(bough_coupling *c, int member);
} member_work;

static void run_member(void *data, int k) {
    const member_work *w = data;
    w->work(w->coupling, w->coupling->scratch->listed[k]);
}

bough_status bough_coupling_each(bough_coupling *c, int level, void (*work)(bough_coupling *c, int member)) {
    member_work w = {c, work};
    int n = list_level(c, level);
    bough_coupling_clear(c);
    bough_pool_run_pairs(c->pool, 0, n, n, run_member, &w);
    return bough_coupling_failure(c);
}

void bough_coupling_begin(bough_coupling *c) {
    assert(c->t0 < c->t1);
    memset(c->followed, 0, (size_t)c->assembly->n_input * sizeof *c->followed);
    for (int i = 0; i < c->assembly->n_member; i++) {
        c->signal[i].t0 = c->t0;
        c->signal[i].t1 = c->t1;
    }
}

// -- outputs of a member under its signal ---------------------------------------------------------

void bough_coupling_not_finite(bough_coupling *c, int member) {
    const bough_member *m = c->assembly->member[member];
    c->status[member] =
        bough_fail(BOUGH_RETRY, "%s: no finite rate of change at %.6g s", m->system.name, m->time);
}

void bough_coupling_outputs(bough_coupling *c, int member, double t, double *output) {
    const bough_system *s = &c->assembly->member[member]->system;
    double *seen = c->scratch->seen + c->assembly->input_offset[member];
    bough_signal_value(&c->signal[member], t, seen);
    s->ops->output(s->self, t, c->assembly->member[member]->state, seen, output);
}

void bough_coupling_output_rate(bough_coupling *c, int member, double t, const double *input,
                                const double *input_rate, double *rate) {
    const bough_assembly *a = c->assembly;
    const bough_system *s = &a->member[member]->system;
    const double *state = a->member[member]->state;
    double *state_rate = c->scratch->state_rate + a->state_offset[member];
    if (!s->ops->derivative(s->self, t, state, input, state_rate)) {
        bough_coupling_not_finite(c, member);
        return;
    }
    // ȯ = ∂o/∂y ẏ + ∂o/∂u u̇ + ∂o/∂t
    s->ops->output_tangent(s->self, t, state, input, state_rate, input_rate, rate);
    if (s->ops->output_drift == NULL) return;
    double *drift = c->scratch->output_drift + a->output_offset[member];
    s->ops->output_drift(s->self, t, state, input, drift);
    for (int k = 0; k < s->n_output; k++) rate[k] += drift[k];
}

// The same under its signal, into the place of the member's outputs.
static void find_output_rate(bough_coupling *c, int member, double t, double *output_rate) {
    const bough_assembly *a = c->assembly;
    double *seen = c->scratch->seen + a->input_offset[member];
    double *seen_rate = c->scratch->seen_rate + a->input_offset[member];
    bough_signal_value(&c->signal[member], t, seen);
    bough_signal_rate(&c->signal[member], t, seen_rate);
    bough_coupling_output_rate(c, member, t, seen, seen_rate, output_rate + a->output_offset[member]);
}

// -- advancing ------------------------------------------------------------------------------------

void bough_coupling_advance_to(bough_coupling *c, int member, double t, bool restart) {
    bough_member *m = c->assembly->member[member];
    assert(t >= m->time && c->t0 < c->t1 && c->signal[member].t0 == c->t0);
    c->status[member] = bough_member_advance(m, t, &c->signal[member], restart);
    assert(!bough_is_ok(&c->status[member]) || m->time == t);
    // a failure may be due to the signal, and a shorter macro step gives another signal
    if (c->status[member].code == BOUGH_FAILED) c->status[member].code = BOUGH_RETRY;
}

static void advance_follower(bough_coupling *c, int member) {
    bough_coupling_advance_to(c, member, c->t1, c->scratch->restart);
}

bough_status bough_coupling_advance(bough_coupling *c, int level, bool restart) {
    c->scratch->restart = restart;
    return bough_coupling_each(c, level, advance_follower);
}

// A member that others follow.
static void advance_leader(bough_coupling *c, int member) {
    const bough_status *status = &c->status[member];
    // rates of the outputs at t0
    find_output_rate(c, member, c->t0, c->advanced.start_rate);
    if (!bough_is_ok(status)) return;
    // the step
    bough_coupling_advance_to(c, member, c->t1, c->scratch->restart);
    if (!bough_is_ok(status)) return;
    // rates and values of the outputs at t1
    find_output_rate(c, member, c->t1, c->advanced.end_rate);
    if (!bough_is_ok(status)) return;
    bough_coupling_outputs(c, member, c->t1, c->advanced.value + c->assembly->output_offset[member]);
}

bough_status bough_coupling_advance_leaders(bough_coupling *c, int level, bool restart) {
    c->scratch->restart = restart;
    return bough_coupling_each(c, level, advance_leader);
}

// -- signals --------------------------------------------------------------------------------------

// The cubic begins at the input obtained last.
void bough_coupling_interpolate(bough_coupling *c, int j) {
    const bough_output_curve *from = &c->advanced;
    int source = c->assembly->source[j], member = c->assembly->receiver[j];
    c->followed[j] = true;
    bough_signal_hermite(&c->signal[member], j - c->assembly->input_offset[member],
                         (bough_signal_end){c->input[j], from->start_rate[source]},
                         (bough_signal_end){from->value[source], from->end_rate[source]});
}

// theory (58)
void bough_coupling_extrapolate(bough_coupling *c, int j, int degree) {
    assert(degree >= 0 && degree < BOUGH_HISTORY);
    int n_point = degree < c->past.n ? degree + 1 : c->past.n, member = c->assembly->receiver[j];
    double value[BOUGH_HISTORY];
    for (int p = 0; p < n_point; p++) value[p] = c->past.input[p][j];
    bough_signal_polynomial(&c->signal[member], j - c->assembly->input_offset[member], n_point, c->past.time,
                            value);
}

// The second divided difference, twice.
double bough_coupling_curvature(const bough_coupling *c, int j, double end) {
    if (c->past.n < 2 || c->restart) return 0;
    // steps and values of the three points
    double h = c->t1 - c->t0, before = c->t0 - c->past.time[1];
    double now = c->past.input[0][j], last = c->past.input[1][j];
    return 2 * ((end - now) / h - (now - last) / before) / (h + before);
}

// -- the end of a step ----------------------------------------------------------------------------

void bough_coupling_record(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_history *past = &c->past;
    for (int i = 0; i < a->n_member; i++) {
        bough_signal_value(&c->signal[i], c->t1, c->applied + a->input_offset[i]);
    }
    // the oldest point gives its memory to the newest
    double *newest = past->input[BOUGH_PAST - 1];
    for (int p = BOUGH_PAST - 1; p > 0; p--) {
        past->input[p] = past->input[p - 1];
        past->time[p] = past->time[p - 1];
    }
    past->input[0] = newest;
    past->time[0] = c->t1;
    memcpy(newest, c->input, (size_t)a->n_input * sizeof(double));
    if (past->n < BOUGH_HISTORY) past->n++;
}

void bough_coupling_snapshot(bough_coupling *c, bough_snapshot *s) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) bough_member_snapshot(a->member[i], s);
    bough_snapshot_doubles(s, c->output, a->n_output);
    bough_snapshot_doubles(s, c->input, a->n_input);
    bough_snapshot_doubles(s, c->applied, a->n_input);
    for (int p = 0; p < BOUGH_PAST; p++) bough_snapshot_doubles(s, c->past.input[p], a->n_input);
    bough_snapshot_doubles(s, c->past.time, BOUGH_PAST);
    bough_snapshot_take(s, &c->past.n, sizeof c->past.n);
}

#include "cosim/master.h"

bough_master_def bough_master_def_default(void) {
    return (bough_master_def){.scheme = bough_scheme_options_default()};
}

long bough_master_multiple(double period, double macro_step) {
    double ratio = period / macro_step, whole = round(ratio);
    return whole >= 1 && fabs(ratio - whole) <= 1e-9 * whole ? (long)whole : 0;
}

// Loads and events of the def; events in the order of time.
static void copy_loads(bough_master *m, bough_arena *arena, const bough_master_def *def) {
    m->load = bough_arena_take(arena, (size_t)def->n_load * sizeof *m->load);
    m->load_every = bough_arena_take(arena, (size_t)def->n_load * sizeof *m->load_every);
    m->event = bough_arena_doubles(arena, (size_t)def->n_event);
    m->n_load = def->n_load;
    for (int i = 0; i < def->n_load; i++) {
        m->load[i] = def->load[i];
        m->load_every[i] = bough_master_multiple(def->load[i].period, def->macro_step);
        assert(m->load_every[i] > 0);
    }
    if (def->n_event == 0) return;
    memcpy(m->event, def->event, (size_t)def->n_event * sizeof *m->event);
    qsort(m->event, (size_t)def->n_event, sizeof *m->event, bough_ascending);
    m->n_event = 1;
    for (int i = 1; i < def->n_event; i++)
        if (m->event[i] > m->event[m->n_event - 1]) m->event[m->n_event++] = m->event[i];
}

// The stability before the run. No verdict where the analysis fails: the run then shows the cause.
static void judge_stability(bough_master *m) {
    const bough_scheme_options *options = &m->coupling->options;
    if (!m->coupling->scheme->judged) return;
    bough_status status = bough_stability_advise(m->assembly, options, m->macro_step, &m->advice);
    if (!bough_is_ok(&status)) return;
    bough_stability_describe(m->assembly, &m->advice, options, m->macro_step, m->verdict);
}

// Times closer than this are one synchronisation point [s].
static double resolution(const bough_master *m) { return 1e-9 * m->macro_step; }

static bool on_grid(const bough_master *m) {
    return fabs(m->time - (double)m->grid_index * m->macro_step) <= resolution(m);
}

static bool is_due(const bough_master *m, int load) {
    return on_grid(m) && m->grid_index % m->load_every[load] == 0;
}

static void begin_loads(bough_master *m, double t) {
    m->begun = t;
    for (int i = 0; i < m->n_load; i++) {
        if (m->load[i].begin) m->load[i].begin(m->load[i].self, t);
    }
}

static void evaluate_loads(bough_master *m) {
    for (int i = 0; i < m->n_load; i++) {
        if (m->load[i].evaluate && is_due(m, i)) m->load[i].evaluate(m->load[i].self, m->time);
    }
}

bough_status bough_master_build(bough_arena *arena, const bough_master_def *def, bough_master **master) {
    assert(def->macro_step > 0 && def->duration > 0 && isfinite(def->duration));
    bough_master *m = bough_arena_take(arena, sizeof *m);
    m->macro_step = def->macro_step;
    m->halves = def->halves;
    m->duration = def->duration;
    m->at_event = true;
    copy_loads(m, arena, def);
    // the assembly and its coupling
    BOUGH_TRY(bough_assembly_build(arena, &def->assembly, &m->assembly));
    BOUGH_TRY(bough_scheme_couple(arena, m->assembly, &def->scheme, def->pool, &m->coupling));
    // what checks and controls the steps
    const bough_scheme *scheme = m->coupling->scheme;
    m->monitor = bough_monitor_create(arena, m->coupling);
    bool controlled = def->control.tolerance > 0 && !scheme->one_system;
    if (controlled) {
        int order = bough_scheme_defect_order(scheme, &def->scheme);
        m->control = bough_step_control_create(arena, m->coupling, &def->control, m->macro_step, order);
    }
    // loads at time 0, and the scheme's preparation with them
    begin_loads(m, 0);
    if (!m->control) judge_stability(m);
    evaluate_loads(m);
    m->coupling->t1 = m->coupling->t0 + m->macro_step;
    *master = m;
    return scheme->prepare ? scheme->prepare(m->coupling) : bough_ok();
}

bool bough_master_done(const bough_master *m) { return m->time >= m->duration; }

enum { BLOCK = 4, FIRST = 64 }; // macro steps

// If all of the first macro steps were halved, their steps would be those of the compared run, theory (71),
// wherever this takes one step in each macro step. Halved macro steps follow each other, because every change
// of the step takes new factors.
static bool taken_in_halves(const bough_master *m) {
    if (!m->halves || m->split || m->halve) return m->halves;
    if (m->grid_index >= FIRST) return m->at_event || m->grid_index % (8 * BLOCK) < BLOCK;
    return m->at_event || m->grid_index % (2 * BLOCK) < BLOCK || m->many_steps;
}

// By multiplication, so that the grid does not drift.
static double half_of_step(const bough_master *m) { return ((double)m->grid_index + 0.5) * m->macro_step; }

static double next_on_grid(const bough_master *m) {
    double half = half_of_step(m);
    return taken_in_halves(m) && half > m->time + resolution(m) ? half
                                                                : (double)(m->grid_index + 1) * m->macro_step;
}

// The next synchronisation point: grid point, half of a step, event or the end, whichever comes first. An
// event next to a grid point gives its own time, which is the same number on every grid.
static double next_whole(const bough_master *m) {
    double eps = resolution(m);
    double next = next_on_grid(m);
    for (int i = m->next_event; i < m->n_event; i++) {
        if (m->event[i] <= m->time + eps) continue;
        if (m->event[i] < next + eps) next = m->event[i];
        break;
    }
    return next > m->duration - eps ? m->duration : next;
}

double bough_master_next(const bough_master *m) {
    double next = next_whole(m);
    bool halfway = m->halves && fabs(m->time - half_of_step(m)) <= resolution(m);
    return m->split && (m->at_event || on_grid(m) || halfway) ? (m->time + next) / 2 : next;
}

// Samples the loads that are due; whether one of them jumps.
static bough_status sample_loads(bough_master *m, bool *jumped) {
    for (int i = 0; i < m->n_load; i++) {
        if (!m->load[i].sample || !is_due(m, i)) continue;
        // held or continued by the load itself until its next sample
        double next = (double)(m->grid_index + m->load_every[i]) * m->macro_step;
        bool jump = false;
        BOUGH_TRY(m->load[i].sample(m->load[i].self, m->time, next, &jump));
        *jumped = *jumped || jump;
    }
    return bough_ok();
}

bool bough_master_sampled(const bough_master *m) {
    for (int i = 0; i < m->n_load; i++) {
        if (m->load[i].sample && !is_due(m, i)) return false;
    }
    return true;
}

// Passes the events up to the present; whether the last of them is now.
static bool pass_events(bough_master *m) {
    double eps = resolution(m);
    bool now = false;
    for (; m->next_event < m->n_event && m->event[m->next_event] <= m->time + eps; m->next_event++) {
        now = m->event[m->next_event] >= m->time - eps;
    }
    return now;
}

static void set_time(bough_master *m, double t) {
    m->time = t;
    if (t >= (double)(m->grid_index + 1) * m->macro_step - resolution(m)) m->grid_index++;
    m->at_event = pass_events(m);
}

// A macro step under step control: undone and repeated with shorter steps until it is accepted. Of the
// failures only those that ask for a retry are repeated.
static bough_status take_controlled_step(bough_master *m) {
    bough_step_control *control = m->control;
    bough_coupling *c = m->coupling;
    double to = c->t1;
    bool compared = c->compared;
    bough_step_control_save(control, c);
    for (;;) {
        c->t1 = bough_step_control_end(control, c->t0, to);
        c->compared = compared && bough_step_control_exhausted(control); // shorter steps are tried first
        // the step, and its defect
        bough_status status = bough_scheme_step(c);
        bool good = bough_is_ok(&status);
        if (!good && (status.code != BOUGH_RETRY || bough_step_control_exhausted(control))) {
            return status;
        }
        double error = good ? bough_step_control_defect(control, c) : HUGE_VAL;
        bool shortest = bough_step_control_exhausted(control);
        if (bough_step_control_accept(control, c, error)) return status;
        if (shortest) return status; // the monitor finds the cause
        bough_step_control_restore(control, c);
    }
}

static bough_status interrupted(const bough_master *m) {
    return bough_fail(BOUGH_INTERRUPTED, "interrupted at %.9g s of %.9g s", m->time, m->duration);
}

static bough_status macro_step(bough_master *m) {
    bough_coupling *c = m->coupling;
    // the step
    c->t0 = m->time;
    c->t1 = bough_master_next(m);
    c->restart = m->at_event;
    // loads from t0 on
    begin_loads(m, c->t0 + resolution(m));
    BOUGH_TRY(sample_loads(m, &c->restart));

    // advance the members and exchange their values
    bough_monitor_keep(m->monitor, c);
    c->compared = m->compared;
    bough_status status = m->control ? take_controlled_step(m) : bough_scheme_step(c);
    if (!bough_is_ok(&status) && m->stop && m->stop()) {
        bough_monitor_undo(m->monitor, c);
        return interrupted(m);
    }
    if (!bough_is_ok(&status)) {
        return bough_monitor_explain(m->monitor, c, &m->advice, status);
    }

    // check the result
    BOUGH_TRY(bough_monitor_step(m->monitor, c, m->compared));
    // t1 is the present
    set_time(m, c->t1);
    m->steps++;
    evaluate_loads(m);
    return bough_ok();
}

typedef struct stepping {
    bough_master *master;
    bough_status status;
} stepping;

static void macro_step_in_region(void *self) {
    stepping *w = self;
    w->status = macro_step(w->master);
}

void bough_master_stop_by(bough_master *m, bool (*stop)(void)) {
    m->stop = stop;
    for (int i = 0; i < m->assembly->n_member; i++) m->assembly->member[i]->stop = stop;
    bough_member *whole = bough_scheme_whole(m->coupling);
    if (whole) whole->stop = stop;
}

bough_statistics bough_master_statistics(const bough_master *m) {
    bough_statistics sum = {0};
    for (int i = 0; i <= m->assembly->n_member; i++) {
        const bough_member *member =
            i < m->assembly->n_member ? m->assembly->member[i] : bough_scheme_whole(m->coupling);
        if (member == NULL) continue;
        bough_statistics own = bough_member_statistics(member);
        bough_statistics_add(&sum, 1, &own);
    }
    return sum;
}

bough_status bough_step(bough_master *m) {
    enum { SEVERAL = 4 };
    stepping w = {.master = m};
    // how many steps the integrators take in it decides whether the next one is halved
    long before = m->halves ? bough_master_statistics(m).steps : 0;
    bough_pool_region(m->coupling->pool, macro_step_in_region, &w);
    if (m->halves) {
        long own = bough_master_statistics(m).steps - before;
        m->many_steps = (double)own >= SEVERAL * (m->time - m->begun) / m->macro_step;
    }
    return w.status;
}

void bough_master_snapshot(bough_master *m, bough_snapshot *s) {
    bough_coupling *c = m->coupling;
    // where the run is
    BOUGH_SNAPSHOT(s, m->time, m->steps, m->grid_index, m->at_event, m->begun, m->many_steps);
    bough_snapshot_take(s, &m->split, sizeof m->split);
    // members, coupling and scheme; what checks and controls the steps
    bough_scheme_snapshot(c, s);
    BOUGH_SNAPSHOT(s, c->t0, c->t1);
    bough_monitor_snapshot(m->monitor, c, s);
    if (m->control) bough_step_control_snapshot(m->control, s);
    if (s->move != BOUGH_SNAPSHOT_RESTORE) return;
    // what follows from the time
    m->next_event = 0;
    pass_events(m);
    begin_loads(m, m->begun);
}

void bough_master_join(bough_master *m, const bough_master *other) {
    bough_member *whole = bough_scheme_whole(m->coupling);
    m->time = m->begun = other->time;
    m->grid_index = (long)floor((m->time + resolution(m)) / m->macro_step);
    m->next_event = 0;
    m->at_event = pass_events(m);
    for (int i = 0; i < m->assembly->n_member; i++)
        bough_member_set(m->assembly->member[i], m->time, other->assembly->member[i]->state);
    if (whole) {
        bough_assembly_states(m->assembly, whole->state);
        bough_member_set(whole, m->time, whole->state);
    }
}

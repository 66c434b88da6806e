#include "apps/study/study_clock.h"

#include "apps/output/progress.h"

// A member's system and integrator behind the clock; one thread at a time works on it.
typedef struct clocked_member {
    bough_system real;
    bough_integrator integrator;
    bough_integrator_ops shown; // its operations, but for those below
    bool stepping;              // in a step of its own
    double own, model;          // steps of its own; everything else [s]
} clocked_member;

typedef struct clocked_load {
    bough_sampled_load real;
    double spent; // [s]
} clocked_load;

struct bough_clock {
    const bough_assembly *assembly;
    clocked_member *member; // (n_member)
    int n_load;
    clocked_load *load; // (n_load)
};

const char *bough_clock_name(bough_clock_part part) {
    static const char *const names[] = {"tree steps", "rod steps", "tree model",
                                        "rod model",  "loads",     "recording"};
    return names[part];
}

// -- members --------------------------------------------------------------------------------------

// Runs `call` of the member m and adds its time, unless it is part of an own step, to m->model.
#define CLOCKED(call)                                                                              \
    clocked_member *m = self;                                                                      \
    double began = m->stepping ? 0 : bough_wall_clock();                                           \
    call;                                                                                          \
    if (!m->stepping) m->model += bough_wall_clock() - began

static bool derivative(void *self, double t, const double *y, const double *u, double *rate) {
    bool ok;
    CLOCKED(ok = m->real.ops->derivative(m->real.self, t, y, u, rate));
    return ok;
}

static bool derivative_again(void *self, double t, const double *y, const double *u,
                             double *rate) {
    bool ok;
    CLOCKED(ok = m->real.ops->derivative_again(m->real.self, t, y, u, rate));
    return ok;
}

static void output(void *self, double t, const double *y, const double *u, double *out) {
    CLOCKED(m->real.ops->output(m->real.self, t, y, u, out));
}

static void output_tangent(void *self, double t, const double *y, const double *u,
                           const double *dy, const double *du, double *out) {
    CLOCKED(m->real.ops->output_tangent(m->real.self, t, y, u, dy, du, out));
}

static bool kept_tangent(void *self, const void *factors, const double *dy, const double *du,
                         double *out) {
    bool kept;
    CLOCKED(kept = m->real.ops->kept_tangent(m->real.self, factors, dy, du, out));
    return kept;
}

static void output_drift(void *self, double t, const double *y, const double *u, double *drift) {
    CLOCKED(m->real.ops->output_drift(m->real.self, t, y, u, drift));
}

static void input_columns(void *self, double t, const double *y, const double *u, double *column) {
    CLOCKED(m->real.ops->input_columns(m->real.self, t, y, u, column));
}

static void *factors(void *self, bough_arena *arena) {
    const clocked_member *m = self;
    return m->real.ops->factors(m->real.self, arena);
}

static bool linearise(void *self, double t, const double *y, const double *u, void *factors) {
    bool ok;
    CLOCKED(ok = m->real.ops->linearise(m->real.self, t, y, u, factors));
    return ok;
}

static bool factor(void *self, void *factors, double gamma) {
    bool ok;
    CLOCKED(ok = m->real.ops->factor(m->real.self, factors, gamma));
    return ok;
}

static void solve(void *self, void *factors, double *x) {
    CLOCKED(m->real.ops->solve(m->real.self, factors, x));
}

static bool constrain(void *self, double t, double *y) {
    bool far;
    CLOCKED(far = m->real.ops->constrain(m->real.self, t, y));
    return far;
}

static void project(void *self, const double *y, double *x) {
    CLOCKED(m->real.ops->project(m->real.self, y, x));
}

static void hold_loads(void *self, double t0, double t1) {
    CLOCKED(m->real.ops->hold_loads(m->real.self, t0, t1));
}

// Those that the system has.
static void show_system(clocked_member *m, bough_system *shown, bough_arena *arena) {
    bough_system_ops *ops = bough_arena_take(arena, sizeof *ops);
    const bough_system_ops *real = m->real.ops;
    *ops = (bough_system_ops){.derivative = derivative,
                              .output = output,
                              .output_tangent = output_tangent,
                              .input_columns = input_columns,
                              .factors = factors,
                              .linearise = linearise,
                              .factor = factor,
                              .solve = solve};
    if (real->derivative_again != NULL) ops->derivative_again = derivative_again;
    if (real->kept_tangent != NULL) ops->kept_tangent = kept_tangent;
    if (real->output_drift != NULL) ops->output_drift = output_drift;
    if (real->constrain != NULL) ops->constrain = constrain;
    if (real->project != NULL) ops->project = project;
    if (real->hold_loads != NULL) ops->hold_loads = hold_loads;
    shown->ops = ops;
    shown->self = m;
}

static bough_status advance(void *self, double *t, double pause, double t1, bool restart,
                            double *y) {
    clocked_member *m = self;
    double began = bough_wall_clock();
    m->stepping = true;
    bough_status status =
        m->integrator.ops->advance(m->integrator.self, t, pause, t1, restart, y);
    m->stepping = false;
    m->own += bough_wall_clock() - began;
    return status;
}

static void statistics(const void *self, bough_statistics *sum) {
    const clocked_member *m = self;
    m->integrator.ops->statistics(m->integrator.self, sum);
}

static void transfer(void *self, bough_snapshot *s) {
    clocked_member *m = self;
    m->integrator.ops->transfer(m->integrator.self, s);
}

static void show_member(clocked_member *m, bough_member *shown, bough_arena *arena) {
    m->real = shown->system;
    m->integrator = shown->integrator;
    show_system(m, &shown->system, arena);
    if (m->integrator.ops == NULL) return;
    m->shown = *m->integrator.ops;
    m->shown.advance = advance;
    m->shown.statistics = statistics;
    if (m->shown.transfer != NULL) m->shown.transfer = transfer;
    shown->integrator.ops = &m->shown;
    shown->integrator.self = m;
}

// -- loads ----------------------------------------------------------------------------------------

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    clocked_load *l = self;
    double began = bough_wall_clock();
    bough_status status = l->real.sample(l->real.self, t, t_next, jumped);
    l->spent += bough_wall_clock() - began;
    return status;
}

static void evaluate(void *self, double t) {
    clocked_load *l = self;
    double began = bough_wall_clock();
    l->real.evaluate(l->real.self, t);
    l->spent += bough_wall_clock() - began;
}

// -- clock ----------------------------------------------------------------------------------------

bough_status bough_clock_create(bough_arena *arena, bough_simulation *s, bough_clock **clock) {
    bough_master *master = s->master;
    bough_assembly *a = master->assembly;
    bough_clock *c = bough_arena_take(arena, sizeof *c);
    c->assembly = a;
    c->n_load = master->n_load;
    c->member = bough_arena_take(arena, (size_t)a->n_member * sizeof *c->member);
    c->load = bough_arena_take(arena, (size_t)c->n_load * sizeof *c->load);
    for (int i = 0; i < a->n_member; i++) {
        show_member(&c->member[i], a->member[i], arena);
    }
    for (int i = 0; i < c->n_load; i++) {
        c->load[i].real = master->load[i];
        master->load[i].self = &c->load[i];
        master->load[i].sample = sample;
        if (master->load[i].evaluate) master->load[i].evaluate = evaluate;
    }
    *clock = c;
    return bough_ok();
}

void bough_clock_read(const bough_clock *c, double *seconds) {
    for (int p = 0; p < BOUGH_CLOCK_PARTS; p++) seconds[p] = 0;
    for (int i = 0; i < c->assembly->n_member; i++) {
        bool leads = c->assembly->stage[i] == 0;
        seconds[leads ? BOUGH_CLOCK_LEADERS : BOUGH_CLOCK_FOLLOWERS] += c->member[i].own;
        seconds[leads ? BOUGH_CLOCK_LEADER_MODEL : BOUGH_CLOCK_FOLLOWER_MODEL] +=
            c->member[i].model;
    }
    for (int i = 0; i < c->n_load; i++) seconds[BOUGH_CLOCK_LOADS] += c->load[i].spent;
}

#include "apps/study/study_clock.h"

#include "apps/output/progress.h"

// A member behind the clock; one thread at a time works on it.
typedef struct clocked_member {
    const bough_subsystem *real;
    bough_subsystem shown;
    double own, model; // steps of its own; everything else [s]
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

// Runs `call` of the member m and adds its time to m->part.
#define CLOCKED(part, call)                                                                        \
    clocked_member *m = self;                                                                      \
    double began = bough_wall_clock();                                                             \
    call;                                                                                          \
    m->part += bough_wall_clock() - began

static bool derivative(void *self, double t, const double *y, const double *u, double *rate) {
    bool ok;
    CLOCKED(model, ok = m->real->ops->derivative(m->real->self, t, y, u, rate));
    return ok;
}

static void output(void *self, double t, const double *y, const double *u, double *out) {
    CLOCKED(model, m->real->ops->output(m->real->self, t, y, u, out));
}

static void output_tangent(void *self, double t, const double *y, const double *u,
                           const double *dy, const double *du, double *out) {
    CLOCKED(model, m->real->ops->output_tangent(m->real->self, t, y, u, dy, du, out));
}

static void input_columns(void *self, double t, const double *y, const double *u, double *column) {
    CLOCKED(model, m->real->ops->input_columns(m->real->self, t, y, u, column));
}

static void *factors(void *self, bough_arena *arena) {
    const clocked_member *m = self;
    return m->real->ops->factors(m->real->self, arena);
}

static bool linearise(void *self, double t, const double *y, const double *u, void *factors) {
    bool ok;
    CLOCKED(model, ok = m->real->ops->linearise(m->real->self, t, y, u, factors));
    return ok;
}

static bool factor(void *self, void *factors, double gamma) {
    bool ok;
    CLOCKED(model, ok = m->real->ops->factor(m->real->self, factors, gamma));
    return ok;
}

static void solve(void *self, void *factors, double *x) {
    CLOCKED(model, m->real->ops->solve(m->real->self, factors, x));
}

static bough_status advance(void *self, double t1, const bough_signal *input, bool restart) {
    bough_status status;
    CLOCKED(own, status = m->real->ops->advance(m->real->self, t1, input, restart));
    return status;
}

static bough_status advance_part(void *self, double pause, double t1, const bough_signal *input,
                                 bool restart) {
    const bough_subsystem_ops *ops = ((const clocked_member *)self)->real->ops;
    if (ops->advance_part == NULL) return advance(self, t1, input, restart);
    bough_status status;
    CLOCKED(own, status = ops->advance_part(m->real->self, pause, t1, input, restart));
    return status;
}

static size_t save_size(void *self) {
    const clocked_member *m = self;
    return m->real->ops->save_size(m->real->self);
}

static void save(void *self, void *copy) {
    CLOCKED(model, m->real->ops->save(m->real->self, copy));
}

static void restore(void *self, const void *copy) {
    CLOCKED(model, m->real->ops->restore(m->real->self, copy));
}

static void set_state(void *self, double t, const double *y) {
    CLOCKED(model, m->real->ops->set_state(m->real->self, t, y));
}

static void statistics(void *self, bough_statistics *sum) {
    const clocked_member *m = self;
    m->real->ops->statistics(m->real->self, sum);
}

static const bough_subsystem_ops clocked_ops = {
    .derivative = derivative,
    .output = output,
    .output_tangent = output_tangent,
    .input_columns = input_columns,
    .factors = factors,
    .linearise = linearise,
    .factor = factor,
    .solve = solve,
    .advance = advance,
    .advance_part = advance_part,
    .save_size = save_size,
    .save = save,
    .restore = restore,
    .set_state = set_state,
    .statistics = statistics,
};

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
    if (c == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    c->assembly = a;
    c->n_load = master->n_load;
    c->member = bough_arena_take(arena, (size_t)a->n_member * sizeof *c->member);
    c->load = bough_arena_take(arena, (size_t)c->n_load * sizeof *c->load);
    if (bough_arena_exhausted(arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int i = 0; i < a->n_member; i++) {
        clocked_member *m = &c->member[i];
        *m = (clocked_member){.real = a->member[i], .shown = *a->member[i]};
        m->shown.ops = &clocked_ops;
        m->shown.self = m;
        a->member[i] = &m->shown;
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

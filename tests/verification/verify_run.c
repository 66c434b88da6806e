// One case of a study of kind verify on one mesh: its quantities.
#include "tests/unit/tree_measure.h"
#include "tests/verification/verify.h"

#include "apps/bough/analysis/steady.h"
#include "apps/bough/analysis/vibration.h"
#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/run.h"
#include "flexbody/rod/rod_modes.h"
#include "tests/unit/rod_energy.h"

// -- scene ----------------------------------------------------------------------------------------

static bough_status open_scene(bough_arena *arena, const bough_verify_case *x, int k, bough_run *run) {
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    BOUGH_TRY(bough_verify_scene(arena, x, k, &errors, &scene));
    return bough_run_create(arena, scene, run);
}

static const bough_beam *first_rod(const bough_simulation *s) {
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod) return &s->beam[k];
    }
    return NULL;
}

// -- static ---------------------------------------------------------------------------------------

static double tip_component(const bough_simulation *s, const bough_beam *rod, int component) {
    bough_vec3 shift, turn;
    bough_quaternion p;
    bough_simulation_shift(s, rod, rod->def.n_segment, &shift, &turn);
    bough_vec3 position = bough_simulation_beam_tip(s, rod, &p);
    const double values[9] = {position.x, position.y, position.z, shift.x, shift.y,
                              shift.z,    turn.x,     turn.y,     turn.z};
    return values[component];
}

// The first rod by itself.
static bough_status steady(bough_arena *arena, const bough_simulation *s, bough_steady *found) {
    const bough_beam *rod = first_rod(s);
    bough_turning turning;
    if (!rod) return bough_fail(BOUGH_INVALID, "the scene has no rod");
    BOUGH_TRY(bough_steady_turning(s, rod, &turning));
    return bough_steady_find(arena, s, rod, &turning, found);
}

// Of the first rod, with the scene in equilibrium as a whole where its modes are those of the whole.
static bough_status do_static(bough_arena *arena, const bough_verify_case *x, bough_simulation *s,
                              double *value) {
    bough_steady found;
    double time = bough_equilibrium_time(s);
    if (first_rod(s) && bough_vibration_wanted(s)) {
        BOUGH_TRY(bough_simulation_equilibrium(s, time, 0, NULL));
    } else {
        BOUGH_TRY(steady(arena, s, &found));
        bough_member_set(&s->rod[found.beam->port], 0, found.state);
    }
    for (int i = 0; i < x->n_expect; i++) {
        if (!x->expect[i].diagnosis) value[i] = tip_component(s, first_rod(s), x->expect[i].quantity.index);
    }
    return bough_ok();
}

// -- modes ----------------------------------------------------------------------------------------

static double largest_growth(const bough_rod_mode_list *list) {
    double largest = 0;
    for (int k = 0; k < list->found; k++) {
        const bough_rod_mode *mode = &list->mode[k];
        largest = fmax(largest, -2 * BOUGH_PI * mode->damping * mode->frequency);
    }
    return largest;
}

static bough_status do_whole_modes(bough_arena *arena, const bough_verify_case *x, int wanted,
                                   bough_simulation *s, double *value) {
    bough_vibration v;
    bough_status status = bough_vibration_find(arena, s, wanted, &v);
    for (int i = 0; i < x->n_expect && bough_is_ok(&status); i++) {
        const bough_verify_quantity *q = &x->expect[i].quantity;
        if (x->expect[i].diagnosis || q->index >= v.found) continue;
        const bough_scene_mode *mode = &v.mode[q->index];
        value[i] = q->what == BOUGH_VERIFY_DAMPING ? mode->damping : mode->frequency;
        for (int k = 0; k < v.found && q->what == BOUGH_VERIFY_GROWTH; k++) {
            value[i] = k == 0 ? fmax(0, v.mode[k].growth) : fmax(value[i], v.mode[k].growth);
        }
    }
    return status;
}

static bough_status do_modes(bough_arena *arena, const bough_verify_case *x, bough_simulation *s,
                             double *value) {
    int wanted = 4; // 4: among which the largest growth is looked for
    for (int i = 0; i < x->n_expect; i++) {
        if (x->expect[i].quantity.index >= wanted) wanted = x->expect[i].quantity.index + 1;
    }
    // in the air the others' number moves a mode, as those of `bough modes`
    int listed = s->scene->modes.count > wanted ? s->scene->modes.count : wanted;
    if (bough_vibration_wanted(s)) return do_whole_modes(arena, x, listed, s, value);
    bough_steady at;
    bough_rod_mode_list list = {.wanted = wanted};
    bough_status status = steady(arena, s, &at);
    if (bough_is_ok(&status)) {
        status = bough_rod_modes(arena, at.model, &at.work, at.input, at.state, &list);
    }
    for (int i = 0; i < x->n_expect && bough_is_ok(&status); i++) {
        const bough_verify_quantity *q = &x->expect[i].quantity;
        if (x->expect[i].diagnosis || q->index >= list.found) continue;
        const bough_rod_mode *mode = &list.mode[q->index];
        value[i] = q->what == BOUGH_VERIFY_DAMPING ? mode->damping : mode->frequency;
        if (q->what == BOUGH_VERIFY_GROWTH) value[i] = largest_growth(&list);
    }
    return status;
}

// -- invariants -----------------------------------------------------------------------------------

// Of the whole scene.
typedef struct invariants {
    double energy, motion_energy; // the latter without gravity's
    bough_vec3 momentum, angular;
} invariants;

typedef struct gauge {
    bough_simulation *simulation;
    bough_vertex_motion **vertex; // (n_beam)
    bough_rod_scratch *scratch;   // (n_beam)
} gauge;

static void gauge_init(gauge *g, bough_arena *arena, bough_simulation *s) {
    g->simulation = s;
    g->vertex = bough_arena_take(arena, (size_t)s->n_beam * sizeof *g->vertex);
    g->scratch = bough_arena_take(arena, (size_t)s->n_beam * sizeof *g->scratch);
    for (int k = 0; k < s->n_beam; k++) {
        size_t n = (size_t)s->beam[k].def.n_segment + 1;
        g->vertex[k] = bough_arena_take(arena, n * sizeof *g->vertex[k]);
        if (s->beam[k].rod) {
            bough_rod_scratch_init(&g->scratch[k], arena, bough_rod_body_model(s->beam[k].rod));
        }
    }
}

static void add_vertex(const bough_vertex_inertia *v, const bough_vertex_motion *m, bough_vec3 gravity,
                       invariants *sum) {
    bough_vec3 u = m->velocity, x = m->position;
    bough_vec3 w = bough_mat3_tmul(m->rotation, m->angular);
    bough_vec3 moment = bough_mat3_mul(m->rotation, v->moment);
    const double *j = v->inertia;
    bough_mat3 tensor = {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}};
    bough_vec3 jw = bough_mat3_mul(tensor, w);
    bough_vec3 p = bough_axpy(v->mass, u, bough_cross(m->angular, moment));
    bough_vec3 l = bough_add(bough_mat3_mul(m->rotation, jw), bough_cross(moment, u));
    sum->momentum = bough_add(sum->momentum, p);
    sum->angular = bough_add(sum->angular, bough_add(l, bough_cross(x, p)));
    double kinetic = 0.5 * (bough_dot(p, u) + bough_dot(l, m->angular));
    sum->motion_energy += kinetic;
    sum->energy += kinetic - bough_dot(gravity, bough_axpy(v->mass, x, moment));
}

// The tree has the rigid bodies and, of every rod, the vertices that it carries.
static invariants measure(const gauge *g) {
    bough_simulation *s = g->simulation;
    bough_simulation_update(s);
    tree_sums tree = tree_sum(s->tree, s->view);
    double strain_energy = tree.elastic;
    invariants sum = {.energy = tree.kinetic + tree.potential,
                      .motion_energy = tree.kinetic,
                      .momentum = tree.linear_momentum,
                      .angular = tree.angular_momentum};
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (!beam->rod) continue;
        const bough_rod_model *model = bough_rod_body_model(beam->rod);
        bough_simulation_beam_motion(s, beam, g->vertex[k]);
        for (int i = 1; i <= model->n; i++)
            add_vertex(&beam->def.inertia[i], &g->vertex[k][i], s->tree->gravity, &sum);
        bough_rod_gather(model, s->rod[beam->port].state, bough_simulation_rod_input(s, beam),
                         &g->scratch[k]);
        strain_energy += rod_elastic_energy(model, &g->scratch[k]);
    }
    sum.energy += strain_energy;
    sum.motion_energy += strain_energy;
    return sum;
}

// The largest change of an invariant since `time`, and its largest value.
typedef struct drift {
    bool started;
    invariants first;
    double change, largest;
} drift;

static void follow_drift(drift *d, bough_verify_invariant which, const invariants *now) {
    double change, size;
    if (!d->started) d->first = *now;
    d->started = true;
    if (which == BOUGH_VERIFY_ENERGY) {
        change = fabs(now->energy - d->first.energy);
        size = now->motion_energy;
    } else {
        bool angular = which == BOUGH_VERIFY_ANGULAR_MOMENTUM;
        bough_vec3 a = angular ? now->angular : now->momentum;
        bough_vec3 b = angular ? d->first.angular : d->first.momentum;
        change = bough_norm(bough_sub(a, b));
        size = bough_norm(a);
    }
    d->change = fmax(d->change, change);
    d->largest = fmax(d->largest, size);
}

// -- run ------------------------------------------------------------------------------------------

// Sums over the synchronisation points: of a channel, and of its first harmonic in the azimuth.
typedef struct wave {
    int n;
    double sum, cosine, sine;
} wave;

typedef struct case_run {
    const bough_verify_case *x;
    bough_run *run;
    const double *sample; // (run->channels.count)
    int *column;          // (n_expect); −1: no channel
    drift *drift;         // (n_expect)
    wave *wave;           // (n_expect)
    int azimuth;          // its column; −1: no rotor
    gauge gauge;
    bool conserves; // some quantity is a drift
    double *value;  // (n_expect)
} case_run;

static bough_status prepare(bough_arena *arena, case_run *r) {
    size_t n = (size_t)r->x->n_expect;
    r->column = bough_arena_take(arena, n * sizeof *r->column);
    r->drift = bough_arena_take(arena, n * sizeof *r->drift);
    r->wave = bough_arena_take(arena, n * sizeof *r->wave);
    r->azimuth = bough_channels_find(&r->run->channels, "Azimuth");
    gauge_init(&r->gauge, arena, r->run->simulation);
    for (int i = 0; i < r->x->n_expect; i++) {
        const bough_verify_quantity *q = &r->x->expect[i].quantity;
        if (!r->x->expect[i].diagnosis && q->what == BOUGH_VERIFY_DRIFT) r->conserves = true;
        r->column[i] = q->channel ? bough_channels_find(&r->run->channels, q->channel) : -1;
        if (q->channel && r->column[i] < 0) {
            return bough_fail(BOUGH_INVALID, "the scene has no channel '%.60s'", q->channel);
        }
        if (q->what == BOUGH_VERIFY_AMPLITUDE && r->azimuth < 0) {
            return bough_fail(BOUGH_INVALID, "the scene has no rotor for an amplitude per turn");
        }
    }
    return bough_ok();
}

static double follow_wave(wave *w, bool amplitude, double sample, double azimuth) {
    double angle = azimuth * (BOUGH_PI / 180);
    w->n++;
    w->sum += sample;
    w->cosine += sample * cos(angle);
    w->sine += sample * sin(angle);
    return amplitude ? 2 * hypot(w->cosine, w->sine) / w->n : w->sum / w->n;
}

static void look_at(case_run *r, int i, double t, const invariants *now) {
    const bough_verify_quantity *q = &r->x->expect[i].quantity;
    double close = 1e-6 * r->run->simulation->master->macro_step, *value = &r->value[i];
    double sample = r->column[i] >= 0 ? r->sample[r->column[i]] : 0;
    bool first = isnan(*value);
    if (q->what == BOUGH_VERIFY_AT && fabs(t - q->time) < close) *value = sample;
    if (q->what == BOUGH_VERIFY_LARGEST && (first || sample > *value)) *value = sample;
    if (q->what == BOUGH_VERIFY_SMALLEST && (first || sample < *value)) *value = sample;
    bool amplitude = q->what == BOUGH_VERIFY_AMPLITUDE;
    if ((amplitude || q->what == BOUGH_VERIFY_MEAN) && t > q->time + close) {
        double azimuth = r->azimuth < 0 ? 0 : r->sample[r->azimuth];
        *value = follow_wave(&r->wave[i], amplitude, sample, azimuth);
    }
    if (q->what == BOUGH_VERIFY_DRIFT && t > q->time - close) {
        drift *d = &r->drift[i];
        follow_drift(d, (bough_verify_invariant)q->index, now);
        *value = d->largest > 0 ? d->change / d->largest : d->change;
    }
}

static bough_status look(void *self) {
    case_run *r = self;
    double t = r->run->simulation->master->time;
    invariants now = {0};
    if (r->conserves) now = measure(&r->gauge);
    r->sample = bough_run_values(r->run);
    for (int i = 0; i < r->x->n_expect; i++) {
        if (!r->x->expect[i].diagnosis) look_at(r, i, t, &now);
    }
    return bough_ok();
}

// What a step of the tree takes, by itself or in the integrator of all bodies.
static void count_work(case_run *r) {
    bough_statistics work = bough_run_statistics(r->run, 0);
    bough_statistics whole = bough_run_statistics(r->run, r->run->simulation->master->assembly->n_member);
    bough_statistics_add(&work, 1, &whole);
    for (int i = 0; i < r->x->n_expect; i++) {
        const bough_verify_expect *e = &r->x->expect[i];
        if (e->diagnosis || e->quantity.what != BOUGH_VERIFY_WORK || work.steps == 0) continue;
        r->value[i] = (double)work.derivatives / (double)work.steps;
    }
}

static bough_status do_run(bough_arena *arena, const bough_verify_case *x, bough_run *run, bool (*stop)(void),
                           double *value) {
    case_run r = {.x = x, .run = run, .value = value};
    BOUGH_TRY(prepare(arena, &r));
    look(&r);
    run->stop = stop;
    run->after = look;
    run->self = &r;
    bough_run_all(run);
    if (run->outcome.code != BOUGH_INTERRUPTED) count_work(&r);
    return run->outcome;
}

void bough_verify_run(bough_arena *arena, const bough_verify_case *x, int k, bool (*stop)(void),
                      bough_verify_result *result) {
    bough_arena *own = bough_arena_child(arena);
    bough_run run;
    result->value = bough_arena_doubles(arena, (size_t)x->n_expect);
    for (int i = 0; i < x->n_expect; i++) result->value[i] = NAN;
    result->outcome = open_scene(own, x, k, &run);
    if (bough_is_ok(&result->outcome)) {
        bough_simulation *s = run.simulation;
        result->outcome = x->action == BOUGH_VERIFY_STATIC  ? do_static(own, x, s, result->value)
                          : x->action == BOUGH_VERIFY_MODES ? do_modes(own, x, s, result->value)
                                                            : do_run(own, x, &run, stop, result->value);
    }
    bough_arena_destroy(own);
}

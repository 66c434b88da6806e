// The search for the fastest settings that meet an error.
#include "apps/bough/cases/tune.h"

#include "apps/bough/cases/case_run.h"
#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/run.h"
#include "apps/bough/results/folder.h"

// -- the scene ------------------------------------------------------------------------------------

// Whether the rod keeps the scene's number of segments: with a load at a vertex, or with modal pieces.
static bool is_kept(const bough_scene *scene, int body) {
    if (scene->body[body].fidelity == BOUGH_SCENE_SEGMENTED_MODAL) return true;
    for (int k = 0; k < scene->n_load; k++) {
        const bough_scene_load *load = &scene->load[k];
        if (load->body_name && load->body == body && load->place == BOUGH_SCENE_AT_VERTEX) return true;
    }
    return false;
}

// With fewer segments a run is hardly faster, and errors do not fall with the order of the mesh.
enum { FEW_SEGMENTS = 10 };

int bough_tune_segments(const bough_scene *scene, int body, const bough_tune_settings *settings) {
    const bough_scene_body *b = &scene->body[body];
    if (!bough_scene_has_mesh(b)) return 0;
    if (settings->own || is_kept(scene, body)) return b->rod.n_segment;
    double n = settings->mesh * b->rod.n_segment, lanes = n > 12 ? 4 : 2; // segments are computed in lanes
    return (int)fmax(lanes * round(n / lanes), fmin(b->rod.n_segment, FEW_SEGMENTS));
}

static void apply(const bough_tune_state *t, const bough_tune_settings *s, bough_scene *scene) {
    bough_scene_simulation *simulation = &scene->simulation;
    if (!s->own) {
        bool whole = bough_scheme_at(s->scheme)->one_system;
        bough_scene_solver *solver = whole ? &simulation->master : &simulation->micro;
        simulation->coupling.scheme = s->scheme;
        solver->solver = s->solver;
        solver->rtol = s->rtol;
        solver->step = s->step;
        if (!whole) simulation->master.solver = BOUGH_IDA;
        if (!whole) simulation->master.rtol = fmin(0.1 * s->rtol, 1e-6);
        simulation->macro_step = s->macro_step;
        simulation->step_control.tolerance = 0;
        scene->aero.rate = s->rate;
        for (int i = 0; i < scene->n_body; i++) {
            scene->body[i].micro.node = NULL;
            int n = bough_tune_segments(t->scene, i, s);
            if (n > 0) scene->body[i].rod.n_segment = n;
        }
    }
    double pair = 2 * simulation->macro_step; // the companion's step is twice as long
    simulation->duration = pair * fmax(1, round(t->options->span / pair));
    simulation->threads = 1;
    simulation->error_bound = 0;
    simulation->error_shares = true;
    simulation->output.from = 0;
}

// -- the run --------------------------------------------------------------------------------------

typedef struct measurement {
    const bough_tune_state *tune;
    bough_tune_point *point;
    bool estimate, separate;
} measurement;

static double worst(const bough_companion *c, bool motion, const double *error, char name[32]) {
    bough_error_verdict v = bough_error_verdict_of(c, motion, error);
    if (name && v.channel >= 0) snprintf(name, 32, "%.31s", c->channels->channel[v.channel].name);
    return v.channel < 0 ? 0 : v.relative;
}

// Forces and moments contain vibrations that hardly move anything: they may have four times the error of
// motions.
static double together(double motion, double force) { return fmax(motion, 0.25 * force); }

static bough_status take_errors(const measurement *m, bough_arena *arena, bough_companion *c) {
    bough_tune_point *p = m->point;
    if (c->compared == 0 || c->reason[0]) return bough_fail(BOUGH_FAILED, "no error is known: %s", c->reason);
    p->motion = worst(c, true, c->error, p->channel);
    p->force = worst(c, false, c->error, NULL);
    p->error = together(p->motion, p->force);
    if (!isfinite(p->error)) return bough_fail(BOUGH_FAILED, "the error of %s has no bound", p->channel);
    if (!m->separate) return bough_ok();
    bough_error_shares shares;
    bough_status status = bough_error_shares_find(arena, c, m->tune->options->stop, &shares);
    for (int k = 0; k < BOUGH_SHARES && bough_is_ok(&status); k++) {
        const double *error = shares.share[k].largest;
        if (!shares.share[k].unknown[0])
            p->part[k] = together(worst(c, true, error, NULL), worst(c, false, error, NULL));
    }
    p->separate = bough_is_ok(&status);
    return status;
}

static bough_status run_in(bough_arena *arena, void *self) {
    const measurement *m = self;
    const bough_tune_options *o = m->tune->options;
    bough_scene *scene = bough_scene_copy(arena, m->tune->scene);
    bough_run run;
    apply(m->tune, &m->point->settings, scene);
    scene->simulation.error_estimate = m->estimate ? BOUGH_SCENE_COMPANION : BOUGH_SCENE_NO_ESTIMATE;
    BOUGH_TRY(bough_run_create(arena, scene, &run));
    run.stop = o->stop;
    run.steps_together = true;
    run.beside = true;
    bough_run_all(&run);
    if (!bough_is_ok(&run.outcome)) return run.outcome;
    if (m->estimate) return take_errors(m, arena, run.companion);
    double cpu = run.cpu_s * o->span / scene->simulation.duration;
    if (!(m->point->cpu > 0) || cpu < m->point->cpu) m->point->cpu = cpu;
    return bough_ok();
}

// A failed run is an outcome of the point. BOUGH_INTERRUPTED by the options' stop.
static bough_status perform(measurement m) {
    m.point->outcome = bough_arena_use(run_in, &m);
    return bough_ends_study(m.point->outcome.code) ? m.point->outcome : bough_ok();
}

// Runs the point without an estimate of the error and keeps the shortest CPU time.
static bough_status measure_time(const bough_tune_state *t, bough_tune_point *point) {
    return perform((measurement){t, point, false, false});
}

// -- the front ------------------------------------------------------------------------------------

bool bough_tune_ended(const bough_tune_point *p) { return bough_is_ok(&p->outcome) && p->cpu > 0; }

static bool meets_error(const bough_tune_state *t, const bough_tune_point *p) {
    return bough_tune_ended(p) && p->error <= t->error;
}

static bool beats(const bough_tune_state *t, const bough_tune_point *a, const bough_tune_point *b) {
    bool meets = meets_error(t, a), other = meets_error(t, b);
    if (meets != other) return meets;
    return meets ? a->cpu < b->cpu : a->error < b->error;
}

// Marks the Pareto front and the chosen point.
static void choose(bough_tune_state *t) {
    t->chosen = -1;
    for (int i = 0; i < t->n; i++) {
        bough_tune_point *p = &t->point[i];
        p->best = bough_tune_ended(p);
        for (int k = 0; k < t->n && p->best; k++) {
            const bough_tune_point *q = &t->point[k];
            p->best = !(bough_tune_ended(q) && q->cpu < p->cpu && q->error <= p->error);
        }
        if (bough_tune_ended(p) && (t->chosen < 0 || beats(t, p, &t->point[t->chosen]))) t->chosen = i;
    }
}

// -- settings -------------------------------------------------------------------------------------

static const double longest_period = 0.1; // between samples of the air [s]
static const double loosest = 0.02;       // rtol

// The longest round period up to 1.1 `wanted` [s] that is one or two macro steps of the scene.
static double period_up_to(const bough_scene *scene, double wanted, double *macro_step) {
    static const double round_one[] = {10, 8, 6.25, 5, 4, 3.125, 2.5, 2, 1.6, 1.25};
    bough_scene s = *scene;
    for (double unit = 0.01; unit > 1e-6; unit *= 0.1) {
        for (size_t k = 0; k < sizeof round_one / sizeof *round_one; k++) {
            double period = round_one[k] * unit;
            s.aero.rate = 1 / period;
            for (int parts = 1; parts <= 2 && period <= 1.1 * wanted; parts++) {
                *macro_step = period / parts;
                if (bough_scene_step_fits(&s, *macro_step)) return period;
            }
        }
    }
    *macro_step = scene->simulation.macro_step;
    return 1 / scene->aero.rate;
}

static void set_rate(const bough_tune_state *t, double rate, bough_tune_settings *s) {
    if (rate > 0) s->rate = 1 / period_up_to(t->scene, fmin(1 / rate, longest_period), &s->macro_step);
}

// A fraction of the macro step, at most `step`: steps end where macro steps end.
static void set_step(double step, bough_tune_settings *s) {
    double parts = ceil(s->macro_step / step - 0.1);
    s->step = parts > 1 ? s->macro_step / parts : 0;
}

static bool near(double a, double b, double relative) { return fabs(a - b) <= relative * fmax(a, b); }

static bool same(const bough_tune_state *t, const bough_tune_settings *a, const bough_tune_settings *b) {
    bool equal = a->scheme == b->scheme && a->solver == b->solver &&
                 near(bough_tune_step(a), bough_tune_step(b), 0.05) &&
                 near(a->macro_step, b->macro_step, 1e-9) && near(a->rate, b->rate, 1e-9) &&
                 near(a->rtol, b->rtol, 0.1);
    for (int i = 0; i < t->scene->n_body && equal; i++)
        equal = bough_tune_segments(t->scene, i, a) == bough_tune_segments(t->scene, i, b);
    return equal;
}

// -- trying ---------------------------------------------------------------------------------------

// Runs new settings and finds errors, with `separate` also those of mesh, air and time, and CPU time. *at:
// their point, −1 if there is no room.
static bough_status try(bough_tune_state *t, const bough_tune_settings *s, bool separate, int *at) {
    *at = -1;
    for (int i = 0; i < t->n; i++) {
        if (same(t, s, &t->point[i].settings)) *at = i;
    }
    if (*at >= 0 || t->n == BOUGH_TUNE_POINTS) return bough_ok();
    *at = t->n++;
    bough_tune_point *p = &t->point[*at];
    *p = (bough_tune_point){.settings = *s, .outcome = bough_ok()};
    bough_status status = perform((measurement){t, p, true, separate});
    if (bough_is_ok(&status) && bough_is_ok(&p->outcome)) status = measure_time(t, p);
    choose(t);
    if (bough_is_ok(&status)) bough_tune_print(t, *at, t->options->stream);
    return status;
}

// -- all settings at once -------------------------------------------------------------------------

enum { MESH, AIR, TIME, PARTS, ROUNDS = 5 };
// Order of each part's error, and how many times finer or coarser it may become in one round.
static const double order[PARTS] = {2, 3, 1}, most[PARTS] = {1.6, 2, 20};
static const double order_of_step = 3;
static const double margin = 0.85;                      // of the error bound, aimed at
static const double close_to = 0.7;                     // of the bound: no further round is needed
static const double hardly_less = 0.9, much_more = 1.5; // than in the previous round

// Refines or coarsens each part so that all contribute equally to the error aimed at. The separate errors are
// the largest of different channels, so that their sum exceeds the error.
static void refine_parts(const bough_tune_state *t, const bough_tune_point *p, double aimed,
                         bough_tune_settings *s) {
    double factor[PARTS], part[PARTS], sum = 0;
    int parts = 0;
    for (int k = 0; k < PARTS; k++) {
        part[k] = fmin(p->part[k], p->error);
        parts += part[k] > 0;
        sum += part[k];
    }
    for (int k = 0; k < PARTS; k++) {
        double aim = aimed * t->error * fmax(sum / p->error, 1) / fmax(parts, 1);
        double finer = part[k] > 0 ? pow(part[k] / aim, 1 / order[k]) : 1;
        factor[k] = fmax(1 / most[k], fmin(finer, most[k]));
    }
    double step = bough_tune_step(s);
    s->mesh *= factor[MESH];
    s->rtol = fmin(s->rtol / factor[TIME], loosest);
    set_rate(t, s->rate * factor[AIR], s);
    set_step(step / pow(factor[TIME], 1 / order_of_step), s);
}

// Repeats until the error is just below the bound. After a round whose error is too large and hardly smaller
// than the previous one, a smaller error is aimed at; a round with a much larger error is the last.
static bough_status descend(bough_tune_state *t, bough_tune_settings *s) {
    double before = HUGE_VAL, aimed = margin;
    for (int k = 0; k < ROUNDS; k++) {
        int n = t->n, at;
        bough_status status = try(t, s, true, &at);
        if (!bough_is_ok(&status) || at < 0) return status;
        const bough_tune_point *p = &t->point[at];
        bool meets = meets_error(t, p);
        if (!bough_tune_ended(p) || !p->separate || (k > 0 && t->n == n)) break;
        if (meets ? p->error > close_to * t->error : !(p->error < much_more * before)) break;
        if (!meets && p->error > hardly_less * before) aimed *= 0.6;
        before = p->error;
        refine_parts(t, p, aimed, s);
    }
    return bough_ok();
}

// -- one setting at a time ------------------------------------------------------------------------

enum { COARSER_MESH, LOOSER, LONGER, SHORTER, LOWER_RATE, RAMP, VARIATIONS };

static bool has_rods(const bough_scene *scene) {
    for (int i = 0; i < scene->n_body; i++) {
        if (bough_scene_has_mesh(&scene->body[i])) return true;
    }
    return false;
}

// False if the scene has no such variation.
static bool vary(const bough_tune_state *t, int variation, bough_tune_settings *s) {
    bough_scene scene = *t->scene;
    scene.aero.rate = s->rate;
    switch (variation) {
    case COARSER_MESH: s->mesh *= 0.75; return has_rods(&scene);
    case LOOSER: s->rtol *= 2.5; return s->rtol < loosest;
    case LONGER:
        if (!(s->step > 0)) s->macro_step *= 2;
        s->step = 0;
        return bough_scene_step_fits(&scene, s->macro_step);
    case SHORTER: set_step(0.5 * bough_tune_step(s), s); return true;
    case LOWER_RATE: set_rate(t, 0.8 * s->rate, s); return s->rate > 0;
    default:
        s->scheme = bough_scheme_index(bough_scheme_advised()->name);
        s->solver = BOUGH_ROSENBROCK;
        s->step = fmin(bough_tune_step(s), 0.5 * s->macro_step);
        return has_rods(&scene) && t->scene->n_connector[BOUGH_SCENE_CLOSURE] == 0;
    }
}

static bough_status vary_best(bough_tune_state *t) {
    for (int k = 0; k < VARIATIONS; k++) {
        if (t->chosen < 0) return bough_ok();
        bough_tune_settings s = t->point[t->chosen].settings;
        if (s.own && t->n > 1) s = t->point[1].settings;
        s.own = false;
        int at;
        BOUGH_TRY(vary(t, k, &s) ? try(t, &s, false, &at) : bough_ok());
    }
    return bough_ok();
}

// -- all ------------------------------------------------------------------------------------------

static bough_tune_settings settings_of(const bough_scene *scene) {
    const bough_scene_simulation *s = &scene->simulation;
    bool whole = bough_scheme_at(s->coupling.scheme)->one_system;
    const bough_scene_solver *solver = whole ? &s->master : &s->micro;
    return (bough_tune_settings){.own = true,
                                 .scheme = s->coupling.scheme,
                                 .solver = solver->solver,
                                 .rtol = solver->rtol,
                                 .step = solver->step,
                                 .macro_step = s->macro_step,
                                 .rate = scene->aero.node ? scene->aero.rate : 0,
                                 .mesh = 1};
}

// All bodies as one system, with the scene's own settings as far as they apply.
static bough_tune_settings start_of(const bough_tune_state *t) {
    bough_tune_settings s = settings_of(t->scene);
    s.own = false;
    if (bough_scheme_at(s.scheme)->one_system) return s;
    s.scheme = bough_scheme_index(BOUGH_SCHEME_DEFAULT);
    if (s.solver != BOUGH_ROSENBROCK && s.solver != BOUGH_GENERALIZED_ALPHA) s.step = 0;
    s.solver = BOUGH_AUTOMATIC;
    return s;
}

// Times scatter by more than settings differ: the candidates are run again, alternately.
static bough_status time_again(bough_tune_state *t) {
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < t->n; i++) {
            bough_tune_point *p = &t->point[i];
            if (!p->best && !p->settings.own &&
                !(meets_error(t, p) && p->cpu < 1.3 * t->point[t->chosen].cpu))
                continue;
            BOUGH_TRY(measure_time(t, p));
        }
    }
    choose(t);
    return bough_ok();
}

static bough_status search(bough_tune_state *t) {
    bough_tune_settings own = settings_of(t->scene), s = start_of(t);
    int at;
    BOUGH_TRY(try(t, &own, bough_scheme_at(own.scheme)->one_system, &at));
    BOUGH_TRY(descend(t, &s));
    BOUGH_TRY(vary_best(t));
    return time_again(t);
}

// Prints the fastest run that is as accurate as the scene as written.
static void print_equal(const bough_tune_state *t) {
    const bough_tune_point *own = &t->point[0], *least = own;
    if (!bough_tune_ended(own)) return;
    for (int i = 1; i < t->n; i++) {
        const bough_tune_point *p = &t->point[i];
        if (bough_tune_ended(p) && p->error <= own->error && p->cpu < least->cpu) least = p;
    }
    fprintf(t->options->stream, "# the scene as written: error %.2g, forces %.2g; %.3g s of CPU", own->motion,
            own->force, own->cpu);
    if (least != own)
        fprintf(t->options->stream, "; run %d is no less accurate in %.3g s", (int)(least - t->point) + 1,
                least->cpu);
    fputc('\n', t->options->stream);
}

static bough_status conclude(const bough_tune_state *t) {
    if (t->chosen < 0) return bough_fail(BOUGH_FAILED, "no run ended: %.200s", t->point[0].outcome.message);
    const bough_tune_point *p = &t->point[t->chosen];
    fprintf(t->options->stream, "\n");
    bough_tune_print_settings(t, t->options->stream);
    print_equal(t);
    if (meets_error(t, p)) return bough_ok();
    bool moves = p->motion > t->error;
    return bough_fail(
        BOUGH_FAILED,
        "no settings meet the error %.3g: run %d comes nearest, with an error of %s of %.2g instead of "
        "%.3g; try a larger --error",
        t->error, t->chosen + 1, moves ? "motions" : "forces and moments", moves ? p->motion : p->force,
        (moves ? 1 : 4) * t->error);
}

bough_status bough_tune(bough_arena *arena, const bough_scene *scene, const bough_tune_options *options) {
    bough_tune_state *t = bough_arena_take(arena, sizeof *t);
    *t = (bough_tune_state){.options = options, .scene = scene, .chosen = -1};
    t->error = options->error > 0 ? options->error : scene->simulation.accuracy;
    bough_tune_print(t, -1, options->stream);
    BOUGH_TRY(search(t));
    if (t->chosen >= 0) BOUGH_TRY(bough_tune_write(t));
    return conclude(t);
}

// One stretch of a scene with other settings: its errors and its cost.
#include "apps/bough/cases/tune_internal.h"
#include "apps/bough/model/error_shares.h"
#include "apps/bough/model/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// -- the scene ------------------------------------------------------------------------------------

// A load at a vertex, the pieces of a modal body: the number of segments is then the scene's.
static bool is_kept(const bough_scene *scene, int body) {
    if (scene->body[body].fidelity == BOUGH_SCENE_SEGMENTED_MODAL) return true;
    for (int k = 0; k < scene->n_load; k++) {
        const bough_scene_load *load = &scene->load[k];
        if (load->body_name && load->body == body && load->place == BOUGH_SCENE_AT_VERTEX) return true;
    }
    return false;
}

// Fewer save little, and errors do not fall with the order of the mesh.
enum { FEW_SEGMENTS = 10 };

int bough_tune_segments(const bough_scene *scene, int body, const bough_tune_settings *settings) {
    const bough_scene_body *b = &scene->body[body];
    if (!bough_scene_has_mesh(b)) return 0;
    if (settings->own || is_kept(scene, body)) return b->rod.n_segment;
    double n = settings->mesh * b->rod.n_segment, lanes = n > 12 ? 4 : 2; // segments are worked on in lanes
    return (int)fmax(lanes * round(n / lanes), fmin(b->rod.n_segment, FEW_SEGMENTS));
}

static void apply(const bough_tune_state *t, const bough_tune_settings *s, bough_scene *scene) {
    bough_scene_simulation *simulation = &scene->simulation;
    if (!s->own) {
        bool whole = bough_scheme_find(bough_scheme_name(s->scheme))->one_system;
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
    double pair = 2 * simulation->macro_step; // the companion takes two at once
    simulation->duration = pair * fmax(1, round(t->options->span / pair));
    simulation->threads = 1;
    simulation->error_bound = 0;
    simulation->error_shares = false;
    simulation->output.from = 0;
}

// -- the run --------------------------------------------------------------------------------------

typedef struct measurement {
    const bough_tune_state *tune;
    bough_tune_point *point;
    bool estimate, shares;
} measurement;

static double worst(const bough_companion *c, bool motion, const double *error, char name[32]) {
    bough_error_verdict v = bough_error_verdict_of(c, motion, error);
    if (name && v.channel >= 0) snprintf(name, 32, "%.31s", c->channels->channel[v.channel].name);
    return v.channel < 0 ? 0 : v.relative;
}

// Forces and moments contain vibrations that hardly move anything: four times the error of motions.
static double together(double motion, double force) { return fmax(motion, 0.25 * force); }

static bough_status take_errors(const measurement *m, bough_arena *arena, bough_companion *c) {
    bough_tune_point *p = m->point;
    if (c->compared == 0 || c->reason[0]) return bough_fail(BOUGH_FAILED, "no error is known: %s", c->reason);
    p->motion = worst(c, true, c->error, p->channel);
    p->force = worst(c, false, c->error, NULL);
    p->error = together(p->motion, p->force);
    if (!isfinite(p->error)) return bough_fail(BOUGH_FAILED, "the error of %s has no bound", p->channel);
    if (!m->shares) return bough_ok();
    bough_error_shares shares;
    bough_status status = bough_error_shares_find(arena, c, m->tune->options->stop, &shares);
    for (int k = 0; k < BOUGH_SHARES && bough_is_ok(&status); k++) {
        const double *error = shares.share[k].largest;
        if (!shares.share[k].unknown[0])
            p->share[k] = together(worst(c, true, error, NULL), worst(c, false, error, NULL));
    }
    p->shared = bough_is_ok(&status);
    return status;
}

static bough_status run_in(bough_arena *arena, void *self) {
    const measurement *m = self;
    const bough_tune_options *o = m->tune->options;
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_run run;
    BOUGH_TRY(bough_scene_read(arena, o->scene, o->set, o->n_set, &errors, &scene));
    apply(m->tune, &m->point->settings, scene);
    scene->simulation.error_estimate = m->estimate ? BOUGH_SCENE_COMPANION : BOUGH_SCENE_NO_ESTIMATE;
    BOUGH_TRY(bough_run_create(arena, scene, &run));
    run.stop = o->stop;
    run.beside = true;
    bough_run_all(&run);
    if (!bough_is_ok(&run.outcome)) return run.outcome;
    if (m->estimate) return take_errors(m, arena, run.companion);
    double cpu = run.cpu_s * o->span / scene->simulation.duration;
    if (!(m->point->cpu > 0) || cpu < m->point->cpu) m->point->cpu = cpu;
    return bough_ok();
}

static bool ends(bough_code code) {
    return code == BOUGH_INTERRUPTED || code == BOUGH_OUT_OF_MEMORY || code == BOUGH_IO;
}

static bough_status perform(measurement *m) {
    m->point->outcome = bough_arena_use(run_in, m);
    return ends(m->point->outcome.code) ? m->point->outcome : bough_ok();
}

bough_status bough_tune_time(const bough_tune_state *t, bough_tune_point *point) {
    measurement m = {t, point, false, false};
    return perform(&m);
}

bough_status bough_tune_measure(const bough_tune_state *t, bool shares, bough_tune_point *point) {
    measurement m = {t, point, true, shares};
    bough_status status = perform(&m);
    if (!bough_is_ok(&status) || !bough_is_ok(&point->outcome)) return status;
    return bough_tune_time(t, point);
}

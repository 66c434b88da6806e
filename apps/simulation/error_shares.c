#include "apps/simulation/error_shares.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Orders at which the error falls with a segment's length and with the time between samples of the air:
// those of the rod's segments and of the signal between samples (docs/theory.md).
static const double mesh_order = 2, linear_air_order = 3, held_air_order = 1;

const char *bough_error_share_name(bough_error_share_kind kind) {
    return kind == BOUGH_SHARE_MESH ? "mesh" : "air";
}

static void unknown(bough_error_share *share, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(share->unknown, sizeof share->unknown, format, arguments);
    va_end(arguments);
}

bough_status bough_error_shares_create(bough_arena *arena, const bough_run *run, double interval,
                                       bough_error_shares *shares) {
    const bough_simulation *s = run->simulation;
    *shares = (bough_error_shares){.n_channel = s->n_motion_channel};
    for (int k = 0; k < BOUGH_SHARES; k++) {
        unknown(&shares->share[k], "simulation.error_shares does not ask for it");
    }
    if (!s->scene->simulation.error_shares) return bough_ok();
    double rows = ceil(s->master->duration / interval) + 2;
    if (rows * shares->n_channel > 1e8) {
        return bough_fail(BOUGH_INVALID, "simulation.error_shares: %.3g rows of %d channels do not fit"
                          " into memory; a longer simulation.output.interval", rows, shares->n_channel);
    }
    size_t n = (size_t)shares->n_channel + 1;
    shares->most = (int)rows;
    shares->row = bough_arena_doubles(arena, (size_t)shares->most * n);
    for (int k = 0; k < BOUGH_SHARES; k++) shares->share[k].largest = bough_arena_doubles(arena, n);
    return bough_ok();
}

void bough_error_shares_note(bough_error_shares *shares, bough_run *run) {
    if (!shares->row || shares->n_row >= shares->most) return;
    size_t n = (size_t)shares->n_channel;
    const double *value = bough_run_values(run);
    if (value) memcpy(shares->row + n * (size_t)shares->n_row++, value, n * sizeof *value);
}

// -- other runs -----------------------------------------------------------------------------------

// A run beside which the noted rows pass, or whose rows take their place.
typedef struct follower {
    bough_error_shares *shares;
    bough_error_share *share;
    bool takes;
    bough_run run;
    int row;
} follower;

static bough_status pass_row(void *self, double t) {
    follower *f = self;
    (void)t;
    const double *value = bough_run_values(&f->run);
    if (!value || f->row >= f->shares->n_row) return bough_ok();
    size_t n = (size_t)f->shares->n_channel;
    double *first = f->shares->row + (size_t)f->row++ * n;
    if (f->takes) memcpy(first, value, n * sizeof *value);
    for (int i = 0; i < f->shares->n_channel; i++) {
        double error = f->share->part * fabs(value[i] - first[i]);
        f->share->largest[i] = fmax(f->share->largest[i], error);
    }
    return bough_ok();
}

// The loads on vertices stay at their places.
static void follow_vertices(bough_arena *arena, bough_scene *scene, int times) {
    size_t n = (size_t)scene->n_load;
    bough_scene_load *load = bough_arena_take(arena, n * sizeof *load);
    for (size_t i = 0; i < n; i++) {
        load[i] = scene->load[i];
        if (load[i].place == BOUGH_SCENE_AT_VERTEX) load[i].vertex *= times;
    }
    scene->load = load;
}

static bool repeatable(const bough_scene *scene, bough_error_share *share) {
    share->unknown[0] = '\0';
    if (scene->control.node && scene->control.kind == BOUGH_SCENE_BLADED) {
        unknown(share, "the controller's library keeps a state that a second run would change");
    }
    return share->unknown[0] == '\0';
}

bool bough_error_share_refine(bough_arena *arena, bough_scene *scene, int times, bough_error_share *share) {
    size_t n = (size_t)scene->n_body;
    bough_scene_body *body = bough_arena_take(arena, n * sizeof *body);
    bool any = false;
    if (!repeatable(scene, share)) return false;
    follow_vertices(arena, scene, times);
    memcpy(body, scene->body, n * sizeof *body);
    for (size_t i = 0; i < n; i++) {
        if (!body[i].rod.node || body[i].fidelity == BOUGH_SCENE_RIGID) continue;
        if (body[i].fidelity != BOUGH_SCENE_ROD) {
            unknown(share, "%s is a modal body, whose shapes have errors of their own", body[i].name);
            return false;
        }
        body[i].rod.n_segment *= times;
        any = true;
    }
    if (!any) unknown(share, "no body has a mesh");
    share->order = mesh_order;
    share->part = 1 / (1 - pow(times, -mesh_order));
    scene->body = body;
    return any;
}

// Twice the samples: half of them may be too few to be stable.
static bool refine_air(bough_scene *scene, bough_error_share *share) {
    share->order = scene->aero.hold == BOUGH_SCENE_CONSTANT ? held_air_order : linear_air_order;
    double finer = pow(2, share->order);
    if (!repeatable(scene, share)) return false;
    if (!scene->aero.node) unknown(share, "the scene has no air");
    scene->aero.rate *= 2;
    share->part = finer / (finer - 1);
    return scene->aero.node != NULL;
}

static double tighter(double rtol) { return fmin(rtol, fmax(rtol / 30, 1e-8)); }

// All bodies in one system, because a coupling that holds on the scene's mesh may not hold on a finer one, with
// small errors of the steps; and macro steps into which twice the samples of the air fit.
static void refine_time(bough_scene *scene) {
    bough_scene_simulation *simulation = &scene->simulation;
    int monolithic = bough_scheme_index("monolithic");
    if (simulation->coupling.scheme == monolithic && simulation->master.solver != BOUGH_GENERALIZED_ALPHA) {
        simulation->master.rtol = tighter(simulation->master.rtol);
    } else {
        simulation->coupling.scheme = monolithic;
        simulation->master.solver = BOUGH_AUTOMATIC;
        simulation->master.rtol = 1e-5;
    }
    bool air = scene->aero.node != NULL;
    if (air && lround(1 / (scene->aero.rate * simulation->macro_step)) % 2 != 0) {
        simulation->macro_step /= 2;
        simulation->master.step = fmin(simulation->master.step, simulation->macro_step);
    }
}

typedef struct finding {
    bough_error_share_kind kind;
    const bough_run *run;
    double interval;
    bough_error_shares *shares;
    char *failed;  // (sizeof share.unknown) what ended the run with short steps; "": nothing
    bool *started; // whether there has been one
} finding;

// Runs a scene from start to end; false with the reason in the share.
static bool pass(bough_arena *arena, const finding *x, const bough_scene *scene, bool takes) {
    bough_error_share *share = &x->shares->share[x->kind];
    follower f = {.shares = x->shares, .share = share, .takes = takes};
    bough_status status = bough_run_create(arena, scene, &f.run);
    if (bough_is_ok(&status)) {
        f.run.stop = x->run->stop;
        bough_run_record_at(&f.run, (bough_run_record){x->interval, true, .sample = pass_row, .self = &f});
        bough_run_all(&f.run);
        status = f.run.outcome;
        share->cpu_s += f.run.cpu_s;
    }
    if (!bough_is_ok(&status)) {
        unknown(share, "the run that would tell it failed: %.100s", status.message);
    } else if (f.row != x->shares->n_row) {
        unknown(share, "the run was resumed: its rows before are not in memory");
    }
    return share->unknown[0] == '\0';
}

// The run with short steps, whose rows take the place of the run's own; once for both shares.
static bool pass_base(bough_arena *arena, const finding *x, const bough_scene *scene) {
    bough_error_share *share = &x->shares->share[x->kind];
    if (*x->started) {
        unknown(share, "%s", x->failed);
        return share->unknown[0] == '\0';
    }
    *x->started = true;
    bool passed = pass(arena, x, scene, true);
    memcpy(x->failed, share->unknown, sizeof share->unknown);
    return passed;
}

static bough_status find(bough_arena *arena, void *self) {
    const finding *x = self;
    bough_error_share *share = &x->shares->share[x->kind];
    bough_scene base = *x->run->simulation->scene;
    base.simulation.error_estimate = BOUGH_ERROR_NOT_TOLD;
    base.simulation.error_bound = 0;
    base.simulation.error_shares = false;
    refine_time(&base);
    bough_scene scene = base;
    // Twice the segments: half of them may be too few for the order to hold.
    bool mesh = x->kind == BOUGH_SHARE_MESH;
    bool ready = mesh ? bough_error_share_refine(arena, &scene, 2, share) : refine_air(&scene, share);
    if (ready && pass_base(arena, x, &base)) pass(arena, x, &scene, false);
    return bough_ok();
}

void bough_error_shares_find(bough_error_shares *shares, const bough_run *run, double interval) {
    char failed[sizeof shares->share[0].unknown] = "";
    bool started = false;
    for (int k = 0; k < BOUGH_SHARES && shares->row; k++) {
        finding f = {(bough_error_share_kind)k, run, interval, shares, failed, &started};
        bough_status status = bough_arena_use(find, &f);
        if (!bough_is_ok(&status)) unknown(&shares->share[k], "%s", status.message);
    }
}

// -- what they mean -------------------------------------------------------------------------------

// Above `least` and up to `most`, of the channel's range.
static void describe(const bough_error_shares *shares, bough_error_share_kind kind,
                     const bough_error_probe *probe, double least, double most,
                     char text[BOUGH_ERROR_WARNING]) {
    const bough_error_share *share = &shares->share[kind];
    text[0] = '\0';
    if (share->unknown[0]) return;
    bough_error_verdict v = bough_error_probe_verdict_of(probe, share->largest);
    if (v.channel < 0 || v.relative <= least || v.relative > most) return;
    bool mesh = kind == BOUGH_SHARE_MESH;
    const bough_channel *channel = &probe->channels->channel[v.channel];
    snprintf(text, BOUGH_ERROR_WARNING,
             "%s errs by %.2g %s, %.2g of its range; cause: the %s; try %s, %.2g times as %s", channel->name,
             share->largest[v.channel], channel->unit, v.relative, mesh ? "mesh" : "sampling of the air",
             mesh ? "rod.segments" : "aero.rate", 1.1 * pow(v.relative / least, 1 / share->order),
             mesh ? "many" : "high");
}

void bough_error_share_warn(const bough_error_shares *shares, bough_error_share_kind kind,
                            const bough_error_probe *probe, double bound, char text[BOUGH_ERROR_WARNING]) {
    describe(shares, kind, probe, BOUGH_ERROR_NOTICEABLE, bound > 0 ? bound : HUGE_VAL, text);
}

bough_status bough_error_shares_judge(const bough_error_shares *shares, const bough_error_probe *probe,
                                      double bound) {
    char text[BOUGH_ERROR_WARNING];
    for (int k = 0; k < BOUGH_SHARES && bound > 0; k++) {
        describe(shares, (bough_error_share_kind)k, probe, bound, HUGE_VAL, text);
        if (text[0]) return bough_fail(BOUGH_FAILED, "the error bound %.3g is exceeded: %s", bound, text);
    }
    return bough_ok();
}

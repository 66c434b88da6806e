#include "apps/bough/cli/static_find.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bough_status find_apart(bough_arena *arena, bough_static *x) {
    const bough_simulation *s = x->simulation;
    const bough_turning rest = {0};
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod == NULL) continue;
        bough_status status = bough_steady_find(arena, s, &s->beam[k], &rest, &x->rod[x->n++]);
        if (!bough_is_ok(&status)) return status;
    }
    return bough_ok();
}

// All together, with what the run's channels are there: joints, drives, closures, markers, roots, rotor.
static bough_status find_whole(bough_arena *arena, bough_static *x) {
    bough_simulation *s = x->simulation;
    x->time = bough_equilibrium_time(s);
    bough_status status = bough_simulation_equilibrium(s, s->master->assembly, x->time, &x->work);
    for (int k = 0; k < s->n_beam && bough_is_ok(&status); k++) {
        if (s->beam[k].rod == NULL) continue;
        status = bough_steady_equilibrium(arena, s, &s->beam[k], x->time, &x->rod[x->n++]);
    }
    if (bough_is_ok(&status)) status = bough_simulation_channels(s, &x->channels);
    if (!bough_is_ok(&status)) return status;
    x->value = bough_arena_doubles(arena, (size_t)x->channels.count + 1);
    bough_simulation_update(s);
    bough_channels_sample(&x->channels, x->time, x->value);
    return status;
}

bough_status bough_static_find(bough_arena *arena, bough_simulation *s, bough_static *x) {
    *x = (bough_static){.simulation = s, .channels = bough_channels_start(arena)};
    x->rod = bough_arena_take(arena, ((size_t)s->n_rod + 1) * sizeof *x->rod);
    // a modal body only with the whole
    x->apart = bough_equilibrium_apart(s) && bough_steady_rods(s) == s->n_rod;
    return x->apart ? find_apart(arena, x) : find_whole(arena, x);
}

void bough_static_results(bough_steady *rod, bough_vec3 result[BOUGH_STATIC_RESULTS]) {
    double wrench[6];
    bough_steady_displacement(rod, rod->model->n_segment, &result[BOUGH_STATIC_DISPLACEMENT],
                              &result[BOUGH_STATIC_ROTATION]);
    bough_rod_root_wrench(rod->model, &rod->work.scaled, rod->time, rod->state, rod->input,
                          &rod->work.scratch, wrench);
    result[BOUGH_STATIC_FORCE] = bough_v3(wrench[0], wrench[1], wrench[2]);
    result[BOUGH_STATIC_MOMENT] = bough_v3(wrench[3], wrench[4], wrench[5]);
}

// -- a finer mesh ---------------------------------------------------------------------------------

static const double part = 16.0 / 15; // of the difference that is the error, at order 2

typedef struct comparison {
    bough_static *coarse;
    bough_mesh_error *mesh;
    double *error; // (n × BOUGH_STATIC_RESULTS)
} comparison;

static void compare(const comparison *c, bough_static *fine) {
    bough_vec3 here[BOUGH_STATIC_RESULTS], there[BOUGH_STATIC_RESULTS];
    for (int k = 0; k < fine->n; k++) {
        bough_static_results(&c->coarse->rod[k], here);
        bough_static_results(&fine->rod[k], there);
        for (int i = 0; i < BOUGH_STATIC_RESULTS; i++) {
            c->error[BOUGH_STATIC_RESULTS * k + i] = part * bough_norm(bough_sub(here[i], there[i]));
        }
    }
    for (int i = 0; !fine->apart && i < fine->simulation->n_motion_channel; i++) {
        c->mesh->largest[i] = part * fabs(c->coarse->value[i] - fine->value[i]);
    }
}

// Segments of the finer mesh by those of the scene: two would still miss a feature of a table, as the last
// metre of a blade.
enum { TIMES = 4 };

// The finer mesh starts with the joints of the equilibrium found: a mechanism may have several.
static void start_near(const bough_simulation *coarse, bough_simulation *fine) {
    memcpy(fine->leader.state, coarse->leader.state, (size_t)fine->leader.system.n_state * sizeof(double));
}

// Loads on vertices stay at their places.
static void follow_vertices(bough_arena *arena, bough_scene *scene) {
    size_t n = (size_t)scene->n_load;
    bough_scene_load *load = bough_arena_take(arena, n * sizeof *load);
    for (size_t i = 0; i < n; i++) {
        load[i] = scene->load[i];
        if (load[i].place == BOUGH_SCENE_AT_VERTEX) load[i].vertex *= TIMES;
    }
    scene->load = load;
}

// False, with the reason, where no finer mesh tells the error.
static bool refine(bough_arena *arena, bough_scene *scene, bough_mesh_error *mesh) {
    size_t n = (size_t)scene->n_body;
    bough_scene_body *body = bough_arena_take(arena, n * sizeof *body);
    bool any = false;
    memcpy(body, scene->body, n * sizeof *body);
    for (size_t i = 0; i < n; i++) {
        if (!body[i].rod.node || body[i].fidelity == BOUGH_SCENE_RIGID) continue;
        if (body[i].fidelity != BOUGH_SCENE_ROD) {
            snprintf(mesh->unknown, sizeof mesh->unknown,
                     "%.60s is a modal body, whose shapes have errors of their own", body[i].name);
            return false;
        }
        body[i].rod.n_segment *= TIMES;
        any = true;
    }
    if (!any) snprintf(mesh->unknown, sizeof mesh->unknown, "no body has a mesh");
    follow_vertices(arena, scene);
    scene->body = body;
    return any;
}

static bough_status find_finer(bough_arena *arena, void *self) {
    const comparison *c = self;
    bough_scene scene = *c->coarse->simulation->scene;
    bough_simulation *s;
    bough_static fine;
    if (!refine(arena, &scene, c->mesh)) return bough_ok();
    bough_status status = bough_simulation_build(arena, &scene, &s);
    if (!bough_is_ok(&status)) return status;
    start_near(c->coarse->simulation, s);
    status = bough_static_find(arena, s, &fine);
    if (bough_is_ok(&status)) compare(c, &fine);
    return status;
}

double *bough_static_mesh_error(bough_arena *arena, bough_static *x, bough_mesh_error *mesh) {
    *mesh = (bough_mesh_error){.largest = bough_arena_doubles(arena, (size_t)x->channels.count + 1)};
    comparison c = {x, mesh, bough_arena_doubles(arena, BOUGH_STATIC_RESULTS * ((size_t)x->n + 1))};
    bough_status status = bough_arena_use(find_finer, &c);
    if (!bough_is_ok(&status)) {
        snprintf(mesh->unknown, sizeof mesh->unknown, "with %d times the segments: %.120s", TIMES,
                 status.message);
    }
    return c.error;
}

#include "apps/bough/static_find.h"

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

typedef struct comparison {
    bough_static *coarse;
    bough_error_share *share;
    double *error; // (n × BOUGH_STATIC_RESULTS)
} comparison;

static void compare(const comparison *c, bough_static *fine) {
    bough_vec3 here[BOUGH_STATIC_RESULTS], there[BOUGH_STATIC_RESULTS];
    for (int k = 0; k < fine->n; k++) {
        bough_static_results(&c->coarse->rod[k], here);
        bough_static_results(&fine->rod[k], there);
        for (int i = 0; i < BOUGH_STATIC_RESULTS; i++) {
            c->error[BOUGH_STATIC_RESULTS * k + i] =
                c->share->part * bough_norm(bough_sub(here[i], there[i]));
        }
    }
    for (int i = 0; !fine->apart && i < fine->simulation->n_motion_channel; i++) {
        c->share->largest[i] = c->share->part * fabs(c->coarse->value[i] - fine->value[i]);
    }
}

// Segments of the finer mesh by those of the scene: two would still miss a feature of a table, as the last
// metre of a blade.
enum { TIMES = 4 };

// The finer mesh starts with the joints of the equilibrium found: a mechanism may have several.
static void start_near(const bough_simulation *coarse, bough_simulation *fine) {
    memcpy(fine->leader.state, coarse->leader.state, (size_t)fine->leader.system.n_state * sizeof(double));
}

static bough_status find_finer(bough_arena *arena, void *self) {
    const comparison *c = self;
    bough_scene scene = *c->coarse->simulation->scene;
    bough_simulation *s;
    bough_static fine;
    if (!bough_error_share_refine(arena, &scene, TIMES, c->share)) return bough_ok();
    bough_status status = bough_simulation_build(arena, &scene, &s);
    if (!bough_is_ok(&status)) return status;
    start_near(c->coarse->simulation, s);
    status = bough_static_find(arena, s, &fine);
    if (bough_is_ok(&status)) compare(c, &fine);
    return status;
}

double *bough_static_mesh_error(bough_arena *arena, bough_static *x, bough_error_share *share) {
    *share = (bough_error_share){.largest = bough_arena_doubles(arena, (size_t)x->channels.count + 1)};
    comparison c = {x, share, bough_arena_doubles(arena, BOUGH_STATIC_RESULTS * ((size_t)x->n + 1))};
    bough_status status = bough_arena_use(find_finer, &c);
    if (!bough_is_ok(&status)) {
        snprintf(share->unknown, sizeof share->unknown, "with %d times the segments: %.120s", TIMES,
                 status.message);
    }
    return c.error;
}

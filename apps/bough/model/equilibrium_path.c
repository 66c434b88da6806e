// Paths of equilibria while the loads grow.
#include "apps/bough/model/equilibrium_search.h"

#include <math.h>
#include <string.h>

static bough_status tell_point(void *self, double share, const double *state, bool limit) {
    const bough_equilibrium_search *x = self;
    double time = fmin(fmax(share, 0), 1) * bough_equilibrium_time(x->simulation);
    for (int i = 0; i < x->assembly->n_member; i++)
        bough_member_set(x->assembly->member[i], time, state + x->assembly->state_offset[i]);
    bough_simulation_update(x->simulation);
    bough_whole_inputs(x->whole, time, state);
    size_t size = (size_t)x->assembly->n_input * sizeof(double);
    memcpy(x->simulation->master->coupling->input, x->whole->input, size);
    return x->listener.point(x->listener.self, time, share, limit);
}

static bough_status refuse_path(const bough_simulation *s) {
    const char *file = s->scene->file;
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        if (link->motion == NULL) continue;
        return bough_fail(BOUGH_INVALID,
                          "%.200s: body '%s': a path of equilibria knows no prescribed motions: give its "
                          "joint a load",
                          file, s->tree->bodies[link->body].name);
    }
    if (s->aero != NULL) return bough_fail(BOUGH_INVALID, "%.200s: a path of equilibria knows no air", file);
    if (s->jumps)
        return bough_fail(BOUGH_INVALID, "%.200s: loads: a path of equilibria knows no jumps", file);
    if (bough_equilibrium_time(s) > 0) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "%.200s: loads: expected one that grows, as 'ramp: [0 s, 1 s]': its path is "
                      "followed over the ramp",
                      file);
}

static bough_status walk_path(bough_arena *arena, void *self) {
    bough_equilibrium_search *x = self;
    bough_path_def def = bough_path_def_default();
    bough_equilibrium_search_set_up(arena, x);
    bough_equilibrium_def start = bough_equilibrium_search_def(x);
    BOUGH_TRY(bough_equilibrium_search_balance(arena, x, &start));
    def.end = bough_equilibrium_time(x->simulation);
    def.self = x;
    def.move = bough_equilibrium_search_move;
    def.rest = bough_equilibrium_search_rest;
    def.point = tell_point;
    return bough_path_follow(arena, x->whole, &def, x->state, x->report);
}

bough_status bough_simulation_path(bough_simulation *s, const bough_assembly *assembly,
                                   bough_path_listener listener, bough_path_report *report) {
    bough_equilibrium_work work = {0};
    bough_equilibrium_search x = {s, assembly, .limits = bough_equilibrium_def_default(), .work = &work};
    x.listener = listener;
    x.report = report;
    *report = (bough_path_report){0};
    BOUGH_TRY(refuse_path(s));
    return bough_arena_use(walk_path, &x);
}

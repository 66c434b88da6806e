// All members in one system ẏ = F(t, y), coupled.h, integrated by one method across macro steps: no
// coupling error. With a one-step method the members are coupled at its stages, each of which costs
// a member what its own sub-solver would; with an implicit multistep method at a tight tolerance it
// is the reference of every error figure.
#include "cosim/coupled.h"
#include "cosim/scheme.h"

#include <assert.h>

static bough_status create(bough_coupling *c, bough_arena *arena) {
    bough_member *whole = c->whole = bough_arena_take(arena, sizeof *whole);
    bough_system system = bough_coupled_system(arena, c->assembly, c->pool, "monolithic system");
    return bough_member_create(arena, &system, c->t0, &c->options.integrator, whole);
}

// The members' states are set for queries; only the integrator of the whole system runs.
static bough_status step(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_member *whole = c->whole;
    if (!whole->started) {
        bough_assembly_states(a, whole->state);
        bough_member_set(whole, c->t0, whole->state);
    }
    assert(whole->time == c->t0);
    bough_status status = bough_member_advance(whole, c->t1, NULL, c->restart);
    if (!bough_is_ok(&status)) return status;
    const bough_coupled *factors = whole->factors;
    c->interface = factors->own;
    c->interface_gamma = factors->gamma;
    for (int i = 0; i < a->n_member; i++) {
        bough_member_set(a->member[i], c->t1, whole->state + a->state_offset[i]);
    }
    bough_assembly_states(a, whole->state);
    bough_coupling_begin(c);
    return bough_ok();
}

static void snapshot(bough_coupling *c, bough_snapshot *s) { bough_member_snapshot(c->whole, s); }

const bough_scheme bough_scheme_monolithic = {
    .name = "monolithic",
    .summary = "all bodies in one system, coupled at the stages of the master's method: no coupling "
               "error",
    .one_system = true,
    .create = create,
    .step = step,
    .snapshot = snapshot,
};

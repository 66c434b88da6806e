#include "cosim/interface_newton.h"

#include "cosim/coupled.h"

#include <math.h>
#include <string.h>

enum { MOST_AGE = 12 }; // steps: as the ramp keeps its tangents

struct bough_interface_newton {
    int n_span;
    bough_coupled **coupled; // (n_span)
    double *state;           // (n_state) where
    double length;           // of the macro step they were made for [s]; 0: none
    int age;                 // steps since
};

bough_interface_newton *bough_interface_newton_create(bough_arena *arena, const bough_coupling *c,
                                                      int n_span) {
    bough_interface_newton *n = bough_arena_take(arena, sizeof *n);
    n->n_span = n_span;
    n->coupled = bough_arena_take(arena, (size_t)n_span * sizeof *n->coupled);
    n->state = bough_arena_doubles(arena, (size_t)c->assembly->n_state);
    for (int k = 0; k < n_span; k++) {
        n->coupled[k] = bough_coupled_create(arena, c->assembly, c->pool);
    }
    return n;
}

bough_status bough_interface_newton_update(bough_interface_newton *n, bough_coupling *c, const double *span) {
    double length = c->t1 - c->t0;
    bool same = !c->restart && fabs(length - n->length) <= 1e-9 * length;
    n->age++;
    if (same && n->age <= MOST_AGE) return bough_ok();
    n->length = length;
    n->age = 0;
    const bough_assembly *a = c->assembly;
    bough_assembly_states(a, n->state);
    bough_status status = bough_ok();
    for (int k = 0; k < n->n_span && bough_is_ok(&status); k++) {
        status = bough_coupled_setup(n->coupled[k], c->t0, n->state, c->input, span[k] * length);
    }
    return status;
}

void bough_interface_newton_forget(bough_interface_newton *n) { n->length = 0; }

void bough_interface_newton_solve(const bough_interface_newton *n, int span, double *change) {
    bough_coupled_close(n->coupled[span], change);
}

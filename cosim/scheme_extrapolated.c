// Extrapolated coupling: the levels advance one after the other. Inputs whose source has advanced follow it,
// forces of members that advance later are extrapolated by a polynomial of degree 0, 1 or 2 through the last
// synchronisation points, theory (58), fewer at the start; order degree + 1. Stable only below some macro
// step. Degree 0 has a name of its own: Gauss–Seidel, under held forces, a delay of 1/2 H, theory (59).
#include "cosim/scheme.h"

// Sets the signals of a level. True when one of them jumps from step to step.
static bool set_signals(bough_coupling *c, int level, int degree) {
    const bough_assembly *a = c->assembly;
    bool jumps = false;
    for (int j = 0; j < a->n_input; j++) {
        if (a->level[a->receiver[j]] != level) continue;
        if (a->level[a->source_member[j]] < level) {
            bough_coupling_interpolate(c, j);
        } else {
            bough_coupling_extrapolate(c, j, degree);
            jumps = true;
        }
    }
    return jumps;
}

static bough_status step_by(bough_coupling *c, int degree) {
    int n = c->assembly->n_level;
    bough_status status = bough_ok();
    bough_coupling_begin(c);
    for (int level = 0; level < n && bough_is_ok(&status); level++) {
        bool restart = set_signals(c, level, degree) || c->restart;
        // the last level has no followers within the step
        status = level < n - 1 ? bough_coupling_advance_leaders(c, level, restart)
                               : bough_coupling_advance(c, level, restart);
    }
    return status;
}

static bough_status step_held(bough_coupling *c) { return step_by(c, 0); }

static bough_status step(bough_coupling *c) { return step_by(c, c->options.order); }

static int defect_order(const bough_scheme_options *options) { return options->order + 1; }

const bough_scheme bough_scheme_gauss_seidel = {
    .name = "gauss-seidel",
    .summary = "first the master with constant forces, then the bodies with its new motion; order "
               "1, explicit",
    .explicit_forces = true,
    .foreign = true,
    .judged = true,
    .step = step_held,
};

const bough_scheme bough_scheme_extrapolated = {
    .name = "extrapolated",
    .summary = "forces extrapolated by a polynomial; order 1 to 3 (degree + 1), explicit",
    .reads = BOUGH_READS_ORDER,
    .explicit_forces = true,
    .foreign = true,
    .judged = true,
    .step = step,
    .defect_order = defect_order,
};

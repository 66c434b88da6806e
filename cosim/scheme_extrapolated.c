// Extrapolated coupling: like Gauss–Seidel, with forces extrapolated by a polynomial of degree 0, 1
// or 2 through the last synchronisation values (fewer at the start); order degree + 1. The parallel
// variant extrapolates every input. Stable only below some macro step. Degree 0 has a name of its own:
// Gauss–Seidel, under held forces, a delay of 1/2 H.
#include "cosim/scheme.h"
#include "cosim/sequence.h"

static bough_status create_held(bough_coupling *c, bough_arena *arena) {
    (void)arena;
    c->options.order = 0;
    c->options.parallel = false;
    return bough_ok();
}

static bough_status step_parallel(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_coupling_begin(c);
    for (int i = 0; i < a->n_member; i++) {
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            bough_sequence_extrapolate(c, i, j, c->options.order);
        }
    }
    return bough_coupling_advance(c, BOUGH_ALL_LEVELS, true);
}

static bough_status step(bough_coupling *c) {
    if (c->options.parallel) return step_parallel(c);
    return bough_sequence_step(c, c->options.order);
}

static int defect_order(const bough_scheme_options *options) { return options->order + 1; }

const bough_scheme bough_scheme_gauss_seidel = {
    .name = "gauss-seidel",
    .summary = "first the master with constant forces, then the bodies with its new motion; order "
               "1, explicit",
    .explicit_forces = true,
    .judged = true,
    .create = create_held,
    .step = step,
};

const bough_scheme bough_scheme_extrapolated = {
    .name = "extrapolated",
    .summary = "forces extrapolated by a polynomial; order 1 to 3 (degree + 1), explicit",
    .reads = BOUGH_READS_ORDER,
    .explicit_forces = true,
    .judged = true,
    .step = step,
    .defect_order = defect_order,
};

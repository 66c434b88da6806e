// Coupling schemes of the tests alone: polynomials of one degree for all inputs, extrapolated before their
// source has advanced, interpolated through its new value and earlier ones after. An independent program that
// integrates the members exactly gives their stability limits and errors.
#include "cosim/scheme.h"

static bool before(int level, int other, bool reversed) { return reversed ? level > other : level < other; }

// Input j through the new value of its source and `order` earlier ones.
static void interpolate(bough_coupling *c, int j) {
    const bough_history *past = &c->past;
    int degree = c->options.order < past->n ? c->options.order : past->n, member = c->assembly->receiver[j];
    double time[BOUGH_HISTORY + 1] = {c->t1};
    double value[BOUGH_HISTORY + 1] = {c->advanced.value[c->assembly->source[j]]};
    for (int p = 0; p < degree; p++) {
        time[p + 1] = past->time[p];
        value[p + 1] = past->input[p][j];
    }
    bough_signal_polynomial(&c->signal[member], j - c->assembly->input_offset[member], degree + 1, time,
                            value);
}

static bough_status step_by(bough_coupling *c, bool reversed) {
    const bough_assembly *a = c->assembly;
    bough_status status = bough_ok();
    bough_coupling_begin(c);
    for (int k = 0; k < a->n_level && bough_is_ok(&status); k++) {
        int level = reversed ? a->n_level - 1 - k : k;
        for (int j = 0; j < a->n_input; j++) {
            if (a->level[a->receiver[j]] != level) continue;
            if (before(a->level[a->source_member[j]], level, reversed)) {
                interpolate(c, j);
            } else {
                bough_coupling_extrapolate(c, j, c->options.order);
            }
        }
        status = bough_coupling_advance_leaders(c, level, true);
    }
    return status;
}

static bough_status step(bough_coupling *c) { return step_by(c, false); }

static bough_status step_reversed(bough_coupling *c) { return step_by(c, true); }

static bough_status step_at_once(bough_coupling *c) {
    bough_coupling_begin(c);
    for (int j = 0; j < c->assembly->n_input; j++) bough_coupling_extrapolate(c, j, c->options.order);
    return bough_coupling_advance(c, BOUGH_ALL_LEVELS, true);
}

#define ENTRY(title, work)                                                                                   \
    {                                                                                                        \
        .name = title, .summary = "polynomials", .reads = BOUGH_READS_ORDER, .explicit_forces = true,        \
        .judged = true, .step = work                                                                         \
    }
const bough_scheme bough_scheme_polynomial = ENTRY("polynomial", step);
const bough_scheme bough_scheme_polynomial_reversed = ENTRY("polynomial-reversed", step_reversed);
const bough_scheme bough_scheme_polynomial_at_once = ENTRY("polynomial-at-once", step_at_once);

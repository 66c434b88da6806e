// Frozen coupling (Jacobi): all members advance at once under what they knew at T_k; forces are
// constant, motions continue with a constant rate. Order 1. Stable only below a macro step that the
// damping sets: a constant force is a delay of 3/2 H, theory (59).
#include "cosim/scheme.h"

// Rates of the outputs at T_k of a member whose motion others get.
static void find_rates(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    bool wanted = false;
    for (int j = 0; j < a->n_input; j++) {
        wanted = wanted || (a->kinematic[j] && a->source_member[j] == member);
    }
    if (!wanted) return;
    bough_coupling_output_rate(c, member, c->t0, c->input + a->input_offset[member], NULL,
                               c->advanced.start_rate + a->output_offset[member]);
}

static void hold(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    bough_signal *s = &c->signal[member];
    for (int j = 0; j < s->n; j++) {
        int input = a->input_offset[member] + j;
        if (a->kinematic[input]) {
            bough_signal_hold_rate(s, j, c->input[input], c->advanced.start_rate[a->source[input]]);
        } else {
            bough_signal_hold(s, j, c->input[input]);
        }
    }
}

// A constant value jumps at every synchronisation point, a motion only changes its rate there: a member whose
// inputs are motions keeps its integrator's history.
static bool sees_jumps(const bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    for (int j = a->input_offset[member]; j < a->input_offset[member + 1]; j++) {
        if (!a->kinematic[j]) return true;
    }
    return false;
}

static void advance(bough_coupling *c, int member) {
    bough_coupling_advance_to(c, member, c->t1, c->restart || sees_jumps(c, member));
}

static bough_status step(bough_coupling *c) {
    bough_coupling_begin(c);
    // signals from the values and rates at T_k
    BOUGH_TRY(bough_coupling_each(c, BOUGH_ALL_LEVELS, find_rates));
    for (int i = 0; i < c->assembly->n_member; i++) hold(c, i);
    // all members at once
    return bough_coupling_each(c, BOUGH_ALL_LEVELS, advance);
}

const bough_scheme bough_scheme_frozen = {
    .name = "frozen",
    .summary = "all bodies advance at once with constant exchanged values; order 1, explicit",
    .explicit_forces = true,
    .judged = true,
    .step = step,
};

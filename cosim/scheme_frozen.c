// Frozen coupling (Jacobi): all members advance at once under what they knew at T_k; forces are
// held, motions continue with their rate held. Order 1. Stable only below a macro step that the
// damping sets: a frozen force is a delay of 3/2 H.
#include "cosim/scheme.h"
#include "cosim/signal.h"

// Rates of the outputs at T_k, where a motion of the member is held by its rate.
static void find_rates(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    bool wanted = false;
    for (int j = 0; j < a->n_input; j++) {
        wanted = wanted || (a->kinematic[j] && a->source_member[j] == member);
    }
    if (!wanted) return;
    if (!bough_coupling_output_rate(c, member, c->t0, c->input + a->input_offset[member], NULL,
                                    c->start_rate + a->output_offset[member])) {
        c->status[member] = bough_coupling_not_finite(c, member);
    }
}

static void hold(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    bough_signal *s = &c->signal[member];
    for (int j = 0; j < s->n; j++) {
        int input = a->input_offset[member] + j;
        if (a->kinematic[input]) {
            bough_signal_hold_rate(s, j, 1, c->input + input, c->start_rate + a->source[input]);
        } else {
            bough_signal_hold(s, j, 1, c->input + input);
        }
    }
}

// A held value jumps at every synchronisation point; a motion held by its rate only bends there, so
// a member that sees nothing else keeps its integrator's history.
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
    bough_status status = bough_coupling_each(c, BOUGH_ALL_LEVELS, find_rates);
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < c->assembly->n_member; i++) hold(c, i);
    return bough_coupling_each(c, BOUGH_ALL_LEVELS, advance);
}

const bough_scheme bough_scheme_frozen = {
    .name = "frozen",
    .summary = "all bodies advance at once with constant exchanged values; order 1, explicit",
    .explicit_forces = true,
    .judged = true,
    .step = step,
};

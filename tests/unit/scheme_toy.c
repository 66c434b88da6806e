// A coupling scheme of a user's own, as test_scheme_table adds it: this file and one line of the
// table. All members advance at once; every input is held at the value of its middle of the step,
// extrapolated from the last two: order 2, as a held value at the start is of order 1.
#include "cosim/scheme.h"

static void hold(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const bough_history *past = &c->past;
    for (int j = a->input_offset[member], local = 0; j < a->input_offset[member + 1]; j++, local++) {
        double slope = 0;
        if (past->n > 1) {
            slope = (past->input[0][j] - past->input[1][j]) / (past->time[0] - past->time[1]);
        }
        double middle = past->input[0][j] + 0.5 * (c->t1 - c->t0) * slope;
        bough_signal_hold(&c->signal[member], local, middle);
    }
}

static bough_status step(bough_coupling *c) {
    bough_coupling_begin(c);
    for (int i = 0; i < c->assembly->n_member; i++) hold(c, i);
    return bough_coupling_advance(c, BOUGH_ALL_LEVELS, true);
}

const bough_scheme bough_scheme_toy = {
    .name = "toy",
    .summary = "inputs held at the extrapolated middle of the step; order 2, explicit",
    .explicit_forces = true,
    .judged = true,
    .step = step,
};

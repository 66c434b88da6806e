#include "cosim/sequence.h"

#include "cosim/signal.h"

#include <assert.h>

void bough_sequence_extrapolate(bough_coupling *c, int member, int j, int degree) {
    assert(degree >= 0 && degree < BOUGH_HISTORY);
    int n_point = degree < c->n_past ? degree + 1 : c->n_past;
    const double *value[BOUGH_HISTORY];
    for (int p = 0; p < n_point; p++) value[p] = c->past[p] + j;
    bough_signal_polynomial(&c->signal[member], j - c->assembly->input_offset[member], 1, n_point,
                            c->past_time, value);
}

bool bough_sequence_before(const bough_coupling *c, int level, int other) {
    return c->options.reversed ? level > other : level < other;
}

// True when an input of the level's members jumps from step to step.
static bool prepare(bough_coupling *c, int level, int degree) {
    const bough_assembly *a = c->assembly;
    bool jumps = c->options.interpolation == BOUGH_POLYNOMIAL;
    for (int i = 0; i < a->n_member; i++) {
        if (a->level[i] != level) continue;
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            if (bough_sequence_before(c, a->level[a->source_member[j]], level)) {
                bough_coupling_interpolate(c, i, j);
            } else {
                bough_sequence_extrapolate(c, i, j, degree);
                jumps = true;
            }
        }
    }
    return jumps;
}

bough_status bough_sequence_step(bough_coupling *c, int degree) {
    int n = c->assembly->n_level;
    bough_status status = bough_ok();
    bough_coupling_begin(c);
    for (int k = 0; k < n && bough_is_ok(&status); k++) {
        int level = c->options.reversed ? n - 1 - k : k;
        bool restart = prepare(c, level, degree) || c->restart;
        status = k < n - 1 ? bough_coupling_advance_leaders(c, level, restart)
                           : bough_coupling_advance(c, level, restart);
    }
    return status;
}

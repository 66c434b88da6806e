// Gauss–Seidel: stage 0 advances under held forces, the later stages then see its new motion
// interpolated. Order 1. Stable only below a macro step that the damping sets: a delay of 1/2 H.
#include "cosim/scheme.h"
#include "cosim/sequence.h"

static bough_status step(bough_coupling *c) {
    return bough_sequence_step(c, 0);
}

const bough_scheme bough_scheme_gauss_seidel = {
    .name = "gauss-seidel",
    .summary = "the trunk first under held forces, bodies follow its motion; order 1, explicit",
    .explicit_forces = true,
    .judged = true,
    .step = step,
};

// The linear member of a member: its system's linearisation about the current state, so that a coupling
// scheme can be run on small perturbations and its macro step becomes a linear map.
//     ẏ = J y + B u,   o = C y + D u
// Its own steps are those of the two-stage SDIRK method with γ = 1 − 1/√2, which keeps the
// oscillations (their amplitude falls by 0.004 (ωh)⁴ per step h) and damps everything stiff at
// once; the trapezoidal rule would keep all stiff modes alive and hide the interesting ones.
#ifndef BOUGH_COSIM_ANALYSIS_LINEAR_MEMBER_H
#define BOUGH_COSIM_ANALYSIS_LINEAR_MEMBER_H

#include "cosim/member.h"

// Builds the linear member in the arena: at the member's current time and state and the input given
// (n_input), copied. The perturbation starts at 0. `sub_step` is the longest step [s]. The linear
// member must stay where it is.
void bough_linear_member_create(bough_arena *arena, const bough_member *real, const double *input,
                                double sub_step, bough_member *linear);

#endif

// Stability analysis of a coupling before the run: the fastest growing oscillation of the linearised macro
// step, theory (69). The scheme itself runs on linear members, so one macro step is a linear map of
// the perturbations: states, and the earlier inputs that the scheme stores. The largest eigenvalues come
// from Arnoldi's method (modified Gram–Schmidt, twice), applied to so many macro steps that the stiff
// modes decay and the slow modes change their phase visibly.
//
// The analysis leaves out loads from outside the members, such as aerodynamic damping (so it is
// conservative), changes of the state during the run, and growth without oscillation, which belongs to the
// mechanics: a free rotation, an inverted pendulum.
#pragma once

#include "cosim/assembly.h"
#include "cosim/coupling.h"

typedef struct bough_stability {
    double growth;    // of the fastest growing oscillation [1/s]; negative: it decays
    double suspected; // the same, including uncertain eigenvalues; at least `growth` [1/s]
    double rising; // growth of motions that grow faster than they oscillate, by coupling or mechanics [1/s]
    double frequency; // of the fastest growing oscillation [Hz]
    int body;         // the member on an interface with the largest part in it
} bough_stability;

// Analyses a scheme at a macro step about the members' current states. Allocates and releases its own
// memory. BOUGH_INVALID for a scheme of one system, which has no coupling.
bough_status bough_stability_judge(const bough_assembly *a, const bough_scheme_options *options,
                                   double macro_step, bough_stability *result);

// The same with linear members that step by at most `sub_step` [s]; they damp faster motions.
bough_status bough_stability_judge_by(const bough_assembly *a, const bough_scheme_options *options,
                                      double macro_step, double sub_step, bough_stability *result);

// Whether it grows by more than rounding and drift.
bool bough_stability_grows(const bough_stability *s);

typedef struct bough_stability_advice {
    bough_stability now; // at the given macro step
    bool unstable;       // it grows, and grows less with a smaller macro step or another scheme
    double macro_step;   // the largest fraction of the macro step that is stable [s]; 0: none of those tried
    const char *scheme;  // another scheme that is stable at this macro step; NULL: none of those tried
} bough_stability_advice;

// Analyses a scheme and, if it is unstable, searches a stable macro step and scheme.
bough_status bough_stability_advise(const bough_assembly *a, const bough_scheme_options *options,
                                    double macro_step, bough_stability_advice *advice);

enum { BOUGH_VERDICT = 320 };

// One sentence: text (BOUGH_VERDICT), empty where it is stable.
void bough_stability_describe(const bough_assembly *a, const bough_stability_advice *advice,
                              const bough_scheme_options *options, double macro_step, char *text);

// The linear member of a member: its system's linearisation about the current state, on which a coupling
// scheme can be run with small perturbations,
//     ẏ = J y + B u,   o = C y + D u.
// Builds it in the arena at the member's current time and state and the input given (n_input), copied. The
// perturbation starts at 0. `sub_step` is the longest step of its own [s]. The linear member must stay where
// it is.
void bough_linear_member_create(bough_arena *arena, const bough_member *real, const double *input,
                                double sub_step, bough_member *linear);

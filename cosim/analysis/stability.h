// Stability analysis of a coupling before the run: the fastest growing oscillation of the linearised macro
// step. The scheme itself runs on linear members (linear_member.h), so one macro step is a linear map of
// the perturbations: states, and the earlier inputs that the scheme stores. The largest eigenvalues come
// from Arnoldi's method (modified Gram–Schmidt, twice), applied to so many macro steps that the stiff
// modes decay and the slow modes change their phase visibly.
//
// The analysis does not contain loads from outside the members, such as aerodynamic damping (it is
// conservative), changes of the state during the run, and growth without oscillation, which belongs to
// the mechanics: a free rotation, an inverted pendulum.
#ifndef BOUGH_COSIM_ANALYSIS_STABILITY_H
#define BOUGH_COSIM_ANALYSIS_STABILITY_H

#include "cosim/assembly.h"
#include "cosim/coupling.h"

typedef struct bough_stability {
    double growth;    // of the fastest growing oscillation [1/s]; negative: it decays
    double suspected; // the same, including uncertain eigenvalues; at least `growth` [1/s]
    double rising;    // growth of what grows faster than it oscillates, of coupling or mechanics [1/s]
    double frequency; // of the fastest growing oscillation [Hz]
    int body;         // the member on an interface with the largest share in it
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

// One sentence: text (BOUGH_VERDICT), empty when there is nothing to warn of.
void bough_stability_describe(const bough_assembly *a, const bough_stability_advice *advice,
                              const bough_scheme_options *options, double macro_step, char *text);

#endif

// Verdict on a coupling before it is run: the fastest growing oscillation of the linearised macro
// step. The scheme itself is run on linear members in place of the members (linear_member.h), so
// that one macro step is a linear map of the perturbations: states, and what the scheme remembers
// of earlier inputs. The largest eigenvalues come from Arnoldi's method (modified Gram–Schmidt,
// twice), applied to as many macro steps as it takes for the stiff modes to die out and the slow
// ones to turn visibly.
//
// What it does not see: loads from outside the members, so no aerodynamic damping (it errs on the
// safe side), changes of the state along the run, and growth without oscillation, which is left to
// the mechanics: a free rotation, an inverted pendulum.
#ifndef BOUGH_COSIM_STABILITY_H
#define BOUGH_COSIM_STABILITY_H

#include "cosim/assembly.h"
#include "cosim/coupling.h"

typedef struct bough_stability {
    double growth;    // of the fastest growing oscillation [1/s]; negative: it decays
    double suspected; // the same, including values that are not certain; at least `growth` [1/s]
    double rising;    // of what grows faster than it turns; the mechanics' own or not [1/s]
    double frequency; // of it [Hz]
    int body;         // the member on an interface that takes most part in it
} bough_stability;

// Judges a scheme at a macro step about the members' current states. Takes memory of its own and
// releases it.
// BOUGH_INVALID for a scheme of one system, which has no coupling to judge.
bough_status bough_stability_judge(const bough_assembly *a, const bough_scheme_options *options,
                                   double macro_step, bough_stability *result);

// The same with linear members that step by at most `sub_step` [s]: what they do not resolve, they
// damp.
bough_status bough_stability_judge_by(const bough_assembly *a, const bough_scheme_options *options,
                                      double macro_step, double sub_step, bough_stability *result);

// Whether it grows by more than rounding and drift.
bool bough_stability_grows(const bough_stability *s);

typedef struct bough_stability_advice {
    bough_stability now; // at the macro step asked about
    bool unstable;       // it grows, and less so with a smaller macro step or another scheme
    double macro_step;   // the largest fraction of it that holds [s]; 0: none of those tried
    bool instead_holds;  // the scheme to try instead holds at the macro step asked about
} bough_stability_advice;

// Judges, and when it grows looks for what would hold.
bough_status bough_stability_advise(const bough_assembly *a, const bough_scheme_options *options,
                                    double macro_step, bough_stability_advice *advice);

enum { BOUGH_VERDICT = 320 };

// One sentence: text (BOUGH_VERDICT), empty when there is nothing to warn of.
void bough_stability_describe(const bough_assembly *a, const bough_stability_advice *advice,
                              const bough_scheme_options *options, double macro_step, char *text);

#endif

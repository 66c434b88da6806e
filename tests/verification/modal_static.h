// Equilibrium and natural frequencies of a modal body whose root is held, at rest or in steady
// rotation: what rod_static.h and rod_modes.h are for a rod.
#pragma once

#include "flexbody/modal/modal_system.h"

// Brings `state` (n_state), from where it is, to rest in a frame of constant twist and gravity,
// `input` (9), under its loads at time t, by Newton's method with steps shortened so that no shape
// rotates a vertex by more than half a radian. BOUGH_FAILED when it does not converge.
bough_status bough_modal_steady(bough_modal_body *body, double t, const double *input, bough_arena *arena,
                                double *state);

// Natural frequencies |λ|/2π [Hz] of the body about that state, of pairs with Im λ > 0 and
// ascending, into frequency (wanted); *found may be less. BOUGH_FAILED when the eigenvalues cannot
// be found.
bough_status bough_modal_frequencies(bough_arena *arena, bough_modal_body *body, double t,
                                     const double *input, const double *state, int wanted, double *frequency,
                                     int *found);

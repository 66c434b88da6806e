// The interface's Jacobian for Newton's method: how inputs answer to their own change over a part
// of a macro step. Every member answers by one linearly implicit step, (I − γJ) δy = γ B δu, as in
// the ramp's prediction; γ is the time over which a unit change at the part's end acts, ∫ w dt.
#ifndef BOUGH_COSIM_INTERFACE_NEWTON_H
#define BOUGH_COSIM_INTERFACE_NEWTON_H

#include "cosim/coupling.h"

typedef struct bough_interface_newton bough_interface_newton;

// `n_span` Jacobians, of spans (γ over the macro step) given to bough_interface_newton_update.
bough_interface_newton *bough_interface_newton_create(bough_arena *arena, const bough_coupling *c,
                                                      int n_span);

// Makes the Jacobians for a step: anew when the macro step changes, loads jump, and every few steps.
// Members must be at t0.
bough_status bough_interface_newton_update(bough_interface_newton *n, bough_coupling *c, const double *span);

// The next update makes them anew.
void bough_interface_newton_forget(bough_interface_newton *n);

// What closes the interface over a change (n_input) of the leaders' inputs, in place: (I − ∂u/∂u)⁻¹
// by the Jacobian of that span.
void bough_interface_newton_solve(const bough_interface_newton *n, int span, double *change);

#endif

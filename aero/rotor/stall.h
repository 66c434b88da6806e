// Dynamic stall: lift follows a change of the angle of attack with delay, by the shed wake and by
// the flow's separation. The Beddoes–Leishman model in the state form of Hansen, Gaunaa and Madsen,
// whose parameters follow from the static polar, its indicial lift and two defaults.
//
// M. H. Hansen, M. Gaunaa, H. A. Madsen, "A Beddoes–Leishman type dynamic stall model in
// state-space and indicial formulations", Risø-R-1354 (2004). The centre of pressure stays the
// static one's. Beyond 40° from the flow the static polar takes over, wholly from 50°.
#ifndef BOUGH_AERO_ROTOR_STALL_H
#define BOUGH_AERO_ROTOR_STALL_H

#include "aero/rotor/polar.h"

typedef enum bough_stall_kind {
    BOUGH_STALL_NONE, // the static polar at once
    BOUGH_STALL_HGM,
} bough_stall_kind;

// Trailing-edge separation point in [0, 1], 1 attached, and the lift of fully separated flow, of
// which the static lift is made: Cl = f·slope·(α − α₀) + (1 − f)·separated. A polar of slope 0
// has no lift and is always static.
void bough_stall_split(const bough_polar *polar, double alpha, double *f, double *separated);

// The flow at a section.
typedef struct bough_stall_inflow {
    double speed; // relative [m/s]
    double alpha; // angle of attack at the aerodynamic centre [rad]
    double rate;  // nose-up rotation of the section [rad/s]
} bough_stall_inflow;

// Of one section; doubles only, so that it is saved and restored as a row of them.
typedef struct bough_stall_state {
    double started; // 0: the next advance starts in equilibrium
    double speed;   // at the last advance [m/s]
    double alpha;   // at three quarters of the chord there [rad]
    double wake[2]; // downwash that the shed wake still withholds, as U·x₁, U·x₂ [m rad/s]
    double pressure_sought, pressure;     // angle of the pressure's lag: input and state [rad]
    double separation_sought, separation; // f of the lagged angle: input and state [-]
} bough_stall_state;

// Derivatives of the coefficients by the angle of attack [1/rad] and by the section's rotation [s/rad] after
// an advance, with the separation constant: it follows later.
typedef struct bough_stall_slopes {
    bough_coefficients angle, rate;
    double fixed; // of the static lift by the angle
} bough_stall_slopes;

// Advances by `step` [s], during which U α changes linearly: exact for the wake and the pressure, for the
// separation with a linear input. Returns the coefficients at the end; in equilibrium those of the static
// polar. `chord` [m]; `slopes` may be NULL.
bough_coefficients bough_stall_advance(const bough_polar *polar, double chord, bough_stall_inflow inflow,
                                       double step, bough_stall_state *state, bough_stall_slopes *slopes);

#endif

// Dynamic stall: lift follows a change of the angle of attack with delay, by the shed wake and by
// the flow's separation. The Beddoes–Leishman model in the state form of Hansen, Gaunaa and Madsen,
// whose parameters follow from the static polar, its indicial lift and two defaults.
//
// M. H. Hansen, M. Gaunaa, H. A. Madsen, "A Beddoes–Leishman type dynamic stall model in
// state-space and indicial formulations", Risø-R-1354 (2004). The centre of pressure stays the
// static one's. Beyond 40° from the flow the static polar takes over, wholly from 50°.
#pragma once

#include "aero/rotor/polar.h"
#include "core/base/level.h"

typedef enum bough_stall_kind {
    BOUGH_STALL_NONE, // the static polar at once
    BOUGH_STALL_HGM,
} bough_stall_kind;

// Of one section; doubles only, so that it is saved and restored as a row of them.
typedef struct bough_stall_state {
    double started; // 0: the next advance starts in equilibrium
    double speed;   // at the last advance [m/s]
    double alpha;   // at three quarters of the chord there [rad]
    double wake[2]; // downwash that the shed wake still withholds, as U·x₁, U·x₂ [m rad/s]
    double pressure_sought, pressure;     // angle of the pressure's lag: input and state [rad]
    double separation_sought, separation; // f of the lagged angle: input and state [-]
} bough_stall_state;

// Sections side by side.
typedef struct bough_stall_sections {
    int n;
    const bough_polar *const *polar; // (n); of slope 0: no lift, always static
    const double *chord;             // (n) [m]
    const double *speed;             // (n) relative [m/s]
    const double *alpha;             // (n) angle of attack at the aerodynamic centre [rad]
    const double *rate;              // (n) nose-up rotation of the section [rad/s]
    bough_stall_state *state;        // (n)
} bough_stall_sections;

typedef struct bough_stall_rows {
    double *lift, *drag, *moment; // (n padded to whole vectors)
} bough_stall_rows;

// After an advance, all (n padded to whole vectors).
typedef struct bough_stall_results {
    bough_stall_rows coefficients;
    bool with_slopes; // else the rows below are not written
    // derivatives by the angle of attack [1/rad] and by the section's rotation [s/rad], with the separation
    // constant: it follows later
    bough_stall_rows by_angle, by_rate;
    double *static_slope; // of the static lift [1/rad]
} bough_stall_results;

// Advances the states by `step` [s], during which U α changes linearly: exact for the wake and the pressure,
// for the separation with a linear input. Finds the coefficients at the end; in equilibrium they are those of
// the static polar.
void bough_stall_advance(const bough_stall_sections *sections, double step,
                         const bough_stall_results *results);
BOUGH_DECLARE_LEVELS(bough_stall_advance);

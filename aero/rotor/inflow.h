// Dynamic inflow: the induction follows a change of the rotor's loading with delay, because the
// wake has to be convected away first. Øye's two first-order filters in series,
//     w + τ₁ w' = q + k τ₁ q',   v + τ₂ v' = w,
// from the induced velocity q of the momentum balance to the induced velocity v, with k = 0.6. With q
// linear between samples this is AeroDyn's discrete dynamic BEM: with τ₁ given its mode 1, else 2.
//
// S. Øye, in: H. Snel, J. G. Schepers (eds.), Joint investigation of dynamic inflow effects and
// implementation of an engineering method, ECN-C--94-107 (1995).
#ifndef BOUGH_AERO_ROTOR_INFLOW_H
#define BOUGH_AERO_ROTOR_INFLOW_H

#include "aero/rotor/induction.h"

typedef enum bough_inflow_kind {
    BOUGH_INFLOW_EQUILIBRIUM, // no delay
    BOUGH_INFLOW_OYE,
} bough_inflow_kind;

typedef struct bough_inflow_def {
    bough_inflow_kind kind;
    double time; // τ₁ [s]; 0: from the rotor's induction, its radius and the wind
} bough_inflow_def;

// Of one station; normal and tangential components.
typedef struct bough_inflow_state {
    double sought[2];  // q at the last advance [m/s]
    double slow[2];    // w − k q [m/s]
    double reached[2]; // v [m/s]
} bough_inflow_state;

// τ₁ [s] of a rotor of that radius [m] with the mean induction `axial` in a wind [m/s].
double bough_inflow_time(const bough_inflow_def *def, double axial, double radius, double wind);

// Equilibrium with q [m/s].
void bough_inflow_start(bough_inflow_state *state, const double sought[2]);

// Advances by `step` [s], during which q changes linearly to `sought`: the exact solution for any step.
// `fraction`: the station's radius divided by the rotor's, which gives τ₂ from τ₁.
void bough_inflow_advance(bough_inflow_state *state, const double sought[2], double step, double tau1,
                          double fraction);

// Common to all stations of a rotor.
typedef struct bough_inflow_clock {
    bool started; // there was a sample before
    double time;  // of the last sample [s]
    double tau;   // τ₁ at the last sample [s]
} bough_inflow_clock;

typedef struct bough_inflow_station {
    bough_inflow_state state;
    double fraction; // radius over the rotor's
} bough_inflow_station;

// Replaces the inductions of the momentum balance by the delayed ones, a `step` [s] after the last sample;
// the first sample is in equilibrium. `inflow`: normal and tangential [m/s].
void bough_inflow_follow(const bough_inflow_clock *clock, double step, const double inflow[2], double *axial,
                         double *tangential, bough_inflow_station *station);

#endif

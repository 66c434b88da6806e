// Blade element momentum at a station: the inflow angle at which blade forces and momentum
// agree, by Ning's single residual, whose root is always bracketed.
//
// The solver has no memory. A stalled polar may have several roots; a start from the last result would then
// make the next result depend on the past, and a repeated step would not repeat its loads. The solver
// starts at the balance of linear lift and takes the root of attached flow if there is one. Without
// attached flow it starts from zero induction. If neither start has a root close to it, it uses Ning's
// bracket.
//
// S. A. Ning, "A simple solution method for the blade element momentum equations with guaranteed
// convergence", Wind Energy 17 (2014).
#pragma once

#include "aero/rotor/polar.h"
#include "core/base/level.h"

// Thrust as a function of a where momentum theory is not valid.
typedef enum bough_high_thrust {
    // From a = 0.35/cos χ, at most 0.5, a parabola, smooth there, to CT = 2 at a = 1 and beyond; the
    // swirl fades with the part of the thrust by momentum theory. AeroDyn's newer (polar) formulation does
    // this.
    BOUGH_HIGH_THRUST_SMOOTH,
    // From a = 0.4 the parabola of M. L. Buhl, NREL/TP-500-36834 (2005); for a > 1 the propeller
    // brake state of momentum theory. AeroDyn's older formulation does this.
    BOUGH_HIGH_THRUST_BUHL,
} bough_high_thrust;

typedef struct bough_induction_options {
    bough_high_thrust high_thrust;
    bool tip_loss, hub_loss; // Prandtl
    bool tangential;         // a' at all
    bool axial_drag;         // drag in the axial induction
    bool tangential_drag;    // drag in the tangential induction
    // Momentum theory of a disk at an angle to the wind, smooth high thrust only: the mass flow is that
    // through a disk of the same radius across the resultant (H. Glauert, ARC R&M 1111, 1926),
    // CT = 4 F a sqrt((1 − a)² + tan²χ), and the parabola beyond ends at CT = 2 + 2.113 tan χ^1.527.
    // AeroDyn's SkewMomCorr.
    bool skewed_momentum;
} bough_induction_options;

// Everything on, smooth high thrust.
bough_induction_options bough_induction_options_default(void);

// Whether an element is at the very tip or root, where the loss leaves a = 1, a' = 0.
BOUGH_INLINE bool bough_induction_is_fixed(const bough_induction_options *options, double tip_factor,
                                           double hub_factor) {
    return (options->tip_loss && tip_factor < 1e-9) || (options->hub_loss && hub_factor < 1e-9);
}

// Stations in structures of arrays. x is normal to the swept surface (downwind), y tangential against the
// rotation.
typedef struct bough_elements {
    int n;                                 // a multiple of BOUGH_LANES
    const bough_polar *const *polar;       // (n), and so all that follow
    const double *solidity;                // B c/(2 π r) [-]
    const double *tip_factor, *hub_factor; // B (R − r)/(2 r), B (r − R_hub)/(2 R_hub) [-]
    const double *cone;                    // cos² of the blade's angle from the rotor plane [-]
    const double *twist;                   // of the chord from y [rad]
    const double *inflow_x, *inflow_y;     // relative to the blade, without induction [m/s]
    // The untwisted section is oblique to y: component of its normal along y, and 1 less the component of its
    // chord. 0 unless the blade leans out of the rotor plane and y from its chord.
    const double *skew_normal, *skew_chord;
    double skew; // χ, of the wind and the shaft, of the whole rotor, below 90 degrees [rad]
} bough_elements;

// The inductions, side by side in vector lanes: `axial` a in [−1, 1.5], `tangential` a' in [−1, 1], both 0
// where no balance exists, and `loss`, Prandtl's factor there (n each) [-]; finite for any finite elements.
// Returns how often it evaluated the residuals.
int bough_induction_solve(const bough_induction_options *options, const bough_elements *elements,
                          double *axial, double *tangential, double *loss);
BOUGH_DECLARE_LEVELS(bough_induction_solve);

// -- dynamic inflow -------------------------------------------------------------------------------

// Dynamic inflow: the induction follows a change of the rotor's loading with delay, because the
// wake has to be convected away first. Øye's two first-order filters in series,
//     w + τ₁ w' = q + k τ₁ q',   v + τ₂ v' = w,
// from the induced velocity q of the momentum balance to the induced velocity v, with k = 0.6. With q
// linear between samples this is AeroDyn's discrete dynamic BEM: with τ₁ given its mode 1, else 2.
//
// S. Øye, in: H. Snel, J. G. Schepers (eds.), Joint investigation of dynamic inflow effects and
// implementation of an engineering method, ECN-C--94-107 (1995).

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

// The solver of theory (79), compiled for several processors: induction_kernel.c.
#include "aero/rotor/induction.h"

#include "core/base/base.h"

bough_induction_options bough_induction_options_default(void) {
    return (bough_induction_options){BOUGH_HIGH_THRUST_SMOOTH, true, true, true, true, true, false};
}

// -- dynamic inflow -------------------------------------------------------------------------------

static const double k = 0.6;
// Slower wind than this would hold the wake for minutes, and in calm for ever [m/s].
static const double least_wind = 0.5;

double bough_inflow_time(const bough_inflow_def *def, double axial, double radius, double wind) {
    if (def->time > 0) return def->time;
    return 1.1 / (1 - 1.3 * bough_clamp(axial, 0, 0.5)) * radius / fmax(fabs(wind), least_wind);
}

void bough_inflow_start(bough_inflow_state *state, const double sought[2]) {
    for (int c = 0; c < 2; c++) {
        state->sought[c] = state->reached[c] = sought[c];
        state->slow[c] = (1 - k) * sought[c];
    }
}

// theory (85). With z = w − k q the filters are z + τ₁ z' = (1 − k) q and v + τ₂ v' = k q + z. For q = q₀ + s
// t
//     z = (1 − k)(q₀ + s (t − τ₁)) + C exp(−t/τ₁),
//     v = q₀ + s (t − (1 − k) τ₁ − τ₂) + C τ₁/(τ₁ − τ₂) exp(−t/τ₁) + D exp(−t/τ₂),
// C and D from the values at t = 0; τ₂ is between 0.13 and 0.39 τ₁.
void bough_inflow_advance(bough_inflow_state *state, const double sought[2], double step, double tau1,
                          double fraction) {
    if (step > 0) {
        double s = bough_clamp(fraction, 0, 1), tau2 = (0.39 - 0.26 * s * s) * tau1;
        double slow_left = exp(-step / tau1), fast_left = exp(-step / tau2);
        for (int c = 0; c < 2; c++) {
            double rate = (sought[c] - state->sought[c]) / step;
            double slow_lag = (1 - k) * tau1 * rate, lag = slow_lag + tau2 * rate;
            double start = state->slow[c] - (1 - k) * state->sought[c] + slow_lag; // C
            double forced = start * tau1 / (tau1 - tau2);
            double own = state->reached[c] - (state->sought[c] - lag) - forced; // D
            state->slow[c] = (1 - k) * sought[c] - slow_lag + start * slow_left;
            state->reached[c] = sought[c] - lag + forced * slow_left + own * fast_left;
        }
    }
    for (int c = 0; c < 2; c++) state->sought[c] = sought[c];
}

// In a slower inflow an induced velocity has no induction factor [m/s].
static const double slow = 1e-3;

void bough_inflow_follow(const bough_inflow_clock *clock, double step, const double inflow[2], double *axial,
                         double *tangential, bough_inflow_station *station) {
    const double sought[2] = {*axial * inflow[0], *tangential * inflow[1]};
    bough_inflow_state *state = &station->state;
    if (!clock->started) {
        bough_inflow_start(state, sought);
        return;
    }
    bough_inflow_advance(state, sought, step, clock->tau, station->fraction);
    *axial = fabs(inflow[0]) < slow ? 0 : bough_clamp(state->reached[0] / inflow[0], -1, 1.5);
    *tangential = fabs(inflow[1]) < slow ? 0 : bough_clamp(state->reached[1] / inflow[1], -1, 1);
}

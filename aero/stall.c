#include "aero/stall.h"

#include "core/base.h"

#include <math.h>

// Jones' approximation of the indicial lift of a flat plate: 1 − Σ A exp(−b s), s in semi-chords.
static const double wake_share[2] = {0.165, 0.335}, wake_rate[2] = {0.0455, 0.3};
// Lags of pressure and separation, in semi-chords.
static const double pressure_time = 1.7, separation_time = 3.0;
// The static polar alone from the second angle on, none of it up to the first [rad].
static const double fading = 40 * BOUGH_PI / 180, faded = 50 * BOUGH_PI / 180;
// Slower than this there is no wake to speak of [m/s].
static const double slow = 1e-3;

static const double turn = 2 * BOUGH_PI;

// -- the polar's parts ----------------------------------------------------------------------------

// Closer to zero lift than this the ratio of lifts is taken here [rad].
static const double near_zero = 1e-4;

static double lift_at(const bough_polar *polar, double alpha) {
    return bough_polar_at(polar, alpha).lift;
}

bough_stall_airfoil bough_stall_airfoil_of(const bough_polar *polar) {
    return (bough_stall_airfoil){polar, polar->slope, polar->zero_lift};
}

// With r = Cl/(slope·(α − α₀)) Kirchhoff's f = (2√r − 1)² leaves the separated lift
// slope·(α − α₀)(3√r − 1)/(4√r), which is all of it at f = 0 and half of it at f = 1.
void bough_stall_split(const bough_stall_airfoil *airfoil, double alpha, double *f,
                       double *separated) {
    double lift = lift_at(airfoil->polar, alpha), d = remainder(alpha - airfoil->zero_lift, turn);
    *f = 0;
    *separated = lift;
    if (fabs(d) > BOUGH_PI / 2) return;
    double linear = airfoil->slope * d, at = lift;
    if (fabs(d) < near_zero) {
        d = copysign(near_zero, d);
        at = lift_at(airfoil->polar, airfoil->zero_lift + d);
    }
    double q = sqrt(fmin(fmax(at / (airfoil->slope * d), 0), 1));
    if (q <= 0.5) return;
    *f = (2 * q - 1) * (2 * q - 1);
    *separated = linear * (3 * q - 1) / (4 * q);
}

// -- states ---------------------------------------------------------------------------------------

// x' = (u − x)/T over a step of h = Δt/T, in which u goes linearly from u0 to u1.
static double lagged(double x, double u0, double u1, double h) {
    if (!(h > 0)) return x;
    double mean = -expm1(-h) / h; // of exp(−t) over the step
    return u1 + (x - u0) * exp(-h) - (u1 - u0) * mean;
}

// Moves all angles by a number of turns, so that that of attack stays in [−π, π].
static void unwind(bough_stall_state *s) {
    double shift = turn * round(s->alpha / turn);
    s->alpha -= shift;
    s->pressure_sought -= shift;
    s->pressure -= shift;
    for (int i = 0; i < 2; i++)
        s->wake[i] -= wake_share[i] * shift * s->speed;
}

static double separation_at(const bough_stall_airfoil *airfoil, double alpha) {
    double f, separated;
    bough_stall_split(airfoil, alpha, &f, &separated);
    return f;
}

static void start(const bough_stall_airfoil *airfoil, double alpha, double speed,
                  bough_stall_state *s) {
    double f = separation_at(airfoil, alpha);
    *s = (bough_stall_state){.started = 1,
                             .speed = speed,
                             .alpha = alpha,
                             .wake = {wake_share[0] * speed * alpha, wake_share[1] * speed * alpha},
                             .pressure_sought = alpha,
                             .pressure = alpha,
                             .separation_sought = f,
                             .separation = f};
}

// The angle of attack that the wake leaves.
static double effective(const bough_stall_state *s) {
    double own = 1 - wake_share[0] - wake_share[1];
    return own * s->alpha + (s->wake[0] + s->wake[1]) / s->speed;
}

static void advance(const bough_stall_airfoil *airfoil, double semi_chords, double alpha,
                    double speed, double mass_angle, bough_stall_state *s) {
    double next = s->alpha + remainder(alpha - s->alpha, turn);
    double before = s->speed * s->alpha, after = speed * next;
    for (int i = 0; i < 2; i++) {
        s->wake[i] = lagged(s->wake[i], wake_share[i] * before, wake_share[i] * after,
                            wake_rate[i] * semi_chords);
    }
    s->speed = speed;
    s->alpha = next;
    double sought = effective(s) + mass_angle;
    s->pressure = lagged(s->pressure, s->pressure_sought, sought, semi_chords / pressure_time);
    s->pressure_sought = sought;
    double f = separation_at(airfoil, s->pressure);
    s->separation = lagged(s->separation, s->separation_sought, f, semi_chords / separation_time);
    s->separation_sought = f;
    unwind(s);
}

// -- coefficients ---------------------------------------------------------------------------------

// `late`: the angle of attack at three quarters of the chord, `turning` the rotation's part of it.
// The circulation's lift leans back by what the wake withholds and by the rotation once more.
static bough_coefficients dynamic(const bough_stall_airfoil *airfoil, const bough_stall_state *s,
                                  double late, double turning) {
    double angle = effective(s), f, separated, x = s->separation;
    bough_stall_split(airfoil, angle, &f, &separated);
    bough_coefficients k = bough_polar_at(airfoil->polar, angle);
    double linear = airfoil->slope * remainder(angle - airfoil->zero_lift, turn);
    double lift = x * linear + (1 - x) * separated, mass_lift = BOUGH_PI * turning;
    double least = bough_polar_at(airfoil->polar, airfoil->zero_lift).drag;
    double separating = (sqrt(f) - sqrt(fmax(x, 0))) / 2 - (f - x) / 4;
    double leaning = remainder(late - angle, turn) + turning;
    double drag = k.drag + leaning * lift + (k.drag - least) * separating;
    return (bough_coefficients){lift + mass_lift, drag, k.moment - mass_lift / 2};
}

static double mixed(double a, double b, double w) { return a + w * (b - a); }

bough_coefficients bough_stall_advance(const bough_stall_airfoil *airfoil, double chord,
                                       bough_stall_inflow inflow, double step,
                                       bough_stall_state *state) {
    double alpha = remainder(inflow.alpha, turn), speed = inflow.speed;
    bough_coefficients fixed = bough_polar_at(airfoil->polar, alpha);
    if (airfoil->slope == 0 || !(speed > slow)) {
        state->started = 0;
        return fixed;
    }
    // The rotation as the downwash at three quarters of the chord.
    double turning = bough_clamp(chord * inflow.rate / (2 * speed), -0.5, 0.5);
    double late = alpha + turning;
    if (state->started == 0) {
        start(airfoil, late, speed, state);
    } else if (step > 0) {
        double semi_chords = step * (state->speed + speed) / chord;
        advance(airfoil, semi_chords, late, speed, BOUGH_PI * turning / airfoil->slope, state);
    }
    double share = bough_clamp((faded - fabs(alpha)) / (faded - fading), 0, 1);
    if (share == 0) return fixed;
    bough_coefficients k = dynamic(airfoil, state, late, turning);
    return (bough_coefficients){mixed(fixed.lift, k.lift, share),
                                mixed(fixed.drag, k.drag, share),
                                mixed(fixed.moment, k.moment, share)};
}

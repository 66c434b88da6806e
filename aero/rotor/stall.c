// theory (88, 89, 90, 91)
#include "aero/rotor/stall.h"

#include "core/base/base.h"
#include "core/base/lanes.h"

#include <math.h>

// Lags of pressure and separation, in semi-chords.
static const double pressure_time = 1.7, separation_time = 3.0;
// The static polar alone from the second angle on, none of it up to the first [rad].
static const double fading = 40 * BOUGH_DEGREE, faded = 50 * BOUGH_DEGREE;
// Slower than this there is no wake [m/s].
static const double slow = 1e-3;

static const double circle = 2 * BOUGH_PI;

// -- attached and separated lift ----------------------------------------------------------------------------

// Closer to zero lift than this the ratio of lifts is taken here [rad].
static const double near_zero = 1e-4;

// With r = Cl/(slope·(α − α₀)) Kirchhoff's f = (2√r − 1)² leaves the separated lift
// slope·(α − α₀)(3√r − 1)/(4√r), which is all of it at f = 0 and half of it at f = 1.
static void split(const bough_polar *polar, double alpha, double lift, double *f, double *separated) {
    double d = lane_remainder(alpha - polar->zero_lift);
    *f = 0;
    *separated = lift;
    if (fabs(d) > BOUGH_PI / 2) return;
    double linear = polar->slope * d, at = lift;
    if (fabs(d) < near_zero) {
        d = copysign(near_zero, d);
        at = bough_polar_at(polar, polar->zero_lift + d).lift;
    }
    double q = sqrt(fmin(fmax(at / (polar->slope * d), 0), 1));
    if (q <= 0.5) return;
    *f = (2 * q - 1) * (2 * q - 1);
    *separated = linear * (3 * q - 1) / (4 * q);
}

void bough_stall_split(const bough_polar *polar, double alpha, double *f, double *separated) {
    split(polar, alpha, bough_polar_at(polar, alpha).lift, f, separated);
}

// -- states ---------------------------------------------------------------------------------------

// x' = (u − x)/T over a step of h = Δt/T, in which u goes linearly from u0 to u1.
static double lagged(double x, double u0, double u1, double h) {
    if (!(h > 0)) return x;
    double decayed = expm1(-h); // exp(−h) − 1
    return u1 + (x - u0) * (1 + decayed) + (u1 - u0) * decayed / h;
}

// Moves all angles by multiples of 2π, so that the angle of attack stays in [−π, π].
static void unwind(const bough_polar *polar, bough_stall_state *s) {
    double shift = circle * round(s->alpha / circle);
    s->alpha -= shift;
    s->pressure_sought -= shift;
    s->pressure -= shift;
    for (int i = 0; i < 2; i++) s->wake[i] -= polar->wake_weight[i] * shift * s->speed;
}

static double separation_at(const bough_polar *polar, double alpha) {
    double f, separated;
    bough_stall_split(polar, alpha, &f, &separated);
    return f;
}

static void start(const bough_polar *polar, double alpha, double speed, bough_stall_state *s) {
    double f = separation_at(polar, alpha);
    *s = (bough_stall_state){
        .started = 1,
        .speed = speed,
        .alpha = alpha,
        .wake = {polar->wake_weight[0] * speed * alpha, polar->wake_weight[1] * speed * alpha},
        .pressure_sought = alpha,
        .pressure = alpha,
        .separation_sought = f,
        .separation = f};
}

// α_E of theory (89).
static double effective(const bough_polar *polar, const bough_stall_state *s) {
    double own = 1 - polar->wake_weight[0] - polar->wake_weight[1];
    return own * s->alpha + (s->wake[0] + s->wake[1]) / s->speed;
}

static void advance(const bough_polar *polar, double semi_chords, double alpha, double speed,
                    double mass_angle, bough_stall_state *s) {
    double next = s->alpha + lane_remainder(alpha - s->alpha);
    double before = s->speed * s->alpha, after = speed * next;
    for (int i = 0; i < 2; i++) {
        s->wake[i] = lagged(s->wake[i], polar->wake_weight[i] * before, polar->wake_weight[i] * after,
                            polar->wake_rate[i] * semi_chords);
    }
    s->speed = speed;
    s->alpha = next;
    // theory (90): lags of pressure and of separation
    double sought = effective(polar, s) + mass_angle;
    s->pressure = lagged(s->pressure, s->pressure_sought, sought, semi_chords / pressure_time);
    s->pressure_sought = sought;
    double f = separation_at(polar, s->pressure);
    s->separation = lagged(s->separation, s->separation_sought, f, semi_chords / separation_time);
    s->separation_sought = f;
    unwind(polar, s);
}

// -- coefficients ---------------------------------------------------------------------------------

// The static polar at the effective angle.
typedef struct static_part {
    double angle, f, separated, linear; // α_E; point of separation; lift of separated and of attached flow
    bough_coefficients k;
} static_part;

static static_part static_at(const bough_polar *polar, double angle) {
    static_part p = {.angle = angle,
                     .linear = polar->slope * lane_remainder(angle - polar->zero_lift),
                     .k = bough_polar_at(polar, angle)};
    split(polar, angle, p.k.lift, &p.f, &p.separated);
    return p;
}

// theory (91). `x`: the lagged f, `late`: α at three quarters of the chord, `downwash`: ϑ, the contribution
// of the rotation to it. The lift of the circulation leans back by the angle that the wake withholds and by
// ϑ.
static bough_coefficients dynamic(const bough_polar *polar, static_part p, double x, double late,
                                  double downwash) {
    double lift = x * p.linear + (1 - x) * p.separated, mass_lift = BOUGH_PI * downwash;
    double separating = (sqrt(p.f) - sqrt(fmax(x, 0))) / 2 - (p.f - x) / 4;
    double leaning = lane_remainder(late - p.angle) + downwash;
    double drag = p.k.drag + leaning * lift + (p.k.drag - polar->least_drag) * separating;
    return (bough_coefficients){lift + mass_lift, drag, p.k.moment - mass_lift / 2};
}

static double mixed(double a, double b, double w) { return a + w * (b - a); }

static bough_coefficients mixture(bough_coefficients a, bough_coefficients b, double w) {
    return (bough_coefficients){mixed(a.lift, b.lift, w), mixed(a.drag, b.drag, w),
                                mixed(a.moment, b.moment, w)};
}

// Weight of the dynamic coefficients against the static polar.
static double dynamic_weight(double alpha) {
    return bough_clamp((faded - fabs(alpha)) / (faded - fading), 0, 1);
}

// ϑ: downwash at three quarters of the chord by the rotation.
static double downwash_of(double chord, bough_stall_inflow inflow) {
    return bough_clamp(chord * inflow.rate / (2 * inflow.speed), -0.5, 0.5);
}

// -- slopes ---------------------------------------------------------------------------------------

// ∂α_E/∂α within an advance.
static double prompt_fraction(const bough_polar *polar, double semi_chords) {
    double fraction = 1;
    // theory (89): the shed wake, driven by U α
    for (int i = 0; i < 2; i++) {
        double h = polar->wake_rate[i] * semi_chords;
        fraction -= polar->wake_weight[i] * (h > 1e-6 ? -expm1(-h) / h : 1);
    }
    return fraction;
}

static bough_coefficients quotient(bough_coefficients a, bough_coefficients b, double step) {
    return (bough_coefficients){(a.lift - b.lift) / step, (a.drag - b.drag) / step,
                                (a.moment - b.moment) / step};
}

// The coefficients after an advance, and what they are made of.
typedef struct advanced {
    double alpha, late, downwash, weight;
    bough_coefficients fixed, k; // of the static polar, and dynamic ones
    double angle;                // α_E
    double prompt;               // ∂α_E/∂α
} advanced;

// By differences of the dynamic coefficients; `slopes` has those of the static polar.
static void find_slopes(const bough_polar *polar, const advanced *a, double chord, bough_stall_inflow inflow,
                        double x, bough_stall_slopes *slopes) {
    const double d = 1e-4; // [rad]
    static_part moved = static_at(polar, a->angle + a->prompt * d);
    bough_coefficients more = dynamic(polar, moved, x, a->late + d, a->downwash);
    bough_coefficients rotated = dynamic(polar, moved, x, a->late + d, a->downwash + d);
    slopes->angle = mixture(slopes->angle, quotient(more, a->k, d), a->weight);
    if (a->weight < 1) { // the weight depends on the angle, too
        double fading_rate = -copysign(1 / (faded - fading), a->alpha);
        bough_coefficients by_weight = quotient(a->k, a->fixed, 1 / fading_rate);
        slopes->angle.lift += by_weight.lift;
        slopes->angle.drag += by_weight.drag;
        slopes->angle.moment += by_weight.moment;
    }
    bool limited = fabs(a->downwash) >= 0.5;
    double quarter = limited ? 0 : a->weight * chord / (2 * inflow.speed);
    slopes->rate = mixture((bough_coefficients){0}, quotient(rotated, a->k, d), quarter);
}

bough_coefficients bough_stall_advance(const bough_polar *polar, double chord, bough_stall_inflow inflow,
                                       double step, bough_stall_state *state, bough_stall_slopes *slopes) {
    double alpha = lane_remainder(inflow.alpha), speed = inflow.speed;
    advanced a = {.alpha = alpha, .fixed = bough_polar_at(polar, alpha), .weight = dynamic_weight(alpha)};
    if (slopes) {
        *slopes = (bough_stall_slopes){.angle = bough_polar_slope(polar, alpha)};
        slopes->fixed = slopes->angle.lift;
    }
    if (polar->slope == 0 || !(speed > slow)) {
        state->started = 0;
        return a.fixed;
    }
    a.downwash = downwash_of(chord, inflow);
    a.late = alpha + a.downwash;
    if (state->started == 0) {
        start(polar, a.late, speed, state);
    } else if (step > 0) {
        double semi_chords = step * (state->speed + speed) / chord;
        advance(polar, semi_chords, a.late, speed, BOUGH_PI * a.downwash / polar->slope, state);
    }
    if (a.weight == 0) return a.fixed;
    // theory (91)
    a.angle = effective(polar, state);
    a.k = dynamic(polar, static_at(polar, a.angle), state->separation, a.late, a.downwash);
    if (slopes) {
        a.prompt = prompt_fraction(polar, 2 * step * speed / chord);
        find_slopes(polar, &a, chord, inflow, state->separation, slopes);
    }
    return mixture(a.fixed, a.k, a.weight);
}

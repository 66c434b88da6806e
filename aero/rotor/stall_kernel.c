// theory (88, 89, 90, 91), eight sections side by side in vector lanes.
#include "aero/rotor/stall.h"

#include "core/base/lanes.h"

#include <assert.h>

enum { N = BOUGH_LANES };

// Lags of pressure and separation, in semi-chords.
static const double pressure_time = 1.7, separation_time = 3.0;
// Weight of the static polar: 0 up to the first angle, 1 from the second on [rad].
static const double fading = 40 * BOUGH_DEGREE, faded = 50 * BOUGH_DEGREE;
// Slower than this there is no wake [m/s].
static const double slow = 1e-3;
// Closer to zero lift than this the ratio of lifts is taken here [rad].
static const double near_zero = 1e-4;
// Slopes are differences over this angle [rad].
static const double increment = 1e-4;

typedef double lane[N];

// Coefficients, and the lift that the point of separation follows from.
typedef struct polar_lanes {
    lane lift, drag, moment, near;
} polar_lanes;

// The fields of a state.
enum { STARTED, SPEED, ALPHA, WAKE, PRESSURE_SOUGHT = 5, PRESSURE, SEPARATION_SOUGHT, SEPARATION, FIELDS };
static_assert(FIELDS * sizeof(double) == sizeof(bough_stall_state), "a row of doubles");

typedef struct group {
    _Alignas(8 * N) lane state[FIELDS];
    lane starting, moving; // 1: the state starts, goes on; both 0: it stays
    lane inflow, angle;    // speed and angle of attack [m/s], [rad]
    lane chord, downwash;  // ϑ: downwash at three quarters of the chord by the rotation [rad]
    lane passed, ahead;    // semi-chords that the flow passes in the step; with the last speed alone
    lane weight;           // of the dynamic coefficients against the static polar
    lane slope, zero_lift, least_drag, weights[2], rates[2]; // of the polars
    lane effective, moved, prompt;                           // α_E, beside it, ∂α_E/∂α
    polar_lanes fixed, slopes, at_pressure, at_effective, at_moved, k, by, rate; // the last three: results
    const bough_polar *polar[N];
} group;

// -- polars ---------------------------------------------------------------------------------------

BOUGH_INLINE void look_up(const lane angle, const group *restrict g, polar_lanes *restrict k) {
    for (int i = 0; i < N; i++) {
        const bough_polar *polar = g->polar[i];
        bough_coefficients c = bough_polar_at(polar, angle[i]);
        double d = lane_remainder(angle[i] - polar->zero_lift);
        k->lift[i] = k->near[i] = c.lift;
        k->drag[i] = c.drag;
        k->moment[i] = c.moment;
        if (fabs(d) < near_zero)
            k->near[i] = bough_polar_at(polar, polar->zero_lift + copysign(near_zero, d)).lift;
    }
}

static void look_up_slopes(group *restrict g) {
    for (int i = 0; i < N; i++) {
        bough_coefficients c = bough_polar_slope(g->polar[i], g->angle[i]);
        g->slopes.lift[i] = c.lift;
        g->slopes.drag[i] = c.drag;
        g->slopes.moment[i] = c.moment;
    }
}

// Trailing-edge separation point in [0, 1], 1 attached, and the lift of attached and of fully separated flow,
// of which the static lift is made: Cl = f·attached + (1 − f)·separated.
typedef struct parts {
    double f, attached, separated;
} parts;

// With r = Cl/(slope·(α − α₀)) Kirchhoff's f = (2√r − 1)² leaves the separated lift
// slope·(α − α₀)(3√r − 1)/(4√r), which is all of it at f = 0 and half of it at f = 1.
BOUGH_INLINE parts split(const group *g, const polar_lanes *k, double alpha, int i) {
    double from_zero = lane_remainder(alpha - g->zero_lift[i]), attached = g->slope[i] * from_zero;
    double d = fabs(from_zero) < near_zero ? copysign(near_zero, from_zero) : from_zero;
    double q = sqrt(lane_clamp(k->near[i] / (g->slope[i] * d), 0, 1)), partly = q > 0.5 ? 1 : 0;
    partly = fabs(d) > BOUGH_PI / 2 ? 0 : partly;
    double separated = attached * (3 * q - 1) / (4 * (partly > 0 ? q : 1));
    return (parts){partly * (2 * q - 1) * (2 * q - 1), attached, partly > 0 ? separated : k->lift[i]};
}

// -- states ---------------------------------------------------------------------------------------

// exp(−h) − 1
BOUGH_INLINE double decline(double h) { return lane_expm1(-(h < 700 ? h : 700)); }

// x' = (u − x)/T over a step of h = Δt/T, in which u goes linearly from u0 to u1.
BOUGH_INLINE double lagged(double x, double u0, double u1, double h) {
    double decayed = decline(h), next = u1 + (x - u0) * (1 + decayed) + (u1 - u0) * decayed / h;
    return h > 0 ? next : x;
}

// Sections from `first` on, and beyond the last that one again.
static void take(const bough_stall_sections *s, int first, group *restrict g) {
    for (int i = 0; i < N; i++) {
        int j = first + i < s->n ? first + i : s->n - 1;
        const bough_polar *polar = g->polar[i] = s->polar[j];
        double state[FIELDS];
        memcpy(state, s->state + j, sizeof state);
        for (int k = 0; k < FIELDS; k++) g->state[k][i] = state[k];
        g->inflow[i] = s->speed[j];
        g->angle[i] = lane_remainder(s->alpha[j]);
        g->chord[i] = s->chord[j];
        g->downwash[i] = s->rate[j];
        g->slope[i] = polar->slope;
        g->zero_lift[i] = polar->zero_lift;
        g->least_drag[i] = polar->least_drag;
        for (int k = 0; k < 2; k++) {
            g->weights[k][i] = polar->wake_weight[k];
            g->rates[k][i] = polar->wake_rate[k];
        }
    }
}

// Which states start, go on or stay. Those that start are in equilibrium; their separation follows later.
static void begin(double step, group *restrict g) {
#pragma omp simd
    for (int i = 0; i < N; i++) {
        double u = g->inflow[i], active = u > slow ? 1 : 0;
        active = g->slope[i] == 0 ? 0 : active;
        double starting = g->state[STARTED][i] == 0 ? active : 0, moving = step > 0 ? active - starting : 0;
        double safe = active > 0 ? u : 1, slope = active > 0 ? g->slope[i] : 1;
        double downwash = lane_clamp(g->chord[i] * g->downwash[i] / (2 * safe), -0.5, 0.5);
        double late = g->angle[i] + downwash;
        g->state[STARTED][i] = active;
        g->starting[i] = starting;
        g->moving[i] = moving;
        g->passed[i] = step * (g->state[SPEED][i] + u) / g->chord[i];
        g->ahead[i] = 2 * step * u / g->chord[i];
        g->downwash[i] = downwash;
        g->weight[i] = active * lane_clamp((faded - fabs(g->angle[i])) / (faded - fading), 0, 1);
        g->slope[i] = slope;
        g->state[SPEED][i] = starting > 0 ? u : g->state[SPEED][i];
        g->state[ALPHA][i] = starting > 0 ? late : g->state[ALPHA][i];
        g->state[PRESSURE_SOUGHT][i] = starting > 0 ? late : g->state[PRESSURE_SOUGHT][i];
        g->state[PRESSURE][i] = starting > 0 ? late : g->state[PRESSURE][i];
        for (int k = 0; k < 2; k++)
            g->state[WAKE + k][i] = starting > 0 ? g->weights[k][i] * u * late : g->state[WAKE + k][i];
    }
}

// α_E of theory (89).
BOUGH_INLINE double effective(const group *g, int i) {
    double own = 1 - g->weights[0][i] - g->weights[1][i];
    return own * g->state[ALPHA][i] +
           (g->state[WAKE][i] + g->state[WAKE + 1][i]) / (g->state[SPEED][i] > 0 ? g->state[SPEED][i] : 1);
}

// The wake and the lag of pressure.
static void advance(group *restrict g) {
#pragma omp simd
    for (int i = 0; i < N; i++) {
        double moving = g->moving[i], late = g->angle[i] + g->downwash[i], alpha = g->state[ALPHA][i];
        double next = alpha + lane_remainder(late - alpha);
        double before = g->state[SPEED][i] * alpha, after = g->inflow[i] * next;
        for (int k = 0; k < 2; k++) {
            double part = g->weights[k][i], x = g->state[WAKE + k][i];
            double wake = lagged(x, part * before, part * after, g->rates[k][i] * g->passed[i]);
            g->state[WAKE + k][i] = moving > 0 ? wake : x;
        }
        g->state[SPEED][i] = moving > 0 ? g->inflow[i] : g->state[SPEED][i];
        g->state[ALPHA][i] = moving > 0 ? next : alpha;
        // theory (90)
        double sought = effective(g, i) + BOUGH_PI * g->downwash[i] / g->slope[i], x = g->state[PRESSURE][i];
        double lag = lagged(x, g->state[PRESSURE_SOUGHT][i], sought, g->passed[i] / pressure_time);
        g->state[PRESSURE][i] = moving > 0 ? lag : x;
        g->state[PRESSURE_SOUGHT][i] = moving > 0 ? sought : g->state[PRESSURE_SOUGHT][i];
    }
}

// The lag of separation, then all angles moved by multiples of 2π, so that the angle of attack stays in
// [−π, π].
static void separate(group *restrict g) {
#pragma omp simd
    for (int i = 0; i < N; i++) {
        double moving = g->moving[i], x = g->state[SEPARATION][i],
               f = split(g, &g->at_pressure, g->state[PRESSURE][i], i).f;
        double lag = lagged(x, g->state[SEPARATION_SOUGHT][i], f, g->passed[i] / separation_time);
        double kept = g->starting[i] > 0 ? f : x;
        g->state[SEPARATION][i] = moving > 0 ? lag : kept;
        g->state[SEPARATION_SOUGHT][i] = moving + g->starting[i] > 0 ? f : g->state[SEPARATION_SOUGHT][i];
        double shift = moving * 2 * BOUGH_PI * lane_round(g->state[ALPHA][i] * (0.5 / BOUGH_PI));
        g->state[ALPHA][i] -= shift;
        g->state[PRESSURE_SOUGHT][i] -= shift;
        g->state[PRESSURE][i] -= shift;
        for (int k = 0; k < 2; k++) g->state[WAKE + k][i] -= g->weights[k][i] * shift * g->state[SPEED][i];
        // ∂α_E/∂α within the advance, theory (89): the shed wake, driven by U α
        double prompt = 1;
        for (int k = 0; k < 2; k++) {
            double h = g->rates[k][i] * g->ahead[i], mean = -decline(h) / h;
            prompt -= g->weights[k][i] * (h > 1e-6 ? mean : 1);
        }
        g->effective[i] = effective(g, i);
        g->prompt[i] = prompt;
        g->moved[i] = g->effective[i] + prompt * increment;
    }
}

// -- coefficients ---------------------------------------------------------------------------------

// theory (91) at the angle `effective`. `late`: α at three quarters of the chord. The lift of the circulation
// leans back by the angle that the wake withholds and by ϑ.
BOUGH_INLINE bough_coefficients dynamic(const group *g, const polar_lanes *k, int i, double effective,
                                        double late, double downwash) {
    parts p = split(g, k, effective, i);
    double x = g->state[SEPARATION][i], lift = x * p.attached + (1 - x) * p.separated;
    double separating = (sqrt(p.f) - sqrt(x > 0 ? x : 0)) / 2 - (p.f - x) / 4, mass = BOUGH_PI * downwash;
    double leaning = lane_remainder(late - effective) + downwash;
    double drag = k->drag[i] + leaning * lift + (k->drag[i] - g->least_drag[i]) * separating;
    return (bough_coefficients){lift + mass, drag, k->moment[i] - mass / 2};
}

static void mix(group *restrict g) {
#pragma omp simd
    for (int i = 0; i < N; i++) {
        double late = g->angle[i] + g->downwash[i], w = g->weight[i];
        bough_coefficients k = dynamic(g, &g->at_effective, i, g->effective[i], late, g->downwash[i]);
        g->k.lift[i] = g->fixed.lift[i] + w * (k.lift - g->fixed.lift[i]);
        g->k.drag[i] = g->fixed.drag[i] + w * (k.drag - g->fixed.drag[i]);
        g->k.moment[i] = g->fixed.moment[i] + w * (k.moment - g->fixed.moment[i]);
    }
}

// By differences of the dynamic coefficients, where the weight depends on the angle, too.
static void find_slopes(group *restrict g) {
#pragma omp simd
    for (int i = 0; i < N; i++) {
        const double d = increment;
        double turned = g->downwash[i], late = g->angle[i] + turned, w = g->weight[i];
        bough_coefficients k = dynamic(g, &g->at_effective, i, g->effective[i], late, turned);
        bough_coefficients more = dynamic(g, &g->at_moved, i, g->moved[i], late + d, turned);
        bough_coefficients rotated = dynamic(g, &g->at_moved, i, g->moved[i], late + d, turned + d);
        double partly = w < 1 ? 1 : 0, fade = -copysign(1 / (faded - fading), g->angle[i]);
        fade *= w > 0 ? partly : 0;
        const polar_lanes *s = &g->slopes;
        g->by.lift[i] =
            s->lift[i] + w * ((more.lift - k.lift) / d - s->lift[i]) + fade * (k.lift - g->fixed.lift[i]);
        g->by.drag[i] =
            s->drag[i] + w * ((more.drag - k.drag) / d - s->drag[i]) + fade * (k.drag - g->fixed.drag[i]);
        g->by.moment[i] = s->moment[i] + w * ((more.moment - k.moment) / d - s->moment[i]) +
                          fade * (k.moment - g->fixed.moment[i]);
        double quarter = g->chord[i] / (2 * (w > 0 ? g->inflow[i] : 1));
        quarter = fabs(turned) < 0.5 ? w * quarter / d : 0;
        g->rate.lift[i] = quarter * (rotated.lift - k.lift);
        g->rate.drag[i] = quarter * (rotated.drag - k.drag);
        g->rate.moment[i] = quarter * (rotated.moment - k.moment);
    }
}

static void keep(const group *g, int first, const bough_stall_sections *s) {
    for (int i = 0; i < N && first + i < s->n; i++) {
        double state[FIELDS];
        for (int k = 0; k < FIELDS; k++) state[k] = g->state[k][i];
        memcpy(s->state + first + i, state, sizeof state);
    }
}

// -- the whole ------------------------------------------------------------------------------------

static void put(const polar_lanes *k, const bough_stall_rows *to, int first) {
    memcpy(to->lift + first, k->lift, sizeof k->lift);
    memcpy(to->drag + first, k->drag, sizeof k->drag);
    memcpy(to->moment + first, k->moment, sizeof k->moment);
}

void BOUGH_AT_LEVEL(bough_stall_advance)(const bough_stall_sections *s, double step,
                                         const bough_stall_results *to) {
    for (int first = 0; first < s->n; first += N) {
        group g;
        take(s, first, &g);
        look_up(g.angle, &g, &g.fixed);
        begin(step, &g);
        advance(&g);
        look_up(g.state[PRESSURE], &g, &g.at_pressure);
        separate(&g);
        look_up(g.effective, &g, &g.at_effective);
        mix(&g);
        put(&g.k, &to->coefficients, first);
        keep(&g, first, s);
        if (!to->with_slopes) continue;
        look_up_slopes(&g);
        look_up(g.moved, &g, &g.at_moved);
        find_slopes(&g);
        put(&g.by, &to->by_angle, first);
        put(&g.rate, &to->by_rate, first);
        memcpy(to->static_slope + first, g.slopes.lift, sizeof g.slopes.lift);
    }
}

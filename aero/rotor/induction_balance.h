// Ning's residual multiplied by sin φ, in which it has no pole:
//     f(φ) = sin²φ/(1 − a) − |Vx/Vy| (sin φ cos φ − σ ct/(4F)),
// written for the quadrant of positive inflow, to which mirroring brings every other. Without
// branches but those of the options, so that it runs in vector lanes; for induction_kernel.c only.
#pragma once

#include "aero/rotor/induction.h"
#include "core/base/lanes.h"

// Both ends of an interval keep this distance from φ = 0 and π, where no wake exists [rad].
static const double clearance = 1e-6;
// Of the inflow angle [rad].
static const double precision = 1e-12;
// Slower than this there is no wake [m/s].
static const double slow = 1e-3;
// From this exponent on Prandtl's factor is 1 to the last digit.
static const double no_loss = 40;
// Least loss factor.
static const double least_loss = 1e-4;
// a beyond which the smooth parabola replaces momentum theory: without skew, and the most [Spera].
static const double critical = 0.35, most_critical = 0.5;
// Of a wake's angle, beyond which there is no disk across the wind [rad].
static const double most_skew_angle = 80 * BOUGH_DEGREE;

// The thrust that momentum theory has at a = 1 − x, and the parabola from x_c on, by the skew; of the
// whole rotor.
typedef struct wake {
    double critical;     // a_c = 1 − x_c
    double tangent2;     // tan²χ, 0 without the skew's momentum
    double value, slope; // CT/F and its slope in a at a_c
    double limit;        // k up to there, CT = 4 F k x²
    double most;         // CT at a = 1, but for small slopes
} wake;

typedef struct problem {
    double sign_x, sign_y;         // of the inflow
    double slope;                  // |Vx / Vy|
    double density, cone;          // σ/4, cos² of the cone
    double tip_factor, hub_factor; // 1e3, which loses nothing, when the loss is off
    double twist, skew_normal, skew_chord;
    wake wake;
} problem;

// The point at which the polar is evaluated.
typedef struct flow {
    double s, c;  // of the inflow angle
    double loss;  // F
    double alpha; // angle of attack [rad]
} flow;

// The inflow's direction in the section's axes, rotated by the small angle of an oblique section.
typedef struct section_flow {
    double s, c, angle;
} section_flow;

typedef struct balance {
    double residual;
    double axial; // sin²φ/(1 − a)
    double swirl; // sin φ cos φ/(1 + a')
} balance;

// Options as factors, 0 or 1.
typedef struct weights {
    double tip_loss, hub_loss, axial_drag, tangential_drag, swirl;
} weights;

BOUGH_INLINE weights weights_of(const bough_induction_options *o) {
    return (weights){o->tip_loss, o->hub_loss, o->axial_drag, o->tangential_drag, o->tangential};
}

BOUGH_INLINE wake wake_of(const bough_induction_options *o, double skew) {
    double angle = fmin(fabs(skew), most_skew_angle);
    double a = fmin(critical / cos(angle), most_critical), x = 1 - a;
    double t = o->skewed_momentum ? tan(angle) : 0, root = sqrt(x * x + t * t);
    return (wake){.critical = a,
                  .tangent2 = t * t,
                  .value = 4 * a * root,
                  .slope = 4 * (1 - 3 * a + 2 * a * a + t * t) / root,
                  .limit = a * root / (x * x),
                  .most = 2 + 2.113 * pow(t * t, 0.7635)};
}

// Of element i; its wake is the caller's.
BOUGH_INLINE problem problem_of(weights o, const bough_elements *e, int i) {
    return (problem){.sign_x = copysign(1, e->inflow_x[i]),
                     .sign_y = copysign(1, e->inflow_y[i]),
                     .slope = fabs(e->inflow_x[i] / e->inflow_y[i]),
                     .density = e->solidity[i] / 4,
                     .cone = e->cone[i],
                     .tip_factor = o.tip_loss * e->tip_factor[i] + (1 - o.tip_loss) * 1e3,
                     .hub_factor = o.hub_loss * e->hub_factor[i] + (1 - o.hub_loss) * 1e3,
                     .twist = e->twist[i],
                     .skew_normal = e->skew_normal[i],
                     .skew_chord = e->skew_chord[i]};
}

// Whether the loss leaves a momentum balance, and the inflow a wake.
BOUGH_INLINE bool is_balanced(problem p, double vx, double vy) {
    double least_factor = p.tip_factor < p.hub_factor ? p.tip_factor : p.hub_factor;
    double least_speed = fabs(vx) < fabs(vy) ? fabs(vx) : fabs(vy);
    return least_factor >= 1e-9 && least_speed >= slow;
}

// theory (82): (2/π) acos exp(−x)
BOUGH_INLINE double prandtl(double x) {
    double e = lane_exp(-(x < no_loss ? x : no_loss)), near_one = e > 0.5 ? 1 : 0;
    double angle = lane_arc_sine(near_one > 0 ? sqrt((1 - e) / 2) : e);
    return near_one > 0 ? 4 / BOUGH_PI * angle : 1 - 2 / BOUGH_PI * angle;
}

BOUGH_INLINE double loss_at(problem p, double s) {
    double inverse = 1 / s, f = prandtl(p.tip_factor * inverse) * prandtl(p.hub_factor * inverse);
    return f > least_loss ? f : least_loss;
}

// (s, c) is the inflow in the element's axes, along the section's normal s + g c and its chord
// (1 − h) c: the angle between by its tangent, with series for 1/(1 + e), sine, cosine and angle
// that are good to 1e-6 up to 0.03.
BOUGH_INLINE section_flow seen_by_section(problem p, double s, double c) {
    double g = p.skew_normal, h = p.skew_chord;
    double e = c * (s * g - c * h), t = c * (s * h + c * g) * (1 - e + e * e), t2 = t * t;
    double sine = t * (1 - t2 / 2), cosine = 1 - t2 / 2;
    return (section_flow){s * cosine + c * sine, c * cosine - s * sine, t * (1 - t2 / 3)};
}

BOUGH_INLINE flow flow_at(problem p, double phi) {
    sine_cosine k = lane_sine_cosine(phi);
    double angle = p.sign_x * (p.sign_y > 0 ? phi : BOUGH_PI - phi);
    double oblique = seen_by_section(p, p.sign_x * k.sine, p.sign_y * k.cosine).angle;
    return (flow){k.sine, k.cosine, loss_at(p, fabs(k.sine)), angle + oblique - p.twist};
}

// theory (80): sin²φ/(1 − a) for the loading c = σ cn/(4F) = k sin²φ by Buhl's parabola beyond k = 2/3, whose
// root written as 1 − a = 1/(√g₂ + 5/3 − F) has no singular case.
BOUGH_INLINE double axial_buhl(double c, double s, double f, bool brake) {
    double s2 = s * s;
    if (brake) return s2 - c;
    double square = s2 * (2 * f * c - (4. / 3 - f) * f * s2);
    double beyond = sqrt(square > 0 ? square : 0) + (5. / 3 - f) * s2;
    return 3 * c <= 2 * s2 ? s2 + c : beyond;
}

// theory (81): the same by the parabola CT = d₀ + d₁ x + d₂ x² of x = 1 − a that leaves momentum theory
// smoothly at a_c. Its other root, a > 1, belongs to φ < 0, at any load.
BOUGH_INLINE double axial_parabola(const wake w, double c, double s, double f) {
    double xc = 1 - w.critical, s2 = s * s, value = f * w.value, slope = f * w.slope;
    double least = value + slope * xc + 0.001, d0 = w.most > least ? w.most : least;
    double d2 = (d0 - slope * xc - value) * (1 / (xc * xc)), d1 = -slope - 2 * d2 * xc;
    double square = d1 * d1 * s2 + 4 * d0 * (4 * f * c - d2 * s2);
    double root = sqrt(square > 0 ? square : 0);
    return (s * root - d1 * s2) / (2 * d0);
}

// theory (83), below a_c: k x² = (1 − x) sqrt(x² + tan²χ) by Newton's method, which gains all digits from
// where there is no skew; of negative loads the slope at a = 0.
BOUGH_INLINE double axial_skewed(const wake w, double c, double s) {
    enum { STEPS = 5 };
    double s2 = s * s, t2 = w.tangent2, k = c / s2;
    k = k > 0 ? k : 0;
    k = k < w.limit ? k : w.limit;
    double x = 1 / (1 + k);
    for (int i = 0; i < STEPS; i++) {
        double root = sqrt(x * x + t2), defect = (1 - x) * root - k * x * x;
        double slope = (1 - x) * x / root - root - 2 * k * x;
        x -= defect / slope;
    }
    return c > 0 ? s2 / x : s2 + c / sqrt(1 + t2);
}

BOUGH_INLINE double axial_smooth(bool skewed, bool brake, const wake w, double c, double s, double f) {
    if (brake) return axial_parabola(w, c, s, f);
    double low = skewed ? axial_skewed(w, c, s) : s * s + c;
    return c <= w.limit * s * s ? low : axial_parabola(w, c, s, f);
}

// Where momentum theory gives the swirl: not where a > 1.
BOUGH_INLINE bool is_low(bool brake, const wake w, double c, double s, double axial) {
    return c <= w.limit * s * s && (!brake || axial > 0);
}

// The part of the thrust by momentum theory, a/(k |1 − a|): the swirl fades with it beyond a_c and where a
// > 1.
BOUGH_INLINE double swirl_fraction(bool brake, const wake w, double c, double s, double axial) {
    double s2 = s * s, fraction = fabs(axial - s2) / c; // a = 1 − sin²φ/axial
    return is_low(brake, w, c, s, axial) ? 1 : fraction;
}

// The same in a skewed wake, and of the mass flow that it adds.
BOUGH_INLINE double swirl_skewed(bool brake, const wake w, double c, double s, double axial, double f) {
    double s2 = s * s, t2 = w.tangent2, x = s2 / axial, a = 1 - x, x2 = x * x;
    double inverse = 1 / sqrt(x2 + t2), thrust = 4 * f * c / s2 * x2;
    double high = 4 * fabs(a) * f * fabs(x) * sqrt(x2 + t2 * f * f) / sqrt(thrust * thrust + 16 * a * a * t2);
    return (is_low(brake, w, c, s, axial) ? fabs(x) : high) * inverse;
}

// `high_thrust`, `brake`, `skewed`: known where this is inlined into a loop.
BOUGH_INLINE balance balance_of(bough_high_thrust high_thrust, bool brake, bool skewed, weights o, problem p,
                                flow w, double lift, double drag) {
    section_flow f = seen_by_section(p, p.sign_x * w.s, p.sign_y * w.c);
    double normal = lift * f.c + o.axial_drag * drag * f.s;
    double chordwise = lift * f.s - o.tangential_drag * drag * f.c;
    double tangent = (1 - p.skew_chord) * chordwise - p.skew_normal * normal;
    double density = p.density / w.loss, loading = density * p.cone * p.sign_x * normal;
    double swirl = o.swirl * density * p.sign_y * tangent, axial;
    if (high_thrust == BOUGH_HIGH_THRUST_BUHL) {
        axial = axial_buhl(loading, w.s, w.loss, brake);
    } else {
        axial = axial_smooth(skewed, brake, p.wake, loading, w.s, w.loss);
        swirl *= skewed ? swirl_skewed(brake, p.wake, loading, w.s, axial, w.loss)
                        : swirl_fraction(brake, p.wake, loading, w.s, axial);
    }
    double left = w.s * w.c - swirl;
    return (balance){axial - p.slope * left, axial, left};
}

// The inflow angle without induction.
BOUGH_INLINE double free_angle(problem p) {
    return lane_clamp(lane_angle(p.slope, 1), 2 * clearance, BOUGH_PI / 2 - clearance);
}

// Where a windmill element with linear lift, no drag and no swirl would balance: 4F φ (φ₀ − φ) =
// σ c_lα (φ − θ − α₀) for small angles, φ₀ that without induction; 0 unless attached and in (0, φ₀).
BOUGH_INLINE double attached_angle(problem p, double lift_slope, double zero_lift, double phi0) {
    double zero = p.twist + zero_lift;
    double k = p.density * p.cone * lift_slope / loss_at(p, lane_sine_cosine(0.7 * phi0).sine);
    double h = (phi0 - k) / 2, square = h * h + k * zero;
    double phi = h + sqrt(square > 0 ? square : 0), off = fabs(phi - zero);
    double windmill = p.sign_x + p.sign_y > 1 ? lift_slope : 0;
    return windmill * square > 0 && off < 0.2 && phi > 1e-3 && phi < phi0 ? phi : 0;
}

// The first guess of a bracket's other end, a little beyond the likely root: from the attached angle by a
// step of Newton's method with the slope of the same model, from φ₀ by a step of the fixed-point iteration
// for the inductions.
BOUGH_INLINE double nearby(problem p, double attached, double lift_slope, double phi0, double phi, flow w,
                           balance b) {
    const double overshoot = 1.4;
    double rise = 2 * phi - phi0 + p.density * p.cone * lift_slope / w.loss;
    double newton = lane_clamp(phi - overshoot * b.residual / rise, 0.8 * phi, 1.2 * phi);
    double induced = lane_angle(p.slope * w.s * b.swirl, w.c * b.axial);
    double iterated = lane_clamp(phi + overshoot * (induced - phi), clearance, BOUGH_PI / 2);
    double bound = newton < phi0 ? newton : phi0;
    return attached > 0 ? bound : iterated;
}

// The other end of the search if the first has no root.
BOUGH_INLINE double farther(double attached, double phi0, double phi, double residual) {
    double up = 1.2 * phi < phi0 ? 1.2 * phi : phi0;
    double low = attached > 0 ? 0.8 * phi : clearance, high = attached > 0 ? up : BOUGH_PI / 2;
    return residual > 0 ? low : high;
}

// One step of Chandrupatla's method: inverse quadratic interpolation through (a, fa), (b, fb),
// (c, fc) where it is known to converge, else bisection; the fraction of the way from a to b.
BOUGH_INLINE double root_fraction(double a, double fa, double b, double fb, double c, double fc) {
    double ab = fabs(a - b), cb = fabs(c - b), fab = fa - fb, fca = fc - fa, fcb = fc - fb;
    double low = ab * fcb * fcb - cb * fab * fab, high = (cb - ab) * fcb * fcb - cb * fca * fca;
    double t = fa * fc / (fab * fcb) + (c - a) * fa * fb / ((b - a) * fca * fcb);
    double fits = low > 0 ? 1 : 0;
    fits = high > 0 ? fits : 0;
    return fits > 0 ? t : 0.5;
}

typedef struct induction {
    double axial, tangential;
} induction;

BOUGH_INLINE induction induction_of(weights o, flow w, balance b) {
    double safe = b.swirl == 0 ? 1 : b.swirl, swirl = b.swirl == 0 ? -1 : w.s * w.c / safe - 1;
    return (induction){lane_clamp(1 - w.s * w.s / b.axial, -1, 1.5), o.swirl * lane_clamp(swirl, -1, 1)};
}

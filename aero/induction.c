#include "aero/induction.h"

#include "core/base.h"

#include <math.h>

// Ning's residual multiplied by sin φ, in which it has no pole:
//     f(φ) = sin²φ/(1 − a) − |Vx/Vy| (sin φ cos φ − σ ct/(4F)),
// written for the quadrant of positive inflow, to which mirroring brings every other.

// Both ends of an interval keep this distance from φ = 0 and π, where no wake exists [rad].
static const double clearance = 1e-6;
// Of the inflow angle [rad].
static const double precision = 1e-12;
// Slower than this there is no wake to speak of [m/s].
static const double slow = 1e-3;
// Least loss factor.
static const double least_loss = 1e-4;

bough_induction_options bough_induction_options_default(void) {
    return (bough_induction_options){BOUGH_HIGH_THRUST_SMOOTH, true, true, true, true, true};
}

typedef struct problem {
    const bough_induction_options *options;
    const bough_element *element;
    double sign_x, sign_y; // of the inflow
    double slope;          // |Vx / Vy|
    bool brake;            // propeller brake state, φ < 0
    int evaluations;
} problem;

typedef struct balance {
    double axial; // sin²φ/(1 − a)
    double swirl; // sin φ cos φ/(1 + a')
    double sc;    // sin φ cos φ
    double s2;    // sin²φ
    double loss;  // F
} balance;

// (2/π) acos exp(−factor/|sin φ|)
static double prandtl(double factor, double s) {
    double x = factor / s;
    return x > 37 ? 1 : 2 / BOUGH_PI * acos(exp(-x)); // beyond 37 the exponential is lost to 1
}

static double loss(const problem *p, double s) {
    double f = 1;
    if (p->options->tip_loss) f *= prandtl(p->element->tip_factor, s);
    if (p->options->hub_loss) f *= prandtl(p->element->hub_factor, s);
    return fmax(f, least_loss);
}

// sin²φ/(1 − a) for the loading c = σ cn/(4F) = k sin²φ by Buhl's parabola beyond k = 2/3, whose
// root written as 1 − a = 1/(√g₂ + 5/3 − F) has no singular case.
static double axial_buhl(double c, double s, double f, bool brake) {
    double s2 = s * s;
    if (brake) return s2 - c;
    if (3 * c <= 2 * s2) return s2 + c;
    return sqrt(s2 * (2 * f * c - (4. / 3 - f) * f * s2)) + (5. / 3 - f) * s2;
}

// a beyond which the smooth parabola replaces momentum theory.
static const double critical = 0.35;

// The same by the parabola CT = d₀ + d₁ x + d₂ x² of x = 1 − a that leaves 4 F a (1 − a) smoothly
// at a = 0.35. Its other root, a > 1, belongs to φ < 0.
static double axial_smooth(double c, double s, double f) {
    const double xc = 1 - critical, d0 = 2;
    double s2 = s * s;
    if (xc * c <= critical * s2) return s2 + c;
    double value = 4 * f * critical * xc, slope = 4 * f * (1 - 2 * critical);
    double d2 = (d0 - slope * xc - value) / (xc * xc), d1 = -slope - 2 * d2 * xc;
    double root = sqrt(fmax(0, d1 * d1 * s2 + 4 * d0 * (4 * f * c - d2 * s2)));
    return (s * root - d1 * s2) / (2 * d0);
}

// The momentum share of the thrust, a/(k |1 − a|), with which the swirl fades beyond a = 0.35.
static double swirl_share(double c, double s, double axial) {
    double s2 = s * s;
    if ((1 - critical) * c <= critical * s2) return 1;
    return fabs(axial - s2) / c; // a = 1 − sin²φ/axial
}

static balance balance_at(problem *p, double phi) {
    const bough_element *e = p->element;
    const bough_induction_options *o = p->options;
    double s = sin(phi), c = cos(phi);
    double flow_s = p->sign_x * s, flow_c = p->sign_y * c;
    double angle = p->sign_y > 0 ? p->sign_x * phi : p->sign_x * (BOUGH_PI - phi);
    bough_coefficients k = bough_polar_at(e->polar, angle - e->twist);
    double normal = k.lift * flow_c + (o->axial_drag ? k.drag * flow_s : 0);
    double tangent = k.lift * flow_s - (o->tangential_drag ? k.drag * flow_c : 0);
    double f = loss(p, fabs(s)), density = e->solidity / (4 * f);
    double loading = density * e->cone * p->sign_x * normal;
    double swirl = o->tangential ? density * p->sign_y * tangent : 0;
    p->evaluations++;
    if (o->high_thrust == BOUGH_HIGH_THRUST_BUHL) {
        return (balance){axial_buhl(loading, s, f, p->brake), s * c - swirl, s * c, s * s, f};
    }
    double axial = axial_smooth(loading, s, f);
    swirl *= swirl_share(loading, s, axial);
    return (balance){axial, s * c - swirl, s * c, s * s, f};
}

static double residual(const problem *p, balance b) { return b.axial - p->slope * b.swirl; }

// One step of Chandrupatla's method: inverse quadratic interpolation through (a, fa), (b, fb),
// (c, fc) where it is known to converge, else bisection; the fraction of the way from a to b.
static double fraction(double a, double fa, double b, double fb, double c, double fc) {
    double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
    if (!(phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)) return 0.5;
    return fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
}

// The balance at a root in [low, high], where f changes sign; it begins in the middle, or where the
// chord meets zero.
static balance root(problem *p, double low, balance at_low, double high, balance at_high,
                    bool secant) {
    enum { MOST = 100 };
    double a = high, fa = residual(p, at_high), b = low, fb = residual(p, at_low);
    double t = secant ? bough_clamp(fa / (fa - fb), 0.01, 0.99) : 0.5;
    balance at_a = at_high;
    for (int i = 0; i < MOST; i++) {
        double x = a + t * (b - a);
        balance at_x = balance_at(p, x);
        double fx = residual(p, at_x), c = a, fc = fa;
        if ((fx > 0) != (fa > 0)) {
            c = b, fc = fb;
            b = a, fb = fa;
        }
        a = x, fa = fx, at_a = at_x;
        double width = fabs(b - a);
        if (fa == 0 || width < 2 * precision) break;
        t = fraction(a, fa, b, fb, c, fc);
        if (fabs(t) * width < precision && fabs(fx) < fabs(fb)) break;
        t = bough_clamp(t, precision / width, 1 - precision / width);
    }
    return at_a;
}

static bool changes_sign(const problem *p, balance a, balance b) {
    return (residual(p, a) > 0) != (residual(p, b) > 0);
}

// Where a windmill element with linear lift, no drag and no swirl would balance, if that is
// attached flow: 4F φ (φ₀ − φ) = σ c_lα (φ − θ − α₀) for small angles, φ₀ that without induction.
static bool attached_angle(const problem *p, double phi0, double *phi) {
    const bough_element *e = p->element;
    if (p->sign_x < 0 || p->sign_y < 0 || e->polar->slope == 0) return false;
    double zero = e->twist + e->polar->zero_lift;
    double k = e->solidity * e->cone * e->polar->slope / (4 * loss(p, sin(0.7 * phi0)));
    double h = (phi0 - k) / 2, square = h * h + k * zero;
    if (!(square > 0)) return false;
    *phi = h + sqrt(square);
    return *phi > 1e-3 && *phi < phi0 && fabs(*phi - zero) < 0.2;
}

// The root next to that angle, which the answer takes whatever other roots there are.
static bool search_attached(problem *p, double phi0, balance *found) {
    double a, b;
    if (!attached_angle(p, phi0, &a)) return false;
    balance at_a = balance_at(p, a), at_b;
    for (double share = 0.04; share < 0.5; share *= 5) {
        b = residual(p, at_a) > 0 ? (1 - share) * a : fmin((1 + share) * a, phi0);
        at_b = balance_at(p, b);
        if (changes_sign(p, at_a, at_b)) {
            *found = root(p, b, at_b, a, at_a, true);
            return found->axial > 0;
        }
        a = b, at_a = at_b;
    }
    return false;
}

// The windmill state, φ in (0, π/2], split at the angle without induction, near which it ends.
static bool search_windmill(problem *p, balance *found) {
    double middle = bough_clamp(atan(p->slope), 2 * clearance, BOUGH_PI / 2 - clearance);
    if (search_attached(p, middle, found)) return true;
    double low = clearance, high = middle;
    balance at_low = balance_at(p, low), at_high = balance_at(p, high);
    if (!changes_sign(p, at_low, at_high)) {
        low = middle, at_low = at_high;
        high = BOUGH_PI / 2, at_high = balance_at(p, high);
        if (!changes_sign(p, at_low, at_high)) return false;
    }
    *found = root(p, low, at_low, high, at_high, false);
    return found->axial > 0;
}

// Looks for a balance with φ in [low, high]; the momentum balance must be of the assumed state.
static bool search(problem *p, double low, double high, bool brake, balance *found) {
    p->brake = brake;
    balance at_low = balance_at(p, low), at_high = balance_at(p, high);
    if (!changes_sign(p, at_low, at_high)) return false;
    *found = root(p, low, at_low, high, at_high, false);
    return brake ? found->axial < 0 : found->axial > 0;
}

bough_induction bough_induction_solve(const bough_induction_options *options,
                                      const bough_element *element) {
    double vx = element->inflow_x, vy = element->inflow_y;
    if ((options->tip_loss && element->tip_factor < 1e-9) ||
        (options->hub_loss && element->hub_factor < 1e-9)) {
        return (bough_induction){.axial = 1, .fixed = true};
    }
    if (fabs(vx) < slow || fabs(vy) < slow) return (bough_induction){0};
    problem p = {.options = options,
                 .element = element,
                 .sign_x = copysign(1, vx),
                 .sign_y = copysign(1, vy),
                 .slope = fabs(vx / vy)};
    balance b = {0};
    bool found = search_windmill(&p, &b) || search(&p, -BOUGH_PI / 4, -clearance, true, &b) ||
                 search(&p, BOUGH_PI / 2, BOUGH_PI - clearance, false, &b);
    if (!found) return (bough_induction){.evaluations = p.evaluations};
    double swirl = b.swirl != 0 ? b.sc / b.swirl - 1 : -1;
    return (bough_induction){.axial = bough_clamp(1 - b.s2 / b.axial, -1, 1.5),
                             .tangential = options->tangential ? bough_clamp(swirl, -1, 1) : 0,
                             .loss = b.loss,
                             .evaluations = p.evaluations};
}

double bough_induction_angle(const bough_element *element, double axial, double tangential) {
    return atan2(element->inflow_x * (1 - axial), element->inflow_y * (1 + tangential));
}

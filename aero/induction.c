#include "aero/induction.h"

#include "aero/induction_balance.h"

bough_induction_options bough_induction_options_default(void) {
    return (bough_induction_options){BOUGH_HIGH_THRUST_SMOOTH, true, true, true, true, true, false};
}

// One element while its balance is sought.
typedef struct quest {
    const bough_induction_options *options;
    const bough_polar *polar;
    problem problem;
    bool brake; // propeller brake state, φ < 0
    int evaluations;
} quest;

typedef struct point {
    double phi;
    flow flow;
    balance balance;
} point;

static point point_at(quest *q, double phi) {
    flow w = flow_at(q->problem, phi);
    bough_coefficients k = bough_polar_at(q->polar, w.alpha);
    q->evaluations++;
    return (point){phi, w,
                   balance_of(q->options->high_thrust, q->brake, q->options->skewed_momentum,
                              weights_of(q->options), q->problem, w, k.lift, k.drag)};
}

static bool changes_sign(point a, point b) {
    return (a.balance.residual > 0) != (b.balance.residual > 0);
}

// A root between low and high, where f changes sign.
static point root(quest *q, point low, point high) {
    enum { MOST = 100 };
    point a = high, b = low;
    double fa = a.balance.residual, fb = b.balance.residual;
    double t = lane_clamp(fa / (fa - fb), 0.01, 0.99);
    for (int i = 0; i < MOST; i++) {
        point x = point_at(q, a.phi + t * (b.phi - a.phi)), c = a;
        if (changes_sign(x, a)) {
            c = b;
            b = a;
        }
        a = x;
        fa = a.balance.residual;
        fb = b.balance.residual;
        double width = fabs(b.phi - a.phi);
        if (fa == 0 || width < 2 * precision) break;
        t = root_fraction(a.phi, fa, b.phi, fb, c.phi, c.balance.residual);
        if (fabs(t) * width < precision && fabs(fa) < fabs(fb)) break;
        t = lane_clamp(t, precision / width, 1 - precision / width);
    }
    return a;
}

// The windmill state, φ in (0, π/2]: the root next to the attached angle, whatever other roots
// there are, without one that next to the angle without induction; else any.
static bool search_near(quest *q, double phi0, point *found) {
    const bough_polar *polar = q->polar;
    double guess = attached_angle(q->problem, polar->slope, polar->zero_lift, phi0);
    point a = point_at(q, guess > 0 ? guess : phi0);
    point b = point_at(q, nearby(q->problem, guess, polar->slope, phi0, a.phi, a.flow, a.balance));
    if (!changes_sign(a, b)) {
        a = b;
        b = point_at(q, farther(guess, phi0, a.phi, a.balance.residual));
        if (!changes_sign(a, b)) return false;
    }
    *found = root(q, b, a);
    return found->balance.axial > 0;
}

static bool search_windmill(quest *q, point *found) {
    double middle = free_angle(q->problem);
    if (search_near(q, middle, found)) return true;
    point low = point_at(q, clearance), high = point_at(q, middle);
    if (!changes_sign(low, high)) {
        low = high;
        high = point_at(q, BOUGH_PI / 2);
        if (!changes_sign(low, high)) return false;
    }
    *found = root(q, low, high);
    return found->balance.axial > 0;
}

// Looks for a balance with φ in [low, high]; the momentum balance must be of the assumed state.
static bool search(quest *q, double low, double high, bool brake, point *found) {
    q->brake = brake;
    point at_low = point_at(q, low), at_high = point_at(q, high);
    if (!changes_sign(at_low, at_high)) return false;
    *found = root(q, at_low, at_high);
    return brake ? found->balance.axial < 0 : found->balance.axial > 0;
}

bough_induction bough_induction_solve(const bough_induction_options *options,
                                      const bough_element *element) {
    const bough_element *e = element;
    if (bough_induction_is_fixed(options, e->tip_factor, e->hub_factor)) {
        return (bough_induction){.axial = 1};
    }
    problem posed = problem_of(weights_of(options), *e);
    posed.wake = wake_of(options, e->skew);
    if (!is_balanced(posed, e->inflow_x, e->inflow_y)) return (bough_induction){0};
    quest q = {options, e->polar, posed, false, 0};
    point p;
    bool found = search_windmill(&q, &p) || search(&q, -BOUGH_PI / 4, -clearance, true, &p) ||
                 search(&q, BOUGH_PI / 2, BOUGH_PI - clearance, false, &p);
    bough_induction i = {0};
    if (found) i = induction_of(weights_of(options), p.flow, p.balance);
    i.evaluations = q.evaluations;
    return i;
}

// theory (79) for all elements, side by side in vector lanes: first all roots next to a guess, then the
// others, interval by interval.
#include "aero/rotor/induction_balance.h"

enum { MOST_LANES = 32, MOST_STEPS = 100 };

typedef double lane[MOST_LANES];

typedef struct lanes {
    // of the problem; aligned, so that no vector of any lane lies across cache lines
    _Alignas(8 * BOUGH_LANES) lane sign_x;
    lane sign_y, slope, density, cone, tip_factor, hub_factor, twist, skew_normal, skew_chord;
    lane lift_slope, free_angle;
    lane attached;   // 1: the guess is the attached angle
    lane open, here; // 1: no root is known yet; it is taken to be in reach
    // the point last evaluated
    lane phi, s, c, loss, alpha, lift, drag, residual, axial, swirl;
    // the bracket and the fraction of the next step in it: 0 when the root is found
    lane a, fa, b, fb, step;
    const bough_induction_options *options;
    const bough_polar *const *polar;
    wake wake;
    int n;
    int n_live, live[MOST_LANES / BOUGH_LANES]; // groups of lanes, by their first, still to do
    bool brake;                                 // propeller brake state, φ < 0
    int evaluations;
} lanes;

BOUGH_INLINE problem load_problem(const lanes *x, int i) {
    return (problem){x->sign_x[i],      x->sign_y[i],     x->slope[i],      x->density[i],
                     x->cone[i],        x->tip_factor[i], x->hub_factor[i], x->twist[i],
                     x->skew_normal[i], x->skew_chord[i], x->wake};
}

BOUGH_INLINE flow load_flow(const lanes *x, int i) {
    return (flow){x->s[i], x->c[i], x->loss[i], x->alpha[i]};
}

BOUGH_INLINE balance load_balance(const lanes *x, int i) {
    return (balance){x->residual[i], x->axial[i], x->swirl[i]};
}

// The stages of an evaluation, each for a group of lanes.
BOUGH_INLINE void enter_flow(int first, lanes *restrict x) {
#pragma omp simd
    for (int i = first; i < first + BOUGH_LANES; i++) {
        flow w = flow_at(load_problem(x, i), x->phi[i]);
        x->s[i] = w.s;
        x->c[i] = w.c;
        x->loss[i] = w.loss;
        x->alpha[i] = w.alpha;
    }
}

BOUGH_INLINE void evaluate_polars(int first, lanes *restrict x) {
    for (int i = first; i < first + BOUGH_LANES; i++) {
        bough_coefficients k = bough_polar_at(x->polar[i], x->alpha[i]);
        x->lift[i] = k.lift;
        x->drag[i] = k.drag;
    }
}

BOUGH_INLINE void weigh(bough_high_thrust high_thrust, bool brake, bool skewed, weights o, int first,
                        lanes *restrict x) {
#pragma omp simd
    for (int i = first; i < first + BOUGH_LANES; i++) {
        balance b = balance_of(high_thrust, brake, skewed, o, load_problem(x, i), load_flow(x, i), x->lift[i],
                               x->drag[i]);
        x->residual[i] = b.residual;
        x->axial[i] = b.axial;
        x->swirl[i] = b.swirl;
    }
}

BOUGH_INLINE void weigh_all(bough_high_thrust high_thrust, bool brake, bool skewed, lanes *restrict x) {
    weights o = weights_of(x->options);
    for (int g = 0; g < x->n_live; g++) weigh(high_thrust, brake, skewed, o, x->live[g], x);
}

// The options become constants of the loops.
BOUGH_INLINE void weigh_in(bool brake, lanes *restrict x) {
    if (x->options->high_thrust == BOUGH_HIGH_THRUST_BUHL) {
        weigh_all(BOUGH_HIGH_THRUST_BUHL, brake, false, x);
    } else if (x->options->skewed_momentum) {
        weigh_all(BOUGH_HIGH_THRUST_SMOOTH, brake, true, x);
    } else {
        weigh_all(BOUGH_HIGH_THRUST_SMOOTH, brake, false, x);
    }
}

// At x->phi. Stage by stage, so that the groups' chains of operations run beside each other.
static void evaluate(lanes *restrict x) {
    x->evaluations++;
    for (int g = 0; g < x->n_live; g++) enter_flow(x->live[g], x);
    for (int g = 0; g < x->n_live; g++) evaluate_polars(x->live[g], x);
    if (x->brake) {
        weigh_in(true, x);
    } else {
        weigh_in(false, x);
    }
}

// The groups in which a root is taken to be in reach.
static void list_live(lanes *x) {
    x->n_live = 0;
    for (int first = 0; first < x->n; first += BOUGH_LANES) {
        double any = 0;
        for (int i = first; i < first + BOUGH_LANES; i++) any += x->here[i];
        if (any > 0) x->live[x->n_live++] = first;
    }
}

// The problems of the elements from `first` on, and their first guesses.
static void take(const bough_elements *e, int first, lanes *restrict x) {
    weights o = weights_of(x->options);
    lane zero_lift;
    for (int i = 0; i < x->n; i++) {
        x->lift_slope[i] = x->polar[i]->slope;
        zero_lift[i] = x->polar[i]->zero_lift;
    }
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        problem p = problem_of(o, e, first + i);
        double limit = free_angle(p);
        double phi = attached_angle(p, x->lift_slope[i], zero_lift[i], limit);
        x->sign_x[i] = p.sign_x;
        x->sign_y[i] = p.sign_y;
        x->slope[i] = p.slope;
        x->density[i] = p.density;
        x->cone[i] = p.cone;
        x->tip_factor[i] = p.tip_factor;
        x->hub_factor[i] = p.hub_factor;
        x->twist[i] = p.twist;
        x->skew_normal[i] = p.skew_normal;
        x->skew_chord[i] = p.skew_chord;
        x->free_angle[i] = limit;
        // an element without balance is never open
        x->open[i] = x->here[i] = is_balanced(p, e->inflow_x[first + i], e->inflow_y[first + i]) ? 1 : 0;
        x->attached[i] = phi > 0 ? 1 : 0;
        x->phi[i] = phi > 0 ? phi : limit;
    }
}

// The point just evaluated becomes an end of the bracket.
static void set_first_end(lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        x->a[i] = x->phi[i];
        x->fa[i] = x->residual[i];
    }
}

// From there to where the bracket's other end may be.
static void go_near(lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        x->phi[i] = nearby(load_problem(x, i), x->attached[i], x->lift_slope[i], x->free_angle[i], x->phi[i],
                           load_flow(x, i), load_balance(x, i));
    }
}

// To the other end of the search where the bracket is still missing.
static void go_far(lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        double next = farther(x->attached[i], x->free_angle[i], x->phi[i], x->residual[i]);
        double missing = x->step[i] == 0 ? 1 : 0;
        x->a[i] = missing > 0 ? x->phi[i] : x->a[i];
        x->fa[i] = missing > 0 ? x->residual[i] : x->fa[i];
        x->phi[i] = missing > 0 ? next : x->phi[i];
    }
}

// Conditions are numbers, 1 or 0: the compiler does not vectorise all that can be done with bool.
BOUGH_INLINE double differ(double a, double b) {
    double above_a = a > 0 ? 1 : 0, above_b = b > 0 ? 1 : 0;
    return fabs(above_a - above_b);
}

// Whether a and the point just evaluated make a bracket: the first step in it where they do.
static double bracket(lanes *restrict x) {
    double missing = 0;
#pragma omp simd reduction(+ : missing)
    for (int i = 0; i < x->n; i++) {
        double fa = x->fa[i], fb = x->residual[i], chord = lane_clamp(fa / (fa - fb), 0.01, 0.99);
        double found = x->here[i] * differ(fa, fb);
        x->b[i] = x->phi[i];
        x->fb[i] = fb;
        x->step[i] = found * chord;
        missing += x->here[i] - found;
    }
    return missing;
}

static void keep_bracketed(lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) x->here[i] = x->step[i] > 0 ? 1 : 0;
}

// Next to the attached angle, whatever other roots there are, or, without it, to that without induction.
static void surround_guess(lanes *restrict x) {
    // windmill state
    x->brake = false;
    list_live(x);
    evaluate(x);
    // the guess is one end, a point beyond the likely root the other
    set_first_end(x);
    go_near(x);
    evaluate(x);
    if (bracket(x) == 0) return;
    // elements without a bracket: the far end
    go_far(x);
    evaluate(x);
    bracket(x);
    keep_bracketed(x);
}

// The windmill state up to the angle without induction, beyond it if there is no root below, the propeller
// brake state, and what is left.
enum { INTERVALS = 4, BEYOND = 1, BRAKE = 2 };

// Sets the angles of all elements to one end of an interval.
static void go_to_end(int interval, int end, lanes *restrict x) {
    for (int i = 0; i < x->n; i++) {
        double middle = x->free_angle[i];
        const double ends[INTERVALS][2] = {{clearance, middle},
                                           {middle, BOUGH_PI / 2},
                                           {-BOUGH_PI / 4, -clearance},
                                           {BOUGH_PI / 2, BOUGH_PI - clearance}};
        x->phi[i] = ends[interval][end];
    }
}

static void surround_interval(int interval, lanes *restrict x) {
    for (int i = 0; i < x->n; i++) {
        bool had_root = interval == BEYOND && x->here[i] > 0;
        x->here[i] = had_root ? 0 : x->open[i];
    }
    // both ends of the interval
    x->brake = interval == BRAKE;
    list_live(x);
    go_to_end(interval, 1, x);
    evaluate(x);
    set_first_end(x);
    go_to_end(interval, 0, x);
    evaluate(x);
    bracket(x);
    keep_bracketed(x);
}

// Shrinks a group's brackets to the points just evaluated; how many roots are still to be found.
BOUGH_INLINE double shrink(int first, lanes *restrict x) {
    double open = 0;
#pragma omp simd reduction(+ : open)
    for (int i = first; i < first + BOUGH_LANES; i++) {
        double was_open = x->step[i] > 0 ? 1 : 0;
        double a = x->phi[i], fa = x->residual[i], other = x->a[i], fother = x->fa[i];
        double far = x->b[i], ffar = x->fb[i], crossed = differ(fa, fother);
        // the new point replaces the end of its own sign; the third point serves the interpolation
        double b = crossed > 0 ? other : far, fb = crossed > 0 ? fother : ffar;
        double c = crossed > 0 ? far : other, fc = crossed > 0 ? ffar : fother;
        double width = fabs(b - a), t = root_fraction(a, fa, b, fb, c, fc);
        double near = fabs(fa) < fabs(fb) ? fabs(t) * width : 1, going = was_open;
        going = near < precision ? 0 : going;
        going = width < 2 * precision ? 0 : going;
        going = fa == 0 ? 0 : going;
        x->a[i] = was_open > 0 ? a : other;
        x->fa[i] = was_open > 0 ? fa : fother;
        x->b[i] = was_open > 0 ? b : far;
        x->fb[i] = was_open > 0 ? fb : ffar;
        double step = lane_clamp(t, precision / width, 1 - precision / width);
        x->step[i] = going > 0 ? step : 0;
        open += going > 0 ? 1 : 0;
    }
    return open;
}

BOUGH_INLINE void step(int first, lanes *restrict x) {
#pragma omp simd
    for (int i = first; i < first + BOUGH_LANES; i++) {
        double next = x->a[i] + x->step[i] * (x->b[i] - x->a[i]);
        x->phi[i] = x->step[i] > 0 ? next : x->phi[i];
    }
}

static void find_roots(lanes *restrict x) {
    list_live(x);
    for (int k = 0; k < MOST_STEPS && x->n_live > 0; k++) {
        for (int g = 0; g < x->n_live; g++) step(x->live[g], x);
        evaluate(x);
        // groups whose roots are found are left out
        int left = 0;
        for (int g = 0; g < x->n_live; g++)
            if (shrink(x->live[g], x) > 0) x->live[left++] = x->live[g];
        x->n_live = left;
    }
}

// Takes the roots at which the balance is of the state that was assumed; how many are still to be found.
static double take_roots(lanes *restrict x, double *restrict axial, double *restrict tangential,
                         double *restrict loss) {
    weights o = weights_of(x->options);
    double sign = x->brake ? -1 : 1, open = 0;
#pragma omp simd reduction(+ : open)
    for (int i = 0; i < x->n; i++) {
        induction found = induction_of(o, load_flow(x, i), load_balance(x, i));
        double good = x->open[i] * x->here[i] * (sign * x->axial[i] > 0 ? 1 : 0);
        axial[i] = good > 0 ? found.axial : axial[i];
        tangential[i] = good > 0 ? found.tangential : tangential[i];
        loss[i] = good > 0 ? x->loss[i] : loss[i];
        x->open[i] -= good;
        open += x->open[i];
    }
    return open;
}

// Elements from `first` on, at most MOST_LANES of them. Without a balance there is no induction.
static void solve_some(const bough_elements *e, int first, lanes *restrict x, double *restrict axial,
                       double *restrict tangential, double *restrict loss) {
    for (int i = 0; i < x->n; i++) {
        double tip = e->tip_factor[first + i], hub = e->hub_factor[first + i];
        axial[i] = bough_induction_is_fixed(x->options, tip, hub) ? 1 : 0;
        tangential[i] = loss[i] = 0;
    }
    // roots next to the guesses, then interval by interval where one is missing
    take(e, first, x);
    surround_guess(x);
    find_roots(x);
    double open = take_roots(x, axial, tangential, loss);
    for (int k = 0; k < INTERVALS && open > 0; k++) {
        surround_interval(k, x);
        find_roots(x);
        open = take_roots(x, axial, tangential, loss);
    }
}

int BOUGH_AT_LEVEL(bough_induction_solve)(const bough_induction_options *options,
                                          const bough_elements *elements, double *axial, double *tangential,
                                          double *loss) {
    int evaluations = 0;
    for (int first = 0; first < elements->n; first += MOST_LANES) {
        int left = elements->n - first;
        lanes x; // only what is used of it
        x.options = options;
        x.polar = elements->polar + first;
        x.wake = wake_of(options, elements->skew);
        x.n = left < MOST_LANES ? left : MOST_LANES;
        x.evaluations = 0;
        solve_some(elements, first, &x, axial + first, tangential + first, loss + first);
        evaluations += x.evaluations;
    }
    return evaluations;
}

// The search of induction.c for many elements side by side, in vector lanes: that of the windmill
// state, next to attached flow or in all its range. The rest goes one by one.
#include "aero/induction_balance.h"

enum { MOST_LANES = 32, MOST_STEPS = 100 };

typedef double lane[MOST_LANES];

static const double NOWHERE = 0, ATTACHED = 1, BELOW = 2, ABOVE = 3; // φ₀

typedef struct lanes {
    const bough_induction_options *options;
    const bough_polar *const *polar;
    int n;
    lane sign_x, sign_y, slope, density, cone, tip_factor, hub_factor, twist; // of the problem
    lane free_angle;
    lane search; // which search of the windmill state is under way, or NOWHERE
    // the point last evaluated
    lane phi, s, c, loss, alpha, lift, drag, residual, axial, swirl;
    // the bracket, and where to go in it: none when the root is found
    lane a, fa, b, fb, step;
} lanes;

static inline problem load_problem(const lanes *x, int i) {
    return (problem){x->sign_x[i], x->sign_y[i], x->slope[i],      x->density[i],
                     x->cone[i],   x->tip_factor[i], x->hub_factor[i], x->twist[i]};
}

static bough_element element_of(const bough_elements *e, int i) {
    return (bough_element){e->polar[i], e->solidity[i], e->tip_factor[i], e->hub_factor[i],
                           e->cone[i],  e->twist[i],    e->inflow_x[i],   e->inflow_y[i]};
}

static inline void balance_all(bough_high_thrust high_thrust, weights o, lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        flow w = {x->s[i], x->c[i], x->loss[i], x->alpha[i]};
        balance b = balance_of(high_thrust, false, o, load_problem(x, i), w, x->lift[i],
                               x->drag[i]);
        x->residual[i] = b.residual;
        x->axial[i] = b.axial;
        x->swirl[i] = b.swirl;
    }
}

// At x->phi.
static void evaluate(lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        flow w = flow_at(load_problem(x, i), x->phi[i]);
        x->s[i] = w.s;
        x->c[i] = w.c;
        x->loss[i] = w.loss;
        x->alpha[i] = w.alpha;
    }
    for (int i = 0; i < x->n; i++) {
        bough_coefficients k = bough_polar_at(x->polar[i], x->alpha[i]);
        x->lift[i] = k.lift;
        x->drag[i] = k.drag;
    }
    weights o = weights_of(x->options);
    if (x->options->high_thrust == BOUGH_HIGH_THRUST_BUHL) {
        balance_all(BOUGH_HIGH_THRUST_BUHL, o, x);
    } else {
        balance_all(BOUGH_HIGH_THRUST_SMOOTH, o, x);
    }
}

// Poses the problems of the elements from `first` on, and where to begin with them.
static void take(const bough_elements *e, int first, lanes *restrict x) {
    weights o = weights_of(x->options);
    lane lift_slope, zero_lift;
    for (int i = 0; i < x->n; i++) {
        lift_slope[i] = x->polar[i]->slope;
        zero_lift[i] = x->polar[i]->zero_lift;
    }
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        int k = first + i;
        double vx = e->inflow_x[k], vy = e->inflow_y[k];
        problem p = problem_of(o, e->solidity[k], e->cone[k], e->tip_factor[k], e->hub_factor[k],
                               e->twist[k], vx, vy);
        double limit = free_angle(p), phi = attached_angle(p, lift_slope[i], zero_lift[i], limit);
        double search = phi > 0 ? ATTACHED : BELOW;
        x->sign_x[i] = p.sign_x;
        x->sign_y[i] = p.sign_y;
        x->slope[i] = p.slope;
        x->density[i] = p.density;
        x->cone[i] = p.cone;
        x->tip_factor[i] = p.tip_factor;
        x->hub_factor[i] = p.hub_factor;
        x->twist[i] = p.twist;
        x->free_angle[i] = limit;
        x->search[i] = is_balanced(p, vx, vy) ? search : NOWHERE;
        x->phi[i] = phi > 0 ? phi : limit;
        x->step[i] = 0;
    }
}

// From the point just evaluated, which becomes a, to where the bracket's other end may be.
static void go_on(double share, lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        double near = further(x->phi[i], x->residual[i], share, x->free_angle[i]);
        double edge = x->search[i] == BELOW ? clearance : BOUGH_PI / 2;
        double next = x->search[i] == ATTACHED ? near : edge;
        double free = x->step[i] == 0 ? 1 : 0; // no bracket there yet
        x->a[i] = free > 0 ? x->phi[i] : x->a[i];
        x->fa[i] = free > 0 ? x->residual[i] : x->fa[i];
        x->phi[i] = free > 0 ? next : x->phi[i];
    }
}

// Conditions are numbers, 1 or 0: the compiler does not vectorise all that can be done with bool.
static inline double differ(double a, double b) {
    double above_a = a > 0 ? 1 : 0, above_b = b > 0 ? 1 : 0;
    return fabs(above_a - above_b);
}

// Whether a and the point just evaluated make a bracket: the first step in it where they do.
static double bracket(lanes *restrict x) {
    double missing = 0;
#pragma omp simd reduction(+ : missing)
    for (int i = 0; i < x->n; i++) {
        double fa = x->fa[i], fb = x->residual[i], chord = lane_clamp(fa / (fa - fb), 0.01, 0.99);
        double start = x->search[i] == ATTACHED ? chord : 0.5, found = differ(fa, fb);
        x->b[i] = x->phi[i];
        x->fb[i] = fb;
        x->step[i] = x->search[i] != NOWHERE ? found * start : 0;
        missing += x->search[i] != NOWHERE ? 1 - found : 0;
    }
    return missing;
}

// Where a search has failed: the attached one goes on, that below φ₀ is followed by that above.
static void turn_round(lanes *restrict x) {
#pragma omp simd
    for (int i = 0; i < x->n; i++) {
        bool turn = x->step[i] == 0 && x->search[i] == BELOW;
        x->phi[i] = turn ? x->a[i] : x->phi[i];
        x->residual[i] = turn ? x->fa[i] : x->residual[i];
        x->search[i] = turn ? ABOVE : x->search[i];
    }
}

static void surround(lanes *restrict x) {
    evaluate(x);
    go_on(first_share, x);
    evaluate(x);
    if (bracket(x) == 0) return;
    turn_round(x);
    go_on(second_share, x);
    evaluate(x);
    if (bracket(x) == 0) return;
#pragma omp simd
    for (int i = 0; i < x->n; i++) x->search[i] = x->step[i] > 0 ? x->search[i] : NOWHERE;
}

// Shrinks the brackets to the points just evaluated; how many roots are still to be found.
static double shrink(lanes *restrict x) {
    double open = 0;
#pragma omp simd reduction(+ : open)
    for (int i = 0; i < x->n; i++) {
        double was_open = x->step[i] > 0 ? 1 : 0;
        double a = x->phi[i], fa = x->residual[i], other = x->a[i], fother = x->fa[i];
        double far = x->b[i], ffar = x->fb[i], crossed = differ(fa, fother);
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

static void find_roots(lanes *restrict x) {
    double open = 1;
    for (int k = 0; k < MOST_STEPS && open > 0; k++) {
#pragma omp simd
        for (int i = 0; i < x->n; i++) {
            double next = x->a[i] + x->step[i] * (x->b[i] - x->a[i]);
            x->phi[i] = x->step[i] > 0 ? next : x->phi[i];
        }
        evaluate(x);
        open = shrink(x);
    }
}

// Elements from `first` on, at most MOST_LANES of them.
static void solve_some(const bough_elements *e, int first, lanes *restrict x, double *axial,
                       double *tangential, double *loss) {
    const bough_induction_options options = *x->options;
    take(e, first, x);
    surround(x);
    find_roots(x);
    for (int i = 0; i < x->n; i++) {
        flow w = {x->s[i], x->c[i], x->loss[i], x->alpha[i]};
        balance b = {x->residual[i], x->axial[i], x->swirl[i]};
        bough_induction found = induction_of(&options, w, b);
        if (!(x->search[i] != NOWHERE && b.axial > 0)) {
            bough_element element = element_of(e, first + i);
            found = bough_induction_solve(&options, &element);
        }
        axial[first + i] = found.axial;
        tangential[first + i] = found.tangential;
        loss[first + i] = found.loss;
    }
}

void bough_induction_solve_all(const bough_induction_options *options,
                               const bough_elements *elements, double *axial, double *tangential,
                               double *loss) {
    for (int first = 0; first < elements->n; first += MOST_LANES) {
        int left = elements->n - first;
        lanes x; // only what is used of it
        x.options = options;
        x.polar = elements->polar + first;
        x.n = left < MOST_LANES ? left : MOST_LANES;
        solve_some(elements, first, &x, axial, tangential, loss);
    }
}

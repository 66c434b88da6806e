#include "cosim/error_estimate.h"

#include "cosim/coupled.h"
#include "cosim/port.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { BATCH = 32, WITHIN = 3 };
static const double longest_batch = 0.25; // the members are linearised once in it [s]
static const double longest_step = 0.02;  // of the α method [s]

// Generalised-α of a first-order system (Jansen, Whiting, Hulbert 2000): one solution a step, which
// keeps the amplitude of resolved modes and takes that of others times ρ∞.
typedef struct alpha_method {
    double h;      // [s]
    double m, f;   // α_m, α_f = γ = 1/(1 + ρ∞)
    double factor; // g = α_f γ h/α_m: it solves with I − g J
} alpha_method;

static const double own_radius = 0.6;
static const double most_radius = 0.8, least_radius = 0.5; // with the factors of a scheme

static alpha_method method_of(double h, double radius) {
    double f = 1 / (1 + radius), m = 0.5 * (3 - radius) * f;
    return (alpha_method){h, m, f, f * f * h / m};
}

struct bough_error_estimate {
    const bough_assembly *assembly;
    const bough_member *whole; // all members as one system: no defects, only own errors; or NULL
    // the batch
    int n_step;
    double start[BATCH], end[BATCH]; // [s]
    double *defect;                  // (BATCH × 4 × n_input) cubics as in bough_signal
    double *own;                     // (BATCH × n_state) what the members' own steps erred by
    double *own_sum;                 // (n_state) the same over the whole run, magnitudes
    long batches;
    bool lost; // a member could not be linearised
    // reconstruction of the inputs
    int n_point;        // synchronisation points before the step that no jump parts from it
    bough_signal curve; // (n_input) through them and the step's end
    double *cubic;      // (n_input) its last coefficient in the step before, where known within
    double *size;       // (n_input) of a vector's first: its largest norm so far
    // the error
    double *error, *rate; // (n_state) ε, ε̇
    double *input_worst;  // (n_input) largest |P (C ε + D υ)|
    // linearisation
    bough_coupled *coupled;
    double *at; // (n_state) where
    // scratch
    double *x;              // (n_state)
    double *outside, *seen; // (n_input)
    double *mean;           // (n_input) of δ over a step
    alpha_method method;    // of the batch
    int step;               // of the batch, in progress
};

// -- building -------------------------------------------------------------------------------------

static void take(bough_error_estimate *e, bough_arena *arena) {
    const bough_assembly *a = e->assembly;
    size_t n = (size_t)a->n_state, n_input = (size_t)a->n_input;
    e->defect = bough_arena_doubles(arena, BATCH * 4 * n_input);
    e->curve = bough_port_signal(arena, a->n_input);
    bough_arena_each(arena, n_input, &e->cubic, &e->input_worst, &e->size, &e->outside, &e->seen, &e->mean);
    e->own = bough_arena_doubles(arena, BATCH * n);
    bough_arena_each(arena, n, &e->own_sum, &e->error, &e->rate, &e->at, &e->x);
}

bough_error_estimate *bough_error_estimate_create(bough_arena *arena, const bough_coupling *c) {
    bough_error_estimate *e = bough_arena_take(arena, sizeof *e);
    e->assembly = c->assembly;
    take(e, arena);
    e->n_point = 1;
    e->whole = c->whole;
    e->coupled = bough_coupled_create(arena, c->assembly, c->pool);
    return e;
}

// -- defects --------------------------------------------------------------------------------------

// The values within the step are more accurate.
static void reconstruct_within(bough_error_estimate *e, const bough_coupling *c) {
    const bough_assembly *a = e->assembly;
    double time[WITHIN + 1] = {c->t0};
    e->curve.t0 = c->t0;
    e->curve.t1 = c->t1;
    const double *value[WITHIN + 1];
    for (int k = 0; k < WITHIN; k++) time[k + 1] = c->t0 + c->within_time[k] * (c->t1 - c->t0);
    for (int j = 0; j < a->n_input; j++) {
        value[0] = c->past[1] + j;
        for (int k = 0; k < WITHIN; k++) value[k + 1] = c->within + k * a->n_output + a->source[j];
        bough_port_polynomial(&e->curve, j, 1, WITHIN + 1, time, value);
    }
}

// A cubic through Lobatto points misses a quartic, whose coefficient is a quarter of the change of the
// cubics' last ones. It acts as a share of that, held, would: 5e-4 on an oscillation of a radian in a
// step and less on slower ones, but 0.1 was measured where a light body hangs between stiff ones.
static const double lobatto_share = 0.1;

static void add_remainder(bough_error_estimate *e, int j, double *defect) {
    double cubic = e->curve.coefficient[3 * e->curve.n + j];
    *defect += lobatto_share * (cubic - e->cubic[j]) / 4;
    e->cubic[j] = cubic;
}

// The obtained inputs: the polynomial through the last synchronisation points, none of them before a jump.
static void reconstruct(bough_error_estimate *e, const bough_coupling *c) {
    int past = c->restart ? 1 : e->n_point;
    const double *value[BOUGH_PAST];
    for (int p = 0; p <= past; p++) value[p] = c->past[p];
    e->curve.t0 = c->t0;
    e->curve.t1 = c->t1;
    bough_port_polynomial(&e->curve, 0, e->curve.n, past + 1, c->past_time, value);
}

static void keep_defects(bough_error_estimate *e, const bough_coupling *c) {
    const bough_assembly *a = e->assembly;
    int n = e->whole ? 0 : a->n_input;
    double *defect = e->defect + (size_t)e->n_step * 4 * (size_t)n;
    for (int i = 0; i < a->n_member; i++) {
        const bough_signal *s = &c->signal[i];
        for (int j = 0, k = a->input_offset[i]; j < s->n && n > 0; j++, k++) {
            for (int p = 0; p < 4; p++) {
                double difference = s->coefficient[p * s->n + j] - e->curve.coefficient[p * n + k];
                defect[p * n + k] = c->followed[k] ? 0 : difference;
            }
            if (c->n_within > 0 && !c->followed[k]) add_remainder(e, k, defect + k);
        }
    }
    e->start[e->n_step] = c->t0;
    e->end[e->n_step] = c->t1;
    e->n_step++;
}

// Factor of the error of all members as one system, where steps are long for stiff members: on land.yaml
// and power.yaml the error is 0.7 to 6 of the method's own estimate.
static const double whole_share = 2.5;

// Before the step is counted.
static void keep_own_errors(bough_error_estimate *e) {
    const bough_assembly *a = e->assembly;
    assert(e->n_step < BATCH);
    const double share = e->whole ? whole_share : 1;
    double *slot = e->own + (size_t)e->n_step * (size_t)a->n_state;
    for (int i = 0; i < a->n_member; i++) {
        const bough_member *m = a->member[i];
        double *restrict error = e->whole ? e->whole->own_error : m->own_error;
        if (e->whole && error) error += a->state_offset[i];
        double *restrict sum = slot + a->state_offset[i], *restrict all = e->own_sum + a->state_offset[i];
        int n = m->system.n_state;
        if (error == NULL) {
            memset(sum, 0, (size_t)n * sizeof *sum);
            continue;
        }
#pragma omp simd
        for (int k = 0; k < n; k++) {
            sum[k] = share * error[k];
            all[k] += fabs(error[k]);
            error[k] = 0;
        }
    }
}

void bough_error_estimate_step(bough_error_estimate *e, bough_coupling *c) {
    if (c->n_within > 0) {
        reconstruct_within(e, c);
    } else if (!e->whole) {
        reconstruct(e, c);
    }
    keep_own_errors(e);
    keep_defects(e, c);
    e->n_point = c->restart ? 2 : e->n_point + 1 < BOUGH_PAST ? e->n_point + 1 : BOUGH_PAST - 1;
    if (e->n_step == BATCH || c->t1 - e->start[0] >= longest_batch) {
        bough_error_estimate_finish(e, c);
    }
}

// -- of one step ----------------------------------------------------------------------------------

// Squares of the vectors' norms: square (n_input), in a vector's first.
static void square_norms(const bough_error_estimate *e, const double *x, double *square) {
    for (int j = 0; j < e->assembly->n_input; j++) {
        if (e->assembly->vector[j] == j) square[j] = 0;
        square[e->assembly->vector[j]] += x[j] * x[j];
    }
}

// Largest norm of a vector in x (n_input) relative to its size.
static double worst_relative(bough_error_estimate *e, const double *x) {
    double *square = e->outside, worst = 0;
    square_norms(e, x, square);
    for (int j = 0; j < e->assembly->n_input; j++) {
        if (e->assembly->vector[j] != j || !(square[j] > 0)) continue;
        double relative = sqrt(square[j]) / e->size[j];
        worst = relative <= worst ? worst : relative; // a NaN wins
    }
    return worst;
}

// Largest relative difference of seen and reconstructed inputs at t.
static double defect_near(bough_error_estimate *e, const bough_coupling *c, double t) {
    const bough_assembly *a = e->assembly;
    bough_signal_value(&e->curve, t, e->seen);
    for (int i = 0; i < a->n_member; i++) {
        bough_signal_value(&c->signal[i], t, e->outside + a->input_offset[i]);
    }
    for (int j = 0; j < a->n_input; j++) {
        e->seen[j] = c->followed[j] ? 0 : e->outside[j] - e->seen[j];
    }
    return worst_relative(e, e->seen);
}

// Largest relative change over the step. After a start or a jump no curvature is known yet; a
// quarter of the change stands in for it.
static double change_over(bough_error_estimate *e, const bough_coupling *c) {
    for (int j = 0; j < e->assembly->n_input; j++) {
        e->seen[j] = c->followed[j] ? 0 : c->input[j] - c->past[1][j];
    }
    return worst_relative(e, e->seen);
}

double bough_error_estimate_defect(bough_error_estimate *e, const bough_coupling *c) {
    square_norms(e, c->input, e->outside);
    for (int j = 0; j < e->assembly->n_input; j++) {
        if (e->assembly->vector[j] == j) e->size[j] = fmax(e->size[j], sqrt(e->outside[j]));
    }
    reconstruct(e, c);
    double end = defect_near(e, c, c->t1);
    double middle = defect_near(e, c, 0.5 * (c->t0 + c->t1));
    if (!isfinite(end) || !isfinite(middle)) return HUGE_VAL;
    bool first = c->restart || e->n_point == 1;
    return fmax(fmax(end, middle), first ? 0.25 * change_over(e, c) : 0);
}

// -- propagation ----------------------------------------------------------------------------------

static bough_signal defect_of(const bough_error_estimate *e, int step) {
    int n = e->assembly->n_input;
    return (bough_signal){.n = n,
                          .t0 = e->start[step],
                          .t1 = e->end[step],
                          .coefficient = e->defect + (size_t)step * 4 * (size_t)n};
}

// Uses the scheme's factors, which fix g, if a number of steps goes with them that is not much larger than
// `steps`. ρ∞ follows from g/h = 2/((1 + ρ∞)(3 − ρ∞)). The trapezoidal rule's g = h/2 would ask for 1: with
// most_radius the time scale of ε has an error of 1 %.
static bool borrow(bough_error_estimate *e, const bough_coupling *c, double span, double *steps) {
    double g = c->interface_gamma, least = method_of(1, most_radius).factor;
    double n = fmax(*steps, ceil(least * span / g * (1 - 0.011)));
    if (!c->interface || !(n <= 3 * *steps)) return false;
    double ratio = n * g / span, radius = fmin(1 - sqrt(fmax(4 - 2 / ratio, 0)), most_radius);
    if (!(radius >= least_radius)) return false;
    e->method = method_of(g / method_of(1, radius).factor, radius);
    bough_coupled_borrow(e->coupled, c->interface, c->t1, e->at, c->input, g);
    *steps = n;
    return true;
}

// Linearises at the members' current states, for so many steps or more.
static bool linearise(bough_error_estimate *e, bough_coupling *c, double span, double *steps) {
    bough_assembly_states(e->assembly, e->at);
    if (borrow(e, c, span, steps)) return true;
    e->method = method_of(span / *steps, own_radius);
    bough_status status = bough_coupled_setup(e->coupled, c->t1, e->at, c->input, e->method.factor);
    return bough_is_ok(&status);
}

// The mean of δ over [t, t + h], by Gauss' rule on every macro step that shares in it; `step` is
// the first of them and on return the last.
static void find_mean(bough_error_estimate *e, double t, double h) {
    static const double node[] = {0.2113248654051871, 0.7886751345948129};
    int n = e->whole ? 0 : e->assembly->n_input;
    memset(e->mean, 0, (size_t)n * sizeof(double));
    for (;; e->step++) {
        bough_signal defect = defect_of(e, e->step);
        double a = fmax(t, defect.t0), b = fmin(t + h, defect.t1), share = 0.5 * (b - a) / h;
        for (int g = 0; g < 2; g++) {
            bough_signal_value(&defect, a + node[g] * (b - a), e->outside);
            for (int j = 0; j < n; j++) e->mean[j] += share * e->outside[j];
        }
        if (defect.t1 >= t + h || e->step == e->n_step - 1) return;
    }
}

// The members' own errors in the macro step in progress, and the time it lasts.
static const double *own_errors(const bough_error_estimate *e, double *time) {
    *time = e->end[e->step] - e->start[e->step];
    return e->own + (size_t)e->step * (size_t)e->assembly->n_state;
}

// One step: x is ε at t + α_f h,
//     (I − g J) x = ε + (α_f h (1 − γ) − g (1 − α_m)) ε̇ + g (B δ + s),
// s the rate at which the members' own steps err in the macro step in progress.
static void advance(bough_error_estimate *e) {
    const alpha_method *a = &e->method;
    int n = e->assembly->n_state;
    double time, h = a->h, part = a->f, kept = part * h * (1 - part), own = 1 / (part * part * h);
    const double *restrict erring = own_errors(e, &time);
    double carried = kept - a->factor * (1 - a->m), added = a->factor / time;
    double *restrict x = e->x, *restrict error = e->error, *restrict rate = e->rate;
#pragma omp simd
    for (int k = 0; k < n; k++) x[k] = error[k] + carried * rate[k] + added * erring[k];
    bough_coupled_solve_driven(e->coupled, e->mean, e->x);
#pragma omp simd
    for (int k = 0; k < n; k++) {
        double now = own * (x[k] - error[k] - kept * rate[k]);
        error[k] += h * (rate[k] + part * (now - rate[k]));
        rate[k] = now;
    }
    for (int j = 0; j < e->assembly->n_input; j++) {
        e->input_worst[j] = fmax(e->input_worst[j], fabs(e->coupled->change[j] - e->mean[j]));
    }
}

static bool propagate(bough_error_estimate *e, bough_coupling *c) {
    double start = e->start[0], span = e->end[e->n_step - 1] - start;
    double steps = fmax(e->n_step, ceil(span / longest_step - 1e-6));
    if (!linearise(e, c, span, &steps)) return false;
    double h = span / steps;
    e->step = 0;
    for (int k = 0; k < (int)steps; k++) {
        find_mean(e, start + k * h, h);
        advance(e);
    }
    return true;
}

void bough_error_estimate_finish(bough_error_estimate *e, bough_coupling *c) {
    if (e->n_step > 0 && !e->lost) e->lost = !propagate(e, c);
    if (e->n_step > 0) e->batches++;
    e->n_step = 0;
}

// Each batch makes its own factors.
void bough_error_estimate_snapshot(bough_error_estimate *e, bough_snapshot *s) {
    const bough_assembly *a = e->assembly;
    bough_snapshot_take(s, &e->n_step, sizeof e->n_step);
    bough_snapshot_doubles(s, e->start, BATCH);
    bough_snapshot_doubles(s, e->end, BATCH);
    bough_snapshot_doubles(s, e->defect, BATCH * 4 * a->n_input);
    bough_snapshot_doubles(s, e->own, BATCH * a->n_state);
    bough_snapshot_take(s, &e->batches, sizeof e->batches);
    bough_snapshot_take(s, &e->lost, sizeof e->lost);
    bough_snapshot_take(s, &e->n_point, sizeof e->n_point);
    bough_snapshot_doubles(s, e->cubic, a->n_input);
    bough_snapshot_doubles(s, e->size, a->n_input);
    bough_snapshot_doubles(s, e->own_sum, a->n_state);
    bough_snapshot_doubles(s, e->error, a->n_state);
    bough_snapshot_doubles(s, e->rate, a->n_state);
    bough_snapshot_doubles(s, e->input_worst, a->n_input);
}

// -- answers --------------------------------------------------------------------------------------

long bough_error_estimate_batches(const bough_error_estimate *e) { return e->batches; }

const double *bough_error_estimate_states(const bough_error_estimate *e) { return e->lost ? NULL : e->error; }

double bough_error_estimate_own_share(const bough_error_estimate *e) {
    double own = 0, whole = 0;
    for (int i = 0; i < e->assembly->n_member; i++) {
        const bough_system *s = &e->assembly->member[i]->system;
        for (int k = 0, j = e->assembly->state_offset[i]; k < s->n_state; k++, j++) {
            own = fmax(own, e->own_sum[j] / s->scale[k]);
            whole = fmax(whole, fabs(e->error[j]) / s->scale[k]);
        }
    }
    return whole > 0 ? own / whole : 0;
}

double bough_error_estimate_input(const bough_error_estimate *e, int j) {
    return e->lost ? (double)NAN : BOUGH_ERROR_SAFETY * e->input_worst[j];
}

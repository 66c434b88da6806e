// The detection of growth uses the interface defect: the force obtained at T_{k+1} minus the force applied
// to its receiver. An explicit coupling beyond its limit makes the defect grow exponentially, at rates as
// slow as 0.2 per second and together with physical oscillations. The defect is therefore reduced to its
// maxima over windows of two lengths. A sequence of growing windows counts as an instability only if
//   - the total growth is large (limit below),
//   - it does not slow down: the later half of the run grows at least 0.7 times as much as the
//     earlier half in the logarithm, which a ramp, a start-up or any low power of time does not, and
//   - the defect is no longer small against the force itself.
// The detection needs the time of this growth: at +0.8 per second about nine seconds. It cannot distinguish
// numerical from physical exponential growth, and it misses growth with beats within its windows.
//
// The bound on the error itself (error_bound.h) detects an instability that the error of the start-up hides,
// or that saturates before it has grown so far. Before the run ends, the eigenvalues about the current state
// must confirm that the coupling is the cause.
//
// Implicit couplings may grow without a defect, and a few long steps give no sequence of windows. A force
// that has grown by a factor of 100 since its first steps is therefore analysed, and again after each
// further factor of 100: the coupling is the cause if its eigenvalues explain that growth and those of a
// shorter macro step do not.
#include "cosim/monitor.h"

#include "cosim/error_bound.h"
#include "cosim/scheme.h"
#include "cosim/stability.h"

#include <math.h>
#include <string.h>

enum { N_SCALE = 2, RING = 128, SHORTEST = 6 };
static const int window_steps[N_SCALE] = {16, 64};
static const double total_growth = 1e3;
enum { FIRST_STEPS = 8 };
static const double suspicious_growth = 100;

typedef struct window {
    double current;       // maximum so far in the open window
    double ring[RING];    // logarithms of the maxima of closed windows
    int count;            // steps in the open window
    int n;                // length of the run of growing windows, at most RING
    int last;             // newest entry of the ring
} window;

// Up to three components of one connection: a vector, measured by its norm.
typedef struct group {
    int first, count;   // inputs, numbered over all
    int to, from;       // members
    bool kinematic;
    double defect_max, defect_sum; // Σ of squares over the steps
    double magnitude;   // largest norm of the obtained value so far
    double window_sum;  // Σ of squares over the open window of the error bound
    double small;       // largest norm of the first steps with one, or when last looked into
    double small_time;  // then [s]
    int first_steps;    // of these so far
    window scale[N_SCALE];
} group;

// The error of one interface.
typedef struct account {
    bough_interface_energy total, closed; // closed: at the end of the last window
    double gross, exchanged; // in the open window: Σ|residual of a step|, ∫ |wrench · twist| dt [J]
    bough_error_bound bound;
} account;

struct bough_monitor {
    char advice[BOUGH_SCHEME_ADVICE]; // another scheme to try, or ""
    bool resting; // growth is not judged
    int n_group;
    group *group;
    long steps;
    account *account;      // (n_interface)
    int window_steps;      // in the open window
    double window_time;    // its length so far [s]
    int unbalanced;        // windows in a row that make or lose energy
    double *start;         // (n_input) scratch
};

static int receiver(const bough_assembly *a, int input) {
    int i = 0;
    while (input >= a->input_offset[i + 1]) i++;
    return i;
}

static void make_groups(bough_monitor *m, const bough_assembly *a) {
    for (int j = 0; j < a->n_input; j++) {
        if (a->vector[j] == j) {
            m->group[m->n_group++] = (group){.first = j,
                                             .to = receiver(a, j),
                                             .from = a->source_member[j],
                                             .kinematic = a->kinematic[j]};
        }
        m->group[m->n_group - 1].count++;
    }
}

bough_monitor *bough_monitor_create(bough_arena *arena, const bough_coupling *coupling) {
    const bough_assembly *a = coupling->assembly;
    size_t n_input = (size_t)a->n_input;
    bough_monitor *m = bough_arena_take(arena, sizeof *m);
    if (!a->opaque) bough_scheme_advise(coupling->scheme, m->advice);
    m->group = bough_arena_take(arena, n_input * sizeof *m->group);
    m->start = bough_arena_doubles(arena, n_input);
    m->account = bough_arena_take(arena, (size_t)a->n_interface * sizeof *m->account);
    make_groups(m, a);
    return m;
}

// -- non-finite values ----------------------------------------------------------------------------

// In vector lanes: what is not finite leaves a NaN.
static bool all_finite(const double *x, int n) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n; i++) sum += x[i] - x[i];
    return sum == 0;
}

static bough_status check_finite(const bough_monitor *m, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        if (all_finite(a->member[i]->state, s->n_state) &&
            all_finite(c->output + a->output_offset[i], s->n_output)) {
            continue;
        }
        return bough_fail(BOUGH_FAILED,
                          "%s: no finite state or output at %.6g s (scheme %s, macro step %.6g s); "
                          "try a smaller macro step%s",
                          s->name, c->t1, c->scheme->name, c->t1 - c->t0,
                          m->advice);
    }
    return bough_ok();
}

// -- growth ---------------------------------------------------------------------------------------

static double back(const window *w, int n) {
    return w->ring[(w->last - n + RING) % RING];
}

// Closes the window: the run of growing windows becomes longer or starts anew.
static void close_window(window *w, double floor) {
    double maximum = log(fmax(w->current, floor));
    bool grows = w->n > 0 && maximum > w->ring[w->last];
    w->last = (w->last + 1) % RING;
    w->ring[w->last] = maximum;
    w->n = !grows ? 1 : w->n < RING ? w->n + 1 : RING;
    w->current = 0;
    w->count = 0;
}

// Growth per window [ratio] when the run is exponential and long enough, else 0.
static double exponential_growth(const window *w) {
    for (int span = SHORTEST; span < w->n; span++) {
        int half = span / 2;
        double later = back(w, 0) - back(w, half);
        double total = back(w, 0) - back(w, 2 * half);
        if (total >= log(total_growth) && later >= 0.7 * (total - later)) {
            return exp(total / (2.0 * half));
        }
    }
    return 0;
}

static bough_status unstable(const bough_monitor *m, const bough_coupling *c, const group *g,
                             double per_step) {
    const bough_assembly *a = c->assembly;
    double h = c->t1 - c->t0;
    return bough_fail(BOUGH_FAILED,
                      "coupling of %s and %s is unstable at %.6g s: scheme %s, macro step %.6g s, "
                      "interface error grows by %.4g per step (%.3g per second); try a smaller "
                      "macro step%s",
                      a->member[g->from]->system.name, a->member[g->to]->system.name, c->t1, c->scheme->name, h,
                      per_step, log(per_step) / h,
                      m->advice);
}

static bough_status watch(const bough_monitor *m, const bough_coupling *c, group *g,
                          double defect) {
    double significant = c->scheme->explicit_forces ? 0.01 : 0.3;
    for (int k = 0; k < N_SCALE; k++) {
        window *w = &g->scale[k];
        w->current = fmax(w->current, defect);
        if (++w->count < window_steps[k]) continue;
        bool large = w->current > significant * g->magnitude;
        close_window(w, 1e-9 * g->magnitude + 1e-300);
        double growth = large ? exponential_growth(w) : 0;
        if (growth > 0) return unstable(m, c, g, pow(growth, 1.0 / window_steps[k]));
    }
    return bough_ok();
}

static double norm(const double *x, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += x[i] * x[i];
    return sqrt(sum);
}

// Growth of whatever grows fastest [1/s], about the current state; negative: nothing, or unknown.
static double fastest_growth(const bough_coupling *c, const bough_scheme_options *options,
                             double macro_step) {
    bough_stability s = {0};
    double fine = macro_step / 32; // what members ring at within a step counts too
    bough_status status = bough_stability_judge_by(c->assembly, options, macro_step, fine, &s);
    return bough_is_ok(&status) ? fmax(s.growth, s.rising) : -1;
}

static bough_status look_into(const bough_monitor *m, bough_coupling *c, const group *g) {
    static const int shorter[] = {8, 64};
    bough_scheme_options options = bough_scheme_options_in_use(c);
    double h = c->t1 - c->t0, growth = fastest_growth(c, &options, h), own = growth / 2;
    double needed = log(suspicious_growth) / (c->t1 - g->small_time); // for what was seen
    for (int k = 0; k < 2 && growth > needed / 2 && own >= growth / 2; k++) {
        own = fastest_growth(c, &options, h / shorter[k]);
    }
    if (own >= growth / 2) return bough_ok();
    const bough_assembly *a = c->assembly;
    return bough_fail(BOUGH_FAILED,
                      "coupling of %s and %s is unstable at %.6g s: scheme %s, macro step %.6g s, "
                      "their force has grown by more than a factor of 100, by %.3g per "
                      "second; try a smaller macro step%s",
                      a->member[g->from]->system.name, a->member[g->to]->system.name, c->t1, c->scheme->name, h,
                      growth, m->advice);
}

static bough_status watch_size(const bough_monitor *m, bough_coupling *c, group *g, double size) {
    if (g->first_steps < FIRST_STEPS) {
        g->first_steps += size > 0;
        g->small = fmax(g->small, size);
        g->small_time = c->t1;
    } else if (!g->kinematic && size > suspicious_growth * g->small) {
        bough_status status = look_into(m, c, g);
        g->small = size;
        g->small_time = c->t1;
        return status;
    }
    return bough_ok();
}

static bough_status judge_group(const bough_monitor *m, bough_coupling *c, group *g) {
    double difference[3];
    for (int i = 0; i < g->count; i++) {
        difference[i] = c->input[g->first + i] - c->applied[g->first + i];
    }
    double defect = norm(difference, g->count), size = norm(c->input + g->first, g->count);
    g->magnitude = fmax(g->magnitude, size);
    g->defect_max = fmax(g->defect_max, defect);
    g->defect_sum += defect * defect;
    g->window_sum += defect * defect;
    if (m->resting) return bough_ok();
    bough_status status = watch(m, c, g, defect);
    return bough_is_ok(&status) ? watch_size(m, c, g, size) : status;
}

// -- energy ---------------------------------------------------------------------------------------

static double dot(const double *x, const double *y, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += x[i] * y[i];
    return sum;
}

// Trapezoidal work of the obtained wrench, and of its difference to the applied wrench.
static void keep_accounts(bough_monitor *m, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    const double *before = c->past[1];
    double half = (c->t1 - c->t0) / 2;
    for (int i = 0; i < a->n_member; i++) {
        bough_signal_value(&c->signal[i], c->t0, m->start + a->input_offset[i]);
    }
    for (int k = 0; k < a->n_interface; k++) {
        const bough_interface *f = &a->interface[k];
        const double *v0 = before + f->twist, *v1 = c->input + f->twist;
        double obtained0 = dot(before + f->wrench, v0, f->count);
        double obtained1 = dot(c->input + f->wrench, v1, f->count);
        double applied = dot(m->start + f->wrench, v0, f->count) +
                         dot(c->applied + f->wrench, v1, f->count);
        double residual = half * (obtained0 + obtained1 - applied);
        double exchanged = half * (fabs(obtained0) + fabs(obtained1));
        m->account[k].total.residual += residual;
        m->account[k].total.exchanged += exchanged;
        m->account[k].gross += fabs(residual);
        m->account[k].exchanged += exchanged;
    }
}

// -- error bound ----------------------------------------------------------------------------------

// The worst relative defect of an interface's wrench in the window.
static double window_defect(const bough_monitor *m, const bough_interface *f) {
    double worst = 0;
    for (int k = 0; k < m->n_group; k++) {
        const group *g = &m->group[k];
        if (g->first < f->wrench || g->first >= f->wrench + f->count || g->magnitude == 0) continue;
        worst = fmax(worst, sqrt(g->window_sum / m->window_steps) / g->magnitude);
    }
    return worst;
}

static bough_status lost(const bough_monitor *m, const bough_coupling *c, int interface,
                         double try_step) {
    const bough_assembly *a = c->assembly;
    const bough_interface *f = &a->interface[interface];
    const bough_error_bound *b = &m->account[interface].bound;
    return bough_fail(BOUGH_FAILED,
                      "the coupling of %.32s and %.32s is unstable and has lost the solution at "
                      "%.6g s (scheme %s, macro step %.4g s): interface error %.2g of the largest "
                      "force, growing by %.4g per step, and %.2g of the exchanged energy; good "
                      "until %.4g s; try macro_step: %.3g s%s",
                      a->member[f->body]->system.name, a->member[receiver(a, f->wrench)]->system.name, c->t1,
                      c->scheme->name, c->t1 - c->t0, b->last.defect, b->growth, b->last.energy,
                      b->good_time, try_step,
                      m->advice);
}

// The eigenvalues about the current state distinguish an unstable from a coarse coupling.
static bough_status confirm(const bough_monitor *m, bough_coupling *c, int interface) {
    bough_scheme_options options = bough_scheme_options_in_use(c);
    bough_stability_advice advice = {0};
    double h = c->t1 - c->t0;
    bough_status status = bough_stability_advise(c->assembly, &options, h, &advice);
    bool unstable = bough_is_ok(&status) && advice.unstable;
    if (!unstable && !bough_error_bound_hopeless(&m->account[interface].bound)) return bough_ok();
    return lost(m, c, interface, advice.macro_step > 0 ? advice.macro_step : h / 2);
}

// The share of the exchanged energy that the interfaces have added or removed, over the whole run and in the
// last two windows, so that a sudden start, which no macro step resolves, does not count. Only this
// detects an implicit coupling that is stable but wrong, such as the damped ramp on a light body; accurate
// couplings stay a hundred times below. Schemes with constant forces are of first order and exceed it; for
// these there is the error bound.
static const double most_energy_error = 0.01;
enum { MOST_UNBALANCED = 2 };

// Error and exchange of all interfaces, over the run or since the last window closed.
static bough_interface_energy sum_energy(const bough_monitor *m, int n, bool since) {
    bough_interface_energy sum = {0};
    for (int k = 0; k < n; k++) {
        const account *x = &m->account[k];
        sum.residual += fabs(x->total.residual - (since ? x->closed.residual : 0));
        sum.exchanged += x->total.exchanged - (since ? x->closed.exchanged : 0);
    }
    return sum;
}

static bool holds_forces(const bough_coupling *c) {
    return c->scheme->explicit_forces || bough_scheme_defect_order(c->scheme, &c->options) == 1;
}

static bough_status judge_balance(bough_monitor *m, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_interface_energy all = sum_energy(m, a->n_interface, false);
    bough_interface_energy last = sum_energy(m, a->n_interface, true);
    bool balanced = all.residual <= most_energy_error * all.exchanged ||
                    last.residual <= most_energy_error * last.exchanged;
    m->unbalanced = balanced ? 0 : m->unbalanced + 1;
    int worst = 0;
    for (int k = 0; k < a->n_interface; k++) {
        m->account[k].closed = m->account[k].total;
        double residual = fabs(m->account[k].total.residual);
        if (residual > fabs(m->account[worst].total.residual)) worst = k;
    }
    if (holds_forces(c) || m->unbalanced < MOST_UNBALANCED) return bough_ok();
    int body = a->interface[worst].body;
    return bough_fail(BOUGH_FAILED,
                      "the coupling of %s has lost the solution at %.6g s (scheme %s, macro step "
                      "%.6g s): the coupling itself adds or removes %.2g of the energy "
                      "exchanged at the interfaces; try a smaller macro step%s%s",
                      a->member[body]->system.name, c->t1, c->scheme->name, c->t1 - c->t0,
                      all.residual / all.exchanged, a->opaque ? "" : " or scheme: ",
                      a->opaque ? "" : bough_scheme_last_resort(c->scheme));
}

// Windows are of at least 64 steps and a second.
static bough_status judge_error(bough_monitor *m, bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    m->window_steps++;
    m->window_time += c->t1 - c->t0;
    if (m->window_steps < 64 || m->window_time < 1 - 1e-9) return bough_ok();
    int broken = -1;
    for (int k = 0; k < a->n_interface; k++) {
        account *x = &m->account[k];
        bough_error_window closed = {.defect = window_defect(m, &a->interface[k]),
                                     .energy = x->exchanged > 0 ? x->gross / x->exchanged : 0};
        bough_error_bound_close(&x->bound, closed, m->window_steps, c->t1);
        x->gross = x->exchanged = 0;
        if (broken < 0 && bough_error_bound_broken(&x->bound)) broken = k;
    }
    for (int k = 0; k < m->n_group; k++) m->group[k].window_sum = 0;
    m->window_steps = 0;
    m->window_time = 0;
    bough_status status = broken < 0 ? bough_ok() : confirm(m, c, broken);
    return bough_is_ok(&status) ? judge_balance(m, c) : status;
}

// -- the step -------------------------------------------------------------------------------------

bough_status bough_monitor_step(bough_monitor *m, bough_coupling *c) {
    bough_status status = check_finite(m, c);
    if (!bough_is_ok(&status)) return status;
    m->steps++;
    keep_accounts(m, c);
    for (int k = 0; k < m->n_group && bough_is_ok(&status); k++) {
        status = judge_group(m, c, &m->group[k]);
    }
    return bough_is_ok(&status) && !m->resting ? judge_error(m, c) : status;
}

void bough_monitor_judge(bough_monitor *m, bool judges) { m->resting = !judges; }

void bough_monitor_snapshot(bough_monitor *m, const bough_coupling *c, bough_snapshot *s) {
    const bough_assembly *a = c->assembly;
    bough_snapshot_take(s, m->group, (size_t)m->n_group * sizeof *m->group);
    bough_snapshot_take(s, &m->steps, sizeof m->steps);
    bough_snapshot_take(s, m->account, (size_t)a->n_interface * sizeof *m->account);
    bough_snapshot_take(s, &m->window_steps, sizeof m->window_steps);
    bough_snapshot_take(s, &m->window_time, sizeof m->window_time);
    bough_snapshot_take(s, &m->unbalanced, sizeof m->unbalanced);
}

bough_coupling_report bough_monitor_report(const bough_monitor *m, const bough_coupling *c) {
    bough_coupling_report report = {0};
    for (int k = 0; k < m->n_group && m->steps > 0; k++) {
        const group *g = &m->group[k];
        if (g->magnitude == 0) continue;
        double rms = sqrt(g->defect_sum / (double)m->steps);
        report.defect_max = fmax(report.defect_max, g->defect_max / g->magnitude);
        report.defect_rms = fmax(report.defect_rms, rms / g->magnitude);
    }
    for (int k = 0; k < c->assembly->n_interface; k++) {
        report.energy_residual += fabs(m->account[k].total.residual);
        report.energy_exchanged += m->account[k].total.exchanged;
    }
    return report;
}

bough_interface_energy bough_monitor_energy(const bough_monitor *m, int interface) {
    return m->account[interface].total;
}

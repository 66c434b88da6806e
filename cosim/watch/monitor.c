// Two checks serve where no other solution shows the error; docs/verification.md has what each finds on
// random scenes.
//
// Growth: a force that has grown by a factor of 100 since its first steps, and whose values obtained and
// applied differ, is analysed, and again after each further factor of 100. The coupling is the cause if its
// eigenvalues, theory (69), about the current state explain that growth, and those of a shorter macro step,
// or of another scheme there, do not. Growth that belongs to the mechanics, such as a fall or flutter, does
// not end the run. A foreign simulator has no eigenvalues; there the coupling is the cause if the forces
// obtained and applied differ by half their size.
//
// Energy: what the interfaces add or remove, theory (70), shows an implicit coupling that is stable but
// wrong.
#include "cosim/watch/monitor.h"

#include "cosim/scheme.h"

enum { FIRST_STEPS = 8 };
static const double suspicious_growth = 100;

// Difference of the forces obtained and applied, relative to the largest so far. With a smaller one an
// implicit coupling that does not iterate causes no growth yet. (Explicit ones may apply all forces as
// obtained.)
static const double agreement = 1e-5;

// Up to three components of one connection: a vector, measured by its norm.
typedef struct group {
    int first, count; // inputs, numbered over all
    int to, from;     // members
    bool kinematic;
    double defect_max, defect_sum; // Σ of squares over the steps
    double magnitude;              // largest norm of the obtained value so far
    double small;                  // largest norm of the first steps with one, or when last analysed
    double small_time;             // then [s]
    int first_steps;               // of these so far
} group;

// The energy of one pair of ports.
typedef struct account {
    bough_pair_energy total, closed; // closed: at the end of the last window
} account;

struct bough_monitor {
    char advice[64]; // another scheme to try, or ""
    int n_group;
    group *group;
    long steps;
    account *account;   // (n_pair)
    int window_steps;   // in the open window
    double window_time; // its length so far [s]
    int unbalanced;     // windows in a row in which the interfaces add or remove energy
    double *start;      // (n_input) scratch

    // by bough_monitor_keep
    double *state, *input; // (n_state), (n_input) at the start of the step
};

static void make_groups(bough_monitor *m, const bough_assembly *a) {
    for (int j = 0; j < a->n_input; j++) {
        if (a->vector[j] == j) {
            m->group[m->n_group++] = (group){
                .first = j, .to = a->receiver[j], .from = a->source_member[j], .kinematic = a->kinematic[j]};
        }
        m->group[m->n_group - 1].count++;
    }
}

// What belongs to the remedy of one system of all members: another solver, where the present one suits fewer
// states.
static const char *solver_advice(const bough_coupling *c) {
    int most = bough_integrator_find(c->options.integrator.kind)->most_states;
    return most > 0 && c->assembly->n_state > most ? " with master.solver: automatic" : "";
}

bough_monitor *bough_monitor_create(bough_arena *arena, const bough_coupling *coupling) {
    const bough_assembly *a = coupling->assembly;
    size_t n_input = (size_t)a->n_input;
    bough_monitor *m = bough_arena_take(arena, sizeof *m);
    if (!a->opaque && !coupling->scheme->one_system)
        snprintf(m->advice, sizeof m->advice, " or scheme: " BOUGH_SCHEME_DEFAULT "%s",
                 solver_advice(coupling));
    m->group = bough_arena_take(arena, n_input * sizeof *m->group);
    bough_arena_each(arena, n_input, &m->start, &m->input);
    m->state = bough_arena_doubles(arena, (size_t)a->n_state);
    m->account = bough_arena_take(arena, (size_t)a->n_pair * sizeof *m->account);
    make_groups(m, a);
    return m;
}

// -- non-finite values ----------------------------------------------------------------------------

static bough_status check_finite(const bough_monitor *m, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        if (bough_all_finite(s->n_state, a->member[i]->state) &&
            bough_all_finite(s->n_output, c->output + a->output_offset[i])) {
            continue;
        }
        return bough_fail(BOUGH_FAILED,
                          "%s: no finite state or output at %.6g s (scheme %s, macro step %.6g s); "
                          "try a smaller macro step%s",
                          s->name, c->t1, c->scheme->name, c->t1 - c->t0, m->advice);
    }
    return bough_ok();
}

// -- growth ---------------------------------------------------------------------------------------

static double norm(const double *x, int n) { return sqrt(bough_scalar_product(n, x, x)); }

// Growth of the fastest growing motion about the current state [1/s]; negative: none grows, or it is not
// known.
static double fastest_growth(const bough_coupling *c, const bough_scheme_options *options,
                             double macro_step) {
    bough_stability s = {0};
    double fine = macro_step / 32; // oscillations within a step count, too
    bough_status status = bough_stability_judge_by(c->assembly, options, macro_step, fine, &s);
    return bough_is_ok(&status) ? fmax(s.growth, s.rising) : -1;
}

// Relative difference of the forces from which on the coupling is taken to cause a growth where the equations
// of a member are not known: the growth alone may be the member's own.
static const double unrelated = 0.5;

static bool coupling_grows(const bough_coupling *c, const group *g, double defect, double *growth) {
    static const int shorter[] = {8, 64, 64};
    double needed = log(suspicious_growth) / (c->t1 - g->small_time); // to explain the force
    *growth = needed;
    if (c->assembly->opaque) return defect > unrelated * g->magnitude;
    // the growth of this coupling, then that of better ones
    bough_scheme_options options = c->options;
    double h = c->t1 - c->t0, own;
    *growth = fastest_growth(c, &options, h);
    own = *growth / 2;
    for (int k = 0; k < 3 && *growth > needed / 2 && own >= *growth / 2; k++) {
        // an explicit scheme may grow at short steps, too, and faster
        if (k == 2) options = bough_scheme_damped(&options);
        own = fastest_growth(c, &options, h / shorter[k]);
    }
    return own < *growth / 2;
}

// Fails if the coupling is the cause of a growing force.
static bough_status analyse(const bough_monitor *m, const bough_coupling *c, const group *g, double defect) {
    double growth;
    if (!coupling_grows(c, g, defect, &growth)) return bough_ok();
    const bough_assembly *a = c->assembly;
    return bough_fail(BOUGH_FAILED,
                      "coupling of %s and %s is unstable at %.6g s: scheme %s, macro step %.6g s, "
                      "their force has grown by more than a factor of 100, by %.3g per "
                      "second; try a smaller macro step%s",
                      a->member[g->from]->system.name, a->member[g->to]->system.name, c->t1, c->scheme->name,
                      c->t1 - c->t0, growth, m->advice);
}

// Compares a force with its size in the first steps.
static bough_status watch_size(const bough_monitor *m, const bough_coupling *c, group *g, double size,
                               double defect) {
    if (g->first_steps < FIRST_STEPS) {
        g->first_steps += size > 0;
        g->small = fmax(g->small, size);
        g->small_time = c->t1;
    } else if (!g->kinematic && size > suspicious_growth * g->small &&
               (c->scheme->repeats || c->scheme->explicit_forces || defect > agreement * g->magnitude)) {
        bough_status status = analyse(m, c, g, defect);
        g->small = size;
        g->small_time = c->t1;
        return status;
    }
    return bough_ok();
}

static bough_status judge_group(const bough_monitor *m, bough_coupling *c, group *g, bool compared) {
    // the defect, theory (68), at t1
    double difference[3];
    for (int i = 0; i < g->count; i++) {
        difference[i] = c->input[g->first + i] - c->applied[g->first + i];
    }
    double defect = norm(difference, g->count), size = norm(c->input + g->first, g->count);
    // its statistics
    g->magnitude = fmax(g->magnitude, size);
    g->defect_max = fmax(g->defect_max, defect);
    g->defect_sum += defect * defect;
    return compared ? bough_ok() : watch_size(m, c, g, size, defect);
}

// -- energy ---------------------------------------------------------------------------------------

// Trapezoidal work of the obtained wrench, and of its difference to the applied wrench.
static void keep_accounts(bough_monitor *m, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    const double *before = c->past.input[1];
    double half = (c->t1 - c->t0) / 2;
    for (int i = 0; i < a->n_member; i++) {
        bough_signal_value(&c->signal[i], c->t0, m->start + a->input_offset[i]);
    }
    for (int k = 0; k < a->n_pair; k++) {
        const bough_port_pair *f = &a->pair[k];
        const double *v0 = before + f->twist, *v1 = c->input + f->twist;
        double obtained0 = bough_scalar_product(f->count, before + f->wrench, v0);
        double obtained1 = bough_scalar_product(f->count, c->input + f->wrench, v1);
        double applied = bough_scalar_product(f->count, m->start + f->wrench, v0) +
                         bough_scalar_product(f->count, c->applied + f->wrench, v1);
        double residual = half * (obtained0 + obtained1 - applied);
        double exchanged = half * (fabs(obtained0) + fabs(obtained1));
        m->account[k].total.residual += residual;
        m->account[k].total.exchanged += exchanged;
    }
}

// Largest ratio of the energy that the interfaces add or remove to the energy that they exchange, over the
// whole run and in the last two windows, so that a sudden start, which no macro step resolves, does not
// count. Accurate couplings stay a hundred times below. Schemes with constant forces are of first order and
// exceed it.
static const double most_energy_error = 0.01;
enum { MOST_UNBALANCED = 2 };

// Error and exchange of all interfaces, over the run or since the last window closed.
static bough_pair_energy sum_energy(const bough_monitor *m, int n, bool since) {
    bough_pair_energy sum = {0};
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
    bough_pair_energy all = sum_energy(m, a->n_pair, false);
    bough_pair_energy last = sum_energy(m, a->n_pair, true);
    bool balanced = all.residual <= most_energy_error * all.exchanged ||
                    last.residual <= most_energy_error * last.exchanged;
    m->unbalanced = balanced ? 0 : m->unbalanced + 1;
    // the window closes; the interface with the largest error
    int worst = 0;
    for (int k = 0; k < a->n_pair; k++) {
        m->account[k].closed = m->account[k].total;
        double residual = fabs(m->account[k].total.residual);
        if (residual > fabs(m->account[worst].total.residual)) worst = k;
    }
    if (holds_forces(c) || m->unbalanced < MOST_UNBALANCED) return bough_ok();
    int body = a->pair[worst].body;
    return bough_fail(BOUGH_FAILED,
                      "the coupling of %s is not accurate at %.6g s (scheme %s, macro step "
                      "%.6g s): the coupling itself adds or removes %.2g of the energy "
                      "exchanged at the interfaces; try a smaller macro step%s",
                      a->member[body]->system.name, c->t1, c->scheme->name, c->t1 - c->t0,
                      all.residual / all.exchanged, m->advice);
}

// Windows are of at least 64 steps and a second.
static bough_status judge_energy(bough_monitor *m, const bough_coupling *c) {
    m->window_steps++;
    m->window_time += c->t1 - c->t0;
    if (m->window_steps < 64 || m->window_time < 1 - 1e-9) return bough_ok();
    m->window_steps = 0;
    m->window_time = 0;
    return judge_balance(m, c);
}

// -- the step -------------------------------------------------------------------------------------

bough_status bough_monitor_step(bough_monitor *m, bough_coupling *c, bool compared) {
    BOUGH_TRY(check_finite(m, c));
    m->steps++;
    keep_accounts(m, c);
    for (int k = 0; k < m->n_group; k++) BOUGH_TRY(judge_group(m, c, &m->group[k], compared));
    return compared ? bough_ok() : judge_energy(m, c);
}

void bough_monitor_snapshot(bough_monitor *m, const bough_coupling *c, bough_snapshot *s) {
    const bough_assembly *a = c->assembly;
    bough_snapshot_take(s, m->group, (size_t)m->n_group * sizeof *m->group);
    bough_snapshot_take(s, &m->steps, sizeof m->steps);
    bough_snapshot_take(s, m->account, (size_t)a->n_pair * sizeof *m->account);
    BOUGH_SNAPSHOT(s, m->window_steps, m->window_time, m->unbalanced);
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
    bough_pair_energy all = sum_energy(m, c->assembly->n_pair, false);
    report.energy_residual = all.residual;
    report.energy_exchanged = all.exchanged;
    return report;
}

bough_pair_energy bough_monitor_energy(const bough_monitor *m, int interface) {
    return m->account[interface].total;
}

// -- a member that fails --------------------------------------------------------------------------

enum { ADVICE = 240 };

void bough_monitor_keep(bough_monitor *m, const bough_coupling *c) {
    bough_assembly_states(c->assembly, m->state);
    memcpy(m->input, c->input, (size_t)c->assembly->n_input * sizeof *m->input);
}

static void restore_members(const bough_monitor *m, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        bough_member_set(a->member[i], c->t0, m->state + a->state_offset[i]);
    }
}

void bough_monitor_undo(const bough_monitor *m, bough_coupling *c) {
    restore_members(m, c);
    memcpy(c->input, m->input, (size_t)c->assembly->n_input * sizeof *m->input);
}

// The stability at the start of the step; empty where the analysis fails, too.
static bough_stability_advice judge_again(const bough_monitor *m, bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_stability_advice advice;
    restore_members(m, c);
    bough_status status = bough_stability_advise(a, &c->options, c->t1 - c->t0, &advice);
    return bough_is_ok(&status) ? advice : (bough_stability_advice){0};
}

// Under a stable coupling shorter macro steps and other tolerances seldom help a member that fails; one
// system of all members does. What makes that fail, too, makes every method fail: vibrations without damping,
// a mesh that is too coarse. An opaque member cannot be part of one system.
static void advise(const bough_coupling *c, const bough_stability_advice *advice, char *text) {
    if (!advice->unstable) {
        bool coupled = !c->scheme->one_system && !c->assembly->opaque;
        snprintf(
            text, ADVICE, "; try %s%s",
            c->scheme->one_system
                ? "damping of flexible bodies, more segments or another master.rtol; a slack rope that snaps "
                  "taut kinks within sqrt(EI/tension): give it a larger bending stiffness EI"
            : c->assembly->opaque ? "a smaller macro step or another micro.rtol"
                                  : "scheme: " BOUGH_SCHEME_DEFAULT,
            coupled ? solver_advice(c) : "");
        return;
    }
    double factor = exp(advice->now.growth * (c->t1 - c->t0));
    bool slowly = factor < 1.1; // three digits of such a factor would hide the growth
    int n = snprintf(text, ADVICE, ": the coupling grows by %s%.3g%s in each macro step; try ",
                     slowly ? "" : "a factor of ", slowly ? 100 * (factor - 1) : factor, slowly ? " %" : "");
    if (advice->macro_step > 0) {
        n += snprintf(text + n, (size_t)(ADVICE - n), "macro_step: %.9g s or ", advice->macro_step);
    }
    snprintf(text + n, (size_t)(ADVICE - n), "scheme: " BOUGH_SCHEME_DEFAULT "%s", solver_advice(c));
}

bough_status bough_monitor_explain(const bough_monitor *m, bough_coupling *c,
                                   const bough_stability_advice *before, bough_status cause) {
    if (cause.code != BOUGH_FAILED && cause.code != BOUGH_RETRY) return cause;
    char text[ADVICE];
    // the part of the coupling in it
    bough_stability_advice advice = *before;
    if (!advice.unstable && !c->scheme->one_system) advice = judge_again(m, c);
    advise(c, &advice, text);
    return bough_fail(BOUGH_FAILED, "%s (scheme %s, macro step %.6g s from %.6g s)%s", cause.message,
                      c->scheme->name, c->t1 - c->t0, c->t0, text);
}

// Iterated coupling: the macro step is repeated until the interface agrees, theory (63). The unknowns are
// values of the inputs whose source advances in the same level or later (the feedback), at nodes of the step:
//   - end values: at T_{k+1}. The input is a polynomial of degree `order` through this value and earlier
//     ones. The order is therefore degree + 1, by the interpolation and not by the iteration.
//   - waveform: also at the Lobatto points, where the sub-solvers stop. The input is the cubic through
//     all values. Its error is orthogonal to linear functions, so the order is 6, theory (67).
// Other inputs are the same polynomials through the actual values of their source. With end values a
// member may get a position and a speed that are not consistent, which disturbs a stiff member. Cubics
// through values and rates at both ends would be unstable on a light interface body: measured, a carrier
// of a hundredth of its inertia fails at 20 ms.
//
// A sweep advances the levels in order and gives the resulting feedback; an accelerator computes the next
// values from it. Before each sweep the members return to T_k and restart their integrators, so that equal
// values give equal results.
//
// A converged step may still be unstable: measured on a mass of a ten-thousandth of the other one
// (test_scheme.c), a linear force is stable up to a macro step of about 3.5 divided by the frequency
// (11 ms), a quadratic one at no step from 2.5 to 40 ms, a constant one (degree 0) at all of these. The
// eigenvalues of the step are therefore computed before the run.
//
// The residual is relative to the largest value of its port so far. It cannot become smaller than the noise
// by the members' own tolerances. An adaptive multistep method that restarts and stops within the step has
// a hundred times more noise there than at the end of the step.
#include "cosim/scheme.h"
#include "cosim/whole.h"

// Inputs below this part of the largest one contain only rounding.
static const double least_scale = 1e-6;

enum { MOST_NODES = 3 };
enum { MOST_AGE = 12 }; // of Newton's Jacobians [steps]: as the ramp keeps its tangents
static const double end_point[] = {1};
static const double lobatto[MOST_NODES] = {0.27639320225002103, 0.72360679774997897, 1};

typedef struct iteration {
    bough_accelerator *accelerator;
    // Newton's, theory (66), one for each node: response of the inputs to their own change at the node. Every
    // member responds by one linearly implicit step, theory (55); γ is the time over which a unit change at
    // the node acts, ∫ w dt. NULL: another accelerator.
    bough_whole *jacobian[MOST_NODES];
    double span[MOST_NODES]; // γ over the macro step
    double *at;              // (n_state) where they are made
    double length;           // of the macro step that they are made for [s]; 0: none
    int age;                 // steps since
    void **copy;             // (n_member) states at T_k
    int n_node;
    const double *node;      // (n_node) in (0, 1], the last is 1
    long sweeps, unfinished; // so far: see bough_scheme_report
    size_t n_prescribed;     // n_node × n_input
    double *prescribed,
        *best;         // (n_prescribed) values of the inputs in use, and those with the smallest residual
    double *obtained;  // (n_node × n_output) outputs in the last sweep; of end values the coupling's
    int n_input;       // of all members
    int n;             // feedback inputs
    int *input;        // (n) their numbers over all inputs
    int *group;        // (n) first feedback of the vector that each belongs to, up to 3 long
    bool *is_feedback; // (n_input)
    double *size;      // (n) of a group's first: its largest norm so far
    double *scale;     // (n)
    double *guess;     // (n_node × n) scaled values prescribed
    double *image;     // (n_node × n) the values obtained
    double *change;    // (n_input) scratch
} iteration;

// -- building -------------------------------------------------------------------------------------

static void find_feedback(iteration *it, const bough_assembly *a) {
    for (int j = 0; j < a->n_input; j++) {
        if (a->level[a->source_member[j]] < a->level[a->receiver[j]]) continue;
        int k = it->n++;
        it->is_feedback[j] = true;
        it->input[k] = j;
        it->group[k] = a->vector[j] == j ? k : it->group[k - 1];
    }
}

static void take(iteration *it, const bough_assembly *a, bough_arena *arena) {
    size_t n = (size_t)a->n_input, n_node = (size_t)it->n_node;
    it->copy = bough_arena_take(arena, (size_t)a->n_member * sizeof *it->copy);
    it->input = bough_arena_take(arena, n * sizeof *it->input);
    it->group = bough_arena_take(arena, n * sizeof *it->group);
    it->is_feedback = bough_arena_take(arena, n * sizeof *it->is_feedback);
    it->n_prescribed = n_node * n;
    bough_arena_each(arena, n_node * n, &it->prescribed, &it->best, &it->guess, &it->image);
    bough_arena_each(arena, n, &it->size, &it->scale, &it->change);
    for (int i = 0; i < a->n_member; i++) {
        bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
        bough_member_snapshot(a->member[i], &measure);
        it->copy[i] = bough_arena_take(arena, measure.used);
    }
}

static void solve_newton(void *self, double *x);

static void create_accelerator(bough_coupling *c, iteration *it, bough_arena *arena) {
    bough_accelerator_def def = {.kind = c->options.accelerator,
                                 .n = it->n_node * it->n,
                                 .relaxation = c->options.relaxation,
                                 .solve = solve_newton,
                                 .self = it};
    it->accelerator = bough_accelerator_create(arena, &def);
    // Newton's Jacobians
    if (def.kind != BOUGH_ACCELERATE_NEWTON) return;
    static const double part[BOUGH_HISTORY] = {1, 1. / 2, 5. / 12}; // ∫ of the end value's weight
    for (int k = 0; k < it->n_node; k++) {
        it->span[k] = it->n_node == 1 ? part[c->options.order] : it->node[k] / 2;
        it->jacobian[k] = bough_whole_create(arena, c->assembly, c->pool);
    }
    it->at = bough_arena_doubles(arena, (size_t)c->assembly->n_state);
}

static bough_status create(bough_coupling *c, bough_arena *arena) {
    iteration *it = bough_arena_take(arena, sizeof *it);
    assert(c->options.order >= 0 && c->options.order < BOUGH_HISTORY);
    bool waveform = c->options.exchange == BOUGH_EXCHANGE_WAVEFORM;
    it->n_input = c->assembly->n_input;
    it->n_node = waveform ? MOST_NODES : 1;
    it->node = waveform ? lobatto : end_point;
    take(it, c->assembly, arena);
    it->obtained = c->advanced.value;
    if (waveform) it->obtained = bough_arena_doubles(arena, MOST_NODES * (size_t)c->assembly->n_output);
    find_feedback(it, c->assembly);
    c->scheme_data = it;
    create_accelerator(c, it, arena);
    return bough_ok();
}

// -- a sweep --------------------------------------------------------------------------------------

static void transfer(const bough_coupling *c, int member, bough_snapshot_move move) {
    bough_snapshot copy = {.move = move, .copy = ((const iteration *)c->scheme_data)->copy[member]};
    bough_member_snapshot(c->assembly->member[member], &copy);
}

static void save(bough_coupling *c, int member) { transfer(c, member, BOUGH_SNAPSHOT_SAVE); }

static void restore(bough_coupling *c, int member) { transfer(c, member, BOUGH_SNAPSHOT_RESTORE); }

static double node_time(const bough_coupling *c, int k) {
    const iteration *it = c->scheme_data;
    return k + 1 < it->n_node ? c->t0 + it->node[k] * (c->t1 - c->t0) : c->t1;
}

// Input j of the member through its values at the nodes and, of end values, earlier ones.
static void interpolate(bough_coupling *c, int member, int j) {
    const bough_assembly *a = c->assembly;
    const iteration *it = c->scheme_data;
    double time[MOST_NODES + BOUGH_HISTORY], value[MOST_NODES + BOUGH_HISTORY];
    int n = it->n_node, earlier = n > 1 ? 1 : c->options.order;
    for (int k = 0; k < n; k++) {
        time[k] = node_time(c, k);
        value[k] = it->prescribed[k * a->n_input + j];
    }
    for (int p = 0; p < earlier && p < c->past.n; p++, n++) {
        time[n] = c->past.time[p];
        value[n] = c->past.input[p][j];
    }
    bough_signal_polynomial(&c->signal[member], j - a->input_offset[member], n, time, value);
}

// Advances a member from node to node, with assumed feedback and obtained other inputs, and evaluates its
// outputs.
static void advance(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const iteration *it = c->scheme_data;
    // its inputs over the step
    for (int j = a->input_offset[member]; j < a->input_offset[member + 1]; j++) {
        for (int k = 0; k < it->n_node && !it->is_feedback[j]; k++) {
            it->prescribed[k * a->n_input + j] = it->obtained[k * a->n_output + a->source[j]];
        }
        interpolate(c, member, j);
        c->followed[j] = it->n_node > 1 && !it->is_feedback[j];
    }
    // its outputs at the nodes
    for (int k = 0; k < it->n_node; k++) {
        double t = node_time(c, k);
        bough_coupling_advance_to(c, member, t, k == 0);
        if (!bough_is_ok(&c->status[member])) return;
        bough_coupling_outputs(c, member, t, it->obtained + k * a->n_output + a->output_offset[member]);
    }
}

static bough_status sweep(bough_coupling *c) {
    int n = c->assembly->n_level;
    bough_status status = bough_ok();
    for (int k = 0; k < n && bough_is_ok(&status); k++) {
        status = bough_coupling_each(c, k, advance);
    }
    return status;
}

// -- the iteration --------------------------------------------------------------------------------

// First values: extrapolated from earlier ones, or constant where the loads jump.
static void predict(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    iteration *it = c->scheme_data;
    int degree = c->restart ? 0 : it->n_node > 1 ? BOUGH_HISTORY - 1 : c->options.order;
    for (int j = 0; j < a->n_input; j++) bough_coupling_extrapolate(c, j, degree);
    for (int k = 0; k < it->n_node; k++) {
        for (int i = 0; i < a->n_member; i++) {
            double *prescribed = it->prescribed + k * a->n_input + a->input_offset[i];
            bough_signal_value(&c->signal[i], node_time(c, k), prescribed);
        }
    }
}

// Magnitudes of the ports from the first sweep; they are constant over the step.
static void update_scales(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    iteration *it = c->scheme_data;
    const double *obtained = it->obtained + (it->n_node - 1) * a->n_output;
    const double *prescribed = it->prescribed + (it->n_node - 1) * a->n_input;
    double largest = 0;
    // norm of each vector, the largest so far
    for (int k = 0; k < it->n;) {
        int first = k;
        double sum = 0;
        for (; k < it->n && it->group[k] == first; k++) {
            double value = obtained[a->source[it->input[k]]], old = prescribed[it->input[k]];
            sum += fmax(value * value, old * old);
        }
        it->size[first] = fmax(it->size[first], sqrt(sum));
        largest = fmax(largest, it->size[first]);
    }
    // no scale much below the largest
    for (int k = 0; k < it->n; k++) {
        it->scale[k] = fmax(it->size[it->group[k]], least_scale * largest);
        if (!(it->scale[k] > 0)) it->scale[k] = 1;
    }
}

// The residual of the last sweep [1], theory (63).
static double evaluate(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    iteration *it = c->scheme_data;
    for (int p = 0; p < it->n_node; p++) {
        const double *prescribed = it->prescribed + p * a->n_input;
        const double *obtained = it->obtained + p * a->n_output;
        for (int k = 0; k < it->n; k++) {
            int j = it->input[k];
            it->guess[p * it->n + k] = prescribed[j] / it->scale[k];
            it->image[p * it->n + k] = obtained[a->source[j]] / it->scale[k];
        }
    }
    return bough_accelerator_take(it->accelerator, it->guess, it->image);
}

// The values of the next sweep.
static void correct(bough_coupling *c) {
    iteration *it = c->scheme_data;
    bough_accelerator_next(it->accelerator, it->guess);
    for (int p = 0; p < it->n_node; p++) {
        double *prescribed = it->prescribed + p * c->assembly->n_input;
        for (int k = 0; k < it->n; k++) {
            prescribed[it->input[k]] = it->scale[k] * it->guess[p * it->n + k];
        }
    }
}

// x (n_node × n), scaled: node by node the change that closes the interface over this residual.
static void solve_newton(void *self, double *x) {
    const iteration *it = self;
    for (int p = 0; p < it->n_node; p++, x += it->n) {
        memset(it->change, 0, (size_t)it->n_input * sizeof(double));
        for (int k = 0; k < it->n; k++) it->change[it->input[k]] = it->scale[k] * x[k];
        bough_whole_close(it->jacobian[p], it->change);
        for (int k = 0; k < it->n; k++) x[k] = it->change[it->input[k]] / it->scale[k];
    }
}

// The Jacobians for a step, members being at t0: anew when the macro step changes, loads jump, and every few
// steps.
static bough_status renew_jacobians(bough_coupling *c) {
    iteration *it = c->scheme_data;
    double length = c->t1 - c->t0;
    bool same = !c->restart && fabs(length - it->length) <= 1e-9 * length;
    it->age++;
    if (same && it->age <= MOST_AGE) return bough_ok();
    it->length = length;
    it->age = 0;
    bough_assembly_states(c->assembly, it->at);
    bough_status status = bough_ok();
    for (int k = 0; k < it->n_node && bough_is_ok(&status); k++) {
        status = bough_whole_setup(it->jacobian[k], c->t0, it->at, c->input, it->span[k] * length);
    }
    return status;
}

static bough_status not_converged(const bough_coupling *c, int sweeps, double residual) {
    const bough_assembly *a = c->assembly;
    const iteration *it = c->scheme_data;
    // the input with the largest residual at t1, and its receiver
    int worst = 0, last = (it->n_node - 1) * it->n;
    for (int k = 1; k < it->n; k++) {
        double off = fabs(it->image[last + k] - it->guess[last + k]);
        if (off > fabs(it->image[last + worst] - it->guess[last + worst])) worst = k;
    }
    int from = a->source_member[it->input[worst]], to = a->receiver[it->input[worst]];
    // what may help
    double contraction = bough_accelerator_contraction(it->accelerator);
    bool learns = bough_acceleration_learns(c->options.accelerator);
    const char *advice = !learns             ? "try accelerator: iqn-ils"
                         : contraction < 0.9 ? "try more iterations"
                                             : "try a larger tolerance or a tighter micro rtol";
    return bough_fail(
        BOUGH_RETRY,
        "coupling of %.24s and %.24s not converged at %.6g s: residual %.2g after %d iterations, convergence factor %.3g; %s",
        a->member[from]->system.name, a->member[to]->system.name, c->t1, residual, sweeps, contraction,
        advice);
}

// Repeats the step with the values of the smallest residual: where another solution shows the error, their
// error is part of it.
static bough_status go_back(bough_coupling *c) {
    iteration *it = c->scheme_data;
    bough_status status = bough_coupling_each(c, BOUGH_ALL_LEVELS, restore);
    memcpy(it->prescribed, it->best, it->n_prescribed * sizeof(double));
    it->sweeps++;
    it->unfinished++;
    return bough_is_ok(&status) ? sweep(c) : status;
}

static bough_status step(bough_coupling *c) {
    iteration *it = c->scheme_data;
    bough_coupling_begin(c);
    bough_status status = bough_coupling_each(c, BOUGH_ALL_LEVELS, save);
    bough_accelerator_start(it->accelerator);
    predict(c);
    if (bough_is_ok(&status) && it->jacobian[0]) status = renew_jacobians(c);
    // sweeps until the residual is small, k of them so far
    double best = HUGE_VAL;
    for (int k = 1; bough_is_ok(&status); k++) {
        status = sweep(c);
        it->sweeps++;
        if (!bough_is_ok(&status)) return c->compared && isfinite(best) ? go_back(c) : status;
        if (k == 1) update_scales(c);
        double residual = evaluate(c);
        bool lost = k == 1 && !isfinite(residual); // before any iteration: the monitor finds the cause
        if (residual <= c->options.tolerance || lost) break;
        if (residual < best) {
            best = residual;
            memcpy(it->best, it->prescribed, it->n_prescribed * sizeof(double));
        }
        if (k == c->options.iterations || bough_accelerator_diverges(it->accelerator)) {
            return c->compared && isfinite(best) ? go_back(c) : not_converged(c, k, residual);
        }
        // back to T_k with better values
        correct(c);
        status = bough_coupling_each(c, BOUGH_ALL_LEVELS, restore);
    }
    return status;
}

static void snapshot(bough_coupling *c, bough_snapshot *s) {
    iteration *it = c->scheme_data;
    bough_snapshot_doubles(s, it->size, it->n);
    BOUGH_SNAPSHOT(s, it->sweeps, it->unfinished);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) it->length = 0; // Jacobians are made anew
}

static int defect_order(const bough_scheme_options *options) {
    return options->exchange == BOUGH_EXCHANGE_WAVEFORM ? 4 : options->order + 1;
}

static void report(const bough_coupling *c, bough_scheme_report *to) {
    const iteration *it = c->scheme_data;
    to->sweeps = it->sweeps;
    to->unfinished = it->unfinished;
}

const bough_scheme bough_scheme_iterated = {
    .name = "iterated",
    .summary = "the step is repeated until the interface agrees; order 1 to 3 (degree + 1), of "
               "waveforms 6, implicit",
    .reads = BOUGH_READS_ORDER | BOUGH_READS_EXCHANGE | BOUGH_READS_ACCELERATOR,
    .foreign = true,
    .repeats = true,
    .judged = true,
    .create = create,
    .step = step,
    .snapshot = snapshot,
    .defect_order = defect_order,
    .report = report,
};

// Iterated coupling: the macro step is repeated until the interface agrees with itself. The unknowns
// are the end values of the inputs whose source advances in the same stage or later (the feedback);
// every input is a polynomial of degree `order` through its end value and earlier ones, so the order
// is degree + 1, from the interpolation and not from the iteration. A sweep takes the stages in
// order and tells what the feedback turned out to be; an accelerator turns that into the next end
// values. Before each repetition the members return to T_k and restart their integrators, the first
// sweep likewise, so that equal end values give equal answers.
//
// Converged is not yet stable: measured on a mass a ten-thousandth of the other (test_scheme.c), a
// linear force holds to a macro step of about 3.5 over its frequency (11 ms), a quadratic one at none
// of 2.5 to 40 ms, a held one (degree 0) at all of these. The eigenvalues of the step are judged
// before the run.
//
// The residual is relative to the largest value of its port so far. It cannot become smaller than
// the noise that the members' own tolerances leave on their answers.
#include "cosim/accelerate.h"
#include "cosim/port.h"
#include "cosim/scheme.h"
#include "cosim/sequence.h"

#include <math.h>
#include <string.h>

// Ports below this share of the largest one hold rounding only.
static const double least_scale = 1e-6;

typedef struct iteration {
    bough_accelerator *accelerator;
    void **copy;         // (n_member) states at T_k
    int n;               // feedback inputs
    int *input;          // (n) their numbers over all inputs
    int *group;          // (n) first feedback of the vector that each belongs to, up to 3 long
    bool *is_feedback;   // (n_input)
    double *end;         // (n_input) end values in use
    double *size;        // (n) of a group's first: its largest norm so far
    double *scale;       // (n)
    double *guess;       // (n) scaled end values
    double *image;       // (n) what they turned out to be
} iteration;

// -- building -------------------------------------------------------------------------------------

static bough_status check(const bough_scheme_options *o) {
    if (o->order < 0 || o->order >= BOUGH_HISTORY) {
        return bough_fail(BOUGH_INVALID, "iterated coupling: order is %d, must be 0, 1 or 2",
                          o->order);
    }
    if (!(o->tolerance > 0) || o->iterations < 1) {
        return bough_fail(BOUGH_INVALID,
                          "iterated coupling: tolerance %g and iterations %d must be positive",
                          o->tolerance, o->iterations);
    }
    return bough_ok();
}

static void find_feedback(iteration *it, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            if (bough_sequence_before(c, a->stage[a->source_member[j]], a->stage[i])) continue;
            int k = it->n++;
            it->is_feedback[j] = true;
            it->input[k] = j;
            bool continues = k > 0 && j > a->input_offset[i] && it->input[k - 1] == j - 1 &&
                             a->source[j] == a->source[j - 1] + 1 && k - it->group[k - 1] < 3 &&
                             a->source_member[j] == a->source_member[j - 1];
            it->group[k] = continues ? it->group[k - 1] : k;
        }
    }
}

static bool take(iteration *it, const bough_assembly *a, bough_arena *arena) {
    size_t n = (size_t)a->n_input;
    it->copy = bough_arena_take(arena, (size_t)a->n_member * sizeof *it->copy);
    it->input = bough_arena_take(arena, n * sizeof *it->input);
    it->group = bough_arena_take(arena, n * sizeof *it->group);
    it->is_feedback = bough_arena_take(arena, n * sizeof *it->is_feedback);
    it->end = bough_arena_doubles(arena, n);
    it->size = bough_arena_doubles(arena, n);
    it->scale = bough_arena_doubles(arena, n);
    it->guess = bough_arena_doubles(arena, n);
    it->image = bough_arena_doubles(arena, n);
    for (int i = 0; i < a->n_member && it->copy; i++) {
        const bough_subsystem *s = a->member[i];
        it->copy[i] = bough_arena_take(arena, s->ops->save_size(s->self));
    }
    return !bough_arena_exhausted(arena);
}

static bough_status create(bough_coupling *c, bough_arena *arena) {
    bough_status status = check(&c->options);
    if (!bough_is_ok(&status)) return status;
    iteration *it = bough_arena_take(arena, sizeof *it);
    if (!it || !take(it, c->assembly, arena)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    }
    find_feedback(it, c);
    c->scheme_data = it;
    bough_accelerator_def def = {
        .kind = c->options.accelerator, .n = it->n, .relaxation = c->options.relaxation};
    return bough_accelerator_create(arena, &def, &it->accelerator);
}

// -- a sweep --------------------------------------------------------------------------------------

static void save(bough_coupling *c, int member) {
    const bough_subsystem *s = c->assembly->member[member];
    const iteration *it = c->scheme_data;
    s->ops->save(s->self, it->copy[member]);
}

static void restore(bough_coupling *c, int member) {
    const bough_subsystem *s = c->assembly->member[member];
    const iteration *it = c->scheme_data;
    s->ops->restore(s->self, it->copy[member]);
}

// Input j of the member through its end value.
static void interpolate(bough_coupling *c, int member, int j) {
    const iteration *it = c->scheme_data;
    int degree = c->options.order < c->n_past ? c->options.order : c->n_past;
    double time[BOUGH_HISTORY + 1] = {c->t1};
    const double *value[BOUGH_HISTORY + 1] = {it->end + j};
    for (int p = 0; p < degree; p++) {
        time[p + 1] = c->past_time[p];
        value[p + 1] = c->past[p] + j;
    }
    bough_port_polynomial(&c->signal[member], j - c->assembly->input_offset[member], 1, degree + 1,
                          time, value);
}

// Advances a member and finds its outputs under what it was told.
static void advance(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const bough_subsystem *s = a->member[member];
    const iteration *it = c->scheme_data;
    for (int j = a->input_offset[member]; j < a->input_offset[member + 1]; j++) {
        if (!it->is_feedback[j]) it->end[j] = c->end_output[a->source[j]];
        interpolate(c, member, j);
    }
    c->status[member] = s->ops->advance(s->self, c->t1, &c->signal[member], true);
    if (!bough_is_ok(&c->status[member])) return;
    s->ops->output(s->self, c->t1, s->state, it->end + a->input_offset[member],
                   c->end_output + a->output_offset[member]);
}

static bough_status sweep(bough_coupling *c) {
    int n = c->assembly->n_stage;
    bough_status status = bough_ok();
    for (int k = 0; k < n && bough_is_ok(&status); k++) {
        status = bough_coupling_each(c, c->options.reversed ? n - 1 - k : k, advance);
    }
    return status;
}

// -- the iteration --------------------------------------------------------------------------------

// First end values: the earlier ones extrapolated, or held where the loads jump.
static void predict(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    iteration *it = c->scheme_data;
    for (int i = 0; i < a->n_member; i++) {
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            bough_sequence_extrapolate(c, i, j, c->restart ? 0 : c->options.order);
        }
        bough_signal_value(&c->signal[i], c->t1, it->end + a->input_offset[i]);
    }
}

// Sizes of the ports from what the first sweep found; they hold for the step.
static void update_scales(bough_coupling *c) {
    iteration *it = c->scheme_data;
    double largest = 0;
    for (int k = 0; k < it->n;) {
        int first = k;
        double sum = 0;
        for (; k < it->n && it->group[k] == first; k++) {
            double value = c->end_output[c->assembly->source[it->input[k]]];
            sum += fmax(value * value, it->end[it->input[k]] * it->end[it->input[k]]);
        }
        it->size[first] = fmax(it->size[first], sqrt(sum));
        largest = fmax(largest, it->size[first]);
    }
    for (int k = 0; k < it->n; k++) {
        it->scale[k] = fmax(it->size[it->group[k]], least_scale * largest);
        if (!(it->scale[k] > 0)) it->scale[k] = 1;
    }
}

// The residual of the sweep just made [1].
static double evaluate(bough_coupling *c) {
    iteration *it = c->scheme_data;
    for (int k = 0; k < it->n; k++) {
        int j = it->input[k];
        it->guess[k] = it->end[j] / it->scale[k];
        it->image[k] = c->end_output[c->assembly->source[j]] / it->scale[k];
    }
    return bough_accelerator_take(it->accelerator, it->guess, it->image);
}

static void correct(bough_coupling *c) {
    iteration *it = c->scheme_data;
    bough_accelerator_next(it->accelerator, it->guess);
    for (int k = 0; k < it->n; k++) it->end[it->input[k]] = it->scale[k] * it->guess[k];
}

static bough_status not_converged(const bough_coupling *c, int sweeps, double residual) {
    const bough_assembly *a = c->assembly;
    const iteration *it = c->scheme_data;
    int worst = 0, to = 0;
    for (int k = 1; k < it->n; k++) {
        double off = fabs(it->image[k] - it->guess[k]);
        if (off > fabs(it->image[worst] - it->guess[worst])) worst = k;
    }
    while (it->input[worst] >= a->input_offset[to + 1]) to++;
    double contraction = bough_accelerator_contraction(it->accelerator);
    const char *advice = c->options.accelerator != BOUGH_ACCELERATE_IQN_ILS
                             ? "try accelerator: iqn-ils"
                         : contraction < 0.9 ? "try more iterations"
                                             : "try a larger tolerance or a tighter micro rtol";
    return bough_fail(BOUGH_FAILED,
                      "coupling of %.24s and %.24s not converged at %.6g s: residual %.2g after %d "
                      "iterations, factor %.3g in each; %s",
                      a->member[a->source_member[it->input[worst]]]->name, a->member[to]->name,
                      c->t1, residual, sweeps, contraction, advice);
}

static bough_status step(bough_coupling *c) {
    iteration *it = c->scheme_data;
    bough_coupling_begin(c);
    bough_status status = bough_coupling_each(c, BOUGH_ALL_STAGES, save);
    bough_accelerator_start(it->accelerator);
    predict(c);
    for (int k = 1; bough_is_ok(&status); k++) {
        status = sweep(c);
        c->sweeps++;
        if (!bough_is_ok(&status)) break;
        if (k == 1) update_scales(c);
        double residual = evaluate(c);
        bool lost = k == 1 && !isfinite(residual); // before iterating: for the monitor to tell
        if (residual <= c->options.tolerance || lost) break;
        if (k == c->options.iterations || bough_accelerator_diverges(it->accelerator)) {
            return not_converged(c, k, residual);
        }
        correct(c);
        status = bough_coupling_each(c, BOUGH_ALL_STAGES, restore);
    }
    return status;
}

static void snapshot(bough_coupling *c, bough_snapshot *s) {
    const iteration *it = c->scheme_data;
    bough_snapshot_doubles(s, it->size, it->n);
}

const bough_scheme bough_scheme_iterated = {
    .name = "iterated",
    .summary = "the step repeated until the interface agrees; order 1 to 3 (degree + 1), implicit",
    .judged = true,
    .create = create,
    .step = step,
    .snapshot = snapshot,
};

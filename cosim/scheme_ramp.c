// Ramp, linearly implicit. From one linearly implicit θ-step of size H of
// every member, linearised at T_k,
//     (I − θH J) Δ = H f(T_k + θH, y, u) + θH B δu,   o^ = h(T_{k+1}, y, u) + C Δ + D δu,
// the end-of-step port values are found by solving the coupled linear interface equations. The
// leaders (stage 0) then advance under forces that change linearly from the value applied at the end of the
// last step to the predicted value. The forces are continuous, so integrators keep their history. The other
// members then advance once with the cubic of the resulting motion.
//
// A parabola that is zero at both ends is added to the linear force. It contains the impulse of the force's
// curvature and compensates the impulse deficit of earlier steps, so the exchanged momentum is of third
// order without further cost. It is used on heavy interface bodies only, because elsewhere the delayed
// compensation causes oscillations.
//
// θ = 1/2: order 3 with that impulse, 2 without. On an interface body that is lighter than the bodies it
// carries, or with θ > 1/2, the first step has θ = 1, which is damped and of order 1. If the eigenvalues of
// the macro step show that the trapezoidal rule is unstable, all steps have the smallest stable θ: slightly
// above 1/2, of order 1 with an error 2θ − 1 times as large. If no θ is stable, the step is repeated with
// waveforms (iteration.h). The interface is solved as in condense.h.
#include "cosim/analysis/stability.h"
#include "cosim/condense.h"
#include "cosim/iteration.h"
#include "cosim/port.h"
#include "cosim/scheme.h"

#include <math.h>
#include <string.h>

typedef struct ramp {
    bough_condensed *interface;
    double middle, gamma; // where and for what members are linearised [s]
    double *increment;    // (n_state) Δ of each member if the leaders' inputs did not change
    double *base;         // (n_output) h at the start values
    double *output;       // (n_output) change of the outputs with that
    double *change;       // (n_input) changes of the inputs
    double *input;        // (n_input) at the start of the step, as linearised: what was applied to leaders
    double theta;         // of the present step
    double final;         // after the damped first steps
    double damped;        // steps that begin before are damped [s]
    bool chosen;          // θ is final
    bool repeats;         // no θ holds: waveforms are iterated
    bool repays;          // impulses
    bool fresh;           // followers are linearised in this step
    int age;              // steps since they were
    double span;          // θH then [s]
} ramp;

static bool leads(const bough_coupling *c, int member) { return c->assembly->stage[member] == 0; }

// -- memory ---------------------------------------------------------------------------------------

// The elimination needs leaders whose outputs depend on states only, and followers connected with leaders.
static bough_status check_shape(const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i) && a->feedthrough[i]) {
            return bough_fail(BOUGH_INVALID,
                              "scheme ramp: %s leads, so its outputs must not depend on its "
                              "inputs directly; use another scheme",
                              a->member[i]->system.name);
        }
    }
    for (int i = 0; i < a->n_member; i++) {
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            if (leads(c, i) != leads(c, a->source_member[j])) continue;
            return bough_fail(BOUGH_INVALID, "scheme ramp: leaders and followers may only "
                                             "be connected with each other; use another scheme");
        }
    }
    return bough_ok();
}

static bough_status create(bough_coupling *c, bough_arena *arena) {
    const bough_assembly *a = c->assembly;
    bough_status status = check_shape(c);
    if (!bough_is_ok(&status)) return status;
    ramp *r = bough_arena_take(arena, sizeof *r);
    r->increment = bough_arena_doubles(arena, (size_t)a->n_state);
    r->base = bough_arena_doubles(arena, (size_t)a->n_output);
    r->output = bough_arena_doubles(arena, (size_t)a->n_output);
    bough_arena_each(arena, (size_t)a->n_input, &r->change, &r->input, &c->deficit);
    r->damped = -HUGE_VAL;
    r->chosen = c->options.theta > 0;
    r->theta = r->final = r->chosen ? c->options.theta : 0.5;
    c->scheme_data = r;
    r->interface = bough_condensed_create(arena, a);
    return bough_ok();
}

// -- the θ-step of every member -------------------------------------------------------------------

// Leaders start from the inputs that were applied last: that is where the ramp starts.
static void choose_inputs(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    ramp *r = c->scheme_data;
    for (int i = 0; i < a->n_member; i++) {
        size_t first = (size_t)a->input_offset[i], n = (size_t)a->member[i]->system.n_input;
        const double *from = leads(c, i) ? c->applied : c->input;
        memcpy(r->input + first, from + first, n * sizeof(double));
    }
}

// Changes of the inputs without the leaders' response to their inputs.
static void expect_inputs(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    for (int j = a->input_offset[member]; j < a->input_offset[member + 1]; j++) {
        r->change[j] = r->base[a->source[j]] + r->output[a->source[j]] - r->input[j];
    }
}

// H f and h at the start values.
static bool evaluate(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const bough_system *s = &a->member[member]->system;
    const ramp *r = c->scheme_data;
    const double *input = r->input + a->input_offset[member];
    double *increment = r->increment + a->state_offset[member], h = c->t1 - c->t0;
    if (!s->ops->derivative(s->self, r->middle, a->member[member]->state, input, increment)) return false;
    for (int k = 0; k < s->n_state; k++) increment[k] *= h;
    s->ops->output(s->self, c->t1, a->member[member]->state, input, r->base + a->output_offset[member]);
    return true;
}

// Δ and its outputs; change (n_input of the member) NULL for 0.
static void solve(bough_coupling *c, int member, const double *change) {
    const bough_assembly *a = c->assembly;
    const bough_system *s = &a->member[member]->system;
    const ramp *r = c->scheme_data;
    double *increment = r->increment + a->state_offset[member];
    if (change) bough_condensed_add_columns(r->interface, member, r->gamma, change, increment);
    bough_condensed_solve_member(r->interface, member, increment);
    s->ops->output_tangent(s->self, c->t1, a->member[member]->state, r->input + a->input_offset[member],
                           increment, change, r->output + a->output_offset[member]);
}

static bough_operating_point operating_point(const bough_coupling *c, int member) {
    const ramp *r = c->scheme_data;
    return (bough_operating_point){r->middle, c->assembly->member[member]->state,
                                   r->input + c->assembly->input_offset[member], r->gamma};
}

static void predict_leader(bough_coupling *c, int member) {
    const bough_system *s = &c->assembly->member[member]->system;
    const ramp *r = c->scheme_data;
    bough_operating_point at = operating_point(c, member);
    if (s->n_input == 0 && s->n_output == 0) return; // no ports
    if (!evaluate(c, member) || !bough_condensed_linearise(r->interface, member, &at) ||
        !bough_condensed_factor_leader(r->interface, member, &at)) {
        c->status[member] = bough_coupling_not_finite(c, member);
        return;
    }
    solve(c, member, NULL);
}

static void prepare_follower(bough_coupling *c, int member) {
    if (!evaluate(c, member)) c->status[member] = bough_coupling_not_finite(c, member);
}

static void predict_follower(bough_coupling *c, int member) {
    const ramp *r = c->scheme_data;
    bough_operating_point at = operating_point(c, member);
    if (r->fresh && !(bough_condensed_linearise(r->interface, member, &at) &&
                      bough_condensed_factor_follower(r->interface, member, &at))) {
        c->status[member] = bough_coupling_not_finite(c, member);
        return;
    }
    if (r->fresh) bough_condensed_respond(r->interface, member, &at);
    expect_inputs(c, member);
    solve(c, member, r->change + c->assembly->input_offset[member]);
}

// With a heavy interface, followers keep their tangents and responses for some steps; the next step detects
// and compensates the error of such a prediction.
enum { MOST_AGE = 12 };

static void choose_tangents(bough_coupling *c) {
    ramp *r = c->scheme_data;
    double span = r->theta * (c->t1 - c->t0);
    bool same = r->repays && !c->restart && fabs(span - r->span) <= 1e-9 * span;
    r->age = same && r->age < MOST_AGE ? r->age + 1 : 0;
    r->fresh = r->age == 0;
    r->span = span;
}

// The increments of the leaders' inputs into `change`.
static bough_status predict(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    ramp *r = c->scheme_data;
    choose_tangents(c);
    choose_inputs(c);
    r->gamma = r->theta * (c->t1 - c->t0);
    r->middle = c->t0 + r->gamma;
    bough_staged_work work = {predict_leader, prepare_follower, predict_follower};
    bough_status status = bough_coupling_each_staged(c, work);
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i)) expect_inputs(c, i);
    }
    memset(r->interface->coordinate, 0, (size_t)r->interface->n * sizeof(double));
    if (bough_condensed_close(r->interface)) {
        bough_condensed_solve(r->interface, r->change);
        return bough_ok();
    }
    return bough_fail(BOUGH_RETRY, "the interface equations are singular at %.6g s", c->t0);
}

// Above this gain the leaders are lighter than the bodies they carry: the trapezoidal prediction oscillates.
static const double light_interface = 1;

// Below this gain the delayed compensation of impulses is damped: on two masses of any ratio the macro
// step becomes unstable at gains of 0.3 to 1.
static const double heavy_interface = 0.25;

// The weights. Slightly above 1/2 the ramp damps oscillations and loses little accuracy: measured on masses
// of 3 to 1700 times the one that carries them (10 ms, stiff spring), 0.6 is always stable, 1/2 grows by up
// to 18 per second between 30 and 500, and 1, a constant force, grows at a low frequency everywhere.
static const double weights[] = {0.5, 0.55, 0.6, 0.65, 0.7, 0.8};
enum { WEIGHTS = sizeof weights / sizeof *weights };
static const double ringing = 0.05; // growth that does not count [1/s]
static const double rise = 0.1;     // growth in a macro step that no mechanics has
static const double untamed = 10;   // growth that no outer load damps [1/s]

// Growth of the fastest oscillation with these options [1/s].
static bough_status growth_of(const bough_coupling *c, bough_scheme_options options,
                              bough_stability *stability) {
    // the light body turns by about 2 √ratio in a macro step; four linear member steps a radian
    double h = c->t1 - c->t0, part = fmin(8 * sqrt(c->interface_ratio), 64);
    bough_status status = bough_stability_judge_by(c->assembly, &options, h, fmin(h / part, 5e-3), stability);
    if (!bough_is_ok(&status)) stability->growth = HUGE_VAL;
    return status;
}

static bough_status growth_with(const bough_coupling *c, double theta, double *growth) {
    bough_scheme_options options = c->options;
    bough_stability stability;
    options.theta = theta;
    bough_status status = growth_of(c, options, &stability);
    *growth = stability.growth;
    return status;
}

// Whether iterated waveforms are stable where no weight is.
static bool waveforms_hold(const bough_coupling *c) {
    bough_scheme_options options = c->options;
    bough_stability stability;
    options.name = "iterated";
    options.exchange = BOUGH_EXCHANGE_WAVEFORM;
    bough_status status = growth_of(c, options, &stability);
    bool rises = stability.rising * (c->t1 - c->t0) > rise;
    return bough_is_ok(&status) && stability.suspected <= ringing && !rises;
}

// The first stable weight. If there is none, no prediction is good enough and steps are repeated with
// waveforms, if these are stable; else the weight with the smallest growth is taken, which outer loads may
// damp. A constant force, θ = 1, loses the solution and is the last choice.
static bough_status choose_weight(bough_coupling *c) {
    ramp *r = c->scheme_data;
    double least = HUGE_VAL;
    bough_status status = bough_ok();
    for (int k = 0; k < WEIGHTS && least > ringing && bough_is_ok(&status); k++) {
        double growth;
        status = growth_with(c, weights[k], &growth);
        if (!bough_is_ok(&status) || growth >= least) continue;
        least = growth;
        r->final = weights[k];
    }
    if (least <= ringing || !bough_is_ok(&status)) return status;
    r->repeats = waveforms_hold(c);
    if (least > untamed) r->final = 1;
    return status;
}

// The trapezoidal rule does not damp the start of a light body, so the first step is damped.
static bough_status predict_damped(bough_coupling *c) {
    ramp *r = c->scheme_data;
    r->theta = c->t0 < r->damped ? 1 : r->final;
    return predict(c);
}

static bough_status choose_theta(bough_coupling *c) {
    ramp *r = c->scheme_data;
    bough_status status = predict(c);
    if (!bough_is_ok(&status)) return status;
    c->interface_ratio = bough_condensed_radius(r->interface);
    if (!r->chosen && c->interface_ratio > heavy_interface) {
        status = choose_weight(c);
        if (!bough_is_ok(&status) || r->repeats) return status;
        if (r->final > 0.5 || c->interface_ratio > light_interface) r->damped = c->t1;
        status = predict_damped(c);
    }
    r->chosen = true;
    r->repays = r->final == 0.5 && c->interface_ratio < heavy_interface;
    c->theta = r->final;
    return status;
}

// For repeated steps: their memory, and what they exchange.
static bough_status prepare_repetition(bough_coupling *c, bough_arena *arena) {
    c->options.exchange = BOUGH_EXCHANGE_WAVEFORM;
    return bough_iteration_create(c, arena);
}

// Members that have no finite rate of change are left to the first step, which names them.
static bough_status prepare(bough_coupling *c, bough_arena *arena) {
    ramp *r = c->scheme_data;
    bough_status status = choose_theta(c);
    r->span = 0; // loads are sampled before the first step
    if (status.code == BOUGH_RETRY) return bough_ok();
    if (!bough_is_ok(&status) || !r->repeats) return status;
    return prepare_repetition(c, arena);
}

// -- the step -------------------------------------------------------------------------------------

// Constant force for backward Euler: a ramp would restore the oscillations that θ = 1 damps.
static bool held(const ramp *r) { return r->theta >= 1; }

// The ramp with its parabola.
static void set_repaying(bough_coupling *c, bough_signal *signal, int local, int j, double end) {
    double h = c->t1 - c->t0, start = c->applied[j];
    double impulse = c->deficit[j] - h * h * h / 12 * bough_coupling_curvature(c, j, end);
    double middle = 0.5 * (start + end) + 1.5 * impulse / h;
    const double time[] = {c->t0, c->t0 + 0.5 * h, c->t1};
    const double *const value[] = {&start, &middle, &end};
    bough_port_polynomial(signal, local, 1, 3, time, value);
}

static void set_ramps(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    bough_signal *signal = &c->signal[member];
    for (int j = a->input_offset[member], local = 0; j < a->input_offset[member + 1]; j++, local++) {
        double start = c->applied[j], end = start + r->change[j];
        if (!r->repays) c->deficit[j] = 0;
        if (held(r)) {
            bough_port_hold(signal, local, 1, &end);
        } else if (r->repays) {
            set_repaying(c, signal, local, j, end);
        } else {
            bough_port_linear(signal, local, 1, &start, &end);
        }
    }
}

static bough_status repeat(bough_coupling *c) {
    memset(c->deficit, 0, (size_t)c->assembly->n_input * sizeof(double));
    return bough_iteration_step(c);
}

static bough_status step(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    if (c->iteration) return repeat(c);
    bough_coupling_begin(c);
    bough_status status = c->theta > 0 ? predict_damped(c) : choose_theta(c);
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i)) set_ramps(c, i);
    }
    status = bough_coupling_advance_leaders(c, 0, c->restart || held(c->scheme_data));
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i)) continue;
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            bough_coupling_interpolate(c, i, j);
        }
    }
    for (int stage = 1; stage < a->n_stage; stage++) {
        status = bough_coupling_advance(c, stage, c->restart);
        if (!bough_is_ok(&status)) return status;
    }
    return bough_ok();
}

// After a restore it linearises again.
static void snapshot(bough_coupling *c, bough_snapshot *s) {
    ramp *r = c->scheme_data;
    bough_snapshot_take(s, &r->theta, sizeof r->theta);
    bough_snapshot_take(s, &r->final, sizeof r->final);
    bough_snapshot_take(s, &r->damped, sizeof r->damped);
    bough_snapshot_take(s, &r->chosen, sizeof r->chosen);
    bough_snapshot_take(s, &r->repays, sizeof r->repays);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) r->span = 0;
    if (c->iteration) bough_iteration_snapshot(c, s);
}

static int defect_order(const bough_scheme_options *options) {
    (void)options;
    return 2;
}

// The weight, or that steps are repeated.
static void choose(const bough_coupling *c, bough_scheme_options *options) {
    if (c->theta > 0) options->theta = c->theta;
    if (c->iteration) options->name = "iterated";
}

const bough_scheme bough_scheme_ramp = {
    .name = "ramp",
    .summary = "forces change linearly to a linearly implicit prediction; order 3 on heavy "
               "interface bodies, else 2; stable far beyond the explicit limit",
    .reads = BOUGH_READS_THETA,
    .create = create,
    .prepare = prepare,
    .step = step,
    .snapshot = snapshot,
    .defect_order = defect_order,
    .choose = choose,
};

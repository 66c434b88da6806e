// Ramp, linearly implicit. One linearly implicit θ-step of size H of every member, linearised at T_k,
// theory (60), predicts the inputs at the end of the step: their coupled linear equations are solved as in
// interface.h. The leaders then advance under forces that change linearly from the value applied at the end
// of the last step to the predicted value, theory (61). The forces are continuous, so integrators keep their
// history. The other members then advance once with the cubic of the resulting motion.
//
// A parabola that is zero at both ends is added to the linear force. It contains the impulse of the force's
// curvature and compensates the impulse deficit of earlier steps, theory (62), so the exchanged momentum is
// of third order without further cost. It is used on heavy interface bodies only, because elsewhere the
// delayed compensation causes oscillations.
//
// θ = 1/2: order 3 with that impulse, 2 without. Where the interface body is light, the eigenvalues of the
// linearised macro step are computed before the run; if they grow, the scheme refuses the scene. On an
// interface body that is lighter than the bodies it carries the first step has θ = 1, which is damped and of
// order 1. A scene may name another θ, which is taken as it is: of order 1, with an error 2θ − 1 times as
// large.
#include "cosim/analysis/stability.h"
#include "cosim/interface.h"
#include "cosim/scheme.h"

typedef struct ramp {
    // constant
    bool named; // the scene names θ

    // by the first prediction
    bool measured; // it has been made
    double ratio;  // theory (57)
    double damped; // steps that begin before have θ = 1 [s]
    bool repays;   // impulses are compensated

    // by the prediction of a step
    bough_interface *interface;
    double theta;         // of the step
    double middle, gamma; // where and for what members are linearised [s]
    bool fresh;           // followers are linearised in this step
    int age;              // steps since they were
    double span;          // θH then [s]
    double *increment;    // (n_state) Δ of each member if the leaders' inputs did not change
    double *base;         // (n_output) h at the start values
    double *output;       // (n_output) change of the outputs with that
    double *change;       // (n_input) changes of the inputs
    double *input;        // (n_input) at the start of the step, as linearised: what was applied to leaders

    // by the exchange
    double *deficit; // (n_input) ∫ (obtained − applied value) over all steps, of the leaders' inputs
} ramp;

static bool leads(const bough_coupling *c, int member) { return c->assembly->leads[member]; }

// -- memory ---------------------------------------------------------------------------------------

// The elimination needs leaders whose outputs depend on states only, and followers connected with leaders.
static bough_status check_shape(const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i) && a->feedthrough[i]) {
            return bough_fail(
                BOUGH_INVALID,
                "ramp: %s leads, so its outputs must not depend on its inputs directly; use another scheme",
                a->member[i]->system.name);
        }
    }
    for (int j = 0; j < a->n_input; j++) {
        if (leads(c, a->receiver[j]) != leads(c, a->source_member[j])) continue;
        return bough_fail(BOUGH_INVALID,
                          "ramp: leaders and followers may only be connected with each other; use "
                          "another scheme");
    }
    return bough_ok();
}

static bough_status create(bough_coupling *c, bough_arena *arena) {
    const bough_assembly *a = c->assembly;
    BOUGH_TRY(check_shape(c));
    ramp *r = c->scheme_data = bough_arena_take(arena, sizeof *r);
    r->interface = bough_interface_create(arena, a);
    r->increment = bough_arena_doubles(arena, (size_t)a->n_state);
    bough_arena_each(arena, (size_t)a->n_output, &r->base, &r->output);
    bough_arena_each(arena, (size_t)a->n_input, &r->change, &r->input, &r->deficit);
    r->ratio = (double)NAN;
    r->damped = -HUGE_VAL;
    r->named = c->options.theta > 0;
    if (!r->named) c->options.theta = 0.5;
    r->theta = c->options.theta;
    return bough_ok();
}

// -- the θ-step of every member: theory (60) --------------------------------------------------------------

// Leaders start from the inputs that were applied last: that is where the ramp starts.
static void choose_inputs(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    for (int j = 0; j < a->n_input; j++) r->input[j] = leads(c, a->receiver[j]) ? c->applied[j] : c->input[j];
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
    if (change) bough_interface_add_columns(r->interface, member, r->gamma, change, increment);
    bough_interface_solve_member(r->interface, member, increment);
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
    if (!evaluate(c, member) || !bough_interface_linearise(r->interface, member, &at) ||
        !bough_interface_factor(r->interface, member, &at)) {
        bough_coupling_not_finite(c, member);
        return;
    }
    solve(c, member, NULL);
}

static void predict_follower(bough_coupling *c, int member) {
    const ramp *r = c->scheme_data;
    bough_operating_point at = operating_point(c, member);
    if (r->fresh && !(bough_interface_linearise(r->interface, member, &at) &&
                      bough_interface_factor(r->interface, member, &at))) {
        bough_coupling_not_finite(c, member);
        return;
    }
    if (r->fresh) bough_interface_respond(r->interface, member, &at);
    expect_inputs(c, member);
    solve(c, member, r->change + c->assembly->input_offset[member]);
}

// -- the prediction -------------------------------------------------------------------------------

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

// Task k: the leaders; what followers do without them; the followers, which wait for both.
static void predict_member(void *data, int k) {
    bough_coupling *c = data;
    const bough_assembly *a = c->assembly;
    const int *follower = a->by_role, *leader = a->by_role + a->n_follower;
    int n_leader = a->n_member - a->n_follower, place = k - n_leader, last = place - a->n_follower;
    if (place < 0) {
        predict_leader(c, leader[k]);
    } else if (last < 0) {
        if (!evaluate(c, follower[place])) bough_coupling_not_finite(c, follower[place]);
    } else {
        for (int l = 0; l < n_leader; l++) bough_pool_await(c->pool, l);
        bough_pool_await(c->pool, n_leader + last);
        if (bough_is_ok(&c->status[follower[last]])) predict_follower(c, follower[last]);
    }
}

// The increments of the leaders' inputs into `change`.
static bough_status predict(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    ramp *r = c->scheme_data;
    choose_tangents(c);
    choose_inputs(c);
    r->gamma = r->theta * (c->t1 - c->t0);
    r->middle = c->t0 + r->gamma;
    // every member with the leaders' inputs held
    bough_coupling_clear(c);
    int n_follower = a->n_follower, n_leader = a->n_member - n_follower;
    bough_pool_run_pairs(c->pool, n_leader, n_follower, n_leader + 2 * n_follower, predict_member, c);
    BOUGH_TRY(bough_coupling_failure(c));
    // the interface, theory (56)
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i)) expect_inputs(c, i);
    }
    memset(r->interface->coordinate, 0, (size_t)r->interface->n * sizeof(double));
    if (bough_interface_close(r->interface)) {
        bough_interface_solve(r->interface, r->change);
        return bough_ok();
    }
    return bough_fail(BOUGH_RETRY, "the interface equations are singular at %.6g s", c->t0);
}

// -- the first prediction -------------------------------------------------------------------------

// Above this ratio the leaders are lighter than the bodies they carry: the start of θ = 1/2 oscillates.
static const double light_interface = 1;

// Below this ratio the delayed compensation of impulses is damped: on two masses of any ratio the macro
// step becomes unstable at ratios of 0.3 to 1.
static const double heavy_interface = 0.25;

static const double negligible_growth = 0.05; // [1/s]

// Refuses a scene on which the macro step with θ = 1/2 is unstable.
static bough_status check_stability(const bough_coupling *c, double ratio) {
    // a light body oscillates by about 2 √ratio rad in a macro step; four steps of its linear member a radian
    double h = c->t1 - c->t0, parts = fmin(8 * sqrt(ratio), 64);
    bough_stability found;
    bough_status status =
        bough_stability_judge_by(c->assembly, &c->options, h, fmin(h / parts, 5e-3), &found);
    if (!bough_is_ok(&status) || found.growth <= negligible_growth) return status;
    return bough_fail(BOUGH_INVALID,
                      "under ramp the body that carries %.40s is too light for a macro step of %.6g s: "
                      "a vibration of %.3g Hz would grow by %.3g per second (interface ratio %.3g); use "
                      "scheme: " BOUGH_SCHEME_DEFAULT,
                      c->assembly->member[found.body]->system.name, h, found.frequency, found.growth, ratio);
}

// θ = 1/2 does not damp the start of a light body, so the first step has θ = 1.
static bough_status predict_damped(bough_coupling *c) {
    ramp *r = c->scheme_data;
    r->theta = c->t0 < r->damped ? 1 : c->options.theta;
    return predict(c);
}

// The first prediction, which gives the interface ratio, and what follows from the ratio.
static bough_status measure_interface(bough_coupling *c) {
    ramp *r = c->scheme_data;
    BOUGH_TRY(predict(c));
    bough_status status = bough_ok();
    r->ratio = bough_interface_radius(r->interface);
    if (!r->named && r->ratio > heavy_interface) {
        BOUGH_TRY(check_stability(c, r->ratio));
        if (r->ratio > light_interface) r->damped = c->t1;
        status = predict_damped(c);
    }
    r->measured = true;
    r->repays = c->options.theta == 0.5 && r->ratio < heavy_interface;
    return status;
}

// Members that have no finite rate of change are left to the first step, which names them.
static bough_status prepare(bough_coupling *c) {
    ramp *r = c->scheme_data;
    bough_status status = measure_interface(c);
    r->span = 0; // loads are sampled before the first step
    return status.code == BOUGH_RETRY ? bough_ok() : status;
}

// -- the step -------------------------------------------------------------------------------------

// Constant force for backward Euler: a ramp would restore the oscillations that θ = 1 damps.
static bool held(const ramp *r) { return r->theta >= 1; }

// The ramp with its parabola, theory (61, 62).
static void set_repaying(bough_coupling *c, bough_signal *signal, int local, int j, double end) {
    const ramp *r = c->scheme_data;
    double h = c->t1 - c->t0, start = c->applied[j];
    double impulse = r->deficit[j] - h * h * h / 12 * bough_coupling_curvature(c, j, end);
    double middle = 0.5 * (start + end) + 1.5 * impulse / h;
    const double time[] = {c->t0, c->t0 + 0.5 * h, c->t1}, value[] = {start, middle, end};
    bough_signal_polynomial(signal, local, 3, time, value);
}

static void set_ramps(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    bough_signal *signal = &c->signal[member];
    for (int local = 0; local < signal->n; local++) {
        int j = a->input_offset[member] + local;
        double start = c->applied[j], end = start + r->change[j];
        if (!r->repays) r->deficit[j] = 0;
        if (held(r)) {
            bough_signal_hold(signal, local, end);
        } else if (r->repays) {
            set_repaying(c, signal, local, j, end);
        } else {
            bough_signal_linear(signal, local, start, end);
        }
    }
}

static bough_status step(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    bough_coupling_begin(c);
    // the forces at the end of the step
    BOUGH_TRY(r->measured ? predict_damped(c) : measure_interface(c));
    // leaders under ramps
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i)) set_ramps(c, i);
    }
    BOUGH_TRY(bough_coupling_advance_leaders(c, 0, c->restart || held(r)));
    // followers under the leaders' motion
    for (int j = 0; j < a->n_input; j++) {
        if (!leads(c, a->receiver[j])) bough_coupling_interpolate(c, j);
    }
    for (int level = 1; level < a->n_level; level++) BOUGH_TRY(bough_coupling_advance(c, level, c->restart));
    return bough_ok();
}

// theory (62): integral of the obtained value, by its parabola, minus that of the applied value.
static void add_deficit(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    const bough_signal *s = &c->signal[member];
    double h = c->t1 - c->t0;
    for (int k = 0, n = s->n; k < n; k++) {
        const double *applied = s->coefficient + k;
        int j = a->input_offset[member] + k;
        double curvature = bough_coupling_curvature(c, j, c->input[j]);
        double obtained = 0.5 * (c->past.input[0][j] + c->input[j]) - h * h / 12 * curvature;
        r->deficit[j] +=
            h * (obtained - applied[0] - applied[n] / 2 - applied[2 * n] / 3 - applied[3 * n] / 4);
    }
}

static void obtained(bough_coupling *c) {
    for (int i = 0; i < c->assembly->n_member; i++) {
        if (leads(c, i)) add_deficit(c, i);
    }
}

// -- questions ------------------------------------------------------------------------------------

// After a restore it linearises again.
static void snapshot(bough_coupling *c, bough_snapshot *s) {
    ramp *r = c->scheme_data;
    bough_snapshot_doubles(s, r->deficit, c->assembly->n_input);
    BOUGH_SNAPSHOT(s, r->theta, r->ratio, r->damped, r->measured, r->repays);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) r->span = 0;
}

static int defect_order(const bough_scheme_options *options) {
    (void)options;
    return 2;
}

// The ramp itself is of order 2 for any θ; its end value is so for θ = 1/2 alone. 0: the scheme chooses that.
static int error_order(const bough_scheme_options *options) {
    return options->theta > 0 && options->theta != 0.5 ? 1 : 2;
}

// Backward Euler.
static void damp(bough_scheme_options *options) { options->theta = 1; }

static double *impulse(const bough_coupling *c) { return ((const ramp *)c->scheme_data)->deficit; }

static void report(const bough_coupling *c, bough_scheme_report *to) {
    to->interface_ratio = ((const ramp *)c->scheme_data)->ratio;
}

const bough_scheme bough_scheme_ramp = {
    .name = "ramp",
    .summary = "forces change linearly to a linearly implicit prediction; order 3 on heavy "
               "interface bodies, else 2; stable far beyond the explicit limit",
    .reads = BOUGH_READS_THETA,
    .advised = true,
    .create = create,
    .prepare = prepare,
    .step = step,
    .obtained = obtained,
    .snapshot = snapshot,
    .damp = damp,
    .defect_order = defect_order,
    .error_order = error_order,
    .impulse = impulse,
    .report = report,
};

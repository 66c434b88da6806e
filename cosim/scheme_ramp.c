// Ramp, linearly implicit (the default scheme). From one linearly implicit θ-step of size H of every
// member, linearised at T_k,
//     (I − θH J) Δ = H f(T_k + θH, y, u) + θH B δu,   o^ = h(T_{k+1}, y, u) + C Δ + D δu,
// the end-of-step port values are found by solving the coupled linear interface equations. Stage 0
// then advances under forces that run linearly from the value used at the last step's end to the
// predicted one: continuous, so that its integrator keeps its history. The other members follow once
// with the cubic of the motion it really made.
//
// The ramp carries a parabola that is zero at both ends: it gives the impulse that the force's
// curvature adds, and pays back what earlier steps turned out to owe. So momentum is handed over to
// third order at no cost; on heavy interface bodies only, because elsewhere late payment rings.
//
// θ = 1/2: order 3 with that impulse, 2 without. On an interface body that is light against what
// hangs on it the first step takes θ = 1, damped and of order 1. Where, as the eigenvalues of the
// macro step tell, the trapezoidal rule rings there, all steps take the least θ that does not:
// somewhat above 1/2, of order 1 with an error 2θ − 1 times as large, or 1. The interface is solved
// by elimination onto the inputs of the leading members (stage 0); the sensitivities of the followers
// are found along the leaders' state directions when those are fewer than their inputs.
#include "core/base.h"
#include "core/linalg.h"
#include "cosim/port.h"
#include "cosim/scheme.h"
#include "cosim/stability.h"

#include <math.h>
#include <string.h>

// What one member answers to the θ-step.
typedef struct answer {
    double *column;    // (n_input × n_state) ∂f/∂u; of a leader (I − θHJ)⁻¹ θH ∂f/∂u
    double *increment; // (n_state) Δ for the expected input increments
    double *work;      // (n_state)
    double *expected;  // (n_input) input increments if the leaders' inputs did not change
    double *base;      // (n_output) h at the start values
    double *output;    // (n_output) o^ for the expected increments
    double *response;  // (n_direction × n_output) change of o^ along each direction
    double *direction; // (n_direction × n_input) input increments along each direction
    double *tangent;   // leader: (n_state × n_output) ∂h/∂y, a row per state
    int n_direction;   // of a leader its n_input
    int leader;        // follower asked along a leader's states: that member, else −1
} answer;

typedef struct ramp {
    answer *of; // (n_member)
    int n_lead;
    int *lead;      // (n_lead) the inputs of leading members, numbered over all inputs
    double *matrix; // (n_lead × n_lead, column-major)
    double *gain;   // (n_lead × n_lead, column-major) the leaders' inputs' answer to themselves
    double *square; // (n_lead × n_lead)
    double *change; // (n_lead) right side, then the predicted increments
    int *pivot;     // (n_lead)
    double theta; // of the present step
    double final; // after the damped first steps
    double damped; // steps that begin before are damped [s]
    bool chosen;  // θ is final
    bool repays;  // impulses
    bool fresh;   // followers are linearised in this step
    int age;      // steps since they were
    double span;  // θH then [s]
} ramp;

static bool leads(const bough_coupling *c, int member) {
    return c->assembly->stage[member] == 0;
}

// -- memory ---------------------------------------------------------------------------------------

// A follower that one leader with few states feeds is asked along that leader's states.
static void choose_directions(const bough_coupling *c, answer *w, int member) {
    const bough_assembly *a = c->assembly;
    const bough_subsystem *s = a->member[member];
    w->leader = -1;
    w->n_direction = s->n_input;
    if (leads(c, member) || s->n_input == 0) return;
    int first = a->source_member[a->input_offset[member]];
    for (int j = a->input_offset[member]; j < a->input_offset[member + 1]; j++) {
        if (a->source_member[j] != first) return;
    }
    if (a->member[first]->n_state >= s->n_input) return;
    w->leader = first;
    w->n_direction = a->member[first]->n_state;
}

static void take_answer(const bough_coupling *c, bough_arena *arena, answer *w, int member) {
    const bough_subsystem *s = c->assembly->member[member];
    size_t n = (size_t)s->n_state, n_input = (size_t)s->n_input, n_output = (size_t)s->n_output;
    choose_directions(c, w, member);
    size_t n_direction = (size_t)w->n_direction;
    w->column = bough_arena_doubles(arena, n_input * n);
    w->increment = bough_arena_doubles(arena, n);
    w->work = bough_arena_doubles(arena, n);
    w->expected = bough_arena_doubles(arena, n_input);
    w->base = bough_arena_doubles(arena, n_output);
    w->output = bough_arena_doubles(arena, n_output);
    w->response = bough_arena_doubles(arena, n_direction * n_output);
    if (leads(c, member)) {
        w->tangent = bough_arena_doubles(arena, n * n_output);
    } else {
        w->direction = bough_arena_doubles(arena, n_direction * n_input);
    }
}

// The elimination needs leaders that answer by their states only and followers fed by leaders.
static bough_status check_shape(const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    for (int i = 0; i < a->n_member; i++) {
        if (leads(c, i) && a->feedthrough[i]) {
            return bough_fail(BOUGH_INVALID,
                              "scheme ramp: %s leads, so its outputs must not depend on its "
                              "inputs directly; use another scheme",
                              a->member[i]->name);
        }
    }
    for (int i = 0; i < a->n_member; i++) {
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            if (leads(c, i) != leads(c, a->source_member[j])) continue;
            return bough_fail(BOUGH_INVALID, "scheme ramp: stage 0 and the later stages may only "
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
    if (!r) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    r->of = bough_arena_take(arena, (size_t)a->n_member * sizeof *r->of);
    r->lead = bough_arena_take(arena, (size_t)a->n_input * sizeof(int));
    if (bough_arena_exhausted(arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int i = 0; i < a->n_member; i++) {
        take_answer(c, arena, &r->of[i], i);
        if (!leads(c, i)) continue;
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            r->lead[r->n_lead++] = j;
        }
    }
    size_t n = (size_t)r->n_lead;
    r->matrix = bough_arena_doubles(arena, n * n);
    r->gain = bough_arena_doubles(arena, n * n);
    r->square = bough_arena_doubles(arena, n * n);
    r->change = bough_arena_doubles(arena, n);
    r->pivot = bough_arena_take(arena, n * sizeof(int));
    if (bough_arena_exhausted(arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    c->owed = bough_arena_doubles(arena, (size_t)a->n_input);
    if (bough_arena_exhausted(arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    r->damped = -HUGE_VAL;
    r->chosen = c->options.theta > 0;
    r->theta = r->final = r->chosen ? c->options.theta : 0.5;
    c->scheme_data = r;
    return bough_ok();
}

// -- the θ-step of every member -------------------------------------------------------------------

// A leader's ramp starts where the last one ended: that is what it used.
static const double *base_input(const bough_coupling *c, int member) {
    return (leads(c, member) ? c->used : c->input) + c->assembly->input_offset[member];
}

static void add_columns(const answer *w, const bough_subsystem *s, double factor,
                        const double *input, double *sum) {
    for (int j = 0; j < s->n_input; j++) {
        double weight = factor * input[j];
        if (weight == 0) continue;
        const double *column = w->column + (size_t)j * (size_t)s->n_state;
        for (int k = 0; k < s->n_state; k++) sum[k] += weight * column[k];
    }
}

// Factors the member and finds Δ and o^ for the expected input increments.
static bool linearise(bough_coupling *c, int member) {
    const bough_subsystem *s = c->assembly->member[member];
    const ramp *r = c->scheme_data;
    const answer *w = &r->of[member];
    const double *u = base_input(c, member);
    double h = c->t1 - c->t0, middle = c->t0 + r->theta * h;
    if (!s->ops->derivative(s->self, middle, s->state, u, w->increment)) return false;
    if (r->fresh || leads(c, member)) {
        if (!s->ops->newton_setup(s->self, middle, s->state, u, r->theta * h)) return false;
        s->ops->input_columns(s->self, middle, s->state, u, w->column);
    }
    for (int k = 0; k < s->n_state; k++) w->increment[k] *= h;
    add_columns(w, s, r->theta * h, w->expected, w->increment);
    s->ops->newton_solve(s->self, w->increment);

    s->ops->output(s->self, c->t1, s->state, u, w->base);
    s->ops->output_tangent(s->self, c->t1, s->state, u, w->increment, w->expected, w->output);
    for (int p = 0; p < s->n_output; p++) w->output[p] += w->base[p];
    return true;
}

// Row d of the leader's tangent: its outputs' change with its state d.
static void find_tangent(bough_coupling *c, int member, const answer *w) {
    const bough_subsystem *s = c->assembly->member[member];
    memset(w->work, 0, (size_t)s->n_state * sizeof(double));
    for (int d = 0; d < s->n_state; d++) {
        w->work[d] = 1;
        s->ops->output_tangent(s->self, c->t1, s->state, base_input(c, member), w->work, NULL,
                               w->tangent + (size_t)d * (size_t)s->n_output);
        w->work[d] = 0;
    }
}

// response = columnᵀ · tangent, one row per input of the leader
static void find_response(const bough_subsystem *s, const answer *w) {
    size_t n_output = (size_t)s->n_output;
    memset(w->response, 0, (size_t)s->n_input * n_output * sizeof(double));
    for (int j = 0; j < s->n_input; j++) {
        double *row = w->response + (size_t)j * n_output;
        for (int d = 0; d < s->n_state; d++) {
            double z = w->column[(size_t)j * (size_t)s->n_state + (size_t)d];
            const double *tangent = w->tangent + (size_t)d * n_output;
            for (size_t p = 0; p < n_output; p++) row[p] += z * tangent[p];
        }
    }
}

static void predict_leader(bough_coupling *c, int member) {
    const bough_subsystem *s = c->assembly->member[member];
    const ramp *r = c->scheme_data;
    const answer *w = &r->of[member];
    if (s->n_input == 0 && s->n_output == 0) return; // nobody asks
    if (!linearise(c, member)) {
        c->status[member] = bough_coupling_not_finite(c, member);
        return;
    }
    double scale = r->theta * (c->t1 - c->t0);
    for (int j = 0; j < s->n_input; j++) {
        double *column = w->column + (size_t)j * (size_t)s->n_state;
        for (int k = 0; k < s->n_state; k++) column[k] *= scale;
        s->ops->newton_solve(s->self, column);
    }
    find_tangent(c, member, w);
    find_response(s, w);
}

// -- followers ------------------------------------------------------------------------------------

// Output p of a leader changes with none of its inputs: a follower need not be asked about it.
static bool constant_output(const bough_coupling *c, const answer *w, int member, int p) {
    const bough_subsystem *s = c->assembly->member[member];
    for (int j = 0; j < s->n_input; j++) {
        if (w->response[j * s->n_output + p] != 0) return false;
    }
    return true;
}

// The input increments of a follower along each of its directions.
static void find_directions(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const bough_subsystem *s = a->member[member];
    const ramp *r = c->scheme_data;
    const answer *w = &r->of[member];
    memset(w->direction, 0, (size_t)(w->n_direction * s->n_input) * sizeof(double));
    for (int j = 0; j < s->n_input; j++) {
        int input = a->input_offset[member] + j, from = a->source_member[input];
        int p = a->source[input] - a->output_offset[from], n_output = a->member[from]->n_output;
        if (w->leader < 0) {
            if (!constant_output(c, &r->of[from], from, p)) w->direction[j * s->n_input + j] = 1;
            continue;
        }
        for (int d = 0; d < w->n_direction; d++) {
            w->direction[d * s->n_input + j] = r->of[from].tangent[d * n_output + p];
        }
    }
}

static void expect_inputs(bough_coupling *c, int member) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    for (int j = a->input_offset[member]; j < a->input_offset[member + 1]; j++) {
        int from = a->source_member[j];
        double predicted = r->of[from].output[a->source[j] - a->output_offset[from]];
        r->of[member].expected[j - a->input_offset[member]] = predicted - c->input[j];
    }
}

static bool any(const double *x, int n) {
    for (int i = 0; i < n; i++) {
        if (x[i] != 0) return true;
    }
    return false;
}

static void predict_follower(bough_coupling *c, int member) {
    const bough_subsystem *s = c->assembly->member[member];
    const ramp *r = c->scheme_data;
    const answer *w = &r->of[member];
    expect_inputs(c, member);
    if (!linearise(c, member)) {
        c->status[member] = bough_coupling_not_finite(c, member);
        return;
    }
    if (!r->fresh) return;
    find_directions(c, member);
    for (int d = 0; d < w->n_direction; d++) {
        const double *direction = w->direction + d * s->n_input;
        double *response = w->response + d * s->n_output;
        memset(response, 0, (size_t)s->n_output * sizeof(double));
        if (!any(direction, s->n_input)) continue;
        memset(w->work, 0, (size_t)s->n_state * sizeof(double));
        add_columns(w, s, r->theta * (c->t1 - c->t0), direction, w->work);
        s->ops->newton_solve(s->self, w->work);
        s->ops->output_tangent(s->self, c->t1, s->state, base_input(c, member), w->work, direction,
                               response);
    }
}

static void predict_member(bough_coupling *c, int member) {
    if (!leads(c, member)) predict_follower(c, member);
}

// -- the interface --------------------------------------------------------------------------------

static int member_of_input(const bough_assembly *a, int j) {
    int i = 0;
    while (j >= a->input_offset[i + 1]) i++;
    return i;
}

// How far the leader's input j moves a follower along its direction d.
static double coordinate(const bough_coupling *c, int follower, int d, int lead_member, int j) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    const answer *leader = &r->of[lead_member];
    if (r->of[follower].leader >= 0) {
        if (r->of[follower].leader != lead_member) return 0;
        return leader->column[j * a->member[lead_member]->n_state + d];
    }
    int input = a->input_offset[follower] + d;
    if (a->source_member[input] != lead_member) return 0;
    int p = a->source[input] - a->output_offset[lead_member];
    return leader->response[j * a->member[lead_member]->n_output + p];
}

// Column m of the gain: how the forces on the leaders answer to their component m.
static void find_gain_column(bough_coupling *c, int m) {
    const bough_assembly *a = c->assembly;
    const ramp *r = c->scheme_data;
    int owner = member_of_input(a, r->lead[m]), local = r->lead[m] - a->input_offset[owner];
    double *gain = r->gain + m * r->n_lead;
    for (int l = 0; l < r->n_lead; l++) {
        int follower = a->source_member[r->lead[l]], n_output = a->member[follower]->n_output;
        int p = a->source[r->lead[l]] - a->output_offset[follower];
        const answer *w = &r->of[follower];
        double sum = 0;
        for (int d = 0; d < w->n_direction; d++) {
            double response = w->response[d * n_output + p];
            if (response != 0) sum += response * coordinate(c, follower, d, owner, local);
        }
        gain[l] = sum;
    }
}

// Solves (I − gain) change = o^ − start for the increments of the leaders' inputs.
static bool solve_interface(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    ramp *r = c->scheme_data;
    int n = r->n_lead;
    for (int m = 0; m < n; m++) {
        find_gain_column(c, m);
        for (int l = 0; l < n; l++) {
            r->matrix[m * n + l] = (l == m ? 1 : 0) - r->gain[m * n + l];
        }
        int from = a->source_member[r->lead[m]];
        double predicted = r->of[from].output[a->source[r->lead[m]] - a->output_offset[from]];
        r->change[m] = predicted - c->used[r->lead[m]];
    }
    if (n == 0) return true;
    if (!bough_dense_factor(n, r->matrix, r->pivot)) return false;
    bough_dense_solve(n, 1, r->matrix, r->pivot, r->change);
    return true;
}

// result = a a (n × n, column-major)
static void square(int n, const double *a, double *result) {
    memset(result, 0, (size_t)(n * n) * sizeof(double));
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < n; k++) {
            double factor = a[j * n + k];
            for (int i = 0; i < n; i++) result[j * n + i] += factor * a[k * n + i];
        }
    }
}

// The spectral radius of the gain, as ‖gainᵖ‖^(1/p) with p = 2¹²; the gain is overwritten.
static double gain_radius(ramp *r) {
    double logarithm = 0, weight = 1;
    int n = r->n_lead;
    for (int doubling = 0; doubling < 12; doubling++) {
        double norm = 0;
        for (int i = 0; i < n * n; i++) norm = fmax(norm, fabs(r->gain[i]));
        if (norm == 0) return 0;
        logarithm += weight * log(norm);
        weight /= 2;
        for (int i = 0; i < n * n; i++) r->gain[i] /= norm;
        square(n, r->gain, r->square);
        memcpy(r->gain, r->square, (size_t)(n * n) * sizeof(double));
    }
    return exp(logarithm);
}

// Where the interface is heavy, followers keep their tangents and responses for some steps: what a
// prediction so misses is seen in the next step and paid back.
enum { MOST_AGE = 12 };

static void choose_tangents(bough_coupling *c) {
    ramp *r = c->scheme_data;
    double span = r->theta * (c->t1 - c->t0);
    bool same = r->repays && !c->restart && !c->refactor && fabs(span - r->span) <= 1e-9 * span;
    r->age = same && r->age < MOST_AGE ? r->age + 1 : 0;
    r->fresh = r->age == 0;
    r->span = span;
    c->refactor = false;
}

static bough_status predict(bough_coupling *c) {
    choose_tangents(c);
    bough_status status = bough_coupling_each(c, 0, predict_leader);
    if (!bough_is_ok(&status)) return status;
    status = bough_coupling_each(c, BOUGH_ALL_STAGES, predict_member);
    if (!bough_is_ok(&status)) return status;
    if (solve_interface(c)) return bough_ok();
    return bough_fail(BOUGH_FAILED, "the interface equations are singular at %.6g s", c->t0);
}

// Above this gain the leaders weigh less than what hangs on them: the trapezoidal prediction rings.
static const double light_interface = 1;

// Below this gain late payment of impulses is damped: on two masses of any ratio the macro step's
// eigenvalues turn unstable at gains of 0.3 to 1.
static const double heavy_interface = 0.25;

// Weights to choose from. Slightly above 1/2 the ramp damps what rings and loses little: measured on
// masses of 3 to 1700 times the one that carries them (10 ms, stiff spring) 0.6 is stable throughout,
// 1/2 grows by up to 18 per second between 30 and 500, and 1, held, at a low frequency everywhere.
static const double weights[] = {0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 1};
enum { WEIGHTS = sizeof weights / sizeof *weights };
static const double ringing = 0.05; // growth that does not count [1/s]
static const double untamed = 10;   // growth that no outer load damps [1/s]

// Growth of the fastest oscillation with this weight [1/s].
static bough_status growth_with(const bough_coupling *c, double theta, double *growth) {
    bough_scheme_options options = c->options;
    bough_stability stability;
    options.theta = theta;
    // the light body turns by about 2 √ratio in a macro step; four shadow steps a radian
    double h = c->t1 - c->t0, part = fmin(8 * sqrt(c->interface_ratio), 64);
    bough_status status =
        bough_stability_judge_by(c->assembly, &options, h, fmin(h / part, 5e-3), &stability);
    *growth = stability.growth;
    return status;
}

// The first weight under which nothing rings; where all do, the least growth below 1. Outer loads may
// damp slow growth (measured: 2.5 per second on a hub a hundred times too light, damped by the air),
// a held force loses the solution: it is for what nothing else tames.
static bough_status choose_weight(bough_coupling *c) {
    ramp *r = c->scheme_data;
    double least = HUGE_VAL;
    bough_status status = bough_ok();
    for (int k = 0; k < WEIGHTS && least > ringing && bough_is_ok(&status); k++) {
        double growth;
        if (weights[k] >= 1 && least < untamed) break;
        status = growth_with(c, weights[k], &growth);
        if (!bough_is_ok(&status) || growth >= least) continue;
        least = growth;
        r->final = weights[k];
    }
    return status;
}

// The trapezoidal rule never forgets a light body's start, so its first step is damped.
static bough_status predict_damped(bough_coupling *c) {
    ramp *r = c->scheme_data;
    r->theta = c->t0 < r->damped ? 1 : r->final;
    return predict(c);
}

static bough_status choose_theta(bough_coupling *c) {
    ramp *r = c->scheme_data;
    bough_status status = predict(c);
    if (!bough_is_ok(&status)) return status;
    c->interface_ratio = gain_radius(r);
    if (!r->chosen && c->interface_ratio > light_interface) {
        status = choose_weight(c);
        if (!bough_is_ok(&status)) return status;
        r->damped = c->t1;
        status = predict_damped(c);
    }
    r->chosen = true;
    r->repays = r->final == 0.5 && c->interface_ratio < heavy_interface;
    c->theta = r->final;
    return status;
}

// -- the step -------------------------------------------------------------------------------------

// Backward Euler's companion: a ramp would bring back the ringing that θ = 1 damps.
static bool held(const ramp *r) {
    return r->theta >= 1;
}

// The ramp with its parabola.
static void set_repaying(bough_coupling *c, bough_signal *signal, int local, int j, double end) {
    double h = c->t1 - c->t0, start = c->used[j];
    double impulse = c->owed[j] - h * h * h / 12 * bough_coupling_curvature(c, j, end);
    double middle = 0.5 * (start + end) + 1.5 * impulse / h;
    const double time[] = {c->t0, c->t0 + 0.5 * h, c->t1};
    const double *const value[] = {&start, &middle, &end};
    bough_port_polynomial(signal, local, 1, 3, time, value);
}

static void set_ramps(bough_coupling *c) {
    ramp *r = c->scheme_data;
    for (int m = 0; m < r->n_lead; m++) {
        int j = r->lead[m], i = member_of_input(c->assembly, j);
        double start = c->used[j], end = start + r->change[m];
        int local = j - c->assembly->input_offset[i];
        if (!r->repays) c->owed[j] = 0;
        if (held(r)) {
            bough_port_hold(&c->signal[i], local, 1, &end);
        } else if (r->repays) {
            set_repaying(c, &c->signal[i], local, j, end);
        } else {
            bough_port_linear(&c->signal[i], local, 1, &start, &end);
        }
    }
}

static bough_status step(bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    bough_coupling_begin(c);
    bough_status status = c->theta > 0 ? predict_damped(c) : choose_theta(c);
    if (!bough_is_ok(&status)) return status;
    set_ramps(c);
    status = bough_coupling_advance_lead(c, 0, c->restart || held(c->scheme_data));
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

// The answers' age is not in it: `refactor` makes them anew.
static void snapshot(bough_coupling *c, bough_snapshot *s) {
    ramp *r = c->scheme_data;
    bough_snapshot_take(s, &r->theta, sizeof r->theta);
    bough_snapshot_take(s, &r->final, sizeof r->final);
    bough_snapshot_take(s, &r->damped, sizeof r->damped);
    bough_snapshot_take(s, &r->chosen, sizeof r->chosen);
    bough_snapshot_take(s, &r->repays, sizeof r->repays);
}

const bough_scheme bough_scheme_ramp = {
    .name = "ramp",
    .summary = "forces ramp to a linearly implicit prediction; order 3 on heavy interface bodies, "
               "else 2; stable far beyond the explicit limit",
    .create = create,
    .step = step,
    .snapshot = snapshot,
};

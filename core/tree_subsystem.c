// The tree behind the subsystem contract.
#include "core/tree_subsystem.h"

#include "core/base.h"
#include "core/dynamics.h"
#include "core/integrator_ida.h"
#include "core/integrator_radau.h"
#include "core/linalg.h"
#include "core/loop.h"
#include "core/tree_build.h"
#include "core/tree_newton.h"

#include <string.h>

// Finite differences: the cube root of the rounding error for central, the square root for
// one-sided ones balances truncation against cancellation.
static const double central_increment = 6e-6, onesided_increment = 1.5e-8;

// A quaternion's length is no state of the motion; past this the integrator starts anew with 1.
static const double drift_limit = 1e-3;

typedef struct tree_subsystem {
    bough_tree *tree;
    bough_tree_data *data;
    const char *name;
    int n; // n_q + n_v
    double time;
    double *state, *scale;               // (n)
    const bough_signal *signal;          // while advancing
    double *input;                       // (n_input) at the evaluation's time
    bool started;                        // the integrator's history belongs to the state
    bough_ida *ida;                      // one of them, none without states
    bough_radau *radau;
    double *own_state, *own_rate;        // (n) of IDA: quaternions not normalised; of Radau
                                         // own_rate is scratch
    bough_tree_newton *ida_newton, *newton; // of a tree without closures; with them dense:
    double *ida_matrix, *newton_matrix;     // (n × n, column-major)
    int *ida_pivot, *newton_pivot;          // (n)
    double gamma;                           // of the last newton_setup
    double *y, *r, *base, *plus, *minus; // (n) scratch
    long newton_setups, derivatives;
} tree_subsystem;

// -- model exchange --------------------------------------------------------------------------

static bool all_finite(const double *x, int n) {
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return false;
    }
    return true;
}

static bool derivative(void *self, double t, const double *state, const double *input,
                       double *rate) {
    tree_subsystem *s = self;
    s->derivatives++;
    bough_tree_kinematics(s->tree, state, s->data);
    bough_tree_coordinate_rate(s->tree, state, rate); // q̇ = N(q) v
    bool ok = bough_tree_forward_dynamics(s->tree, s->data, t, input, rate + s->tree->n_q);
    if (ok && s->data->loops != NULL) bough_loops_correct(s->tree, s->data, state, rate);
    return ok && all_finite(rate, s->n);
}

static void store3(bough_vec3 x, double *out) { out[0] = x.x, out[1] = x.y, out[2] = x.z; }

// The part of an end's velocity that is the link's, R u: from link to joint axes.
static bough_vec3 in_joint_axes(const tree_subsystem *s, int link, bough_vec3 u) {
    bough_mat3 placement = s->tree->links[link].joint.placement.rotation;
    return bough_mat3_tmul(placement, bough_mat3_mul(s->data->relative[link].rotation, u));
}

// u, W, x, p of every end.
static void end_outputs(const tree_subsystem *s, const double *state, double *out) {
    for (int e = 0; e < s->tree->n_ends; e++, out += BOUGH_END_OUTPUTS) {
        int i = s->tree->ends[e].link;
        bough_twist twist = s->data->twist[i];
        store3(in_joint_axes(s, i, twist.linear), out);
        store3(twist.angular, out + 3);
        memcpy(out + 6, state + s->tree->links[i].first_coordinate, 7 * sizeof *out);
    }
}

// δ(R u) = R (δu + δη × u); the links' tangents stand in the data.
static void end_tangents(const tree_subsystem *s, const double *state, const double *change,
                         double *out) {
    for (int e = 0; e < s->tree->n_ends; e++, out += BOUGH_END_OUTPUTS) {
        int i = s->tree->ends[e].link;
        const bough_link *link = &s->tree->links[i];
        const double *own = change + link->first_coordinate;
        double eta[BOUGH_JOINT_SPEEDS];
        bough_joint_speed(&link->joint, state + link->first_coordinate, own, eta);
        bough_twist d = s->data->acceleration[i];
        bough_vec3 turned = bough_cross(bough_v3(eta[3], eta[4], eta[5]), s->data->twist[i].linear);
        store3(in_joint_axes(s, i, bough_add(d.linear, turned)), out);
        store3(d.angular, out + 3);
        memcpy(out + 6, own, 7 * sizeof *out);
    }
}

static void output(void *self, double t, const double *state, const double *input, double *out) {
    (void)t, (void)input;
    tree_subsystem *s = self;
    bough_tree_kinematics(s->tree, state, s->data);
    for (int p = 0; p < s->tree->n_ports; p++, out += BOUGH_PORT_OUTPUTS) {
        const bough_frame *port = &s->tree->ports[p];
        bough_vec3 g = port->link < 0 ? s->tree->gravity : s->data->gravity[port->link];
        bough_twist_store(bough_tree_frame_twist(s->data, port), out);
        store3(bough_mat3_tmul(port->placement.rotation, g), out + 6);
    }
    end_outputs(s, state, out);
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *out) {
    (void)t, (void)input, (void)input_rate; // a wrench moves nothing at once
    tree_subsystem *s = self;
    memset(out, 0, (size_t)bough_tree_n_outputs(s->tree) * sizeof(double));
    if (state_rate == NULL) return;
    bough_tree_kinematics(s->tree, state, s->data);
    bough_tree_tangent(s->tree, state, state_rate, s->data);
    for (int p = 0; p < s->tree->n_ports; p++, out += BOUGH_PORT_OUTPUTS) {
        const bough_frame *port = &s->tree->ports[p];
        if (port->link < 0) continue;
        bough_twist_store(bough_twist_to_child(&port->placement, s->data->acceleration[port->link]),
                          out);
        store3(bough_mat3_tmul(port->placement.rotation, s->data->gravity_rate[port->link]),
               out + 6);
    }
    end_tangents(s, state, state_rate, out);
}

static void input_columns(void *self, double t, const double *state, const double *input,
                          double *column) {
    tree_subsystem *s = self;
    const bough_tree *tree = s->tree;
    bough_tree_kinematics(tree, state, s->data);
    bough_tree_forward_dynamics(tree, s->data, t, input, s->r); // for its factors
    for (int j = 0; j < bough_tree_n_inputs(tree); j++, column += s->n) {
        double unit[BOUGH_PORT_INPUTS] = {0};
        int port = j / BOUGH_PORT_INPUTS, end = port - tree->n_ports; // six inputs of either
        unit[j % BOUGH_PORT_INPUTS] = 1;
        const bough_frame *frame = end < 0 ? &tree->ports[port] : &tree->ends[end];
        bough_wrench wrench = end < 0 ? bough_wrench_load(unit)
                                      : bough_tree_end_wrench(tree, s->data, end, unit);
        memset(column, 0, (size_t)tree->n_q * sizeof(double));
        bough_tree_response(tree, s->data, frame, wrench, column + tree->n_q);
    }
}

// The increment of a state that keeps y + δ − y exact to its last digit
static double increment_at(double y, double relative) { return relative * fmax(1, fabs(y)); }

// f is defined for quaternions of any length, so its derivative by components is consistent.
static bool dense_setup(tree_subsystem *s, double t, const double *state, const double *input,
                        double gamma) {
    int n = s->n;
    memcpy(s->y, state, (size_t)n * sizeof(double));
    for (int j = 0; j < n; j++) {
        // Coordinates enter by sines and cosines: their increment does not grow with them.
        double d = j < s->tree->n_q ? central_increment : increment_at(state[j], central_increment);
        double high = state[j] + d, low = state[j] - d;
        s->y[j] = high;
        bool ok = derivative(s, t, s->y, input, s->plus);
        s->y[j] = low;
        ok = ok && derivative(s, t, s->y, input, s->minus);
        s->y[j] = state[j];
        if (!ok) return false;
        double *column = s->newton_matrix + (size_t)n * (size_t)j, factor = gamma / (high - low);
        for (int i = 0; i < n; i++)
            column[i] = -factor * (s->plus[i] - s->minus[i]);
        column[j] += 1;
    }
    return bough_dense_factor(n, s->newton_matrix, s->newton_pivot);
}

static bool newton_setup(void *self, double t, const double *state, const double *input,
                         double gamma) {
    tree_subsystem *s = self;
    s->newton_setups++;
    s->gamma = gamma;
    if (s->newton == NULL) return dense_setup(s, t, state, input, gamma);
    return derivative(s, t, state, input, s->plus) &&
           bough_tree_newton_setup(s->newton, s->data, t, input, state, s->plus + s->tree->n_q,
                                   1 / gamma);
}

// x = b + γ δf, in the form of tree_newton.h: c δq − δ(N v) = c b_q and c δv − c b_v = δv̇.
static void newton_solve(void *self, double *x) {
    tree_subsystem *s = self;
    if (s->newton == NULL) {
        bough_dense_solve(s->n, 1, s->newton_matrix, s->newton_pivot, x);
        return;
    }
    const bough_tree *tree = s->tree;
    double c = 1 / s->gamma;
    for (int i = 0; i < tree->n_v; i++) {
        s->r[i] = -c * x[tree->n_q + i];
        s->plus[i] = x[tree->n_q + i];
        x[tree->n_q + i] = 0;
    }
    for (int i = 0; i < tree->n_q; i++)
        x[i] *= c;
    for (int i = 0; i < tree->n_links; i++) { // δq̇ = δv, δv̇ = 0
        const bough_link *link = &tree->links[i];
        if (link->motion == NULL) continue;
        double *q = x + link->first_coordinate, *v = x + tree->n_q + link->first_speed;
        v[0] = s->plus[link->first_speed];
        q[0] = s->gamma * (q[0] + v[0]);
    }
    bough_tree_newton_solve(s->newton, s->r, x);
}

// -- own steps by IDA ------------------------------------------------------------------------

// A tree without ports may be advanced without a signal.
static void evaluate_input(tree_subsystem *s, double t) {
    if (s->signal != NULL && s->signal->n > 0) bough_signal_value(s->signal, t, s->input);
}

// Prescribed joints are where they should be, not where their integrated acceleration takes them.
static void prescribed_rows(const bough_tree *tree, double t, const double *y, double *r) {
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        if (link->motion == NULL) continue;
        int q = link->first_coordinate, v = tree->n_q + link->first_speed;
        bough_motion_point p = bough_motion_at(link->motion, t);
        r[q] = y[q] - p.q;
        r[v] = y[v] - p.v;
    }
}

static bool residual(void *self, double t, const double *y, const double *rate, double *r) {
    tree_subsystem *s = self;
    const bough_tree *tree = s->tree;
    evaluate_input(s, t);
    if (s->data->loops != NULL) { // the multipliers need the forward dynamics anyway
        bool ok = derivative(s, t, y, s->input, r);
        for (int i = 0; i < s->n; i++)
            r[i] = rate[i] - r[i];
        prescribed_rows(tree, t, y, r);
        return ok;
    }
    bough_tree_kinematics(tree, y, s->data);
    bough_tree_coordinate_rate(tree, y, r);
    for (int i = 0; i < tree->n_q; i++)
        r[i] = rate[i] - r[i]; // q̇ − N(q) v
    bough_tree_inverse_dynamics(tree, s->data, t, s->input, rate + tree->n_q, r + tree->n_q);
    prescribed_rows(tree, t, y, r);
    return true;
}

// ∂F/∂y + cj ∂F/∂ẏ by columns: F is linear in the rates, so that cj may be of any size.
static bool residual_setup(void *self, double t, const double *y, const double *rate, double cj) {
    tree_subsystem *s = self;
    int n = s->n;
    if (s->ida_newton != NULL) {
        evaluate_input(s, t);
        return bough_tree_newton_setup(s->ida_newton, s->data, t, s->input, y,
                                       rate + s->tree->n_q, cj);
    }
    residual(s, t, y, rate, s->base);
    memcpy(s->y, y, (size_t)n * sizeof(double));
    memcpy(s->r, rate, (size_t)n * sizeof(double));
    for (int j = 0; j < n; j++) {
        double high = y[j] + increment_at(y[j], onesided_increment), d = high - y[j];
        s->y[j] = high;
        s->r[j] = rate[j] + cj * d;
        residual(s, t, s->y, s->r, s->plus);
        s->y[j] = y[j];
        s->r[j] = rate[j];
        double *column = s->ida_matrix + (size_t)n * (size_t)j;
        for (int i = 0; i < n; i++)
            column[i] = (s->plus[i] - s->base[i]) / d;
    }
    return bough_dense_factor(n, s->ida_matrix, s->ida_pivot);
}

static void residual_solve(void *self, double *x) {
    tree_subsystem *s = self;
    if (s->ida_newton != NULL) {
        bough_tree_newton_solve(s->ida_newton, NULL, x);
    } else {
        bough_dense_solve(s->n, 1, s->ida_matrix, s->ida_pivot, x);
    }
}

static void normalise(tree_subsystem *s) {
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        bough_joint_normalise(&link->joint, s->state + link->first_coordinate);
    }
}

static bool has_drifted(const tree_subsystem *s) {
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        if (bough_joint_drift(&link->joint, s->own_state + link->first_coordinate) > drift_limit) {
            return true;
        }
    }
    return false;
}

// f under the signal, prescribed joints where they should be; its derivative by one-sided differences
static bool rate_of_change(void *self, double t, const double *y, double *rate) {
    tree_subsystem *s = self;
    evaluate_input(s, t);
    memcpy(s->own_rate, y, (size_t)s->n * sizeof(double));
    bough_tree_prescribe(s->tree, t, s->own_rate);
    return derivative(s, t, s->own_rate, s->input, rate);
}

static bool rate_jacobian(void *self, double t, const double *y, double *matrix) {
    tree_subsystem *s = self;
    int n = s->n;
    if (!rate_of_change(s, t, y, s->base)) return false;
    memcpy(s->y, y, (size_t)n * sizeof(double));
    for (int j = 0; j < n; j++) {
        double d = j < s->tree->n_q ? onesided_increment : increment_at(y[j], onesided_increment);
        s->y[j] = y[j] + d;
        d = s->y[j] - y[j];
        if (!rate_of_change(s, t, s->y, s->plus)) return false;
        s->y[j] = y[j];
        for (int i = 0; i < n; i++)
            matrix[(size_t)n * (size_t)j + (size_t)i] = (s->plus[i] - s->base[i]) / d;
    }
    return true;
}

static bough_status start_radau(tree_subsystem *s) {
    if (s->started) bough_radau_jump(s->radau);
    if (!s->started) bough_radau_start(s->radau, s->time, s->state);
    s->started = true;
    return bough_ok();
}

static bough_status start(tree_subsystem *s) {
    if (s->radau != NULL) return start_radau(s);
    evaluate_input(s, s->time);
    if (!derivative(s, s->time, s->state, s->input, s->own_rate)) {
        return bough_fail(BOUGH_FAILED,
                          "%s at t = %.9g s: the accelerations are not finite; try a smaller "
                          "macro step",
                          s->name, s->time);
    }
    s->started = true;
    return bough_ida_start(s->ida, s->time, s->state, s->own_rate);
}

static bough_status advance(void *self, double t1, const bough_signal *input, bool restart) {
    tree_subsystem *s = self;
    if (s->n == 0) {
        s->time = t1;
        return bough_ok();
    }
    bough_status status = bough_ok();
    s->signal = input;
    if (restart || !s->started) status = start(s);
    if (bough_is_ok(&status)) {
        status = s->radau != NULL ? bough_radau_advance(s->radau, t1, s->own_state)
                                  : bough_ida_advance(s->ida, t1, s->own_state, s->own_rate);
    }
    if (!bough_is_ok(&status)) {
        s->started = false;
        return status;
    }
    s->time = t1;
    memcpy(s->state, s->own_state, (size_t)s->n * sizeof(double));
    bough_tree_prescribe(s->tree, t1, s->state);
    normalise(s);
    if (has_drifted(s)) s->started = false;
    return status;
}

// -- state -----------------------------------------------------------------------------------

// Of Radau all is kept, of IDA, whose history the library hides, nothing.
static size_t save_size(void *self) {
    tree_subsystem *s = self;
    size_t own = s->radau != NULL ? bough_radau_save_size(s->radau) : 0;
    return (2 + (size_t)s->n) * sizeof(double) + own;
}

static void save(void *self, void *copy) {
    tree_subsystem *s = self;
    double *to = copy;
    to[0] = s->time;
    to[1] = s->started && s->radau != NULL;
    memcpy(to + 2, s->state, (size_t)s->n * sizeof(double));
    if (s->radau != NULL) bough_radau_save(s->radau, to + 2 + s->n);
}

static void set_state(void *self, double t, const double *state) {
    tree_subsystem *s = self;
    s->time = t;
    memmove(s->state, state, (size_t)s->n * sizeof(double));
    normalise(s);
    s->started = false;
}

static void restore(void *self, const void *copy) {
    tree_subsystem *s = self;
    const double *from = copy;
    s->time = from[0];
    s->started = from[1] != 0;
    memcpy(s->state, from + 2, (size_t)s->n * sizeof(double));
    if (s->radau != NULL) bough_radau_restore(s->radau, from + 2 + s->n);
}

static void statistics(void *self, bough_statistics *sum) {
    tree_subsystem *s = self;
    *sum = (bough_statistics){0};
    if (s->ida != NULL) bough_ida_statistics(s->ida, sum);
    if (s->radau != NULL) bough_radau_statistics(s->radau, sum);
    sum->derivatives += s->derivatives;
    sum->factorisations += s->newton_setups;
}

// δq ← N N⁺ δq
static void project(void *self, const double *state, double *x) {
    tree_subsystem *s = self;
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        const double *q = state + link->first_coordinate;
        double *change = x + link->first_coordinate, speed[BOUGH_JOINT_SPEEDS];
        bough_joint_speed(&link->joint, q, change, speed);
        bough_joint_rate(&link->joint, q, speed, change);
    }
}

static const bough_subsystem_ops operations = {
    .derivative = derivative,
    .output = output,
    .output_tangent = output_tangent,
    .input_columns = input_columns,
    .newton_setup = newton_setup,
    .newton_solve = newton_solve,
    .advance = advance,
    .save_size = save_size,
    .save = save,
    .restore = restore,
    .set_state = set_state,
    .statistics = statistics,
    .project = project,
};

// -- construction ----------------------------------------------------------------------------

static bool take(bough_arena *arena, tree_subsystem *s) {
    size_t n = (size_t)s->n;
    double **vectors[] = {&s->state, &s->scale, &s->own_state, &s->own_rate, &s->y,
                          &s->r,     &s->base,  &s->plus,      &s->minus};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        *vectors[i] = bough_arena_doubles(arena, n);
    }
    s->input = bough_arena_doubles(arena, (size_t)bough_tree_n_inputs(s->tree));
    return !bough_arena_exhausted(arena);
}

static bough_status take_newton(bough_arena *arena, tree_subsystem *s, bool ida) {
    size_t n = (size_t)s->n;
    bough_status status = bough_ok();
    if (s->tree->n_closures == 0) {
        status = bough_tree_newton_create(arena, s->tree, &s->newton);
        if (ida && bough_is_ok(&status)) {
            status = bough_tree_newton_create(arena, s->tree, &s->ida_newton);
        }
        return status;
    }
    s->newton_matrix = bough_arena_doubles(arena, n * n);
    s->newton_pivot = bough_arena_take(arena, n * sizeof(int));
    if (ida) s->ida_matrix = bough_arena_doubles(arena, n * n);
    if (ida) s->ida_pivot = bough_arena_take(arena, n * sizeof(int));
    if (!bough_arena_exhausted(arena)) return status;
    return bough_fail(BOUGH_OUT_OF_MEMORY, "no memory for the tree's Newton matrices");
}

static bough_status create_integrator(bough_arena *arena, tree_subsystem *s,
                                      bough_tree_solver solver, double rtol) {
    if (s->n == 0) return bough_ok();
    if (solver == BOUGH_TREE_RADAU) {
        bough_ode ode = {s->name, s->n, s, rate_of_change, rate_jacobian};
        return bough_radau_create(arena, &ode, s->scale, rtol, &s->radau);
    }
    bough_dae dae = {.name = s->name,
                     .n = s->n,
                     .self = s,
                     .residual = residual,
                     .setup = residual_setup,
                     .solve = residual_solve};
    return bough_ida_create(arena, &dae, s->scale, rtol, &s->ida);
}

static void describe(tree_subsystem *s, bough_subsystem *subsystem) {
    *subsystem = (bough_subsystem){
        .name = s->name,
        .kind = "tree",
        .solver = s->radau != NULL ? "Radau IIA" : "IDA",
        .n_state = s->n,
        .n_input = bough_tree_n_inputs(s->tree),
        .n_output = bough_tree_n_outputs(s->tree),
        .scale = s->scale,
        .time = &s->time,
        .state = s->state,
        .ops = &operations,
        .self = s,
    };
}

bough_status bough_tree_subsystem_create(bough_arena *arena, bough_tree *tree, const char *name,
                                         double start_time, bough_tree_solver solver, double rtol,
                                         bough_subsystem *subsystem) {
    tree_subsystem *s = bough_arena_take(arena, sizeof *s);
    if (s == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "no memory for the tree's integrator");
    s->tree = tree;
    s->n = tree->n_q + tree->n_v;
    s->name = bough_arena_string(arena, name);
    bough_status status = bough_tree_data_create(arena, tree, &s->data);
    if (!bough_is_ok(&status)) return status;
    if (!take(arena, s)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "no memory for the tree's integrator");
    }
    for (int i = 0; i < s->n; i++)
        s->scale[i] = 1;
    set_state(s, start_time, tree->initial);
    status = take_newton(arena, s, solver == BOUGH_TREE_IDA);
    if (bough_is_ok(&status)) status = create_integrator(arena, s, solver, rtol);
    if (bough_is_ok(&status)) describe(s, subsystem);
    return status;
}

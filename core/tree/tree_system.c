// The tree as a system: core/solve/system.h.
#include "core/tree/tree.h"

#include "core/base/linalg.h"
#include "core/tree/dynamics.h"
#include "core/tree/loop.h"
#include "core/tree/tree_newton.h"

// Central differences: the cube root of the rounding error balances truncation against cancellation.
static const double central_increment = 6e-6;

// A quaternion's length is not a state of the motion; beyond this deviation the integrator restarts with 1.
static const double drift_limit = 1e-3;

typedef struct tree_system {
    bough_tree *tree;
    bough_tree_data *data;
    int n;                        // n_q + n_v
    bool prescribed;              // some joints' motions are given
    bool moved;                   // the data have the kinematics of the state `at`
    double *at;                   // (n)
    double *initial, *scale;      // (n)
    double *placed;               // (n) a state with the given motions in place
    double *increment;            // (n_q) of the coordinates for differences
    double *r, *plus, *minus, *y; // (n) scratch
} tree_system;

// One linearisation and its factors
typedef struct tree_factors {
    double time, gamma;
    double *state, *input, *rate; // (n), (n_input), (n): where it is linearised, and f there
    bough_tree_newton *newton;    // NULL with closures:
    double *jacobian, *matrix;    // (n × n, column-major) ∂f/∂y; I − γ ∂f/∂y, factored
    int *pivot;                   // (n)
} tree_factors;

// -- model exchange --------------------------------------------------------------------------

// The state with the positions of prescribed joints at t. f and h depend on the prescribed motion, not on
// the states of these joints, so that no integrator causes a drift.
static const double *place(tree_system *s, double t, const double *state) {
    if (!s->prescribed) return state;
    memcpy(s->placed, state, (size_t)s->n * sizeof(double));
    bough_tree_prescribe(s->tree, t, s->placed);
    return s->placed;
}

// The kinematics at a state. f is often asked for where h has just been, or where speeds alone differ: then
// inertias and mobility remain.
static void move_to(tree_system *s, const double *state) {
    bough_tree_data *d = s->data;
    size_t n_q = (size_t)s->tree->n_q, n_v = (size_t)s->tree->n_v;
    bool remain = s->moved && memcmp(s->at, state, n_q * sizeof(double)) == 0;
    if (remain && memcmp(s->at + n_q, state + n_q, n_v * sizeof(double)) == 0) return;
    bool factored = d->factored, found = d->loops && d->loops->found;
    bough_tree_kinematics(s->tree, state, d);
    d->factored = remain && factored;
    if (d->loops) d->loops->found = remain && found;
    memcpy(s->at, state, (size_t)s->n * sizeof(double));
    s->moved = true;
}

static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    tree_system *s = self;
    state = place(s, t, state);
    move_to(s, state);
    bough_tree_coordinate_rate(s->tree, state, rate); // q̇ = N(q) v
    bool ok = bough_tree_forward_dynamics(s->tree, s->data, t, input, rate + s->tree->n_q);
    if (ok && s->data->loops != NULL) bough_loops_correct(s->tree, s->data, state, rate);
    return ok && bough_all_finite(s->n, rate);
}

// The part of an end's velocity that is the link's, R u: from link to joint axes.
static bough_vec3 in_joint_axes(const tree_system *s, int link, bough_vec3 u) {
    bough_mat3 placement = s->tree->links[link].joint.placement.rotation;
    return bough_mat3_tmul(placement, bough_mat3_mul(s->data->relative[link].rotation, u));
}

// u, W, x, p of every end.
static void end_outputs(const tree_system *s, const double *state, double *out) {
    for (int e = 0; e < s->tree->n_ends; e++, out += BOUGH_END_OUTPUTS) {
        int i = s->tree->ends[e].link;
        bough_twist twist = s->data->twist[i];
        bough_v3_store(in_joint_axes(s, i, twist.linear), out);
        bough_v3_store(twist.angular, out + 3);
        memcpy(out + 6, state + s->tree->links[i].first_coordinate, 7 * sizeof *out);
    }
}

// δ(R u) = R (δu + δη × u); the links' tangents are in the data.
static void end_tangents(const tree_system *s, const double *state, const double *change, double *out) {
    for (int e = 0; e < s->tree->n_ends; e++, out += BOUGH_END_OUTPUTS) {
        int i = s->tree->ends[e].link;
        const bough_link *link = &s->tree->links[i];
        const double *own = change + link->first_coordinate;
        double eta[BOUGH_JOINT_SPEEDS];
        bough_joint_speed(&link->joint, state + link->first_coordinate, own, eta);
        bough_twist d = s->data->acceleration[i];
        bough_vec3 turned = bough_cross(bough_v3_load(eta + 3), s->data->twist[i].linear);
        bough_v3_store(in_joint_axes(s, i, bough_add(d.linear, turned)), out);
        bough_v3_store(d.angular, out + 3);
        memcpy(out + 6, own, 7 * sizeof *out);
    }
}

// The ground's axes in those of a port.
static bough_mat3 axes_at(const tree_system *s, int a) {
    const bough_frame *port = &s->tree->ports[s->tree->axes[a]];
    return bough_mat3_transpose(bough_tree_frame_pose(s->data, port).rotation);
}

static void axes_outputs(const tree_system *s, double *out) {
    for (int a = 0; a < s->tree->n_axes; a++, out += BOUGH_AXES_OUTPUTS) {
        bough_mat3 e = axes_at(s, a);
        bough_v3_store(e.c1, out);
        bough_v3_store(e.c2, out + 3);
        bough_v3_store(e.c3, out + 6);
    }
}

// δ(Eᵀ) along the change of the port's rotation
static void axes_tangents(const tree_system *s, double *out) {
    for (int a = 0; a < s->tree->n_axes; a++, out += BOUGH_AXES_OUTPUTS) {
        const bough_frame *port = &s->tree->ports[s->tree->axes[a]];
        if (port->link < 0) continue;
        bough_mat3 e = axes_at(s, a);
        bough_vec3 eta = bough_mat3_tmul(port->placement.rotation, s->data->rotation[port->link]);
        bough_v3_store(bough_cross(e.c1, eta), out);
        bough_v3_store(bough_cross(e.c2, eta), out + 3);
        bough_v3_store(bough_cross(e.c3, eta), out + 6);
    }
}

// Twist and gravity at each port, in its axes; motion of the ends; axes.
static void output(void *self, double t, const double *state, const double *input, double *out) {
    (void)input;
    tree_system *s = self;
    state = place(s, t, state);
    move_to(s, state);
    for (int p = 0; p < s->tree->n_ports; p++, out += BOUGH_PORT_OUTPUTS) {
        const bough_frame *port = &s->tree->ports[p];
        bough_vec3 g = port->link < 0 ? s->tree->gravity : s->data->gravity[port->link];
        bough_twist_store(bough_tree_frame_twist(s->data, port), out);
        bough_v3_store(bough_mat3_tmul(port->placement.rotation, g), out + 6);
    }
    end_outputs(s, state, out);
    axes_outputs(s, out + BOUGH_END_OUTPUTS * s->tree->n_ends);
}

// δo along a change of the state: out (n_output).
static void outputs_change(tree_system *s, const double *state, const double *change, double *out) {
    memset(out, 0, (size_t)bough_tree_n_outputs(s->tree) * sizeof(double));
    move_to(s, state);
    bough_tree_tangent(s->tree, state, change, s->data);
    for (int p = 0; p < s->tree->n_ports; p++, out += BOUGH_PORT_OUTPUTS) {
        const bough_frame *port = &s->tree->ports[p];
        if (port->link < 0) continue;
        bough_twist_store(bough_twist_to_child(&port->placement, s->data->acceleration[port->link]), out);
        bough_vec3 g = bough_cross(s->data->gravity[port->link], s->data->rotation[port->link]);
        bough_v3_store(bough_mat3_tmul(port->placement.rotation, g), out + 6);
    }
    end_tangents(s, state, change, out);
    axes_tangents(s, out + BOUGH_END_OUTPUTS * s->tree->n_ends);
}

// x with the entries of prescribed joints made 0, or, `given`, with all others.
static void select_states(const tree_system *s, bool given, double *x) {
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        if ((link->motion != NULL) == given) continue;
        for (int k = 0; k < link->n_coordinates; k++) x[link->first_coordinate + k] = 0;
        for (int k = 0; k < link->n_speeds; k++) x[s->tree->n_q + link->first_speed + k] = 0;
    }
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *out) {
    (void)input, (void)input_rate; // motions do not depend on wrenches directly
    tree_system *s = self;
    if (state_rate == NULL) {
        memset(out, 0, (size_t)bough_tree_n_outputs(s->tree) * sizeof(double));
        return;
    }
    if (s->prescribed) {
        memcpy(s->y, state_rate, (size_t)s->n * sizeof(double));
        select_states(s, false, s->y);
        state_rate = s->y;
    }
    outputs_change(s, place(s, t, state), state_rate, out);
}

// ∂h/∂t, by prescribed joints.
static void output_drift(void *self, double t, const double *state, const double *input, double *drift) {
    tree_system *s = self;
    if (!s->prescribed || !derivative(s, t, state, input, s->y)) {
        memset(drift, 0, (size_t)bough_tree_n_outputs(s->tree) * sizeof(double));
        return;
    }
    select_states(s, true, s->y);
    outputs_change(s, s->placed, s->y, drift);
}

// M⁻¹ times the unit wrenches at ports and ends.
static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    tree_system *s = self;
    const bough_tree *tree = s->tree;
    // articulated bodies at this state, then one response for each input
    move_to(s, place(s, t, state));
    bough_tree_forward_dynamics(tree, s->data, t, input, s->r); // for its factors
    for (int j = 0; j < bough_tree_n_inputs(tree); j++, column += s->n) {
        double unit[BOUGH_PORT_INPUTS] = {0};
        int port = j / BOUGH_PORT_INPUTS, end = port - tree->n_ports; // six inputs of either
        unit[j % BOUGH_PORT_INPUTS] = 1;
        const bough_frame *frame = end < 0 ? &tree->ports[port] : &tree->ends[end];
        bough_wrench wrench =
            end < 0 ? bough_wrench_load(unit) : bough_tree_end_wrench(tree, s->data, end, unit);
        memset(column, 0, (size_t)tree->n_q * sizeof(double));
        bough_tree_response(tree, s->data, frame, wrench, column + tree->n_q);
    }
}

// Coordinates enter by sines and cosines: their increments do not grow with them. Those of lengths are small
// against a small mechanism.
static void find_increments(tree_system *s) {
    const bough_tree *tree = s->tree;
    double length = central_increment * fmin(1, tree->closure_size);
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int n = bough_joint_n_slides(link->joint.kind);
        for (int k = 0; k < link->n_coordinates; k++)
            s->increment[link->first_coordinate + k] = k < n ? length : central_increment;
    }
}

// ∂f/∂y by differences. f is defined for quaternions of any length, so its derivative by components
// is consistent.
static bool find_jacobian(tree_system *s, tree_factors *k) {
    int n = s->n;
    memcpy(s->y, k->state, (size_t)n * sizeof(double));
    for (int j = 0; j < n; j++) {
        double y = k->state[j];
        double d = j < s->tree->n_q ? s->increment[j] : central_increment * fmax(1, fabs(y));
        double high = y + d, low = y - d;
        s->y[j] = high;
        bool ok = derivative(s, k->time, s->y, k->input, s->plus);
        s->y[j] = low;
        ok = ok && derivative(s, k->time, s->y, k->input, s->minus);
        s->y[j] = y;
        if (!ok) return false;
        double *column = k->jacobian + (size_t)n * (size_t)j;
        for (int i = 0; i < n; i++) column[i] = (s->plus[i] - s->minus[i]) / (high - low);
    }
    return true;
}

static void *factors(void *self, bough_arena *arena) {
    const tree_system *s = self;
    size_t n = (size_t)s->n;
    tree_factors *k = bough_arena_take(arena, sizeof *k);
    bough_arena_each(arena, n, &k->state, &k->rate);
    k->input = bough_arena_doubles(arena, (size_t)bough_tree_n_inputs(s->tree));
    if (s->tree->n_closures == 0) {
        k->newton = bough_tree_newton_create(arena, s->tree);
        return k;
    }
    bough_arena_each(arena, n * n, &k->jacobian, &k->matrix);
    k->pivot = bough_arena_take(arena, n * sizeof(int));
    return k;
}

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
    tree_system *s = self;
    tree_factors *k = factors;
    k->time = t;
    memcpy(k->state, state, (size_t)s->n * sizeof(double));
    if (input != NULL) {
        memcpy(k->input, input, (size_t)bough_tree_n_inputs(s->tree) * sizeof(double));
    }
    // with closures a dense Jacobian, else v̇ for the recursion
    if (k->newton == NULL) return find_jacobian(s, k);
    return derivative(s, t, state, k->input, k->rate);
}

static bool factor(void *self, void *factors, double gamma) {
    tree_system *s = self;
    tree_factors *k = factors;
    int n = s->n;
    k->gamma = gamma;
    if (k->newton != NULL) {
        s->moved = false; // the recursion moves the data
        return bough_tree_newton_setup(k->newton, s->data, k->time, k->input, place(s, k->time, k->state),
                                       k->rate + s->tree->n_q, 1 / gamma);
    }
    for (int i = 0; i < n * n; i++) k->matrix[i] = -gamma * k->jacobian[i];
    for (int i = 0; i < n; i++) k->matrix[(size_t)n * (size_t)i + (size_t)i] += 1;
    return bough_dense_factor(n, k->matrix, k->pivot);
}

// x = b + γ δf, in the form of tree_newton.h: c δq − δ(N v) = c b_q and c δv − c b_v = δv̇. Nothing
// depends on the states of prescribed joints: their x is b.
static void solve_tree(tree_system *s, const tree_factors *k, double *x) {
    const bough_tree *tree = s->tree;
    double c = 1 / k->gamma;
    if (s->prescribed) {
        memcpy(s->y, x, (size_t)s->n * sizeof(double));
        select_states(s, false, x);
    }
    if (s->prescribed && bough_all_zero(s->n, x)) { // as in their columns of the inverse
        memcpy(x, s->y, (size_t)s->n * sizeof(double));
        return;
    }
    for (int i = 0; i < tree->n_v; i++) {
        s->r[i] = -c * x[tree->n_q + i];
        x[tree->n_q + i] = 0;
    }
    for (int i = 0; i < tree->n_q; i++) x[i] *= c;
    bough_tree_newton_solve(k->newton, s->r, x);
    if (!s->prescribed) return;
    select_states(s, true, s->y);
    for (int i = 0; i < s->n; i++) x[i] += s->y[i];
}

static void solve(void *self, void *factors, double *x) {
    tree_system *s = self;
    const tree_factors *k = factors;
    if (k->newton != NULL) {
        solve_tree(s, k, x);
    } else {
        bough_dense_solve(s->n, 1, k->matrix, k->pivot, x);
    }
}

// -- states ----------------------------------------------------------------------------------

static bool constrain(void *self, double t, double *state) {
    const tree_system *s = self;
    bool drifted = false;
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        double *q = state + link->first_coordinate;
        drifted = drifted || bough_joint_drift(&link->joint, q) > drift_limit;
        bough_joint_normalise(&link->joint, q);
    }
    // quaternions of length 1, then given motions
    bough_tree_prescribe(s->tree, t, state);
    return drifted;
}

// δq ← N N⁺ δq
static void project(void *self, const double *state, double *x) {
    tree_system *s = self;
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        const double *q = state + link->first_coordinate;
        double *change = x + link->first_coordinate, speed[BOUGH_JOINT_SPEEDS];
        bough_joint_speed(&link->joint, q, change, speed);
        bough_joint_rate(&link->joint, q, speed, change);
    }
}

// Without kept_tangent: tangents of the outputs need the kinematics only.
static const bough_system_ops operations = {
    BOUGH_SYSTEM_REQUIRED,
    .output_drift = output_drift,
    .constrain = constrain,
    .project = project,
};

// -- construction ----------------------------------------------------------------------------

bough_system bough_tree_system_create(bough_arena *arena, bough_tree *tree, const char *name) {
    tree_system *s = bough_arena_take(arena, sizeof *s);
    s->tree = tree;
    s->n = tree->n_q + tree->n_v;
    for (int i = 0; i < tree->n_links; i++) s->prescribed = s->prescribed || tree->links[i].motion != NULL;
    s->data = bough_tree_data_create(arena, tree);
    bough_arena_each(arena, (size_t)s->n, &s->at, &s->initial, &s->scale, &s->placed, &s->y, &s->r, &s->plus,
                     &s->minus);
    s->increment = bough_arena_doubles(arena, (size_t)tree->n_q);
    find_increments(s);
    for (int i = 0; i < s->n; i++) s->scale[i] = 1;
    memcpy(s->initial, tree->initial, (size_t)s->n * sizeof(double));
    return (bough_system){.name = bough_arena_string(arena, name),
                          .kind = "tree",
                          .n_state = s->n,
                          .n_input = bough_tree_n_inputs(tree),
                          .n_output = bough_tree_n_outputs(tree),
                          .scale = s->scale,
                          .initial = s->initial,
                          .ahead = tree->n_closures == 0,
                          .ops = &operations,
                          .self = s};
}

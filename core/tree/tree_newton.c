// Newton's linear systems of an open tree in O(n), theory (47, 48, 49).
#include "core/tree/tree_newton.h"

#include "core/base/linalg.h"
#include "core/tree/dynamics.h"
#include "core/tree/force.h"

enum { N = 6, Z = 18 }; // components of a twist, of ζ

// ζ of a link
typedef struct change {
    bough_twist pose, speed, acceleration;
} change;

enum { ROWS = N * Z, BLOCK = 24 * 12 };

// The factors of a link, in its own axes
typedef struct node {
    bough_transform relative;
    bough_twist speed, joint, carried, pulled; // V, S v, X V_λ, X (A_λ − g)
    bough_wrench force;                        // through the joint, F
    bough_wrench end_force;                    // of an end, whose direction does not rotate with the link
    double tau_q, tau_v;                       // −∂τ/∂q, −∂τ/∂v
    double matrix[ROWS];                       // 𝒜 (6 × 18)
    double column[ROWS];                       // Σ, a row per speed
    double back[ROWS];                         // D⁻¹ Sᵀ𝒜, a row per speed
    double gain[N * N];                        // wrench on the parent by x, a row per speed
    double coordinate[N * N];                  // δη along each speed, a row per speed
    double factor[N * N];                      // D
    int pivot[N];
    // of the present solution
    change known, total; // ζ⁰, ζ
    bough_wrench load;   // p
    double speeds[N];    // x
} node;

// One end of a spring or bushing on a link
typedef struct newton_end {
    int element, side, link;
    const bough_frame *frame;
} newton_end;

struct bough_tree_newton {
    const bough_tree *tree;
    node *node;         // (n_links)
    double c;           // δv̇ = c δv
    double *state;      // (n_q + n_v) where it is linearised
    int n_ends, n_rows; // n_rows = 6 n_ends
    newton_end *ends;   // (n_ends)
    double *block;      // J of each element: ∂(both wrenches)/∂(poses, twists), 24 rows of 12
    double *matrix;     // E − J T⁻¹ Eᵀ (n_rows × n_rows, column-major)
    int *pivot;         // (n_rows)
    double *coupling;   // (n_rows) changes of the ends' wrenches
    double *zero;       // (n_q + n_v) zeros
    double *keep;       // (n_q + n_v) scratch
};

typedef bough_twist twist;
typedef bough_wrench wrench;

static const twist no_twist;
static const wrench no_wrench;

// -- small algebra ---------------------------------------------------------------------------

static void store(change z, double *out) {
    bough_twist_store(z.pose, out);
    bough_twist_store(z.speed, out + N);
    bough_twist_store(z.acceleration, out + 2 * N);
}

static change load(const double *in) {
    return (change){bough_twist_load(in), bough_twist_load(in + N), bough_twist_load(in + 2 * N)};
}

static change add(change a, change b) {
    return (change){bough_twist_add(a.pose, b.pose), bough_twist_add(a.speed, b.speed),
                    bough_twist_add(a.acceleration, b.acceleration)};
}

static wrench times(const double *matrix, change z) {
    double x[Z], y[N] = {0};
    store(z, x);
    for (int r = 0; r < N; r++) {
        for (int k = 0; k < Z; k++) y[r] += matrix[Z * r + k] * x[k];
    }
    return bough_wrench_load(y);
}

// -- the linearised kinematics -----------------------------------------------------------------

// 𝒳 ζ_λ: δA_i has X δA_λ and, from V_i × S v, (X δV_λ) × S v
static change carry(const node *n, change z) {
    change own = {bough_twist_to_child(&n->relative, z.pose), bough_twist_to_child(&n->relative, z.speed),
                  bough_twist_to_child(&n->relative, z.acceleration)};
    own.acceleration = bough_twist_add(own.acceleration, bough_twist_cross(own.speed, n->joint));
    return own;
}

// ζ by δη of the joint, δv and the change of S v̇ (all in twists): the parent's motion in link axes rotates
// with δη.
static change move(const node *n, twist eta, twist speed, twist acceleration) {
    change z = {.pose = eta};
    z.speed = bough_twist_add(bough_twist_cross(n->carried, eta), speed);
    z.acceleration = bough_twist_add(bough_twist_cross(n->pulled, eta), bough_twist_cross(z.speed, n->joint));
    z.acceleration = bough_twist_add(z.acceleration, bough_twist_cross(n->speed, speed));
    z.acceleration = bough_twist_add(z.acceleration, acceleration);
    return z;
}

static twist scaled(double f, twist t) {
    return (twist){bough_scale(f, t.linear), bough_scale(f, t.angular)};
}

// δη along each speed, and Σ
static void find_columns(const bough_tree_newton *w, const bough_link *link, node *n) {
    const double *q = w->state + link->first_coordinate;
    const double *v = w->state + w->tree->n_q + link->first_speed;
    for (int k = 0; k < link->n_speeds; k++) {
        double unit[N] = {0}, dq[BOUGH_JOINT_COORDINATES], *eta = n->coordinate + N * k;
        unit[k] = 1;
        bough_joint_change(&link->joint, q, v, w->c, w->zero, unit, dq);
        bough_joint_speed(&link->joint, q, dq, eta);
        twist own = bough_joint_column(&link->joint, k);
        store(move(n, bough_joint_twist(&link->joint, eta), own, scaled(w->c, own)), n->column + Z * k);
    }
}

// -- setup -----------------------------------------------------------------------------------

// Copies the evaluation at this point.
static void remember(const bough_tree_newton *w, const bough_tree_data *d, int i) {
    const bough_link *link = &w->tree->links[i];
    node *n = &w->node[i];
    twist ground = {bough_scale(-1, w->tree->gravity), {0, 0, 0}};
    twist pull = ground;
    if (link->parent >= 0) {
        pull = d->acceleration[link->parent];
        pull.linear = bough_sub(pull.linear, d->gravity[link->parent]);
    }
    n->relative = d->relative[i];
    n->speed = d->twist[i];
    n->joint = d->joint_twist[i];
    n->carried = link->parent < 0 ? no_twist : bough_twist_to_child(&n->relative, d->twist[link->parent]);
    n->pulled = bough_twist_to_child(&n->relative, pull);
    n->force = d->wrench[i];
    n->end_force = no_wrench;
    n->tau_q = n->tau_v = 0;
    if (link->n_speeds == 1) {
        n->tau_q = bough_joint_spring_stiffness(&link->spring, w->state[link->first_coordinate]);
        n->tau_v = link->spring.damping;
    }
}

// 𝒜 of the link alone: δf = I δA + δV ×* I V + V ×* I δV
static void own_matrix(const bough_inertia *inertia, node *n) {
    wrench momentum = bough_inertia_mul(inertia, n->speed);
    memset(n->matrix, 0, sizeof n->matrix);
    for (int k = 0; k < N; k++) {
        double column[N];
        wrench inertial = bough_inertia_mul(inertia, bough_twist_unit(k));
        wrench turning = bough_wrench_add(bough_wrench_cross(bough_twist_unit(k), momentum),
                                          bough_wrench_cross(n->speed, inertial));
        bough_wrench_store(turning, column);
        for (int r = 0; r < N; r++) n->matrix[Z * r + N + k] = column[r];
        bough_wrench_store(inertial, column);
        for (int r = 0; r < N; r++) n->matrix[Z * r + 2 * N + k] = column[r];
    }
}

// Wrenches that keep their direction in the ground change with the link's pose.
static void add_applied(const bough_tree_newton *w, const bough_tree_data *d, double t) {
    for (int a = 0; a < w->tree->n_applied; a++) {
        const bough_frame *frame = &w->tree->markers[w->tree->applied[a].marker];
        if (frame->link < 0) continue;
        for (int k = 0; k < N; k++) {
            double column[N];
            twist shift = bough_twist_to_child(&frame->placement, bough_twist_unit(k));
            wrench by = bough_applied_change(w->tree, d, a, t, shift);
            bough_wrench_store(bough_wrench_to_parent(&frame->placement, by), column);
            for (int r = 0; r < N; r++) w->node[frame->link].matrix[Z * r + k] -= column[r];
        }
    }
}

static void add_ends(const bough_tree_newton *w, const bough_tree_data *d, const double *input) {
    const bough_tree *tree = w->tree;
    for (int e = 0; input != NULL && e < tree->n_ends; e++) {
        const double *own = input + BOUGH_PORT_INPUTS * tree->n_ports + BOUGH_END_INPUTS * e;
        wrench by = bough_tree_end_wrench(tree, d, e, own);
        w->node[tree->ends[e].link].end_force.force = by.force;
    }
}

// −δ(Rᵀ f) = −f × δη of an end's force by a rotation of the link's own joint
static wrench turned_end(const node *n, twist eta) {
    return (wrench){bough_cross(eta.angular, n->end_force.force), {0, 0, 0}};
}

// D = Sᵀ(𝒜Σ + ends) − ∂τ, and the wrench on the parent by x
static bool factor_joint(const bough_link *link, node *n) {
    int m = link->n_speeds;
    for (int k = 0; k < m; k++) {
        twist eta = bough_joint_twist(&link->joint, n->coordinate + N * k);
        wrench by = bough_wrench_add(times(n->matrix, load(n->column + Z * k)), turned_end(n, eta));
        bough_joint_force(&link->joint, by, n->factor + m * k); // column k
        // transformed to the parent, the wrench rotates with the joint
        bough_wrench_store(bough_wrench_add(by, bough_wrench_cross(eta, n->force)), n->gain + N * k);
    }
    if (m == 1) n->factor[0] += n->tau_q * n->coordinate[0] + n->tau_v;
    return bough_dense_factor(m, n->factor, n->pivot);
}

// D⁻¹ Sᵀ𝒜
static void find_back(const bough_link *link, node *n) {
    for (int k = 0; k < Z; k++) {
        double column[N], own[N];
        for (int r = 0; r < N; r++) column[r] = n->matrix[Z * r + k];
        bough_joint_force(&link->joint, bough_wrench_load(column), own);
        bough_dense_solve(link->n_speeds, 1, n->factor, n->pivot, own);
        for (int j = 0; j < link->n_speeds; j++) n->back[Z * j + k] = own[j];
    }
}

// up += Xᵀ (𝒜 − gain back) 𝒳; rows are wrenches by columns of twists, so that both sides go to the
// parent alike.
static void pass_matrix(const bough_link *link, const node *n, double *up) {
    double passed[N * Z];
    for (int r = 0; r < N; r++) {
        double row[Z];
        memcpy(row, n->matrix + Z * r, sizeof row);
        for (int j = 0; link->motion == NULL && j < link->n_speeds; j++) {
            for (int k = 0; k < Z; k++) row[k] -= n->gain[N * j + r] * n->back[Z * j + k];
        }
        wrench pose = bough_wrench_load(row), speed = bough_wrench_load(row + N);
        wrench acceleration = bough_wrench_load(row + 2 * N);
        speed = bough_wrench_add(speed, bough_wrench_cross(n->joint, acceleration));
        bough_wrench_store(bough_wrench_to_parent(&n->relative, pose), passed + Z * r);
        bough_wrench_store(bough_wrench_to_parent(&n->relative, speed), passed + Z * r + N);
        bough_wrench_store(bough_wrench_to_parent(&n->relative, acceleration), passed + Z * r + 2 * N);
    }
    for (int k = 0; k < Z; k++) {
        double column[N];
        for (int r = 0; r < N; r++) column[r] = passed[Z * r + k];
        bough_wrench_store(bough_wrench_to_parent(&n->relative, bough_wrench_load(column)), column);
        for (int r = 0; r < N; r++) up[Z * r + k] += column[r];
    }
}

static bool factor_tree(const bough_tree_newton *w) {
    for (int i = w->tree->n_links - 1; i >= 0; i--) {
        const bough_link *link = &w->tree->links[i];
        node *n = &w->node[i];
        if (link->motion == NULL) {
            find_columns(w, link, n);
            if (!factor_joint(link, n)) return false;
            find_back(link, n);
        }
        // 𝒜 of the parent
        if (link->parent >= 0) pass_matrix(link, n, w->node[link->parent].matrix);
    }
    return true;
}

// -- solution --------------------------------------------------------------------------------

// ζ⁰ and the joint's change in it: from r_q, the known v̇ and, of a prescribed joint, r_v
static void find_known(const bough_tree_newton *w, const double *a, const double *x, int i, double eta[N]) {
    const bough_link *link = &w->tree->links[i];
    node *n = &w->node[i];
    const double *q = w->state + link->first_coordinate;
    const double *v = w->state + w->tree->n_q + link->first_speed;
    const double *rq = x + link->first_coordinate, *rv = x + w->tree->n_q + link->first_speed;
    twist speed = no_twist, acceleration = no_twist;
    if (link->motion != NULL) {
        eta[0] = rq[0];
        n->speeds[0] = rv[0];
        speed = bough_joint_twist(&link->joint, rv);
    } else {
        double dq[BOUGH_JOINT_COORDINATES];
        bough_joint_change(&link->joint, q, v, w->c, rq, w->zero, dq);
        bough_joint_speed(&link->joint, q, dq, eta);
        if (a != NULL) acceleration = bough_joint_twist(&link->joint, a + link->first_speed);
    }
    n->known = move(n, bough_joint_twist(&link->joint, eta), speed, acceleration);
}

// From the leaves to the root: p of the parents, x without the parent's motion
static void eliminate(const bough_tree_newton *w, const double *a, const double *x) {
    for (int i = w->tree->n_links - 1; i >= 0; i--) {
        const bough_link *link = &w->tree->links[i];
        node *n = &w->node[i];
        double eta[N];
        find_known(w, a, x, i, eta);
        twist angle = bough_joint_twist(&link->joint, eta);
        wrench by = bough_wrench_add(times(n->matrix, n->known), n->load);
        by = bough_wrench_add(by, turned_end(n, angle));
        wrench up = bough_wrench_add(by, bough_wrench_cross(angle, n->force));
        if (link->motion == NULL) {
            double required[N];
            bough_joint_force(&link->joint, by, required);
            for (int k = 0; k < link->n_speeds; k++)
                n->speeds[k] = x[w->tree->n_q + link->first_speed + k] - required[k];
            if (link->n_speeds == 1) n->speeds[0] -= n->tau_q * eta[0];
            // x of the joint, without the parent's motion
            bough_dense_solve(link->n_speeds, 1, n->factor, n->pivot, n->speeds);
            for (int k = 0; k < link->n_speeds; k++) {
                wrench gain = bough_wrench_load(n->gain + N * k);
                up.force = bough_axpy(n->speeds[k], gain.force, up.force);
                up.moment = bough_axpy(n->speeds[k], gain.moment, up.moment);
            }
        }
        // p of the parent
        if (link->parent < 0) continue;
        wrench *sum = &w->node[link->parent].load;
        *sum = bough_wrench_add(*sum, bough_wrench_to_parent(&n->relative, up));
    }
}

// From the root to the leaves: x and ζ
static void substitute(const bough_tree_newton *w) {
    for (int i = 0; i < w->tree->n_links; i++) {
        const bough_link *link = &w->tree->links[i];
        node *n = &w->node[i];
        n->total = n->known;
        change carried = {no_twist, no_twist, no_twist};
        if (link->parent >= 0) carried = carry(n, w->node[link->parent].total);
        n->total = add(n->total, carried);
        if (link->motion != NULL) continue;
        double from[Z], sum[Z];
        store(carried, from);
        store(n->total, sum);
        for (int k = 0; k < link->n_speeds; k++) {
            for (int j = 0; j < Z; j++) n->speeds[k] -= n->back[Z * k + j] * from[j];
            for (int j = 0; j < Z; j++) sum[j] += n->column[Z * k + j] * n->speeds[k];
        }
        n->total = load(sum);
    }
}

// Solves without the springs and bushings, into the nodes' speeds and total changes: r as in
// bough_tree_newton_solve, the ends' wrenches changed by `coupling` (n_rows) or NULL for none.
static void sweep(const bough_tree_newton *w, const double *coupling, const double *a, const double *x) {
    for (int i = 0; i < w->tree->n_links; i++) w->node[i].load = no_wrench;
    for (int e = 0; coupling != NULL && e < w->n_ends; e++) {
        wrench by = bough_wrench_load(coupling + N * e);
        wrench *sum = &w->node[w->ends[e].link].load;
        *sum = bough_wrench_sub(*sum, bough_wrench_to_parent(&w->ends[e].frame->placement, by));
    }
    eliminate(w, a, x);
    substitute(w);
}

// -- springs and bushings ----------------------------------------------------------------------

// The wrenches at their ends change by c = J ζ, with ζ of the tree without springs and bushings under c:
// (E − J T⁻¹ Eᵀ) c = J T⁻¹ r.

// Lists the ends of springs and bushings, which sets n_ends and n_rows.
static void list_ends(bough_tree_newton *w) {
    for (int e = 0; e < bough_tree_n_elements(w->tree); e++) {
        for (int side = 0; side < 2; side++) {
            const bough_frame *frame = bough_element_frame(w->tree, e, side);
            if (frame->link < 0) continue;
            w->ends[w->n_ends++] = (newton_end){e, side, frame->link, frame};
        }
    }
    w->n_rows = N * w->n_ends;
}

// Their tangents at the data's poses and twists, then the factors of the system that couples them.
static void find_blocks(const bough_tree_newton *w, const bough_tree_data *d) {
    for (int e = 0; e < bough_tree_n_elements(w->tree); e++) {
        for (int k = 0; k < 24; k++) {
            twist shift[2] = {no_twist, no_twist}, rate[2] = {no_twist, no_twist};
            (k < 12 ? shift : rate)[(k / N) % 2] = bough_twist_unit(k % N);
            bough_force_pair by = bough_element_change(w->tree, d, e, shift, rate);
            double *row = w->block + (size_t)BLOCK * (size_t)e + 12 * k;
            bough_wrench_store(by.on[0], row);
            bough_wrench_store(by.on[1], row + N);
        }
    }
}

// How the present ζ change the ends' wrenches (n_rows)
static void find_coupling(const bough_tree_newton *w, double *change_of) {
    memset(change_of, 0, (size_t)w->n_rows * sizeof(double));
    for (int e = 0; e < w->n_ends; e++) {
        const newton_end *from = &w->ends[e];
        double z[2 * N];
        const node *n = &w->node[from->link];
        bough_twist_store(bough_twist_to_child(&from->frame->placement, n->total.pose), z);
        bough_twist_store(bough_twist_to_child(&from->frame->placement, n->total.speed), z + N);
        const double *block = w->block + (size_t)BLOCK * (size_t)from->element;
        // the ends of one element are neighbours in the list
        for (int to = e - 1 < 0 ? 0 : e - 1; to <= e + 1 && to < w->n_ends; to++) {
            if (w->ends[to].element != from->element) continue;
            for (int k = 0; k < 2 * N; k++) {
                int column = (k < N ? 0 : 12) + N * from->side + k % N;
                for (int r = 0; r < N; r++)
                    change_of[N * to + r] += block[12 * column + N * w->ends[to].side + r] * z[k];
            }
        }
    }
}

static bool factor_coupling(const bough_tree_newton *w) {
    int m = w->n_rows;
    for (int j = 0; j < m; j++) {
        double *column = w->matrix + (size_t)m * (size_t)j;
        memset(w->coupling, 0, (size_t)m * sizeof(double));
        w->coupling[j] = 1;
        sweep(w, w->coupling, NULL, w->zero);
        find_coupling(w, column);
        for (int i = 0; i < m; i++) column[i] = (i == j ? 1 : 0) - column[i];
    }
    return bough_dense_factor(m, w->matrix, w->pivot);
}

// The changes of the ends' wrenches from those that the present solution has, in newton->coupling.
static void solve_coupling(const bough_tree_newton *w) {
    find_coupling(w, w->coupling);
    bough_dense_solve(w->n_rows, 1, w->matrix, w->pivot, w->coupling);
}

// -- the whole -------------------------------------------------------------------------------

// NOLINTNEXTLINE(readability-function-size): a point of the motion has so many arguments
bool bough_tree_newton_setup(bough_tree_newton *w, bough_tree_data *data, double t, const double *input,
                             const double *state, const double *acceleration, double c) {
    const bough_tree *tree = w->tree;
    size_t n = (size_t)(tree->n_q + tree->n_v);
    w->c = c;
    memcpy(w->state, state, n * sizeof(double));
    bough_tree_kinematics(tree, state, data);
    bough_tree_inverse_dynamics(tree, data, t, input, acceleration, w->keep);
    for (int i = 0; i < tree->n_links; i++) {
        remember(w, data, i);
        own_matrix(&tree->links[i].inertia, &w->node[i]);
    }
    add_applied(w, data, t);
    add_ends(w, data, input);
    find_blocks(w, data);
    return factor_tree(w) && (w->n_rows == 0 || factor_coupling(w));
}

static void store_solution(const bough_tree_newton *w, double *x) {
    for (int i = 0; i < w->tree->n_links; i++) {
        const bough_link *link = &w->tree->links[i];
        if (link->motion != NULL) continue; // δq = r_q, δv = r_v
        const double *q = w->state + link->first_coordinate;
        const double *v = w->state + w->tree->n_q + link->first_speed;
        double dq[BOUGH_JOINT_COORDINATES], *own = x + link->first_coordinate;
        bough_joint_change(&link->joint, q, v, w->c, own, w->node[i].speeds, dq);
        memcpy(own, dq, (size_t)link->n_coordinates * sizeof(double));
        memcpy(x + w->tree->n_q + link->first_speed, w->node[i].speeds,
               (size_t)link->n_speeds * sizeof(double));
    }
}

void bough_tree_newton_solve(bough_tree_newton *w, const double *a, double *x) {
    sweep(w, NULL, a, x);
    if (w->n_rows > 0) {
        solve_coupling(w);
        sweep(w, w->coupling, a, x);
    }
    store_solution(w, x);
}

bough_tree_newton *bough_tree_newton_create(bough_arena *arena, const bough_tree *tree) {
    size_t n = (size_t)(tree->n_q + tree->n_v), elements = (size_t)bough_tree_n_elements(tree);
    bough_tree_newton *w = bough_arena_take(arena, sizeof *w);
    w->tree = tree;
    w->node = bough_arena_take(arena, (size_t)tree->n_links * sizeof *w->node);
    bough_arena_each(arena, n, &w->state, &w->keep);
    w->zero = bough_arena_doubles(arena, n + BOUGH_JOINT_COORDINATES);
    w->ends = bough_arena_take(arena, 2 * elements * sizeof *w->ends);
    w->block = bough_arena_doubles(arena, BLOCK * elements);
    list_ends(w);
    size_t m = (size_t)w->n_rows;
    w->matrix = bough_arena_doubles(arena, m * m);
    w->pivot = bough_arena_take(arena, m * sizeof(int));
    w->coupling = bough_arena_doubles(arena, m);
    return w;
}

// Recursive dynamics of the rigid tree, theory (39, 40, 41).
#include "core/tree/dynamics.h"

#include "core/base/linalg.h"
#include "core/tree/force.h"

enum { N = 6, NN = N * N };

static const bough_twist no_twist;
static const bough_wrench no_wrench;

// X_i V_λ for a quantity that is zero on the ground
static bough_twist from_parent(const bough_tree_data *d, const bough_link *links, int i,
                               const bough_twist *quantity) {
    int parent = links[i].parent;
    return bough_twist_to_child(&d->relative[i], parent < 0 ? no_twist : quantity[parent]);
}

// Springs along joint axes: they depend on coordinates, which only the kinematics read.
static void joint_springs(const bough_tree *tree, const double *q, const double *v, bough_tree_data *d) {
    d->elastic = 0;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        if (link->n_speeds != 1) continue; // their passive force stays zero
        double energy;
        d->passive[link->first_speed] =
            bough_joint_spring_force(&link->spring, q[link->first_coordinate], v[link->first_speed], &energy);
        d->elastic += energy;
    }
}

void bough_tree_kinematics(const bough_tree *tree, const double *state, bough_tree_data *d) {
    const double *q = state, *v = state + tree->n_q;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int up = link->parent;
        d->relative[i] = bough_joint_pose(&link->joint, q + link->first_coordinate);
        d->pose[i] = up < 0 ? d->relative[i] : bough_transform_compose(d->pose[up], d->relative[i]);
        // theory (39): V_i = X_i V_λ + S v
        d->joint_twist[i] = bough_joint_twist(&link->joint, v + link->first_speed);
        d->twist[i] = bough_twist_add(from_parent(d, tree->links, i, d->twist), d->joint_twist[i]);
        d->gravity[i] = bough_mat3_tmul(d->pose[i].rotation, tree->gravity);
    }
    d->factored = false;
    if (d->loops) d->loops->found = false;
    joint_springs(tree, q, v, d);
    for (int k = 0; k < bough_tree_n_elements(tree); k++) {
        double energy;
        bough_element_force(tree, d, k, &energy);
        d->elastic += energy;
    }
}

// -- loads -----------------------------------------------------------------------------------

// Subtracts a wrench at a frame from that which its link's joint transmits.
static void subtract_at(bough_tree_data *d, const bough_frame *frame, bough_wrench wrench) {
    if (frame->link < 0) return;
    bough_wrench *sum = &d->wrench[frame->link];
    *sum = bough_wrench_sub(*sum, bough_wrench_to_parent(&frame->placement, wrench));
}

static void element_wrenches(const bough_tree *tree, bough_tree_data *d, int element) {
    double energy;
    bough_force_pair pair = bough_element_force(tree, d, element, &energy);
    for (int end = 0; end < 2; end++) subtract_at(d, bough_element_frame(tree, element, end), pair.on[end]);
}

// Gᵀλ of a closure at the present multipliers, theory (46).
static void closure_wrenches(const bough_tree *tree, bough_tree_data *d, const bough_closure *c) {
    for (int k = c->first_row; k < c->first_row + bough_constraint_n_rows(&c->constraint); k++) {
        double lambda = d->loops->multiplier[k];
        for (int end = 0; end < 2 && lambda != 0; end++) {
            bough_wrench w = d->loops->row[k].wrench[end];
            subtract_at(d, &tree->markers[c->marker[end]], bough_wrench_scale(lambda, w));
        }
    }
}

bough_wrench bough_tree_end_wrench(const bough_tree *tree, const bough_tree_data *d, int end,
                                   const double *input) {
    int i = tree->ends[end].link;
    bough_wrench w = bough_wrench_load(input);
    bough_vec3 force = bough_mat3_mul(tree->links[i].joint.placement.rotation, w.force);
    w.force = bough_mat3_tmul(d->relative[i].rotation, force);
    return w;
}

// theory (40) without accelerations: wrench_i = V ×* I V − I g − f_ext
static void bias_wrenches(const bough_tree *tree, bough_tree_data *d, double t, const double *input) {
    for (int i = 0; i < tree->n_links; i++) {
        bough_twist lift = {bough_scale(-1, d->gravity[i]), {0, 0, 0}};
        d->wrench[i] = bough_inertia_wrench(&tree->links[i].inertia, lift, d->twist[i]);
    }
    // external wrenches: ports, ends, samples, springs and bushings, applied loads, closures
    for (int p = 0; input != NULL && p < tree->n_ports; p++) {
        subtract_at(d, &tree->ports[p], bough_wrench_load(input + BOUGH_PORT_INPUTS * p));
    }
    for (int e = 0; input != NULL && e < tree->n_ends; e++) {
        const double *own = input + BOUGH_PORT_INPUTS * tree->n_ports + BOUGH_END_INPUTS * e;
        subtract_at(d, &tree->ends[e], bough_tree_end_wrench(tree, d, e, own));
    }
    for (int m = 0; m < tree->n_markers; m++) {
        if (tree->external[m].active) subtract_at(d, &tree->markers[m], bough_tree_wrench(tree, m, t));
    }
    for (int k = 0; k < bough_tree_n_elements(tree); k++) element_wrenches(tree, d, k);
    for (int k = 0; k < tree->n_applied; k++) {
        const bough_frame *marker = &tree->markers[tree->applied[k].marker];
        subtract_at(d, marker, bough_applied_force(tree, d, k, t));
    }
    for (int c = 0; c < tree->n_closures; c++) closure_wrenches(tree, d, &tree->closures[c]);
}

// τ of the joints' springs and loads, into data->force
static void joint_loads(const bough_tree *tree, bough_tree_data *d, double t) {
    memcpy(d->force, d->passive, (size_t)tree->n_v * sizeof(double));
    for (int k = 0; k < tree->n_loads; k++) {
        const bough_joint_load_def *load = &tree->loads[k];
        const bough_link *link = &tree->links[tree->bodies[load->body].link];
        d->force[link->first_speed] += load->value * bough_schedule_at(&load->schedule, t);
    }
}

static double prescribed_acceleration(const bough_link *link, double t) {
    return bough_motion_at(link->motion, t).a;
}

// -- inverse dynamics ------------------------------------------------------------------------

// theory (39, 40): accelerations outwards, wrenches inwards.
void bough_tree_inverse_dynamics(const bough_tree *tree, bough_tree_data *d, double t, const double *input,
                                 const double *acceleration, double *residual) {
    bias_wrenches(tree, d, t, input);
    joint_loads(tree, d, t);
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        // A_i = X_i A_λ + V_i × S v + S v̇
        const double *rate = acceleration + link->first_speed;
        double given = link->motion == NULL ? 0 : prescribed_acceleration(link, t);
        bough_twist own = bough_joint_twist(&link->joint, link->motion == NULL ? rate : &given);
        bough_twist turn = bough_twist_cross(d->twist[i], d->joint_twist[i]);
        d->acceleration[i] =
            bough_twist_add(from_parent(d, tree->links, i, d->acceleration), bough_twist_add(turn, own));
        d->wrench[i] = bough_wrench_add(d->wrench[i], bough_inertia_mul(&link->inertia, d->acceleration[i]));
    }
    for (int i = tree->n_links - 1; i >= 0; i--) {
        const bough_link *link = &tree->links[i];
        double *row = residual + link->first_speed;
        // residual Sᵀ f_i − τ; of a prescribed joint it is the drive, theory (43)
        bough_joint_force(&link->joint, d->wrench[i], row);
        for (int k = 0; k < link->n_speeds; k++) row[k] -= d->force[link->first_speed + k];
        if (link->motion != NULL) {
            d->drive[link->first_speed] = row[0];
            row[0] = acceleration[link->first_speed] - prescribed_acceleration(link, t);
        }
        if (link->parent < 0) continue;
        bough_wrench *up = &d->wrench[link->parent];
        *up = bough_wrench_add(*up, bough_wrench_to_parent(&d->relative[i], d->wrench[i]));
    }
}

// -- forward dynamics by articulated bodies ------------------------------------------------------

// Of a symmetric matrix, whose rows are its columns.
static bough_wrench matrix_mul(const double *restrict a, bough_twist v) {
    double x[N], y[N] = {0};
    bough_twist_store(v, x);
    for (int c = 0; c < N; c++) {
        for (int r = 0; r < N; r++) y[r] += a[N * c + r] * x[c];
    }
    return bough_wrench_load(y);
}

// Symmetric, so rows are columns.
void bough_tree_rigid_matrix(const bough_inertia *inertia, double a[36]) {
    for (int k = 0; k < N; k++) {
        bough_wrench_store(bough_inertia_mul(inertia, bough_twist_unit(k)), a + N * k);
    }
}

// Block (row, column) of 3×3 of a 6×6 matrix.
static bough_mat3 block_of(const double *a, int row, int column) {
    const double *from = a + N * row + column;
    return (bough_mat3){{from[0], from[N], from[2 * N]},
                        {from[1], from[N + 1], from[2 * N + 1]},
                        {from[2], from[N + 2], from[2 * N + 2]}};
}

static void add_row(double x, double y, double z, double *to) {
    to[0] += x;
    to[1] += y;
    to[2] += z;
}

// By address: a matrix that is passed on the stack waits for its own stores.
static void add_block(const bough_mat3 *b, int row, int column, double *a) {
    double *to = a + N * row + column;
    add_row(b->c1.x, b->c2.x, b->c3.x, to);
    add_row(b->c1.y, b->c2.y, b->c3.y, to + N);
    add_row(b->c1.z, b->c2.z, b->c3.z, to + 2 * N);
}

static bough_mat3 rotated(bough_mat3 r, bough_mat3 a) {
    return bough_mat3_product(bough_mat3_product(r, a), bough_mat3_transpose(r));
}

// a ξ(p) and ξ(p) a with ξ(p) v = p×v
static bough_mat3 times_cross(bough_mat3 a, bough_vec3 p) {
    return (bough_mat3){bough_axpy(p.z, a.c2, bough_scale(-p.y, a.c3)),
                        bough_axpy(p.x, a.c3, bough_scale(-p.z, a.c1)),
                        bough_axpy(p.y, a.c1, bough_scale(-p.x, a.c2))};
}

static bough_mat3 cross_times(bough_vec3 p, bough_mat3 a) {
    return (bough_mat3){bough_cross(p, a.c1), bough_cross(p, a.c2), bough_cross(p, a.c3)};
}

// A positive semidefinite matrix is zero where its diagonal is, as of a pitch joint that carries a rod only.
static bool is_zero(const double *a) {
    double trace = 0;
    for (int k = 0; k < N; k++) trace += a[(N + 1) * k];
    return trace == 0;
}

// up += Xᵀ a X of a symmetric a: its blocks rotated, then shifted by p.
static void add_to_parent(const bough_transform *x, const double *a, double *up) {
    if (is_zero(a)) return;
    bough_mat3 mass = rotated(x->rotation, block_of(a, 0, 0));
    bough_mat3 coupling = rotated(x->rotation, block_of(a, 0, 3));
    bough_mat3 inertia = rotated(x->rotation, block_of(a, 3, 3)), back = bough_mat3_transpose(coupling);
    bough_vec3 to_child = bough_scale(-1, x->position);
    coupling = bough_mat3_add(coupling, times_cross(mass, to_child));
    inertia = bough_mat3_add(inertia, times_cross(back, to_child));
    inertia = bough_mat3_add(inertia, cross_times(x->position, coupling));
    back = bough_mat3_transpose(coupling);
    add_block(&mass, 0, 0, up);
    add_block(&coupling, 0, 3, up);
    add_block(&back, 3, 0, up);
    add_block(&inertia, 3, 3, up);
}

// Whether a column of the motion subspace moves inertia beyond rounding errors.
static bool moves_inertia(const double *articulated, bough_twist column, double moved) {
    int first = bough_norm(column.angular) > 0 ? 3 : 0;
    double trace = 0;
    for (int r = first; r < first + 3; r++) trace += articulated[N * r + r];
    return moved > 1e-14 * trace;
}

// U = Iᴬ S, D = Sᵀ U and its Cholesky factor
static bool factor_joint(const bough_link *link, const double *articulated, double *gain, double *factor) {
    int n = link->n_speeds;
    for (int k = 0; k < n; k++) {
        bough_twist column = bough_joint_column(&link->joint, k);
        bough_wrench u = matrix_mul(articulated, column);
        bough_wrench_store(u, gain + N * k);
        bough_joint_force(&link->joint, u, factor + n * k);
        if (!moves_inertia(articulated, column, factor[n * k + k])) return false;
    }
    return bough_cholesky_factor(n, factor);
}

// Iᵃ = Iᴬ − U D⁻¹ Uᵀ, in place: the inertia that the parent carries through the joint, none through a free
// one
static void release_joint(const bough_link *link, const double *restrict gain, const double *factor,
                          double *restrict articulated) {
    int n = link->n_speeds;
    if (n == N) {
        memset(articulated, 0, NN * sizeof *articulated);
        return;
    }
    for (int r = 0; r < N; r++) {
        double x[N];
        for (int k = 0; k < n; k++) x[k] = gain[N * k + r];
        bough_cholesky_solve(n, factor, x);
        for (int k = 0; k < n; k++) {
            for (int c = 0; c < N; c++) articulated[N * r + c] -= x[k] * gain[N * k + c];
        }
    }
}

// U D⁻¹ u
static bough_wrench gain_solve(const bough_link *link, const double *gain, const double *factor,
                               const double *u) {
    double x[N], w[N] = {0};
    memcpy(x, u, (size_t)link->n_speeds * sizeof(double));
    bough_cholesky_solve(link->n_speeds, factor, x);
    for (int k = 0; k < link->n_speeds; k++) {
        for (int r = 0; r < N; r++) w[r] += gain[N * k + r] * x[k];
    }
    return bough_wrench_load(w);
}

// u = τ − Sᵀ pᴬ, in place of τ in data->force
static double *joint_remainder(const bough_link *link, bough_tree_data *d, int i) {
    double *u = d->force + link->first_speed, resisting[N];
    bough_joint_force(&link->joint, d->wrench[i], resisting);
    for (int k = 0; k < link->n_speeds; k++) u[k] -= resisting[k];
    return u;
}

// v̇ = D⁻¹ (u − Uᵀ a'), A = a' + S v̇
static void accelerate(const bough_link *link, bough_tree_data *d, int i, bough_twist arriving,
                       double *acceleration) {
    double *own = acceleration + link->first_speed;
    for (int k = 0; k < link->n_speeds; k++) {
        bough_wrench column = bough_wrench_load(d->joint_gain + NN * i + N * k);
        own[k] = d->force[link->first_speed + k] - bough_power(arriving, column);
    }
    bough_cholesky_solve(link->n_speeds, d->joint_factor + NN * i, own);
    d->acceleration[i] = bough_twist_add(arriving, bough_joint_twist(&link->joint, own));
}

// pᵃ = pᴬ + Iᵃ c + U D⁻¹ u; through a prescribed joint pᴬ + Iᴬ (c + S v̇) and Iᵃ = Iᴬ
static bough_wrench pass_down(const bough_link *link, bough_tree_data *d, int i, double t) {
    double *own = d->articulated + NN * i, *gain = d->joint_gain + NN * i;
    double *factor = d->joint_factor + NN * i;
    bough_twist turn = bough_twist_cross(d->twist[i], d->joint_twist[i]);
    if (link->motion != NULL) {
        double given = prescribed_acceleration(link, t);
        turn = bough_twist_add(turn, bough_joint_twist(&link->joint, &given));
        return bough_wrench_add(d->wrench[i], matrix_mul(own, turn));
    }
    double *u = joint_remainder(link, d, i);
    if (!d->factored) release_joint(link, gain, factor, own);
    return bough_wrench_add(d->wrench[i],
                            bough_wrench_add(matrix_mul(own, turn), gain_solve(link, gain, factor, u)));
}

// theory (43): A = a' + S v̇ with the given v̇, and the drive of the joint
static void follow(const bough_link *link, bough_tree_data *d, int i, bough_twist arriving, double given) {
    double needed[N];
    d->acceleration[i] = bough_twist_add(arriving, bough_joint_twist(&link->joint, &given));
    bough_wrench inertial = matrix_mul(d->articulated + NN * i, d->acceleration[i]);
    bough_joint_force(&link->joint, bough_wrench_add(inertial, d->wrench[i]), needed);
    d->drive[link->first_speed] = needed[0] - d->force[link->first_speed];
}

// Articulated bodies, theory (41). Their inertias depend on the coordinates alone.
bool bough_tree_free_dynamics(const bough_tree *tree, bough_tree_data *d, double t, const double *input,
                              double *acceleration) {
    bias_wrenches(tree, d, t, input);
    joint_loads(tree, d, t);
    d->singular = -1;
    for (int i = 0; i < tree->n_links && !d->factored; i++) {
        memcpy(d->articulated + NN * i, tree->links[i].matrix, sizeof tree->links[i].matrix);
    }
    // inwards: articulated inertia and bias wrench of each parent
    for (int i = tree->n_links - 1; i >= 0; i--) {
        const bough_link *link = &tree->links[i];
        double *own = d->articulated + NN * i;
        if (link->motion == NULL && !d->factored &&
            !factor_joint(link, own, d->joint_gain + NN * i, d->joint_factor + NN * i)) {
            d->singular = i;
            return false;
        }
        if (link->parent < 0) {
            if (link->motion == NULL) joint_remainder(link, d, i);
            continue;
        }
        bough_wrench passed = pass_down(link, d, i, t);
        if (link->n_speeds < N && !d->factored)
            add_to_parent(&d->relative[i], own, d->articulated + NN * link->parent);
        bough_wrench *up = &d->wrench[link->parent];
        *up = bough_wrench_add(*up, bough_wrench_to_parent(&d->relative[i], passed));
    }
    d->factored = true;
    // outwards: accelerations
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        bough_twist turn = bough_twist_cross(d->twist[i], d->joint_twist[i]);
        bough_twist carried = from_parent(d, tree->links, i, d->acceleration);
        bough_twist arriving = bough_twist_add(carried, turn);
        if (link->motion == NULL) {
            accelerate(link, d, i, arriving, acceleration);
        } else {
            acceleration[link->first_speed] = prescribed_acceleration(link, t);
            follow(link, d, i, arriving, acceleration[link->first_speed]);
        }
    }
    return true;
}

void bough_tree_free_response(const bough_tree *tree, bough_tree_data *d, const bough_frame *frame,
                              bough_wrench wrench, double *change) {
    memset(change, 0, (size_t)tree->n_v * sizeof(double));
    if (frame->link < 0) return;
    memset(d->force, 0, (size_t)tree->n_v * sizeof(double));
    for (int i = 0; i < tree->n_links; i++) d->wrench[i] = no_wrench;
    subtract_at(d, frame, wrench);
    // inwards along the ancestors, the only links with a bias wrench
    for (int i = frame->link; i >= 0; i = tree->links[i].parent) {
        const bough_link *link = &tree->links[i];
        bough_wrench passed = d->wrench[i];
        if (link->motion == NULL) {
            const double *gain = d->joint_gain + NN * i, *factor = d->joint_factor + NN * i;
            double *u = joint_remainder(link, d, i);
            passed = bough_wrench_add(passed, gain_solve(link, gain, factor, u));
        }
        if (link->parent < 0) break;
        d->wrench[link->parent] = bough_wrench_to_parent(&d->relative[i], passed);
    }
    for (int i = 0; i < tree->n_links; i++) {
        // outwards over all links, with the factors of the last dynamics
        bough_twist carried = from_parent(d, tree->links, i, d->acceleration);
        if (tree->links[i].motion == NULL) {
            accelerate(&tree->links[i], d, i, carried, change);
        } else {
            d->acceleration[i] = carried;
        }
    }
}

// -- rates and tangents ----------------------------------------------------------------------

void bough_tree_coordinate_rate(const bough_tree *tree, const double *state, double *rate) {
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        bough_joint_rate(&link->joint, state + link->first_coordinate, state + tree->n_q + link->first_speed,
                         rate + link->first_coordinate);
    }
}

void bough_tree_tangent(const bough_tree *tree, const double *state, const double *change,
                        bough_tree_data *d) {
    const double *dv = change + tree->n_q;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        double eta[N];
        bough_joint_speed(&link->joint, state + link->first_coordinate, change + link->first_coordinate, eta);
        bough_twist moved = bough_joint_twist(&link->joint, eta);
        bough_twist own = bough_joint_twist(&link->joint, dv + link->first_speed);
        bough_twist carried = from_parent(d, tree->links, i, d->twist);
        // δV_i = X δV_λ + (X V_λ) × S δη + S δv
        d->acceleration[i] = bough_twist_add(from_parent(d, tree->links, i, d->acceleration),
                                             bough_twist_add(bough_twist_cross(carried, moved), own));
        bough_vec3 above = link->parent < 0 ? no_twist.linear : d->rotation[link->parent];
        d->rotation[i] = bough_add(bough_mat3_tmul(d->relative[i].rotation, above), moved.angular);
    }
}

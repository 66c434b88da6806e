// The initial state of a tree with closures: coordinates and speeds that satisfy them.
#include "core/base/base.h"
#include "core/tree/dynamics.h"
#include "core/tree/loop_internal.h"

#include <string.h>

enum { MOST_ITERATIONS = 60 };
static const double longest = 0.05;    // step of a coordinate [rad, m]: a shallow arch turns over else
static const double near_enough = 0.1; // of the mechanism's extent, and in equations of directions
static const double satisfied = 1e-10;

// The largest distance from a closure's end to the ground's origin, a link or another closure [m]
static double extent(const bough_tree *tree, const bough_tree_data *d) {
    bough_vec3 at = bough_tree_frame_pose(d, bough_loops_end(tree, 0, 0)).position;
    double largest = bough_norm(at);
    for (int i = 0; i < tree->n_links; i++)
        largest = fmax(largest, bough_norm(bough_sub(d->pose[i].position, at)));
    for (int c = 0; c < tree->n_closures; c++) {
        bough_vec3 x = bough_tree_frame_pose(d, bough_loops_end(tree, c, 0)).position;
        largest = fmax(largest, bough_norm(bough_sub(x, at)));
    }
    return largest > 1e-6 ? largest : 1;
}

// The row that is violated most, lengths measured by `size`.
static int worst_row(const bough_tree *tree, const bough_tree_data *d, bool of_rate, double size,
                     double *violation) {
    int worst = 0;
    *violation = 0;
    for (int k = 0; k < tree->n_rows; k++) {
        const bough_closure *c = &tree->closures[bough_loops_of_row(tree, k)];
        const bough_constraint_row *row = &d->loops->row[k];
        double x = fabs(of_rate ? row->rate : row->value);
        if (k - c->first_row < c->constraint.n_translation) x /= size;
        if (x <= *violation) continue;
        *violation = x;
        worst = k;
    }
    return worst;
}

static bough_status refuse(const bough_tree *tree, const bough_tree_data *d, int row, bool of_rate) {
    const bough_closure *c = &tree->closures[bough_loops_of_row(tree, row)];
    bool turns = row - c->first_row >= c->constraint.n_translation;
    if (of_rate) {
        return bough_fail(BOUGH_INVALID,
                          "closure '%s': with the initial speeds its ends move apart at %.4g %s; "
                          "leave out the speeds that should follow the others",
                          c->name, fabs(d->loops->row[row].rate), turns ? "rad/s" : "m/s");
    }
    return bough_fail(BOUGH_INVALID,
                      "closure '%s': its ends are %.4g %s apart, from where it cannot be assembled; "
                      "correct the joints' initial positions, the closure's placements or its axis",
                      c->name, fabs(d->loops->row[row].value), turns ? "(sine of an angle)" : "m");
}

// One step of Newton's method, the least in the measure of the inertias.
static bool approach(bough_tree *tree, bough_tree_data *d) {
    bough_loops *l = d->loops;
    double *q = tree->initial, step[BOUGH_JOINT_COORDINATES];
    memset(l->multiplier, 0, (size_t)tree->n_rows * sizeof(double));
    if (!bough_tree_free_dynamics(tree, d, 0, NULL, l->speed) || !bough_loops_mobility(tree, d)) {
        return false;
    }
    double *x = l->work + 4 * tree->n_rows;
    for (int k = 0; k < tree->n_rows; k++) x[k] = l->row[k].value;
    bough_loops_solve(tree, l, x);
    bough_loops_spread(tree, l, x, l->correction);
    double largest = 0;
    for (int k = 0; k < tree->n_v; k++) largest = fmax(largest, fabs(l->correction[k]));
    for (int k = 0; k < tree->n_v && largest > longest; k++) l->correction[k] *= longest / largest;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        double *own = q + link->first_coordinate;
        bough_joint_rate(&link->joint, own, l->correction + link->first_speed, step);
        for (int k = 0; k < link->n_coordinates; k++) own[k] -= step[k];
        bough_joint_normalise(&link->joint, own);
    }
    for (int k = 0; k < tree->n_v; k++)
        tree->closure_moved = fmax(tree->closure_moved, fabs(l->correction[k]));
    return true;
}

static bough_status assemble_positions(bough_tree *tree, bough_tree_data *d, double size) {
    double violation;
    for (int i = 0;; i++) {
        bough_tree_kinematics(tree, tree->initial, d);
        bough_loops_rows(tree, d);
        int row = worst_row(tree, d, false, size, &violation);
        if (violation <= satisfied && i > 0) return bough_ok();
        bool far = i == 0 && violation > near_enough;
        if (far || i == MOST_ITERATIONS || !approach(tree, d)) return refuse(tree, d, row, false);
    }
}

// Row `row` of G
static void jacobian_row(const bough_tree *tree, const bough_tree_data *d, int row, double *g) {
    memset(g, 0, (size_t)tree->n_v * sizeof(double));
    for (int end = 0; end < 2; end++) {
        const bough_frame *frame = bough_loops_end(tree, bough_loops_of_row(tree, row), end);
        if (frame->link < 0) continue;
        bough_wrench w = bough_wrench_to_parent(&frame->placement, d->loops->row[row].wrench[end]);
        for (int i = frame->link; i >= 0; i = tree->links[i].parent) {
            const bough_link *link = &tree->links[i];
            double own[BOUGH_JOINT_SPEEDS];
            bough_joint_force(&link->joint, w, own);
            for (int k = 0; k < link->n_speeds; k++) g[link->first_speed + k] += own[k];
            w = bough_wrench_to_parent(&d->relative[i], w);
        }
    }
}

// Speeds that are zero follow those that are given: the least squares of G δ = −G v over them, or,
// with all of them free, over all.
static bool follow(bough_tree *tree, bough_tree_data *d, bool all) {
    bough_loops *l = d->loops;
    int m = tree->n_rows, n = tree->n_v;
    double *v = tree->initial + tree->n_q, *x = l->work + 4 * m;
    for (int j = 0; j < m; j++) {
        double *g = l->response + (size_t)j * (size_t)n;
        jacobian_row(tree, d, j, g);
        for (int k = 0; k < n; k++) {
            if (!all && v[k] != 0) g[k] = 0;
        }
        for (int i = 0; i < tree->n_links; i++) {
            if (tree->links[i].motion != NULL) g[tree->links[i].first_speed] = 0;
        }
    }
    for (int i = 0; i < m; i++) {
        for (int j = 0; j < m; j++) {
            double sum = 0;
            for (int k = 0; k < n; k++) sum += l->response[i * n + k] * l->response[j * n + k];
            l->matrix[i * m + j] = sum;
        }
    }
    if (!bough_loops_factor(tree, l)) return false;
    for (int j = 0; j < m; j++) x[j] = l->row[j].rate;
    bough_loops_solve(tree, l, x);
    bough_loops_spread(tree, l, x, l->speed);
    for (int k = 0; k < n; k++) v[k] -= l->speed[k];
    return true;
}

static bough_status assemble_speeds(bough_tree *tree, bough_tree_data *d, double size) {
    double violation, fastest = 0;
    for (int k = 0; k < tree->n_v; k++) fastest = fmax(fastest, fabs(tree->initial[tree->n_q + k]));
    for (int attempt = 0;; attempt++) {
        bough_tree_kinematics(tree, tree->initial, d);
        bough_loops_rows(tree, d);
        int row = worst_row(tree, d, true, size, &violation);
        if (violation <= satisfied * fastest) return bough_ok();
        bool far = attempt == 1 && violation > near_enough * fastest;
        if (far || attempt == 3 || !follow(tree, d, attempt > 0)) return refuse(tree, d, row, true);
    }
}

bough_status bough_loops_assemble(bough_tree *tree, bough_tree_data *d) {
    if (d->loops == NULL) return bough_ok();
    bough_tree_kinematics(tree, tree->initial, d);
    double size = tree->closure_size = extent(tree, d);
    bough_status status = assemble_positions(tree, d, size);
    if (bough_is_ok(&status)) {
        tree->closure_rank = d->loops->rank;
        status = assemble_speeds(tree, d, size);
    }
    return status;
}

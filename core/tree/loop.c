#include "core/tree/loop.h"

#include "core/base/base.h"
#include "core/base/linalg.h"
#include "core/tree/dynamics.h"
#include "core/tree/loop_internal.h"

#include <string.h>

// Of the scaled matrix' eigenvalues: below this share of the largest, equations depend on each
// other. It is the square of the distance from a position in which the loop could branch, relative to its
// size.
static const double dependent = 1e-9;
// The same per opening of the loop relative to its size, up to this share.
static const double per_opening = 30, most_dependent = 1e-7;
// Of the diagonal's largest entry of the same kind: below this nothing moves.
static const double rigid = 1e-13;
// Of the largest entry of the other kind, both per length: below this the largest entry of a kind is the
// square of rounding errors. A plane mechanism that lies across the ground's axes has such rotations.
static const double rounding = 1e-22;

// -- construction ------------------------------------------------------------------------------

static bough_status check(const bough_tree *tree, const bough_closure_def *c) {
    if (tree->markers[c->marker[0]].link != tree->markers[c->marker[1]].link) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "closure '%s': its ends cannot move against each other, so there is nothing "
                      "to close",
                      c->name);
}

bough_status bough_loops_place(bough_arena *arena, const bough_tree_def *def, bough_tree *tree) {
    tree->closures = bough_arena_take(arena, (size_t)def->n_closures * sizeof(bough_closure));
    tree->closure_time = def->closure_time > 0 ? def->closure_time : 0.01;
    tree->closure_size = 1;
    for (int k = 0; k < def->n_closures; k++) {
        const bough_closure_def *from = &def->closures[k];
        bough_closure *to = &tree->closures[k];
        bough_status status = check(tree, from);
        if (!bough_is_ok(&status)) return status;
        to->name = bough_arena_string(arena, from->name);
        to->marker[0] = from->marker[0], to->marker[1] = from->marker[1];
        to->constraint = bough_constraint_make(from->kind, from->axis, from->second_axis);
        to->first_row = tree->n_rows;
        tree->n_rows += bough_constraint_n_rows(&to->constraint);
        tree->n_closures++;
    }
    return bough_ok();
}

bough_loops *bough_loops_create(bough_arena *arena, const bough_tree *tree) {
    if (tree->n_closures == 0) return NULL;
    size_t m = (size_t)tree->n_rows, n = (size_t)tree->n_v;
    bough_loops *l = bough_arena_take(arena, sizeof *l);
    l->row = bough_arena_take(arena, m * sizeof *l->row);
    l->response = bough_arena_doubles(arena, m * n);
    l->matrix = bough_arena_doubles(arena, m * m);
    bough_arena_each(arena, m, &l->value, &l->scale, &l->multiplier);
    l->work = bough_arena_doubles(arena, 8 * m);
    l->correction = bough_arena_doubles(arena, n);
    l->speed = bough_arena_doubles(arena, n);
    return l;
}

// -- rows ------------------------------------------------------------------------------------

const bough_frame *bough_loops_end(const bough_tree *tree, int closure, int end) {
    return &tree->markers[tree->closures[closure].marker[end]];
}

static bough_frame_motion motion_of(const bough_tree_data *d, const bough_frame *frame) {
    return (bough_frame_motion){bough_tree_frame_pose(d, frame), bough_tree_frame_twist(d, frame)};
}

void bough_loops_rows(const bough_tree *tree, bough_tree_data *d) {
    for (int c = 0; c < tree->n_closures; c++) {
        bough_frame_motion a = motion_of(d, bough_loops_end(tree, c, 0)),
                           b = motion_of(d, bough_loops_end(tree, c, 1));
        bough_constraint_rows(&tree->closures[c].constraint, &a, &b,
                              d->loops->row + tree->closures[c].first_row);
    }
}

int bough_loops_of_row(const bough_tree *tree, int row) {
    int c = tree->n_closures - 1;
    while (tree->closures[c].first_row > row) c--;
    return c;
}

static bough_twist rate_of(const bough_tree_data *d, const bough_frame *frame) {
    static const bough_twist none;
    return frame->link < 0 ? none : bough_twist_to_child(&frame->placement, d->acceleration[frame->link]);
}

// x = G v̇ with the links' accelerations that stand in the data
static void find_rates(const bough_tree *tree, const bough_tree_data *d, double *x) {
    for (int c = 0; c < tree->n_closures; c++) {
        bough_twist a = rate_of(d, bough_loops_end(tree, c, 0)), b = rate_of(d, bough_loops_end(tree, c, 1));
        int first = tree->closures[c].first_row;
        for (int k = first; k < first + bough_constraint_n_rows(&tree->closures[c].constraint); k++) {
            const bough_wrench *w = d->loops->row[k].wrench;
            x[k] = bough_power(a, w[0]) + bough_power(b, w[1]);
        }
    }
}

// -- the equations of the multipliers ---------------------------------------------------------

// Row `row` of M⁻¹Gᵀ, and G times it into the matrix
static void respond(const bough_tree *tree, bough_tree_data *d, int row) {
    bough_loops *l = d->loops;
    int c = bough_loops_of_row(tree, row), m = tree->n_rows, n = tree->n_v;
    double *sum = l->response + (size_t)row * (size_t)n, *column = l->matrix + (size_t)row * (size_t)m;
    memset(sum, 0, (size_t)n * sizeof(double));
    memset(column, 0, (size_t)m * sizeof(double));
    for (int end = 0; end < 2; end++) {
        const bough_frame *frame = bough_loops_end(tree, c, end);
        if (frame->link < 0) continue;
        bough_tree_free_response(tree, d, frame, l->row[row].wrench[end], l->speed);
        find_rates(tree, d, l->work);
        for (int k = 0; k < n; k++) sum[k] += l->speed[k];
        for (int k = 0; k < m; k++) column[k] += l->work[k];
    }
}

// Whether an equation is one of rotation.
static bool turns(const bough_tree *tree, int row) {
    const bough_closure *c = &tree->closures[bough_loops_of_row(tree, row)];
    return row - c->first_row >= c->constraint.n_translation;
}

// Of the diagonal, among equations of translation and of rotation; infinite where that is rounding
static void find_largest(const bough_tree *tree, const bough_loops *l, double largest[2]) {
    int m = tree->n_rows;
    double area = tree->closure_size * tree->closure_size;
    largest[0] = largest[1] = 0;
    for (int k = 0; k < m; k++) {
        double *x = &largest[turns(tree, k)];
        *x = fmax(*x, l->matrix[k * m + k]);
    }
    bool still = largest[0] < rounding * area * largest[1],
         straight = area * largest[1] < rounding * largest[0];
    if (still) largest[0] = INFINITY;
    if (straight) largest[1] = INFINITY;
}

// A loop that is open by ε of its size goes on in the other way within a distance of √ε from such a position.
static double least_eigenvalue(const bough_tree *tree, const bough_loops *l) {
    double open = 0;
    for (int k = 0; k < tree->n_rows; k++) {
        double size = turns(tree, k) ? 1 : tree->closure_size;
        open = fmax(open, fabs(l->row[k].value) / size);
    }
    return fmin(fmax(dependent, per_opening * open), most_dependent) * l->value[tree->n_rows - 1];
}

// One scale for the translations of a closure and one for its rotations: its largest entry becomes one. Near
// a position where equations begin to depend on each other, an entry of its own for each would hide that: the
// loop's errors then turn the motion aside, with accelerations without bound. Rows that nothing moves drop
// out.
static void find_scales(const bough_tree *tree, bough_loops *l) {
    int m = tree->n_rows;
    double largest[2];
    find_largest(tree, l, largest);
    for (int c = 0; c < tree->n_closures; c++) {
        int first = tree->closures[c].first_row;
        int last = c + 1 < tree->n_closures ? tree->closures[c + 1].first_row : m;
        double own[2] = {0, 0};
        for (int k = first; k < last; k++) {
            double *x = &own[turns(tree, k)];
            *x = fmax(*x, l->matrix[k * m + k]);
        }
        for (int k = first; k < last; k++) {
            bool moves = l->matrix[k * m + k] > rigid * largest[turns(tree, k)];
            l->scale[k] = moves ? 1 / sqrt(own[turns(tree, k)]) : 0;
        }
    }
}

// Scales the matrix and finds its eigenvectors.
bool bough_loops_factor(const bough_tree *tree, bough_loops *l) {
    int m = tree->n_rows;
    find_scales(tree, l);
    for (int j = 0; j < m; j++) {
        for (int k = 0; k < m; k++) l->matrix[j * m + k] *= l->scale[j] * l->scale[k];
    }
    if (!bough_symmetric_eigen(m, l->matrix, l->value, l->work)) return false;
    double least = least_eigenvalue(tree, l);
    l->rank = 0;
    for (int k = 0; k < m; k++) {
        if (l->value[k] > least) l->rank++;
    }
    return true;
}

// After kinematics, bough_loops_rows and free dynamics at this state.
bool bough_loops_mobility(const bough_tree *tree, bough_tree_data *d) {
    for (int k = 0; k < tree->n_rows; k++) respond(tree, d, k);
    return bough_loops_factor(tree, d->loops);
}

// The least x of all that make G M⁻¹Gᵀ x = x as far as it can be, in place
void bough_loops_solve(const bough_tree *tree, const bough_loops *l, double *x) {
    int m = tree->n_rows;
    double *part = l->work;
    double least = least_eigenvalue(tree, l);
    for (int i = 0; i < m; i++) {
        part[i] = 0;
        if (l->value[i] <= least) continue;
        for (int k = 0; k < m; k++) part[i] += l->matrix[i * m + k] * l->scale[k] * x[k];
        part[i] /= l->value[i];
    }
    for (int k = 0; k < m; k++) {
        double sum = 0;
        for (int i = 0; i < m; i++) sum += l->matrix[i * m + k] * part[i];
        x[k] = l->scale[k] * sum;
    }
}

// speed (n_v) = M⁻¹Gᵀ x
void bough_loops_spread(const bough_tree *tree, const bough_loops *l, const double *x, double *speed) {
    int n = tree->n_v;
    memset(speed, 0, (size_t)n * sizeof(double));
    for (int j = 0; j < tree->n_rows; j++) {
        for (int k = 0; k < n; k++) speed[k] += x[j] * l->response[(size_t)j * (size_t)n + (size_t)k];
    }
}

// -- dynamics ---------------------------------------------------------------------------------

bool bough_tree_forward_dynamics(const bough_tree *tree, bough_tree_data *d, double t, const double *input,
                                 double *acceleration) {
    bough_loops *l = d->loops;
    if (l == NULL) return bough_tree_free_dynamics(tree, d, t, input, acceleration);
    int m = tree->n_rows;
    double *x = l->work + 4 * m;
    memset(l->multiplier, 0, (size_t)m * sizeof(double));
    if (!bough_tree_free_dynamics(tree, d, t, input, acceleration)) return false;
    bough_loops_rows(tree, d);
    find_rates(tree, d, x);
    for (int k = 0; k < m; k++)
        l->multiplier[k] = -(x[k] + l->row[k].bias + l->row[k].rate / tree->closure_time);
    if (!bough_loops_mobility(tree, d)) return false;
    bough_loops_solve(tree, l, l->multiplier);
    for (int k = 0; k < m; k++) x[k] = l->row[k].value / tree->closure_time;
    bough_loops_solve(tree, l, x);
    bough_loops_spread(tree, l, x, l->correction);
    return bough_tree_free_dynamics(tree, d, t, input, acceleration);
}

void bough_tree_response(const bough_tree *tree, bough_tree_data *d, const bough_frame *frame,
                         bough_wrench wrench, double *change) {
    bough_tree_free_response(tree, d, frame, wrench, change);
    bough_loops *l = d->loops;
    if (l == NULL || frame->link < 0) return;
    double *x = l->work + 4 * tree->n_rows;
    find_rates(tree, d, x);
    bough_loops_solve(tree, l, x);
    bough_loops_spread(tree, l, x, l->speed);
    for (int k = 0; k < tree->n_v; k++) change[k] -= l->speed[k];
}

void bough_loops_correct(const bough_tree *tree, const bough_tree_data *d, const double *state,
                         double *rate) {
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        double own[BOUGH_JOINT_COORDINATES];
        bough_joint_rate(&link->joint, state + link->first_coordinate,
                         d->loops->correction + link->first_speed, own);
        for (int k = 0; k < link->n_coordinates; k++) rate[link->first_coordinate + k] -= own[k];
    }
}

double bough_loops_margin(const bough_tree *tree, bough_tree_data *d, int *closure) {
    bough_loops *l = d->loops;
    int m = tree->n_rows, smallest = m - tree->closure_rank, row = 0;
    double largest[2];
    if (tree->closure_rank == 0) return 1;
    for (int k = 0; k < m; k++) respond(tree, d, k);
    find_largest(tree, l, largest);
    for (int j = 0; j < m; j++) {
        for (int k = 0; k < m; k++) {
            double size = sqrt(largest[turns(tree, j)] * largest[turns(tree, k)]);
            l->matrix[j * m + k] = size > 0 ? l->matrix[j * m + k] / size : 0;
        }
    }
    if (!bough_symmetric_eigen(m, l->matrix, l->value, l->work)) return 1;
    const double *vector = l->matrix + (size_t)smallest * (size_t)m;
    for (int k = 1; k < m; k++) {
        if (fabs(vector[k]) > fabs(vector[row])) row = k;
    }
    *closure = bough_loops_of_row(tree, row);
    return l->value[smallest] / l->value[m - 1];
}

bough_wrench bough_loops_wrench(const bough_tree *tree, const bough_tree_data *d, int closure) {
    bough_wrench sum = {{0, 0, 0}, {0, 0, 0}};
    const bough_closure *c = &tree->closures[closure];
    for (int k = c->first_row; k < c->first_row + bough_constraint_n_rows(&c->constraint); k++) {
        bough_wrench w = d->loops->row[k].wrench[1];
        sum.force = bough_axpy(d->loops->multiplier[k], w.force, sum.force);
        sum.moment = bough_axpy(d->loops->multiplier[k], w.moment, sum.moment);
    }
    return sum;
}

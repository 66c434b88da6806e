// Closed loops, theory (45, 46).
#include "core/tree/loop.h"

#include "core/base/linalg.h"
#include "core/tree/dynamics.h"
#include "core/tree/force.h"

// Eigenvalues of the scaled matrix below this, relative to the largest, belong to dependent equations. It is
// the square of the distance from a position in which the loop could branch, relative to the loop's size.
static const double dependent = 1e-9;
// The same limit per opening of the loop relative to its size. It is at most the smaller of `most_dependent`
// and this share of the smallest eigenvalue at the start, which is small where masses are very different.
static const double per_opening = 30, most_dependent = 3e-6, dependent_share = 1e-3;
static const double dependent_before = 1e-7; // its maximum until the loops are assembled
// Diagonal entries below this, relative to the largest of the same kind, belong to equations that nothing
// moves.
static const double rigid = 1e-13;
// Below this, relative to the largest entry of the other kind, both per length, the largest entry of a kind
// is the square of rounding errors. A plane mechanism oblique to the ground's axes has such rotations.
static const double rounding = 1e-22;

// -- construction ------------------------------------------------------------------------------

static bough_status check(const bough_tree *tree, const bough_closure_def *c) {
    if (tree->markers[c->marker[0]].link != tree->markers[c->marker[1]].link) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "closure '%s': its ends cannot move relative to each other, so there is nothing "
                      "to close",
                      c->name);
}

bough_status bough_loops_place(bough_arena *arena, const bough_tree_def *def, bough_tree *tree) {
    tree->closures = bough_arena_take(arena, (size_t)def->n_closures * sizeof(bough_closure));
    tree->closure_time = def->closure_time > 0 ? def->closure_time : 0.01;
    tree->closure_size = 1;
    tree->closure_dependent = dependent_before;
    for (int k = 0; k < def->n_closures; k++) {
        const bough_closure_def *from = &def->closures[k];
        bough_closure *to = &tree->closures[k];
        BOUGH_TRY(check(tree, from));
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
    bough_arena_each(arena, n, &l->correction, &l->speed);
    return l;
}

// -- rows ------------------------------------------------------------------------------------

// The marker at an end of a closure.
static const bough_frame *end_of(const bough_tree *tree, int closure, int end) {
    return &tree->markers[tree->closures[closure].marker[end]];
}

void bough_loops_rows(const bough_tree *tree, bough_tree_data *d) {
    for (int c = 0; c < tree->n_closures; c++) {
        bough_frame_motion a = bough_tree_frame_motion(d, end_of(tree, c, 0));
        bough_frame_motion b = bough_tree_frame_motion(d, end_of(tree, c, 1));
        bough_constraint_rows(&tree->closures[c].constraint, &a, &b,
                              d->loops->row + tree->closures[c].first_row);
    }
}

// The closure that an equation belongs to.
static int closure_of(const bough_tree *tree, int row) {
    int c = tree->n_closures - 1;
    while (tree->closures[c].first_row > row) c--;
    return c;
}

static bough_twist rate_of(const bough_tree_data *d, const bough_frame *frame) {
    static const bough_twist none;
    return frame->link < 0 ? none : bough_twist_to_child(&frame->placement, d->acceleration[frame->link]);
}

// x = G v̇ with the links' accelerations in the data
static void find_rates(const bough_tree *tree, const bough_tree_data *d, double *x) {
    for (int c = 0; c < tree->n_closures; c++) {
        bough_twist a = rate_of(d, end_of(tree, c, 0)), b = rate_of(d, end_of(tree, c, 1));
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
    int c = closure_of(tree, row), m = tree->n_rows, n = tree->n_v;
    double *sum = l->response + (size_t)row * (size_t)n, *column = l->matrix + (size_t)row * (size_t)m;
    memset(sum, 0, (size_t)n * sizeof(double));
    memset(column, 0, (size_t)m * sizeof(double));
    for (int end = 0; end < 2; end++) {
        const bough_frame *frame = end_of(tree, c, end);
        if (frame->link < 0) continue;
        bough_tree_free_response(tree, d, frame, l->row[row].wrench[end], l->speed);
        find_rates(tree, d, l->work);
        for (int k = 0; k < n; k++) sum[k] += l->speed[k];
        for (int k = 0; k < m; k++) column[k] += l->work[k];
    }
}

// Whether an equation is one of rotation.
static bool turns(const bough_tree *tree, int row) {
    const bough_closure *c = &tree->closures[closure_of(tree, row)];
    return row - c->first_row >= c->constraint.n_translation;
}

// Largest diagonal entries of translations and of rotations; infinite where they are rounding errors
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

// The threshold: a loop that is open by ε of its size changes to the other branch within √ε of a branch
// position.
static double least_eigenvalue(const bough_tree *tree, const bough_loops *l) {
    double open = 0;
    for (int k = 0; k < tree->n_rows; k++) {
        double size = turns(tree, k) ? 1 : tree->closure_size;
        open = fmax(open, fabs(l->row[k].value) / size);
    }
    double least = fmin(per_opening * open, tree->closure_dependent);
    return fmax(least, dependent) * l->value[tree->n_rows - 1];
}

// One scale for the translations of a closure and one for its rotations: its largest entry becomes one. Near
// a position where equations begin to depend on each other, separate scales would hide that, and errors of
// the loop would deflect the motion with unbounded accelerations. Rows that nothing moves are left out.
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
static bool factor(const bough_tree *tree, bough_loops *l) {
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

// M⁻¹Gᵀ and the factors of G M⁻¹Gᵀ, unless they are of these coordinates; after kinematics, bough_loops_rows
// and free dynamics there.
static bool find_mobility(const bough_tree *tree, bough_tree_data *d) {
    bough_loops *l = d->loops;
    for (int k = 0; k < tree->n_rows && !l->found; k++) respond(tree, d, k);
    l->found = l->found || factor(tree, l);
    return l->found;
}

// The least x with G M⁻¹Gᵀ x equal to the given x in the least-squares sense, in place
static void solve(const bough_tree *tree, const bough_loops *l, double *x) {
    int m = tree->n_rows;
    double *part = l->work;
    double least = least_eigenvalue(tree, l);
    for (int i = 0; i < m; i++) {
        part[i] = 0;
        // by the pseudo-inverse: dependent directions are left out
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
static void spread(const bough_tree *tree, const bough_loops *l, const double *x, double *speed) {
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
    // v̇ of the open tree, from which the right side follows
    if (!bough_tree_free_dynamics(tree, d, t, input, acceleration)) return false;
    bough_loops_rows(tree, d);
    find_rates(tree, d, x);
    for (int k = 0; k < m; k++)
        // theory (46): G v̇ + Ġ v = −G v/T
        l->multiplier[k] = -(x[k] + l->row[k].bias + l->row[k].rate / tree->closure_time);
    if (!find_mobility(tree, d)) return false;
    solve(tree, l, l->multiplier);
    // theory (45): G M⁻¹Gᵀ μ = g/T
    for (int k = 0; k < m; k++) x[k] = l->row[k].value / tree->closure_time;
    solve(tree, l, x);
    spread(tree, l, x, l->correction);
    // the dynamics again, under Gᵀλ
    return bough_tree_free_dynamics(tree, d, t, input, acceleration);
}

void bough_tree_response(const bough_tree *tree, bough_tree_data *d, const bough_frame *frame,
                         bough_wrench wrench, double *change) {
    bough_tree_free_response(tree, d, frame, wrench, change);
    bough_loops *l = d->loops;
    if (l == NULL || frame->link < 0) return;
    double *x = l->work + 4 * tree->n_rows;
    find_rates(tree, d, x);
    solve(tree, l, x);
    spread(tree, l, x, l->speed);
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
    static const double risen = 1e-5; // rows that always depend on others keep eigenvalues of rounding
    bough_loops *l = d->loops;
    int m = tree->n_rows, smallest = m - tree->closure_rank, row = 0;
    double largest[2];
    if (tree->closure_rank == 0) return 1;
    l->found = false;
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
    *closure = closure_of(tree, row);
    // a row that depended on the others at the start alone: the loop began in a singular position
    if (smallest > 0 && l->value[smallest - 1] > risen * l->value[m - 1]) return 0;
    return l->value[smallest] / l->value[m - 1];
}

bough_wrench bough_loops_wrench(const bough_tree *tree, const bough_tree_data *d, int closure) {
    bough_wrench sum = {{0, 0, 0}, {0, 0, 0}};
    const bough_closure *c = &tree->closures[closure];
    for (int k = c->first_row; k < c->first_row + bough_constraint_n_rows(&c->constraint); k++) {
        bough_wrench w = bough_wrench_scale(d->loops->multiplier[k], d->loops->row[k].wrench[1]);
        sum = bough_wrench_add(sum, w);
    }
    return sum;
}

// -- the initial state: coordinates and speeds that satisfy the closures -----------------------

enum { MOST_ITERATIONS = 60 };
static const double longest = 0.05;    // step of a coordinate [rad, m]: longer ones snap a shallow arch
static const double near_enough = 0.1; // relative to the mechanism's extent, and for directions
static const double satisfied = 1e-10;
static const double point = 1e-6; // no mechanism is as small [m]

// The largest distance from a closure's end to the ground's origin, a link or another closure; where they lie
// in one point, to a spring's end [m]
static double extent(const bough_tree *tree, const bough_tree_data *d) {
    bough_vec3 at = bough_tree_frame_pose(d, end_of(tree, 0, 0)).position;
    double largest = bough_norm(at);
    for (int i = 0; i < tree->n_links; i++)
        largest = fmax(largest, bough_norm(bough_sub(d->pose[i].position, at)));
    for (int c = 0; c < tree->n_closures; c++) {
        bough_vec3 x = bough_tree_frame_pose(d, end_of(tree, c, 0)).position;
        largest = fmax(largest, bough_norm(bough_sub(x, at)));
    }
    bool together = largest < point;
    for (int e = 0; together && e < 2 * bough_tree_n_elements(tree); e++) {
        bough_vec3 x = bough_tree_frame_pose(d, bough_element_frame(tree, e / 2, e % 2)).position;
        largest = fmax(largest, bough_norm(bough_sub(x, at)));
    }
    return largest > point ? largest : 1;
}

// The row that is violated most, lengths measured by `size`.
static int worst_row(const bough_tree *tree, const bough_tree_data *d, bool of_rate, double size,
                     double *violation) {
    int worst = 0;
    *violation = 0;
    for (int k = 0; k < tree->n_rows; k++) {
        const bough_constraint_row *row = &d->loops->row[k];
        double x = fabs(of_rate ? row->rate : row->value);
        if (!turns(tree, k)) x /= size;
        if (x <= *violation) continue;
        *violation = x;
        worst = k;
    }
    return worst;
}

double bough_loops_opening(const bough_tree *tree, bough_tree_data *d, int *closure) {
    double opening;
    bough_loops_rows(tree, d);
    *closure = closure_of(tree, worst_row(tree, d, false, tree->closure_size, &opening));
    return opening;
}

static bough_status refuse(const bough_tree *tree, const bough_tree_data *d, int row, bool of_rate) {
    const char *name = tree->closures[closure_of(tree, row)].name;
    bool turning = turns(tree, row);
    if (of_rate) {
        return bough_fail(
            BOUGH_INVALID,
            "closure '%s': with the initial speeds its ends separate at %.4g %s; leave out the speeds that follow from the others",
            name, fabs(d->loops->row[row].rate), turning ? "rad/s" : "m/s");
    }
    return bough_fail(
        BOUGH_INVALID,
        "closure '%s': its ends are %.4g %s apart and cannot be brought together; correct the joints' initial positions, the closure's placements or its axis",
        name, fabs(d->loops->row[row].value), turning ? "(sine of an angle)" : "m");
}

// Moves the coordinates by the correction, at most by the longest step.
static void move(bough_tree *tree, bough_tree_data *d) {
    bough_loops *l = d->loops;
    double *q = tree->initial, largest = 0;
    for (int k = 0; k < tree->n_v; k++) largest = fmax(largest, fabs(l->correction[k]));
    for (int k = 0; k < tree->n_v && largest > longest; k++) l->correction[k] *= longest / largest;
    bough_loops_correct(tree, d, q, q);
    for (int i = 0; i < tree->n_links; i++)
        bough_joint_normalise(&tree->links[i].joint, q + tree->links[i].first_coordinate);
    for (int k = 0; k < tree->n_v; k++)
        tree->closure_moved = fmax(tree->closure_moved, fabs(l->correction[k]));
}

// One step of Newton's method, the least in the measure of the inertias.
static bool approach(bough_tree *tree, bough_tree_data *d) {
    bough_loops *l = d->loops;
    memset(l->multiplier, 0, (size_t)tree->n_rows * sizeof(double));
    if (!bough_tree_free_dynamics(tree, d, 0, NULL, l->speed) || !find_mobility(tree, d)) {
        return false;
    }
    double *x = l->work + 4 * tree->n_rows;
    for (int k = 0; k < tree->n_rows; k++) x[k] = l->row[k].value;
    solve(tree, l, x);
    spread(tree, l, x, l->correction);
    move(tree, d);
    return true;
}

// Row `row` of G
static void jacobian_row(const bough_tree *tree, const bough_tree_data *d, int row, double *g) {
    memset(g, 0, (size_t)tree->n_v * sizeof(double));
    for (int end = 0; end < 2; end++) {
        const bough_frame *frame = end_of(tree, closure_of(tree, row), end);
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

// What may change besides joints whose speed is zero: those of given speed, the ends of rods.
enum { JOINTS = 0, GIVEN = 1, ENDS = 2 };

// change (n_v): the least change of the coordinates that makes the closures' values, or, `of_rate`, the least
// change of the speeds that makes their rates.
static bool least_squares(bough_tree *tree, bough_tree_data *d, int loose, bool of_rate, double *change) {
    bough_loops *l = d->loops;
    int m = tree->n_rows, n = tree->n_v;
    const double *v = tree->initial + tree->n_q;
    double *x = l->work + 4 * m;
    for (int j = 0; j < m; j++) {
        double *g = l->response + (size_t)j * (size_t)n;
        jacobian_row(tree, d, j, g);
        for (int k = 0; k < n; k++) {
            if (!(loose & GIVEN) && v[k] != 0) g[k] = 0;
        }
        for (int i = 0; i < tree->n_links; i++) {
            if (tree->links[i].motion != NULL) g[tree->links[i].first_speed] = 0;
        }
        for (int e = 0; e < tree->n_ends && !(loose & ENDS); e++)
            memset(g + tree->links[tree->ends[e].link].first_speed, 0, BOUGH_JOINT_SPEEDS * sizeof *g);
    }
    for (int i = 0; i < m; i++) {
        for (int j = 0; j < m; j++) {
            double sum = 0;
            for (int k = 0; k < n; k++) sum += l->response[i * n + k] * l->response[j * n + k];
            l->matrix[i * m + j] = sum;
        }
    }
    if (!factor(tree, l)) return false;
    for (int j = 0; j < m; j++) x[j] = of_rate ? l->row[j].rate : l->row[j].value;
    solve(tree, l, x);
    spread(tree, l, x, change);
    return true;
}

// Newton's method by the joints alone: rods keep their shapes, which their ends would strain.
static void close_joints(bough_tree *tree, bough_tree_data *d, double size) {
    double violation;
    for (int i = 0; i < MOST_ITERATIONS; i++) {
        bough_tree_kinematics(tree, tree->initial, d);
        bough_loops_rows(tree, d);
        worst_row(tree, d, false, size, &violation);
        if (violation <= satisfied || violation > near_enough) return;
        if (!least_squares(tree, d, GIVEN, false, d->loops->correction)) return;
        move(tree, d);
    }
}

static bough_status assemble_positions(bough_tree *tree, bough_tree_data *d, double size) {
    double violation;
    if (tree->n_ends > 0) close_joints(tree, d, size);
    for (int i = 0;; i++) {
        bough_tree_kinematics(tree, tree->initial, d);
        bough_loops_rows(tree, d);
        int row = worst_row(tree, d, false, size, &violation);
        if (violation <= satisfied && i > 0) return bough_ok();
        bool far = i == 0 && violation > near_enough;
        if (far || i == MOST_ITERATIONS || !approach(tree, d)) return refuse(tree, d, row, false);
    }
}

// Changes speeds by the least squares that close the rates: in the first attempt those of joints that are
// zero, then those of the rods' ends too, at last the given ones.
static bool follow(bough_tree *tree, bough_tree_data *d, int loose) {
    double *v = tree->initial + tree->n_q, *change = d->loops->speed;
    if (!least_squares(tree, d, loose, true, change)) return false;
    for (int k = 0; k < tree->n_v; k++) v[k] -= change[k];
    return true;
}

static bough_status assemble_speeds(bough_tree *tree, bough_tree_data *d, double size) {
    double violation, fastest = 0;
    for (int k = 0; k < tree->n_v; k++) fastest = fmax(fastest, fabs(tree->initial[tree->n_q + k]));
    for (int attempt = tree->n_ends > 0 ? -1 : 0;; attempt++) {
        bough_tree_kinematics(tree, tree->initial, d);
        bough_loops_rows(tree, d);
        int row = worst_row(tree, d, true, size, &violation);
        if (violation <= satisfied * fastest) return bough_ok();
        int loose = attempt < 0 ? JOINTS : attempt == 0 ? ENDS : GIVEN | ENDS;
        bool far = attempt == 1 && violation > near_enough * fastest;
        if (far || attempt == 3 || !follow(tree, d, loose)) return refuse(tree, d, row, true);
    }
}

// With the factors of the assembled loops.
static void find_rank(bough_tree *tree, const bough_loops *l) {
    int m = tree->n_rows;
    tree->closure_rank = l->rank;
    if (l->rank == 0) return;
    double smallest = l->value[m - l->rank] / l->value[m - 1];
    tree->closure_dependent = fmin(dependent_share * smallest, most_dependent);
}

bough_status bough_loops_assemble(bough_tree *tree, bough_tree_data *d) {
    if (d->loops == NULL) return bough_ok();
    bough_tree_kinematics(tree, tree->initial, d);
    double size = tree->closure_size = extent(tree, d);
    BOUGH_TRY(assemble_positions(tree, d, size));
    find_rank(tree, d->loops);
    return assemble_speeds(tree, d, size);
}

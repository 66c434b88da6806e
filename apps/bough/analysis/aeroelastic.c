#include "apps/bough/analysis/aeroelastic.h"

#include "core/base/linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double converged = 1e-3; // largest relative residual of a mode that is kept
static const double same = 1e-4;      // relative distance of two real eigenvalues that count as a double one

enum { SWEEPS = 12 }; // of the simultaneous iteration, on twice as many vectors as are kept

static const double least_motion = 0.2; // participation of the bodies; modes with less are the air's

typedef struct work {
    bough_whole *coupled;
    const bough_modes_def *def;
    int n, k;
    double *inverse;                   // P = (I − γJ)⁻¹ (n × n)
    double *turned;                    // I + γ P S, factored (n × n)
    int *pivot;                        // (n)
    double *right, *left;              // bases (n × k)
    double *image, *mode, *mode_image; // (n × k)
} work;

static void take(bough_arena *arena, work *w) {
    size_t n = (size_t)w->n, k = (size_t)w->k;
    w->pivot = bough_arena_take(arena, (n + k) * sizeof *w->pivot);
    bough_arena_each(arena, n * n, &w->inverse, &w->turned);
    bough_arena_each(arena, n * k, &w->right, &w->left, &w->image, &w->mode, &w->mode_image);
}

// -- the inverse ----------------------------------------------------------------------------------

static void invert(work *w) {
    size_t n = (size_t)w->n;
    for (size_t j = 0; j < n; j++) {
        double *column = w->inverse + j * n;
        memset(column, 0, n * sizeof *column);
        column[j] = 1;
        bough_whole_solve(w->coupled, column);
        bough_whole_project(w->coupled, w->def->state, column);
    }
}

// A joint that nothing holds moves on at its speed: the eigenvalue 0 twice, with one vector. Joints'
// coordinates that go back this slowly, against the point, have two.
static const double going_back = 1e-6;

// I + γ P S
static bool turn(work *w, int n_coordinate) {
    const bough_modes_def *def = w->def;
    size_t n = (size_t)w->n;
    int parts = def->n_part;
    double *rate = w->image; // (parts × parts)
    memset(w->turned, 0, n * n * sizeof *w->turned);
    for (size_t j = 0; j < n; j++) w->turned[j * n + j] = 1;
    for (size_t j = 0; j < (size_t)n_coordinate; j++) {
        for (size_t i = 0; i < n; i++) w->turned[j * n + i] += going_back * w->inverse[j * n + i];
    }
    if (def->spin == 0) return bough_dense_factor(w->n, w->turned, w->pivot);
    bough_modes_rate(def, rate);
    for (int l = 0; l < parts; l++) {
        for (int k = 0; k < parts; k++) {
            double factor = rate[k * parts + l] / def->point;
            for (int j = 0; j < def->n_row && factor != 0; j++) {
                size_t to = (size_t)def->row[l * def->n_row + j];
                size_t from = (size_t)def->row[k * def->n_row + j];
                const double *column = w->inverse + from * n;
                for (size_t i = 0; i < n; i++) w->turned[to * n + i] += factor * column[i];
            }
        }
    }
    return bough_dense_factor(w->n, w->turned, w->pivot);
}

static void apply(const work *w, const double *x, double *image) {
    bough_dense_product((bough_product){w->n, w->k, w->n, false, 1, 0}, w->inverse, x, image);
    bough_dense_solve(w->n, w->k, w->turned, w->pivot, image);
}

// x is changed.
static void apply_transposed(const work *w, double *x, double *image) {
    bough_dense_solve_transposed(w->n, w->k, w->turned, w->pivot, x);
    bough_dense_product((bough_product){w->n, w->k, w->n, true, 1, 0}, w->inverse, x, image);
}

// -- subspaces ------------------------------------------------------------------------------------

static void orthonormalise(const work *w, double *x) {
    size_t n = (size_t)w->n;
    for (int twice = 0; twice < 2; twice++) { // for rounding
        for (int j = 0; j < w->k; j++) {
            double *column = x + (size_t)j * n, norm = 0;
            for (int i = 0; i < j; i++) {
                const double *other = x + (size_t)i * n;
                double product = 0;
                for (size_t r = 0; r < n; r++) product += column[r] * other[r];
                for (size_t r = 0; r < n; r++) column[r] -= product * other[r];
            }
            for (size_t r = 0; r < n; r++) norm += column[r] * column[r];
            norm = 1 / sqrt(norm);
            for (size_t r = 0; r < n; r++) column[r] *= norm;
        }
    }
}

// Start vectors, the same in every run.
static void start(const work *w, double *x) {
    uint64_t seed = 1;
    for (size_t i = 0; i < (size_t)w->n * (size_t)w->k; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        x[i] = (double)(seed >> 11) / 4503599627370496. - 1;
    }
    orthonormalise(w, x);
}

static void find_subspaces(work *w) {
    size_t bytes = (size_t)w->n * (size_t)w->k * sizeof(double);
    start(w, w->right);
    memcpy(w->left, w->right, bytes);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        apply(w, w->right, w->image);
        memcpy(w->right, w->image, bytes);
        orthonormalise(w, w->right);
        apply_transposed(w, w->left, w->image);
        memcpy(w->left, w->image, bytes);
        orthonormalise(w, w->left);
    }
}

// -- the reduced system ---------------------------------------------------------------------------

// The modes of a basis that is twice as large as needed: the others have not converged.
typedef struct ritz {
    double *matrix, *value, *vector, *room; // (k × k), (2 × k), (k × k), (8 k)
    int *order;                             // (k) by the size of the inverse's eigenvalue
    bool *good, *taken;                     // (k) converged, and in use
} ritz;

static void take_ritz(bough_arena *arena, int k, ritz *r) {
    size_t n = (size_t)k;
    bough_arena_each(arena, n * n, &r->matrix, &r->vector);
    r->value = bough_arena_doubles(arena, 2 * n);
    r->room = bough_arena_doubles(arena, 8 * n);
    r->order = bough_arena_take(arena, n * sizeof *r->order);
    r->good = bough_arena_take(arena, n * sizeof *r->good);
    r->taken = bough_arena_take(arena, n * sizeof *r->taken);
}

// Pairs stay together, as they are equal in size.
static void sort_ritz(int k, ritz *r) {
    for (int i = 0; i < k; i++) r->order[i] = i;
    for (int i = 1; i < k; i++) {
        int own = r->order[i], at = i;
        double size = hypot(r->value[own], r->value[k + own]);
        for (; at > 0; at--) {
            int other = r->order[at - 1];
            if (hypot(r->value[other], r->value[k + other]) >= size) break;
            r->order[at] = other;
        }
        r->order[at] = own;
    }
}

// |M v − μ v| / |μ v| of a real mode or of a pair, by its first; images (n × k): M v.
static double residual(const work *w, const ritz *r, int at, const double *modes, const double *images) {
    size_t n = (size_t)w->n;
    const double *v = modes + (size_t)at * n, *image = images + (size_t)at * n;
    double re = r->value[at], im = r->value[w->k + at], defect = 0, size = 0;
    const double *other = im > 0 ? v + n : v; // its imaginary part
    for (size_t i = 0; i < n; i++) {
        double expected = re * v[i] - (im > 0 ? im * other[i] : 0), off = image[i] - expected;
        defect += off * off;
        size += (re * re + im * im) * (v[i] * v[i] + (im > 0 ? other[i] * other[i] : 0));
    }
    return sqrt(defect / size);
}

// Puts the modes of a basis (n × k) in its place; its image under the inverse or its transpose is in
// w->image.
static bool find_ritz(work *w, double *basis, ritz *r) {
    int n = w->n, k = w->k;
    bough_dense_product((bough_product){k, k, n, true, 1, 0}, basis, w->image, r->matrix);
    if (!bough_dense_eigen(k, r->matrix, r->value, r->vector, r->room)) return false;
    bough_dense_product((bough_product){n, k, k, false, 1, 0}, basis, r->vector, w->mode);
    bough_dense_product((bough_product){n, k, k, false, 1, 0}, w->image, r->vector, w->mode_image);
    sort_ritz(k, r);
    for (int i = 0; i < k; i++) {
        r->good[i] = residual(w, r, i, w->mode, w->mode_image) < converged;
    }
    memcpy(basis, w->mode, (size_t)n * (size_t)k * sizeof *basis);
    return true;
}

// The left mode of the same eigenvalue, −1: none has converged.
static int partner(int k, const ritz *right, int at, const ritz *left) {
    double re = right->value[at], im = right->value[k + at], nearest = converged * hypot(re, im);
    int found = -1;
    for (int i = 0; i < k; i++) {
        double off = hypot(left->value[i] - re, left->value[k + i] - im);
        if (!left->good[i] || left->taken[i] || off > nearest) continue;
        nearest = off;
        found = i;
    }
    return found;
}

// Keeps the modes that have converged on both sides, largest eigenvalues first, no pair in part: their
// number. block[i]: size of the block of modes that begins at i, a pair or a double real one.
static int keep(work *w, const ritz *right, ritz *left, int most, int *block) {
    size_t n = (size_t)w->n, bytes = n * sizeof(double);
    int kept = 0;
    double last = 0; // eigenvalue of a real mode alone before
    for (int i = 0; i < w->k; i++) {
        int at = right->order[i], size = right->value[w->k + at] > 0 ? 2 : 1;
        if (right->value[w->k + at] < 0 || kept + size > most || !right->good[at]) continue;
        int other = partner(w->k, right, at, left);
        if (other < 0) continue;
        left->taken[other] = true;
        double value = right->value[at];
        bool is_double = size == 1 && fabs(value - last) < same * fabs(value);
        block[is_double ? kept - 1 : kept] = is_double ? 2 : size;
        last = size == 1 && !is_double ? value : 0;
        for (int c = 0; c < size; c++, kept++) {
            memcpy(w->mode + (size_t)kept * n, w->right + (size_t)(at + c) * n, bytes);
            memcpy(w->mode_image + (size_t)kept * n, w->left + (size_t)(other + c) * n, bytes);
        }
    }
    memcpy(w->right, w->mode, (size_t)kept * bytes);
    memcpy(w->left, w->mode_image, (size_t)kept * bytes);
    return kept;
}

// Makes two columns (n) orthonormal. The modes of the double eigenvalue 0 of a rotor that turns freely are
// almost parallel; their difference is the second motion.
static void separate(size_t n, double *a) {
    double *b = a + n, aa = 0, ab = 0, bb = 0;
    for (size_t i = 0; i < n; i++) aa += a[i] * a[i];
    for (size_t i = 0; i < n; i++) ab += a[i] * b[i];
    for (size_t i = 0; i < n; i++) b[i] -= ab / aa * a[i];
    for (size_t i = 0; i < n; i++) bb += b[i] * b[i];
    for (size_t i = 0; i < n; i++) a[i] /= sqrt(aa), b[i] /= sqrt(bb);
}

// For the block of `size` modes from `first` on: (Wᵀ U)⁻¹ Wᵀ, and the motion in it,
// (E − (L (I − γ(J − S))⁻¹ U)⁻¹)/γ. Left and right modes of different blocks are orthogonal.
static bool set_block(work *w, int first, int size, bough_aeroelastic *to) {
    size_t n = (size_t)w->n, k = (size_t)to->n_motion, at = (size_t)first;
    double *right = w->right + at * n, *left = w->left + at * n, small[4], row[2], image[4];
    int pivot[2];
    if (size == 2) separate(n, right), separate(n, left);
    bough_dense_product((bough_product){size, size, w->n, true, 1, 0}, left, right, small);
    if (!bough_dense_factor(size, small, pivot)) return false;
    for (size_t i = 0; i < n; i++) {
        for (int c = 0; c < size; c++) row[c] = left[(size_t)c * n + i];
        bough_dense_solve(size, 1, small, pivot, row);
        for (int c = 0; c < size; c++) to->left[i * k + at + (size_t)c] = row[c];
    }
    memcpy(w->mode, right, (size_t)size * n * sizeof *right);
    w->k = size;
    apply(w, w->mode, w->mode_image);
    bough_dense_product((bough_product){size, size, w->n, true, 1, 0}, left, w->mode_image, image);
    bough_dense_solve(size, size, small, pivot, image);
    if (!bough_dense_factor(size, image, pivot)) return false;
    for (int j = 0; j < size; j++) {
        row[0] = row[1] = 0;
        row[j] = 1;
        bough_dense_solve(size, 1, image, pivot, row);
        for (int i = 0; i < size; i++) {
            to->motion[(at + (size_t)j) * k + at + (size_t)i] = w->def->point * ((i == j) - row[i]);
        }
    }
    return true;
}

// Modes on both sides, and the motion in them.
static bool set_motion(bough_arena *arena, work *w, bough_aeroelastic *to) {
    ritz right, left;
    take_ritz(arena, w->k, &right);
    take_ritz(arena, w->k, &left);
    int *size = bough_arena_take(arena, (size_t)w->k * sizeof *size);
    apply(w, w->right, w->image);
    if (!find_ritz(w, w->right, &right)) return false;
    memcpy(w->mode, w->left, (size_t)w->n * (size_t)w->k * sizeof(double));
    apply_transposed(w, w->mode, w->image);
    if (!find_ritz(w, w->left, &left)) return false;
    to->n_motion = keep(w, &right, &left, to->n_motion, size);
    for (int i = 0; i < to->n_motion; i += size[i]) {
        if (!set_block(w, i, size[i], to)) return false;
    }
    memcpy(to->shape, w->right, (size_t)w->n * (size_t)to->n_motion * sizeof(double));
    return to->n_motion > 0;
}

static void add_block(const double *block, int rows, int columns, int first_row, int first_column,
                      bough_aeroelastic *to) {
    for (int j = 0; j < columns; j++) {
        double *column = to->rate + (size_t)(first_column + j) * (size_t)to->n_all + first_row;
        for (int i = 0; i < rows; i++) column[i] += block[(size_t)j * (size_t)rows + (size_t)i];
    }
}

// The air's own rates turn with the blades.
static void turn_air(bough_arena *arena, const work *w, const bough_simulation *s,
                     const bough_blade_group *group, int per_blade, bough_aeroelastic *to) {
    const bough_modes_def *def = w->def;
    if (def->spin == 0 || per_blade == 0) return;
    int n = def->n_part, *row = bough_arena_take(arena, (size_t)(n * per_blade) * sizeof *row);
    double *rate = bough_arena_doubles(arena, (size_t)n * (size_t)n);
    bough_modes_rate(def, rate);
    bough_air_tangent_rows(s, group, per_blade, row);
    for (int k = 0; k < n; k++) {
        for (int l = 0; l < n; l++) {
            for (int j = 0; j < per_blade; j++) {
                size_t column = (size_t)(to->n_motion + row[l * per_blade + j]);
                size_t at = (size_t)(to->n_motion + row[k * per_blade + j]);
                to->rate[column * (size_t)to->n_all + at] -= rate[k * n + l];
            }
        }
    }
}

// The static response of the modes left out to forces (n × columns), γ (I − γ(J − S))⁻¹ (E − U L); the forces
// lose their part in the modes kept. `share` (n_motion × columns) is work.
static void follow(work *w, const bough_aeroelastic *to, int columns, double *force, double *share,
                   double *moved) {
    int n = w->n, k = to->n_motion;
    bough_dense_product((bough_product){k, columns, n, false, 1, 0}, to->left, force, share);
    bough_dense_product((bough_product){n, columns, k, false, -1, 1}, to->shape, share, force);
    w->k = columns;
    apply(w, force, moved);
    for (size_t i = 0; i < (size_t)n * (size_t)columns; i++) moved[i] /= w->def->point;
}

// The air's forces by that response of theirs, `moved` (n × columns), on the motion and on the air's states.
static void add_followed(const bough_air_tangent *t, int columns, const double *moved, int first_column,
                         double *image, double *block, bough_aeroelastic *to) {
    int n = to->n, k = to->n_motion, m = t->n_air;
    bough_dense_product((bough_product){n, columns, n, false, 1, 0}, t->motion, moved, image);
    bough_dense_product((bough_product){k, columns, n, false, 1, 0}, to->left, image, block);
    add_block(block, k, columns, 0, first_column, to);
    bough_dense_product((bough_product){m, columns, n, false, 1, 0}, t->drive, moved, block);
    add_block(block, m, columns, k, first_column, to);
}

static void add_response(bough_arena *arena, work *w, const bough_air_tangent *t, bough_aeroelastic *to) {
    int n = w->n, k = to->n_motion, m = t->n_air;
    size_t most = (size_t)(k > m ? k : m);
    double *force, *moved;
    bough_arena_each(arena, (size_t)n * most, &force, &moved);
    double *block = bough_arena_doubles(arena, most * most);
    bough_dense_product((bough_product){n, k, n, false, 1, 0}, t->motion, to->shape, force);
    follow(w, to, k, force, block, moved);
    add_followed(t, k, moved, 0, force, block, to);
    if (m == 0) return;
    memcpy(force, t->lift, (size_t)n * (size_t)m * sizeof *force);
    follow(w, to, m, force, block, moved);
    add_followed(t, m, moved, k, force, block, to);
}

static void add_air(bough_arena *arena, work *w, const bough_simulation *s, const bough_blade_group *group,
                    const bough_air_tangent *t, bough_aeroelastic *to) {
    int n = w->n, k = to->n_motion, m = t->n_air;
    size_t most = (size_t)(k > m ? k : m);
    double *block = bough_arena_doubles(arena, most * most + (size_t)k * (size_t)k);
    add_block(to->motion, k, k, 0, 0, to);
    bough_dense_product((bough_product){n, k, n, false, 1, 0}, t->motion, to->shape, w->image);
    bough_dense_product((bough_product){k, k, n, false, 1, 0}, to->left, w->image, block);
    add_block(block, k, k, 0, 0, to);
    bough_dense_product((bough_product){k, m, n, false, 1, 0}, to->left, t->lift, block);
    add_block(block, k, m, 0, k, to);
    bough_dense_product((bough_product){m, k, n, false, 1, 0}, t->drive, to->shape, block);
    add_block(block, m, k, k, 0, to);
    add_block(t->lag, m, m, k, k, to);
    add_response(arena, w, t, to);
    turn_air(arena, w, s, group, t->n_per_blade, to);
}

bough_status bough_aeroelastic_reduce(bough_arena *arena, const bough_simulation *s, bough_whole *coupled,
                                      const bough_modes_def *def, const bough_blade_group *group,
                                      const bough_air_tangent *tangent, int n_motion,
                                      bough_aeroelastic *reduced) {
    int n = coupled->assembly->n_state, kept = n_motion < n ? n_motion : n;
    work w = {.coupled = coupled, .def = def, .n = n, .k = 2 * kept < n ? 2 * kept : n};
    size_t all = (size_t)(kept + tangent->n_air);
    *reduced = (bough_aeroelastic){.n = n,
                                   .n_motion = kept,
                                   .n_air = tangent->n_air,
                                   .shape = bough_arena_doubles(arena, (size_t)n * (size_t)kept),
                                   .left = bough_arena_doubles(arena, (size_t)n * (size_t)kept),
                                   .motion = bough_arena_doubles(arena, (size_t)kept * (size_t)kept),
                                   .rate = bough_arena_doubles(arena, all * all)};
    take(arena, &w);
    bough_status status = bough_whole_setup(coupled, def->time, def->state, def->input, 1 / def->point);
    if (!bough_is_ok(&status)) return bough_fail(BOUGH_FAILED, "%s", status.message);
    invert(&w);
    bool done = turn(&w, s->tree->n_q);
    if (done) find_subspaces(&w);
    if (!done || !set_motion(arena, &w, reduced)) {
        return bough_fail(BOUGH_FAILED, "the motion in the air cannot be reduced to %d states", kept);
    }
    reduced->n_all = reduced->n_motion + reduced->n_air;
    add_air(arena, &w, s, group, tangent, reduced);
    return bough_ok();
}

// -- its modes ------------------------------------------------------------------------------------

static int slower(const void *a, const void *b) {
    const bough_eigen_pair *x = a, *y = b;
    double first = hypot(x->real, x->imaginary), second = hypot(y->real, y->imaginary);
    return (first > second) - (first < second);
}

// Participation of the motion in mode j (and j + 1 of a pair), Σ |left × right| over its states relative to
// that over all, which is independent of units; `inverse`: of the matrix of eigenvectors.
static double motion_share(const bough_aeroelastic *r, const double *vector, const double *inverse, size_t j,
                           bool pair) {
    size_t m = (size_t)r->n_all;
    double motion = 0, all = 0;
    for (size_t i = 0; i < m; i++) {
        double re = vector[j * m + i], im = pair ? vector[(j + 1) * m + i] : 0;
        double left = inverse[i * m + j], other = pair ? inverse[i * m + j + 1] : 0;
        double part = hypot(re, im) * hypot(left, other);
        all += part;
        if (i < (size_t)r->n_motion) motion += part;
    }
    return all > 0 ? motion / all : 0;
}

static void invert_vectors(bough_arena *arena, size_t m, const double *vector, double *inverse) {
    double *factor = bough_arena_doubles(arena, m * m);
    int *pivot = bough_arena_take(arena, (m + 1) * sizeof *pivot);
    memcpy(factor, vector, m * m * sizeof *factor);
    for (size_t i = 0; i < m; i++) inverse[i * m + i] = 1;
    if (bough_dense_factor((int)m, factor, pivot)) {
        bough_dense_solve((int)m, (int)m, factor, pivot, inverse);
    }
}

bough_status bough_aeroelastic_modes(bough_arena *arena, const bough_aeroelastic *reduced,
                                     bough_eigen_pair *pair, int *found) {
    size_t m = (size_t)reduced->n_all, n = (size_t)reduced->n;
    int k = reduced->n_motion;
    double *a = bough_arena_doubles(arena, m * m), *vector = bough_arena_doubles(arena, m * m);
    double *value = bough_arena_doubles(arena, 2 * m), *room = bough_arena_doubles(arena, 8 * m);
    double *inverse = bough_arena_doubles(arena, m * m);
    *found = 0;
    memcpy(a, reduced->rate, m * m * sizeof *a);
    if (!bough_dense_eigen((int)m, a, value, vector, room)) {
        return bough_fail(BOUGH_FAILED, "the eigenvalues of the motion in the air do not converge");
    }
    invert_vectors(arena, m, vector, inverse);
    for (size_t j = 0; j < m; j++) {
        bool oscillates = value[m + j] > 0;
        if (!oscillates && (value[m + j] < 0 || value[j] <= 0)) continue;
        if (motion_share(reduced, vector, inverse, j, oscillates) < least_motion) continue;
        bough_eigen_pair *p = &pair[*found];
        *p = (bough_eigen_pair){value[j], value[m + j], bough_arena_doubles(arena, n),
                                bough_arena_doubles(arena, n)};
        bough_product shape = {(int)n, 1, k, false, 1, 0};
        bough_dense_product(shape, reduced->shape, vector + j * m, p->shape_real);
        if (oscillates) {
            bough_dense_product(shape, reduced->shape, vector + (j + 1) * m, p->shape_imag);
        }
        ++*found;
    }
    qsort(pair, (size_t)*found, sizeof *pair, slower);
    return bough_ok();
}

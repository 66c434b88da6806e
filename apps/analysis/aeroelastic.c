#include "apps/analysis/aeroelastic.h"

#include "core/linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SWEEPS = 12 }; // of the simultaneous iteration, on twice as many vectors as are kept

// Of a mode's participation; below it is one of the air, in which the bodies hardly take part.
static const double least_motion = 0.2;

typedef struct work {
    bough_coupled *coupled;
    const bough_modes_def *def;
    int n, k;
    double *inverse;       // P = (I − γJ)⁻¹ (n × n)
    double *turned;        // I + γ P S, factored (n × n)
    int *pivot;            // (n)
    double *right, *left;  // bases (n × k)
    double *image, *small; // (n × k), (k × k)
} work;

static bool take(bough_arena *arena, work *w) {
    size_t n = (size_t)w->n, k = (size_t)w->k;
    w->inverse = bough_arena_doubles(arena, n * n);
    w->turned = bough_arena_doubles(arena, n * n);
    w->pivot = bough_arena_take(arena, (n + k) * sizeof *w->pivot);
    w->right = bough_arena_doubles(arena, n * k);
    w->left = bough_arena_doubles(arena, n * k);
    w->image = bough_arena_doubles(arena, n * k);
    w->small = bough_arena_doubles(arena, k * k);
    return !bough_arena_exhausted(arena);
}

// -- the inverse ----------------------------------------------------------------------------------

static void invert(work *w) {
    size_t n = (size_t)w->n;
    for (size_t j = 0; j < n; j++) {
        double *column = w->inverse + j * n;
        memset(column, 0, n * sizeof *column);
        column[j] = 1;
        bough_coupled_solve(w->coupled, column);
        bough_modes_project(w->coupled, w->def->state, column);
    }
}

// I + γ P S
static bool turn(work *w) {
    const bough_modes_def *def = w->def;
    size_t n = (size_t)w->n;
    int parts = def->n_part;
    double *rate = w->image; // (parts × parts)
    memset(w->turned, 0, n * n * sizeof *w->turned);
    for (size_t j = 0; j < n; j++) w->turned[j * n + j] = 1;
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

// The same numbers in every run.
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
} ritz;

static bool take_ritz(bough_arena *arena, int k, ritz *r) {
    size_t n = (size_t)k;
    r->matrix = bough_arena_doubles(arena, n * n);
    r->value = bough_arena_doubles(arena, 2 * n);
    r->vector = bough_arena_doubles(arena, n * n);
    r->room = bough_arena_doubles(arena, 8 * n);
    r->order = bough_arena_take(arena, n * sizeof *r->order);
    return !bough_arena_exhausted(arena);
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

// (Wᵀ U)⁻¹ Wᵀ into w->image, as (k × n), and of the inverse the matrix that it has in the basis.
static bool project(work *w, ritz *r) {
    int n = w->n, k = w->k;
    apply(w, w->right, w->image);
    bough_dense_product((bough_product){k, k, n, true, 1, 0}, w->left, w->right, w->small);
    bough_dense_product((bough_product){k, k, n, true, 1, 0}, w->left, w->image, r->matrix);
    if (!bough_dense_factor(k, w->small, w->pivot)) return false;
    bough_dense_solve(k, k, w->small, w->pivot, r->matrix);
    for (int i = 0; i < k; i++) {
        for (int j = 0; j < n; j++) {
            w->image[(size_t)j * (size_t)k + (size_t)i] = w->left[(size_t)i * (size_t)n + (size_t)j];
        }
    }
    bough_dense_solve(k, n, w->small, w->pivot, w->image);
    return bough_dense_eigen(k, r->matrix, r->value, r->vector, r->room);
}

// u of the modes with the largest eigenvalues μ of the inverse, so that left · shape is the unit matrix,
// and their rates (1 − 1/μ)/γ; of a pair in its real and imaginary part.
static bool set_motion(bough_arena *arena, work *w, bough_aeroelastic *to) {
    ritz r;
    int n = w->n, k = w->k, kept = to->n_motion;
    if (!take_ritz(arena, k, &r) || !project(w, &r)) return false;
    sort_ritz(k, &r);
    const double *imaginary = r.value + k;
    if (kept < k && imaginary[r.order[kept - 1]] > 0) to->n_motion = --kept; // its conjugate is next
    for (int i = 0; i < k; i++) {
        memcpy(w->small + (size_t)i * (size_t)k, r.vector + (size_t)r.order[i] * (size_t)k,
               (size_t)k * sizeof(double));
    }
    bough_dense_product((bough_product){n, kept, k, false, 1, 0}, w->right, w->small, to->shape);
    if (!bough_dense_factor(k, w->small, w->pivot)) return false;
    bough_dense_solve(k, n, w->small, w->pivot, w->image);
    for (int j = 0; j < n; j++) {
        memcpy(to->left + (size_t)j * (size_t)kept, w->image + (size_t)j * (size_t)k,
               (size_t)kept * sizeof(double));
    }
    for (int i = 0; i < kept; i++) {
        int at = r.order[i];
        double re = r.value[at], im = imaginary[at], size = re * re + im * im;
        double *column = to->motion + (size_t)i * (size_t)kept;
        column[i] = w->def->point * (1 - re / size);
        if (im > 0) column[i + 1] = -w->def->point * im / size;
        if (im < 0) column[i - 1] = -w->def->point * im / size;
    }
    return true;
}

static void add_block(const double *block, int rows, int columns, int first_row, int first_column,
                      bough_aeroelastic *to) {
    for (int j = 0; j < columns; j++) {
        double *column = to->rate + (size_t)(first_column + j) * (size_t)to->n_all + first_row;
        for (int i = 0; i < rows; i++) column[i] += block[(size_t)j * (size_t)rows + (size_t)i];
    }
}

// The air's own rates turn with the blades.
static bool turn_air(bough_arena *arena, const work *w, const bough_simulation *s,
                     const bough_blade_group *group, int per_blade, bough_aeroelastic *to) {
    const bough_modes_def *def = w->def;
    if (def->spin == 0 || per_blade == 0) return true;
    int n = def->n_part, *row = bough_arena_take(arena, (size_t)(n * per_blade) * sizeof *row);
    double *rate = bough_arena_doubles(arena, (size_t)n * (size_t)n);
    if (!row || !rate) return false;
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
    return true;
}

static bool add_air(bough_arena *arena, const work *w, const bough_simulation *s,
                    const bough_blade_group *group, const bough_air_tangent *t,
                    bough_aeroelastic *to) {
    int n = w->n, k = to->n_motion, m = t->n_air;
    size_t most = (size_t)(k > m ? k : m);
    double *block = bough_arena_doubles(arena, most * most + (size_t)k * (size_t)k);
    if (!block) return false;
    add_block(to->motion, k, k, 0, 0, to);
    bough_dense_product((bough_product){n, k, n, false, 1, 0}, t->motion, to->shape, w->image);
    bough_dense_product((bough_product){k, k, n, false, 1, 0}, to->left, w->image, block);
    add_block(block, k, k, 0, 0, to);
    bough_dense_product((bough_product){k, m, n, false, 1, 0}, to->left, t->lift, block);
    add_block(block, k, m, 0, k, to);
    bough_dense_product((bough_product){m, k, n, false, 1, 0}, t->drive, to->shape, block);
    add_block(block, m, k, k, 0, to);
    add_block(t->lag, m, m, k, k, to);
    return turn_air(arena, w, s, group, t->n_per_blade, to);
}

bough_status bough_aeroelastic_reduce(bough_arena *arena, const bough_simulation *s,
                                      bough_coupled *coupled, const bough_modes_def *def,
                                      const bough_blade_group *group,
                                      const bough_air_tangent *tangent, int n_motion,
                                      bough_aeroelastic *reduced) {
    int n = coupled->assembly->n_state, kept = n_motion < n ? n_motion : n;
    work w = {.coupled = coupled, .def = def, .n = n, .k = 2 * kept < n ? 2 * kept : n};
    size_t all = (size_t)(kept + tangent->n_air);
    *reduced = (bough_aeroelastic){
        .n = n,
        .n_motion = kept,
        .n_air = tangent->n_air,
        .shape = bough_arena_doubles(arena, (size_t)n * (size_t)kept),
        .left = bough_arena_doubles(arena, (size_t)n * (size_t)kept),
        .motion = bough_arena_doubles(arena, (size_t)kept * (size_t)kept),
        .rate = bough_arena_doubles(arena, all * all)};
    if (!take(arena, &w) || bough_arena_exhausted(arena)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    }
    bough_status status =
        bough_coupled_setup(coupled, def->time, def->state, def->input, 1 / def->point);
    if (!bough_is_ok(&status)) return bough_fail(BOUGH_FAILED, "%s", status.message);
    invert(&w);
    bool done = turn(&w);
    if (done) find_subspaces(&w);
    if (!done || !set_motion(arena, &w, reduced)) {
        return bough_fail(BOUGH_FAILED, "the motion in the air cannot be reduced to %d states",
                          kept);
    }
    reduced->n_all = reduced->n_motion + reduced->n_air;
    return add_air(arena, &w, s, group, tangent, reduced)
               ? bough_ok()
               : bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
}

// -- its modes ------------------------------------------------------------------------------------

static int slower(const void *a, const void *b) {
    const bough_eigen_pair *x = a, *y = b;
    double first = hypot(x->real, x->imaginary), second = hypot(y->real, y->imaginary);
    return (first > second) - (first < second);
}

// Of mode j (and j + 1 of a pair) the motion's share of the participation |left × right|, whatever the
// units of the states; `inverse` of the eigenvectors' matrix.
static double motion_share(const bough_aeroelastic *r, const double *vector, const double *inverse,
                           size_t j, bool pair) {
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

static bool invert_vectors(bough_arena *arena, size_t m, const double *vector, double *inverse) {
    double *factor = bough_arena_doubles(arena, m * m);
    int *pivot = bough_arena_take(arena, (m + 1) * sizeof *pivot);
    if (!factor || !pivot) return false;
    memcpy(factor, vector, m * m * sizeof *factor);
    for (size_t i = 0; i < m; i++) inverse[i * m + i] = 1;
    if (bough_dense_factor((int)m, factor, pivot)) {
        bough_dense_solve((int)m, (int)m, factor, pivot, inverse);
    }
    return true;
}

bough_status bough_aeroelastic_modes(bough_arena *arena, const bough_aeroelastic *reduced,
                                     bough_eigen_pair *pair, int *found) {
    size_t m = (size_t)reduced->n_all, n = (size_t)reduced->n;
    int k = reduced->n_motion;
    double *a = bough_arena_doubles(arena, m * m), *vector = bough_arena_doubles(arena, m * m);
    double *value = bough_arena_doubles(arena, 2 * m), *room = bough_arena_doubles(arena, 8 * m);
    double *inverse = bough_arena_doubles(arena, m * m);
    *found = 0;
    if (bough_arena_exhausted(arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    memcpy(a, reduced->rate, m * m * sizeof *a);
    if (!bough_dense_eigen((int)m, a, value, vector, room)) {
        return bough_fail(BOUGH_FAILED, "the eigenvalues of the motion in the air do not converge");
    }
    if (!invert_vectors(arena, m, vector, inverse)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    }
    for (size_t j = 0; j < m; j++) {
        bool oscillates = value[m + j] > 0;
        if (!oscillates && (value[m + j] < 0 || value[j] <= 0)) continue;
        if (motion_share(reduced, vector, inverse, j, oscillates) < least_motion) continue;
        bough_eigen_pair *p = &pair[*found];
        *p = (bough_eigen_pair){value[j], value[m + j], bough_arena_doubles(arena, n),
                                bough_arena_doubles(arena, n)};
        if (!p->shape_real || !p->shape_imag) {
            return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
        }
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

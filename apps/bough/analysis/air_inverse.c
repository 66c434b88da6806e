// theory (77). The matrix is dense where the air couples states, the members' own part of its inverse is not:
// a solution is one by the members' factors, then one by the dense factors of what the air and the rotation
// add. Where left vectors and forces of the air are solutions, too, the inverse is one matrix.
#include "apps/bough/analysis/air_inverse.h"

#include "apps/bough/analysis/rotor_inverse.h"
#include "core/base/linalg.h"

#include <string.h>

enum { CHUNK = 64 }; // columns of a product

// A joint that nothing holds moves on at its speed: the eigenvalue 0 twice, with one vector. Joints'
// coordinates that go back this slowly, against the point, have two.
static const double going_back = 1e-6;

struct bough_air_inverse {
    const bough_aeroelastic *system;
    int n;
    bough_rotor_inverse *rotor; // NULL: dense, as follows
    bool is_matrix;             // `inverse` is the whole inverse
    double *inverse;            // P = (I − γJ)⁻¹ (n × n), column-major as all; then T⁻¹ P
    double *factor;             // T (n × n), factored
    int *pivot;                 // (n)
    double *rate;               // S (n_part × n_part), row-major
};

static void take(bough_arena *arena, bough_air_inverse *w) {
    size_t n = (size_t)w->n, parts = (size_t)w->system->def->n_part;
    w->pivot = bough_arena_take(arena, n * sizeof *w->pivot);
    bough_arena_each(arena, n * n, &w->inverse, &w->factor);
    w->rate = bough_arena_doubles(arena, parts * parts + 1);
}

static void solve_members(const bough_air_inverse *w, double *x) {
    bough_whole_solve(w->system->whole, x);
    bough_whole_project(w->system->whole, w->system->def->state, x);
}

static void invert_members(bough_air_inverse *w) {
    size_t n = (size_t)w->n;
    for (size_t j = 0; j < n; j++) {
        w->inverse[j * n + j] = 1;
        solve_members(w, w->inverse + j * n);
    }
}

// Column `to` += factor P e_from
static void add_column(bough_air_inverse *w, size_t to, size_t from, double factor) {
    const double *restrict column = w->inverse + from * (size_t)w->n;
    double *restrict sum = w->factor + to * (size_t)w->n;
    for (int i = 0; i < w->n; i++) sum[i] += factor * column[i];
}

// γ P S of the members
static void add_spin(bough_air_inverse *w) {
    const bough_modes_def *def = w->system->def;
    for (int k = 0; k < def->n_part; k++) {
        for (int l = 0; l < def->n_part; l++) {
            double factor = w->rate[k * def->n_part + l] / def->point;
            for (int j = 0; j < def->n_row && factor != 0; j++)
                add_column(w, (size_t)def->row[l * def->n_row + j], (size_t)def->row[k * def->n_row + j],
                           factor);
        }
    }
}

// −= γ P A, some columns at a time: the rows of these that are not 0, and the columns of P for them.
static void subtract_forces(bough_arena *arena, bough_air_inverse *w, const double *a) {
    size_t n = (size_t)w->n;
    int *row = bough_arena_take(arena, n * sizeof *row);
    double *inverse = bough_arena_doubles(arena, n * n), *force = bough_arena_doubles(arena, n * CHUNK),
           *product = bough_arena_doubles(arena, n * CHUNK);
    for (int begin = 0; begin < w->n; begin += CHUNK) {
        int width = w->n - begin < CHUNK ? w->n - begin : CHUNK, rows = 0;
        const double *column = a + (size_t)begin * n;
        for (size_t i = 0; i < n; i++) {
            bool used = false;
            for (size_t j = 0; j < (size_t)width && !used; j++) used = column[j * n + i] != 0;
            if (used) row[rows++] = (int)i;
        }
        for (size_t k = 0; k < (size_t)rows; k++) {
            memcpy(inverse + k * n, w->inverse + (size_t)row[k] * n, n * sizeof *inverse);
            for (size_t j = 0; j < (size_t)width; j++)
                force[j * (size_t)rows + k] = column[j * n + (size_t)row[k]];
        }
        bough_product p = {w->n, width, rows, false, -1 / w->system->def->point, 0};
        bough_dense_product(p, inverse, force, product);
        double *to = w->factor + (size_t)begin * n;
        for (size_t i = 0; i < n * (size_t)width; i++) to[i] += product[i];
    }
}

static bool factor(bough_arena *arena, bough_air_inverse *w) {
    const bough_aeroelastic *x = w->system;
    size_t n = (size_t)w->n;
    invert_members(w);
    for (size_t j = 0; j < n; j++) w->factor[j * n + j] = 1;
    for (size_t j = 0; j < (size_t)x->simulation->tree->n_q; j++) add_column(w, j, j, going_back);
    if (x->def->spin != 0) {
        bough_modes_rate(x->def, w->rate);
        add_spin(w);
    }
    subtract_forces(arena, w, x->air->motion);
    return bough_dense_factor(w->n, w->factor, w->pivot);
}

bough_air_inverse *bough_air_inverse_create(bough_arena *arena, const bough_aeroelastic *system,
                                            bool transposed) {
    bough_air_inverse *w = bough_arena_take(arena, sizeof *w);
    *w = (bough_air_inverse){.system = system, .n = system->air->n};
    w->rotor = bough_rotor_inverse_create(arena, system, going_back);
    if (w->rotor) return w;
    take(arena, w);
    if (!factor(arena, w)) return NULL;
    w->is_matrix = transposed;
    if (transposed) bough_dense_solve(w->n, w->n, w->factor, w->pivot, w->inverse);
    return w;
}

// T⁻¹ P z by the factors.
static void solve(const bough_air_inverse *w, int n, const double *z, double *image) {
    size_t length = (size_t)w->n;
    memcpy(image, z, length * (size_t)n * sizeof *image);
    for (size_t k = 0; k < (size_t)n; k++) solve_members(w, image + k * length);
    bough_dense_solve(w->n, n, w->factor, w->pivot, image);
}

void bough_air_inverse_apply(bough_air_inverse *w, bool transposed, int n, const double *z, double *image) {
    if (w->rotor)
        bough_rotor_inverse_apply(w->rotor, transposed, n, z, image);
    else if (w->is_matrix)
        bough_dense_product((bough_product){w->n, n, w->n, transposed, 1, 0}, w->inverse, z, image);
    else
        solve(w, n, z, image);
}

// theory (117).
#include "apps/bough/analysis/aeroelastic.h"
#include "apps/bough/analysis/air_inverse.h"
#include "core/base/linalg.h"

#include <float.h>

static const double most = 0.5; // part of an eigenvector in a mode: it is that mode

typedef struct work {
    const bough_known_modes *known;
    const bough_aeroelastic *system;
    bough_air_inverse *inverse;
    double gamma;
    int n, m;     // states on the other mesh of the members, of the air
    int q;        // columns: real and imaginary parts of the modes
    int *first;   // (known->n + 1) first column of each mode; those without a left vector have none
    double *rate; // S (n_part × n_part)
} work;

// Right or left vectors as columns. `members`: first those after one step of inverse iteration, then their
// change by a second one; each of length 1.
typedef struct side {
    double *known;   // (n × q)
    double *members; // (n × 2 q)
    double *rate;    // (n × 2 q) right: rates of the members with these
    double *air;     // (m × 2 q) as known, then 0: a step leaves it as it is
} side;

// -- vectors on the other mesh --------------------------------------------------------------------

// States of a rod are linear between its moving vertices, and beyond the first and the last of them; those of
// a left vector are proportional to each vertex's mass.
static void carry_rod(const bough_rod_model *from, const bough_rod_model *to, bool left, const double *x,
                      double *y) {
    for (int i = 0; i < to->n; i++) {
        int k = 1;
        while (k + 1 < from->n && from->span[k + 1] < to->span[i + 1]) k++;
        int next = k < from->n ? k + 1 : k;
        double gap = from->span[next] - from->span[k];
        double b = gap > 0 ? (to->span[i + 1] - from->span[k]) / gap : 0, a = 1 - b;
        double mass = to->vertex[i + 1].mass;
        if (left && mass > 0) {
            a *= mass / fmax(from->vertex[k].mass, DBL_MIN);
            b *= mass / fmax(from->vertex[next].mass, DBL_MIN);
        }
        for (int c = 0; c < BOUGH_ROD_STATES; c++)
            y[c * to->n + i] = a * x[c * from->n + k - 1] + b * x[c * from->n + next - 1];
    }
}

static void carry(const work *w, bool left, const double *x, double *y) {
    const bough_simulation *s = w->known->simulation, *other = w->system->simulation;
    const bough_assembly *a = s->assembly, *b = other->assembly;
    for (int i = 0; i < a->n_member; i++) {
        if (b->member[i]->system.n_state == a->member[i]->system.n_state)
            memcpy(y + b->state_offset[i], x + a->state_offset[i],
                   (size_t)a->member[i]->system.n_state * sizeof *y);
    }
    for (int k = 0; k < s->n_beam; k++) {
        int i = s->beam[k].port + 1;
        if (i > 0)
            carry_rod(s->beam[k].mesh, other->beam[k].mesh, left, x + a->state_offset[i],
                      y + b->state_offset[i]);
    }
}

static side take_side(bough_arena *arena, const work *w, bool left) {
    side x;
    size_t n = (size_t)w->n, m = (size_t)w->m, q = (size_t)w->q + 1;
    size_t length = (size_t)w->known->simulation->assembly->n_state;
    x.known = bough_arena_doubles(arena, n * q);
    bough_arena_each(arena, 2 * n * q, &x.members, &x.rate);
    x.air = bough_arena_doubles(arena, 2 * m * q + 1);
    for (int k = 0; k < w->known->n; k++) {
        const double *from = left ? w->known->vector[k].left : w->known->vector[k].right;
        for (int c = w->first[k]; c < w->first[k + 1]; c++, from += length + m) {
            carry(w, left, from, x.known + (size_t)c * n);
            memcpy(x.air + (size_t)c * m, from + length, m * sizeof *from);
        }
    }
    return x;
}

// -- a step of inverse iteration ------------------------------------------------------------------

// z (n × q) = (1 − γλ) x of each mode.
static void times_point(const work *w, const double *x, double *z) {
    size_t n = (size_t)w->n;
    for (int k = 0; k < w->known->n; k++) {
        size_t at = (size_t)w->first[k] * n, parts = (size_t)(w->first[k + 1] - w->first[k]);
        double real = 1 - w->gamma * w->known->pair[k].real, other = w->gamma * w->known->pair[k].imaginary;
        for (size_t i = at; i < at + parts * n; i++) {
            bool first = i < at + n;
            z[i] = real * x[i];
            if (parts == 2) z[i] += first ? other * x[i + n] : -other * x[i - n];
        }
    }
}

// The members' part of a step with the known eigenvalues and the air's part as it is, from x (n × q).
static void step(bough_arena *arena, const work *w, bool left, const double *x, const double *air,
                 double *image, double *rate) {
    const bough_air_tangent *t = w->system->air;
    size_t n = (size_t)w->n, size = n * (size_t)w->q;
    double *z = bough_arena_doubles(arena, size + 1), *force = bough_arena_doubles(arena, size + 1);
    times_point(w, x, z);
    memcpy(force, z, size * sizeof *force);
    bough_dense_product(
        (bough_product){w->n, w->q, w->m, left, .factor = w->gamma, .keep = 1, .rows_a = t->all},
        left ? bough_air_tangent_entry(t, n, 0) : bough_air_tangent_entry(t, 0, n), air, force);
    bough_air_inverse_apply(w->inverse, left, w->q, force, image);
    for (size_t i = 0; i < size; i++) rate[i] = (image[i] - z[i]) / w->gamma;
}

// Length 1 of each column, in units of the scales.
static void normalise(const work *w, const double *scale, bool left, side *x) {
    size_t n = (size_t)w->n, m = (size_t)w->m;
    for (size_t c = 0; c < 2 * (size_t)w->q; c++) {
        double sum = DBL_MIN, *own = x->members + c * n;
        for (size_t i = 0; i < n; i++) sum += pow(left ? own[i] * scale[i] : own[i] / scale[i], 2);
        for (size_t i = 0; i < n; i++) own[i] /= sqrt(sum), x->rate[c * n + i] /= sqrt(sum);
        for (size_t i = 0; i < m; i++) x->air[c * m + i] /= sqrt(sum);
    }
}

static side find_side(bough_arena *arena, const work *w, const double *scale, bool left) {
    side x = take_side(arena, w, left);
    size_t size = (size_t)w->n * (size_t)w->q;
    step(arena, w, left, x.known, x.air, x.members, x.rate);
    step(arena, w, left, x.members, x.air, x.members + size, x.rate + size);
    for (size_t i = 0; i < size; i++) x.members[size + i] -= x.members[i], x.rate[size + i] -= x.rate[i];
    normalise(w, scale, left, &x);
    return x;
}

// -- Galerkin -------------------------------------------------------------------------------------

// Rates of the air (m × 2 q).
static double *air_rates(bough_arena *arena, const work *w, const side *right) {
    const bough_air_tangent *t = w->system->air;
    int parts = w->system->def->n_part, n = t->n_per_blade;
    double *rate = bough_arena_doubles(arena, (size_t)w->m * 2 * (size_t)w->q + 1);
    bough_dense_product((bough_product){w->m, 2 * w->q, w->n, false, .factor = 1, .rows_a = t->all},
                        t->matrix + t->n, right->members, rate);
    bough_dense_product((bough_product){w->m, w->q, w->m, false, .factor = 1, .keep = 1, .rows_a = t->all},
                        bough_air_tangent_entry(t, (size_t)w->n, (size_t)w->n), right->air, rate);
    if (w->system->def->spin == 0) return rate;
    int *row = bough_arena_take(arena, (size_t)(parts * n + 1) * sizeof *row);
    for (int k = 0; k < parts * n; k++)
        row[k] = bough_air_tangent_blade(w->system->simulation, w->system->group, k / n) * n + k % n;
    for (size_t at = 0; at < (size_t)w->q * (size_t)w->m; at += (size_t)w->m)
        bough_modes_add_rate(w->system->def, w->rate, n, row, -1, right->air + at, rate + at);
    return rate;
}

// The system in these vectors.
typedef struct reduced {
    int q;                 // vectors
    double *length;        // Wᵀ V (q × q)
    double *matrix;        // (Wᵀ V)⁻¹ Wᵀ M V (q × q)
    double *value, *right; // (2 × q), (q × q): X of it
    double *image, *left;  // Wᵀ V X, X⁻¹ (q × q)
} reduced;

static bool reduce(bough_arena *arena, const work *w, const side *right, const side *left, reduced *x) {
    int q = x->q = 2 * w->q;
    size_t size = (size_t)q * (size_t)q + 1;
    x->value = bough_arena_doubles(arena, 2 * (size_t)q + 1);
    bough_arena_each(arena, size, &x->length, &x->matrix, &x->right, &x->image, &x->left);
    const double *rate = air_rates(arena, w, right);
    const bough_product members = {q, q, w->n, true, .factor = 1},
                        air = {q, q, w->m, true, .factor = 1, .keep = 1};
    bough_dense_product(members, left->members, right->rate, x->matrix);
    bough_dense_product(air, left->air, rate, x->matrix);
    bough_dense_product(members, left->members, right->members, x->length);
    bough_dense_product(air, left->air, right->air, x->length);
    for (int i = 0; i < q; i++) x->left[i * q + i] = 1;
    if (!bough_dense_divide(arena, q, q, x->length, x->matrix) ||
        !bough_dense_eigen(q, x->matrix, x->value, x->right,
                           bough_arena_doubles(arena, BOUGH_EIGEN_WORK((size_t)q) + 1)))
        return false;
    bough_dense_product((bough_product){q, q, q, false, .factor = 1}, x->length, x->right, x->image);
    return bough_dense_divide(arena, q, q, x->right, x->left);
}

// Σ of a block of a (q rows) with weights 1 and ±i along its rows, 1 and i along its columns.
static double complex block_sum(const double *a, int q, int rows, double sign, int columns) {
    const double complex unit = (double complex)I;
    double complex sum = 0;
    for (int j = 0; j < columns; j++)
        for (int i = 0; i < rows; i++) sum += a[j * q + i] * (i > 0 ? sign * unit : 1) * (j > 0 ? unit : 1);
    return sum;
}

// Part of eigenvector j in mode k: right vector of j times left vector of k, times left vector of j times
// right vector of k. The sum over all j is 1.
static double part_in(const work *w, const reduced *x, int j, int k) {
    int c = w->first[k], parts = w->first[k + 1] - c, q = x->q, own = x->value[q + j] > 0 ? 2 : 1;
    double complex length = block_sum(x->length + c * q + c, q, parts, 1, parts);
    double complex right = block_sum(x->image + j * q + c, q, parts, 1, own);
    double complex left = block_sum(x->left + c * q + j, q, own, -1, parts);
    return cabs(right * left / length) / own;
}

// For each mode the eigenvalue whose vector has most of the mode.
static void choose(const work *w, const reduced *x, double complex *there) {
    for (int k = 0; k < w->known->n; k++) {
        there[k] = (double)NAN;
        for (int j = 0; j < x->q && w->first[k + 1] > w->first[k]; j++) {
            if (x->value[x->q + j] < 0 || part_in(w, x, j, k) < most) continue;
            there[k] = x->value[j] + x->value[x->q + j] * (double complex)I;
        }
    }
}

static bough_status find(bough_arena *arena, work *w, double complex *there) {
    double *scale = bough_arena_doubles(arena, (size_t)w->n);
    reduced x = {0};
    w->rate = bough_modes_rate(arena, w->system->def);
    bough_assembly_scales(w->system->whole->assembly, scale);
    BOUGH_TRY(bough_air_inverse_create(arena, w->system, &w->inverse));
    const side right = find_side(arena, w, scale, false), left = find_side(arena, w, scale, true);
    if (!reduce(arena, w, &right, &left, &x))
        return bough_fail(BOUGH_FAILED, "they do not follow from those of the scene");
    choose(w, &x, there);
    return bough_ok();
}

bough_status bough_mesh_change_find(bough_arena *arena, const bough_known_modes *known,
                                    const bough_aeroelastic *system, double complex *there) {
    work w = {.known = known,
              .system = system,
              .gamma = 1 / system->def->point,
              .n = system->air->n,
              .m = system->air->n_air};
    w.first = bough_arena_take(arena, ((size_t)known->n + 1) * sizeof *w.first);
    for (int k = 0; k < known->n; k++) {
        int parts = known->vector[k].left == NULL ? 0 : 1 + (known->pair[k].imaginary > 0);
        w.q = w.first[k + 1] = w.first[k] + parts;
    }
    bough_arena *own = bough_arena_child(arena);
    bough_status status = find(own, &w, there);
    bough_arena_destroy(own);
    return status;
}

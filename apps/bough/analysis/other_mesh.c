// theory (114).
#include "apps/bough/analysis/aeroelastic.h"

#include "core/base/linalg.h"

#include <math.h>
#include <string.h>

// -- from one mesh to the other -------------------------------------------------------------------

// Where a vertex is among the moving ones of another mesh, which begin behind the root, at rest.
typedef struct between {
    int below;    // vertex, 0: the root
    double above; // share of the next one
} between;

static between find_between(const bough_rod_model *m, double span) {
    int i = 0;
    while (i + 1 < m->n && m->span[i + 1] < span) i++;
    double share = (span - m->span[i]) / (m->span[i + 1] - m->span[i]);
    return (between){i, fmin(share, 1)};
}

// A component of a shape from vertices to other ones, linear between them.
static void interpolate(const bough_rod_model *own, const bough_rod_model *other, const double *x,
                        double *to) {
    for (int i = 0; i < other->n; i++) {
        between at = find_between(own, other->span[i + 1]);
        to[i] = at.above * x[at.below] + (at.below > 0 ? (1 - at.above) * x[at.below - 1] : 0);
    }
}

// A component of a left vector: the adjoint of the interpolation from `other` to `own`.
static void restrict_to(const bough_rod_model *own, const bough_rod_model *other, const double *y,
                        double *to) {
    memset(to, 0, (size_t)other->n * sizeof *to);
    for (int i = 0; i < own->n; i++) {
        between at = find_between(other, own->span[i + 1]);
        to[at.below] += at.above * y[i];
        if (at.below > 0) to[at.below - 1] += (1 - at.above) * y[i];
    }
}

typedef void mesh_map(const bough_rod_model *own, const bough_rod_model *other, const double *x, double *to);

// The rod of a member; NULL: it is none.
static const bough_rod_model *rod_of(const bough_simulation *s, int member) {
    for (int k = 0; k < s->n_beam; k++)
        if (s->beam[k].rod != NULL && s->beam[k].port + 1 == member) return s->beam[k].mesh;
    return NULL;
}

static bool have_equal_members(const bough_simulation *own, const bough_simulation *other) {
    const bough_assembly *a = own->master->assembly, *b = other->master->assembly;
    if (a->n_member != b->n_member) return false;
    for (int i = 0; i < a->n_member; i++)
        if (rod_of(own, i) == NULL && a->member[i]->system.n_state != b->member[i]->system.n_state)
            return false;
    return true;
}

// A vector of all members.
static void map_members(const bough_simulation *own, const bough_simulation *other, mesh_map *map,
                        const double *x, double *to) {
    const bough_assembly *a = own->master->assembly, *b = other->master->assembly;
    for (int i = 0; i < a->n_member; i++) {
        const double *from = x + a->state_offset[i];
        double *part = to + b->state_offset[i];
        const bough_rod_model *here = rod_of(own, i), *there = rod_of(other, i);
        if (here == NULL) memcpy(part, from, (size_t)a->member[i]->system.n_state * sizeof *part);
        for (int c = 0; c < BOUGH_ROD_STATES && here != NULL; c++)
            map(here, there, from + c * here->n, part + c * there->n);
    }
}

// -- products -------------------------------------------------------------------------------------

// Columns of members (n) and of the air (n_air): a real mode's vector, or real and imaginary part.
typedef struct columns {
    double *members, *air;
} columns;

typedef struct work {
    const bough_aeroelastic *system;
    int n, n_air, count;  // states of the other mesh, of the air; columns
    double gamma;         // of P
    const double *growth; // (2 × count) of each column's mode: real and imaginary part
    const int *part;      // (count) 0: real or alone, 1: imaginary; −1: real, with an imaginary one
    double *rate;         // S (n_part × n_part)
    int *air_row;         // (n_part × n_per_blade)
    double *inverse;      // P (n × n)
} work;

static columns take_columns(bough_arena *arena, int n, int n_air, int count) {
    return (columns){bough_arena_doubles(arena, (size_t)n * (size_t)count + 1),
                     bough_arena_doubles(arena, (size_t)n_air * (size_t)count + 1)};
}

// to += factor S x, or its transpose −S, of rows of equal parts.
static void add_spin(const work *w, double factor, int n_row, const int *row, int length, const double *x,
                     double *to) {
    int parts = w->system->def->n_part;
    if (w->system->def->spin == 0) return;
    for (int c = 0; c < w->count; c++, x += length, to += length) {
        for (int k = 0; k < parts; k++) {
            for (int l = 0; l < parts; l++) {
                double rate = factor * w->rate[k * parts + l];
                for (int j = 0; j < n_row; j++) to[row[k * n_row + j]] += rate * x[row[l * n_row + j]];
            }
        }
    }
}

// to += a x, or aᵀ x: a (m × k), x of k (or m) rows.
static void add_product(const work *w, bool transposed, int rows, int by, const double *a, const double *x,
                        double *to) {
    if (by == 0) return;
    bough_dense_product((bough_product){rows, w->count, by, transposed, 1, 1}, a, x, to);
}

// (A − S) x + R m into `to`, or of the transpose with Gᵀ m.
static void find_forces(const work *w, bool transposed, const columns *x, double *to) {
    const bough_air_tangent *t = w->system->air;
    const bough_modes_def *def = w->system->def;
    memset(to, 0, (size_t)w->n * (size_t)w->count * sizeof *to);
    add_product(w, transposed, w->n, w->n, t->motion, x->members, to);
    add_product(w, transposed, w->n, w->n_air, transposed ? t->drive : t->lift, x->air, to);
    add_spin(w, transposed ? 1 : -1, def->n_row, def->row, w->n, x->members, to);
}

// (1 − γλ) x of each column's mode.
static void shift(const work *w, const double *x, double *to) {
    size_t n = (size_t)w->n;
    for (int c = 0; c < w->count; c++) {
        double real = 1 - w->gamma * w->growth[2 * c], turn = w->gamma * w->growth[2 * c + 1];
        const double *own = x + (size_t)c * n;
        double *out = to + (size_t)c * n;
        for (size_t i = 0; i < n; i++) out[i] = real * own[i];
        if (w->part[c] == 0) continue;
        const double *other = w->part[c] < 0 ? own + n : own - n;
        for (size_t i = 0; i < n; i++) out[i] -= w->part[c] * turn * other[i];
    }
}

// Vectors of one side and what the next step takes.
typedef struct vectors {
    bool left;
    columns x;
    double *force;  // (A − S) x + R m; of left vectors that of the transpose
    double *before; // x is P times it
} vectors;

// One step of inverse iteration with the members' own P: x ← P ((1 − γλ) x + γ (A − S) x + γ R m).
static void improve(const work *w, vectors *v) {
    size_t size = (size_t)w->n * (size_t)w->count;
    shift(w, v->x.members, v->before);
    for (size_t i = 0; i < size; i++) v->before[i] += w->gamma * v->force[i];
    bough_dense_product((bough_product){w->n, w->count, w->n, v->left, 1, 0}, w->inverse, v->before,
                        v->x.members);
    find_forces(w, v->left, &v->x, v->force);
}

// B x after a step: (x − before)/γ + (A − S) x + R m; G x + (H − S) m.
static void map_by_system(const work *w, const vectors *v, columns *y) {
    const bough_air_tangent *t = w->system->air;
    for (size_t i = 0; i < (size_t)w->n * (size_t)w->count; i++)
        y->members[i] = (v->x.members[i] - v->before[i]) / w->gamma + v->force[i];
    if (w->n_air == 0) return;
    memset(y->air, 0, (size_t)w->n_air * (size_t)w->count * sizeof *y->air);
    add_product(w, false, w->n_air, w->n, t->drive, v->x.members, y->air);
    add_product(w, false, w->n_air, w->n_air, t->lag, v->x.air, y->air);
    add_spin(w, -1, t->n_per_blade, w->air_row, w->n_air, v->x.air, y->air);
}

// (Yᵀ X)⁻¹ Yᵀ B X into `matrix` (count × count); false where singular.
static bool project(bough_arena *arena, int count, int n, int n_air, const columns *left,
                    const columns *right, const columns *image, double *matrix) {
    double *product = bough_arena_doubles(arena, (size_t)count * (size_t)count);
    int *pivot = bough_arena_take(arena, (size_t)count * sizeof *pivot);
    const bough_product of_members = {count, count, n, true, 1, 0},
                        of_air = {count, count, n_air, true, 1, 1};
    bough_dense_product(of_members, left->members, right->members, product);
    bough_dense_product(of_members, left->members, image->members, matrix);
    if (n_air > 0) bough_dense_product(of_air, left->air, right->air, product);
    if (n_air > 0) bough_dense_product(of_air, left->air, image->air, matrix);
    if (!bough_dense_factor(count, product, pivot)) return false;
    bough_dense_solve(count, count, product, pivot, matrix);
    return true;
}

// -- both meshes in the same modes ----------------------------------------------------------------

// The modes that have vectors on both sides, as columns.
typedef struct chosen {
    int n, count;
    int *mode, *first; // (n) of the basis; first column
    double *growth;    // (2 × count)
    int *part;         // (count)
} chosen;

static chosen choose(bough_arena *arena, const bough_mode_basis *modes) {
    size_t n = (size_t)modes->n + 1;
    chosen x = {0};
    x.mode = bough_arena_take(arena, n * sizeof *x.mode);
    x.first = bough_arena_take(arena, n * sizeof *x.first);
    x.part = bough_arena_take(arena, 2 * n * sizeof *x.part);
    x.growth = bough_arena_doubles(arena, 4 * n);
    for (int k = 0; k < modes->n; k++) {
        const bough_eigen_pair *pair = &modes->pair[k];
        if (modes->vector[k].left == NULL) continue;
        x.mode[x.n] = k;
        x.first[x.n++] = x.count;
        for (int part = 0; part < 1 + (pair->imaginary > 0); part++, x.count++) {
            x.growth[2 * x.count] = pair->real;
            x.growth[2 * x.count + 1] = pair->imaginary;
            x.part[x.count] = pair->imaginary > 0 ? 2 * part - 1 : 0;
        }
    }
    return x;
}

// += Λ: B [x_r x_i] = [x_r x_i] [a b; −b a]
static void add_own(const chosen *x, double *matrix) {
    size_t count = (size_t)x->count;
    for (size_t c = 0; c < count; c++) {
        matrix[c * count + c] += x->growth[2 * c];
        if (x->part[c] < 0) matrix[c * count + c + 1] -= x->growth[2 * c + 1];
        if (x->part[c] > 0) matrix[c * count + c - 1] += x->growth[2 * c + 1];
    }
}

typedef enum kind { RIGHT, LEFT, BEFORE } kind;

static columns collect(bough_arena *arena, const chosen *x, const bough_mode_basis *modes, int n, int n_air,
                       kind which) {
    columns to = take_columns(arena, n, n_air, x->count);
    size_t all = (size_t)(n + n_air);
    for (int k = 0; k < x->n; k++) {
        const bough_mode_vectors *v = &modes->vector[x->mode[k]];
        const double *from = which == RIGHT ? v->right : which == LEFT ? v->left : v->before;
        int parts = x->part[x->first[k]] == 0 ? 1 : 2;
        for (int part = 0; part < parts; part++, from += all) {
            size_t c = (size_t)(x->first[k] + part);
            memcpy(to.members + c * (size_t)n, from, (size_t)n * sizeof *from);
            memcpy(to.air + c * (size_t)n_air, from + n, (size_t)n_air * sizeof *from);
        }
    }
    return to;
}

// The same of the system on its own mesh, whose vectors are not quite invariant where the air has states.
static bool set_own_projection(bough_arena *arena, const chosen *x, const bough_mode_basis *modes, int n,
                               int n_air, const columns *left, const columns *right, double *matrix) {
    add_own(x, matrix);
    if (x->n == 0 || modes->vector[x->mode[0]].before == NULL) return true;
    columns image = collect(arena, x, modes, n, n_air, BEFORE);
    size_t count = (size_t)x->count;
    for (size_t i = 0; i < count * (size_t)n; i++)
        image.members[i] = modes->point * (right->members[i] - image.members[i]);
    for (size_t i = 0; i < count * (size_t)n_air; i++)
        image.air[i] = modes->point * (right->air[i] - image.air[i]);
    return project(arena, x->count, n, n_air, left, right, &image, matrix);
}

static vectors begin(bough_arena *arena, const work *w, const bough_simulation *own, bool left,
                     const columns *from) {
    vectors to = {.left = left, .x = take_columns(arena, w->n, 0, w->count)};
    size_t n = (size_t)own->master->assembly->n_state, size = (size_t)w->n * (size_t)w->count;
    bough_arena_each(arena, size + 1, &to.force, &to.before);
    to.x.air = from->air;
    for (int c = 0; c < w->count; c++)
        map_members(own, w->system->simulation, left ? restrict_to : interpolate,
                    from->members + (size_t)c * n, to.x.members + (size_t)c * (size_t)w->n);
    find_forces(w, left, &to.x, to.force);
    return to;
}

static void invert_members(bough_arena *arena, work *w) {
    size_t n = (size_t)w->n;
    w->inverse = bough_arena_doubles(arena, n * n);
    for (size_t j = 0; j < n; j++) {
        w->inverse[j * n + j] = 1;
        bough_whole_solve(w->system->whole, w->inverse + j * n);
        bough_whole_project(w->system->whole, w->system->def->state, w->inverse + j * n);
    }
}

// -- eigenvalues ----------------------------------------------------------------------------------

// How much of eigenvector j is mode k.
static double share(const chosen *x, const double *vector, const double *inverse, int j, int k) {
    size_t count = (size_t)x->count;
    double sum = 0;
    int parts = x->part[x->first[k]] == 0 ? 1 : 2;
    for (int part = 0; part < parts; part++) {
        size_t i = (size_t)(x->first[k] + part);
        sum += fabs(vector[(size_t)j * count + i] * inverse[i * count + (size_t)j]);
    }
    return sum;
}

// Every mode the eigenvalue of which it has the most, the clearest first.
static void assign(bough_arena *arena, const chosen *x, const double *eigenvalue, const double *vector,
                   const double *inverse, double (*value)[2]) {
    bool *taken = bough_arena_take(arena, (size_t)x->count * sizeof *taken);
    bool *done = bough_arena_take(arena, (size_t)x->n * sizeof *done);
    for (int pass = 0; pass < x->n; pass++) {
        double most = 0;
        int mode = -1, at = -1;
        for (int j = 0; j < x->count; j++) {
            if (taken[j] || eigenvalue[x->count + j] < 0) continue;
            for (int k = 0; k < x->n; k++) {
                double own = done[k] ? 0 : share(x, vector, inverse, j, k);
                if (own > most) most = own, mode = k, at = j;
            }
        }
        if (mode < 0) return;
        taken[at] = done[mode] = true;
        value[x->mode[mode]][0] = eigenvalue[at];
        value[x->mode[mode]][1] = eigenvalue[x->count + at];
    }
}

static bool find_values(bough_arena *arena, const chosen *x, double *matrix, double (*value)[2]) {
    size_t count = (size_t)x->count;
    double *vector, *inverse, *factor;
    bough_arena_each(arena, count * count, &vector, &inverse, &factor);
    double *eigenvalue = bough_arena_doubles(arena, 2 * count);
    int *pivot = bough_arena_take(arena, count * sizeof *pivot);
    if (!bough_dense_eigen(x->count, matrix, eigenvalue, vector,
                           bough_arena_doubles(arena, BOUGH_EIGEN_WORK(count))))
        return false;
    memcpy(factor, vector, count * count * sizeof *factor);
    for (size_t i = 0; i < count; i++) inverse[i * count + i] = 1;
    if (!bough_dense_factor(x->count, factor, pivot)) return false;
    bough_dense_solve(x->count, x->count, factor, pivot, inverse);
    assign(arena, x, eigenvalue, vector, inverse, value);
    return true;
}

// Whether a step has changed no eigenvalue that is wanted by more than a small part of what the mesh changes.
static bool has_converged(const bough_mode_basis *modes, double (*before)[2], double (*value)[2]) {
    static const double part = 0.1, least = 3e-5;
    for (int k = 0; k < modes->n; k++) {
        const bough_eigen_pair *own = &modes->pair[k];
        double step = hypot(value[k][0] - before[k][0], value[k][1] - before[k][1]);
        double moved = hypot(value[k][0] - own->real, value[k][1] - own->imaginary);
        bool good = step <= part * moved + least * hypot(own->real, own->imaginary);
        if (modes->wanted[k] && !good) return false;
    }
    return true;
}

// Eigenvalues of Λ + the other mesh's system less the own one's, both in the modes of the own one, after step
// upon step of both sides' vectors.
static bool iterate(bough_arena *arena, work *w, const bough_simulation *own, const chosen *x,
                    const bough_mode_basis *modes, double (*value)[2]) {
    enum { STEPS = 6 };
    int n = own->master->assembly->n_state;
    size_t size = (size_t)x->count * (size_t)x->count, bytes = (size_t)modes->n * sizeof *value;
    double *here, *there, (*before)[2] = bough_arena_take(arena, bytes);
    bough_arena_each(arena, size, &here, &there);
    columns own_right = collect(arena, x, modes, n, w->n_air, RIGHT);
    columns own_left = collect(arena, x, modes, n, w->n_air, LEFT);
    if (!set_own_projection(arena, x, modes, n, w->n_air, &own_left, &own_right, here)) return false;
    vectors right = begin(arena, w, own, false, &own_right), left = begin(arena, w, own, true, &own_left);
    columns image = take_columns(arena, w->n, w->n_air, w->count);
    invert_members(arena, w);
    for (int step = 0; step < STEPS; step++) {
        bough_arena *child = bough_arena_child(arena);
        improve(w, &right);
        improve(w, &left);
        map_by_system(w, &right, &image);
        bool good = project(child, w->count, w->n, w->n_air, &left.x, &right.x, &image, there);
        for (size_t i = 0; i < size; i++) there[i] -= here[i];
        add_own(x, there);
        memcpy(before, value, bytes);
        good = good && find_values(child, x, there, value);
        bough_arena_destroy(child);
        if (!good || (step > 0 && has_converged(modes, before, value))) return good;
    }
    return false;
}

// The point is the largest |λ|: nothing that the interpolation adds to a mode grows then.
static double point_of(const chosen *x) {
    double largest = 0;
    for (int c = 0; c < x->count; c++) largest = fmax(largest, hypot(x->growth[2 * c], x->growth[2 * c + 1]));
    return largest;
}

bough_status bough_other_mesh_find(bough_arena *arena, const bough_aeroelastic *system,
                                   const bough_simulation *own, const bough_mode_basis *modes,
                                   double (*value)[2], bool *found) {
    const bough_modes_def *def = system->def;
    chosen x = choose(arena, modes);
    for (int k = 0; k < modes->n; k++) value[k][0] = value[k][1] = (double)NAN;
    *found = have_equal_members(own, system->simulation);
    if (!*found || x.count == 0) return bough_ok();
    work w = {.system = system,
              .n = system->air->n,
              .n_air = system->air->n_air,
              .count = x.count,
              .gamma = 1 / point_of(&x),
              .growth = x.growth,
              .part = x.part};
    size_t parts = (size_t)def->n_part;
    w.rate = bough_arena_doubles(arena, parts * parts + 1);
    if (def->spin != 0) bough_modes_rate(def, w.rate);
    w.air_row = bough_arena_take(arena, (parts * (size_t)system->air->n_per_blade + 1) * sizeof *w.air_row);
    bough_air_tangent_rows(system->simulation, system->group, system->air->n_per_blade, w.air_row);
    bough_status status = bough_whole_setup(system->whole, def->time, def->state, def->input, w.gamma);
    if (!bough_is_ok(&status)) return bough_fail(BOUGH_FAILED, "%s", status.message);
    *found = iterate(arena, &w, own, &x, modes, value);
    return bough_ok();
}

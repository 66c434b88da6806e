// theory (77, 100).
#include "apps/bough/analysis/aeroelastic.h"

#include "apps/bough/analysis/air_inverse.h"
#include "core/base/linalg.h"

static const double same = 1e-6;        // relative distance of equal right and left eigenvalues
static const double least_motion = 0.2; // participation of the bodies; modes with less are modes of the air

enum { MODES_BEYOND = 8 }; // the wanted modes in the basis of the reduced system, besides an eighth

typedef struct work {
    const bough_aeroelastic *system;
    bough_arena *kept; // of the results
    int n, m;          // states of the members, those of the air that change
    int *air, *place;  // (m) rows of the air's tangents; (n_air) places of these rows in m, −1: none
    double *rate;      // S (n_part × n_part), row-major
    bough_air_inverse *inverse; // T⁻¹ P
} work;

// The states of the air that change: those of a model that is not in use are at rest.
static void find_air(bough_arena *arena, work *w) {
    const bough_air_tangent *air = w->system->air;
    size_t n_air = (size_t)air->n_air, all = (size_t)air->all;
    w->air = bough_arena_take(arena, (n_air + 1) * sizeof *w->air);
    w->place = bough_arena_take(arena, (n_air + 1) * sizeof *w->place);
    for (size_t i = 0; i < n_air; i++) {
        bool changes = false;
        for (size_t j = 0; j < all && !changes; j++)
            changes = *bough_air_tangent_entry(air, (size_t)w->n + i, j) != 0;
        w->place[i] = changes ? w->m : -1;
        if (changes) w->air[w->m++] = (int)i;
    }
}

// T⁻¹ P z
static void apply(void *self, int n, const double *z, double *image) {
    bough_air_inverse_apply(((const work *)self)->inverse, false, n, z, image);
}

// Pᵀ T⁻ᵀ z
static void apply_transposed(void *self, int n, const double *z, double *image) {
    bough_air_inverse_apply(((const work *)self)->inverse, true, n, z, image);
}

// Weights of scalar products: states of the members are measured in their scales (power −2, of left vectors
// 2), those of the air have weight 1.
static double *product_weights(bough_arena *arena, const work *w, double power) {
    double *weight = bough_arena_doubles(arena, (size_t)(w->n + w->m));
    bough_assembly_scales(w->system->whole->assembly, weight);
    for (int k = 0; k < w->n + w->m; k++) weight[k] = k < w->n ? pow(weight[k], power) : 1;
    return weight;
}

// Right or left pairs nearest to the point, without the memory of the air; `checked`: the search of the other
// side shows whether some are missing.
static bough_status find_pairs(bough_arena *arena, work *w, bool left, bool decaying, bool checked,
                               bough_eigen_pair *pair, bough_eigen_count *count) {
    const bough_eigen_operator op = {.name = "whole scene in the air",
                                     .length = w->n,
                                     .n_shape = w->n,
                                     .gamma = 1 / w->system->def->point,
                                     .weight = product_weights(arena, w, left ? 2 : -2),
                                     .decaying = decaying,
                                     .checked = checked,
                                     .self = w,
                                     .apply = left ? apply_transposed : apply};
    return bough_eigen_nearest(arena, &op, pair, count);
}

// Order by |λ| of eigenvalue pairs, or of structs that begin with one.
static int slower(const void *a, const void *b) {
    const bough_eigen_pair *x = a, *y = b;
    double first = hypot(x->real, x->imaginary), second = hypot(y->real, y->imaginary);
    return (first > second) - (first < second);
}

// -- the memory of the air ------------------------------------------------------------------------

// The reduced system: the members in the subspace of their modes, and all states of the air, theory (100).
typedef struct reduced {
    int r, all;               // modes as real columns; with the states of the air
    double *right, *left;     // U (n × r), L (r × n), L U = E
    double *real, *imaginary; // (r) of the eigenvalues of U, of a pair's second column the conjugate's
    double *matrix;           // (all × all)
    double *rest;             // (n × m) γ T⁻¹ P (E − U L) R: the modes left out by the air's states
    double *factor;           // (all × all) of E − γ matrix
    int *pivot;               // (all)
    double *value, *vector, *inverse; // (2 × all), (all × all): of the matrix of its vectors
} reduced;

static const bough_eigen_pair *partner(const bough_eigen_pair *of, int n, const bough_eigen_pair *left) {
    const bough_eigen_pair *nearest = NULL;
    double least = HUGE_VAL;
    for (int i = 0; i < n; i++) {
        double off = hypot(left[i].real - of->real, left[i].imaginary - of->imaginary);
        if (off < least) least = off, nearest = &left[i];
    }
    return least < same * hypot(of->real, of->imaginary) + same ? nearest : NULL;
}

// Real and imaginary parts of the modes with right and left vectors, as columns.
static void collect(const work *w, int n_right, const bough_eigen_pair *right, int n_left,
                    const bough_eigen_pair *left, double *of_left, reduced *x) {
    size_t n = (size_t)w->n, bytes = n * sizeof(double);
    for (int i = 0; i < n_right; i++) {
        const bough_eigen_pair *other = partner(&right[i], n_left, left);
        if (other == NULL) continue;
        for (int part = 0; part < 1 + (right[i].imaginary > 0); part++) {
            x->real[x->r] = right[i].real;
            x->imaginary[x->r] = (part == 0 ? 1 : -1) * right[i].imaginary;
            size_t at = (size_t)x->r++ * n;
            memcpy(x->right + at, part == 0 ? right[i].shape_real : right[i].shape_imag, bytes);
            memcpy(of_left + at, part == 0 ? other->shape_real : other->shape_imag, bytes);
        }
    }
}

// L = (Wᵀ U)⁻¹ Wᵀ
static bool orthogonalise(bough_arena *arena, const work *w, const double *of_left, reduced *x) {
    size_t n = (size_t)w->n, r = (size_t)x->r;
    double *small = bough_arena_doubles(arena, r * r);
    bough_dense_product((bough_product){x->r, x->r, w->n, true, .factor = 1}, of_left, x->right, small);
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < r; i++) x->left[j * r + i] = of_left[i * n + j];
    }
    return bough_dense_divide(arena, x->r, w->n, small, x->left);
}

// The first block: L (J − S + A) U
static void set_motion(reduced *x) {
    size_t all = (size_t)x->all;
    for (size_t j = 0; j < (size_t)x->r; j++) {
        x->matrix[j * all + j] = x->real[j];
        if (x->imaginary[j] > 0) x->matrix[j * all + j + 1] = -x->imaginary[j];
        if (x->imaginary[j] < 0) x->matrix[j * all + j - 1] = -x->imaginary[j];
    }
}

// rest ← γ T⁻¹ P (E − U L) rest, the static response of the neglected modes to forces R = rest (n × columns);
// force: L R.
static void follow(bough_arena *arena, work *w, const reduced *x, int columns, const double *force,
                   double *rest) {
    size_t size = (size_t)w->n * (size_t)columns;
    double *left = bough_arena_doubles(arena, size);
    memcpy(left, rest, size * sizeof *left);
    bough_dense_product((bough_product){w->n, columns, x->r, false, .factor = -1, .keep = 1}, x->right, force,
                        left);
    apply(w, columns, left, rest);
}

// Blocks of the air: L R, G U, H − S, and G by the neglected modes, which follow R without delay.
static void set_air(bough_arena *arena, work *w, reduced *x) {
    const bough_air_tangent *air = w->system->air;
    size_t n = (size_t)w->n, r = (size_t)x->r, m = (size_t)w->m, all = (size_t)x->all;
    size_t n_air = (size_t)air->n_air;
    double *lift = x->rest = bough_arena_doubles(arena, n * m), *force = bough_arena_doubles(arena, r * m);
    double *drive = bough_arena_doubles(arena, n_air * (r + m));
    // forces of the air's states, on the modes and on the neglected ones
    for (size_t j = 0; j < m; j++)
        memcpy(lift + j * n, bough_air_tangent_entry(air, 0, n + (size_t)w->air[j]), n * sizeof *lift);
    bough_dense_product((bough_product){x->r, w->m, w->n, false, .factor = 1}, x->left, lift, force);
    follow(arena, w, x, w->m, force, lift);
    // rates of the air by both
    bough_product by_modes = {air->n_air, x->r, w->n, false, .factor = 1, .rows_a = air->all},
                  by_rest = by_modes;
    bough_dense_product(by_modes, air->matrix + n, x->right, drive);
    by_rest.n = w->m, by_rest.factor = 1 / w->system->def->point;
    bough_dense_product(by_rest, air->matrix + n, lift, drive + n_air * r);
    for (size_t j = 0; j < r + m; j++) {
        const double *lag = j < r ? NULL : bough_air_tangent_entry(air, n, n + (size_t)w->air[j - r]);
        double *to = x->matrix + j * all;
        if (j >= r) memcpy(to, force + (j - r) * r, r * sizeof *to);
        for (size_t i = 0; i < m; i++)
            to[r + i] = drive[j * n_air + (size_t)w->air[i]] + (lag ? lag[w->air[i]] : 0);
    }
}

// The rates of the air include the rotation with the blades.
static void turn_air(bough_arena *arena, const work *w, reduced *x) {
    int parts = w->system->def->n_part, per_blade = w->system->air->n_per_blade;
    int first = w->system->group->n_row, n_all = first + per_blade;
    const int *row = bough_air_tangent_rows(arena, w->system->simulation, w->system->group, per_blade);
    for (int k = 0; k < parts; k++) {
        for (int l = 0; l < parts; l++) {
            for (int j = first; j < n_all; j++) {
                int to = w->place[row[k * n_all + j] - w->n], from = w->place[row[l * n_all + j] - w->n];
                if (to < 0 || from < 0) continue;
                x->matrix[(size_t)(x->r + from) * (size_t)x->all + (size_t)(x->r + to)] -=
                    w->rate[k * parts + l];
            }
        }
    }
}

static bool reduce(bough_arena *arena, work *w, int n_right, const bough_eigen_pair *right, int n_left,
                   const bough_eigen_pair *left, reduced *x) {
    size_t columns = 2 * (size_t)n_right + 1;
    x->right = bough_arena_doubles(arena, (size_t)w->n * columns);
    double *of_left = bough_arena_doubles(arena, (size_t)w->n * columns);
    bough_arena_each(arena, columns, &x->real, &x->imaginary);
    collect(w, n_right, right, n_left, left, of_left, x);
    x->left = bough_arena_doubles(arena, (size_t)w->n * (size_t)x->r);
    x->all = x->r + w->m;
    size_t all = (size_t)x->all;
    bough_arena_each(arena, all * all, &x->matrix, &x->vector, &x->inverse);
    x->value = bough_arena_doubles(arena, 2 * all);
    if (!orthogonalise(arena, w, of_left, x)) return false;
    set_motion(x);
    set_air(arena, w, x);
    if (w->system->def->spin != 0) turn_air(arena, w, x);
    return true;
}

static bool find_vectors(bough_arena *arena, reduced *x) {
    size_t all = (size_t)x->all;
    double *scratch = bough_arena_doubles(arena, BOUGH_EIGEN_WORK(all));
    for (size_t i = 0; i < all; i++) x->inverse[i * all + i] = 1;
    return bough_dense_eigen(x->all, x->matrix, x->value, x->vector, scratch) &&
           bough_dense_divide(arena, x->all, x->all, x->vector, x->inverse);
}

// Participation of the members in mode j (and j + 1 of a pair), Σ |left × right| over their states relative
// to that over all, which is independent of units.
static double participation(const reduced *x, size_t j, bool pair) {
    size_t all = (size_t)x->all;
    double motion = 0, whole = 0;
    for (size_t i = 0; i < all; i++) {
        double right = hypot(x->vector[j * all + i], pair ? x->vector[(j + 1) * all + i] : 0);
        double part = right * hypot(x->inverse[i * all + j], pair ? x->inverse[i * all + j + 1] : 0);
        whole += part;
        if (i < (size_t)x->r) motion += part;
    }
    return whole > 0 ? motion / whole : 0;
}

// -- the whole system -----------------------------------------------------------------------------

// Vectors of members and air, with coordinates in the subspace of the modes.
typedef struct vectors {
    int columns;
    double *members;     // (n × columns)
    double *coordinates; // (all × columns), r of the modes and then the air's states
} vectors;

static vectors take_vectors(bough_arena *arena, const work *w, const reduced *x, int columns) {
    size_t k = (size_t)columns + 1;
    return (vectors){columns, bough_arena_doubles(arena, (size_t)w->n * k),
                     bough_arena_doubles(arena, (size_t)x->all * k)};
}

// Members += U modes + γ rest air
static void add_coordinates(const work *w, const reduced *x, vectors *v) {
    bough_product modes = {w->n, v->columns, x->r, false, .factor = 1, .keep = 1, .rows_b = x->all},
                  air = modes;
    bough_dense_product(modes, x->right, v->coordinates, v->members);
    air.k = w->m, air.factor = 1 / w->system->def->point;
    bough_dense_product(air, x->rest, v->coordinates + x->r, v->members);
}

static bool factor_reduced(bough_arena *arena, const work *w, reduced *x) {
    size_t all = (size_t)x->all;
    x->factor = bough_arena_doubles(arena, all * all);
    x->pivot = bough_arena_take(arena, all * sizeof *x->pivot);
    for (size_t k = 0; k < all * all; k++) x->factor[k] = -x->matrix[k] / w->system->def->point;
    for (size_t k = 0; k < all; k++) x->factor[k * all + k] += 1;
    return bough_dense_factor(x->all, x->factor, x->pivot);
}

// Air += γ G members
static void add_drive(bough_arena *arena, const work *w, const reduced *x, vectors *v) {
    const bough_air_tangent *t = w->system->air;
    size_t n_air = (size_t)t->n_air;
    double *rate = bough_arena_doubles(arena, n_air * (size_t)v->columns + 1);
    bough_product p = {t->n_air,        v->columns, w->n, false, .factor = 1 / w->system->def->point,
                       .rows_a = t->all};
    bough_dense_product(p, t->matrix + t->n, v->members, rate);
    for (size_t k = 0; k < (size_t)v->columns; k++) {
        double *air = v->coordinates + k * (size_t)x->all + x->r;
        for (int i = 0; i < w->m; i++) air[i] += rate[k * n_air + (size_t)w->air[i]];
    }
}

// The inverse (E − γ ·)⁻¹ of members and air together: theory (102).
static vectors apply_whole(bough_arena *arena, work *w, const reduced *x, const vectors *z) {
    vectors image = take_vectors(arena, w, x, z->columns);
    size_t size = (size_t)w->n * (size_t)z->columns;
    // the part outside the subspace
    double *other = bough_arena_doubles(arena, size + 1);
    memcpy(other, z->members, size * sizeof *other);
    memcpy(image.coordinates, z->coordinates, (size_t)x->all * (size_t)z->columns * sizeof *other);
    bough_dense_product((bough_product){x->r, z->columns, w->n, false, .factor = 1, .rows_c = x->all},
                        x->left, z->members, image.coordinates);
    bough_dense_product(
        (bough_product){w->n, z->columns, x->r, false, .factor = -1, .keep = 1, .rows_b = x->all}, x->right,
        image.coordinates, other);
    apply(w, z->columns, other, image.members);
    // the subspace and the air, which it drives
    add_drive(arena, w, x, &image);
    bough_dense_solve(x->all, z->columns, x->factor, x->pivot, image.coordinates);
    add_coordinates(w, x, &image);
    return image;
}

// A mode and its column among the vectors of the reduced system.
typedef struct listed {
    bough_eigen_pair pair; // without shape
    size_t column;
} listed;

static int parts_of(const bough_eigen_pair *pair) { return 1 + (pair->imaginary > 0); }

// Real and imaginary part of a vector of the whole, one after the other (2 × length).
static void collect_parts(const work *w, const reduced *x, const vectors *v, size_t column, int parts,
                          double *to) {
    size_t n = (size_t)w->n, m = (size_t)w->m;
    memset(to, 0, 2 * (n + m) * sizeof *to);
    for (size_t part = 0; part < (size_t)parts; part++, to += n + m) {
        memcpy(to, v->members + (column + part) * n, n * sizeof *to);
        memcpy(to + n, v->coordinates + (column + part) * (size_t)x->all + x->r, m * sizeof *to);
    }
}

static int count_parts(int count, const listed *mode) {
    int columns = 0;
    for (int k = 0; k < count; k++) columns += parts_of(&mode[k].pair);
    return columns;
}

// A vector of members and the air's states that change (n + m each) as one of all (2 × (n + n_air)).
static double *spread(const work *w, const double *real, const double *imaginary) {
    size_t n = (size_t)w->n, all = n + (size_t)w->system->air->n_air;
    double *both = bough_arena_doubles(w->kept, 2 * all), *to = both;
    for (const double *from = real; to < both + 2 * all; from = imaginary, to += all) {
        memcpy(to, from, n * sizeof *to);
        for (size_t i = 0; i < (size_t)w->m; i++) to[n + (size_t)w->air[i]] = from[n + i];
    }
    return both;
}

// Modes of the whole system, after one step of inverse iteration, with their residuals.
static void expand(bough_arena *arena, work *w, const reduced *x, int count, const listed *mode,
                   bough_eigen_pair *pair, bough_mode_vectors *vector) {
    size_t n = (size_t)w->n, length = n + (size_t)w->m, all = (size_t)x->all, column = 0;
    const bough_eigen_operator op = {
        .length = (int)length, .gamma = 1 / w->system->def->point, .weight = product_weights(arena, w, -2)};
    double *from = bough_arena_doubles(arena, 4 * length), *to = from + 2 * length;
    // all vectors of the reduced system, as states
    vectors z = take_vectors(arena, w, x, count_parts(count, mode));
    for (int k = 0; k < count; k++) {
        size_t parts = (size_t)parts_of(&mode[k].pair);
        memcpy(z.coordinates + column * all, x->vector + mode[k].column * all, parts * all * sizeof *to);
        column += parts;
    }
    add_coordinates(w, x, &z);
    vectors image = apply_whole(arena, w, x, &z);
    column = 0;
    for (int k = 0; k < count; k++) {
        int parts = parts_of(&mode[k].pair);
        collect_parts(w, x, &z, column, parts, from);
        collect_parts(w, x, &image, column, parts, to);
        memcpy(pair[k].shape_real, to, n * sizeof *to);
        memcpy(pair[k].shape_imag, to + length, n * sizeof *to);
        pair[k].residual = bough_eigen_residual(&op, pair[k].real, pair[k].imaginary, from, to);
        if (vector) vector[k].right = spread(w, to, to + length);
        column += (size_t)parts;
    }
}

// Left vectors of the reduced system: of a pair, p and q of the columns inverse to its real and imaginary
// part, that of the mode is p − iq.
static vectors left_coordinates(bough_arena *arena, const work *w, const reduced *x, int count,
                                const listed *mode) {
    size_t all = (size_t)x->all, column = 0;
    vectors y = take_vectors(arena, w, x, count_parts(count, mode));
    for (int k = 0; k < count; k++) {
        for (size_t part = 0; part < (size_t)parts_of(&mode[k].pair); part++, column++) {
            const double *row = x->inverse + mode[k].column + part;
            for (size_t i = 0; i < all; i++)
                y.coordinates[column * all + i] = part == 0 ? row[i * all] : -row[i * all];
        }
    }
    return y;
}

// Left vectors of the whole: Lᵀ y_u and γ (E − U L)ᵀ (T⁻¹ P)ᵀ Gᵀ y_m of the modes left out, theory (100).
static void find_left(bough_arena *arena, work *w, const reduced *x, int count, const listed *mode,
                      bough_mode_vectors *vector) {
    const bough_air_tangent *t = w->system->air;
    vectors y = left_coordinates(arena, w, x, count, mode);
    size_t n = (size_t)w->n, columns = (size_t)y.columns, n_air = (size_t)t->n_air, column = 0;
    double *force = bough_arena_doubles(arena, n * columns + 1),
           *of_air = bough_arena_doubles(arena, n_air * columns);
    double *both = bough_arena_doubles(arena, 2 * (n + (size_t)w->m));
    for (size_t k = 0; k < columns; k++) {
        for (size_t i = 0; i < (size_t)w->m; i++)
            of_air[k * n_air + (size_t)w->air[i]] = y.coordinates[k * (size_t)x->all + (size_t)x->r + i];
    }
    bough_product p = {
        w->n, y.columns, t->n_air, true, .factor = 1 / w->system->def->point, .rows_a = t->all};
    bough_dense_product(p, t->matrix + t->n, of_air, force);
    bough_air_inverse_apply(w->inverse, true, y.columns, force, y.members);
    bough_dense_product(
        (bough_product){x->r, y.columns, w->n, true, .factor = -1, .keep = 1, .rows_c = x->all}, x->right,
        y.members, y.coordinates);
    bough_dense_product(
        (bough_product){w->n, y.columns, x->r, true, .factor = 1, .keep = 1, .rows_b = x->all}, x->left,
        y.coordinates, y.members);
    for (int k = 0; k < count; k++) {
        int parts = parts_of(&mode[k].pair);
        collect_parts(w, x, &y, column, parts, both);
        vector[k].left = spread(w, both, both + n + (size_t)w->m);
        column += (size_t)parts;
    }
}

// The modes in which the bodies take part; returns their number.
static int choose_modes(const reduced *x, listed *mode) {
    size_t all = (size_t)x->all;
    int found = 0;
    for (size_t j = 0; j < all; j++) {
        double growth = x->value[j], frequency = x->value[all + j];
        if (frequency < 0 || (frequency == 0 && growth <= 0)) continue;
        if (participation(x, j, frequency > 0) < least_motion) continue;
        mode[found++] = (listed){.pair = {.real = growth, .imaginary = frequency}, .column = j};
    }
    return found;
}

static void list_modes(bough_arena *arena, work *w, const reduced *x, bough_eigen_pair *pair,
                       bough_eigen_count *count, bough_mode_vectors *vector) {
    size_t n = (size_t)w->n;
    listed *mode = bough_arena_take(arena, (size_t)x->all * sizeof *mode);
    count->found = choose_modes(x, mode);
    qsort(mode, (size_t)count->found, sizeof *mode, slower);
    if (count->found > count->wanted) count->found = count->wanted;
    for (int k = 0; k < count->found; k++) {
        pair[k] = mode[k].pair;
        bough_arena_each(w->kept, n, &pair[k].shape_real, &pair[k].shape_imag);
    }
    expand(arena, w, x, count->found, mode, pair, vector);
    if (vector) find_left(arena, w, x, count->found, mode, vector);
}

// Number of right or left eigenvectors without a partner.
static int count_unpaired(int n_right, const bough_eigen_pair *right, int n_left,
                          const bough_eigen_pair *left) {
    int unpaired = n_left > n_right ? n_left - n_right : 0;
    for (int i = 0; i < n_right; i++) unpaired += partner(&right[i], n_left, left) == NULL;
    return unpaired;
}

// A basis of right and of left eigenvectors. Both searches start with different vectors and confirm each
// other; if they do not, both search for more.
static bough_status find_both(bough_arena *arena, work *w, bough_eigen_pair *right,
                              bough_eigen_count *n_right, bough_eigen_pair *left, bough_eigen_count *n_left,
                              int *unpaired) {
    for (int checked = 1; checked >= 0; checked--) {
        BOUGH_TRY(find_pairs(arena, w, false, true, checked, right, n_right));
        BOUGH_TRY(find_pairs(arena, w, true, true, checked, left, n_left));
        *unpaired = count_unpaired(n_right->found, right, n_left->found, left);
        if (*unpaired == 0) break;
    }
    return bough_ok();
}

static bough_status follow_memory(bough_arena *arena, work *w, bough_eigen_pair *pair,
                                  bough_eigen_count *count, bough_mode_vectors *vector, int *unpaired) {
    int basis = count->wanted + count->wanted / 8 + MODES_BEYOND;
    bough_eigen_pair *right = bough_arena_take(arena, (size_t)basis * sizeof *right);
    bough_eigen_pair *left = bough_arena_take(arena, (size_t)basis * sizeof *left);
    bough_eigen_count n_right = {.wanted = basis}, n_left = {.wanted = basis};
    reduced x = {0};
    BOUGH_TRY(find_both(arena, w, right, &n_right, left, &n_left, unpaired));
    if (!reduce(arena, w, n_right.found, right, n_left.found, left, &x) || !factor_reduced(arena, w, &x) ||
        !find_vectors(arena, &x))
        return bough_fail(BOUGH_FAILED, "the motion in the air cannot be reduced to %d modes", n_right.found);
    count->converged = n_right.converged < n_left.converged ? n_right.converged : n_left.converged;
    list_modes(arena, w, &x, pair, count, vector);
    return bough_ok();
}

// Vectors of modes without memory of the air, whose states are at rest.
static bough_status find_partners(bough_arena *arena, work *w, const bough_eigen_pair *pair,
                                  const bough_eigen_count *count, bough_mode_vectors *vector) {
    bough_eigen_count n_left = {.wanted = count->wanted};
    bough_eigen_pair *left = bough_arena_take(arena, (size_t)n_left.wanted * sizeof *left);
    BOUGH_TRY(find_pairs(arena, w, true, false, true, left, &n_left));
    for (int k = 0; k < count->found; k++) {
        const bough_eigen_pair *other = partner(&pair[k], n_left.found, left);
        vector[k].right = spread(w, pair[k].shape_real, pair[k].shape_imag);
        vector[k].left = other ? spread(w, other->shape_real, other->shape_imag) : NULL;
    }
    return bough_ok();
}

static bough_status find(bough_arena *arena, work *w, bough_eigen_pair *pair, bough_eigen_count *count,
                         bough_mode_vectors *vector, int *unpaired) {
    find_air(arena, w);
    w->rate = bough_modes_rate(arena, w->system->def);
    BOUGH_TRY(bough_air_inverse_create(arena, w->system, &w->inverse));
    if (w->m > 0) return follow_memory(arena, w, pair, count, vector, unpaired);
    BOUGH_TRY(find_pairs(w->kept, w, false, false, false, pair, count));
    qsort(pair, (size_t)count->found, sizeof *pair, slower);
    return vector ? find_partners(arena, w, pair, count, vector) : bough_ok();
}

bough_status bough_aeroelastic_modes(bough_arena *arena, const bough_aeroelastic *system,
                                     bough_eigen_pair *pair, bough_eigen_count *count,
                                     bough_mode_vectors *vector, int *unpaired) {
    work w = {.system = system, .kept = arena, .n = system->air->n};
    *unpaired = 0;
    bough_arena *own = bough_arena_child(arena);
    bough_status status = find(own, &w, pair, count, vector, unpaired);
    bough_arena_destroy(own);
    return status;
}

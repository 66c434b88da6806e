// theory (77, 109). Equal blades are in blade_inverse.c, and all other states border them; without equal
// blades all states are others.
#include "apps/bough/analysis/air_inverse.h"

#include "core/base/linalg.h"

// A joint without stiffness has a double eigenvalue 0 with one vector. Coordinates of joints return at this
// rate, relative to the point, which gives two vectors.
static const double going_back = 1e-6;

// The blades' blocks of P differ with their loads, and the system with the azimuth. Their mean is used if a
// test vector satisfies the equations to this relative accuracy. Its transpose is exact.
static const double alike = 1e-4, exact = 1e-9;

enum { MOST = 64 }; // vectors at once

static size_t square(int n) { return (size_t)n * (size_t)n; }

// The states that neither belong to the blades nor are held. False if a state of a blade is held.
static bool find_others(bough_arena *arena, bough_air_inverse *x) {
    const bough_modes_def *def = x->system->def;
    const bough_whole *whole = x->system->whole;
    bool *taken = bough_arena_take(arena, (size_t)x->n * sizeof *taken);
    x->other = bough_arena_take(arena, ((size_t)x->n + 1) * sizeof *x->other);
    for (int i = 0; i < x->n_part * x->r; i++) taken[def->row[i]] = true;
    for (int i = 0; i < whole->n_held; i++) {
        if (taken[whole->held[i]]) return false;
        taken[whole->held[i]] = true;
    }
    for (int i = 0; i < x->n; i++)
        if (!taken[i]) x->other[x->n_other++] = i;
    return true;
}

// c (columns × m) += factor Σ aᵀ b over the harmonics, a (n_part × m × r), b (n_part × columns × r).
static void add_products(const bough_air_inverse *x, int m, const double *a, int columns, const double *b,
                         double *c) {
    for (int p = 0; p < x->n_part; p++)
        bough_dense_product((bough_product){m, columns, x->r, true, .factor = 1, .keep = 1},
                            a + (size_t)(p * m) * (size_t)x->r, b + (size_t)(p * columns) * (size_t)x->r, c);
}

// c (n_part × columns × r) += a b, a (n_part × n_other × r), b (columns × n_other).
static void spread(const bough_air_inverse *x, const double *a, int columns, const double *b, double *c) {
    for (int p = 0; p < x->n_part; p++)
        bough_dense_product((bough_product){x->r, columns, x->n_other, false, .factor = 1, .keep = 1},
                            a + (size_t)(p * x->n_other) * (size_t)x->r, b,
                            c + (size_t)(p * columns) * (size_t)x->r);
}

// -- the parts of P and of N = γ (S − A) ----------------------------------------------------------

// Columns of P: P_oo, and P_bo into x->to, by z (n_other × n).
static void set_columns(const bough_air_inverse *x, double *z) {
    size_t n = (size_t)x->n, n_other = (size_t)x->n_other;
    for (size_t j = 0; j < n_other; j++) {
        double *column = z + (x->blades ? j * n : 0);
        memset(column, 0, n * sizeof *column);
        column[x->other[j]] = 1;
        bough_whole_solve(x->system->whole, column);
        // unlike blades do not turn lengths of quaternions into lengths
        if (!x->blades) bough_whole_project(x->system->whole, x->system->def->state, column);
        for (size_t i = 0; i < n_other; i++) x->others[j * n_other + i] = column[x->other[i]];
    }
    if (x->blades) bough_blade_inverse_gather(x->blades, x->n_other, z, x->to);
}

// What forces on a blade do to the others, y (n_other × r), by the outputs that they change.
static void follow_blade(bough_arena *arena, const bough_air_inverse *x, int blade, double *y) {
    bough_whole *whole = x->system->whole;
    const bough_assembly *a = whole->assembly;
    int member = x->system->group->blade[blade]->port + 1, first = a->output_offset[member];
    size_t n_output = (size_t)a->member[member]->system.n_output, n_other = (size_t)x->n_other;
    double *column = bough_arena_doubles(arena, (size_t)x->n);
    double *by_output = bough_arena_doubles(arena, n_other * n_output + 1);
    double *change = bough_arena_doubles(arena, n_output * (size_t)x->r + 1);
    for (size_t o = 0; o < n_output; o++) {
        bough_whole_follow(whole, first + (int)o, column);
        for (size_t i = 0; i < n_other; i++) by_output[o * n_other + i] = column[x->other[i]];
    }
    bough_whole_begin_solution(whole, column);
    for (size_t j = 0; j < (size_t)x->r; j++) {
        double *own = column + a->state_offset[member];
        memset(own, 0, (size_t)x->r * sizeof *own);
        column[x->system->def->row[(size_t)(blade * x->r) + j]] = 1;
        bough_whole_solve_of(whole, member);
        memcpy(change + j * n_output, whole->output_change + first, n_output * sizeof *change);
    }
    bough_dense_product((bough_product){x->n_other, x->r, (int)n_output, false, .factor = 1}, by_output,
                        change, y);
}

// Yᵀ into x->from: what forces on the blades do to the others, P_oo⁻¹ P_ob.
static bool set_rows(bough_arena *arena, const bough_air_inverse *x, double *z) {
    size_t n = (size_t)x->n, n_other = (size_t)x->n_other, all = (size_t)(x->n_part * x->r);
    const int *row = x->system->def->row;
    double *y = bough_arena_doubles(arena, all * n_other + 1);
    for (int k = 0; k < x->n_part; k++) follow_blade(arena, x, k, y + (size_t)(k * x->r) * n_other);
    if (!bough_dense_divide(arena, x->n_other, (int)all, x->others, y)) return false;
    for (size_t k = 0; k < all * n_other; k++) z[k % n_other * n + (size_t)row[k / n_other]] = y[k];
    bough_blade_inverse_gather(x->blades, x->n_other, z, x->from);
    return true;
}

// N_oo, with what holds free joints and, where the blades are among the others, their rotation.
static void set_among(bough_arena *arena, const bough_air_inverse *x, double *among) {
    const bough_modes_def *def = x->system->def;
    size_t n = (size_t)x->n, n_other = (size_t)x->n_other;
    int *place = bough_arena_take(arena, n * sizeof *place);
    const double *rate = bough_modes_rate(arena, def);
    for (size_t j = 0; j < n_other; j++) {
        const double *column = bough_air_tangent_entry(x->system->air, 0, (size_t)x->other[j]);
        place[x->other[j]] = (int)j;
        for (size_t i = 0; i < n_other; i++) among[j * n_other + i] = -x->gamma * column[x->other[i]];
        if (x->other[j] < x->system->simulation->tree->n_q) among[j * n_other + j] += going_back;
    }
    if (x->blades || def->spin == 0) return;
    for (int k = 0; k < def->n_part * def->n_part; k++) {
        const int *to = def->row + k / def->n_part * def->n_row,
                  *from = def->row + k % def->n_part * def->n_row;
        for (int j = 0; j < def->n_row; j++)
            among[place[from[j]] * x->n_other + place[to[j]]] += x->gamma * rate[k];
    }
}

// N_bo or N_obᵀ, by z (n_other × n).
static void set_border(const bough_air_inverse *x, bool transposed, double *z, double *border) {
    const bough_air_tangent *air = x->system->air;
    const int *row = x->system->def->row;
    size_t n = (size_t)x->n;
    for (size_t j = 0; j < (size_t)x->n_other; j++) {
        size_t other = (size_t)x->other[j];
        for (int k = 0; k < x->n_part * x->r; k++) {
            size_t blade = (size_t)row[k];
            z[j * n + blade] = -x->gamma * *(transposed ? bough_air_tangent_entry(air, other, blade)
                                                        : bough_air_tangent_entry(air, blade, other));
        }
    }
    bough_blade_inverse_gather(x->blades, x->n_other, z, border);
}

// W = P_bo − D (N_bb P_bo + N_bo P_oo), V = Y − R D with R = Y N_bb + N_ob, and K = E + R W + (Y N_bo + N_oo)
// P_oo, of which `among` is N_oo.
static bool set_blades(bough_arena *arena, const bough_air_inverse *x, double *z, double *among, double *k) {
    int n = x->n_other;
    size_t all = (size_t)(x->n_part * x->r) * (size_t)n + 1;
    double *onto, *sources, *force, *image, *work = bough_arena_doubles(arena, 2 * all);
    bough_arena_each(arena, all, &onto, &sources, &force, &image);
    if (!set_rows(arena, x, z)) return false;
    set_border(x, false, z, onto);
    set_border(x, true, z, sources);
    // W
    spread(x, onto, n, x->others, force);
    bough_blade_inverse_force(x->blades, false, n, x->to, work, force);
    bough_blade_inverse_apply(x->blades, false, n, force, work, image);
    for (size_t i = 0; i < all; i++) x->to[i] -= image[i];
    // R and V
    add_products(x, n, x->from, n, onto, among);
    bough_blade_inverse_force(x->blades, true, n, x->from, work, sources);
    bough_blade_inverse_apply(x->blades, true, n, sources, work, image);
    for (size_t i = 0; i < all; i++) x->from[i] -= image[i];
    add_products(x, n, sources, n, x->to, k);
    return true;
}

static bool set(bough_arena *arena, const bough_air_inverse *x) {
    int n = x->n_other;
    double *among, *k, *z = bough_arena_doubles(arena, (size_t)x->n * (x->blades ? (size_t)n + 1 : 1));
    bough_arena_each(arena, square(n) + 1, &among, &k);
    set_columns(x, z);
    set_among(arena, x, among);
    if (x->blades && !set_blades(arena, x, z, among, k)) return false;
    bough_dense_product((bough_product){n, n, n, false, .factor = 1, .keep = 1}, among, x->others, k);
    for (size_t i = 0; i < square(n); i += (size_t)n + 1) k[i] += 1, x->inverse[i] = 1;
    return bough_dense_divide(arena, n, n, k, x->inverse);
}

// -- test -----------------------------------------------------------------------------------------

// z − γ (S − A) y − going_back y: the right-hand side of which the image y of z must be the solution.
static void find_force(bough_arena *arena, const bough_air_inverse *x, const double *y, double *z) {
    const bough_modes_def *def = x->system->def;
    const double *rate = bough_modes_rate(arena, def);
    bough_dense_product(
        (bough_product){x->n, 1, x->n, false, .factor = x->gamma, .keep = 1, .rows_a = x->system->air->all},
        x->system->air->matrix, y, z);
    bough_modes_add_rate(def, rate, def->n_row, def->row, -x->gamma, y, z);
    for (int i = 0; i < x->system->simulation->tree->n_q; i++) z[i] -= going_back * y[i];
}

// Whether the image of a test vector solves the equations of the whole, and the transpose is consistent.
static bool is_exact(bough_arena *arena, bough_air_inverse *x) {
    const bough_whole *whole = x->system->whole;
    double *scale, *z, *y, *left, *image, error = 0, size = 0, product = 0, both = 0;
    bough_arena_each(arena, (size_t)x->n, &scale, &z, &y, &left, &image);
    bough_assembly_scales(whole->assembly, scale);
    for (int i = 0; i < x->n; i++) z[i] = scale[i] * sin(1 + 7.3 * i), left[i] = cos(2 + 5.1 * i) / scale[i];
    bough_whole_project(whole, x->system->def->state, z);
    bough_air_inverse_apply(x, false, 1, z, y);
    bough_air_inverse_apply(x, true, 1, left, image);
    for (int i = 0; i < x->n; i++) {
        product += left[i] * y[i] - image[i] * z[i];
        both += fabs(left[i] * y[i]);
    }
    find_force(arena, x, y, z);
    bough_whole_solve(x->system->whole, z);
    bough_whole_project(whole, x->system->def->state, z);
    for (int i = 0; i < x->n; i++) {
        error = fmax(error, fabs(z[i] - y[i]) / scale[i]);
        size = fmax(size, fabs(y[i]) / scale[i]);
    }
    return error <= alike * size && fabs(product) <= exact * both;
}

// -- whole ----------------------------------------------------------------------------------------

// NULL: singular, or the blades are not alike.
static bough_air_inverse *create(bough_arena *arena, const bough_aeroelastic *system,
                                 const bough_blade_inverse *blades) {
    bough_air_inverse *x = bough_arena_take(arena, sizeof *x);
    *x = (bough_air_inverse){
        .system = system, .n = system->air->n, .gamma = 1 / system->def->point, .blades = blades};
    if (blades) x->n_part = system->def->n_part, x->r = system->def->n_row;
    if (!find_others(arena, x)) return NULL;
    size_t all = (size_t)(x->n_part * x->r), n_other = (size_t)x->n_other;
    bough_arena_each(arena, all * n_other + 1, &x->from, &x->to);
    bough_arena_each(arena, n_other * n_other + 1, &x->others, &x->inverse);
    bough_arena_each(arena, all * MOST + 1, &x->argument, &x->image);
    x->work = bough_arena_doubles(arena, 2 * all * MOST + 1);
    bough_arena_each(arena, n_other * MOST + 1, &x->force, &x->moved);
    bough_arena *own = bough_arena_child(arena);
    bool good = set(own, x) && (!blades || is_exact(own, x));
    bough_arena_destroy(own);
    return good ? x : NULL;
}

bough_status bough_air_inverse_create(bough_arena *arena, const bough_aeroelastic *system,
                                      bough_air_inverse **inverse) {
    const bough_modes_def *def = system->def;
    bough_status status = bough_whole_setup(system->whole, def->time, def->state, def->input, 1 / def->point);
    if (!bough_is_ok(&status)) return bough_fail(BOUGH_FAILED, "%s", status.message);
    const bough_blade_inverse *blades = bough_blade_inverse_create(arena, system);
    *inverse = blades ? create(arena, system, blades) : NULL;
    if (*inverse == NULL) *inverse = create(arena, system, NULL);
    if (*inverse) return bough_ok();
    return bough_fail(BOUGH_FAILED, "the motion in the air is singular about %g /s", def->point);
}

// The others' entries of vectors (n × n_state).
static void gather(const bough_air_inverse *x, int n, const double *z, double *force) {
    for (int c = 0; c < n; c++) {
        for (int i = 0; i < x->n_other; i++)
            force[c * x->n_other + i] = z[(size_t)c * (size_t)x->n + (size_t)x->other[i]];
    }
}

static void scatter(const bough_air_inverse *x, int n, const double *force, double *z) {
    for (int c = 0; c < n; c++) {
        for (int i = 0; i < x->n_other; i++)
            z[(size_t)c * (size_t)x->n + (size_t)x->other[i]] = force[c * x->n_other + i];
    }
}

static void project(const bough_air_inverse *x, int n, double *z) {
    for (int c = 0; c < n; c++)
        bough_whole_project(x->system->whole, x->system->def->state, z + (size_t)c * (size_t)x->n);
}

// g ← P_oo g or K⁻¹ g, or by the transpose.
static void multiply_others(const bough_air_inverse *x, const double *matrix, bool transposed, int n) {
    bough_product p = {x->n_other, n, x->n_other, transposed, .factor = 1};
    bough_dense_product(p, matrix, x->force, x->moved);
    memcpy(x->force, x->moved, (size_t)n * (size_t)x->n_other * sizeof *x->force);
}

// theory (109): y_b = D z_b + W g, y_o = P_oo g, K g = V z_b + z_o, then projected. The transpose takes the
// steps in the other order: y_b = Dᵀ z_b + Vᵀ g, y_o = g, Kᵀ g = Wᵀ z_b + P_ooᵀ z_o; the projection is its
// own.
static void apply(const bough_air_inverse *x, bool transposed, int n, const double *z, double *image) {
    memcpy(image, z, (size_t)n * (size_t)x->n * sizeof *image);
    if (transposed) project(x, n, image);
    gather(x, n, image, x->force);
    if (transposed) multiply_others(x, x->others, true, n);
    // g from the blades, then the blades' own part and that from g
    if (x->blades) {
        bough_blade_inverse_gather(x->blades, n, image, x->argument);
        add_products(x, x->n_other, transposed ? x->to : x->from, n, x->argument, x->force);
        bough_blade_inverse_apply(x->blades, transposed, n, x->argument, x->work, x->image);
    }
    multiply_others(x, x->inverse, transposed, n);
    spread(x, transposed ? x->from : x->to, n, x->force, x->image);
    if (!transposed) multiply_others(x, x->others, false, n);
    memset(image, 0, (size_t)n * (size_t)x->n * sizeof *image); // what is held stays at rest
    if (x->blades) bough_blade_inverse_scatter(x->blades, n, x->image, image);
    scatter(x, n, x->force, image);
    if (!transposed) project(x, n, image);
}

void bough_air_inverse_apply(bough_air_inverse *x, bool transposed, int n, const double *z, double *image) {
    for (int begin = 0; begin < n; begin += MOST) {
        size_t at = (size_t)begin * (size_t)x->n;
        apply(x, transposed, n - begin < MOST ? n - begin : MOST, z + at, image + at);
    }
}

#include "apps/bough/analysis/sensitivity.h"

#include "apps/bough/analysis/air_tangent.h"
#include "core/base/linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double difference = 1e-4; // of the largest entry of a vector in units of its scale
static const double step = 0.1;        // of a parameter, in units of its change: polars have corners
static const double least = 1e-9;      // changes of λ relative to it are rounding
static const double exact = 1e-6;      // residual of an eigenvector

enum { ITERATIONS = 4 }; // of inverse iteration about an eigenvalue that is known to some digits

// The linear system J − S + A of theory (100) about one state, as products with vectors (n + m).
typedef struct linear {
    bough_simulation *simulation;
    bough_vibration_point point;
    bough_air_change *air;                      // NULL: its forces do not follow
    int n, m, n_row;                            // states of the members, of the air; of the latter in a blade
    int *air_row;                               // (n_part × n_row)
    double *scale;                              // (n)
    double *rate;                               // S (n_part × n_part), row-major
    double *moved, *side[2], *turned, *follows; // (n + m) work
} linear;

static bough_status prepare(bough_arena *arena, bough_simulation *s, double time, linear *x) {
    *x = (linear){.simulation = s, .n = s->master->assembly->n_state};
    BOUGH_TRY(bough_vibration_point_find(arena, s, time, &x->point));
    const bough_modes_def *def = &x->point.def;
    if (s->aero != NULL && s->scene->modes.air != BOUGH_SCENE_AIR_FROZEN)
        x->air = bough_air_change_create(arena, s, x->point.coupled, time, x->point.state,
                                         s->scene->modes.air == BOUGH_SCENE_AIR_DYNAMIC, &x->m);
    if (x->air) x->n_row = x->m / s->scene->turbine.n_blade;
    size_t all = (size_t)(x->n + x->m) + 1, parts = (size_t)def->n_part;
    bough_arena_each(arena, all, &x->moved, &x->side[0], &x->side[1], &x->turned, &x->follows);
    x->scale = bough_arena_doubles(arena, all);
    bough_assembly_scales(s->master->assembly, x->scale);
    x->air_row = bough_arena_take(arena, (parts * (size_t)x->n_row + 1) * sizeof(int));
    bough_air_tangent_rows(s, &x->point.group, x->n_row, x->air_row);
    x->rate = bough_arena_doubles(arena, parts * parts + 1);
    if (def->spin != 0) bough_modes_rate(def, x->rate);
    return bough_ok();
}

// Row j of part k, of the members' states and then of the air's.
static int row_of(const linear *x, int k, int j) {
    const bough_modes_def *def = &x->point.def;
    return j < def->n_row ? def->row[k * def->n_row + j] : x->n + x->air_row[k * x->n_row + j - def->n_row];
}

// Gives part k what part k + shift has.
static void shift_parts(const linear *x, int shift, const double *from, double *to) {
    const bough_modes_def *def = &x->point.def;
    memcpy(to, from, (size_t)(x->n + x->m) * sizeof *to);
    for (int k = 0; k < def->n_part; k++)
        for (int j = 0; j < def->n_row + x->n_row; j++)
            to[row_of(x, k, j)] = from[row_of(x, (k + shift) % def->n_part, j)];
}

// −S y
static void subtract_spin(const linear *x, const double *y, double *image) {
    const bough_modes_def *def = &x->point.def;
    for (int k = 0; k < def->n_part; k++)
        for (int l = 0; l < def->n_part; l++)
            for (int j = 0; j < def->n_row + x->n_row; j++)
                image[row_of(x, k, j)] -= x->rate[k * def->n_part + l] * y[row_of(x, l, j)];
}

// What follows from the air, in the mean over the azimuths of the blades, over which a slope in azimuth is
// none.
static bough_status add_air(linear *x, double size, const double *y, double *image) {
    const bough_modes_def *def = &x->point.def;
    bool turns = def->spin != 0;
    int shifts = turns ? def->n_part : 1, azimuth = 0, speed;
    if (turns)
        bough_tree_joint_rows(x->simulation->tree, x->simulation->scene->turbine.rotor, &azimuth, &speed);
    for (int shift = 0; shift < shifts; shift++) {
        shift_parts(x, shift, y, x->turned);
        if (turns) x->turned[azimuth] = 0;
        BOUGH_TRY(bough_air_change_follow(x->air, size, x->turned, x->follows));
        shift_parts(x, (shifts - shift) % shifts, x->follows, x->turned);
        for (int i = 0; i < x->n + x->m; i++) image[i] += x->turned[i] / shifts;
    }
    return bough_ok();
}

// image = (J − S + A) y of a real vector; states that are held stay.
static bough_status multiply(linear *x, const double *y, double *image) {
    double largest = 0;
    const bough_vibration_point *p = &x->point;
    for (int i = 0; i < x->n; i++) largest = fmax(largest, fabs(y[i]) / x->scale[i]);
    for (int i = x->n; i < x->n + x->m; i++) largest = fmax(largest, fabs(y[i]));
    memset(image, 0, (size_t)(x->n + x->m) * sizeof *image);
    if (largest == 0) return bough_ok();
    double size = difference / largest;
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < x->n; i++) x->moved[i] = p->state[i] + (2 * side - 1) * size * y[i];
        BOUGH_TRY(bough_whole_rate(p->coupled, p->def.time, x->moved, x->side[side]));
    }
    for (int i = 0; i < x->n; i++) image[i] = (x->side[1][i] - x->side[0][i]) / (2 * size);
    if (x->air) BOUGH_TRY(add_air(x, size, y, image));
    if (p->def.spin != 0) subtract_spin(x, y, image);
    for (int k = 0; k < p->n_held; k++) image[p->held[k]] = 0;
    return bough_ok();
}

// -- eigenvectors ---------------------------------------------------------------------------------

// A mode of the linear system; complex numbers are pairs, real before imaginary part.
typedef struct mode {
    int all;
    double value[2];      // λ
    double *right, *left; // (all × 2)
    double residual;
} mode;

static void multiply_by(const double a[2], const double b[2], double c[2]) {
    double real = a[0] * b[0] - a[1] * b[1], imaginary = a[0] * b[1] + a[1] * b[0];
    c[0] = real;
    c[1] = imaginary;
}

// Σ a b, not conjugated.
static void product(int n, const double *a, const double *b, double sum[2]) {
    sum[0] = sum[1] = 0;
    for (int i = 0; i < n; i++) {
        double term[2];
        multiply_by(a + 2 * i, b + 2 * i, term);
        sum[0] += term[0];
        sum[1] += term[1];
    }
}

static void divide(const double a[2], const double b[2], double c[2]) {
    double square = b[0] * b[0] + b[1] * b[1], over[2] = {b[0] / square, -b[1] / square};
    multiply_by(a, over, c);
}

static double length_of(int n, const double *a) {
    double sum = 0;
    for (int i = 0; i < 2 * n; i++) sum += a[i] * a[i];
    return sqrt(sum);
}

// Real columns of the system, some of the air's states of which never change: those rows and columns are 0.
static bough_status fill(bough_arena *arena, linear *x, double *matrix) {
    size_t all = (size_t)(x->n + x->m);
    double *unit = bough_arena_doubles(arena, all);
    for (size_t j = 0; j < all; j++) {
        unit[j] = 1;
        BOUGH_TRY(multiply(x, unit, matrix + j * all));
        unit[j] = 0;
    }
    for (int k = 0; k < x->point.n_held; k++)
        memset(matrix + (size_t)x->point.held[k] * all, 0, all * sizeof *matrix);
    return bough_ok();
}

// Eigenvectors of the matrix, or of its transposed one, about λ by inverse iteration from those given: vector
// (count × n × 2).
static bool iterate(bough_arena *arena, int n, const double *matrix, bool transposed, const double value[2],
                    int count, double *vector) {
    size_t all = (size_t)n;
    double *factor = bough_arena_doubles(arena, 2 * all * all);
    int *pivot = bough_arena_take(arena, all * sizeof *pivot);
    for (size_t j = 0; j < all; j++)
        for (size_t i = 0; i < all; i++)
            factor[2 * (j * all + i)] = transposed ? matrix[i * all + j] : matrix[j * all + i];
    for (size_t i = 0; i < all; i++) {
        factor[2 * (i * all + i)] -= value[0];
        factor[2 * (i * all + i) + 1] -= value[1];
    }
    if (!bough_complex_factor(n, factor, pivot)) return false;
    for (int k = 0; k < ITERATIONS * count; k++) {
        double *x = vector + (size_t)(k % count) * 2 * all;
        bough_complex_solve(n, factor, pivot, x);
        double size = length_of(n, x);
        if (!isfinite(size)) return false;
        for (size_t i = 0; i < 2 * all; i++) x[i] /= size;
    }
    return true;
}

static void start(int n, int seed, double *vector) {
    for (int i = 0; i < 2 * n; i++) vector[i] = sin((double)(seed + 7 * i)) + 0.1;
}

// (real matrix) × complex vector
static void apply(bough_arena *arena, int n, const double *matrix, const double *y, double *image) {
    size_t all = (size_t)n;
    double *parts = bough_arena_doubles(arena, 4 * all);
    for (size_t i = 0; i < all; i++) {
        parts[i] = y[2 * i];
        parts[all + i] = y[2 * i + 1];
    }
    bough_dense_product((bough_product){n, 2, n, false, 1, 0}, matrix, parts, parts + 2 * all);
    for (size_t i = 0; i < all; i++) {
        image[2 * i] = parts[2 * all + i];
        image[2 * i + 1] = parts[3 * all + i];
    }
}

// The same eigenvalue with another vector.
static bool has_twin(int n, const double *a, const double *b) {
    double real = 0, imaginary = 0;
    for (int i = 0; i < n; i++) {
        real += a[2 * i] * b[2 * i] + a[2 * i + 1] * b[2 * i + 1];
        imaginary += a[2 * i] * b[2 * i + 1] - a[2 * i + 1] * b[2 * i];
    }
    return hypot(real, imaginary) < 0.99;
}

// λ by the quotient of both vectors, and its residual.
static void improve(bough_arena *arena, const double *matrix, mode *x) {
    double *image = bough_arena_doubles(arena, 2 * (size_t)x->all), above[2], below[2];
    apply(arena, x->all, matrix, x->right, image);
    product(x->all, x->left, image, above);
    product(x->all, x->left, x->right, below);
    divide(above, below, x->value);
    for (int i = 0; i < x->all; i++) {
        double term[2];
        multiply_by(x->value, x->right + 2 * i, term);
        image[2 * i] -= term[0];
        image[2 * i + 1] -= term[1];
    }
    x->residual = length_of(x->all, image) / hypot(x->value[0], x->value[1]);
}

static bough_status find_vectors(bough_arena *arena, linear *system, mode *x) {
    size_t all = (size_t)x->all;
    double *matrix = bough_arena_doubles(arena, all * all);
    x->right = bough_arena_doubles(arena, 4 * all);
    x->left = bough_arena_doubles(arena, 2 * all);
    double *twin = x->right + 2 * all;
    BOUGH_TRY(fill(arena, system, matrix));
    start(x->all, 1, x->right);
    start(x->all, 3, twin);
    start(x->all, 2, x->left);
    bool found = iterate(arena, x->all, matrix, false, x->value, 2, x->right) &&
                 iterate(arena, x->all, matrix, true, x->value, 1, x->left);
    if (found && has_twin(x->all, x->right, twin))
        return bough_fail(BOUGH_INVALID, "the sensitivity of one of several modes with one eigenvalue is not "
                                         "defined: their shapes mix");
    if (found) improve(arena, matrix, x);
    if (!found || !(x->residual < exact))
        return bough_fail(BOUGH_FAILED, "the eigenvector of the mode does not converge");
    return bough_ok();
}

// -- parameters -----------------------------------------------------------------------------------

// yᵀ (J − S + A) x of a scene with the vectors of another.
static bough_status quotient(bough_arena *arena, bough_scene *scene, double time, const mode *of,
                             double value[2]) {
    bough_simulation *s;
    bough_equilibrium_work work;
    linear x;
    BOUGH_TRY(bough_simulation_build(arena, scene, &s));
    if (scene->modes.at == BOUGH_SCENE_IN_EQUILIBRIUM)
        BOUGH_TRY(bough_simulation_equilibrium(s, s->master->assembly, time, &work));
    BOUGH_TRY(prepare(arena, s, time, &x));
    size_t all = (size_t)of->all;
    double *part, *image, *both = bough_arena_doubles(arena, 2 * all);
    bough_arena_each(arena, all, &part, &image);
    for (size_t k = 0; k < 2; k++) {
        for (size_t i = 0; i < all; i++) part[i] = of->right[2 * i + k];
        BOUGH_TRY(multiply(&x, part, image));
        for (size_t i = 0; i < all; i++) both[2 * i + k] = image[i];
    }
    product(of->all, of->left, both, value);
    return bough_ok();
}

// dλ = yᵀ dA x/(yᵀ x), by the difference of scenes in which the parameter is greater and smaller.
static bough_status change_of(const bough_scene *scene, double time, const mode *of, const bough_parameter *p,
                              double change[2]) {
    double more[2] = {0, 0}, less[2] = {0, 0}, below[2];
    for (int side = 0; side < 2; side++) {
        bough_arena *own = bough_arena_create();
        bough_status status = quotient(own, bough_parameter_change(own, scene, p, (1 - 2 * side) * step),
                                       time, of, side == 0 ? more : less);
        bough_arena_destroy(own);
        if (!bough_is_ok(&status))
            return bough_fail(status.code, "%s changed: %.300s", p->name, status.message);
    }
    product(of->all, of->left, of->right, below);
    const double half[2] = {0.5 * (more[0] - less[0]) / step, 0.5 * (more[1] - less[1]) / step};
    divide(half, below, change);
    return bough_ok();
}

// Of |λ| and of the damping ratio −Re λ/|λ|.
static bough_sensitivity sensitivity_of(const double value[2], const double change[2],
                                        const bough_parameter *p) {
    double modulus = hypot(value[0], value[1]);
    double longer = (value[0] * change[0] + value[1] * change[1]) / (modulus * modulus);
    return (bough_sensitivity){.name = p->name,
                               .by = p->by,
                               .frequency = longer,
                               .damping = (value[0] * longer - change[0]) / modulus,
                               .eigenvalue = hypot(change[0], change[1]) / modulus};
}

static int larger(const void *a, const void *b) {
    const bough_sensitivity *x = a, *y = b;
    return (x->eigenvalue < y->eigenvalue) - (x->eigenvalue > y->eigenvalue);
}

bough_status bough_sensitivity_find(bough_arena *arena, bough_simulation *s, double time,
                                    const bough_scene_mode *of, bough_sensitivities *found) {
    linear system;
    int n_parameter;
    const bough_parameter *parameter = bough_parameters_of(arena, s->scene, &n_parameter);
    BOUGH_TRY(prepare(arena, s, time, &system));
    mode x = {.all = system.n + system.m, .value = {of->growth, 2 * BOUGH_PI * of->damped_frequency}};
    BOUGH_TRY(find_vectors(arena, &system, &x));
    *found = (bough_sensitivities){
        .residual = x.residual,
        .list = bough_arena_take(arena, ((size_t)n_parameter + 1) * sizeof *found->list)};
    for (int k = 0; k < n_parameter; k++) {
        double change[2] = {0, 0};
        BOUGH_TRY(change_of(s->scene, time, &x, &parameter[k], change));
        bough_sensitivity one = sensitivity_of(x.value, change, &parameter[k]);
        if (one.eigenvalue > least) found->list[found->n++] = one;
    }
    qsort(found->list, (size_t)found->n, sizeof *found->list, larger);
    return bough_ok();
}

#include "apps/bough/analysis/sensitivity.h"

#include "apps/bough/analysis/azimuth.h"
#include "core/base/linalg.h"

#include <complex.h>

static const double difference = 1e-3; // of the largest entry of a vector in units of its scale, and twice it
static const double step = 1e-3;   // of a parameter, in units of its change: with the shape of a slender rod
                                   // its modes stretch it, an error of the square of the step
static const double least = 1e-9;  // changes of λ relative to it are rounding
static const double exact = 1e-6;  // residual of an eigenvector
static const double beside = 1e-6; // of λ, relative: inverse iteration there does not separate equal λ
static const double complex imaginary = (double complex)I;

enum { ITERATIONS = 4 }; // of inverse iteration about an eigenvalue that is known to some digits

// The linear system J − S + A of theory (100) about one state, as products with vectors (n + m).
typedef struct linear {
    bough_simulation *simulation;
    bough_vibration_point point;
    bool in_air;                                // the air's forces follow the motion
    bough_azimuths azimuths;                    // A is the mean over these
    bough_air_change **air;                     // (azimuths.n)
    int n, m;                                   // states of the members, of the air
    int n_all;                                  // of a blade and its air
    const int *row;                             // (n_part × n_all) their rows among all
    double *scale;                              // (n)
    double *rate;                               // S (n_part × n_part), row-major
    double *moved, *side[2], *turned, *follows; // (n + m) work
} linear;

static bough_status prepare(bough_arena *arena, bough_simulation *s, double time, linear *x) {
    *x = (linear){.simulation = s, .n = s->assembly->n_state};
    BOUGH_TRY(bough_vibration_point_find(arena, s, time, &x->point));
    const bough_modes_def *def = &x->point.def;
    if (def->n_axes > 0)
        return bough_fail(BOUGH_INVALID,
                          "%.200s: sensitivities are not computed where bodies turn on free, spherical or "
                          "planar joints",
                          s->scene->file);
    x->in_air = bough_air_follows(s->scene);
    if (x->in_air) {
        BOUGH_TRY(bough_azimuths_find(arena, s, time, &x->point, &x->azimuths));
        x->air = bough_arena_take(arena, (size_t)x->azimuths.n * sizeof *x->air);
        for (int k = 0; k < x->azimuths.n; k++) {
            bough_air_azimuth of = bough_azimuths_air(&x->azimuths, k);
            x->air[k] = bough_air_change_create(arena, &of, &x->m);
        }
    }
    int n_air = x->in_air ? x->m / s->scene->turbine.n_blade : 0;
    x->n_all = def->n_row + n_air;
    x->row = bough_air_tangent_rows(arena, s, &x->point.group, n_air);
    size_t all = (size_t)(x->n + x->m) + 1;
    bough_arena_each(arena, all, &x->moved, &x->side[0], &x->side[1], &x->turned, &x->follows);
    x->scale = bough_arena_doubles(arena, all);
    bough_assembly_scales(s->assembly, x->scale);
    x->rate = bough_modes_rate(arena, def);
    return bough_ok();
}

static int row_of(const linear *x, int blade, int j) { return x->row[blade * x->n_all + j]; }

// Whether y has entries outside the blades and their air.
static bool moves_others(const linear *x, const double *y) {
    int moved = 0;
    for (int i = 0; i < x->n + x->m; i++) moved += y[i] != 0;
    for (int k = 0; k < x->point.def.n_part; k++)
        for (int j = 0; j < x->n_all; j++) moved -= y[row_of(x, k, j)] != 0;
    return moved > 0;
}

// The blades' entries of y, each those of the blade `shift` further on; 0 elsewhere.
static void take_blades(const linear *x, int shift, const double *y, double *to) {
    int n = x->point.def.n_part;
    memset(to, 0, (size_t)(x->n + x->m) * sizeof *to);
    for (int k = 0; k < n; k++)
        for (int j = 0; j < x->n_all; j++) to[row_of(x, k, j)] = y[row_of(x, (k + shift) % n, j)];
}

static void add_blades(const linear *x, int shift, double factor, const double *from, double *image) {
    int n = x->point.def.n_part;
    for (int k = 0; k < n; k++)
        for (int j = 0; j < x->n_all; j++)
            image[row_of(x, (k + shift) % n, j)] += factor * from[row_of(x, k, j)];
}

// Adds the part of one azimuth's air to A y; coupling between blades is its mean over the blades.
static bough_status add_azimuth(linear *x, bough_air_change *air, double size, const double *y,
                                double *image) {
    double share = 1. / x->azimuths.n;
    int shifts = x->point.def.spin != 0 ? x->point.def.n_part : 1;
    BOUGH_TRY(bough_air_change_follow(air, size, false, y, x->follows));
    for (int i = 0; i < x->n + x->m; i++) image[i] += share * x->follows[i];
    bool others = moves_others(x, y);
    for (int shift = 0; shift < shifts && shifts > 1; shift++) {
        take_blades(x, shift, y, x->turned);
        if (shift > 0 || others) BOUGH_TRY(bough_air_change_follow(air, size, false, x->turned, x->follows));
        add_blades(x, shift, share * (1. / shifts - (shift == 0)), x->follows, image);
    }
    return bough_ok();
}

// The factor of y in a difference; 0: y is 0.
static double size_of(const linear *x, const double *y) {
    double largest = bough_largest(x->n, y, x->scale);
    for (int i = x->n; i < x->n + x->m; i++) largest = fmax(largest, fabs(y[i]));
    return largest > 0 ? difference / largest : 0;
}

// image = (J − S) y by a difference of order 4: a transverse change of slender rods stretches segments, with
// a force that grows with its third power.
static bough_status multiply_members(linear *x, double size, const double *y, double *image) {
    static const double weight[] = {8. / 12, -1. / 12};
    const bough_vibration_point *p = &x->point;
    memset(image, 0, (size_t)(x->n + x->m) * sizeof *image);
    for (int times = 1; times <= 2; times++) {
        for (int side = 0; side < 2; side++) {
            double change = (2 * side - 1) * times * size;
            for (int i = 0; i < x->n; i++) x->moved[i] = p->state[i] + change * y[i];
            BOUGH_TRY(bough_whole_rate(p->whole, p->def.time, x->moved, x->side[side]));
        }
        for (int i = 0; i < x->n; i++) image[i] += weight[times - 1] * (x->side[1][i] - x->side[0][i]) / size;
    }
    bough_modes_add_rate(&p->def, x->rate, x->n_all, x->row, -1, y, image);
    return bough_ok();
}

// image = (J − S + A) y of a real vector that is not 0; states that are held stay.
static bough_status multiply(linear *x, const double *y, double *image) {
    double size = size_of(x, y);
    BOUGH_TRY(multiply_members(x, size, y, image));
    for (int k = 0; k < x->azimuths.n; k++) BOUGH_TRY(add_azimuth(x, x->air[k], size, y, image));
    for (int k = 0; k < x->point.n_held; k++) image[x->point.held[k]] = 0;
    return bough_ok();
}

// -- eigenvectors ---------------------------------------------------------------------------------

// A mode of the linear system. LAPACK's complex numbers are C's.
typedef struct mode {
    int all;
    double complex value;         // λ
    double complex *right, *left; // (all)
} mode;

static double complex *take_complex(bough_arena *arena, size_t n) {
    return bough_arena_take(arena, n * sizeof(double complex));
}

// Σ a b, not conjugated.
static double complex product(int n, const double complex *a, const double complex *b) {
    double complex sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

static double length_of(int n, const double complex *a) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += creal(a[i] * conj(a[i]));
    return sqrt(sum);
}

// The matrix by its columns. Rows of states of the air that never change are 0.
static bough_status fill(bough_arena *arena, linear *x, double *matrix) {
    size_t all = (size_t)(x->n + x->m);
    double *unit = bough_arena_doubles(arena, all);
    bough_air_tangent air;
    if (x->in_air) BOUGH_TRY(bough_azimuths_tangent(arena, &x->azimuths, &air));
    for (size_t j = 0; j < all; j++) {
        double *column = matrix + j * all;
        unit[j] = 1;
        BOUGH_TRY(multiply_members(x, size_of(x, unit), unit, column));
        for (size_t i = 0; i < all && x->in_air; i++) column[i] += air.matrix[j * all + i];
        for (int k = 0; k < x->point.n_held; k++) column[x->point.held[k]] = 0;
        unit[j] = 0;
    }
    for (int k = 0; k < x->point.n_held; k++)
        memset(matrix + (size_t)x->point.held[k] * all, 0, all * sizeof *matrix);
    return bough_ok();
}

// Eigenvectors of the matrix, or of its transposed one, about λ by inverse iteration from those given: vector
// (count × n).
static bool iterate(bough_arena *arena, int n, const double *matrix, bool transposed, double complex value,
                    int count, double complex *vector) {
    size_t all = (size_t)n;
    double complex *factor = take_complex(arena, all * all);
    int *pivot = bough_arena_take(arena, all * sizeof *pivot);
    for (size_t j = 0; j < all; j++)
        for (size_t i = 0; i < all; i++)
            factor[j * all + i] = transposed ? matrix[i * all + j] : matrix[j * all + i];
    for (size_t i = 0; i < all; i++) factor[i * all + i] -= (1 + beside) * value;
    if (!bough_complex_factor(n, (double *)factor, pivot)) return false;
    for (int k = 0; k < ITERATIONS * count; k++) {
        double complex *x = vector + (size_t)(k % count) * all;
        bough_complex_solve(n, (double *)factor, pivot, (double *)x);
        double size = length_of(n, x);
        if (!isfinite(size)) return false;
        for (size_t i = 0; i < all; i++) x[i] /= size;
    }
    return true;
}

static void start(int n, int seed, double complex *vector) {
    for (int i = 0; i < n; i++) vector[i] = 1.1 + sin(seed + 7 * i) + imaginary * cos(seed + 5 * i);
}

// Whether two vectors found for one eigenvalue differ: several modes then have it.
static bool differ(int n, const double complex *a, const double complex *b) {
    double complex sum = 0;
    for (int i = 0; i < n; i++) sum += conj(a[i]) * b[i];
    return cabs(sum) < 0.99;
}

// λ by the quotient of both vectors; its residual relative to |λ|, 0 where that is rounding of the product.
static double improve(bough_arena *arena, const double *matrix, mode *x) {
    static const double rounding = 1e-14;
    size_t all = (size_t)x->all;
    double complex *image = take_complex(arena, 2 * all), *terms = image + all;
    for (size_t j = 0; j < all; j++) {
        for (size_t i = 0; i < all; i++) {
            image[i] += matrix[j * all + i] * x->right[j];
            terms[i] += fabs(matrix[j * all + i]) * cabs(x->right[j]);
        }
    }
    x->value = product(x->all, x->left, image) / product(x->all, x->left, x->right);
    for (size_t i = 0; i < all; i++) image[i] -= x->value * x->right[i];
    double residual = length_of(x->all, image);
    return residual > rounding * length_of(x->all, terms) ? residual / cabs(x->value) : 0;
}

static bough_status find_vectors(bough_arena *arena, linear *system, mode *x) {
    size_t all = (size_t)x->all;
    double *matrix = bough_arena_doubles(arena, all * all);
    x->right = take_complex(arena, 2 * all);
    x->left = take_complex(arena, all);
    double complex *second = x->right + all;
    BOUGH_TRY(fill(arena, system, matrix));
    start(x->all, 1, x->right);
    start(x->all, 3, second);
    start(x->all, 2, x->left);
    bool found = iterate(arena, x->all, matrix, false, x->value, 2, x->right) &&
                 iterate(arena, x->all, matrix, true, x->value, 1, x->left);
    if (found && differ(x->all, x->right, second))
        return bough_fail(BOUGH_INVALID, "the sensitivity of one of several modes with one eigenvalue is not "
                                         "defined: their shapes mix");
    if (!found || !(improve(arena, matrix, x) < exact))
        return bough_fail(BOUGH_FAILED, "the eigenvector of the mode does not converge");
    return bough_ok();
}

// -- parameters -----------------------------------------------------------------------------------

// yᵀ (J − S + A) x of a scene with the vectors of another.
static bough_status quotient(bough_arena *arena, bough_scene *scene, double time, const mode *of,
                             double complex *value) {
    bough_simulation *s;
    linear x;
    BOUGH_TRY(bough_simulation_build(arena, scene, &s));
    if (scene->modes.at == BOUGH_SCENE_IN_EQUILIBRIUM)
        BOUGH_TRY(bough_simulation_equilibrium(s, time, 0, NULL));
    BOUGH_TRY(prepare(arena, s, time, &x));
    double *part, *image;
    bough_arena_each(arena, (size_t)of->all, &part, &image);
    *value = 0;
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < of->all; i++) part[i] = k == 0 ? creal(of->right[i]) : cimag(of->right[i]);
        if (size_of(&x, part) == 0) continue;
        BOUGH_TRY(multiply(&x, part, image));
        for (int i = 0; i < of->all; i++) *value += (k == 0 ? 1 : imaginary) * of->left[i] * image[i];
    }
    return bough_ok();
}

// theory (108), by the difference of scenes in which the parameter is greater and smaller.
static bough_status change_of(bough_arena *arena, const bough_scene *scene, double time, const mode *of,
                              const bough_parameter *p, double complex *change) {
    double complex value[2] = {0, 0};
    for (int side = 0; side < 2; side++) {
        bough_arena *own = bough_arena_child(arena);
        bough_scene *other = bough_parameter_change(own, scene, p, (1 - 2 * side) * step);
        bough_status status = quotient(own, other, time, of, &value[side]);
        bough_arena_destroy(own);
        if (!bough_is_ok(&status))
            return bough_fail(status.code, "%s changed: %.300s", p->name, status.message);
    }
    *change = (value[0] - value[1]) / (2 * step * product(of->all, of->left, of->right));
    return bough_ok();
}

// Of |λ| and of the damping ratio −Re λ/|λ|.
static bough_sensitivity sensitivity_of(double complex value, double complex change,
                                        const bough_parameter *p) {
    double modulus = cabs(value), longer = creal(change / value);
    return (bough_sensitivity){.name = p->name,
                               .by = p->by,
                               .frequency = longer,
                               .damping = (creal(value) * longer - creal(change)) / modulus,
                               .eigenvalue = cabs(change) / modulus};
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
    mode x = {.all = system.n + system.m,
              .value = of->growth + 2 * BOUGH_PI * imaginary * of->damped_frequency};
    BOUGH_TRY(find_vectors(arena, &system, &x));
    *found = (bough_sensitivities){
        .list = bough_arena_take(arena, ((size_t)n_parameter + 1) * sizeof *found->list)};
    for (int k = 0; k < n_parameter; k++) {
        double complex change = 0;
        BOUGH_TRY(change_of(arena, s->scene, time, &x, &parameter[k], &change));
        bough_sensitivity one = sensitivity_of(x.value, change, &parameter[k]);
        if (one.eigenvalue > least) found->list[found->n++] = one;
    }
    qsort(found->list, (size_t)found->n, sizeof *found->list, larger);
    return bough_ok();
}

// theory (109). The blades' states are in harmonics wherever they are not said to be of blade after blade.
#include "apps/bough/analysis/rotor_inverse.h"

#include "core/base/base.h"
#include "core/base/linalg.h"

#include <math.h>
#include <string.h>

// The blades' own parts of P differ with their loads, and so does the system with the azimuth. Where a test
// vector misses the equations by no more, relative, their mean stands for them. Its transpose is exact.
static const double alike = 1e-4, exact = 1e-9;

enum { MOST = 64 }; // vectors at once

struct bough_rotor_inverse {
    const bough_aeroelastic *system;
    int n, n_part, r, n_other; // states; blades, states of each; the others that are not held
    int *other;                // (n_other)
    double gamma;
    double *harmonic; // (n_part × n_part) orthonormal: row p of blade k's share; 1, then cos and sin
    // all column-major
    double *blade;          // P of one blade by itself (r × r)
    double **same, **cross; // D (r × r) of each harmonic: on itself; of the sine on the cosine, NULL: none
    double *from, *to;      // V (n_other × n_part r), W K⁻¹ (n_part r × n_other)
    double *others;         // P_oo K⁻¹ (n_other × n_other)
    // scratch of MOST vectors: harmonics of arguments, of images, of the part that couples cosine and sine;
    // g of apply, and P_oo g
    double *argument, *image, *crossed, *force, *moved;
};

// A matrix of the air in blocks: rows and columns of the blades by harmonics, and of the others.
typedef struct blocks {
    double *between;        // γ (S − A), others × n_part r
    double *onto;           // n_part r × others
    double *among;          // others × others, with what holds free joints
    double **same, **cross; // one blade's, of each harmonic (r × r): on itself, of the sine on the cosine
    double (*spin)[2];      // of γS, this times E; added to both when the blades are factored
} blocks;

static size_t square(int n) { return (size_t)n * (size_t)n; }

// First part of harmonic m among the rows of `harmonic`, and how many it has.
static int first_of(int m) { return m == 0 ? 0 : 2 * m - 1; }
static int parts_of(const bough_rotor_inverse *x, int m) { return m == 0 || 2 * m == x->n_part ? 1 : 2; }
static int n_harmonic(const bough_rotor_inverse *x) { return x->n_part / 2 + 1; }

static void set_harmonics(bough_rotor_inverse *x) {
    int n = x->n_part;
    for (int m = 0; m < n_harmonic(x); m++) {
        double size = sqrt((double)parts_of(x, m) / n);
        for (int k = 0; k < n; k++) {
            double angle = 2 * BOUGH_PI * m * k / n;
            x->harmonic[first_of(m) * n + k] = size * cos(angle);
            if (parts_of(x, m) == 2) x->harmonic[(first_of(m) + 1) * n + k] = size * sin(angle);
        }
    }
}

// Harmonics of vectors over the blades (columns × n_state) → (n_part × columns × r), or back.
static void to_harmonics(const bough_rotor_inverse *x, int columns, const double *z, double *hat) {
    size_t r = (size_t)x->r;
    for (int p = 0; p < x->n_part; p++) {
        for (int c = 0; c < columns; c++) {
            double *sum = hat + ((size_t)p * (size_t)columns + (size_t)c) * r;
            memset(sum, 0, r * sizeof *sum);
            for (int k = 0; k < x->n_part; k++) {
                const double *from = z + (size_t)c * (size_t)x->n + x->system->def->row[k * x->r];
                for (size_t j = 0; j < r; j++) sum[j] += x->harmonic[p * x->n_part + k] * from[j];
            }
        }
    }
}

static void from_harmonics(const bough_rotor_inverse *x, int columns, const double *hat, double *z) {
    size_t r = (size_t)x->r;
    for (int k = 0; k < x->n_part; k++) {
        for (int c = 0; c < columns; c++) {
            double *sum = z + (size_t)c * (size_t)x->n + x->system->def->row[k * x->r];
            memset(sum, 0, r * sizeof *sum);
            for (int p = 0; p < x->n_part; p++) {
                const double *from = hat + ((size_t)p * (size_t)columns + (size_t)c) * r;
                for (size_t j = 0; j < r; j++) sum[j] += x->harmonic[p * x->n_part + k] * from[j];
            }
        }
    }
}

// hat (n_part × columns × r) ← D of it, or Dᵀ.
static void apply_blades(const bough_rotor_inverse *x, bool transposed, int columns, const double *argument,
                         double *crossed, double *image) {
    size_t size = (size_t)columns * (size_t)x->r;
    for (int m = 0; m < n_harmonic(x); m++) {
        int parts = parts_of(x, m);
        const double *a = argument + (size_t)first_of(m) * size;
        double *to = image + (size_t)first_of(m) * size;
        bough_product p = {x->r, parts * columns, x->r, transposed, 1, 0};
        bough_dense_product(p, x->same[m], a, to);
        if (parts == 1) continue;
        bough_dense_product(p, x->cross[m], a, crossed);
        double sign = transposed ? -1 : 1;
        for (size_t i = 0; i < size; i++) {
            to[i] += sign * crossed[size + i];
            to[size + i] -= sign * crossed[i];
        }
    }
}

// -- the parts of P -------------------------------------------------------------------------------

static bool find_others(bough_arena *arena, bough_rotor_inverse *x) {
    const bough_modes_def *def = x->system->def;
    const bough_whole *whole = x->system->whole;
    bool *taken = bough_arena_take(arena, (size_t)x->n * sizeof *taken);
    x->other = bough_arena_take(arena, ((size_t)x->n + 1) * sizeof *x->other);
    for (int i = 0; i < def->n_part * def->n_row; i++) taken[def->row[i]] = true;
    for (int i = 0; i < whole->n_held; i++) {
        if (taken[whole->held[i]]) return false;
        taken[whole->held[i]] = true;
    }
    for (int i = 0; i < x->n; i++)
        if (!taken[i]) x->other[x->n_other++] = i;
    return true;
}

// P of a blade, all others at rest: the mean of theirs, which their loads make differ.
static void set_blade(bough_rotor_inverse *x, double *column) {
    const bough_whole *whole = x->system->whole;
    size_t r = (size_t)x->r;
    for (int k = 0; k < x->n_part; k++) {
        int member = x->system->group->blade[k]->port + 1;
        for (size_t j = 0; j < r; j++) {
            memset(column, 0, r * sizeof *column);
            column[j] = 1;
            bough_interface_solve_member(whole->interface, member, column);
            for (size_t i = 0; i < r; i++) x->blade[j * r + i] += column[i] / x->n_part;
        }
    }
}

// Columns of P (n × n_other), and its rows of the others from forces on the blades as `rows`
// (n_other × n_part r).
static void set_borders(const bough_rotor_inverse *x, double *work, double *columns, double *rows) {
    size_t n = (size_t)x->n, n_other = (size_t)x->n_other;
    for (size_t j = 0; j < n_other; j++) {
        columns[j * n + (size_t)x->other[j]] = 1;
        bough_whole_solve(x->system->whole, columns + j * n);
    }
    for (size_t j = 0; j < (size_t)x->n_part * (size_t)x->r; j++) {
        memset(work, 0, n * sizeof *work);
        work[x->system->def->row[j]] = 1;
        bough_whole_solve(x->system->whole, work);
        for (size_t i = 0; i < n_other; i++) rows[j * n_other + i] = work[x->other[i]];
    }
}

// Columns of blade after blade (rows × n_part r) → harmonics.
static void columns_to_harmonics(bough_arena *arena, const bough_rotor_inverse *x, int rows, double *matrix) {
    size_t block = (size_t)rows * (size_t)x->r;
    double *copy = bough_arena_copy(arena, matrix, (size_t)x->n_part * block * sizeof *copy);
    memset(matrix, 0, (size_t)x->n_part * block * sizeof *matrix);
    for (int p = 0; p < x->n_part; p++) {
        for (int k = 0; k < x->n_part; k++) {
            const double *from = copy + (size_t)k * block;
            double *to = matrix + (size_t)p * block;
            for (size_t i = 0; i < block; i++) to[i] += x->harmonic[p * x->n_part + k] * from[i];
        }
    }
}

// -- the parts of γ (S − A) -----------------------------------------------------------------------

// Of one harmonic: Σ_d (block of blades 0, d) cos and sin of m times their angle; of γS, `spin`.
static void sum_harmonic(const bough_rotor_inverse *x, int m, const double *rate, double *same, double *cross,
                         double spin[2]) {
    const bough_modes_def *def = x->system->def;
    const double *a = x->system->air->motion;
    size_t n = (size_t)x->n, r = (size_t)x->r;
    for (int d = 0; d < x->n_part; d++) {
        double angle = 2 * BOUGH_PI * m * d / x->n_part, c = x->gamma * cos(angle), s = x->gamma * sin(angle);
        spin[0] += c * rate[d];
        spin[1] += s * rate[d];
        for (size_t j = 0; j < r; j++) {
            const double *from = a + (size_t)def->row[(size_t)d * r + j] * n + def->row[0];
            for (size_t i = 0; i < r; i++) {
                same[j * r + i] -= c * from[i];
                if (cross) cross[j * r + i] -= s * from[i];
            }
        }
    }
}

static void sum_harmonics(bough_arena *arena, const bough_rotor_inverse *x, blocks *b) {
    double *rate = bough_arena_doubles(arena, square(x->n_part));
    if (x->system->def->spin != 0) bough_modes_rate(x->system->def, rate);
    for (int m = 0; m < n_harmonic(x); m++) {
        b->same[m] = bough_arena_doubles(arena, square(x->r));
        if (parts_of(x, m) == 2) b->cross[m] = bough_arena_doubles(arena, square(x->r));
        sum_harmonic(x, m, rate, b->same[m], b->cross[m], b->spin[m]);
    }
}

static void add_spin(const bough_rotor_inverse *x, const blocks *b) {
    size_t r = (size_t)x->r;
    for (int m = 0; m < n_harmonic(x); m++) {
        for (size_t j = 0; j < r; j++) b->same[m][j * r + j] += b->spin[m][0];
        for (size_t j = 0; j < r && b->cross[m]; j++) b->cross[m][j * r + j] += b->spin[m][1];
    }
}

// Where the others take part; `going_back`: of the joints' coordinates.
static void sum_others(bough_arena *arena, const bough_rotor_inverse *x, double going_back, blocks *b) {
    const double *a = x->system->air->motion;
    size_t n = (size_t)x->n, n_other = (size_t)x->n_other, all = (size_t)x->n_part * (size_t)x->r;
    const int *row = x->system->def->row;
    double *column = bough_arena_doubles(arena, n * n_other + 1);
    for (size_t j = 0; j < all; j++) {
        for (size_t i = 0; i < n_other; i++)
            b->between[j * n_other + i] = -x->gamma * a[(size_t)row[j] * n + (size_t)x->other[i]];
    }
    columns_to_harmonics(arena, x, x->n_other, b->between);
    for (size_t j = 0; j < n_other; j++) {
        for (size_t i = 0; i < n; i++) column[j * n + i] = -x->gamma * a[(size_t)x->other[j] * n + i];
        for (size_t i = 0; i < n_other; i++) b->among[j * n_other + i] = column[j * n + (size_t)x->other[i]];
        if (x->other[j] < x->system->simulation->tree->n_q) b->among[j * n_other + j] += going_back;
    }
    to_harmonics(x, x->n_other, column, b->onto);
}

// -- the blades by harmonics ----------------------------------------------------------------------

// to (r × r) = P of one blade times part (r × r), whose rows without entries are left out, and spin E.
static void multiply_blade(bough_arena *arena, const bough_rotor_inverse *x, const double *part, double spin,
                           double *to) {
    size_t r = (size_t)x->r, rows = 0;
    int *row = bough_arena_take(arena, r * sizeof *row);
    double *columns, *used;
    bough_arena_each(arena, r * r, &columns, &used);
    for (size_t i = 0; i < r; i++) {
        bool zero = true;
        for (size_t j = 0; j < r && zero; j++) zero = part[j * r + i] == 0;
        if (!zero) row[rows++] = (int)i;
    }
    for (size_t i = 0; i < rows; i++) {
        memcpy(columns + i * r, x->blade + (size_t)row[i] * r, r * sizeof *columns);
        for (size_t j = 0; j < r; j++) used[j * rows + i] = part[j * r + (size_t)row[i]];
    }
    memcpy(to, x->blade, r * r * sizeof *to);
    bough_dense_product((bough_product){x->r, x->r, (int)rows, false, 1, spin}, columns, used, to);
}

// Columns with `parts` times r rows, from those of part after part, or to them.
static void join(size_t r, size_t parts, size_t columns, const double *separate, double *joined) {
    for (size_t p = 0; p < parts; p++) {
        for (size_t j = 0; j < columns; j++)
            memcpy(joined + (j * parts + p) * r, separate + (p * columns + j) * r, r * sizeof *joined);
    }
}

static void split(size_t r, size_t parts, size_t columns, const double *joined, double *separate) {
    for (size_t p = 0; p < parts; p++) {
        for (size_t j = 0; j < columns; j++)
            memcpy(separate + (p * columns + j) * r, joined + (j * parts + p) * r, r * sizeof *separate);
    }
}

// T = E + P γ(S − A) of a harmonic, (parts r)².
static double *blade_matrix(bough_arena *arena, const bough_rotor_inverse *x, int m, const blocks *b) {
    size_t r = (size_t)x->r, parts = (size_t)parts_of(x, m), q = parts * r;
    double *t = bough_arena_doubles(arena, q * q), *product = bough_arena_doubles(arena, r * r);
    for (size_t cross = 0; cross < parts; cross++) {
        multiply_blade(arena, x, cross ? b->cross[m] : b->same[m], b->spin[m][cross], product);
        for (size_t p = 0; p < parts; p++) {
            // rows of the cosine and columns of the sine, or with the other sign the other way round
            size_t other = cross ? 1 - p : p;
            double sign = cross && p == 1 ? -1 : 1;
            for (size_t j = 0; j < r; j++) {
                for (size_t i = 0; i < r; i++) t[(other * r + j) * q + p * r + i] = sign * product[j * r + i];
            }
        }
    }
    for (size_t i = 0; i < q; i++) t[i * q + i] += 1;
    return t;
}

// D = T⁻¹ P of each harmonic, and `to` (n_part × n_other × r), the blades' part of P, ← T⁻¹ of it.
static bool factor_blades(bough_arena *arena, bough_rotor_inverse *x, const blocks *b) {
    size_t r = (size_t)x->r, n_other = (size_t)x->n_other;
    for (int m = 0; m < n_harmonic(x); m++) {
        bough_arena *own = bough_arena_child(arena);
        size_t parts = (size_t)parts_of(x, m), q = parts * r;
        double *t = blade_matrix(own, x, m, b), *border = x->to + (size_t)first_of(m) * n_other * r;
        double *right = bough_arena_doubles(own, q * (r + n_other));
        int *pivot = bough_arena_take(own, q * sizeof *pivot);
        for (size_t j = 0; j < r; j++) memcpy(right + j * q, x->blade + j * r, r * sizeof *right);
        join(r, parts, n_other, border, right + r * q);
        bool regular = bough_dense_factor((int)q, t, pivot);
        if (regular) bough_dense_solve((int)q, (int)(r + n_other), t, pivot, right);
        split(r, parts, n_other, right + r * q, border);
        for (size_t j = 0; j < r; j++) {
            memcpy(x->same[m] + j * r, right + j * q, r * sizeof *right);
            for (size_t i = 0; i < r && parts == 2; i++) x->cross[m][j * r + i] = -right[j * q + r + i];
        }
        bough_arena_destroy(own);
        if (!regular) return false;
    }
    return true;
}

// -- the border -----------------------------------------------------------------------------------

// c += factor a N, a and c (n_other × n_part r) and N in blocks of the harmonics.
static void multiply_right(const bough_rotor_inverse *x, double factor, const double *a, double *const *same,
                           double *const *cross, double *c) {
    size_t block = (size_t)x->n_other * (size_t)x->r;
    for (int m = 0; m < n_harmonic(x); m++) {
        int parts = parts_of(x, m);
        const double *from = a + (size_t)first_of(m) * block;
        double *to = c + (size_t)first_of(m) * block;
        for (int p = 0; p < parts; p++) {
            bough_product direct = {x->n_other, x->r, x->r, false, factor, 1}, across = direct;
            bough_dense_product(direct, from + (size_t)p * block, same[m], to + (size_t)p * block);
            if (parts == 1) continue;
            across.factor = p == 1 ? factor : -factor;
            bough_dense_product(across, from + (size_t)(1 - p) * block, cross[m], to + (size_t)p * block);
        }
    }
}

static double *transpose(bough_arena *arena, int rows, int columns, const double *a) {
    double *b = bough_arena_doubles(arena, (size_t)rows * (size_t)columns);
    for (int j = 0; j < columns; j++) {
        for (int i = 0; i < rows; i++)
            b[(size_t)i * (size_t)columns + (size_t)j] = a[(size_t)j * (size_t)rows + (size_t)i];
    }
    return b;
}

// a (rows × n) ← a K⁻¹ by the factors of Kᵀ.
static void divide(bough_arena *arena, int rows, int n, const double *factor, const int *pivot, double *a) {
    double *b = transpose(arena, rows, n, a);
    bough_dense_solve(n, rows, factor, pivot, b);
    double *c = transpose(arena, n, rows, b);
    memcpy(a, c, (size_t)rows * (size_t)n * sizeof *a);
}

// W = T⁻¹ P_bo − D γ(S − A)_bo P_oo
static void set_response(bough_arena *arena, bough_rotor_inverse *x, const blocks *b) {
    size_t block = (size_t)x->n_other * (size_t)x->r, all = block * (size_t)x->n_part;
    double *force, *crossed, *response;
    bough_arena_each(arena, all + 1, &force, &crossed, &response);
    for (int p = 0; p < x->n_part; p++)
        bough_dense_product((bough_product){x->r, x->n_other, x->n_other, false, 1, 0},
                            b->onto + (size_t)p * block, x->others, force + (size_t)p * block);
    apply_blades(x, false, x->n_other, force, crossed, response);
    for (size_t i = 0; i < all; i++) x->to[i] -= response[i];
}

// V = Y − R D, K = E + R W + (Y γ(S − A)_bo + γ(S − A)_oo) P_oo with R = γ (Y (S − A)_bb + (S − A)_ob); Y,
// what forces on the blades do to the others, is in x->from. Then W and P_oo by K.
static bool close_border(bough_arena *arena, bough_rotor_inverse *x, const blocks *b) {
    size_t n_other = (size_t)x->n_other, block = n_other * (size_t)x->r;
    int n = x->n_other, *pivot = bough_arena_take(arena, (n_other + 1) * sizeof *pivot);
    double *k = bough_arena_doubles(arena, square(n) + 1), *rest = b->between;
    bough_product by_blade = {n, n, x->r, false, 1, 1};
    multiply_right(x, 1, x->from, b->same, b->cross, rest);
    for (int p = 0; p < x->n_part; p++)
        bough_dense_product(by_blade, x->from + (size_t)p * block, b->onto + (size_t)p * block, b->among);
    bough_dense_product((bough_product){n, n, n, false, 1, 0}, b->among, x->others, k);
    for (int p = 0; p < x->n_part; p++)
        bough_dense_product(by_blade, rest + (size_t)p * block, x->to + (size_t)p * block, k);
    for (size_t i = 0; i < n_other; i++) k[i * n_other + i] += 1;
    multiply_right(x, -1, rest, x->same, x->cross, x->from);
    double *factor = transpose(arena, n, n, k);
    if (!bough_dense_factor(n, factor, pivot)) return false;
    for (int p = 0; p < x->n_part; p++) divide(arena, x->r, n, factor, pivot, x->to + (size_t)p * block);
    divide(arena, n, n, factor, pivot, x->others);
    return true;
}

// P_oo and, with it, Y from the rows of P.
static bool set_others(bough_arena *arena, bough_rotor_inverse *x, const double *columns) {
    size_t n_other = (size_t)x->n_other;
    int *pivot = bough_arena_take(arena, (n_other + 1) * sizeof *pivot);
    for (size_t j = 0; j < n_other; j++) {
        for (size_t i = 0; i < n_other; i++)
            x->others[j * n_other + i] = columns[j * (size_t)x->n + (size_t)x->other[i]];
    }
    double *factor = bough_arena_copy(arena, x->others, square(x->n_other) * sizeof *factor);
    if (!bough_dense_factor(x->n_other, factor, pivot)) return false;
    bough_dense_solve(x->n_other, x->n_part * x->r, factor, pivot, x->from);
    columns_to_harmonics(arena, x, x->n_other, x->from);
    return true;
}

static bool set(bough_arena *arena, bough_rotor_inverse *x, double going_back) {
    size_t n = (size_t)x->n, n_other = (size_t)x->n_other, all = (size_t)x->n_part * (size_t)x->r;
    blocks b = {0};
    double *columns = bough_arena_doubles(arena, n * n_other + 1);
    bough_arena_each(arena, all * n_other + 1, &b.between, &b.onto);
    b.among = bough_arena_doubles(arena, square(x->n_other) + 1);
    b.spin = bough_arena_take(arena, (size_t)n_harmonic(x) * sizeof *b.spin);
    b.same = bough_arena_take(arena, (size_t)n_harmonic(x) * sizeof *b.same);
    b.cross = bough_arena_take(arena, (size_t)n_harmonic(x) * sizeof *b.cross);
    double *work = bough_arena_doubles(arena, n);
    set_blade(x, work);
    set_borders(x, work, columns, x->from);
    sum_harmonics(arena, x, &b);
    sum_others(arena, x, going_back, &b);
    to_harmonics(x, x->n_other, columns, x->to);
    if (!set_others(arena, x, columns) || !factor_blades(arena, x, &b)) return false;
    add_spin(x, &b);
    set_response(arena, x, &b);
    return close_border(arena, x, &b);
}

// -- test -----------------------------------------------------------------------------------------

// z − γ (S − A) y − going_back y, y by the inverse: the forces of which y is the solution.
static void find_force(bough_arena *arena, const bough_rotor_inverse *x, double going_back, const double *y,
                       double *z) {
    const bough_modes_def *def = x->system->def;
    double *rate = bough_arena_doubles(arena, square(x->n_part));
    bough_dense_product((bough_product){x->n, 1, x->n, false, x->gamma, 1}, x->system->air->motion, y, z);
    if (def->spin != 0) bough_modes_rate(def, rate);
    for (int k = 0; k < x->n_part; k++) {
        for (int l = 0; l < x->n_part; l++) {
            for (int j = 0; j < x->r; j++)
                z[def->row[k * x->r + j]] -= x->gamma * rate[k * x->n_part + l] * y[def->row[l * x->r + j]];
        }
    }
    for (int i = 0; i < x->system->simulation->tree->n_q; i++) z[i] -= going_back * y[i];
}

// Whether one vector's image solves the equations of the whole, and the transpose is one.
static bool is_exact(bough_arena *arena, bough_rotor_inverse *x, double going_back) {
    const bough_whole *whole = x->system->whole;
    double *scale, *z, *y, *left, *image, error = 0, size = 0, product = 0, both = 0;
    bough_arena_each(arena, (size_t)x->n, &scale, &z, &y, &left, &image);
    bough_assembly_scales(whole->assembly, scale);
    for (int i = 0; i < x->n; i++) z[i] = scale[i] * sin(1 + 7.3 * i), left[i] = cos(2 + 5.1 * i) / scale[i];
    bough_whole_project(whole, x->system->def->state, z);
    bough_rotor_inverse_apply(x, false, 1, z, y);
    bough_rotor_inverse_apply(x, true, 1, left, image);
    for (int i = 0; i < x->n; i++) {
        product += left[i] * y[i] - image[i] * z[i];
        both += fabs(left[i] * y[i]);
    }
    find_force(arena, x, going_back, y, z);
    bough_whole_solve(x->system->whole, z);
    bough_whole_project(whole, x->system->def->state, z);
    for (int i = 0; i < x->n; i++) {
        error = fmax(error, fabs(z[i] - y[i]) / scale[i]);
        size = fmax(size, fabs(y[i]) / scale[i]);
    }
    return error <= alike * size && fabs(product) <= exact * both;
}

// -- whole ----------------------------------------------------------------------------------------

static void take(bough_arena *arena, bough_rotor_inverse *x) {
    size_t r = (size_t)x->r, all = (size_t)x->n_part * r, n_other = (size_t)x->n_other;
    x->harmonic = bough_arena_doubles(arena, square(x->n_part));
    x->blade = bough_arena_doubles(arena, r * r);
    x->same = bough_arena_take(arena, (size_t)n_harmonic(x) * sizeof *x->same);
    x->cross = bough_arena_take(arena, (size_t)n_harmonic(x) * sizeof *x->cross);
    for (int m = 0; m < n_harmonic(x); m++) {
        x->same[m] = bough_arena_doubles(arena, r * r);
        if (parts_of(x, m) == 2) x->cross[m] = bough_arena_doubles(arena, r * r);
    }
    bough_arena_each(arena, all * n_other + 1, &x->from, &x->to);
    x->others = bough_arena_doubles(arena, square(x->n_other) + 1);
    bough_arena_each(arena, all * MOST, &x->argument, &x->image, &x->crossed);
    bough_arena_each(arena, n_other * MOST + 1, &x->force, &x->moved);
}

bough_rotor_inverse *bough_rotor_inverse_create(bough_arena *arena, const bough_aeroelastic *system,
                                                double going_back) {
    const bough_modes_def *def = system->def;
    if (def->n_part < 2) return NULL;
    bough_rotor_inverse *x = bough_arena_take(arena, sizeof *x);
    *x = (bough_rotor_inverse){.system = system,
                               .n = system->air->n,
                               .n_part = def->n_part,
                               .r = def->n_row,
                               .gamma = 1 / def->point};
    if (!find_others(arena, x)) return NULL;
    take(arena, x);
    set_harmonics(x);
    bough_arena *own = bough_arena_child(arena);
    bool good = set(own, x, going_back) && is_exact(own, x, going_back);
    bough_arena_destroy(own);
    return good ? x : NULL;
}

// The others' entries of vectors (n × n_state).
static void gather(const bough_rotor_inverse *x, int n, const double *z, double *force) {
    for (int c = 0; c < n; c++) {
        for (int i = 0; i < x->n_other; i++)
            force[c * x->n_other + i] = z[(size_t)c * (size_t)x->n + (size_t)x->other[i]];
    }
}

static void scatter(const bough_rotor_inverse *x, int n, const double *force, double *z) {
    for (int c = 0; c < n; c++) {
        for (int i = 0; i < x->n_other; i++)
            z[(size_t)c * (size_t)x->n + (size_t)x->other[i]] = force[c * x->n_other + i];
    }
}

static void project(const bough_rotor_inverse *x, int n, double *z) {
    for (int c = 0; c < n; c++)
        bough_whole_project(x->system->whole, x->system->def->state, z + (size_t)c * (size_t)x->n);
}

// g ← P_oo g, or its transpose.
static void multiply_others(const bough_rotor_inverse *x, bool transposed, int n) {
    bough_product p = {x->n_other, n, x->n_other, transposed, 1, 0};
    bough_dense_product(p, x->others, x->force, x->moved);
    memcpy(x->force, x->moved, (size_t)n * (size_t)x->n_other * sizeof *x->force);
}

// y_b = D z_b + W g, y_o = P_oo g, g = V z_b + z_o (K in W and P_oo), then projected. The transpose takes the
// steps in the other order: y_b = Dᵀ z_b + Vᵀ g, y_o = g = Wᵀ z_b + P_ooᵀ z_o; the projection is its own.
static void apply(const bough_rotor_inverse *x, bool transposed, int n, const double *z, double *image) {
    size_t block = (size_t)x->n_other * (size_t)x->r, size = (size_t)n * (size_t)x->r;
    const double *in = transposed ? x->to : x->from, *out = transposed ? x->from : x->to;
    memcpy(image, z, (size_t)n * (size_t)x->n * sizeof *image);
    if (transposed) project(x, n, image);
    to_harmonics(x, n, image, x->argument);
    gather(x, n, image, x->force);
    if (transposed) multiply_others(x, true, n);
    // g from the blades, then the blades' own part and that from g
    for (int p = 0; p < x->n_part; p++)
        bough_dense_product((bough_product){x->n_other, n, x->r, transposed, 1, 1}, in + (size_t)p * block,
                            x->argument + (size_t)p * size, x->force);
    apply_blades(x, transposed, n, x->argument, x->crossed, x->image);
    for (int p = 0; p < x->n_part; p++)
        bough_dense_product((bough_product){x->r, n, x->n_other, transposed, 1, 1}, out + (size_t)p * block,
                            x->force, x->image + (size_t)p * size);
    if (!transposed) multiply_others(x, false, n);
    memset(image, 0, (size_t)n * (size_t)x->n * sizeof *image); // what is held stays at rest
    from_harmonics(x, n, x->image, image);
    scatter(x, n, x->force, image);
    if (!transposed) project(x, n, image);
}

void bough_rotor_inverse_apply(bough_rotor_inverse *x, bool transposed, int n, const double *z,
                               double *image) {
    for (int begin = 0; begin < n; begin += MOST) {
        size_t at = (size_t)begin * (size_t)x->n;
        apply(x, transposed, n - begin < MOST ? n - begin : MOST, z + at, image + at);
    }
}

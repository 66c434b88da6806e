// theory (116). The blades' states are harmonics unless a comment says that they are of blade after blade.
#include "apps/bough/analysis/air_inverse.h"

#include "core/base/linalg.h"

enum {
    STATES = BOUGH_ROD_STATES, // of a vertex
    SLOW = BOUGH_ROD_U,        // those of them that are kinematic: position and rotation
};

// One product of harmonics: this part of a matrix times one of an argument, and its sign with columns and
// with rows (or by the transpose). A matrix of a cosine and a sine is (a, b; −b, a), its parts a and b.
typedef struct term {
    int image, matrix, argument;
    double sign[2];
} term;

struct bough_blade_inverse {
    const bough_aeroelastic *system;
    int n, n_part, r;        // states of all members; blades, states of each
    int n_vertex, n_slow, d; // of a blade: vertices, kinematic states (k), behind them the dynamic ones (d)
    double gamma;
    double *harmonic; // (n_part × n_part) orthonormal: row p of blade k's share; 1, then cos and sin
    int n_term;
    term *term; // (n_term)
    // all column-major but for F
    double *air;       // rows d of −γA_bb (n_part × d × r)
    double *spin;      // γS_bb, this times E (n_part)
    double *dynamic;   // D_d (n_part × d × r)
    double *kinematic; // F (n_part × 7 × 13 × n_vertex)
};

// The parts of P of one blade by itself that are used.
typedef struct alone {
    double *dynamic; // rows d (d × r)
    double *vertex;  // each vertex' own block of all rows, transposed (n_vertex × 13 × 13)
} alone;

// First part of harmonic m among the rows of `harmonic`, and how many it has.
static int first_of(int m) { return m == 0 ? 0 : 2 * m - 1; }
static int parts_of(const bough_blade_inverse *x, int m) { return m == 0 || 2 * m == x->n_part ? 1 : 2; }
static int n_harmonic(const bough_blade_inverse *x) { return x->n_part / 2 + 1; }

static void set_harmonics(bough_blade_inverse *x) {
    int n = x->n_part;
    for (int m = 0; m < n_harmonic(x); m++) {
        int first = first_of(m), parts = parts_of(x, m);
        double size = sqrt((double)parts / n);
        for (int k = 0; k < n; k++) {
            double angle = 2 * BOUGH_PI * m * k / n;
            x->harmonic[first * n + k] = size * cos(angle);
            if (parts == 2) x->harmonic[(first + 1) * n + k] = size * sin(angle);
        }
        for (int p = 0; p < parts; p++) {
            for (int o = 0; o < parts; o++)
                x->term[x->n_term++] =
                    (term){first + p, first + o, first + (p ^ o), {o && p ? -1 : 1, o && !p ? -1 : 1}};
        }
    }
}

void bough_blade_inverse_gather(const bough_blade_inverse *x, int columns, const double *z, double *hat) {
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

void bough_blade_inverse_scatter(const bough_blade_inverse *x, int columns, const double *hat, double *z) {
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

// -- products -------------------------------------------------------------------------------------

// c (n_part × columns × d) += a matrix (n_part × d × r) times z (n_part × columns × r), or its transpose,
// which goes the other way.
static void multiply_rows(const bough_blade_inverse *x, bool transposed, const double *matrix, int columns,
                          const double *z, double *c) {
    int in = transposed ? x->d : x->r, out = transposed ? x->r : x->d;
    size_t block = (size_t)x->d * (size_t)x->r;
    for (const term *t = x->term; t < x->term + x->n_term; t++) {
        bough_product product = {out, columns, in, transposed, .factor = t->sign[transposed], .keep = 1};
        bough_dense_product(product, matrix + (size_t)t->matrix * block,
                            z + (size_t)(t->argument * columns) * (size_t)in,
                            c + (size_t)(t->image * columns) * (size_t)out);
    }
}

// Rows k of the image (n_part × columns × r) += F z; by the transpose, all rows += Fᵀ z_k.
static void add_kinematic(const bough_blade_inverse *x, bool transposed, int columns, const double *z,
                          double *image) {
    int n = x->n_vertex, r = x->r;
    for (const term *t = x->term; t < x->term + x->n_term; t++) {
        double sign = t->sign[transposed];
        for (int k = 0; k < columns; k++) {
            const double *in = z + (t->argument * columns + k) * r;
            double *out = image + (t->image * columns + k) * r;
            for (int at = 0; at < x->n_slow * STATES; at += n) {
                int slow = at / n / STATES * n, state = at / n % STATES * n;
                const double *restrict f = x->kinematic + t->matrix * x->n_slow * STATES + at;
                const double *restrict from = in + (transposed ? slow : state);
                double *restrict to = out + (transposed ? state : slow);
                for (int i = 0; i < n; i++) to[i] += sign * f[i] * from[i];
            }
        }
    }
}

// Rows d of vectors (n × r) by themselves (n × d), or added to them.
static void take_rows(const bough_blade_inverse *x, int n, const double *z, double *rows) {
    for (int k = 0; k < n; k++)
        memcpy(rows + k * x->d, z + k * x->r + x->n_slow, (size_t)x->d * sizeof *rows);
}

static void add_rows(const bough_blade_inverse *x, int n, const double *rows, double *z) {
    for (int k = 0; k < n; k++)
        for (int i = 0; i < x->d; i++) z[k * x->r + x->n_slow + i] += rows[k * x->d + i];
}

void bough_blade_inverse_apply(const bough_blade_inverse *x, bool transposed, int columns, const double *z,
                               double *work, double *image) {
    int n = x->n_part * columns;
    size_t r = (size_t)x->r, size = (size_t)n * r;
    double *rows = work + size;
    memset(image, 0, size * sizeof *image);
    if (transposed) {
        // z_d and what the kinematic rows add to it
        memcpy(work, z, size * sizeof *work);
        add_kinematic(x, true, columns, z, work);
        take_rows(x, n, work, rows);
        multiply_rows(x, true, x->dynamic, columns, rows, image);
        for (size_t k = 0; k < (size_t)n; k++)
            for (size_t i = 0; i < (size_t)x->n_slow; i++) image[k * r + i] += work[k * r + i] - z[k * r + i];
        return;
    }
    // y_d, then y_k by z_k and y_d
    memset(rows, 0, size * sizeof *rows);
    multiply_rows(x, false, x->dynamic, columns, z, rows);
    add_rows(x, n, rows, image);
    memcpy(work, image, size * sizeof *work);
    for (size_t k = 0; k < (size_t)n; k++) memcpy(work + k * r, z + k * r, (size_t)x->n_slow * sizeof *work);
    add_kinematic(x, false, columns, work, image);
}

void bough_blade_inverse_force(const bough_blade_inverse *x, bool transposed, int columns, const double *z,
                               double *work, double *force) {
    int n = x->n_part * columns;
    size_t size = (size_t)columns * (size_t)x->r;
    if (transposed) {
        take_rows(x, n, z, work);
        multiply_rows(x, true, x->air, columns, work, force);
    } else {
        memset(work, 0, (size_t)n * (size_t)x->d * sizeof *work);
        multiply_rows(x, false, x->air, columns, z, work);
        add_rows(x, n, work, force);
    }
    for (const term *t = x->term; t < x->term + x->n_term; t++) {
        const double factor = t->sign[transposed] * x->spin[t->matrix];
        const double *from = z + (size_t)t->argument * size;
        double *to = force + (size_t)t->image * size;
        for (size_t i = 0; i < size; i++) to[i] += factor * from[i];
    }
}

// -- factors --------------------------------------------------------------------------------------

// The mean of the blades' P, which differ with their loads, with all other members at rest.
static alone find_alone(bough_arena *arena, const bough_blade_inverse *x) {
    int r = x->r, n = x->n_vertex;
    alone b = {.dynamic = bough_arena_doubles(arena, (size_t)(x->d * r)),
               .vertex = bough_arena_doubles(arena, (size_t)(n * STATES * STATES) + 1)};
    double *column = bough_arena_doubles(arena, (size_t)r);
    for (int k = 0; k < x->n_part; k++) {
        int member = x->system->group->blade[k]->port + 1;
        for (int j = 0; j < r; j++) {
            memset(column, 0, (size_t)r * sizeof *column);
            column[j] = 1;
            bough_interface_solve_member(x->system->whole->interface, member, column);
            for (int i = 0; i < x->d; i++) b.dynamic[j * x->d + i] += column[x->n_slow + i] / x->n_part;
            for (int c = 0; c < STATES && n > 0; c++)
                b.vertex[(j % n * STATES + c) * STATES + j / n] += column[c * n + j % n] / x->n_part;
        }
    }
    return b;
}

// Σ (block of blades 0, k) cos or sin of a harmonic times their angle.
static void sum_harmonics(bough_arena *arena, const bough_blade_inverse *x) {
    const bough_modes_def *def = x->system->def;
    size_t r = (size_t)x->r, d = (size_t)x->d;
    const double *rate = bough_modes_rate(arena, def);
    for (int k = 0; k < x->n_part * x->n_part; k++) {
        int part = k / x->n_part, blade = k % x->n_part, m = (part + 1) / 2;
        double angle = 2 * BOUGH_PI * m * blade / x->n_part;
        double factor = x->gamma * (part == first_of(m) ? cos(angle) : sin(angle));
        double *sum = x->air + (size_t)part * d * r;
        x->spin[part] += factor * rate[blade];
        for (size_t j = 0; j < r; j++) {
            size_t column = (size_t)def->row[(size_t)blade * r + j];
            const double *from = bough_air_tangent_entry(x->system->air, (size_t)def->row[x->n_slow], column);
            for (size_t i = 0; i < d; i++) sum[j * d + i] -= factor * from[i];
        }
    }
}

// z (parts × columns × n) ← a⁻¹ z of a harmonic's matrices a (n × n, the next `stride` entries further) and
// z.
static bool divide_harmonic(bough_arena *arena, size_t parts, size_t n, const double *a, size_t stride,
                            size_t columns, double *z) {
    size_t q = parts * n;
    double *t = bough_arena_doubles(arena, q * q), *joined = bough_arena_doubles(arena, q * columns);
    // of cosine and sine together: a, and what the sine does to the cosine, which to the sine is the opposite
    for (size_t p = 0; p < parts; p++) {
        const double sign = p == 1 ? -1 : 1;
        for (size_t j = 0; j < parts * n; j++) {
            size_t from = j / n;
            const double *own = a + (p ^ from) * stride + j % n * n;
            double *to = t + j * q + p * n;
            for (size_t i = 0; i < n; i++) to[i] = from == 0 ? sign * own[i] : own[i];
        }
        for (size_t k = 0; k < columns; k++)
            for (size_t i = 0; i < n; i++) joined[k * q + p * n + i] = sign * z[(p * columns + k) * n + i];
    }
    if (!bough_dense_divide(arena, (int)q, (int)columns, t, joined)) return false;
    for (size_t p = 0; p < parts; p++) {
        const double sign = p == 1 ? -1 : 1;
        for (size_t k = 0; k < columns; k++)
            for (size_t i = 0; i < n; i++) z[(p * columns + k) * n + i] = sign * joined[k * q + p * n + i];
    }
    return true;
}

// F of a vertex: its kinematic rows of I − γJ are its own, K_k (7 × 13) times its block of P is (E, 0).
static bool set_vertex(bough_arena *arena, const bough_blade_inverse *x, int vertex, const alone *b) {
    enum { SIZE = SLOW * STATES };
    double rows[SIZE] = {0}, *own = b->vertex + vertex * STATES * STATES;
    int pivot[STATES];
    for (int c = 0; c < SLOW; c++) rows[c * STATES + c] = 1;
    if (!bough_dense_factor(STATES, own, pivot)) return false;
    bough_dense_solve(STATES, SLOW, own, pivot, rows);
    for (int m = 0; m < n_harmonic(x); m++) {
        double matrix[2 * SLOW * SLOW] = {0}, f[2 * SIZE] = {0};
        int first = first_of(m), parts = parts_of(x, m);
        // (K_kk + γS) F = (E, −K_kd)
        for (int c = 0; c < SLOW; c++) {
            for (int e = 0; e < SLOW; e++) matrix[e * SLOW + c] = rows[c * STATES + e];
            for (int e = SLOW; e < STATES; e++) f[e * SLOW + c] = -rows[c * STATES + e];
            for (int o = 0; o < parts; o++) matrix[(o * SLOW + c) * SLOW + c] += x->spin[first + o];
            f[c * SLOW + c] = 1;
        }
        if (!divide_harmonic(arena, (size_t)parts, SLOW, matrix, SLOW * SLOW, STATES, f)) return false;
        for (int k = 0; k < parts * SIZE; k++) {
            int row = k / SIZE * SLOW + k % SLOW, column = k % SIZE / SLOW;
            x->kinematic[((first * SLOW + row) * STATES + column) * x->n_vertex + vertex] = f[k];
        }
    }
    return true;
}

// U (n_part × d × r) becomes that of U_k F in the kinematic columns and U_d + U_k F in the dynamic ones.
static void follow_kinematics(bough_arena *arena, const bough_blade_inverse *x, double *u) {
    size_t r = (size_t)x->r, d = (size_t)x->d, n = (size_t)x->n_part * r;
    double *rows, *moved; // by rows
    bough_arena_each(arena, d * n, &rows, &moved);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < d; i++) rows[(j / r * d + i) * r + j % r] = u[j * d + i];
    add_kinematic(x, true, x->d, rows, moved);
    for (size_t j = 0; j < n; j++) {
        double kept = j % r < (size_t)x->n_slow ? 0 : 1;
        for (size_t i = 0; i < d; i++)
            u[j * d + i] = kept * u[j * d + i] + moved[(j / r * d + i) * r + j % r];
    }
}

// theory (116): D_d.
static bool factor(bough_arena *arena, const bough_blade_inverse *x) {
    size_t r = (size_t)x->r, d = (size_t)x->d, slow = (size_t)x->n_slow, block = d * r;
    const alone b = find_alone(arena, x);
    double *u = bough_arena_doubles(arena, (size_t)x->n_part * block);
    for (int i = 0; i < x->n_vertex; i++)
        if (!set_vertex(arena, x, i, &b)) return false;
    // U = rows d of P N
    for (int part = 0; part < x->n_part; part++) {
        double *to = u + (size_t)part * block;
        memcpy(to, b.dynamic, block * sizeof *to);
        bough_dense_product((bough_product){x->d, x->r, x->d, false, .factor = 1, .keep = x->spin[part]},
                            b.dynamic + slow * d, x->air + (size_t)part * block, to);
    }
    follow_kinematics(arena, x, u);
    for (int m = 0; m < n_harmonic(x); m++) {
        size_t parts = (size_t)parts_of(x, m);
        double *to = x->dynamic + (size_t)first_of(m) * block, *own = u + (size_t)first_of(m) * block;
        // P_d − ((U_k F)_k, 0), and C = E + U_d + (U_k F)_d
        memcpy(to, b.dynamic, block * sizeof *to);
        for (size_t p = 0; p < parts; p++)
            for (size_t k = 0; k < slow * d; k++) to[p * block + k] -= own[p * block + k];
        for (size_t i = 0; i < d; i++) own[(slow + i) * d + i] += 1;
        if (!divide_harmonic(arena, parts, d, own + slow * d, block, r, to)) return false;
    }
    return true;
}

bough_blade_inverse *bough_blade_inverse_create(bough_arena *arena, const bough_aeroelastic *system) {
    const bough_modes_def *def = system->def;
    if (def->n_part < 2) return NULL;
    bough_blade_inverse *x = bough_arena_take(arena, sizeof *x);
    *x = (bough_blade_inverse){.system = system,
                               .n = system->air->n,
                               .n_part = def->n_part,
                               .r = def->n_row,
                               .gamma = 1 / def->point};
    // only of rods it is known which states are kinematic
    if (system->group->blade[0]->rod) x->n_vertex = x->r / STATES;
    x->n_slow = SLOW * x->n_vertex;
    x->d = x->r - x->n_slow;
    size_t parts = (size_t)x->n_part, block = (size_t)x->d * (size_t)x->r;
    x->harmonic = bough_arena_doubles(arena, parts * parts);
    x->term = bough_arena_take(arena, 2 * parts * sizeof *x->term);
    x->spin = bough_arena_doubles(arena, parts);
    bough_arena_each(arena, parts * block, &x->air, &x->dynamic);
    x->kinematic = bough_arena_doubles(arena, parts * (size_t)(x->n_slow * STATES) + 1);
    set_harmonics(x);
    bough_arena *own = bough_arena_child(arena);
    sum_harmonics(own, x);
    bool regular = factor(own, x);
    bough_arena_destroy(own);
    return regular ? x : NULL;
}

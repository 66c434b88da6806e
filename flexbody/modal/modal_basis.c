// The shapes of a modal piece: clamped modes, rigid motions and static deflections, from the rod's own
// tangents at rest, orthonormal in the mass, theory (15), and, by Rayleigh and Ritz, in the stiffness.
#include "core/base/linalg.h"
#include "core/base/spatial.h"
#include "flexbody/modal/modal.h"
#include "flexbody/rod/rod_tangent.h"

enum { RIGID = 6 };

static const double dependent =
    1e-6; // norm outside the span of earlier shapes, relative to the whole: below it, dependent

// Vectors have 8 entries for each moving vertex: displacement in frame axes, rotation in section axes, 0, 0.
typedef struct basis {
    bough_arena *arena;
    const bough_rod_model *rod;
    int size;                          // 8 n
    bough_rod_tangent tangent;         // at rest
    bough_block_tridiagonal stiffness; // K; factored by solve()
    bool factored;
    double *vector;  // (count × size)
    double *product; // M times each of them (count × size)
    int count;
} basis;

static bool linearise(basis *b) {
    const bough_rod_model *rod = b->rod;
    const double still[BOUGH_ROD_INPUTS] = {0};
    bough_rod_scratch scratch;
    bough_rod_loads none;
    double *state = bough_arena_doubles(b->arena, (size_t)BOUGH_ROD_STATES * rod->n);
    bough_rod_scratch_init(&scratch, b->arena, rod);
    bough_rod_tangent_init(&b->tangent, b->arena, rod);
    bough_rod_loads_init(&none, b->arena, rod);
    bough_block_tridiagonal_init(&b->stiffness, b->arena, rod->n);
    bough_rod_rest_state(rod, still, state);
    if (!bough_rod_linearise(rod, &none, 0, state, still, &scratch, &b->tangent)) return false;
    bough_rod_linear_stiffness(rod, &b->tangent.blocks, still, state, &b->stiffness);
    return true;
}

// y = M x
static void mass_times(const basis *b, const double *x, double *y) {
    memset(y, 0, (size_t)b->size * sizeof *y);
    for (int i = 0; i < b->rod->n; i++) {
        bough_block_subtract(b->tangent.blocks.mass + (size_t)i * BOUGH_BLOCK, x + BOUGH_COLUMN * i,
                             y + BOUGH_COLUMN * i);
    }
    for (int i = 0; i < b->size; i++) y[i] = -y[i];
}

// Adds x, made orthonormal in the mass to the vectors before it by Gram and Schmidt, unless it depends on
// them.
static void add_vector(basis *b, double *x) {
    size_t at = (size_t)b->count * b->size;
    double *p = b->product + at;
    mass_times(b, x, p);
    // the norm before and after shows dependence
    double before = sqrt(bough_scalar_product(b->size, x, p));
    for (int sweep = 0; sweep < 2; sweep++) { // twice restores what cancellation loses
        for (int k = 0; k < b->count; k++) {
            double along = bough_scalar_product(b->size, x, b->product + (size_t)k * b->size);
            const double *v = b->vector + (size_t)k * b->size;
            for (int i = 0; i < b->size; i++) x[i] -= along * v[i];
        }
    }
    mass_times(b, x, p);
    double left = sqrt(bough_scalar_product(b->size, x, p));
    if (!(left > dependent * before)) return;
    for (int i = 0; i < b->size; i++) {
        b->vector[at + i] = x[i] / left;
        p[i] /= left;
    }
    b->count++;
}

// -- clamped modes --------------------------------------------------------------------------------

// L⁻¹ x in place, and L⁻ᵀ x
static void forward(const double *l, double *x) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < i; j++) x[i] -= l[6 * i + j] * x[j];
        x[i] /= l[6 * i + i];
    }
}

static void backward(const double *l, double *x) {
    for (int i = 5; i >= 0; i--) {
        for (int j = i + 1; j < 6; j++) x[i] -= l[6 * j + i] * x[j];
        x[i] /= l[6 * i + i];
    }
}

// L_i⁻¹ K_ij L_j⁻ᵀ into the dense matrix (6 n × 6 n, by columns).
static void put_whitened(const basis *b, const double *factor, const double *block, int i, int j,
                         double *dense) {
    double column[6][6];
    for (int c = 0; c < 6; c++) {
        for (int r = 0; r < 6; r++) column[c][r] = block[BOUGH_COLUMN * c + r];
        forward(factor + 36 * i, column[c]);
    }
    for (int r = 0; r < 6; r++) {
        double row[6];
        for (int c = 0; c < 6; c++) row[c] = column[c][r];
        forward(factor + 36 * j, row);
        for (int c = 0; c < 6; c++) dense[(size_t)(6 * j + c) * 6 * b->rod->n + 6 * i + r] = row[c];
    }
}

// The mass factored M = L Lᵀ per vertex (n × 36); false unless it is positive definite.
static bool factor_mass(const basis *b, double *factor) {
    for (int i = 0; i < b->rod->n; i++) {
        for (int k = 0; k < 36; k++) {
            factor[36 * i + k] =
                b->tangent.blocks.mass[(size_t)i * BOUGH_BLOCK + BOUGH_COLUMN * (k / 6) + k % 6];
        }
        if (!bough_cholesky_factor(6, factor + 36 * i)) return false;
    }
    return true;
}

// Clamped modes: M = L Lᵀ per vertex turns K φ = ω² M φ into the standard problem of L⁻¹ K L⁻ᵀ, solved by
// LAPACK.
static bool add_modes(basis *b, int count) {
    int size = 6 * b->rod->n;
    size_t n = (size_t)size;
    double *dense = bough_arena_doubles(b->arena, n * n);
    double *vector = bough_arena_doubles(b->arena, n * (size_t)count);
    double *value = bough_arena_doubles(b->arena, n), *work = bough_arena_doubles(b->arena, 26 * n);
    int *index = bough_arena_take(b->arena, 12 * n * sizeof *index);
    double *factor = bough_arena_doubles(b->arena, 36 * (size_t)b->rod->n);
    double *x = bough_arena_doubles(b->arena, (size_t)b->size);
    // whitened stiffness, its lower triangle
    if (!factor_mass(b, factor)) return false;
    for (int i = 0; i < b->rod->n; i++) {
        const double *diagonal = b->stiffness.diagonal + (size_t)i * BOUGH_BLOCK;
        const double *lower = b->stiffness.lower + (size_t)i * BOUGH_BLOCK;
        put_whitened(b, factor, diagonal, i, i, dense);
        if (i > 0) put_whitened(b, factor, lower, i, i - 1, dense);
    }
    // lowest eigenvectors x, shapes L⁻ᵀ x
    if (!bough_symmetric_smallest(size, dense, count, value, vector, work, index)) return false;
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < b->rod->n; i++) {
            double *own = x + BOUGH_COLUMN * i;
            memcpy(own, vector + n * (size_t)k + 6 * i, 6 * sizeof *own);
            backward(factor + 36 * i, own);
        }
        add_vector(b, x);
    }
    return true;
}

// -- rigid motions and static deflections -------------------------------------------------------------

static void rigid_motion(const bough_rod_model *rod, int k, double *x) {
    bough_vec3 e = bough_unit3(k % 3);
    for (int i = 0; i < rod->n; i++) {
        bough_twist v = {e, {0, 0, 0}};
        if (k >= 3) {
            v.linear = bough_cross(e, rod->position0[i + 1]);
            v.angular = bough_mat3_tmul(bough_rotation_matrix(rod->rotation0[i + 1]), e);
        }
        bough_twist_store(v, x + BOUGH_COLUMN * i);
    }
}

// K⁻¹ x
static bool solve(basis *b, double *x) {
    if (!b->factored && !bough_block_tridiagonal_factor(&b->stiffness)) return false;
    b->factored = true;
    bough_block_tridiagonal_solve(&b->stiffness, x);
    return true;
}

// The shapes beside the modes. Rigid motions put momentum in the span; theory (36).
static bool add_others(basis *b, bool statics, bool inner) {
    double *x = bough_arena_doubles(b->arena, (size_t)b->size);
    double *y = bough_arena_doubles(b->arena, (size_t)b->size);
    for (int k = 0; k < RIGID; k++) {
        rigid_motion(b->rod, k, x);
        add_vector(b, x);
    }
    // under accelerations of the frame: K⁻¹ M x
    for (int k = 0; k < RIGID && statics; k++) {
        rigid_motion(b->rod, k, x);
        mass_times(b, x, y);
        if (!solve(b, y)) return false;
        add_vector(b, y);
    }
    // under a wrench of the next piece at the last vertex
    for (int k = 0; k < RIGID && inner; k++) {
        memset(y, 0, (size_t)b->size * sizeof *y);
        y[b->size - BOUGH_COLUMN + k] = 1;
        if (!solve(b, y)) return false;
        add_vector(b, y);
    }
    return true;
}

// -- Rayleigh and Ritz ----------------------------------------------------------------------------

// −Xᵀ A X (count × count) of a tridiagonal A.
static void project(const basis *b, const bough_block_tridiagonal *a, double *work, double *to) {
    for (int l = 0; l < b->count; l++) {
        memset(work, 0, (size_t)b->size * sizeof *work);
        bough_block_tridiagonal_subtract(a, b->vector + (size_t)l * b->size, work);
        for (int k = 0; k < b->count; k++) {
            to[l * b->count + k] = bough_scalar_product(b->size, b->vector + (size_t)k * b->size, work);
        }
    }
}

// Linear combinations of the vectors, the eigenvectors of their stiffness.
static void rotate(const basis *b, const double *eigen, double *rotated) {
    for (int k = 0; k < b->count; k++) {
        double *x = rotated + (size_t)k * b->size;
        memset(x, 0, (size_t)b->size * sizeof *x);
        for (int l = 0; l < b->count; l++) {
            const double *v = b->vector + (size_t)l * b->size;
            for (int i = 0; i < b->size; i++) x[i] += eigen[k * b->count + l] * v[i];
        }
    }
}

// The shapes by rows, rotations in frame axes, and the q that moves a vertex by 1 m or 0.1 rad.
static void store(const basis *b, const double *value, const double *damping, bough_modal_piece *piece) {
    int m = b->count, stride = piece->stride;
    for (int k = 0; k < m; k++) {
        double largest = 0;
        piece->square[k] = value[k];
        for (int l = 0; l < m; l++) piece->damping[k * stride + l] = damping[k * m + l];
        for (int i = 0; i < piece->n; i++) {
            const double *x = b->vector + (size_t)k * b->size + BOUGH_COLUMN * i;
            bough_mat3 r = bough_rotation_matrix(b->rod->rotation0[i + 1]);
            bough_twist v = bough_twist_load(x);
            v.angular = bough_mat3_mul(r, v.angular);
            largest = fmax(largest, fmax(bough_norm(v.linear), 10 * bough_norm(v.angular)));
            double row[6];
            bough_twist_store(v, row);
            for (int c = 0; c < 6; c++) piece->shape[(6 * i + c) * stride + k] = row[c];
        }
        piece->scale[k] = 1 / largest;
    }
}

static void take_memory(bough_arena *arena, int m, bough_modal_piece *piece) {
    piece->m = m;
    piece->stride = bough_padded(m);
    size_t s = (size_t)piece->stride;
    bough_arena_each(arena, s, &piece->square, &piece->scale);
    piece->damping = bough_arena_doubles(arena, (size_t)m * s);
    piece->shape = bough_arena_doubles(arena, 6 * (size_t)piece->n * s);
}

static bool find_shapes(basis *b, bough_modal_options options, bool inner) {
    size_t most = (size_t)options.modes + 3 * RIGID + 1; // one more than can be kept, as work
    bough_arena_each(b->arena, most * (size_t)b->size, &b->vector, &b->product);
    return linearise(b) && add_modes(b, options.modes) && add_others(b, options.statics, inner);
}

// Rayleigh and Ritz: diagonalises the stiffness in the span; value (count), damping (count × count).
static bool diagonalise(basis *b, const bough_block_tridiagonal *stiffness, double *value, double *damping) {
    size_t m = (size_t)b->count;
    double *reduced = bough_arena_doubles(b->arena, m * m);
    double *eigen = bough_arena_doubles(b->arena, m * m);
    double *work = bough_arena_doubles(b->arena, (size_t)b->size + 26 * m);
    double *rotated = bough_arena_doubles(b->arena, m * (size_t)b->size);
    int *index = bough_arena_take(b->arena, 12 * m * sizeof *index);
    project(b, stiffness, work, reduced);
    if (!bough_symmetric_smallest(b->count, reduced, b->count, value, eigen, work, index)) {
        return false;
    }
    rotate(b, eigen, rotated);
    b->vector = rotated;
    // damping in the new shapes is full
    project(b, &b->tangent.blocks.velocity, work, damping);
    return true;
}

bough_status bough_modal_basis(bough_arena *arena, bough_modal_options options, bough_modal_piece *piece) {
    basis b = {.arena = bough_arena_child(arena), .rod = piece->rod, .size = BOUGH_COLUMN * piece->n};
    if (options.modes > 6 * piece->n) options.modes = 6 * piece->n;
    bough_status status = bough_fail(BOUGH_FAILED, "%s: its modes cannot be found", piece->rod->name);
    if (find_shapes(&b, options, piece->inner)) {
        double *value = bough_arena_doubles(b.arena, (size_t)b.count);
        double *damping = bough_arena_doubles(b.arena, (size_t)b.count * (size_t)b.count);
        take_memory(arena, b.count, piece);
        if (diagonalise(&b, &b.tangent.blocks.position, value, damping)) {
            store(&b, value, damping, piece);
            status = bough_ok();
        }
    }
    bough_arena_destroy(b.arena);
    return status;
}

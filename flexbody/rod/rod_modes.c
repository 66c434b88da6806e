#include "flexbody/rod/rod_modes.h"

#include "core/base/eigen.h"

static const double rounding = 1e-11; // smaller damping ratios are zero

// |x_k|² of a complex shape.
static double square_of(const bough_eigen_pair *pair, int k) {
    return pair->shape_real[k] * pair->shape_real[k] + pair->shape_imag[k] * pair->shape_imag[k];
}

// Kinetic energy of translations and of the rotation about the axis; the largest names the mode.
static void set_shares(const bough_rod_model *m, const bough_eigen_pair *pair, bough_rod_mode *mode) {
    double sum = 0;
    for (int i = 0; i < m->n; i++) {
        const bough_vertex_inertia *v = &m->vertex[i + 1];
        for (int c = 0; c < 3; c++) mode->share[c] += v->mass * square_of(pair, BOUGH_COLUMN * i + c);
        mode->share[BOUGH_ROD_TORSION] += v->inertia[2] * square_of(pair, BOUGH_COLUMN * i + 5);
    }
    // as parts of their sum
    for (int c = 0; c < BOUGH_ROD_DIRECTIONS; c++) sum += mode->share[c];
    for (int c = 0; c < BOUGH_ROD_DIRECTIONS; c++) {
        mode->share[c] /= sum;
        if (mode->share[c] > mode->share[mode->dominant]) mode->dominant = (bough_rod_direction)c;
    }
}

// The entry that becomes 1.
static int reference_of(const bough_rod_model *m, const bough_eigen_pair *pair, const bough_rod_mode *mode) {
    bool torsion = mode->dominant == BOUGH_ROD_TORSION;
    int at = torsion ? 5 : 0;
    for (int i = 0; i < m->n; i++) {
        for (int c = torsion ? 5 : 0; c < (torsion ? 6 : 3); c++) {
            if (square_of(pair, BOUGH_COLUMN * i + c) > square_of(pair, at)) at = BOUGH_COLUMN * i + c;
        }
    }
    return at;
}

// The shape divided by its reference entry, rotations in body axes in place of section axes.
static void set_shape(const bough_rod_model *m, const bough_eigen_pair *pair, const double *state,
                      bough_rod_mode *mode) {
    int n = m->n, reference = reference_of(m, pair, mode);
    double square = square_of(pair, reference);
    double cosine = pair->shape_real[reference] / square;
    double sine = -pair->shape_imag[reference] / square;
    for (int i = 0; i < n; i++) {
        bough_mat3 r = bough_rod_rotation(state, n, i);
        const double *a = pair->shape_real + (size_t)BOUGH_COLUMN * i,
                     *b = pair->shape_imag + (size_t)BOUGH_COLUMN * i;
        // (a + i b) divided by the reference
        double real[6], imaginary[6];
        for (int c = 0; c < 6; c++) {
            real[c] = cosine * a[c] - sine * b[c];
            imaginary[c] = cosine * b[c] + sine * a[c];
        }
        // rotations from section to body axes
        bough_vec3 first = bough_mat3_mul(r, bough_v3_load(real + 3));
        bough_vec3 second = bough_mat3_mul(r, bough_v3_load(imaginary + 3));
        const double turned[6] = {first.x, first.y, first.z, second.x, second.y, second.z};
        for (int c = 0; c < 3; c++) {
            mode->real[c * n + i] = real[c];
            mode->real[(3 + c) * n + i] = turned[c];
            mode->imaginary[c * n + i] = imaginary[c];
            mode->imaginary[(3 + c) * n + i] = turned[3 + c];
        }
    }
}

static void fill_mode(bough_arena *arena, const bough_rod_model *m, const bough_eigen_pair *pair,
                      const double *state, bough_rod_mode *mode) {
    // frequency and damping of λ
    double modulus = hypot(pair->real, pair->imaginary), ratio = -pair->real / modulus;
    *mode = (bough_rod_mode){.frequency = modulus / (2 * BOUGH_PI),
                             .damped_frequency = pair->imaginary / (2 * BOUGH_PI),
                             .damping = fabs(ratio) > rounding ? ratio : 0,
                             .real = bough_arena_doubles(arena, 6 * (size_t)m->n),
                             .imaginary = bough_arena_doubles(arena, 6 * (size_t)m->n)};
    set_shares(m, pair, mode);
    set_shape(m, pair, state, mode);
}

// K into the tangent's matrix and C, from the linearisation at the equilibrium.
static bough_status linearise(const bough_rod_model *m, bough_rod_static *work, const double *input,
                              const double *state, bough_block_tridiagonal *damping) {
    if (!bough_rod_linearise(m, &work->scaled, 0, state, input, &work->scratch, &work->tangent)) {
        return bough_fail(BOUGH_FAILED, "rod %s: no linearisation at its equilibrium", m->name);
    }
    const bough_rod_blocks *blocks = &work->tangent.blocks;
    bough_rod_linear_damping(m, blocks, input, state, damping);
    bough_rod_linear_stiffness(m, blocks, input, state, &work->tangent.matrix);
    return bough_ok();
}

bough_status bough_rod_modes(bough_arena *arena, const bough_rod_model *m, bough_rod_static *work,
                             const double *input, const double *state, bough_rod_mode_list *list) {
    bough_block_tridiagonal damping;
    size_t wanted = (size_t)list->wanted;
    bough_eigen_pair *pair = bough_arena_take(arena, wanted * sizeof *pair);
    list->mode = bough_arena_take(arena, wanted * sizeof *list->mode);
    bough_block_tridiagonal_init(&damping, arena, m->n);
    // M, C, K about the equilibrium, then the eigenvalues nearest to 0
    BOUGH_TRY(linearise(m, work, input, state, &damping));
    bough_eigen_problem problem = {m->name, work->tangent.blocks.mass, &damping, &work->tangent.matrix};
    BOUGH_TRY(bough_eigen_smallest(arena, &problem, list->wanted, pair, &list->found));
    for (int k = 0; k < list->found; k++) {
        fill_mode(arena, m, &pair[k], state, &list->mode[k]);
    }
    return bough_ok();
}

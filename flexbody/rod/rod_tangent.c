// Memory of a linearisation, and that about a steady motion.
#include "flexbody/rod/rod_tangent.h"

#include "flexbody/rod/rod_tangent_layout.h"

static void blocks_init(bough_rod_blocks *b, bough_arena *arena, const bough_rod_model *m) {
    b->mass = bough_arena_doubles(arena, (size_t)bough_padded(m->n) * BOUGH_BLOCK);
    bough_block_tridiagonal_init(&b->position, arena, m->n);
    bough_block_tridiagonal_init(&b->velocity, arena, m->n);
}

// Rows over vertices begin a vector register at vertex 1.
void bough_rod_tangent_init(bough_rod_tangent *k, bough_arena *arena, const bough_rod_model *m) {
    size_t s = (size_t)m->stride;
    k->variation = bough_arena_doubles(arena, TANGENTS * s);
    k->local_position = bough_rod_vertex_rows(arena, m, 18);
    k->vertex = bough_rod_vertex_rows(arena, m, KEPT);
    k->work = bough_rod_vertex_rows(arena, m, WORK);
    k->rate = bough_arena_doubles(arena, BOUGH_ROD_STATES * s);
    bough_arena_each(arena, 2 * TANGENTS, &k->root, &k->end);
    k->force = bough_arena_doubles(arena, FORCES * s);
    k->packed = bough_arena_doubles(arena, (size_t)bough_padded(m->n) * BOUGH_COLUMN);
    bough_block_tridiagonal_init(&k->matrix, arena, m->n);
    blocks_init(&k->blocks, arena, m);
}

// -- about a steady motion ------------------------------------------------------------------------

// u = u₀ + ω×x and W = Rᵀω at every vertex.
void bough_rod_move_rigidly(const bough_rod_model *m, const double *input, double *state) {
    int n = m->n;
    bough_vec3 u0 = bough_v3_load(input), omega = bough_v3_load(input + 3);
    for (int i = 0; i < n; i++) {
        bough_vec3 x = {state[i], state[n + i], state[2 * n + i]};
        bough_vec3 u = bough_add(u0, bough_cross(omega, x));
        bough_vec3 w = bough_mat3_tmul(bough_rod_rotation(state, n, i), omega);
        const double values[6] = {u.x, u.y, u.z, w.x, w.y, w.z};
        for (int c = 0; c < 6; c++) state[(BOUGH_ROD_U + c) * n + i] = values[c];
    }
}

// The matrix of a × y into a block, from row and column `at` on.
static void put_cross(bough_vec3 a, double *block, int at) {
    for (int j = 0; j < 3; j++) {
        bough_v3_store(bough_cross(a, bough_unit3(j)), block + (size_t)BOUGH_COLUMN * (at + j) + at);
    }
}

// B of vertex i + 1: how the velocities of the steady motion change with its position and rotation.
static void slide(const double *input, const double *state, int n, int i, double *block) {
    bough_vec3 omega = {input[3], input[4], input[5]};
    bough_mat3 r = bough_rod_rotation(state, n, i);
    memset(block, 0, BOUGH_BLOCK * sizeof *block);
    put_cross(omega, block, 0);
    put_cross(bough_mat3_tmul(r, omega), block, 3);
}

// to = −(position + velocity B) for one block of B's column
static void stiffness_block(const double *position, const double *velocity, const double *b, double *to) {
    double product[BOUGH_BLOCK];
    bough_block_product(velocity, b, product);
    for (int j = 0; j < BOUGH_BLOCK; j++) to[j] = -(position[j] + product[j]);
}

void bough_rod_linear_stiffness(const bough_rod_model *m, const bough_rod_blocks *blocks, const double *input,
                                const double *state, bough_block_tridiagonal *stiffness) {
    const bough_block_tridiagonal *p = &blocks->position, *v = &blocks->velocity;
    for (int i = 0; i < m->n; i++) {
        double b[BOUGH_BLOCK];
        size_t at = (size_t)i * BOUGH_BLOCK, before = at - BOUGH_BLOCK, after = at + BOUGH_BLOCK;
        // the blocks of column i, on which B of vertex i + 1 acts
        slide(input, state, m->n, i, b);
        stiffness_block(p->diagonal + at, v->diagonal + at, b, stiffness->diagonal + at);
        if (i > 0) {
            stiffness_block(p->upper + before, v->upper + before, b, stiffness->upper + before);
        }
        if (i < m->n - 1) {
            stiffness_block(p->lower + after, v->lower + after, b, stiffness->lower + after);
        }
    }
}

void bough_rod_linear_damping(const bough_rod_model *m, const bough_rod_blocks *blocks, const double *input,
                              const double *state, bough_block_tridiagonal *damping) {
    size_t count = (size_t)m->n * BOUGH_BLOCK;
    // off the diagonal −∂f/∂v alone: M is block-diagonal
    for (size_t j = 0; j < count; j++) {
        damping->lower[j] = -blocks->velocity.lower[j];
        damping->upper[j] = -blocks->velocity.upper[j];
    }
    // on it M B, too
    for (int i = 0; i < m->n; i++) {
        double b[BOUGH_BLOCK], product[BOUGH_BLOCK];
        size_t at = (size_t)i * BOUGH_BLOCK;
        slide(input, state, m->n, i, b);
        bough_block_product(blocks->mass + at, b, product);
        for (int j = 0; j < BOUGH_BLOCK; j++) {
            damping->diagonal[at + j] = product[j] - blocks->velocity.diagonal[at + j];
        }
    }
}

// Memory of a linearisation, and the kernels of the model's level.
#include "flexbody/rod/rod_kernels.h"
#include "flexbody/rod/rod_tangent_layout.h"

void bough_rod_blocks_init(bough_rod_blocks *b, bough_arena *arena, const bough_rod_model *m) {
    b->mass = bough_arena_doubles(arena, (size_t)bough_padded(m->n) * BOUGH_BLOCK);
    bough_block_tridiagonal_init(&b->position, arena, m->n);
    bough_block_tridiagonal_init(&b->velocity, arena, m->n);
}

void bough_rod_tangent_init(bough_rod_tangent *k, bough_arena *arena, const bough_rod_model *m) {
    size_t s = (size_t)m->stride;
    k->variation = bough_arena_doubles(arena, TANGENTS * s);
    k->local_position = bough_rod_vertex_rows(arena, m, 18);
    k->vertex = bough_rod_vertex_rows(arena, m, KEPT);
    k->work = bough_rod_vertex_rows(arena, m, WORK);
    k->rate = bough_arena_doubles(arena, BOUGH_ROD_STATES * s);
    k->root = bough_arena_doubles(arena, TANGENTS);
    k->end = bough_arena_doubles(arena, TANGENTS);
    k->force = bough_arena_doubles(arena, FORCES * s);
    k->packed = bough_arena_doubles(arena, (size_t)bough_padded(m->n) * W8);
    bough_block_tridiagonal_init(&k->matrix, arena, m->n);
    bough_rod_blocks_init(&k->blocks, arena, m);
}

bool bough_rod_linearise(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                         const double *state, const double *input, bough_rod_scratch *scratch,
                         bough_rod_tangent *k) {
    return BOUGH_OF_LEVEL(bough_rod_linearise, m->level)(m, loads, t, state, input, scratch, k);
}

bool bough_rod_factor(const bough_rod_model *m, bough_rod_tangent *k, double gamma) {
    return BOUGH_OF_LEVEL(bough_rod_factor, m->level)(m, k, gamma);
}

void bough_rod_solve(const bough_rod_model *m, bough_rod_tangent *k, double *x) {
    BOUGH_OF_LEVEL(bough_rod_solve, m->level)(m, k, x);
}

// The tangents of segments and vertices put into blocks, for factors, statics and eigenvalues. Tangents
// come as structures of arrays, a block wants its entries together: eight vertices at a time, the
// entries of a row are gathered in a tile, a vertex to each lane, and the tile is turned.
#include "flexbody/rod_tangent.h"

#include "flexbody/rod_tangent_layout.h"
#include "flexbody/rod_tile.h"

#include <string.h>

bool bough_rod_blocks_init(bough_rod_blocks *b, bough_arena *arena, const bough_rod_model *m) {
    b->mass = bough_arena_doubles(arena, (size_t)bough_padded(m->n) * BOUGH_BLOCK);
    bool ok = bough_block_tridiagonal_init(&b->position, arena, m->n);
    return bough_block_tridiagonal_init(&b->velocity, arena, m->n) && ok && b->mass != NULL;
}

static void copy_blocks(const bough_block_tridiagonal *from, bough_block_tridiagonal *to) {
    size_t bytes = (size_t)from->n * BOUGH_BLOCK * sizeof(double);
    memcpy(to->lower, from->lower, bytes);
    memcpy(to->diagonal, from->diagonal, bytes);
    memcpy(to->upper, from->upper, bytes);
}

void bough_rod_assemble(const bough_rod_model *m, const bough_rod_tangent *k, bough_rod_blocks *b) {
    copy_blocks(&k->blocks.position, &b->position);
    copy_blocks(&k->blocks.velocity, &b->velocity);
    memcpy(b->mass, k->blocks.mass, (size_t)m->n * BOUGH_BLOCK * sizeof(double));
}

// A column of eight vertices' blocks: entry i of lane l at [LANES i + l]; two rows are padding.
static inline void store_tile(const tile *t, double *restrict column) {
    tile turned;
    turn_tile(t->entry, turned.entry);
    for (int lane = 0; lane < LANES; lane++) {
        memcpy(column + BOUGH_BLOCK * lane, turned.entry + W8 * lane, W8 * sizeof(double));
    }
}

// Three tiles of one column: of the blocks below, on and above the diagonal.
typedef struct column_tiles {
    tile lower, diagonal, upper;
} column_tiles;

// What moves with a column's variation: the force that the segment on the left exerts on the vertex
// by the vertex' own variation (`left`) and the left neighbour's (`before`), the one on the right by
// the vertex' own (`right`) and the right neighbour's (`after`). A shift counts as Δx of the segment
// on the left, −Δx of the one on the right.
typedef struct column_sources {
    const double *left, *before, *right, *after; // first of three forces, at the segment of lane 0
    double before_sign, right_sign;
} column_sources;

static column_sources sources_of(const double *g, int s, int column, bool moment, int v) {
    bool shift = column < 3;
    int k = column % 3, force_left = moment ? LR : F, force_right = moment ? LL : F;
#define AT(direction, force, n) (g + (size_t)(FORCES * ((direction) + k) + (force)) * s + (n))
    return (column_sources){.left = AT(shift ? DELTA : RIGHT, force_left, v - 1),
                            .before = AT(shift ? DELTA : LEFT, force_left, v - 1),
                            .right = AT(shift ? DELTA : LEFT, force_right, v),
                            .after = AT(shift ? DELTA : RIGHT, force_right, v),
                            .before_sign = shift ? -1 : 1,
                            .right_sign = shift ? -1 : 1};
#undef AT
}

// Three rows of a column. A segment pulls its left vertex by f and its right one by −f; moments are
// those on either vertex.
static inline void fill_rows(column_sources from, int s, bool moment, column_tiles *t) {
    double sign = moment ? 1 : -1; // of the segment on the left
    double before = sign * from.before_sign, right = from.right_sign;
    for (int i = 0; i < 3; i++) {
        int row = LANES * (moment ? 3 + i : i);
        const double *restrict a = from.left + i * s, *restrict b = from.before + i * s;
        const double *restrict c = from.right + i * s, *restrict d = from.after + i * s;
        double *restrict lower = t->lower.entry + row, *restrict upper = t->upper.entry + row;
        double *restrict diagonal = t->diagonal.entry + row;
#pragma omp simd
        for (int lane = 0; lane < LANES; lane++) {
            lower[lane] = before * b[lane];
            diagonal[lane] = sign * a[lane] + right * c[lane];
            upper[lane] = d[lane];
        }
    }
}

// Adds a vertex' own terms, six rows of one column, stride s.
static inline void add_own(const double *restrict own, int s, tile *t) {
    for (int i = 0; i < 6; i++) {
#pragma omp simd
        for (int lane = 0; lane < LANES; lane++) t->entry[LANES * i + lane] += own[i * s + lane];
    }
}

static inline void set_own(const double *restrict own, int s, tile *t) {
    for (int i = 0; i < 6; i++) {
        memcpy(t->entry + LANES * i, own + i * s, LANES * sizeof(double));
    }
}

static inline void store_column(const column_tiles *t, int v, int column,
                                bough_block_tridiagonal *b) {
    size_t at = (size_t)(v - 1) * BOUGH_BLOCK + W8 * column;
    store_tile(&t->lower, b->lower + at);
    store_tile(&t->diagonal, b->diagonal + at);
    store_tile(&t->upper, b->upper + at);
}

// Column j of the blocks of vertices v..v + 7.
static void form_column(const bough_rod_tangent *k, int s, int v, int j, column_tiles *t) {
    const double *position = k->variation, *velocity = position + (size_t)TANGENTS * s;
    bough_rod_blocks b = k->blocks;
    fill_rows(sources_of(position, s, j, false, v), s, false, t);
    fill_rows(sources_of(position, s, j, true, v), s, true, t);
    if (j >= 3) add_own(k->local_position + (size_t)6 * (j - 3) * s + v, s, &t->diagonal);
    store_column(t, v, j, &b.position);
    fill_rows(sources_of(velocity, s, j, false, v), s, false, t);
    fill_rows(sources_of(velocity, s, j, true, v), s, true, t);
    add_own(k->local_velocity + (size_t)j * s + v, 6 * s, &t->diagonal);
    store_column(t, v, j, &b.velocity);
    set_own(k->mass + (size_t)j * s + v, 6 * s, &t->diagonal);
    store_tile(&t->diagonal, b.mass + (size_t)(v - 1) * BOUGH_BLOCK + W8 * j);
}

void bough_rod_form_blocks(const bough_rod_model *m, bough_rod_tangent *k) {
    column_tiles t = {{{0}}, {{0}}, {{0}}};
    for (int v = 1; v <= m->n; v += LANES) {
        for (int j = 0; j < 6; j++) form_column(k, m->stride, v, j, &t);
    }
}

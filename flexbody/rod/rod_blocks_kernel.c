// The tangents of segments and vertices put into blocks, for factors, statics and eigenvalues. Tangents have
// eight segments side by side, a block has its entries together: for eight vertices at a time, the entries of
// a row are gathered in a tile, one vertex in each lane, and the tile is transposed.
#include "flexbody/rod/rod_lanes.h"
#include "flexbody/rod/rod_tangent.h"
#include "flexbody/rod/rod_tangent_layout.h"

// Vertices v, v + 1 … in lanes, of which begin..end − 1 are moving ones.
typedef struct lanes {
    int v, begin, end;
} lanes;

static lanes lanes_from(const bough_rod_model *m, int v) {
    int end = m->n + 1 - v;
    return (lanes){v, v < 1, end < LANES ? end : LANES};
}

// A column of eight vertices' blocks, entry i of lane l at [LANES i + l] and two rows of padding, is
// stored, or added to what is there.
BOUGH_INLINE void put_tile(const tile *t, lanes at, int column, bool added, double *blocks) {
    tile turned;
    turn_tile(t->entry, LANES, turned.entry, BOUGH_COLUMN);
    for (int lane = at.begin; lane < at.end; lane++) {
        double *restrict to = blocks + BOUGH_BLOCK * (at.v - 1 + lane) + BOUGH_COLUMN * column;
        const double *restrict from = turned.entry + BOUGH_COLUMN * lane;
#pragma omp simd
        for (int i = 0; i < BOUGH_COLUMN; i++) to[i] = added ? to[i] + from[i] : from[i];
    }
}

// Column j of the forces of the segments on the vertex at their right end, by its own variation (`own`)
// and by the left end's (`other`); or the same of the left end. A shift counts as Δx of the segment
// on the left, −Δx of the one on the right; a segment pulls its left vertex by f and its right one
// by −f; moments are those on either vertex.
BOUGH_INLINE void fill_column(const double *restrict t, int j, bool right_end, tile *own, tile *other) {
    bool shift = j < 3;
    int left = (shift ? DELTA : LEFT) + j % 3, right = (shift ? DELTA : RIGHT) + j % 3;
    int mine = right_end ? right : left, its = right_end ? left : right;
    double own_sign = shift && !right_end ? -1 : 1, other_sign = shift && right_end ? -1 : 1;
    for (int i = 0; i < 6; i++) {
        int force = i < 3 ? F + i : (right_end ? LR : LL) + i - 3;
        double sign = i < 3 && right_end ? -1 : 1;
        const double *restrict row = t + LANES * DIRECTIONS * force;
#pragma omp simd
        for (int lane = 0; lane < LANES; lane++) {
            own->entry[LANES * i + lane] = sign * own_sign * row[LANES * mine + lane];
            other->entry[LANES * i + lane] = sign * other_sign * row[LANES * its + lane];
        }
    }
}

// Adds a vertex' own terms, six rows of one column, stride s.
BOUGH_INLINE void add_own(const double *restrict own, int s, tile *t) {
    for (int i = 0; i < 6; i++) {
#pragma omp simd
        for (int lane = 0; lane < LANES; lane++) t->entry[LANES * i + lane] += own[i * s + lane];
    }
}

BOUGH_INLINE void put_mass(const double *mass, lanes at, int j, double *blocks) {
    tile t = {{0}};
    add_own(mass + j * LANES, 6 * LANES, &t);
    put_tile(&t, at, j, false, blocks);
}

// Column j from the segments' tangents t, those at whose left and right ends the vertices are; own
// terms of the latter have stride `own_stride`.
BOUGH_INLINE void put_column(const double *t, int j, lanes left, lanes right, const double *own,
                             int own_stride, bough_block_tridiagonal *b) {
    tile diagonal = {{0}}, beside = {{0}};
    fill_column(t, j, true, &diagonal, &beside);
    if (own != NULL) add_own(own, own_stride, &diagonal);
    put_tile(&diagonal, right, j, false, b->diagonal);
    put_tile(&beside, right, j, false, b->lower);
    fill_column(t, j, false, &diagonal, &beside);
    put_tile(&diagonal, left, j, true, b->diagonal);
    put_tile(&beside, left, j, false, b->upper);
}

void AT(form_blocks)(const bough_rod_model *m, bough_rod_tangent *k, const bough_rod_eight *eight) {
    int s = m->stride, v = eight->first + 1;
    const double *position = k->variation + (size_t)TANGENTS * eight->first;
    lanes left = lanes_from(m, v - 1), right = lanes_from(m, v);
    for (int j = 0; j < 6; j++) {
        const double *turned = j < 3 ? NULL : k->local_position + (size_t)6 * (j - 3) * s + v;
        put_column(position, j, left, right, turned, s, &k->blocks.position);
        put_column(eight->velocity, j, left, right, eight->own_velocity + j * LANES, 6 * LANES,
                   &k->blocks.velocity);
        put_mass(eight->mass, right, j, k->blocks.mass);
    }
}

// How the arrays of a bough_rod_tangent are laid out: shared by the files that fill and use them.
#ifndef BOUGH_FLEXBODY_ROD_ROD_TANGENT_LAYOUT_H
#define BOUGH_FLEXBODY_ROD_ROD_TANGENT_LAYOUT_H

#include "core/base/base.h"

enum {
    FORCES = 9,     // f, left moment, right moment
    DIRECTIONS = 9, // Δx, φ left, φ right; then Δu, W left, W right
    TANGENTS = FORCES * DIRECTIONS,
    LANES = BOUGH_LANES,
    W8 = 8,
};

// Rows of `vertex`: what elimination and solution need of each vertex.
enum {
    KEPT_P = 0,      // quaternion as in the state, not normalised
    KEPT_W = 4,      // W
    KEPT_OMEGA = 7,  // Rᵀω
    KEPT_R = 10,     // R by columns
    KEPT_TURN = 19,  // elimination of rotations A_φ, by rows
    KEPT_SCALE = 28, // 1/(factor of the quaternion's scale)
    KEPT = 29,
};

// Rows of `work`.
enum {
    WORK_Q = 0,        // eliminated configuration residual A r_q
    WORK_SCALAR = 6,   // of the quaternion residual
    WORK_VELOCITY = 7, // residual, then increments of the velocities
    WORK = WORK_VELOCITY + W8,
};

enum { DELTA = 0, LEFT = 3, RIGHT = 6, F = 0, LL = 3, LR = 6 }; // directions; forces

// -- tiles -------------------------------------------------------------------------------------

enum { TILE = LANES * LANES };

typedef struct tile {
    _Alignas(64) double entry[TILE];
} tile;

// Row r + 4 between row r: three of these turn a tile, as each rotates the bits of the index.
BOUGH_INLINE void shuffle_tile(const double *restrict from, double *restrict to) {
    for (int r = 0; r < LANES / 2; r++) {
        const double *restrict a = from + LANES * r, *restrict b = a + TILE / 2;
        double *restrict pair = to + 2 * LANES * r;
#pragma omp simd
        for (int l = 0; l < LANES; l++) {
            pair[2 * l] = a[l];
            pair[2 * l + 1] = b[l];
        }
    }
}

// to[8 j + i] = from[8 i + j]
BOUGH_INLINE void turn_tile(const double *restrict from, double *restrict to) {
    tile once, twice;
    shuffle_tile(from, once.entry);
    shuffle_tile(once.entry, twice.entry);
    shuffle_tile(twice.entry, to);
}

#endif

// How the arrays of a bough_rod_tangent are laid out: shared by the files that fill and use them.
#pragma once

#include "core/base/base.h"

enum {
    FORCES = 9,     // f, left moment, right moment
    DIRECTIONS = 9, // Δx, φ left, φ right; then Δu, W left, W right
    TANGENTS = FORCES * DIRECTIONS,
    LANES = BOUGH_LANES,
};

// Rows of `vertex`: what elimination and solution need of each vertex.
enum {
    KEPT_P = 0,      // quaternion as in the state, not normalised
    KEPT_W = 4,      // W
    KEPT_OMEGA = 7,  // Rᵀω
    KEPT_R = 10,     // R by columns
    KEPT_TURN = 19,  // elimination of rotations A_φ, by columns
    KEPT_SCALE = 28, // 1/(factor of the quaternion's scale)
    KEPT = 29,
};

// Rows of `work`.
enum {
    WORK_Q = 0,        // eliminated configuration residual A r_q
    WORK_SCALAR = 6,   // of the quaternion residual
    WORK_VELOCITY = 7, // residual, then increments of the velocities
    WORK = WORK_VELOCITY + BOUGH_COLUMN,
};

enum { DELTA = 0, LEFT = 3, RIGHT = 6, F = 0, LL = 3, LR = 6 }; // directions; forces

// -- tiles -------------------------------------------------------------------------------------

enum { TILE = LANES * LANES };

typedef struct tile {
    _Alignas(64) double entry[TILE];
} tile;

typedef double four __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double))));

// to[to_stride j + i] = from[stride i + j] for i, j < 4
BOUGH_INLINE void turn_quarter(const double *from, int stride, double *to, int to_stride) {
    four r0 = *(const four *)from, r1 = *(const four *)(from + stride);
    four r2 = *(const four *)(from + 2 * stride), r3 = *(const four *)(from + 3 * stride);
    four even01 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6),
         odd01 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
    four even23 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6),
         odd23 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
    *(four *)to = __builtin_shufflevector(even01, even23, 0, 1, 4, 5);
    *(four *)(to + to_stride) = __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5);
    *(four *)(to + 2 * to_stride) = __builtin_shufflevector(even01, even23, 2, 3, 6, 7);
    *(four *)(to + 3 * to_stride) = __builtin_shufflevector(odd01, odd23, 2, 3, 6, 7);
}

// to[to_stride j + i] = from[stride i + j] for i, j < 8
BOUGH_INLINE void turn_tile(const double *from, int stride, double *to, int to_stride) {
    for (int i = 0; i < LANES; i += 4) {
        for (int j = 0; j < LANES; j += 4) {
            turn_quarter(from + stride * i + j, stride, to + to_stride * j + i, to_stride);
        }
    }
}

// Tiles of 8×8 doubles, between structures of arrays (a row per entry, a lane per vertex) and arrays of
// rows (a row per vertex).
#ifndef BOUGH_FLEXBODY_ROD_TILE_H
#define BOUGH_FLEXBODY_ROD_TILE_H

#include "flexbody/rod/rod_tangent_layout.h"

enum { TILE = LANES * LANES };

typedef struct tile {
    _Alignas(64) double entry[TILE];
} tile;

// Row r + 4 between row r: three of these turn a tile, as each rotates the bits of the index.
static inline void shuffle_tile(const double *restrict from, double *restrict to) {
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
static inline void turn_tile(const double *restrict from, double *restrict to) {
    tile once, twice;
    shuffle_tile(from, once.entry);
    shuffle_tile(once.entry, twice.entry);
    shuffle_tile(twice.entry, to);
}

#endif

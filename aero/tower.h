// The tower's influence on the wind: potential flow about a circular cylinder, section by section.
#ifndef BOUGH_AERO_TOWER_H
#define BOUGH_AERO_TOWER_H

#include "core/arena.h"
#include "core/status.h"
#include "core/vec3.h"

// A vertical tower; n = 0 for none. Above the last height the influence fades over
// one radius.
typedef struct bough_tower_def {
    bough_vec3 base; // [m], global axes
    int n;
    const double *height;   // (n) above the base, increasing from 0 [m]
    const double *diameter; // (n) [m]
} bough_tower_def;

typedef struct bough_tower {
    bough_vec3 base;
    int n;
    const double *height, *radius; // (n) [m]
} bough_tower;

bough_status bough_tower_build(bough_arena *arena, const bough_tower_def *def, bough_tower *tower);

// The undisturbed wind at a point, as the tower leaves it.
bough_vec3 bough_tower_disturbed(const bough_tower *tower, bough_vec3 position, bough_vec3 wind);

#endif

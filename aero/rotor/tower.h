// The tower's influence on the wind: potential flow about a circular cylinder, section by section,
// ahead of and beside the tower, and the wake behind it.
//
// C. Bak, H. A. Madsen, J. Johansen, "Influence from blade-tower interaction on fatigue loads and
// dynamics", EWEC 2001: a source in the cylinder adds what the drag displaces.
// S. R. J. Powles, Wind Engineering 7 (1983): a cosine-squared wake that widens with the root of
// the distance. Both in the form of the reference code (AeroDyn v5).
#pragma once

#include "core/base/arena.h"
#include "core/base/vec3.h"

typedef enum bough_tower_influence {
    BOUGH_TOWER_POTENTIAL,
    BOUGH_TOWER_BAK,
} bough_tower_influence;

typedef enum bough_tower_shadow {
    BOUGH_TOWER_SHADOW_NONE,
    BOUGH_TOWER_SHADOW_POWLES,
} bough_tower_shadow;

// A vertical tower; n = 0 for none. Above the last height the influence fades over one radius.
typedef struct bough_tower_def {
    bough_vec3 base; // [m], global axes
    int n;
    const double *height;   // (n) above the base, increasing from 0 [m]
    const double *diameter; // (n) [m]
    const double *drag;     // (n) coefficient, for Bak and Powles; NULL: 1 everywhere [-]
    bough_tower_influence influence;
    bough_tower_shadow shadow;
} bough_tower_def;

// As built: its tables are its own.
typedef bough_tower_def bough_tower;

// From heights that increase; n 0: there is no tower.
void bough_tower_build(bough_arena *arena, const bough_tower_def *def, bough_tower *tower);

// The drag on the tower at a place of its axis, unit vector `axis`, in air of that density [kg/m³]
// and velocity relative to the tower [m/s]; only its component normal to the axis counts [N/m].
bough_vec3 bough_tower_drag(const bough_tower *tower, double density, bough_vec3 position, bough_vec3 axis,
                            bough_vec3 inflow);

// Whether a point is low enough for the tower to matter.
static inline bool bough_tower_reaches(const bough_tower *tower, bough_vec3 position) {
    int n = tower->n;
    return n > 0 && position.z - tower->base.z < tower->height[n - 1] + tower->diameter[n - 1] / 2;
}

// How far a point is from the axis, in radii there [-]; infinite where there is no tower.
double bough_tower_distance(const bough_tower *tower, bough_vec3 position);

// The wind at a point with the tower's influence; `wind` is the undisturbed wind there [m/s].
bough_vec3 bough_tower_disturbed(const bough_tower *tower, bough_vec3 position, bough_vec3 wind);

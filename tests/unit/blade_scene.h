// The clamped blade of the NREL 5 MW turbine, of any number of segments.
#pragma once

#include "tests/unit/built_scene.h"

static inline bough_simulation *blade_scene(bough_arena *arena, int segments) {
    char set[48];
    snprintf(set, sizeof set, "bodies[0].rod.segments=%d", segments);
    return scene_build(arena, "tests/data/scenes/blade.yaml", sets_of(set));
}

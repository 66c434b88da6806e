// What the tables of a scene's keys share.
#ifndef BOUGH_APPS_SCENE_SCENE_TABLES_H
#define BOUGH_APPS_SCENE_SCENE_TABLES_H

#include "apps/bough/config/schema_keys.h"
#include "apps/bough/scene/scene_internal.h"

// clang-format off
#define ZERO3 "[0, 0, 0]"
#define WIND_SPEED_RANGE "[0, 150]"
#define PLACEMENT_FORM "list of 'move x|y|z LENGTH' and 'rotate x|y|z ANGLE'"

#define RAMP                                                                                       \
    {KEY(VECTOR, ramp), .count = 2, UNIT(TIME), .range = ">= 0", .fallback = "[0, 0]",             \
     .example = "[0 s, 20 s]",                                                                     \
     .help = "grows linearly from zero at the first time to the full value at the second; two "    \
             "equal times above 0 make a jump"}

#endif

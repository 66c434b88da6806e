// What the tables of a scene's keys share.
#ifndef BOUGH_APPS_SCENE_SCENE_TABLES_H
#define BOUGH_APPS_SCENE_SCENE_TABLES_H

#include "apps/scene/scene_internal.h"

#include <stddef.h>

// clang-format off
#define COUNT(table) (int)(sizeof(table) / sizeof(table)[0])
#define CHOICES(...) (const char *const[]){__VA_ARGS__, NULL}
#define SCHEMA(what, type, keys)                                                                   \
    .name = what, .size = sizeof(type), .n_key = COUNT(keys), .key = keys
#define ZERO3 "[0, 0, 0]"
#define PLACEMENT_FORM "list of 'move x|y|z LENGTH' and 'rotate x|y|z ANGLE'"

#define RAMP(type)                                                                                 \
    {.name = "ramp", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_TIME,                \
     .range = ">= 0", .fallback = "[0, 0]", .example = "[0 s, 20 s]",                              \
     .offset = offsetof(type, ramp),                                                               \
     .help = "grows linearly from zero at the first time to the full value at the second; two "    \
             "equal times above 0 make a jump"}

#endif

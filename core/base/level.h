// Levels of the x86-64 instruction set. A file named *_kernel.c holds loops that take most of a run's time:
// it is compiled once for each level (CMakeLists.txt), and its functions' names end in the level's. When a
// model is built, it notes the level that it calls, so that one program serves every processor. Results
// differ between levels by rounding.
#pragma once

#include <stdbool.h>

typedef enum bough_level {
    BOUGH_LEVEL_V2, // vectors of 2 doubles
    BOUGH_LEVEL_V3, // of 4, fused multiply-add
    BOUGH_LEVEL_V4, // of 8
    BOUGH_LEVEL_COUNT,
} bough_level;

// Declares the levels of a function, which has been declared without one.
#define BOUGH_DECLARE_LEVELS(name) extern __typeof__(name) name##_v2, name##_v3, name##_v4

// The function that is compiled for a level. A header defines a macro with the function's own name, which
// calls the one for its model's level.
#define BOUGH_OF_LEVEL(name, level)                                                                          \
    ((level) == BOUGH_LEVEL_V4 ? name##_v4 : (level) == BOUGH_LEVEL_V3 ? name##_v3 : name##_v2)

// The function's name in the file of kernels that defines it; BOUGH_LEVEL is the level that the file is
// compiled for. BOUGH_WIDTH is the number of doubles in a vector of that level: the compiler makes a loop
// over so many into single vector instructions.
#define BOUGH_AT_LEVEL(name) BOUGH_JOIN_LEVEL(name, BOUGH_LEVEL)
#define BOUGH_JOIN_LEVEL(name, level) BOUGH_JOIN_NAMES(name, level)
#define BOUGH_JOIN_NAMES(name, level) name##_##level

// "v2" …
const char *bough_level_name(bough_level level);

// Whether this processor has the instructions of a level.
bool bough_level_runs(bough_level level);

// The level that the environment's BOUGH_KERNELS names (v2, v3 or v4), or without it the highest that this
// processor has. False if there is no such level or the processor lacks it; *level is then the highest.
bool bough_level_choose(bough_level *level);

// The same for a model, which takes the highest in place of one that cannot be.
bough_level bough_level_chosen(void);

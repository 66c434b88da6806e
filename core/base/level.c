// Instruction sets of x86-64 for which kernels are compiled, and the choice at the start of the program.
#include "core/base/level.h"

#include <stdlib.h>
#include <string.h>

const char *bough_level_name(bough_level level) {
    static const char *const name[BOUGH_LEVEL_COUNT] = {"v2", "v3", "v4"};
    return name[level];
}

bool bough_level_runs(bough_level level) {
#ifdef __x86_64__
    if (level == BOUGH_LEVEL_V2) return true;
    bool v3 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    if (level == BOUGH_LEVEL_V3) return v3;
    return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#else
    // on other processors all levels are compiled alike
    return level == BOUGH_LEVEL_V2;
#endif
}

bool bough_level_choose(bough_level *level) {
    // the highest level that the processor runs
    *level = BOUGH_LEVEL_V4;
    while (!bough_level_runs(*level)) --*level;
    const char *wanted = getenv("BOUGH_KERNELS");
    // BOUGH_KERNELS names another one, for comparisons; it must run, too
    if (wanted == NULL) return true;
    for (int i = 0; i < BOUGH_LEVEL_COUNT; i++) {
        if (strcmp(wanted, bough_level_name(i)) != 0 || !bough_level_runs(i)) continue;
        *level = i;
        return true;
    }
    return false;
}

bough_level bough_level_chosen(void) {
    bough_level level;
    bough_level_choose(&level);
    return level;
}

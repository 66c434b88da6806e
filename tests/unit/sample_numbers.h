// Reproducible numbers, and vectors compared with what is expected of them.
#pragma once

#include "core/base/vec3.h"
#include "tests/unit/check.h"

static inline double sample_between(unsigned *seed, double low, double high) {
    *seed = *seed * 1664525u + 1013904223u;
    return low + (high - low) * (double)(*seed >> 8) / 16777216.;
}

// In [−1, 1].
static inline double sample_random(unsigned *seed) { return sample_between(seed, -1, 1); }

static inline void check_vec3(bough_vec3 value, bough_vec3 expected, double relative, double absolute) {
    check_near(value.x, expected.x, relative, absolute);
    check_near(value.y, expected.y, relative, absolute);
    check_near(value.z, expected.z, relative, absolute);
}

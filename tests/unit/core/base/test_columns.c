// Sums of weighted columns at every level of the kernels that the processor runs.

#include "core/base/linalg.h"
#include "tests/unit/sample_rod.h"

enum { N = 37, COUNT = 20 }; // more than two passes of eight columns, no whole vectors

static void check_level(bough_level level, int n, int count) {
    unsigned seed = 7;
    double column[COUNT * N], weight[COUNT], sum[N + 1], expected[N];
    for (int k = 0; k < count * n; k++) column[k] = sample_random(&seed);
    for (int j = 0; j < count; j++) weight[j] = sample_random(&seed);
    for (int i = 0; i < n; i++) sum[i] = expected[i] = sample_random(&seed);
    // a column of weight 0 is not read
    if (count > 2) {
        weight[2] = 0;
        for (int i = 0; i < n; i++) column[2 * n + i] = (double)NAN;
    }
    for (int j = 0; j < count; j++) {
        if (weight[j] == 0) continue;
        for (int i = 0; i < n; i++) expected[i] += 0.5 * weight[j] * column[j * n + i];
    }
    sum[n] = 1;
    BOUGH_OF_LEVEL(bough_add_columns, level)(n, count, column, 0.5, weight, sum);
    for (int i = 0; i < n; i++) assert_float_equal(sum[i], expected[i], 1e-14);
    assert_true(sum[n] == 1);
}

TEST(columns_are_summed_at_every_level) {
    for (bough_level level = BOUGH_LEVEL_V2; level < BOUGH_LEVEL_COUNT; level++) {
        if (!bough_level_runs(level)) continue;
        for (int n = 1; n <= N; n += 9) {
            for (int count = 0; count <= COUNT; count++) check_level(level, n, count);
        }
    }
}

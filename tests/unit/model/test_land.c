// The land turbine as shipped, its bodies coupled at the stages of the steps.
#include "tests/unit/built_scene.h"

enum { MOST = 128, ROWS = 501 };

static double (*record(const char *speed, int *n))[MOST] {
    static double rows[2][ROWS][MOST];
    static int turn;
    double(*to)[MOST] = rows[turn++ % 2];
    const char *const sets[] = {"simulation.duration=10 s", speed, NULL};
    check_arena(arena);
    bough_simulation *s = scene_build(arena, "apps/turbine/land.yaml", sets);
    bough_channels list = scene_channels(arena, s);
    assert_true(list.count <= MOST);
    *n = list.count;
    for (int k = 0; k < ROWS; k++) {
        bough_simulation_update(s);
        bough_channels_sample(&list, s->master->time, to[k]);
        if (k < ROWS - 1) scene_step(s);
    }
    return to;
}

// The last digit of a start value stays in the last digits: every channel within 1e-6 of its range.
TEST(a_last_digit_is_not_amplified) {
    int n, same;
    double(*a)[MOST] = record("bodies[2].joint.speed=0.5 rad/s", &n);
    double(*b)[MOST] = record("bodies[2].joint.speed=0.5000000000001 rad/s", &same);
    assert_int_equal(n, same);
    for (int j = 0; j < n; j++) {
        double low = HUGE_VAL, high = -HUGE_VAL, largest = 0;
        for (int k = 0; k < ROWS; k++) {
            low = fmin(low, a[k][j]);
            high = fmax(high, a[k][j]);
            largest = fmax(largest, fabs(a[k][j] - b[k][j]));
        }
        if (largest > 1e-6 * (high - low)) {
            fail_msg("channel %d differs by %.1e of its range", j, largest / (high - low));
        }
    }
}

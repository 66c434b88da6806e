#include "aero/wind/wind.h"

#include "tests/unit/check.h"

// Of a def without a table.
static bough_wind built(const bough_wind_def *def) {
    bough_wind wind;
    check_ok(bough_wind_build(NULL, def, &wind));
    return wind;
}

TEST(default_is_calm) {
    bough_wind_def def = bough_wind_def_default();
    bough_wind wind = built(&def);
    bough_vec3 v = bough_wind_at(&wind, bough_v3(1, 2, 3), 4);
    check_near(bough_norm(v), 0, 0, 0);
}

TEST(uniform_wind_blows_along_x_everywhere) {
    bough_wind_def def = bough_wind_def_default();
    def.speed = 8;
    bough_wind wind = built(&def);
    for (double z = -10; z < 200; z += 30) {
        bough_vec3 v = bough_wind_at(&wind, bough_v3(z, -z, z), z);
        check_near(v.x, 8, 0, 0);
        check_near(hypot(v.y, v.z), 0, 0, 0);
    }
}

TEST(shear_follows_power_law) {
    const bough_wind_def def = {
        .speed = 10, .shear = BOUGH_WIND_POWER, .exponent = 0.2, .reference_height = 90};
    bough_wind wind = built(&def);
    check_near(bough_wind_at(&wind, bough_v3(0, 0, 90), 0).x, 10, 1e-15, 0);
    check_near(bough_wind_at(&wind, bough_v3(0, 0, 45), 0).x, 8.705505632961241, 1e-14, 0);
    check_near(bough_wind_at(&wind, bough_v3(0, 0, -1), 0).x, 0, 0, 0);
}

// From height to height the speed grows by the same amount wherever their ratio is the same.
TEST(shear_follows_logarithmic_law) {
    const bough_wind_def def = {
        .speed = 10, .shear = BOUGH_WIND_LOG, .roughness = 0.1, .reference_height = 100};
    bough_wind wind = built(&def);
    static const double table[][2] = {{100, 10}, {10, 20. / 3}, {1, 10. / 3},   {0.1, 0},
                                      {0.05, 0}, {-5, 0},       {1000, 40. / 3}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        double u = bough_wind_at(&wind, bough_v3(3, 4, table[i][0]), 0).x;
        check_near(u, table[i][1], 1e-14, 1e-14);
    }
}

// Towards 30° from x and upwards; shear and table change the horizontal part alone.
TEST(direction_turns_the_horizontal_part) {
    const bough_wind_def def = {.speed = 8,
                                .vertical = -1.5,
                                .direction = BOUGH_PI / 6,
                                .shear = BOUGH_WIND_POWER,
                                .exponent = 0.5,
                                .reference_height = 100};
    bough_wind wind = built(&def);
    bough_vec3 v = bough_wind_at(&wind, bough_v3(5, -7, 25), 3);
    check_near(v.x, 4 * sqrt(0.75), 1e-14, 0);
    check_near(v.y, 4 * 0.5, 1e-14, 0);
    check_near(v.z, -1.5, 0, 0);
}

// A gust between uneven times; the def's tables may be gone after the build.
TEST(table_is_linear_between_and_constant_outside) {
    double time[] = {10, 12, 13, 20}, speed[] = {8, 8, 14, 7};
    const bough_wind_def def = {.speed = 99, .n_time = 4, .time = time, .speed_at_time = speed};
    check_arena(arena);
    bough_wind wind;
    check_ok(bough_wind_build(arena, &def, &wind));
    for (int i = 0; i < 4; i++) time[i] = speed[i] = -1;
    static const double expected[][2] = {{-5, 8},  {10, 8},  {11, 8},      {12, 8}, {12.5, 11},
                                         {13, 14}, {15, 12}, {16.5, 10.5}, {20, 7}, {1e6, 7}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        double u = bough_wind_at(&wind, bough_v3(0, 0, 50), expected[i][0]).x;
        check_near(u, expected[i][1], 1e-14, 0);
    }
}

// A jump; a small change; a peak; a slow change.
TEST(jumps_are_found) {
    static const struct {
        double time[5], speed[5];
        int jump;
    } wind[] = {{{0, 1.01, 1.05, 1.5, 9}, {8, 8, 20, 8, 8}, 1},
                {{0, 1.01, 1.05, 1.5, 9}, {8, 8, 8.8, 8, 8}, -1},
                {{0, 1.01, 1.05, 1.09, 9}, {8, 8, 20, 8, 8}, -1},
                {{0, 1, 1.2, 8.95, 9}, {8, 8, 20, 20, 8}, 3}};
    for (size_t i = 0; i < sizeof wind / sizeof *wind; i++) {
        const bough_wind_def def = {.n_time = 5, .time = wind[i].time, .speed_at_time = wind[i].speed};
        check_arena(arena);
        bough_wind model;
        check_ok(bough_wind_build(arena, &def, &model));
        int jump = bough_wind_jump(&model, 0.1, 0);
        assert_int_equal(jump, wind[i].jump);
        if (jump < 0) continue;
        check_near(bough_wind_row_time(&model, jump), wind[i].time[jump], 0, 0);
        assert_int_equal(bough_wind_jump(&model, 0.1, jump + 1), -1);
    }
}

// A peak between two samples, a jump, a slow gust, a peak of which the sample before it shows a half.
TEST(what_lies_between_samples_is_found) {
    static const struct {
        double time[5], speed[5], missed, at, range;
    } wind[] = {
        {{0, 1.01, 1.05, 1.09, 9}, {8, 8, 20, 8, 8}, 12, 1.05, 12},
        {{0, 1.01, 1.05, 1.09, 9}, {8, 8, 8, 20, 20}, 0, 0, 12},
        {{0, 1, 2, 3, 9}, {8, 8, 20, 8, 8}, 0, 0, 12},
        {{0, 1.05, 1.15, 1.21, 9}, {8, 8, 20, 8, 8}, 6, 1.15, 12},
    };
    for (size_t i = 0; i < sizeof wind / sizeof *wind; i++) {
        check_arena(arena);
        const bough_wind_def def = {.n_time = 5, .time = wind[i].time, .speed_at_time = wind[i].speed};
        bough_wind model;
        check_ok(bough_wind_build(arena, &def, &model));
        bough_wind_missed m = bough_wind_between(&model, 0.1, 10);
        check_near(m.speed, wind[i].missed, 0, 1e-12);
        check_near(m.time, wind[i].at, 0, 0);
        check_near(m.range, wind[i].range, 1e-15, 0);
    }
}

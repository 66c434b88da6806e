#include "apps/bough/cases/counts.h"

#include "tests/unit/sample_numbers.h"

static bough_rainflow counted(const double *x, int n, const double *slope, int n_slope) {
    bough_rainflow r = {.n_slope = n_slope};
    memcpy(r.slope, slope, (size_t)n_slope * sizeof *slope);
    for (int i = 0; i < n; i++) bough_rainflow_add(&r, x[i]);
    bough_rainflow_finish(&r);
    return r;
}

static double cycles_of(const bough_rainflow *r, double range) {
    double width = bough_levels_width(&r->ranges);
    return bough_levels_inside(&r->ranges, (int64_t)floor(range / width));
}

// The example of ASTM E1049-85, figure 6: points A to I, and its table of cycles by range.
TEST(counts_the_example_of_the_standard) {
    static const double history[] = {-2, 1, -3, 5, -1, 3, -4, 4, -2}, slope[] = {1, 3, 10};
    static const double table[][2] = {{10, 0}, {9, 0.5}, {8, 1},   {7, 0}, {6, 0.5},
                                      {5, 0},  {4, 1.5}, {3, 0.5}, {2, 0}, {1, 0}};
    bough_rainflow r = counted(history, 9, slope, 3);
    double sum[3] = {0};
    assert_true(bough_levels_width(&r.ranges) <= 1);
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        check_near(cycles_of(&r, table[i][0]), table[i][1], 0, 0);
        for (int k = 0; k < 3; k++) sum[k] += table[i][1] * pow(table[i][0], slope[k]);
    }
    check_near(r.cycles, 4, 0, 0);
    for (int k = 0; k < 3; k++) check_near(r.damage[k], sum[k], 1e-14, 0);
    check_near(r.forced, 0, 0, 0);
}

// Samples between the turning points and values that stand still change nothing.
TEST(only_turning_points_count) {
    static const double dense[] = {-2, -2, 0, 1, 1, -1, -3, 0, 5, 5, 4,  -1, -1,
                                   1,  3,  2, 2, 0, -4, -4, 0, 4, 3, -2, -2},
                        slope[] = {3};
    bough_rainflow r = counted(dense, sizeof dense / sizeof *dense, slope, 1);
    check_near(r.damage[0], 0.5 * (729 + 216 + 27) + 512 + 1.5 * 64, 1e-14, 0);
}

// n periods of a sine of amplitude a: n cycles of range 2a, so its equivalent load at n cycles is 2a
// for every slope.
TEST(equivalent_load_of_a_sine_is_its_range) {
    enum { PERIODS = 50, PER = 40 };
    static const double slope[] = {3, 4, 10};
    double x[PERIODS * PER + 1];
    for (int i = 0; i <= PERIODS * PER; i++) x[i] = 7 + 2.5 * cos(2 * 3.14159265358979323846 * i / PER);
    bough_rainflow r = counted(x, PERIODS * PER + 1, slope, 3);
    for (int k = 0; k < 3; k++)
        check_near(bough_equivalent_load(r.damage[k], slope[k], PERIODS), 5, 1e-12, 0);
}

// A converging history holds all its ranges open: more of them than fit are counted early, the
// smallest, and the sum for a steep slope does not see it.
TEST(memory_is_bounded) {
    static const double slope[] = {1, 10};
    enum { TURNS = 5000 };
    bough_rainflow r = {.n_slope = 2, .slope = {1, 10}};
    double sum[2] = {0};
    for (int i = 0; i < TURNS; i++) bough_rainflow_add(&r, (i % 2 ? -1. : 1.) * (TURNS - i));
    bough_rainflow_finish(&r);
    for (int i = 0; i + 1 < TURNS; i++)
        for (int k = 0; k < 2; k++) sum[k] += 0.5 * pow(2 * (TURNS - i) - 1, slope[k]);
    assert_true(r.forced > 0);
    check_near(r.cycles, (TURNS - 1) / 2., 1, 0);
    check_near(r.damage[0], sum[0], 0.02, 0);
}

// -- levels ---------------------------------------------------------------------------------------

static void check_same_levels(const bough_levels *a, const bough_levels *b) {
    assert_int_equal(a->exponent, b->exponent);
    assert_int_equal(a->low, b->low);
    assert_int_equal(a->high, b->high);
    for (int64_t k = a->low; k <= a->high; k++) {
        check_near(bough_levels_inside(a, k), bough_levels_inside(b, k), 0, 0);
        check_near(bough_levels_crossed(a, k), bough_levels_crossed(b, k), 0, 0);
    }
}

// Against a count that knows the width from the start, over values that spread while they come.
TEST(levels_are_those_of_a_second_count) {
    enum { N = 20000 };
    static double x[N];
    unsigned seed = 7;
    bough_levels l = {0};
    for (int i = 0; i < N; i++) {
        x[i] = (sample_between(&seed, 0, 1) - 0.4) * (1 + i * 0.01);
        bough_levels_follow(&l, x[i]);
    }
    double width = bough_levels_width(&l);
    assert_true(l.high - l.low < BOUGH_LEVELS && 2 * (l.high - l.low) > BOUGH_LEVELS - 4);
    for (int64_t k = l.low; k <= l.high; k++) {
        double inside = 0, crossed = 0;
        for (int i = 0; i < N; i++) {
            inside += floor(x[i] / width) == (double)k;
            crossed += i > 0 && x[i - 1] < (double)k * width && x[i] >= (double)k * width;
        }
        check_near(bough_levels_inside(&l, k), inside, 0, 0);
        check_near(bough_levels_crossed(&l, k), crossed, 0, 0);
    }
}

TEST(parts_add_to_the_whole) {
    bough_levels whole = {0}, part[3] = {{0}}, sum = {0}, other = {0};
    unsigned seed = 3;
    for (int i = 0; i < 3000; i++) {
        double x = (sample_between(&seed, 0, 1) - 0.5) * (i < 1000 ? 1e-3 : i < 2000 ? 5 : 400);
        bough_levels_add(&whole, x, 1);
        bough_levels_add(&part[i / 1000], x, 1);
    }
    for (int i = 0; i < 3; i++) bough_levels_merge(&sum, &part[i], 1, 1);
    for (int i = 2; i >= 0; i--) bough_levels_merge(&other, &part[i], 1, 1);
    check_same_levels(&whole, &sum);
    check_same_levels(&whole, &other);
}

TEST(constant_and_zero_have_one_level) {
    bough_levels l = {0};
    for (int i = 0; i < 10; i++) bough_levels_follow(&l, 0);
    check_near(bough_levels_inside(&l, 0), 10, 0, 0);
    assert_int_equal(l.low, l.high);
    bough_levels_follow(&l, 1e300);
    bough_levels_follow(&l, -1e300);
    double sum = 0;
    for (int64_t k = l.low; k <= l.high; k++) sum += bough_levels_inside(&l, k);
    check_near(sum, 12, 0, 0);
}

// -- a run's counts -------------------------------------------------------------------------------

TEST(extremes_come_with_all_channels) {
    static const double slope[] = {4}, rows[][2] = {{1, 10}, {5, 20}, {-2, 30}, {5, 40}, {0, NAN}};
    check_arena(arena);
    bough_counts c;
    bough_counts_take(arena, 2, 1, slope, &c);
    for (int i = 0; i < 5; i++) bough_counts_add(&c, 0.5 * i, rows[i]);
    bough_counts_finish(&c);
    const bough_channel_counts *first = &c.channel[0];
    check_near(first->at_most[1], 20, 0, 0); // the first time
    check_near(first->at_least[1], 30, 0, 0);
    check_near(first->at_least[0], -2, 0, 0);
    check_near(first->statistics.most_at, 0.5, 0, 0);
    check_near(first->statistics.least_at, 1, 0, 0);
    check_near(c.channel[1].at_most[0], 5, 0, 0);
    check_near(c.broken, 1, 0, 0);
}

TEST(statistics_hold_beside_a_large_mean) {
    bough_sample_statistics s = {0};
    assert_true(isnan(bough_sample_statistics_deviation(&s)));
    for (int i = 0; i < 100000; i++) bough_sample_statistics_add(&s, i, 1e9 + (i % 2 ? 0.5 : -0.5));
    check_near(s.mean, 1e9, 1e-15, 0);
    check_near(bough_sample_statistics_deviation(&s), 0.5, 1e-6, 0);
    check_near(s.least, 1e9 - 0.5, 0, 0);
    check_near(s.most_at, 1, 0, 0);
}

#include "apps/bough/results/channels.h"

#include "tests/unit/check.h"

static void sample_times(void *self, double t, double *value) {
    double *factor = self;
    for (int i = 0; i < 3; i++) value[i] = factor[i] * t;
}

static void sample_one(void *self, double t, double *value) {
    (void)t;
    *value = *(double *)self;
}

TEST(groups_fill_their_own_channels) {
    check_arena(arena);
    bough_channels list = bough_channels_start(arena);
    double factor[3] = {1, 2, 3}, constant = 7;
    bough_channels_group(&list, sample_times, factor);
    for (int i = 1; i <= 3; i++) {
        bough_channels_add(&list, "m", "OoPDefl%d", i);
        assert_true(bough_is_ok(&list.status));
    }
    bough_channels_group(&list, sample_one, &constant);
    bough_channels_add(&list, "rpm", "RotSpeed");
    assert_int_equal(list.count, 4);
    assert_int_equal(bough_channels_find(&list, "OoPDefl2"), 1);
    assert_int_equal(bough_channels_find(&list, "OoPDefl"), -1);
    double value[4];
    bough_channels_sample(&list, 10, value);
    check_near(value[0], 10, 0, 0);
    check_near(value[2], 30, 0, 0);
    check_near(value[3], 7, 0, 0);
}

// Also per length.
TEST(forces_and_moments_are_loads) {
    static const char *const unit[] = {"kN-m", "N", "N/m", "rpm", "-", "kW"};
    check_arena(arena);
    bough_channels list = bough_channels_start(arena);
    bough_channels_group(&list, sample_times, NULL);
    for (int i = 0; i < 6; i++) bough_channels_add(&list, unit[i], "c%d", i);
    for (int i = 0; i < 6; i++) assert_int_equal(list.channel[i].load, i < 3);
}

TEST(known_values_are_those_of_copies_and_choices) {
    check_arena(arena);
    static const char *const pattern[] = {"RotSpeed"};
    const double known[3] = {4, 5, 6};
    bough_channels list = bough_channels_start(arena), copy, chosen;
    double factor[3] = {1, 2, 3}, value[3];
    bough_channels_group(&list, sample_times, factor);
    bough_channels_add(&list, "m", "OoPDefl1");
    bough_channels_add(&list, "m", "IPDefl1");
    bough_channels_add(&list, "rpm", "RotSpeed");
    assert_int_equal(bough_channels_choose(&list, 0, NULL, &copy), -1);
    assert_int_equal(bough_channels_choose(&list, 1, pattern, &chosen), -1);
    bough_channels_know(&copy, known);
    bough_channels_sample(&list, 10, value);
    assert_memory_equal(value, known, sizeof known);
    bough_channels_sample(&chosen, 10, value);
    check_near(value[0], 6, 0, 0);
    bough_channels_know(&list, NULL);
    bough_channels_sample(&copy, 10, value);
    check_near(value[1], 20, 0, 0);
    bough_channels_sample(&chosen, 10, value);
    check_near(value[0], 30, 0, 0);
}

TEST(an_empty_group_is_not_asked) {
    check_arena(arena);
    bough_channels list = bough_channels_start(arena);
    bough_channels_group(&list, sample_one, NULL);
    bough_channels_sample(&list, 0, NULL);
}

TEST(list_grows_without_losing_names) {
    check_arena(arena);
    bough_channels list = bough_channels_start(arena);
    bough_channels_group(&list, sample_one, NULL);
    for (int i = 0; i < 1000; i++) bough_channels_add(&list, "-", "channel%d", i);
    assert_int_equal(list.count, 1000);
    assert_string_equal(list.channel[0].name, "channel0");
    assert_int_equal(bough_channels_find(&list, "channel999"), 999);
}

TEST(names_that_readers_cannot_split_are_refused) {
    static const char *bad[] = {
        "",     "two words", "tab\tname",
        "Time", "twice",     "a_name_that_is_quite_a_bit_longer_than_forty_seven_characters",
    };
    check_arena(arena);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        bough_channels list = bough_channels_start(arena);
        bough_channels_group(&list, sample_one, NULL);
        bough_channels_add(&list, "m", "twice");
        bough_channels_add(&list, "m", "%s", bad[i]);
        assert_int_equal(list.status.code, BOUGH_INVALID);
        assert_true(strlen(list.status.message) > 0);
        bough_channels_add(&list, "m", "after");
        assert_int_equal(list.count, 1);
    }
}

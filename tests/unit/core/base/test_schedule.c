// Ramps and tables in time at their corners, between and outside.
#include "tests/unit/check.h"

#include "core/base/schedule.h"

TEST(ramp_grows_between_its_times) {
    const bough_schedule ramp = {.start = 1, .end = 3}, always = {.start = 0}, jump = {.start = 2, .end = 2};
    check_near(bough_schedule_at(&always, -1), 1, 0, 0);
    check_near(bough_schedule_at(&jump, 1.999), 0, 0, 0);
    check_near(bough_schedule_at(&jump, 2), 1, 0, 0);
    check_near(bough_schedule_at(&ramp, 0.5), 0, 0, 0);
    check_near(bough_schedule_at(&ramp, 1.5), 0.25, 0, 1e-15);
    check_near(bough_schedule_at(&ramp, 4), 1, 0, 0);
}

TEST(table_is_linear_and_held_outside) {
    const double times[] = {1, 2, 4, 8, 9}, values[] = {-1, 3, 3, 5, 0};
    const bough_schedule table = {.n = 5, .times = times, .values = values};
    for (int k = 0; k < 5; k++) check_near(bough_schedule_at(&table, times[k]), values[k], 0, 0);
    check_near(bough_schedule_at(&table, 0), -1, 0, 0);
    check_near(bough_schedule_at(&table, 1.25), 0, 0, 1e-15);
    check_near(bough_schedule_at(&table, 7), 4.5, 1e-15, 0);
    check_near(bough_schedule_at(&table, 10), 0, 0, 0);
}

TEST(row_is_the_one_that_holds_the_time) {
    const double rows[][3] = {{0, 7, 7}, {1, 7, 7}, {3, 7, 7}, {4, 7, 7}};
    const double t[] = {0, 0.5, 1, 2.9, 3, 3.5}, row[] = {0, 0, 1, 1, 2, 2};
    for (int k = 0; k < 6; k++) assert_int_equal(bough_table_row(4, rows[0], 3, t[k]), row[k]);
}

// The library's public face.
#include "tests/check.h"

#include "apps/api/bough.h"

#include <string.h>

static const char pendulum[] = BOUGH_SOURCE_DIR "/apps/mechanisms/pendulum.yaml";

static void steps_to_the_end_and_reads(void **context) {
    (void)context;
    const char *const set[] = {"simulation.duration=0.5 s"};
    bough_session *s = bough_session_open(pendulum, set, 1);
    assert_int_equal(bough_session_code(s), BOUGH_SESSION_OK);
    assert_string_equal(bough_session_error(s), "");
    assert_true(bough_session_count(s) > 1);
    int channel = 0;
    assert_int_equal(bough_session_find(s, bough_session_name(s, channel)), channel);
    assert_true(bough_session_unit(s, channel)[0] != 0);
    double first = bough_session_read(s, channel);
    int steps = 0;
    while (bough_session_step(s) == BOUGH_SESSION_OK) steps++;
    assert_true(steps > 1);
    check_near(bough_session_time(s), 0.5, 1e-12, 0);
    check_near(bough_session_duration(s), 0.5, 1e-12, 0);
    assert_true(fabs(bough_session_read(s, channel) - first) > 1e-3);
    assert_int_equal(bough_session_step(s), BOUGH_SESSION_DONE);
    assert_int_equal(bough_session_code(s), BOUGH_SESSION_OK);
    bough_session_close(s);
}

static void errors_are_told(void **context) {
    (void)context;
    const char *const set[] = {"simulation.duration=-1 s", "simulation.macro_step=2 m"};
    bough_session *s = bough_session_open(pendulum, set, 2);
    assert_int_equal(bough_session_code(s), BOUGH_SESSION_INVALID);
    assert_non_null(strstr(bough_session_error(s), "duration"));
    assert_non_null(strstr(bough_session_error(s), "macro_step")); // both of them
    assert_int_equal(bough_session_step(s), BOUGH_SESSION_INVALID);
    assert_true(isnan(bough_session_time(s)));
    assert_true(isnan(bough_session_read(s, 0)));
    assert_int_equal(bough_session_find(s, "any"), -1);
    bough_session_close(s);
    s = bough_session_open("/nowhere/scene.yaml", NULL, 0);
    assert_int_not_equal(bough_session_code(s), BOUGH_SESSION_OK);
    assert_non_null(strstr(bough_session_error(s), "/nowhere/scene.yaml"));
    bough_session_close(s);
}

static void sessions_live_side_by_side(void **context) {
    (void)context;
    bough_session *a = bough_session_open(pendulum, NULL, 0);
    bough_session *b = bough_session_open(pendulum, NULL, 0);
    for (int k = 0; k < 20; k++) bough_session_step(a);
    for (int k = 0; k < 20; k++) {
        bough_session_step(b);
        if (k == 10) bough_session_step(a);
    }
    bough_session_step(b);
    for (int i = 0; i < bough_session_count(a); i++) {
        assert_true(bough_session_read(a, i) == bough_session_read(b, i));
    }
    bough_session_close(a);
    bough_session_close(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_to_the_end_and_reads),
        cmocka_unit_test(errors_are_told),
        cmocka_unit_test(sessions_live_side_by_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "apps/bough/results/summary.h"

#include "apps/bough/results/progress.h"
#include "tests/unit/scratch.h"

TEST_IN_FOLDER(fields_arrays_and_objects_are_nested) {
    bough_summary s;
    check_ok(bough_summary_open(&s, *context, "summary.json"));
    bough_summary_text(&s, "scheme", "ramp");
    bough_summary_number(&s, "macro_step_s", 0.1);
    bough_summary_integer(&s, "states", 1234567890123);
    bough_summary_array(&s, "bodies");
    bough_summary_object(&s, NULL);
    bough_summary_text(&s, "name", "blade1");
    bough_summary_end(&s);
    bough_summary_number(&s, NULL, 1.0 / 3);
    bough_summary_end(&s);
    bough_summary_array(&s, "none"); // left open on purpose
    assert_false(scratch_has(*context, "summary.json"));
    check_ok(bough_summary_close(&s));
    char *text = scratch_read(*context, "summary.json");
    assert_string_equal(text, "{\n"
                              "  \"scheme\": \"ramp\",\n"
                              "  \"macro_step_s\": 0.1,\n"
                              "  \"states\": 1234567890123,\n"
                              "  \"bodies\": [\n"
                              "    {\n"
                              "      \"name\": \"blade1\"\n"
                              "    },\n"
                              "    0.33333333333333331\n"
                              "  ],\n"
                              "  \"none\": []\n"
                              "}\n");
    free(text);
    assert_false(scratch_has(*context, "summary.json.partial"));
}

TEST_IN_FOLDER(what_json_does_not_know_becomes_null) {
    bough_summary s;
    bough_summary_open(&s, *context, "summary.json");
    bough_summary_number(&s, "a", NAN);
    bough_summary_number(&s, "b", -INFINITY);
    bough_summary_text(&s, "c", NULL);
    bough_summary_close(&s);
    char *text = scratch_read(*context, "summary.json");
    assert_string_equal(text, "{\n  \"a\": null,\n  \"b\": null,\n  \"c\": null\n}\n");
    free(text);
}

TEST_IN_FOLDER(texts_are_escaped) {
    bough_summary s;
    bough_summary_open(&s, *context, "summary.json");
    bough_summary_text(&s, "a", "\"\\\n\t\x01 ω \xFF\xC3");
    bough_summary_close(&s);
    char *text = scratch_read(*context, "summary.json");
    assert_string_equal(text, "{\n  \"a\": \"\\\"\\\\\\n\\u0009\\u0001 ω \\ufffd\\ufffd\"\n}\n");
    free(text);
}

TEST_IN_FOLDER(numbers_survive_the_round_trip) {
    static const double numbers[] = {0.0, -1.5e-300, 1e22, 4.9406564584124654e-324, 123.456789012345678};
    bough_summary s;
    bough_summary_open(&s, *context, "summary.json");
    for (int i = 0; i < 5; i++) bough_summary_number(&s, "x", numbers[i]);
    bough_summary_close(&s);
    char *text = scratch_read(*context, "summary.json");
    const char *at = text;
    for (int i = 0; i < 5; i++) {
        at = strstr(at, ": ") + 2;
        check_near(strtod(at, NULL), numbers[i], 0, 0);
    }
    free(text);
}

TEST_IN_FOLDER(unwritable_place_is_an_error_of_files) {
    char partial[128];
    bough_summary s;
    check_fails(bough_summary_open(&s, "/proc/none", "summary.json"), BOUGH_IO, "/proc/none");

    snprintf(partial, sizeof partial, "%s/summary.json.partial", (char *)*context);
    assert_int_equal(symlink("/dev/full", partial), 0);
    check_ok(bough_summary_open(&s, *context, "summary.json"));
    check_fails(bough_summary_close(&s), BOUGH_IO, "summary.json");
    assert_false(scratch_has(*context, "summary.json"));
}

TEST(progress_tells_speed_and_time_left) {
    bough_progress p = bough_progress_start(10, 40, true);
    assert_false(p.visible);
    char text[128];
    bough_progress_text(&p, 20, 5, 72, text, sizeof text);
    assert_string_equal(text, "20.00 of 40 s, 2 times real time, 0:10 left");
    bough_progress_text(&p, 10, 5, 72, text, sizeof text);
    assert_string_equal(text, "10.00 of 40 s");
    p.label = "scheme=monolithic, macro_step=20 ms";
    bough_progress_text(&p, 20, 5, 39, text, sizeof text);
    assert_string_equal(text, "scheme=monolith    20.00 of 40 s");
}

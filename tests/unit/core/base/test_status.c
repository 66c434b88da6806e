// Messages: whole where they fit, else cut after a word.
#include "core/base/status.h"
#include "tests/unit/check.h"

TEST(message_is_as_written) {
    bough_status status = bough_fail(BOUGH_INVALID, "rod %s: %d segments", "blade", 3);
    assert_int_equal(status.code, BOUGH_INVALID);
    assert_string_equal(status.message, "rod blade: 3 segments");
}

TEST(long_message_ends_after_a_word) {
    char words[3 * BOUGH_MESSAGE];
    for (int shift = 0; shift < 12; shift++) {
        memset(words, 'x', sizeof words);
        words[shift] = '\0';
        while (strlen(words) < 2 * BOUGH_MESSAGE) strcat(words, "equilibrium ");
        bough_status status = bough_fail(BOUGH_FAILED, "%s", words);
        size_t length = strlen(status.message);
        assert_true(length > BOUGH_MESSAGE - 20 && length < BOUGH_MESSAGE);
        assert_string_equal(status.message + length - 15, "equilibrium ...");
    }
    memset(words, 'x', 2 * BOUGH_MESSAGE); // no word ends
    bough_status status = bough_fail(BOUGH_FAILED, "%s", words);
    assert_string_equal(status.message + strlen(status.message) - 4, " ...");
}

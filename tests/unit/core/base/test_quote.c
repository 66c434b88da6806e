#include "core/base/quote.h"

#include "tests/unit/check.h"

// Every reader of JSON, YAML and JavaScript gives the text back, and no script in a page ends.
TEST(text_is_quoted_for_every_reader) {
    static const struct {
        const char *text, *quoted;
    } rows[] = {
        {"", "\"\""},
        {"a \"b\" \\c", "\"a \\\"b\\\" \\\\c\""},
        {"one\ntwo\t\x01", "\"one\\ntwo\\u0009\\u0001\""},
        {"</script>", "\"\\u003c/script>\""},
        {"µ 中 😀", "\"µ 中 😀\""},
        {"\xC0\xAF\xE4\xB8z\xFF", "\"\\ufffd\\ufffd\\ufffd\\ufffdz\\ufffd\""}, // no UTF-8
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char written[100] = "";
        FILE *file = fmemopen(written, sizeof written, "w");
        bough_quote(file, rows[k].text);
        fclose(file);
        assert_string_equal(written, rows[k].quoted);
    }
}

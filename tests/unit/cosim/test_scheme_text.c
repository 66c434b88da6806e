// What schemes say of themselves.
#include "cosim/scheme.h"
#include "tests/unit/check.h"

// A description has the options that the scheme reads, and no others.
TEST(schemes_are_described_by_what_they_read) {
    static const struct {
        unsigned option;
        const char *text;
    } part[] = {{BOUGH_READS_ORDER, ", order 2"},
                {BOUGH_READS_THETA, ", theta 0.7"},
                {BOUGH_READS_ACCELERATOR, ", accelerator aitken, tolerance 1e-05 in at most 7 iterations"}};
    bough_scheme_options o = bough_scheme_options_default();
    o.order = 2, o.theta = .7, o.accelerator = BOUGH_ACCELERATE_AITKEN, o.tolerance = 1e-5, o.iterations = 7;
    char text[BOUGH_SCHEME_TEXT];
    int found = 0;
    for (int i = 0; bough_scheme_at(i); i++) {
        const bough_scheme *scheme = bough_scheme_at(i);
        bough_scheme_describe(scheme, &o, text);
        assert_int_equal(strncmp(text, scheme->name, strlen(scheme->name)), 0);
        for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
            bool reads = bough_scheme_reads(scheme, part[k].option);
            assert_int_equal(strstr(text, part[k].text) != NULL, reads);
            found += reads;
        }
    }
    assert_true(found >= 4);
    o.exchange = BOUGH_EXCHANGE_WAVEFORM;
    bough_scheme_describe(bough_scheme_find("iterated"), &o, text);
    assert_non_null(strstr(text, "iterated, waveforms, accelerator aitken"));
}

// Keys of a scene are read by some schemes, not by all; every option has one.
TEST(keys_belong_to_some_schemes) {
    unsigned all = 0;
    for (int k = 0; bough_scheme_key_at(k); k++) {
        unsigned option = bough_scheme_key_at(k)->option;
        int n = 0, readers = 0;
        for (; bough_scheme_at(n); n++) readers += bough_scheme_reads(bough_scheme_at(n), option);
        assert_true(readers > 0 && readers < n);
        all |= option;
    }
    assert_int_equal(all, BOUGH_READS_ORDER | BOUGH_READS_THETA | BOUGH_READS_EXCHANGE |
                              BOUGH_READS_ACCELERATOR | BOUGH_READS_MEMBERS);
}

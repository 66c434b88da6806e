// Numbers written fast are printf's, byte for byte.
#include "apps/bough/results/recorder.h"
#include "tests/unit/sample_rod.h"

#include <float.h>

static void check_same(double x) {
    char fast[32], slow[32];
    bough_number_write(fast, 17, x);
    snprintf(slow, sizeof slow, "%17.8E", x);
    assert_string_equal(fast, slow);
}

TEST(random_numbers_of_all_sizes) {
    unsigned seed = 7;
    for (int k = 0; k < 300000; k++) {
        double size = 40 * sample_random(&seed);
        check_same(sample_random(&seed) * pow(10, size));
    }
}

// Ties between two last digits, powers of ten and their neighbours, whole numbers.
TEST(hard_cases) {
    for (int e = -30; e <= 30; e++) {
        double x = pow(10, e);
        const double near[] = {
            x, nextafter(x, 0), nextafter(x, 1e300), 9.999999995 * x, 1.000000005 * x, 5 * x, -x};
        for (size_t k = 0; k < sizeof near / sizeof *near; k++) check_same(near[k]);
    }
    for (int k = 0; k < 1000; k++) {
        check_same(1000000000.0 + 5 + 10 * k); // ten digits that end in five
        check_same(ldexp(100000001 + 2 * k, -1));
        check_same(ldexp(200000001 + 2 * k, -2));
    }
    const double odd[] = {0.0, -0.0, INFINITY, -INFINITY, DBL_MAX, -DBL_MAX, DBL_MIN, 4.9e-324};
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) check_same(odd[k]);
    check_same((double)NAN);
}

// The tests' comparison: cmocka's float assertion passes NaN and has single precision.
#ifndef BOUGH_TESTS_CHECK_H
#define BOUGH_TESTS_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

// |value − expected| <= absolute + relative·|expected|; NaN fails.
#define check_near(value, expected, relative, absolute)                                                      \
    check_near_at((value), (expected), (relative), (absolute), #value, __FILE__, __LINE__)

static inline void check_near_at(double value, double expected, double relative, double absolute,
                                 const char *what, const char *file, int line) {
    if (fabs(value - expected) <= absolute + relative * fabs(expected)) return;
    print_error("%s = %.15g, expected %.15g (off by %.3g)\n", what, value, expected, value - expected);
    _fail(file, line);
}

#endif

// What every test file includes: cmocka, the usual headers of the C library, the declaration
// of a test, and the comparison of numbers.
//
//     TEST(a_sentence_that_holds) { check_near(length, 2, 1e-12, 0); }
//
// is a test that check.c runs. TEST_WITH gives it a set-up and a tear-down of its own, which pass it
// *context; GROUP those of all tests of the file.
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "core/base/arena.h"
#include "core/base/base.h"
#include "core/base/status.h"

#include <string.h>

void check_add_test(struct CMUnitTest test);
void check_set_group(CMFixtureFunction set_up, CMFixtureFunction tear_down);

#define TEST_WITH(name, set_up, tear_down)                                                                   \
    static void name(void **context);                                                                        \
    __attribute__((constructor)) static void add_##name(void) {                                              \
        check_add_test((struct CMUnitTest){#name, name, set_up, tear_down, NULL});                           \
    }                                                                                                        \
    static void name(__attribute__((unused)) void **context)
#define TEST(name) TEST_WITH(name, NULL, NULL)
#define GROUP(set_up, tear_down)                                                                             \
    __attribute__((constructor)) static void set_group(void) { check_set_group(set_up, tear_down); }

// The call must succeed; its message is printed.
#define check_ok(call) check_ok_at((call), #call, __FILE__, __LINE__)

// The call must fail with this code and with a message that contains the text.
#define check_fails(call, expected, text)                                                                    \
    check_fails_at((call), (expected), (text), #call, __FILE__, __LINE__)

// Memory for fixtures: a new arena, which ends with the program unless it is destroyed before.
bough_arena *check_memory(void);

// Memory until the end of the block.
#define check_arena(name) __attribute__((cleanup(check_end_arena))) bough_arena *name = bough_arena_create()

// cmocka's own comparison passes NaN and has single precision: |value − expected| <= absolute +
// relative·|expected|; NaN fails.
#define check_near(value, expected, relative, absolute)                                                      \
    check_near_at((value), (expected), (relative), (absolute), #value, __FILE__, __LINE__)

static inline void check_ok_at(bough_status status, const char *what, const char *file, int line) {
    if (bough_is_ok(&status)) return;
    print_error("%s: %s\n", what, status.message);
    _fail(file, line);
}

static inline void check_fails_at(bough_status status, bough_code expected, const char *text,
                                  const char *what, const char *file, int line) {
    if (status.code == expected && strstr(status.message, text) != NULL) return;
    print_error("%s: code %d instead of %d, or \"%s\" does not say \"%s\"\n", what, (int)status.code,
                (int)expected, status.message, text);
    _fail(file, line);
}

static inline void check_end_arena(bough_arena **arena) { bough_arena_destroy(*arena); }

static inline void check_near_at(double value, double expected, double relative, double absolute,
                                 const char *what, const char *file, int line) {
    if (fabs(value - expected) <= absolute + relative * fabs(expected)) return;
    print_error("%s = %.15g, expected %.15g (off by %.3g)\n", what, value, expected, value - expected);
    _fail(file, line);
}

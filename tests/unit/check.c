// The program around the tests of a file: it runs them in the order in which the file declares them.
#include "tests/unit/check.h"

#include <assert.h>

enum { MOST_TESTS = 64 };

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): filled before main starts
static struct CMUnitTest tests[MOST_TESTS];
static size_t n_test;
static CMFixtureFunction group_set_up, group_tear_down;
static bough_arena *memory;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void check_add_test(struct CMUnitTest test) {
    assert(n_test < MOST_TESTS);
    tests[n_test++] = test;
}

void check_set_group(CMFixtureFunction set_up, CMFixtureFunction tear_down) {
    group_set_up = set_up, group_tear_down = tear_down;
}

bough_arena *check_memory(void) {
    if (memory == NULL) memory = bough_arena_create();
    return bough_arena_child(memory);
}

// cmocka passes over the places that are empty.
int main(void) {
    int failures = cmocka_run_group_tests(tests, group_set_up, group_tear_down);
    bough_arena_destroy(memory);
    return failures;
}

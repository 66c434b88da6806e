// The shipped studies of coupling schemes on masses and springs: every figure is the expected one.
#include "tests/unit/check.h"
#include "tests/unit/scratch.h"
#include "tests/verification/verification.h"

static void perform(const char *folder, const char *name, const char *csv, int rows) {
    char path[512];
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_verification study;
    FILE *stream = tmpfile();
    snprintf(path, sizeof path, BOUGH_SOURCE_DIR "/tests/verification/%s", name);
    bough_status status = bough_verification_read(arena, path, &errors, &study);
    bough_errors_print(&errors, stderr);
    assert_int_equal(status.code, BOUGH_OK);
    bough_verification_options options = {.folder = folder, .quiet = true, .stream = stream};
    status = bough_verification_perform(arena, &study, &options);
    if (!bough_is_ok(&status)) print_error("%s\n", status.message);
    assert_int_equal(status.code, BOUGH_OK);
    char *table = scratch_read(folder, csv), *picture = scratch_read(folder, "plot.svg");
    int lines = 0;
    for (const char *c = table; *c; c++) lines += *c == '\n';
    assert_int_equal(lines, rows);
    assert_non_null(strstr(picture, "</svg>"));
    free(table);
    free(picture);
    fclose(stream);
    bough_arena_destroy(arena);
}

static void two_masses(void **state) { perform(*state, "two-mass.yaml", "two-mass.csv", 1 + 54); }

static void added_mass(void **state) {
    perform(*state, "added-mass.yaml", "added-mass.csv", 1 + 6 * 5 + 10 * 8);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(two_masses, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(added_mass, scratch_make, scratch_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// The shipped studies of coupling schemes on masses and springs: every figure is the expected one.
#include "tests/unit/check.h"
#include "tests/unit/scratch.h"
#include "tests/verification/verification.h"

static void perform(const char *folder, const char *name, const char *csv, int rows) {
    char path[512];
    check_arena(arena);
    bough_errors errors = {.arena = arena};
    bough_verification study;
    FILE *stream = tmpfile();
    snprintf(path, sizeof path, BOUGH_SOURCE_DIR "/tests/verification/%s", name);
    bough_status status = bough_verification_read(arena, path, &errors, &study);
    bough_errors_print(&errors, stderr);
    assert_int_equal(status.code, BOUGH_OK);
    bough_verification_options options = {.folder = folder, .quiet = true, .stream = stream};
    check_ok(bough_verification_perform(arena, &study, &options));
    char *table = scratch_read(folder, csv), *picture = scratch_read(folder, "plot.svg");
    int lines = 0;
    for (const char *c = table; *c; c++) lines += *c == '\n';
    assert_int_equal(lines, rows);
    assert_non_null(strstr(picture, "</svg>"));
    free(table);
    free(picture);
    fclose(stream);
}

TEST_IN_FOLDER(two_masses) { perform(*context, "two-mass.yaml", "two-mass.csv", 1 + 54); }

TEST_IN_FOLDER(added_mass) { perform(*context, "added-mass.yaml", "added-mass.csv", 1 + 6 * 5 + 10 * 8); }

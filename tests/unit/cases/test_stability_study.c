// Studies of kind stability: a reference for each combination of the model's parameters, in parts and
// whole. The rubber bar falls for 20 ms with two dampings; frozen runs fail at once.
#include "apps/bough/cases/perform.h"
#include "tests/unit/check.h"
#include "tests/unit/scratch.h"

#include <stdatomic.h>
#include <string.h>

static const char text[] =
    "title: Falling bar\nkind: stability\nscene: " BOUGH_SOURCE_DIR "/apps/beams/rubber-bar.yaml\n"
    "reference: {simulation.coupling.scheme: monolithic, simulation.macro_step: 1 ms}\n"
    "grid:\n"
    "  bodies[0-0].rod.damping:\n"
    "    - [1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3]\n"
    "    - [1e-2, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2]\n"
    "  simulation.coupling.scheme: [frozen, monolithic]\n"
    "  simulation.macro_step: [1 ms, 2 ms, 4 ms]\n"
    "common: {simulation.duration: 20 ms, simulation.output.interval: 4 ms,\n"
    "         simulation.master.rtol: 1e-8, simulation.micro.rtol: 1e-6}\n"
    "measures:\n  - {name: tip, channels: [barTipX, barTipZ]}\n";

enum { CELLS = 12, REFERENCES = 2 };

static atomic_int steps_left; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

static bool stop(void) { return atomic_fetch_sub(&steps_left, 1) <= 0; }

static bough_status perform(const char *folder, int part, int parts, int steps, char shown[8192]) {
    check_arena(arena);
    bough_errors errors = {.arena = arena};
    bough_study *study;
    char path[128];
    snprintf(path, sizeof path, "%s/study.yaml", folder);
    FILE *file = fopen(path, "w"), *stream = tmpfile();
    fputs(text, file);
    fclose(file);
    bough_status status = bough_study_read(arena, path, 2, &errors, &study);
    bough_errors_print(&errors, stderr);
    assert_int_equal(status.code, BOUGH_OK);
    assert_int_equal(study->n_case, CELLS);
    assert_int_equal(study->n_reference, REFERENCES);
    steps_left = steps;
    bough_study_options options = {
        .folder = folder, .part = part, .parts = parts, .quiet = true, .stop = stop, .stream = stream};
    status = bough_study_perform(arena, study, &options);
    rewind(stream);
    memset(shown, 0, 8192);
    assert_true(fread(shown, 1, 8191, stream) < 8191);
    fclose(stream);
    return status;
}

static int count(const char *in, const char *what) {
    int n = 0;
    for (const char *at = in; (at = strstr(at, what)) != NULL; at += strlen(what)) n++;
    return n;
}

static int lines_of(const char *folder, const char *name) {
    char *content = scratch_read(folder, name);
    int n = count(content, "\n");
    free(content);
    return n;
}

static int results(const char *folder) { return scratch_files(folder, "cases", ".case", NULL); }

// Results in which the text stands.
static int results_with(const char *folder, const char *what) {
    char path[512];
    int n = 0;
    snprintf(path, sizeof path, "%s/cases", folder);
    DIR *stream = opendir(path);
    for (struct dirent *entry; stream && (entry = readdir(stream));) {
        char name[300];
        snprintf(name, sizeof name, "cases/%s", entry->d_name);
        char *content = entry->d_name[0] != '.' ? scratch_read(folder, name) : NULL;
        n += content && strstr(content, what) != NULL;
        free(content);
    }
    if (stream) closedir(stream);
    return n;
}

// Every cell has a figure or a diagnosis; a monolithic run differs from the reference of its own model.
TEST_IN_FOLDER(every_cell_speaks) {
    char shown[8192];
    check_ok(perform(*context, 0, 0, 100000, shown));
    assert_non_null(strstr(shown, "6 of 12 held, 6 stopped with a diagnosis, 0 silent"));
    assert_int_equal(results(*context), CELLS + REFERENCES);
    assert_int_equal(lines_of(*context, "table.csv"), 1 + 1 + CELLS);
    char *table = scratch_read(*context, "table.csv");
    assert_int_equal(count(table, "grows by a factor of "), 6);
    free(table);
    // the same macro step as the reference gives the same bits; a reference has no companion
    assert_int_equal(results_with(*context, "errors 0\n"), 2 + REFERENCES);
    assert_int_equal(results_with(*context, "errors 0\nestimates nan\n"), REFERENCES);
}

TEST_IN_FOLDER(parts_fill_one_folder) {
    char shown[8192];
    for (int part = 1; part <= 2; part++) {
        check_ok(perform(*context, part, 2, 100000, shown));
        assert_non_null(
            strstr(shown, part == 1 ? "6 of 12 cells still missing" : "0 of 12 cells still missing"));
        assert_false(scratch_has(*context, "table.csv"));
        assert_int_equal(results(*context), part * (CELLS / 2 + 1));
    }
    bough_status status = perform(*context, 0, 0, 0, shown); // collects without a step
    assert_int_equal(status.code, BOUGH_OK);
    assert_non_null(strstr(shown, "6 of 12 held"));
    assert_int_equal(results(*context), CELLS + REFERENCES);
}

TEST_IN_FOLDER(an_interrupted_study_goes_on) {
    char shown[8192];
    bough_status status = perform(*context, 0, 0, 45, shown);
    assert_int_equal(status.code, BOUGH_INTERRUPTED);
    check_ok(perform(*context, 0, 0, 100000, shown));
    assert_int_equal(results(*context), CELLS + REFERENCES);
}

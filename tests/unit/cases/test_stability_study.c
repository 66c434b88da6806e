// Studies of kind stability: a reference for each combination of the model's parameters, in parts and
// whole. The rubber bar falls for 20 ms with two dampings; frozen runs fail at once.
#include "tests/unit/study.h"

#include <stdatomic.h>

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

static bough_status perform(const char *folder, int part, int parts, int steps, char shown[STUDY_SHOWN]) {
    steps_left = steps;
    return study_perform(folder, text, (bough_study_options){.part = part, .parts = parts, .stop = stop},
                         shown);
}

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
TEST_IN_FOLDER(parts_fill_one_folder_and_every_cell_speaks) {
    char shown[STUDY_SHOWN];
    for (int part = 1; part <= 2; part++) {
        check_ok(perform(*context, part, 2, 100000, shown));
        assert_non_null(
            strstr(shown, part == 1 ? "6 of 12 cells still missing" : "0 of 12 cells still missing"));
        assert_false(scratch_has(*context, "table.csv"));
        assert_int_equal(count_results(*context), part * (CELLS / 2 + 1));
    }
    check_ok(perform(*context, 0, 0, 0, shown)); // collects without a step
    assert_non_null(strstr(shown, "6 of 12 held, 6 stopped with a diagnosis, 0 silent"));
    assert_int_equal(count_results(*context), CELLS + REFERENCES);
    assert_int_equal(count_in(*context, "table.csv", "\n"), 1 + 1 + CELLS);
    assert_int_equal(count_in(*context, "table.csv", "grows by a factor of "), 6);
    // the same macro step as the reference gives the same bits; a reference has no companion
    assert_int_equal(results_with(*context, "errors 0\n"), 2 + REFERENCES);
    assert_int_equal(results_with(*context, "errors 0\nestimates nan\n"), REFERENCES);
}

TEST_IN_FOLDER(an_interrupted_study_goes_on) {
    char shown[STUDY_SHOWN];
    check_fails(perform(*context, 0, 0, 3000, shown), BOUGH_INTERRUPTED, "interrupted after");
    assert_in_range(count_results(*context), 1, CELLS + REFERENCES - 1);
    check_ok(perform(*context, 0, 0, 10000000, shown));
    assert_non_null(strstr(shown, "6 of 12 held, 6 stopped with a diagnosis, 0 silent"));
    assert_int_equal(count_results(*context), CELLS + REFERENCES);
}

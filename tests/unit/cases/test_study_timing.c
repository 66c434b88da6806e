// Studies of kind timing: all cells in every turn, and their errors.
#include "tests/unit/study.h"

static const char text[] =
    "title: Falling bar\nkind: timing\nrepeat: 3\n"
    "scene: " BOUGH_SOURCE_DIR "/apps/beams/rubber-bar.yaml\n"
    "reference: {simulation.coupling.scheme: monolithic, simulation.macro_step: 1 ms}\n"
    "grid:\n  simulation.micro.rtol: [1e-4, 1e-5]\n  simulation.macro_step: [1 ms, 4 ms]\n"
    "common: {simulation.coupling.scheme: monolithic, simulation.duration: 20 ms,"
    " simulation.output.interval: 4 ms}\n"
    "measures:\n  - {name: tip, channels: [barTipX, barTipZ]}\n";

TEST_IN_FOLDER(every_round_has_every_cell_and_errors_are_reported) {
    const char *folder = *context;
    char shown[STUDY_SHOWN];
    check_ok(study_perform(folder, text, (bough_study_options){0}, shown));
    char *csv = scratch_read(folder, "timing.csv"), *table = scratch_read(folder, "table.txt");
    assert_int_equal(count(csv, "\n"), 1 + 4 * 3);
    assert_int_equal(count(csv, ",1\n"), 2 * 3);  // against itself
    assert_int_equal(count(table, "0.0e+00"), 2); // the reference's settings
    // one panel, over rtol: a line for each macro step, which is no number
    char *plot = scratch_read(folder, "plot.svg");
    assert_int_equal(count(plot, "exponent"), 2);
    assert_int_equal(count(plot, "4 ms: exponent"), 1);
    assert_int_equal(count(plot, "CPU time per simulated second"), 1);
    free(csv), free(table), free(plot);
}

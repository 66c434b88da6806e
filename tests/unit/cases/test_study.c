#include "apps/bough/cases/case_run.h"
#include "tests/unit/study.h"

// The rubber bar falls for 20 ms: monolithic runs are good, frozen ones fail at once, since the
// interface body has no mass of its own.
#define BAR "scene: " BOUGH_SOURCE_DIR "/apps/beams/rubber-bar.yaml\n"
#define HEAD "title: Falling bar\nkind: work-precision\n" BAR
#define REFERENCE "reference: {simulation.coupling.scheme: monolithic, simulation.macro_step: 1 ms}\n"
#define GRID                                                                                                 \
    "grid:\n  simulation.coupling.scheme: [monolithic, frozen]\n"                                            \
    "  simulation.macro_step: [1 ms, 4 ms]\n"
#define COMMON "common: {simulation.duration: 20 ms, simulation.output.interval: 4 ms}\n"
#define MEASURES                                                                                             \
    "measures:\n  - {name: tip, channels: [barTipX, barTipZ]}\n"                                             \
    "  - {name: angle, channel: barPos, scale: 0.0174533, unit: rad}\n"
static const char good_study[] = HEAD REFERENCE GRID COMMON MEASURES;

// A stop request has no argument through which it could count.
static int runs_allowed;         // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static const char *runs_counted; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static int asked;                // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static bool stopped;             // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

enum { ALL = 1000 };

// Asked at each evaluation of a run; the file is read now and then.
static bool stop(void) {
    if (asked++ % 64 == 0 && runs_allowed < ALL) {
        stopped = stopped || count_results(runs_counted) - 1 >= runs_allowed;
    }
    return stopped;
}

// Performs the study of the folder until so many runs are stored; `table` receives what was printed.
static bough_status perform(const char *folder, const char *text, int runs, char table[STUDY_SHOWN]) {
    runs_allowed = runs;
    runs_counted = folder;
    asked = 0;
    stopped = false;
    return study_perform(folder, text, (bough_study_options){.stop = stop}, table);
}

// -- reading --------------------------------------------------------------------------------------

TEST_IN_FOLDER(grid_is_the_product_of_its_values) {
    study_text f = study_opened(*context, good_study);
    const bough_study *s = f.study;
    assert_int_equal(s->n_case, 4);
    assert_string_equal(s->cases[0].settings, "scheme=monolithic, macro_step=1 ms");
    assert_string_equal(s->cases[3].settings, "scheme=frozen, macro_step=4 ms");
    assert_int_equal(s->cases[3].n_set, 4);
    assert_string_equal(s->cases[3].set[0], "simulation.duration=20 ms");
    assert_string_equal(s->cases[3].set[3], "simulation.macro_step=4 ms");
    assert_string_equal(bough_study_value(s, s->reference_case, 1), "1 ms");
    assert_int_equal(s->n_channel, 3);
    assert_string_equal(s->measure[0].unit, "m");
    check_near(s->interval, 4e-3, 1e-15, 0);
    bough_arena_destroy(f.arena);
}

// Keys of the same last part are distinguished; a quoted value stays text.
TEST_IN_FOLDER(labels_are_unique_and_quotes_are_kept) {
    study_text f = study_opened(*context, HEAD REFERENCE
                                "grid: {simulation.master.rtol: [1e-6], simulation.micro.rtol: [1e-5],"
                                " title: ['it''s: 1']}\n" MEASURES);
    const bough_case *cell = &f.study->cases[0];
    assert_string_equal(cell->settings, "master.rtol=1e-6, micro.rtol=1e-5, title=it's: 1");
    assert_string_equal(cell->set[2], "title='it''s: 1'");
    bough_arena_destroy(f.arena);
}

// A cell may replace a whole block of keys at once.
TEST_IN_FOLDER(a_mapping_is_a_value) {
    study_text f = study_opened(*context, HEAD REFERENCE
                                "grid: {simulation.micro: [{solver: rosenbrock, step: 2 ms}]}\n" MEASURES);
    assert_string_equal(f.study->cases[0].set[0], "simulation.micro={solver: rosenbrock, step: 2 ms}");
    bough_arena_destroy(f.arena);
}

// "line:column path" of every error, one a line.
static void check_errors(const char *folder, const char *text, const char *expected) {
    study_text f;
    char found[2048] = "";
    bough_status status = study_open(&f, folder, text);
    assert_int_equal(status.code, BOUGH_INVALID);
    assert_null(f.study);
    for (int i = 0; i < f.errors.n; i++) {
        size_t used = strlen(found);
        const bough_error *e = &f.errors.item[i];
        assert_string_equal(e->file, f.path);
        snprintf(found + used, sizeof found - used, "%d:%d %s\n", e->line, e->column, e->path);
    }
    assert_string_equal(found, expected);
    bough_arena_destroy(f.arena);
}

TEST_IN_FOLDER(bad_keys_are_reported_all_at_once) {
    check_errors(*context,
                 "titel: x\nkind: work-precisoin\nscene: [a]\nreference: none\n"
                 "grid: {a.b: 1, c: [{e: [1]}, 2]}\ncommon: {d: {e: {f: 1}}}\nrepeat: 0\n"
                 "measures:\n  - {name: x}\n  - {name: y, channels: [], norm: max}\n"
                 "  - {name: z, channel: c, scale: 2}\n",
                 "1:1 \n2:7 kind\n3:8 scene\n4:12 reference\n5:13 grid.a.b\n"
                 "7:9 repeat\n9:5 measures[0]\n10:25 measures[1].channels\n"
                 "10:35 measures[1].norm\n11:34 measures[2].scale\n");
}

TEST_IN_FOLDER(replacements_are_checked_where_the_study_gives_them) {
    check_errors(*context,
                 HEAD "reference: {simulation.coupling.schme: ramp}\n"
                      "grid:\n  simulation.coupling.scheme: [ramp, rmap]\n"
                      "  simulation.macro_step: [1 ms, 1 kg]\n"
                      "common: {gravity: 3}\n" MEASURES,
                 "4:40 simulation.coupling\n6:38 simulation.coupling.scheme\n"
                 "7:33 simulation.macro_step\n8:19 gravity\n");
}

// A reference of kind stability has values on the model's axes alone.
TEST_IN_FOLDER(errors_of_a_reference_with_parameters_are_reported) {
    check_errors(*context,
                 "title: Falling bar\nkind: stability\n" BAR REFERENCE
                 "grid:\n  bodies[0].rod.damping: [x]\n  simulation.macro_step: [1 ms]\n" COMMON MEASURES,
                 "6:27 bodies[0].rod.damping\n");
}

TEST_IN_FOLDER(channels_and_their_units_are_checked) {
    check_errors(*context,
                 HEAD REFERENCE GRID COMMON "measures:\n  - {name: tip, channels: [barTipX, barTipQ]}\n"
                                            "  - {name: angle, channel: barPos, unit: rad}\n",
                 "10:5 measures\n11:5 measures\n");
}

TEST_IN_FOLDER(output_times_must_be_common) {
    check_errors(*context, HEAD REFERENCE "grid: {simulation.output.interval: [5 ms, 10 ms]}\n" MEASURES,
                 "5:7 grid\n");
}

TEST_IN_FOLDER(missing_scene_is_reported) {
    check_errors(*context, "kind: work-precision\nscene: none.yaml\n" REFERENCE GRID MEASURES, "2:8 scene\n");
}

// -- differences ----------------------------------------------------------------------------------

TEST(differences_are_the_largest_norms) {
    int end[] = {2, 4};
    bough_study_measure measures[] = {
        {.channels = {4, 2, NULL, end}, .norm = BOUGH_STUDY_EUCLID, .scale = 10},
        {.channels = {2, 1, NULL, end}, .norm = BOUGH_STUDY_LARGEST, .scale = 1}};
    bough_study study = {.n_measure = 2, .measure = measures};
    double a[] = {0, 0, 0, 0, 5, 6, 3, 4, 1, 0, 5, 8};
    double b[] = {0, 0, 0, 0, 5, 6, 0, 0, 0, 0, 5, 6};
    bough_study_series x = {2, 6, 2, a}, y = {2, 6, 2, b};
    double error[2];
    bough_study_compare(&study, &x, &y, error);
    check_near(error[0], 50, 1e-15, 0);
    check_near(error[1], 2, 1e-15, 0);
    a[1] = NAN;
    bough_study_compare(&study, &x, &y, error);
    assert_true(isnan(error[0]));
    check_near(error[1], 2, 1e-15, 0);
}

TEST_IN_FOLDER(reference_differs_from_itself_by_nothing) {
    study_text f = study_opened(*context, good_study);
    bough_study_series reference = bough_study_series_take(f.arena, f.study);
    bough_study_series series = bough_study_series_take(f.arena, f.study);
    bough_study_drive drive = {.stop = NULL};
    bough_case_result result;
    double error[2];
    bough_case_run(f.study, f.study->reference_case, 1, &drive, &reference, &result);
    assert_int_equal(reference.filled, 6);
    bough_status status = bough_case_run(f.study, &f.study->cases[0], 3, &drive, &series, &result);
    assert_true(bough_is_ok(&status) && bough_is_ok(&result.outcome) && result.done);
    assert_true(result.wall > 0 && result.cpu > 0);
    check_near(result.time, 0.02, 1e-14, 0);
    bough_study_compare(f.study, &series, &reference, error);
    assert_true(error[0] == 0 && error[1] == 0);
    series.value[3] += 0.5; // the first channel of the second row
    bough_study_compare(f.study, &series, &reference, error);
    check_near(error[0], 0.5, 1e-12, 0);
    bough_arena_destroy(f.arena);
}

// -- results --------------------------------------------------------------------------------------

// The title ends within the picture, its letters being 0.6 times as wide as high.
static void check_title(const char *folder, const char *title) {
    char *picture = scratch_read(folder, "plot.svg"), *at = strstr(picture, "font-size=\"15\"");
    assert_non_null(strstr(at, title));
    while (strncmp(at, "x=\"", 3) != 0) at--;
    double width = strtod(strstr(picture, "width=\"") + 7, NULL);
    assert_true(strtod(at + 3, NULL) + 0.6 * 15 * (double)strlen(title) <= width);
    free(picture);
}

TEST_IN_FOLDER(every_run_has_a_row_with_its_diagnosis_if_it_failed) {
    static const char title[] = "Falling bar, whose study has a title that is wider than its panels side by "
                                "side, and wider still, so that the picture must have room for it";
    char table[STUDY_SHOWN], study[4096];
    const char *folder = *context;
    snprintf(study, sizeof study, "title: '%s'%s", title, strchr(good_study, '\n'));
    check_ok(perform(folder, study, ALL, table));
    assert_int_equal(count_in(folder, "table.csv", "\n"), 1 + 1 + 4);
    assert_int_equal(count_results(folder), 1 + 4);
    assert_int_equal(
        count_in(folder, "table.csv", "run,simulation.coupling.scheme,simulation.macro_step,status,"), 1);
    assert_int_equal(count_in(folder, "table.csv", ",tip [m],tip estimated [m],angle [rad],"), 1);
    char *text = scratch_read(folder, "table.txt");
    assert_string_equal(text, table);
    free(text);
    assert_int_equal(count(table, "monolithic"), 3);
    assert_int_equal(count(table, "  ok  "), 3);
    assert_int_equal(count(table, "failed at t=0.00"), 2);
    assert_int_equal(count(table, "failed: scheme=frozen, macro_step="), 2);
    assert_int_equal(count_in(folder, "table.csv", ",failed,"), 2);
    assert_int_equal(count_in(folder, "table.csv", "grows by a factor of "), 2);
    assert_int_equal(count_in(folder, "plot.svg", "frozen — 1 ms failed at t=0.00"), 1);
    assert_int_equal(count_in(folder, "plot.svg", "<polyline"), 4);
    assert_int_equal(count_in(folder, "plot.svg", "</svg>\n"), 1);
    check_title(folder, title);
}

TEST_IN_FOLDER(failed_reference_ends_the_study) {
    char table[STUDY_SHOWN];
    check_fails(perform(*context,
                        HEAD "reference: {simulation.coupling.scheme: frozen}\n" GRID COMMON MEASURES, ALL,
                        table),
                BOUGH_FAILED, "the reference failed: ");
    assert_false(scratch_has(*context, "table.csv"));
}

TEST_IN_FOLDER(interrupted_study_goes_on) {
    char table[STUDY_SHOWN], again[STUDY_SHOWN], name[256];
    check_fails(perform(*context, good_study, 1, table), BOUGH_INTERRUPTED, "after 1 of 4 runs");
    assert_int_equal(scratch_files(*context, "cases", ".case", name), 1 + 1);
    assert_false(scratch_has(*context, "table.csv"));
    char *first = scratch_read(*context, name); // with the run's time, which differs in each
    check_ok(perform(*context, good_study, ALL, table));
    char *kept = scratch_read(*context, name);
    assert_string_equal(kept, first);
    free(first);
    free(kept);
    assert_int_equal(count_results(*context), 1 + 4);
    check_ok(perform(*context, good_study, 0, again));
    assert_int_equal(asked, 0);
    assert_string_equal(again, table);
}

// What a process that is killed has begun is no result; a result that is cut off is refused by name, and
// runs again once it is removed.
TEST_IN_FOLDER(half_a_result_is_none) {
    char table[STUDY_SHOWN], name[256], path[512];
    perform(*context, good_study, 1, table);
    scratch_write(*context, "cases/0123.case.partial", "case 0123 finger");
    check_ok(perform(*context, good_study, ALL, table));
    assert_int_equal(scratch_files(*context, "cases", ".case", name), 1 + 4);
    snprintf(path, sizeof path, "%s/%s", (char *)*context, name);
    char *text = scratch_read(*context, name);
    assert_int_equal(truncate(path, (off_t)strlen(text) - 6), 0);
    free(text);
    check_fails(perform(*context, good_study, 0, table), BOUGH_IO, name);
    assert_int_equal(remove(path), 0);
    check_ok(perform(*context, good_study, ALL, table));
    assert_int_equal(count_results(*context), 1 + 4);
}

TEST_IN_FOLDER(other_settings_are_run_anew_and_a_grown_grid_is_completed) {
    char table[STUDY_SHOWN];
    perform(*context, good_study, ALL, table);
    int whole = asked;
    check_fails(perform(*context,
                        HEAD REFERENCE GRID "common: {simulation.duration: 20 ms,"
                                            " simulation.output.interval: 20 ms}\n" MEASURES,
                        0, table),
                BOUGH_INTERRUPTED, "interrupted after");
    static const char grown[] =
        HEAD REFERENCE "grid:\n  simulation.coupling.scheme: [monolithic, frozen, ramp]\n"
                       "  simulation.macro_step: [1 ms, 4 ms]\n" COMMON MEASURES;
    check_ok(perform(*context, grown, ALL, table));
    assert_in_range(asked, 1, whole - 1);
    assert_int_equal(count_in(*context, "table.csv", "\n"), 1 + 1 + 6);
}

TEST(csv_text_is_quoted_where_needed) {
    char text[64] = "";
    FILE *file = tmpfile();
    assert_non_null(file);
    bough_csv_text(file, "plain");
    bough_csv_text(file, "a, \"b\"\nc");
    rewind(file);
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    assert_string_equal(text, "plain\"a, \"\"b\"\" c\"");
}

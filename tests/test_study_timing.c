// Studies of kind timing: all cells in every turn, their errors, and a clock that changes no bit.
#include "apps/simulation/build.h"
#include "apps/study/study_perform.h"
#include "apps/study/study_timing.h"
#include "tests/scratch.h"

static const char text[] =
    "title: Falling bar\nkind: timing\nrepeat: 3\n"
    "scene: " BOUGH_SOURCE_DIR "/apps/beams/rubber-bar.yaml\n"
    "reference: {simulation.coupling.scheme: monolithic, simulation.macro_step: 1 ms}\n"
    "grid:\n  simulation.micro.rtol: [1e-4, 1e-5]\n  simulation.macro_step: [1 ms, 4 ms]\n"
    "common: {simulation.coupling.scheme: monolithic, simulation.duration: 20 ms,"
    " simulation.output.interval: 4 ms}\n"
    "measures:\n  - {name: tip, channels: [barTipX, barTipZ]}\n";

static int count(const char *in, const char *what) {
    int n = 0;
    for (; (in = strstr(in, what)); in += strlen(what)) n++;
    return n;
}

static void write_study(const char *folder, char path[128]) {
    snprintf(path, 128, "%s/study.yaml", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void every_turn_has_every_cell_and_errors_are_told(void **state) {
    char path[128];
    const char *folder = *state;
    write_study(folder, path);
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_study *study;
    bough_status status = bough_study_read(arena, path, 0, &errors, &study);
    bough_errors_print(&errors, stderr);
    assert_int_equal(status.code, BOUGH_OK);
    FILE *stream = tmpfile();
    bough_study_options options = {.folder = folder, .quiet = true, .stream = stream};
    status = bough_study_perform(arena, study, &options);
    assert_int_equal(status.code, BOUGH_OK);
    fclose(stream);
    char *csv = scratch_read(folder, "timing.csv"), *table = scratch_read(folder, "table.txt");
    assert_int_equal(count(csv, "\n"), 1 + 4 * 3);
    assert_int_equal(count(csv, ",1\n"), 2 * 3); // against itself
    assert_int_equal(count(table, "0.0e+00"), 2); // the reference's settings
    assert_non_null(strstr(table, "rod steps"));
    free(csv), free(table);
    bough_arena_destroy(arena);
}

static bough_simulation *build(bough_arena *arena) {
    static const char *const sets[] = {"simulation.coupling.scheme=ramp", "simulation.duration=1 s"};
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_simulation *s;
    bough_status status = bough_scene_read(arena, BOUGH_SOURCE_DIR "/apps/turbine/runup.yaml", sets,
                                           2, &errors, &scene);
    assert_int_equal(status.code, BOUGH_OK);
    status = bough_simulation_build(arena, scene, &s);
    assert_int_equal(status.code, BOUGH_OK);
    return s;
}

static void clock_changes_no_bit_and_sees_all_parts(void **state) {
    (void)state;
    bough_arena *arena = bough_arena_create();
    bough_simulation *plain = build(arena), *clocked = build(arena);
    bough_clock *clock;
    double seconds[BOUGH_CLOCK_PARTS];
    bough_status status = bough_clock_create(arena, clocked, &clock);
    assert_int_equal(status.code, BOUGH_OK);
    for (int k = 0; k < 10; k++) {
        bough_status one = bough_step(plain->master), other = bough_step(clocked->master);
        assert_true(bough_is_ok(&one) && bough_is_ok(&other));
    }
    for (int k = 0; k < plain->n_rod; k++) {
        const bough_member *rod = &plain->rod[k];
        assert_memory_equal(rod->state, clocked->rod[k].state,
                            (size_t)rod->system.n_state * sizeof(double));
    }
    bough_clock_read(clock, seconds);
    for (int p = 0; p < BOUGH_CLOCK_RECORDING; p++) assert_true(seconds[p] > 0);
    bough_arena_destroy(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_turn_has_every_cell_and_errors_are_told, scratch_make,
                                        scratch_remove),
        cmocka_unit_test(clock_changes_no_bit_and_sees_all_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

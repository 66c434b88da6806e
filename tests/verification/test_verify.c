// Studies of kind verify: what is read, judged and reported.
#include "tests/unit/scratch.h"
#include "tests/verification/verify.h"

#define BEAMS BOUGH_SOURCE_DIR "/apps/beams/"
#define HEAD "title: Two beams\nkind: verify\ncases:\n"
#define ROLL_UP                                                                                              \
    "  - name: roll-up, one turn\n    scene: " BEAMS "roll-up.yaml\n    do: static\n"                        \
    "    meshes: [5, 10, 20]\n    expect:\n"                                                                 \
    "      - {quantity: tip uz, value: -10, absolute: 1e-8}\n"
#define ELASTICA(tolerance)                                                                                  \
    "  - name: elastica\n    scene: " BEAMS "elastica.yaml\n    do: static\n"                                \
    "    meshes: [10, 20, 40]\n    expect:\n"                                                                \
    "      - {quantity: tip ux, value: 0.81060902488, relative: " tolerance ", extrapolate: true}\n"
#define TOO_FEW(text)                                                                                        \
    "  - name: too few segments\n    scene: " BEAMS "roll-up.yaml\n    do: static\n"                         \
    "    set:\n      loads[0].moment: [0, 628, 0]\n"                                                         \
    "    expect: [{diagnosis: " text "}]\n"
#define FLYING                                                                                               \
    "  - name: flying rod\n    scene: " BEAMS "flying-rod.yaml\n    do: run\n"                               \
    "    meshes: [8]\n    set: {simulation.duration: 3 s}\n    expect:\n"

typedef struct fixture {
    bough_arena *arena;
    bough_errors errors;
    bough_verification study;
} fixture;

static bough_status open_study(fixture *f, const char *folder, const char *text) {
    char path[128];
    *f = (fixture){.arena = check_memory()};
    f->errors.arena = f->arena;
    snprintf(path, sizeof path, "%s/study.yaml", folder);
    scratch_write(folder, "study.yaml", text);
    return bough_verification_read(f->arena, path, &f->errors, &f->study);
}

// Performs a good study; `table` receives what was printed.
static bough_status perform(const char *folder, const char *text, char table[4096]) {
    fixture f;
    bough_status status = open_study(&f, folder, text);
    bough_errors_print(&f.errors, stderr);
    assert_true(bough_is_ok(&status));
    FILE *stream = tmpfile();
    assert_non_null(stream);
    bough_verification_options options = {.folder = folder, .quiet = true, .stream = stream};
    status = bough_verification_perform(f.arena, &f.study, &options);
    rewind(stream);
    memset(table, 0, 4096);
    assert_true(fread(table, 1, 4095, stream) < 4095);
    fclose(stream);
    bough_arena_destroy(f.arena);
    return status;
}

static bool says(const char *text, const char *what) {
    if (!strstr(text, what)) print_error("no '%s' in:\n%s\n", what, text);
    return strstr(text, what) != NULL;
}

TEST_IN_FOLDER(cases_that_hold_are_a_success) {
    char table[4096];
    check_ok(perform(*context, HEAD ROLL_UP ELASTICA("1e-6"), table));
    assert_true(says(table, "2 of 2 hold, 2 cases"));
    char *csv = scratch_read(*context, "verify.csv");
    assert_non_null(csv);
    assert_true(says(csv, "elastica,tip ux,0.81060902488,"));
    assert_true(says(csv, ",relative,pass,"));
    free(csv);
}

// The same cases with a tolerance that no mesh reaches.
TEST_IN_FOLDER(a_case_that_does_not_hold_is_a_failure) {
    char table[4096];
    check_fails(perform(*context, HEAD ROLL_UP ELASTICA("1e-12"), table), BOUGH_FAILED,
                "1 of 2 expectations do not hold");
    assert_true(says(table, "FAIL"));
    char *csv = scratch_read(*context, "verify.csv");
    assert_non_null(csv);
    assert_true(says(csv, ",relative,fail,"));
    free(csv);
}

// The elastica converges at fourth order.
TEST_IN_FOLDER(order_is_observed_over_three_meshes) {
    char table[4096];
    perform(*context, HEAD ELASTICA("1e-6"), table);
    assert_true(says(table, " 4."));
}

TEST_IN_FOLDER(a_diagnosis_is_expected_or_missed) {
    char table[4096];
    check_ok(perform(*context, HEAD TOO_FEW("more segments are needed"), table));
    check_fails(perform(*context, HEAD TOO_FEW("the moon is full"), table), BOUGH_FAILED, "do not hold");
    assert_true(says(table, "more segments are needed")); // reported in either case
}

TEST_IN_FOLDER(free_flight_keeps_energy_and_momenta) {
    char table[4096];
    check_ok(perform(*context,
                     HEAD FLYING "      - {quantity: drift of energy from 2 s, absolute: 1e-6}\n"
                                 "      - {quantity: drift of momentum from 2 s, absolute: 1e-7}\n"
                                 "      - {quantity: drift of angular momentum from 2 s, "
                                 "absolute: 1e-7}\n",
                     table));
    // while the load acts they change
    check_fails(perform(*context,
                        HEAD FLYING "      - {quantity: drift of momentum from 0 s, absolute: 0.1}\n", table),
                BOUGH_FAILED, "1 of 1");
}

// A rotor at a given speed, whose blade is pitched back and forth once per turn of 4 s: mean and
// first harmonic of the pitch, and of a speed that does not change.
TEST_IN_FOLDER(means_and_amplitudes_of_a_rotor) {
    char table[4096];
    static const char text[] =
        HEAD "  - name: rotor\n    scene: " BOUGH_SOURCE_DIR "/apps/turbine/rotor.yaml\n"
             "    do: run\n    set:\n      simulation.duration: 12 s\n"
             "      bodies[2].joint.motion: {speed: 15 rpm}\n"
             "      bodies[3].joint.motion: {angle: {times: [0 s, 2 s, 4 s, 6 s, 8 s, 10 s, 12 s, "
             "14 s, 16 s], values: [0 deg, 4 deg, -2 deg, 4 deg, -2 deg, 4 deg, -2 deg, 4 deg, "
             "0 deg]}}\n    expect:\n"
             "      - {quantity: mean RotSpeed from 4 s, value: 15, absolute: 1e-9}\n"
             "      - {quantity: amplitude RotSpeed from 4 s, value: 0, absolute: 1e-9}\n"
             "      - {quantity: mean blade1Pos from 4 s, value: 1, absolute: 0.1}\n"
             "      - {quantity: amplitude blade1Pos from 4 s, value: 3, absolute: 0.1}\n";
    bough_status status = perform(*context, text, table);
    if (!bough_is_ok(&status)) print_error("%s\n", table);
    assert_int_equal(status.code, BOUGH_OK);
}

// A run that stops on its way has not kept anything.
TEST_IN_FOLDER(a_run_that_fails_has_not_shown_its_values) {
    char table[4096];
    check_fails(perform(*context,
                        HEAD "  - name: frozen\n    scene: " BEAMS "rubber-bar.yaml\n    do: run\n"
                             "    set: {simulation.coupling.scheme: frozen}\n    expect:\n"
                             "      - {quantity: drift of energy from 0 s, absolute: 1e3}\n",
                        table),
                BOUGH_FAILED, "1 of 1");
    assert_true(says(table, "failed: "));
}

static void check_error(const char *folder, const char *text, const char *message) {
    fixture f;
    bough_status status = open_study(&f, folder, text);
    assert_int_equal(status.code, BOUGH_INVALID);
    assert_int_equal(f.errors.n, 1);
    assert_true(says(f.errors.item[0].text, message));
    bough_arena_destroy(f.arena);
}

#define CASE(lines) HEAD "  - name: a\n    scene: " BEAMS "elastica.yaml\n" lines
TEST_IN_FOLDER(mistakes_are_reported_before_the_first_case) {
    check_error(*context, CASE("    do: static\n    expect: [{quantity: tip q, absolute: 1}]\n"),
                "expected 'tip x|y|z");
    check_error(*context, CASE("    do: static\n    expect: [{quantity: tip x}]\n"),
                "one of 'relative' and 'absolute'");
    check_error(*context, CASE("    do: static\n    expect: [{quantity: frequency 1, absolute: 1}]\n"),
                "does not come from");
    check_error(*context,
                CASE("    do: static\n    meshes: [5, 10, 40]\n"
                     "    expect: [{quantity: tip x, absolute: 1}]\n"),
                "constant factor");
    check_error(*context,
                CASE("    do: static\n    set: {simulation.rot: 1}\n"
                     "    expect: [{quantity: tip x, absolute: 1}]\n"),
                "rot");
}

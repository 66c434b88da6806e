// Which errors count: what is judged by its range, its value or its kind, and in which words.
#include "apps/bough/model/companion.h"
#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/simulation.h"
#include "tests/unit/check.h"

typedef struct row {
    const char *name, *unit;
    double range, error;
} row;

// Of channels that start at 0: the worst, and the words for its error.
static int worst_in(int n, const row *rows, char words[BOUGH_ERROR_SIZE]) {
    bough_arena *arena = bough_arena_create();
    bough_channels channels = bough_channels_start(arena);
    bough_companion c = {.channels = &channels, .compared = 1};
    bough_arena_each(arena, (size_t)n, &c.low, &c.high, &c.other_low, &c.other_high, &c.error, &c.noticed);
    bough_channels_group(&channels, NULL, NULL);
    for (int i = 0; i < n; i++) {
        bough_channels_add(&channels, rows[i].unit, "%s", rows[i].name);
        c.high[i] = c.other_high[i] = rows[i].range;
        c.error[i] = rows[i].error;
    }
    bool motion = strcmp(rows[0].unit, "kN") != 0;
    int worst = bough_error_verdict_of(&c, motion, c.error).channel;
    if (worst >= 0) bough_error_size(&c, worst, words);
    bough_arena_destroy(arena);
    return worst;
}

// Two channels of a run and its companion: the least and the largest value of each, and the error.
typedef struct {
    double low[2], high[2], other_low[2], other_high[2], error[2];
    const char *unit[2], *name[2];
} two_channels;

static bough_companion *compared(bough_arena *arena, two_channels *v) {
    bough_channels *channels = bough_arena_take(arena, sizeof *channels);
    bough_scene *scene = bough_arena_take(arena, sizeof *scene);
    bough_simulation *run = bough_arena_take(arena, sizeof *run);
    bough_companion *c = bough_arena_take(arena, sizeof *c);
    *channels = bough_channels_start(arena);
    bough_channels_group(channels, NULL, NULL);
    for (int k = 0; k < 2; k++) bough_channels_add(channels, v->unit[k], v->name[k]);
    scene->simulation.accuracy = 0.005;
    run->scene = scene;
    *c = (bough_companion){.run = run,
                           .channels = channels,
                           .compared = 1,
                           .low = v->low,
                           .high = v->high,
                           .other_low = v->other_low,
                           .other_high = v->other_high,
                           .error = v->error,
                           .noticed = bough_arena_doubles(arena, 2)};
    for (int k = 0; k < 2; k++) c->noticed[k] = -1;
    return c;
}

// The verdict's relative error before and after the companion's largest value of `channel` becomes `high`.
static void check_verdicts(two_channels *v, int channel, double high, double before, double after) {
    check_arena(arena);
    bough_companion *c = compared(arena, v);
    bough_error_notice(c, 1);
    check_near(bough_error_verdict_of(c, true, c->error).relative, before, 1e-5, 0);
    v->other_high[channel] = high;
    bough_error_notice(c, 2);
    check_near(bough_error_verdict_of(c, true, c->error).relative, after, 1e-5, 0);
}

// A scene that stays in equilibrium has no range: an error of a hundred-thousandth of its size is small,
// until both solutions move.
TEST(errors_of_a_scene_at_rest_are_judged_by_its_size) {
    two_channels v = {.low = {0.9, 0},
                      .high = {0.9 + 1.2e-5, 3e-9},
                      .other_low = {0.9, 0},
                      .other_high = {0.9, 1e-13},
                      .error = {1.2e-5, 3e-9},
                      .unit = {"m", "deg"},
                      .name = {"TipZ", "Pos"}};
    check_verdicts(&v, 0, v.high[0], 1.2e-5 / 0.9, 1);
}

// The deflection of a rotor in steady operation has none either: its error is judged by its value, up to 1 m,
// unless one of the two solutions moves.
TEST(errors_of_what_stays_are_judged_by_its_value) {
    two_channels v = {.low = {0, 16.5},
                      .high = {300, 16.5 + 2e-8},
                      .other_low = {0, 16.5},
                      .other_high = {300, 16.5 + 1e-8},
                      .error = {0, 1.7e-4},
                      .unit = {"deg", "m"},
                      .name = {"Azimuth", "OoPDefl1"}};
    check_verdicts(&v, 1, 16.6, 1.7e-4, 1.7e-4 / 2e-8);
    two_channels steady = {.low = {0, 7},
                           .high = {300, 7.001},
                           .other_low = {0, 7},
                           .other_high = {300, 7.001},
                           .error = {0, 7e-4},
                           .unit = {"deg", "m/s"},
                           .name = {"Azimuth", "bodyVelX"}};
    check_verdicts(&steady, 1, 7.001, 7e-4 / 0.07001, 7e-4 / 0.07001);
}

// The mesh is the cause, though the part of time is unknown, if all other parts together err by much less.
TEST(a_run_that_errs_by_its_mesh_is_warned_of) {
    double mesh[] = {0.2, 0}, others[] = {0.003, 0}, air[] = {0.004, 0};
    two_channels v = {.high = {1, 1},
                      .other_high = {1, 1},
                      .error = {0.2, 0},
                      .unit = {"m", "m"},
                      .name = {"TipDxb1", "TipDyb1"}};
    check_arena(arena);
    bough_companion *c = compared(arena, &v);
    bough_error_shares shares = {.found = true,
                                 .n_channel = 2,
                                 .share = {{"", mesh, others}, {"", air, mesh}, {"it failed", mesh, mesh}}};
    char warning[BOUGH_ERROR_WARNING];
    check_ok(bough_error_judge(arena, c, NULL, 0.02, &shares, warning));
    assert_non_null(strstr(warning, "cause: the mesh"));
    for (int k = 0; k < 2; k++) {
        others[0] = k ? 0.003 : 0.06;
        if (k) strcpy(c->reason, "a companion that ended");
        check_fails(bough_error_judge(arena, c, NULL, 0.02, &shares, warning), BOUGH_FAILED,
                    "the cause was not found: it failed");
    }
}

// A range of rounding is none to measure an error by.
TEST(an_error_far_beyond_its_range_has_no_figure) {
    char words[BOUGH_ERROR_SIZE];
    assert_int_equal(worst_in(1, (row[]){{"TipDxb1", "m", 4, .01}}, words), 0);
    assert_string_equal(words, "0.01 m, 0.0025 of its range");
    assert_int_equal(worst_in(1, (row[]){{"DirXx", "-", 4, .01}}, words), 0);
    assert_string_equal(words, "0.01, 0.0025 of its range");
    assert_int_equal(worst_in(1, (row[]){{"Pos", "deg", 3e-14, 5}}, words), 0);
    assert_string_equal(words, "5 deg, more than 10 times its range");
}

// A twist of rounding or of next to nothing is not judged by itself, beside blades that bend.
TEST(what_hardly_moves_does_not_count) {
    static const struct {
        int n, worst;
        row rows[3];
    } cases[] = {
        {2, 0, {{"TipDxb1", "m", 4, .01}, {"TwstDefl1", "deg", 4e-16, 3e-16}}},
        {3, 2, {{"TipDxb1", "m", 4, .01}, {"TwstDefl1", "deg", 2.5e-4, 2e-4}, {"Pos", "deg", 3, .01}}},
        {2, 1, {{"TipDxb1", "m", 4, .01}, {"TwstDefl1", "deg", 2.5e-3, 2e-3}}},
        {2, -1, {{"TipDxb1", "m", 4e-13, 1e-14}, {"TwstDefl1", "deg", 4e-16, 3e-16}}},
        {2, 1, {{"one", "m", 1, .01}, {"other", "m", 2e-3, 1e-3}}},
        {2, 0, {{"one", "m", 1, .01}, {"other", "m", 5e-4, 4e-4}}},
        {2, 0, {{"RootFzb1", "kN", .07, 2e-4}, {"RootMxb1", "kN-m", 3e-14, 3e-14}}},
        {2, 1, {{"RootFzb1", "kN", .07, 2e-4}, {"RootMxb1", "kN-m", 3e-7, 3e-7}}},
    };
    char words[BOUGH_ERROR_SIZE];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_int_equal(worst_in(cases[k].n, cases[k].rows, words), cases[k].worst);
}

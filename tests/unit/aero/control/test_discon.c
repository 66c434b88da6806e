#include "aero/control/discon.h"

#include "tests/unit/check.h"

typedef struct fixture {
    bough_arena *arena;
    bough_discon *discon;
} fixture;

static fixture open_controller(const char *input, bool copy) {
    fixture f = {.arena = check_memory()};
    check_ok(bough_discon_open(f.arena, BOUGH_SAMPLE_DISCON, input, copy, &f.discon));
    return f;
}

TEST(demands_come_back) {
    for (int k = 0; k < 4; k++) { // of the library, and of a copy
        bool individual = k > 1;
        fixture f = open_controller(individual ? "individual" : "", k % 2 == 1);
        bough_discon_sensed sensed = {.time = 2, .step = 0.01, .n_blade = 3, .generator_speed = 120};
        bough_discon_demand demand;
        check_ok(bough_discon_call(f.discon, &sensed, &demand));
        check_near(demand.torque, 12000, 1e-6, 0);
        for (int b = 0; b < 3; b++) check_near(demand.pitch[b], individual ? 0.2 + 0.1 * b : 0.102, 1e-6, 0);
        bough_arena_destroy(f.arena);
    }
}

TEST(more_blades_than_records_have_one_pitch) {
    for (int individual = 0; individual < 2; individual++) {
        fixture f = open_controller(individual ? "individual" : "", false);
        bough_discon_sensed sensed = {.time = 2, .step = 0.01, .n_blade = 5, .generator_speed = 120};
        bough_discon_demand demand;
        bough_status status = bough_discon_call(f.discon, &sensed, &demand);
        assert_int_equal(status.code, individual ? BOUGH_FAILED : BOUGH_OK);
        if (individual) assert_non_null(strstr(status.message, "allows for 3 blades; the rotor has 5"));
        if (!individual) check_near(demand.pitch[4], 0.102, 1e-6, 0);
        bough_arena_destroy(f.arena);
    }
}

// Every record that the controller receives, by its number in the interface's manual.
TEST(records_are_served) {
    const bough_discon_sensed sensed = {.time = 2,
                                        .step = 0.5,
                                        .n_blade = 3,
                                        .pitch = {0.1, 0.2, 0.3},
                                        .root_moment = {1e6, 2e6, 3e6},
                                        .in_plane = {4e6, 5e6, 6e6},
                                        .individual = true,
                                        .yaw_error = 0.25,
                                        .heading = -0.5,
                                        .acceleration = {0.7, -0.8},
                                        .nodding = 0.01,
                                        .generator_speed = 120,
                                        .rotor_speed = 1.25,
                                        .torque = 4e4,
                                        .shaft_power = 5e6,
                                        .electrical_power = 4.7e6,
                                        .wind = 12,
                                        .azimuth = 3};
    const struct {
        int number;
        double value;
    } record[] = {{1, 0},     {2, 2},    {3, 0.5},   {4, 0.1},  {14, 5e6},  {15, 4.7e6}, {20, 120},
                  {21, 1.25}, {23, 4e4}, {24, 0.25}, {27, 12},  {28, 1},    {30, 1e6},   {31, 2e6},
                  {32, 3e6},  {33, 0.2}, {34, 0.3},  {35, 1},   {37, -0.5}, {49, 1024},  {50, 9},
                  {51, 6},    {53, 0.7}, {54, -0.8}, {60, 3},   {61, 3},    {62, 1000},  {63, 7192},
                  {64, 1024}, {69, 4e6}, {70, 5e6},  {71, 6e6}, {83, 0.01}, {129, 8192}};
    for (size_t i = 0; i < sizeof record / sizeof *record; i++) {
        char input[16];
        snprintf(input, sizeof input, "record %02d", record[i].number);
        fixture f = open_controller(input, false);
        bough_discon_demand demand;
        check_ok(bough_discon_call(f.discon, &sensed, &demand));
        double wanted = record[i].number == 50 ? (double)strlen(input) : record[i].value;
        check_near(demand.torque, wanted, 1e-6, 1e-6);
        check_near(demand.pitch[2], 0.4, 1e-6, 0); // its own demand
        bough_arena_destroy(f.arena);
    }
}

// 0 at first, then 1, and −1 at the last call.
TEST(status_tells_first_and_last) {
    fixture f = open_controller("count", false);
    for (int k = 0; k < 4; k++) {
        bough_discon_sensed sensed = {.time = k, .step = 1, .last = k == 3, .n_blade = 3};
        bough_discon_demand demand;
        check_ok(bough_discon_call(f.discon, &sensed, &demand));
        check_near(demand.torque, k == 3 ? -1 : k > 0, 0, 0);
    }
}

TEST(failures_are_reported) {
    static const char *const answer[][2] = {{"fail", "too late"}, {"nan", "nan"}, {"warn", NULL}};
    for (int i = 0; i < 3; i++) {
        fixture f = open_controller(answer[i][0], false);
        bough_discon_sensed sensed = {.time = 1, .step = 1, .n_blade = 3, .generator_speed = 1};
        bough_discon_demand demand;
        bough_status status = bough_discon_call(f.discon, &sensed, &demand);
        assert_int_equal(status.code, answer[i][1] ? BOUGH_FAILED : BOUGH_OK);
        if (answer[i][1]) {
            assert_non_null(strstr(status.message, answer[i][1]));
            assert_non_null(strstr(status.message, "1 s"));
        }
        bough_arena_destroy(f.arena);
    }
}

TEST(what_is_no_controller_is_refused) {
    static const char *const bad[][2] = {{"/nowhere/discon.so", "/nowhere/discon.so"},
                                         {BOUGH_SOURCE_DIR "/README.md", "README.md"},
                                         {BOUGH_OTHER_LIBRARY, "no function DISCON"},
                                         {BOUGH_SAMPLE_DISCON, "too long a name"}};
    for (int i = 0; i < 4; i++) {
        char input[2000] = "";
        if (i == 3) memset(input, 'x', sizeof input - 1);
        check_arena(arena);
        bough_discon *discon;
        check_fails(bough_discon_open(arena, bad[i][0], input, false, &discon), BOUGH_INVALID, bad[i][1]);
    }
}

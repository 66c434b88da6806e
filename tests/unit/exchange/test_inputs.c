// Inputs of a session against what the scene itself can say.
#include "aero/control/controller.h"
#include "apps/bough/exchange/bough.h"
#include "apps/bough/scene/scene.h"
#include "tests/unit/check.h"

#define APPS BOUGH_SOURCE_DIR "/apps/"
#define MOST 12

static bough_session *open_scene(const char *scene, const char *const *sets) {
    int n = 0;
    while (sets[n]) n++;
    bough_session *s = bough_session_open(scene, sets, n);
    assert_string_equal(bough_session_error(s), "");
    return s;
}

static double read_channel(bough_session *s, const char *name) {
    int k = bough_session_find(s, name);
    assert_true(k >= 0);
    return bough_session_read(s, k);
}

static void step_to(bough_session *s, double t) {
    while (bough_session_time(s) < t - 1e-9) assert_int_equal(bough_session_step(s), BOUGH_SESSION_OK);
}

// All channels that both have, within this share of their value; 0: to the bit.
static void check_within(bough_session *a, bough_session *b, double share) {
    int shared = 0;
    for (int i = 0; i < bough_session_count(a); i++) {
        int k = bough_session_find(b, bough_session_name(a, i));
        if (k < 0) continue;
        double x = bough_session_read(a, i), y = bough_session_read(b, k);
        if (!(fabs(x - y) <= share * fabs(y))) fail_msg("%s: %.17g, %.17g", bough_session_name(a, i), x, y);
        shared++;
    }
    assert_true(shared > 2);
}

static void set(bough_session *s, const char *input, const char *value) {
    int k = bough_session_input(s, input);
    assert_true(k >= 0);
    assert_int_equal(bough_session_set_text(s, k, value), BOUGH_SESSION_OK);
}

// What is set before the first step is what the scene would say.
TEST(constant_inputs_are_loads_of_the_scene) {
    static const struct {
        const char *scene, *with[MOST], *without[MOST], *set[6][2];
    } cases[] = {
        {APPS "mechanisms/pendulum.yaml",
         {"simulation.duration=0.5 s", "loads=[{joint: bob, torque: 0, input: push}]"},
         {"simulation.duration=0.5 s", "loads=[{joint: bob, torque: 3 N m}]"},
         {{"push", "3e-3 kN m"}}},
        {APPS "mechanisms/pendulum.yaml",
         {"simulation.duration=0.5 s",
          "loads=[{body: bob, point: [-1, 0, 0], force: [0, 0, 0], input: kick}]"},
         {"simulation.duration=0.5 s", "loads=[{body: bob, point: [-1, 0, 0], force: [0, 0, 4]}]"},
         {{"kickFz", "4 N"}}},
        {BOUGH_SOURCE_DIR "/tests/data/scenes/example-beam.yaml",
         {"simulation.duration=0.1 s", "loads=[{body: beam, at: 1 m, force: [0, 0, 0], input: tap}]"},
         {"simulation.duration=0.1 s", "loads=[{body: beam, at: 1 m, force: [30, 0, 0]}]"},
         {{"tapFx", "30 N"}}},
        {APPS "turbine/runup.yaml",
         {"simulation.duration=0.2 s", "bodies[3-5].rod.segments=8", "aero.wind.input=wind"},
         {"simulation.duration=0.2 s", "bodies[3-5].rod.segments=8", "aero.wind.speed=15 m/s"},
         {{"wind", "15 m/s"}}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bough_session *a = open_scene(cases[i].scene, cases[i].with);
        bough_session *b = open_scene(cases[i].scene, cases[i].without);
        for (int k = 0; cases[i].set[k][0]; k++) set(a, cases[i].set[k][0], cases[i].set[k][1]);
        step_to(a, bough_session_duration(a));
        step_to(b, bough_session_duration(b));
        check_within(a, b,
                     1e-8); // the sums are the same, their order is not, and steps follow their rounding
        bough_session_close(a);
        bough_session_close(b);
    }
}

// At the end of the step a joint is where the input says, by a cubic that starts and ends with its speeds.
TEST(joints_go_where_the_input_says) {
    const char *const sets[] = {"simulation.duration=1 s",
                                "bodies[0].joint.motion={angle: 10 deg, input: turn}", NULL};
    bough_session *s = open_scene(APPS "mechanisms/pendulum.yaml", sets);
    check_near(read_channel(s, "bobPos"), 10, 0, 1e-12);
    for (int k = 1; k <= 50; k++) {
        char text[40];
        snprintf(text, sizeof text, "%.17g deg", 10 + 0.1 * k);
        set(s, "turn", text);
        bough_session_step(s);
        check_near(read_channel(s, "bobPos"), 10 + 0.1 * k, 0, 1e-12);
        check_near(read_channel(s, "bobVel"), 10, 0, 1e-9); // 0.1 deg in 10 ms
    }
    bough_session_close(s);
}

// The law of the library, called here between steps, is the law that the scene has inside.
TEST(a_law_outside_is_the_law_inside) {
    const char *const inside[] = {"simulation.duration=3 s", "aero.wind={kind: uniform, speed: 14}", NULL};
    const char *const outside[] = {"simulation.duration=3 s", "aero.wind={kind: uniform, speed: 14}",
                                   "control.kind=external", NULL};
    bough_session *a = open_scene(APPS "turbine/land-operation.yaml", inside);
    bough_session *b = open_scene(APPS "turbine/land-operation.yaml", outside);
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_scene_read(arena, NULL, APPS "turbine/land-operation.yaml", NULL, 0, &errors, &scene);
    bough_controller_def law = scene->control.law;
    bough_controller_state memory = {0};
    int torque = bough_session_input(b, "GenTqCom");
    for (int n = 0; n < 75; n++) {
        double step = (n + 1) * 0.04 - n * 0.04; // as rounded there
        double speed = read_channel(b, "LawGenSpeed"), pitch = read_channel(b, "LawBldPitch1");
        bough_controller_advance(&law, speed, pitch, step, &memory);
        bough_session_set(b, torque, memory.torque);
        for (int k = 0; k < 3; k++)
            bough_session_set(b, bough_session_input(b, "BlPitchCom1") + k, memory.pitch);
        assert_int_equal(bough_session_step(a), BOUGH_SESSION_OK);
        assert_int_equal(bough_session_step(b), BOUGH_SESSION_OK);
        check_within(a, b, 0);
    }
    assert_true(read_channel(b, "GenTq") > 1);
    bough_arena_destroy(arena);
    bough_session_close(a);
    bough_session_close(b);
}

TEST(a_copy_holds_the_inputs) {
    const char *const sets[] = {"simulation.duration=1 s", "loads=[{joint: bob, torque: 0, input: push}]",
                                NULL};
    bough_session *s = open_scene(APPS "mechanisms/pendulum.yaml", sets);
    set(s, "push", "2 N m");
    step_to(s, 0.3);
    void *copy = malloc(bough_session_size(s));
    assert_int_equal(bough_session_save(s, copy), BOUGH_SESSION_OK);
    step_to(s, 0.6);
    double once = read_channel(s, "bobPos");
    set(s, "push", "-5 N m");
    step_to(s, 0.7);
    assert_int_equal(bough_session_restore(s, copy), BOUGH_SESSION_OK);
    check_near(bough_session_input_value(s, 0), 2, 0, 0);
    step_to(s, 0.6);
    check_near(read_channel(s, "bobPos"), once, 0, 0);
    free(copy);
    bough_session_close(s);
}

TEST(bad_inputs_are_refused) {
    const char *const sets[] = {"loads=[{joint: bob, torque: 1, input: push}]", NULL};
    bough_session *s = open_scene(APPS "mechanisms/pendulum.yaml", sets);
    assert_int_equal(bough_session_inputs(s), 1);
    assert_string_equal(bough_session_input_unit(s, 0), "N m");
    assert_int_equal(bough_session_input(s, "pull"), -1);
    assert_int_equal(bough_session_set(s, 1, 0), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_set(s, 0, (double)NAN), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_set_text(s, 0, "3 kg"), BOUGH_SESSION_INVALID);
    assert_non_null(strstr(bough_session_error(s), "input push: expected a value in N m, got '3 kg'"));
    check_near(bough_session_input_value(s, 0), 1, 0, 0);
    assert_int_equal(bough_session_step(s), BOUGH_SESSION_OK);
    bough_session_close(s);
    const char *const wind[] = {"aero.wind.input=wind", "control.kind=external", "control.pitch=false", NULL};
    s = open_scene(APPS "turbine/power.yaml", wind);
    int speed = bough_session_input(s, "wind"), torque = bough_session_input(s, "GenTqCom");
    double before = bough_session_input_value(s, speed);
    assert_int_equal(bough_session_set(s, speed, -3), BOUGH_SESSION_INVALID);
    assert_string_equal(bough_session_error(s), "input wind: must be in [0, 150] m/s, got -3");
    assert_int_equal(bough_session_set_text(s, speed, "-3 m/s"), BOUGH_SESSION_INVALID);
    check_near(bough_session_input_value(s, speed), before, 0, 0);
    assert_int_equal(bough_session_set(s, speed, 0), BOUGH_SESSION_OK);
    assert_int_equal(bough_session_set(s, torque, -3), BOUGH_SESSION_OK);
    bough_session_close(s);
    static const char *const bad[][2] = {
        {"loads=[{joint: bob, torque: 1, input: a, ramp: [0 s, 1 s]}]", "only without a ramp or a table"},
        {"loads=[{joint: bob, torque: 1, input: a}, {joint: bob, torque: 1, input: a}]",
         "two inputs are named 'a'"},
        {"bodies[0].joint.motion={speed: 1 rad/s, input: a}", "only with a constant initial position"},
        {"bodies[0].joint={kind: universal, parent: ground, axis: y, second_axis: x, "
         "motion: {first: {angle: 0, input: a}}}",
         "joint.motion.first: unknown key 'input'"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        s = bough_session_open(APPS "mechanisms/pendulum.yaml", &bad[i][0], 1);
        assert_int_equal(bough_session_code(s), BOUGH_SESSION_INVALID);
        if (!strstr(bough_session_error(s), bad[i][1])) fail_msg("%s", bough_session_error(s));
        bough_session_close(s);
    }
}

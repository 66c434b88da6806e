// What events make of torque, pitch and yaw: the NREL 5 MW turbine with rigid blades in steady wind.
#include "tests/unit/built_scene.h"

static const char scene[] = "apps/turbine/power.yaml", rigid[] = "bodies[3-5].fidelity=rigid",
                  sample[] = "control.rate=50 Hz";
static const double step = 0.02; // between samples of the control [s]

typedef struct fixture {
    bough_arena *arena;
    bough_run run;
} fixture;

static fixture open_run(const char *events, const char *more) {
    fixture f = {.arena = check_memory()};
    const char *sets[] = {rigid, sample, "simulation.duration=30 s", events, more, NULL};
    check_ok(bough_run_create(f.arena, scene_read(f.arena, scene, sets), &f.run));
    return f;
}

static void go_to(fixture *f, double t) {
    while (f->run.simulation->master->time < t - 1e-9) {
        check_ok(bough_run_step(&f->run));
    }
}

static double value(fixture *f, const char *name) {
    int k = bough_channels_find(&f->run.channels, name);
    assert_true(k >= 0);
    return bough_run_values(&f->run)[k];
}

// At 8 deg/s from the sample after 1 s on, at once without torque.
TEST(emergency_stop_feathers_without_torque) {
    fixture f = open_run("control.events=[{kind: emergency-stop, at: 1 s}]", NULL);
    go_to(&f, 1);
    assert_true(value(&f, "GenTq") > 10);
    double before = value(&f, "BldPitch1");
    go_to(&f, 3 + step);
    check_near(value(&f, "GenTq"), 0, 0, 1e-12);
    for (int b = 1; b <= 3; b++) {
        char name[16];
        snprintf(name, sizeof name, "BldPitch%d", b);
        check_near(value(&f, name) - before, 8 * (2 + step), 1e-3, 0.2);
    }
    go_to(&f, 16);
    check_near(value(&f, "BldPitch2"), 90, 1e-9, 0);
    assert_true(value(&f, "RotSpeed") < 4);
}

TEST(stop_takes_the_torque_away_in_ten_seconds) {
    fixture f = open_run("control.events=[{kind: stop, at: 1 s, angle: 80 deg, rate: 5 deg/s}]", NULL);
    go_to(&f, 1);
    double torque = value(&f, "GenTq");
    go_to(&f, 6);
    check_near(value(&f, "GenTq"), torque / 2, 0.01, 0);
    check_near(value(&f, "BldPitch1"), 25, 0.01, 0);
    go_to(&f, 20);
    check_near(value(&f, "GenTq"), 0, 0, 1e-12);
    check_near(value(&f, "BldPitch1"), 80, 1e-9, 0);
}

// A brake on the rotor's joint stops it within those ten seconds and would turn it back: a sample after it
// stands there is no torque.
TEST(stop_does_not_drive_a_rotor_that_stands) {
    fixture f = open_run("control.events=[{kind: stop, at: 1 s}]",
                         "loads=[{joint: hub, torque: -12 MN m, ramp: [1 s, 1 s]}]");
    double least = 0;
    for (double t = 1; t < 9; t += step) {
        double before = value(&f, "RotSpeed");
        go_to(&f, t + step);
        least = fmin(least, value(&f, "RotSpeed"));
        if (before < 0) check_near(value(&f, "GenTq"), 0, 0, 1e-9);
    }
    assert_true(least < -0.1);
}

TEST(a_stuck_blade_stays_while_the_others_feather) {
    fixture f = open_run("control.events=[{kind: emergency-stop, at: 2 s}, "
                         "{kind: pitch-stuck, blade: 2, at: 1 s}, "
                         "{kind: pitch-runaway, blade: 3, at: 4 s, angle: -5 deg, rate: 4 deg/s}]",
                         NULL);
    go_to(&f, 1);
    double stuck = value(&f, "BldPitch2");
    go_to(&f, 4);
    check_near(value(&f, "BldPitch2"), stuck, 0, 1e-9);
    check_near(value(&f, "BldPitch1"), 16, 0.02, 0);
    double away = value(&f, "BldPitch3");
    go_to(&f, 6);
    check_near(value(&f, "BldPitch3") - away, -8, 0.05, 0);
    check_near(value(&f, "BldPitch1"), 32, 0.02, 0);
    go_to(&f, 12);
    check_near(value(&f, "BldPitch3"), -5, 1e-9, 0);
}

// A step at the law's rate, then a ramp; the law sets the torque. A stop prevails over both, wherever it
// stands.
TEST(the_pitch_goes_to_given_angles) {
    fixture f =
        open_run("control.events=[{kind: emergency-stop, at: 12 s}, {kind: pitch-to, at: 2 s, angle: 4 deg}, "
                 "{kind: pitch-to, at: 6 s, angle: -1 deg, rate: 2 deg/s}]",
                 NULL);
    go_to(&f, 2);
    double before = value(&f, "BldPitch1");
    go_to(&f, 2.2);
    check_near(value(&f, "BldPitch1") - before, 8 * 0.2, 0.1, 0);
    go_to(&f, 6);
    for (int b = 1; b <= 3; b++) {
        char name[16];
        snprintf(name, sizeof name, "BldPitch%d", b);
        check_near(value(&f, name), 4, 1e-9, 0);
    }
    assert_true(value(&f, "GenTq") > 1);
    go_to(&f, 8);
    check_near(value(&f, "BldPitch1"), 0, 0, 0.05);
    go_to(&f, 12);
    check_near(value(&f, "BldPitch3"), -1, 1e-9, 0);
    go_to(&f, 14);
    check_near(value(&f, "BldPitch3"), 15, 0.02, 0);
}

// The rotor speeds up until a threshold takes the load away, then until another stops it.
TEST(thresholds_trigger) {
    fixture f = open_run("control.events=[{kind: grid-loss, channel: RotSpeed, above: 9.5}, "
                         "{kind: emergency-stop, channel: RotSpeed, above: 11, at: 1 s}]",
                         "aero.wind.speed=11");
    double lost = -1, stopped = -1;
    for (double t = 0; t < 25; t += step) {
        go_to(&f, t);
        double speed = value(&f, "RotSpeed");
        if (lost < 0 && speed > 9.5) lost = t;
        if (stopped < 0 && speed > 11) stopped = t;
        if (lost < 0 && t > 2 * step) assert_true(value(&f, "GenTq") > 1);
        if (lost >= 0 && t > lost + 2 * step) check_near(value(&f, "GenTq"), 0, 0, 1e-12);
        if (stopped < 0) assert_true(value(&f, "BldPitch1") < 1);
    }
    assert_true(lost > 0 && stopped > lost);
    assert_true(value(&f, "BldPitch1") > 30);
}

TEST(before_its_start_the_turbine_idles) {
    fixture f =
        open_run("control.events=[{kind: start, at: 2 s}]", "bodies[3-5].joint.motion={angle: -90 deg}");
    go_to(&f, 2);
    check_near(value(&f, "BldPitch1"), 90, 1e-9, 0);
    check_near(value(&f, "GenTq"), 0, 0, 1e-12);
    go_to(&f, 7);
    assert_true(value(&f, "BldPitch1") < 80);
    double slowest = 1e3;
    for (double t = 7; t <= 28; t += 1) {
        go_to(&f, t);
        slowest = fmin(slowest, value(&f, "RotSpeed"));
    }
    assert_true(slowest > 0); // no torque turns it backwards
    assert_true(value(&f, "BldPitch1") < 30);
}

TEST(a_yaw_drive_turns_the_nacelle) {
    fixture f = open_run("control.events=[{kind: yaw-runaway, body: nacelle, at: 1 s, angle: 3 deg, "
                         "rate: 1 deg/s}]",
                         "bodies[1].joint={kind: revolute, parent: tower, axis: z, motion: {angle: 0 deg}, "
                         "placement: [move z 87.6 m]}");
    go_to(&f, 1);
    check_near(value(&f, "nacellePos"), 0, 0, 1e-9);
    go_to(&f, 3);
    check_near(value(&f, "nacellePos"), 2, 1e-6, 0);
    go_to(&f, 6);
    check_near(value(&f, "nacellePos"), 3, 1e-6, 0);
}

// A copy taken before an event goes on through it to the same bits.
TEST(events_are_in_the_copy) {
    fixture f =
        open_run("control.events=[{kind: pitch-stuck, blade: 1, at: 0.5 s}, {kind: stop, at: 1 s}]", NULL);
    go_to(&f, 0.8);
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    bough_run_snapshot(&f.run, &measure);
    char *copy = bough_arena_take(f.arena, measure.used);
    bough_run_snapshot(&f.run, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, copy, 0});
    bough_run_snapshot(&f.run, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, copy, 0});
    go_to(&f, 3);
    double pitch = value(&f, "BldPitch2"), stuck = value(&f, "BldPitch1");
    bough_run_snapshot(&f.run, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, copy, 0});
    go_to(&f, 3);
    check_near(value(&f, "BldPitch2"), pitch, 0, 0);
    check_near(value(&f, "BldPitch1"), stuck, 0, 0);
    assert_true(pitch > stuck + 6);
}

static void refused(const char *set, const char *message) { scene_refused(scene, set, message); }

TEST(senseless_events_are_refused) {
    refused("control.events=[{kind: stop}]", "time of the event");
    refused("control.events=[{kind: stop, channel: RotSpeed}]", "needs one of");
    refused("control.events=[{kind: stop, at: 1, above: 3}]", "needs its 'channel'");
    refused("control.events=[{kind: stop, channel: RotSped, above: 3}]", "did you mean 'RotSpeed'");
    refused("control.events=[{kind: pitch-stuck, at: 1 s}]", "blade");
    refused("control.events=[{kind: pitch-stuck, at: 1 s, blade: 4}]", "the turbine has 3 blades");
    refused("control.events=[{kind: stop, at: 1 s, blade: 2}]", "only used with");
    refused("control.events=[{kind: pitch-to, at: 1 s}]", "needs its 'angle'");
    refused("control={kind: variable-speed, pitch: false, events: [{kind: stop, at: 1 s}]}",
            "control.pitch: true");
    refused("control.events=[{kind: yaw-runaway, at: 1 s, body: nacelle}]", "has no 'motion'");
}

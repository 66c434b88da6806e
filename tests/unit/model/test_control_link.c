// Between controller and turbine: torque on the rotor's joint, blades steered by their pitch joints.
#include "tests/unit/built_scene.h"

#include "apps/bough/model/control_link.h"

static const char turbine[] = "apps/turbine/power.yaml";

#define RIGID "simulation.threads=1", "bodies[3-5].fidelity=rigid"
#define BLADED "control={kind: bladed, library: " BOUGH_SAMPLE_DISCON "}"

static built open_turbine(const char *const *sets) { return built_open(turbine, sets); }

// Above rated wind the law settles where a rigid rotor gives rated power at rated speed: a pitch of
// 10.45° gives 2 % less than it.
TEST(law_holds_speed_and_power) {
    static const char *const sets[] = {RIGID, "aero.wind.speed=15 m/s", "bodies[3-5].pitch=8 deg",
                                       "bodies[2].joint.speed=12.6 rpm", NULL};
    built f = open_turbine(sets);
    run_until(&f, 60);
    check_near(channel(&f, "RotSpeed"), 12.1, 2e-3, 0);
    check_near(channel(&f, "BldPitch1"), 10.3, 0, 0.25);
    check_near(channel(&f, "BldPitch3"), channel(&f, "BldPitch1"), 1e-12, 0);
    check_near(channel(&f, "GenPwr"), 0.944 * 5296.61, 1e-3, 0);
    check_near(channel(&f, "RtAeroPwr"), 5296610, 2e-2, 0); // blade 1 is near the tower
}

// Blades that nobody pitches and that stand beyond power_pitch: from standstill in a light wind the generator
// has no torque below cut-in, and at 9 rpm that of the best tip-speed ratio.
TEST(law_brakes_unsteered_blades_only) {
    const char *const *sets = sets_of(RIGID, "aero.wind.speed=6 m/s", "control.pitch=false",
                                      "bodies[3-5].pitch=10 deg", "bodies[2].joint.speed=0 rpm");
    built f = open_turbine(sets);
    for (int k = 1; k <= 10; k++) {
        run_until(&f, k);
        check_near(channel(&f, "GenTq"), 0, 0, 0);
        assert_true(channel(&f, "RotSpeed") > 0);
    }
    bough_arena_destroy(f.arena);
    static const char *const turning[] = {RIGID, "aero.wind.speed=8 m/s", "control.pitch=false",
                                          "bodies[3-5].pitch=2 deg", NULL};
    f = open_turbine(turning);
    run_until(&f, 0.04);
    double speed = channel(&f, "GenSpeed") * BOUGH_PI / 30;
    check_near(1e3 * channel(&f, "GenTq"), 2.332287 * speed * speed, 1e-2, 0);
}

// The library asks for a pitch of 0.1 + 0.001 t and 100 N m s of torque; both come a sample late,
// the pitch first at 8°/s.
TEST(library_steers_the_turbine) {
    static const char *const sets[] = {RIGID, BLADED, NULL};
    built f = open_turbine(sets);
    check_near(channel(&f, "GenSpeed"), 97 * 9.16, 1e-9, 0); // before any sample
    run_until(&f, 0.5);
    check_near(channel(&f, "BldPitch1"), 8 * 0.5, 1e-6, 0);
    check_near(channel(&f, "blade1Vel"), -8, 1e-6, 0);
    run_until(&f, 1.98);
    double speed = channel(&f, "GenSpeed") * BOUGH_PI / 30; // of the last sample
    run_until(&f, 2);
    check_near(channel(&f, "BldPitch2") * BOUGH_PI / 180, 0.10198, 1e-6, 0);
    check_near(channel(&f, "GenTq"), 0.1 * speed, 1e-6, 0);
}

// Collective pitch reaches every blade, also beyond those that the interface has records for.
TEST(library_steers_all_blades) {
    static const char *const sets[] = {
        RIGID,
        BLADED,
        "bodies[1].joint={kind: fixed, parent: ground, placement: [move z 87.6 m]}",
        "bodies[0]={name: blade4, fidelity: rigid, joint: {kind: revolute, parent: hub, axis: z, "
        "motion: {angle: 0 deg}, placement: [rotate x 60 deg, rotate y -2.5 deg, move z 1.5 m]}, "
        "rod: {table: blade-structure.yaml, segments: 24}}",
        "turbine.blades=[blade1, blade2, blade3, blade4]",
        NULL};
    built f = open_turbine(sets);
    run_until(&f, 0.5);
    check_near(channel(&f, "BldPitch4"), 8 * 0.5, 1e-6, 0);
}

// A turbine that looks along x in a wind of 10° across; a tower that bends moves its nacelle.
TEST(library_receives_the_nacelle) {
    static const char *const sets[] = {RIGID, BLADED, "aero.wind.direction=10 deg", NULL};
    static const char *const record[] = {"record 24", "record 37", "record 53"};
    for (int i = 0; i < 3; i++) {
        bough_arena *arena = check_memory();
        bough_simulation *s = NULL;
        bough_scene *scene = scene_read(arena, turbine, sets);
        scene->control.input = record[i];
        check_ok(bough_simulation_build(arena, scene, &s));
        built f = built_from(arena, s);
        run_until(&f, 1);
        double found = 1000 * channel(&f, "GenTq"); // kN m
        if (i == 0) check_near(found, 10 * BOUGH_PI / 180, 0, 5e-3);
        if (i == 1) check_near(found, 0, 0, 5e-3);
        if (i == 2) assert_true(fabs(found) < 2);
        bough_arena_destroy(f.arena);
    }
}

TEST(library_may_pitch_each_blade) {
    static const char *const sets[] = {RIGID, BLADED, "control.law={pitch_rate: 1 rad/s}", NULL};
    check_arena(arena);
    bough_scene *scene = scene_read(arena, turbine, sets);
    scene->control.input = "individual"; // of no folder
    bough_simulation *s = NULL;
    check_ok(bough_simulation_build(arena, scene, &s));
    while (s->master->time < 1) scene_step(s);
    for (int b = 0; b < 3; b++) {
        const bough_beam *blade = bough_simulation_beam(s, scene->turbine.blade[b]);
        check_near(bough_simulation_pitch(s, blade), 0.2 + 0.1 * b, 1e-6, 0);
    }
}

// What the library reports ends the run with its message.
TEST(failing_library_ends_the_run) {
    static const char *const sets[] = {RIGID, BLADED, NULL};
    check_arena(arena);
    bough_scene *scene = scene_read(arena, turbine, sets);
    scene->control.input = "fail";
    bough_simulation *s = NULL;
    bough_status status = bough_simulation_build(arena, scene, &s);
    while (bough_is_ok(&status) && s->master->time < 1) status = bough_step(s->master);
    check_fails(status, BOUGH_FAILED, "too late");
    check_near(s->master->time, 0.52, 1e-9, 0);
}

// A sample taken again from the saved memory steers as before.
TEST(memory_is_saved_and_restored) {
    static const char *const sets[] = {RIGID, "aero.wind.speed=15 m/s", NULL};
    built f = open_turbine(sets);
    run_until(&f, 3);
    double saved[100];
    bough_generator generator[2];
    bool jumped;
    bough_sampled_load load = f.s->sampled[1];
    bough_snapshot copy = {BOUGH_SNAPSHOT_SAVE, (char *)saved, 0},
                   back = {BOUGH_SNAPSHOT_RESTORE, (char *)saved, 0};
    bough_snapshot room = {BOUGH_SNAPSHOT_MEASURE, NULL, 0};
    load.snapshot(load.self, &room);
    assert_true(room.used <= sizeof saved);
    load.snapshot(load.self, &copy);
    for (int k = 0; k < 2; k++) {
        back.used = 0;
        load.snapshot(load.self, &back);
        check_ok(load.sample(load.self, 3, 3.02, &jumped));
        generator[k] = bough_control_link_generator(f.s->control);
        assert_false(jumped);
    }
    check_near(generator[1].torque, generator[0].torque, 0, 0);
    check_near(generator[1].power, generator[0].power, 0, 0);
}

TEST(bad_scenes_are_refused) {
    static const char *const bad[][2] = {
        {"bodies[4].joint={kind: fixed, parent: hub}", "all or none"},
        {"bodies[3].joint.axis=x", "turn about z"},
        {"control.rate=33 Hz", "multiple of the macro step"},
        {"control={kind: bladed}", "'library' is missing"},
        {"control.law.slip=-1", "must be positive"},
        {"control={kind: bladed, library: nowhere.so}", "cannot be loaded"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        scene_refused("apps/turbine/power.yaml", bad[i][0], bad[i][1]);
}

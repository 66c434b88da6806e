// Limits of the models: each is reported once, with time and body.
#include "apps/bough/model/run.h"
#include "apps/bough/model/validity.h"

#include "tests/unit/built_scene.h"

#include <string.h>

static const char turbine[] = "tests/data/scenes/example-turbine.yaml";

static bough_simulation *run_scene(bough_arena *arena, const char *scene, const char *const *sets,
                                   int steps) {
    bough_simulation *s = scene_build(arena, scene, sets);
    for (int k = 0; k < steps; k++) {
        scene_step(s);
        bough_validity_check(s);
    }
    return s;
}

static bough_simulation *run(bough_arena *arena, const char *const *sets, int steps) {
    return run_scene(arena, turbine, sets, steps);
}

// The limits that a run passes, a bit each.
static int passed(const bough_simulation *s) {
    int bits = 0;
    for (int k = 0; k < BOUGH_LIMITS; k++) bits |= s->validity->limit[k].passed << k;
    return bits;
}

TEST(within_the_limits_there_is_no_warning) {
    static const char *const sets[] = {NULL};
    check_arena(arena);
    assert_int_equal(passed(run(arena, sets, 100)), 0);
}

// Blades of a few metres on the shaft at 18 rad/s.
TEST(a_fast_section_is_warned_of_once) {
    static const char *const sets[] = {"bodies[2].joint.speed=18 rad/s", "aero.ramp=[0 s, 0 s]", NULL};
    check_arena(arena);
    bough_simulation *s = run(arena, sets, 4);
    bough_passing first = s->validity->limit[BOUGH_LIMIT_MACH];
    assert_int_equal(passed(s), 1 << BOUGH_LIMIT_MACH);
    assert_string_equal(s->scene->body[first.body].name, "blade1");
    check_near(first.time, 0.02, 1e-12, 0);
    assert_true(first.value > 170 && first.value < 250);
    for (int k = 0; k < 4; k++) scene_step(s), bough_validity_check(s);
    check_near(s->validity->limit[BOUGH_LIMIT_MACH].time, 0.02, 1e-12, 0);
    char text[200];
    bough_validity_describe(s, BOUGH_LIMIT_MACH, text, sizeof text);
    assert_non_null(strstr(text, "blade1 at 0.02 s: a section meets the air at "));
}

// 5 rad/s are 57 deg in a fifth of a second, 6 rad/s 69 deg.
TEST(a_rotor_that_turns_far_between_samples_is_reported) {
    for (int speed = 5; speed <= 6; speed++) {
        char chosen[48];
        snprintf(chosen, sizeof chosen, "bodies[hub].joint.motion={speed: %d rad/s}", speed);
        const char *const sets[] = {"bodies[hub].joint.speed=null", chosen, "aero.rate=5", NULL};
        check_arena(arena);
        bough_simulation *s = run(arena, sets, 4);
        bough_passing first = s->validity->limit[BOUGH_LIMIT_ROTATION];
        assert_int_equal(first.passed, speed == 6);
        if (first.passed) check_near(first.value, 1.2 * 180 / BOUGH_PI, 1e-3, 0);
    }
}

// A cantilever whose tip moment rolls it up to a circle: 60 deg in each of six segments, 30 of twelve.
TEST(a_turned_segment_is_reported) {
    static const char *const coarse[] = {"bodies[0].rod.segments=6", "simulation.initial=equilibrium", NULL};
    static const char *const fine[] = {"bodies[0].rod.segments=12", "simulation.initial=equilibrium", NULL};
    check_arena(arena);
    bough_simulation *s = scene_build(arena, "apps/beams/roll-up.yaml", fine);
    bough_validity_check(s);
    assert_int_equal(passed(s), 0);
    s = scene_build(arena, "apps/beams/roll-up.yaml", coarse);
    bough_validity_check(s);
    assert_int_equal(passed(s), 1 << BOUGH_LIMIT_TURN);
    check_near(s->validity->limit[BOUGH_LIMIT_TURN].value, 60, 1, 0);
}

// The tip of a uniform cantilever goes aside by F L³/(3 E I): 50 N and 55 N are on either side of a tenth of
// its length.
TEST(a_modal_body_that_bends_far_is_reported) {
    static const char *const load[] = {"loads=[{body: beam, at: tip, force: [50 N, 0, 0]}]",
                                       "loads=[{body: beam, at: tip, force: [55 N, 0, 0]}]"};
    for (int k = 0; k < 2; k++) {
        const char *const sets[] = {"bodies[beam].fidelity=modal", "gravity=[0, 0, 0]",
                                    "simulation.initial=equilibrium", load[k], NULL};
        check_arena(arena);
        bough_simulation *s = scene_build(arena, "tests/data/scenes/example-beam.yaml", sets);
        bough_validity_check(s);
        assert_int_equal(passed(s), k == 0 ? 0 : 1 << BOUGH_LIMIT_SHAPES);
        if (k == 1) check_near(s->validity->limit[BOUGH_LIMIT_SHAPES].value, 55. * 4 / (3 * 700), 1e-3, 0);
    }
}

// The hub on the tower's axis, without tilt: the hanging blade stands in the tower.
TEST(a_blade_in_the_tower_is_reported) {
    static const char *const sets[] = {"bodies[2].joint.placement=[move z 1.2 m]", NULL};
    check_arena(arena);
    bough_simulation *s = run(arena, sets, 4);
    bough_passing first = s->validity->limit[BOUGH_LIMIT_TOWER];
    assert_int_equal(passed(s), 1 << BOUGH_LIMIT_TOWER);
    assert_string_equal(s->scene->body[first.body].name, "blade2");
    assert_true(first.value >= 0 && first.value < 1);
}

// Each is seen before the first step; a scene without the defect passes nothing, above.
TEST(defects_of_the_model_are_reported_at_the_start) {
    static const struct {
        const char *scene, *set;
        bough_limit limit;
        double value;
        const char *text;
    } model[] = {
        {turbine, "bodies[blade2].joint.placement=[rotate x 60 deg, move z 1.5 m]", BOUGH_LIMIT_SPACING, 60,
         "hub at 0 s: the blades are not evenly spaced about its axis: between two of them are 60 deg"},
        {turbine, "aero.wind.direction=90 deg", BOUGH_LIMIT_ACROSS, 90,
         "hub at 0 s: its axis is across the wind, or faces away from it: the angle between them is 90 deg"},
        {turbine,
         "aero.wind={kind: uniform, table: {times: [0, 1.001, 1.01, 1.019], speeds: [12, 12, 40, 12]}}",
         BOUGH_LIMIT_WIND, 28,
         "hub at 1.01 s: the wind changes by 28 m/s and back between two samples of the air"},
        {"tests/data/scenes/example-beam.yaml", "bodies[beam].rod.segments=1", BOUGH_LIMIT_MESH, 1,
         "beam at 0 s: a rod of one segment bends by a third too little"},
    };
    for (int i = 0; i < 4; i++) {
        const char *const sets[] = {model[i].set, NULL};
        check_arena(arena);
        bough_simulation *s = scene_build(arena, model[i].scene, sets);
        char text[400];
        assert_int_equal(passed(s), 1 << model[i].limit);
        check_near(s->validity->limit[model[i].limit].value, model[i].value, 1e-6, 0);
        bough_validity_describe(s, model[i].limit, text, sizeof text);
        assert_memory_equal(text, model[i].text, strlen(model[i].text));
    }
}

#define IN_PIECES(blade) "bodies[" blade "].fidelity=segmented-modal", "bodies[" blade "].rod.segments=6"

// Vibrations of the pieces grow under air at 10 Hz, and not at 50 Hz.
TEST(samples_too_seldom_for_a_modal_blade_are_reported) {
    for (int rate = 10; rate <= 50; rate += 40) {
        char chosen[32];
        snprintf(chosen, sizeof chosen, "aero.rate=%d", rate);
        const char *const sets[] = {IN_PIECES("blade1"),
                                    IN_PIECES("blade2"),
                                    IN_PIECES("blade3"),
                                    chosen,
                                    "aero.ramp=[0, 0]",
                                    "simulation.coupling.scheme=monolithic",
                                    "bodies[hub].joint.speed=1.2 rad/s",
                                    NULL};
        check_arena(arena);
        bough_simulation *s = run_scene(arena, "apps/turbine/runup.yaml", sets, 30);
        assert_int_equal(s->validity->limit[BOUGH_LIMIT_SAMPLES].passed, rate == 10);
    }
}

// Windows of four bars, whose rods all come to lie on one line at 0.75 s; a loop that stays away from such a
// position.
TEST(singular_positions_are_reported) {
    static const char *const sets[] = {NULL};
    check_arena(arena);
    bough_simulation *s = run_scene(arena, "apps/mechanisms/four-bar.yaml", sets, 75);
    bough_passing first = s->validity->limit[BOUGH_LIMIT_SINGULAR];
    assert_int_equal(passed(s), 1 << BOUGH_LIMIT_SINGULAR);
    assert_true(first.time > 0.6 && first.value < 0.01);
    assert_int_equal(passed(run_scene(arena, "tests/data/scenes/closed.yaml", sets, 100)), 0);
}

// A connecting rod of 3 mg between bodies of one ton is too light to be told from equations that depend on
// each other: its loop opens, and the run ends.
TEST(a_loop_that_comes_apart_ends_the_run) {
    static const char *const sets[] = {"bodies[rod].mass=3e-6 kg",
                                       "bodies[rod].inertia=[2.5e-7, 2.5e-7, 1e-9]",
                                       "bodies[crank].joint.angle=0 deg",
                                       "bodies[rod].joint.angle=0 deg",
                                       "closures[pin].to_placement=[move z 1.2 m]",
                                       NULL};
    for (int k = 0; k < 2; k++) {
        check_arena(arena);
        bough_run run;
        const bough_scene *scene =
            scene_read(arena, "tests/data/scenes/light-rod.yaml", sets + (k == 0 ? 2 : 0));
        check_ok(bough_run_create(arena, scene, &run));
        bough_status status = bough_ok();
        for (int i = 0; i < 20 && bough_is_ok(&status); i++) status = bough_run_step(&run);
        assert_int_equal(status.code, k == 0 ? BOUGH_OK : BOUGH_FAILED);
        if (k == 1)
            assert_non_null(strstr(status.message, "closure 'pin' at 0.08 s under scheme monolithic"));
    }
}

// Two masses on stiff springs without damping, which ring at 16 and 31 kHz; at 160 and 310 Hz the same is
// cheap.
TEST(costly_motions_are_reported) {
    static const char *const stiff[] = {"springs[0-1].stiffness=1e10", "simulation.master.solver=ida",
                                        "simulation.error_estimate=none", NULL};
    for (int k = 0; k < 2; k++) {
        check_arena(arena);
        bough_run run;
        const bough_scene *scene =
            scene_read(arena, "apps/mechanisms/elastic-double-pendulum.yaml", stiff + k);
        bough_status status = bough_run_create(arena, scene, &run);
        for (int i = 0; i < 30 && bough_is_ok(&status); i++) status = bough_run_step(&run);
        assert_int_equal(status.code, BOUGH_OK);
        bough_passing cost = run.simulation->validity->limit[BOUGH_LIMIT_STEPS];
        assert_int_equal(passed(run.simulation), k == 0 ? 1 << BOUGH_LIMIT_STEPS : 0);
        assert_true(k == 1 || (cost.time > 0.005 && cost.time < 0.295 && cost.value > 1000));
        assert_true(k == 1 || cost.body == 0 || cost.body == 1);
    }
}

// A column that stands straight under more than Euler's load starts in an unstable equilibrium; under less it
// does not. EI π²/(4 L²) = 24.7 N.
TEST(an_unstable_start_is_reported) {
    static const char *const load[] = {"loads=[{body: column, at: tip, force: [0, 0, -40]}]",
                                       "loads=[{body: column, at: tip, force: [0, 0, -20]}]"};
    for (int k = 0; k < 2; k++) {
        const char *sets[] = {
            "bodies=[{name: column, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: "
            "{length: 1, segments: 16, stiffness: [1e5, 1e5, 1e6, 10, 20, 10], mass: [1, 0, "
            "0, 1e-3, 1e-3, 0]}}]",
            load[k],
            "gravity=[0, 0, 0]",
            "markers=[]",
            "simulation.initial=equilibrium",
            NULL};
        check_arena(arena);
        bough_run run;
        check_ok(bough_run_create(arena, scene_read(arena, "apps/mechanisms/pendulum.yaml", sets), &run));
        assert_int_equal(passed(run.simulation), k == 0 ? 1 << BOUGH_LIMIT_START : 0);
    }
}

// So is one beside a turbine in steady operation, whose own start is stable.
TEST(an_unstable_start_in_operation_is_reported) {
    static const char *const load[] = {"loads[0].force=[0, 0, -200]", "loads[0].force=[0, 0, -40]"};
    for (int k = 0; k < 2; k++) {
        const char *sets[] = {load[k], NULL};
        check_arena(arena);
        bough_run run;
        const bough_scene *scene = scene_read(arena, "tests/data/scenes/operation-beside-column.yaml", sets);
        check_ok(bough_run_create(arena, scene, &run));
        assert_int_equal(passed(run.simulation), k == 0 ? 1 << BOUGH_LIMIT_START : 0);
    }
}

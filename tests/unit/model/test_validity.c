// Limits of the models: each is reported once, with time and body.
#include "apps/bough/model/run.h"
#include "apps/bough/model/validity.h"

#include "tests/unit/built_scene.h"

static const char turbine[] = "tests/data/scenes/example-turbine.yaml", roll_up[] = "apps/beams/roll-up.yaml",
                  runup[] = "apps/turbine/runup.yaml", pendulum[] = "apps/mechanisms/pendulum.yaml",
                  beam[] = "tests/data/scenes/example-beam.yaml",
                  operation[] = "tests/data/scenes/operation-beside-column.yaml";

static bough_simulation *run_scene(bough_arena *arena, const char *scene, const char *const *sets,
                                   int steps) {
    bough_simulation *s = scene_build(arena, scene, sets);
    bough_validity_check_equilibrium(s);
    for (int k = 0; k <= steps; k++) {
        if (k > 0) scene_step(s);
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
    check_arena(arena);
    assert_int_equal(passed(run(arena, no_sets, 100)), 0);
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

#define IN_PIECES(blade) "bodies[" blade "].fidelity=segmented-modal", "bodies[" blade "].rod.segments=6"
#define PIECES                                                                                               \
    IN_PIECES("blade1"), IN_PIECES("blade2"), IN_PIECES("blade3"), "aero.ramp=[0, 0]",                       \
        "simulation.coupling.scheme=monolithic", "bodies[hub].joint.speed=1.2 rad/s"
#define SPEED(value) "bodies[hub].joint.speed=null", "bodies[hub].joint.motion={speed: " value " rad/s}"
#define SEGMENTS(n) "bodies[0].rod.segments=" n, "simulation.initial=equilibrium"
#define ON_TOWER "bodies[2].joint.placement=[move z 1.2 m]"
#define MODAL(force)                                                                                         \
    "bodies[beam].fidelity=modal", "gravity=[0, 0, 0]", "simulation.initial=equilibrium",                    \
        "loads=[{body: beam, at: tip, force: [" force ", 0, 0]}]"
#define COLUMN(force)                                                                                        \
    "bodies=[{name: col, fidelity: rigid, mass: 1, joint: {kind: fixed, parent: ground}}, "                  \
    "{name: column, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: {length: 1, "                  \
    "segments: 16, stiffness: [1e5, 1e5, 1e6, 10, 20, 10], mass: [1, 0, 0, 1e-3, 1e-3, 0]}}]",               \
        "loads=[{body: column, at: tip, force: [0, 0, " force "]}]", "gravity=[0, 0, 0]", "markers=[]",      \
        "simulation.initial=equilibrium"

// Runs on either side of a limit.
static const struct {
    const char *scene, *set[12];
    int steps;
    bough_limit limit;
    bool passes, others; // it is passed; so may others be
    double low, high;    // of its value
    const char *body;    // NULL: not looked at
} either_side[] = {
    // 5 rad/s are 57 deg in a fifth of a second, 6 rad/s 69 deg
    {turbine, {SPEED("5"), "aero.rate=5"}, 4, BOUGH_LIMIT_ROTATION, false, true, 0, 0, NULL},
    {turbine, {SPEED("6"), "aero.rate=5"}, 4, BOUGH_LIMIT_ROTATION, true, true, 68.7, 68.8, "hub"},
    // a tip moment rolls a cantilever up to a circle: 30 deg in each of twelve segments, 60 of six
    {roll_up, {SEGMENTS("12")}, 0, BOUGH_LIMIT_TURN, .others = true},
    {roll_up, {SEGMENTS("6")}, 0, BOUGH_LIMIT_TURN, true, true, 59, 61, NULL},
    // the tip of a uniform cantilever goes aside by F L³/(3 E I), a tenth of its length at 52.5 N
    {beam, {MODAL("50 N")}, 0, BOUGH_LIMIT_SHAPES, .others = false},
    {beam, {MODAL("55 N")}, 0, BOUGH_LIMIT_SHAPES, true, false, 0.1046, 0.1049, "beam"},
    // the hub on the tower's axis, without tilt: the hanging blade stands in the tower
    {turbine, {ON_TOWER}, 4, BOUGH_LIMIT_TOWER, true, false, 0, 1, "blade2"},
    // vibrations of the pieces grow under air at 10 Hz, and not at 50 Hz
    {runup, {PIECES, "aero.rate=10"}, 30, BOUGH_LIMIT_SAMPLES, true, true, 0.3, 1, NULL},
    {runup, {PIECES, "aero.rate=50"}, 30, BOUGH_LIMIT_SAMPLES, false, true, 0, 0, NULL},
    // four bars that all come to lie on one line at 0.75 s; a loop that stays away from such a position
    {"apps/mechanisms/four-bar.yaml", {NULL}, 75, BOUGH_LIMIT_SINGULAR, true, false, 0, 0.01, NULL},
    {"tests/data/scenes/closed.yaml", {NULL}, 100, BOUGH_LIMIT_SINGULAR, .others = false},
    // Euler's load is EI π²/(4 L²) = 24.7 N
    {pendulum, {COLUMN("-20")}, 0, BOUGH_LIMIT_START, .others = false},
    {pendulum, {COLUMN("-40")}, 0, BOUGH_LIMIT_START, true, false, 0.1, 100, "column"},
    // beside a turbine in steady operation, whose own start is stable
    {operation, {"loads[0].force=[0, 0, -40]"}, 0, BOUGH_LIMIT_START, .others = false},
    {operation, {"loads[0].force=[0, 0, -200]"}, 0, BOUGH_LIMIT_START, true, false, 0.1, 100, "column"},
};

TEST(a_limit_is_reported_where_it_is_passed) {
    for (size_t k = 0; k < sizeof either_side / sizeof *either_side; k++) {
        check_arena(arena);
        bough_simulation *s =
            run_scene(arena, either_side[k].scene, either_side[k].set, either_side[k].steps);
        bough_passing first = s->validity->limit[either_side[k].limit];
        print_message("%s: %g\n", bough_limit_name(either_side[k].limit), first.value);
        assert_int_equal(first.passed, either_side[k].passes);
        assert_true(either_side[k].others || passed(s) == either_side[k].passes << either_side[k].limit);
        if (first.passed)
            assert_true(first.value >= either_side[k].low && first.value <= either_side[k].high);
        if (either_side[k].body) assert_string_equal(s->scene->body[first.body].name, either_side[k].body);
    }
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
        {beam, "bodies[beam].rod.segments=1", BOUGH_LIMIT_MESH, 1,
         "beam at 0 s: a rod of one segment bends by a third too little"},
    };
    for (int i = 0; i < 4; i++) {
        check_build_with(arena, s, model[i].scene, model[i].set);
        char text[400];
        assert_int_equal(passed(s), 1 << model[i].limit);
        check_near(s->validity->limit[model[i].limit].value, model[i].value, 1e-6, 0);
        bough_validity_describe(s, model[i].limit, text, sizeof text);
        assert_memory_equal(text, model[i].text, strlen(model[i].text));
    }
}

// A connecting rod of 3 mg between bodies of one ton is too light to be distinguished from equations that
// depend on each other, and one of 1 m cannot follow a slider that is pulled away: the loop opens, and the
// run ends.
TEST(a_loop_that_comes_apart_ends_the_run) {
    static const struct {
        const char *sets[6], *text; // without a text the loop stays closed
    } loop[] = {
        {{"bodies[crank].joint.angle=0 deg", "bodies[rod].joint.angle=0 deg",
          "closures[pin].to_placement=[move z 1.2 m]"},
         NULL},
        {{"bodies[rod].mass=3e-6 kg", "bodies[rod].inertia=[2.5e-7, 2.5e-7, 1e-9]",
          "bodies[crank].joint.angle=0 deg", "bodies[rod].joint.angle=0 deg",
          "closures[pin].to_placement=[move z 1.2 m]"},
         "of its size: the steps are too long (try a smaller rtol or macro_step), or one of its bodies"},
        {{"bodies[rod].mass=30 kg", "bodies[crank].joint.speed=0",
          "bodies[slider].joint.motion={position: {from: 0, to: 0.1, ramp: [0, 0.2]}}"},
         "of its size: it cannot follow the motion that a joint prescribes, or the steps"},
    };
    for (int k = 0; k < 3; k++) {
        check_run(arena, run, "tests/data/scenes/light-rod.yaml", loop[k].sets);
        bough_status status = bough_ok();
        for (int i = 0; i < 20 && bough_is_ok(&status); i++) status = bough_run_step(&run);
        if (loop[k].text)
            check_fails(status, BOUGH_FAILED, loop[k].text);
        else
            check_ok(status);
    }
}

// Two masses on stiff springs without damping, which ring at 16 and 31 kHz; at 160 and 310 Hz the same is
// cheap.
TEST(costly_motions_are_reported) {
    static const char *const stiff[] = {"springs[0-1].stiffness=1e10", "simulation.master.solver=ida",
                                        "simulation.error_estimate=none", NULL};
    for (int k = 0; k < 2; k++) {
        check_run(arena, run, "apps/mechanisms/elastic-double-pendulum.yaml", stiff + k);
        for (int i = 0; i < 30; i++) check_ok(bough_run_step(&run));
        bough_passing cost = run.simulation->validity->limit[BOUGH_LIMIT_STEPS];
        assert_int_equal(passed(run.simulation), k == 0 ? 1 << BOUGH_LIMIT_STEPS : 0);
        assert_true(k == 1 || (cost.time > 0.005 && cost.time < 0.295 && cost.value > 1000));
        assert_true(k == 1 || cost.body == 0 || cost.body == 1);
    }
}

// A rod of 136 Hz that is let go, in macro steps of 0.25 s: its steps pass over the vibrations, and the finer
// solution gives up.
TEST(vibrations_that_no_solution_follows_are_reported) {
    static const char *const damping[] = {"bodies[rod].rod.damping=[0, 0, 0, 0, 0, 0]",
                                          "bodies[rod].rod.damping=[1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3]"};
    for (int k = 0; k < 2; k++) {
        check_run(arena, run, "tests/data/scenes/let-go.yaml",
                  sets_of("simulation.macro_step=0.25 s", "simulation.duration=2 s",
                          "bodies[rod].rod.stiffness=[1e6, 1e6, 1e7, 8e3, 8e3, 6e3]", damping[k]));
        for (int i = 0; i < 8; i++) check_ok(bough_run_step(&run));
        assert_int_equal(passed(run.simulation), k == 0 ? 1 << BOUGH_LIMIT_FAST : 0);
        check_near(run.simulation->validity->limit[BOUGH_LIMIT_FAST].time, k == 0 ? 0.25 : 0, 1e-12, 0);
    }
}

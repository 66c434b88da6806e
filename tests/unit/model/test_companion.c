// The companion of a run: what it tells against solutions that are finer in mesh, air and time.
#include "apps/bough/model/companion.h"
#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/run.h"
#include "tests/unit/built_scene.h"

#include <stdlib.h>
#include <string.h>

static const char example[] = "tests/data/scenes/example-turbine.yaml";
enum { MOST = 256, STEPS = 100 };

typedef struct outcome {
    int n; // channels
    char name[MOST][BOUGH_CHANNEL_NAME];
    double value[STEPS][MOST]; // at multiples of 20 ms
    double error[MOST];        // estimate
    double largest[MOST];      // value
    bool compared;
    char reason[BOUGH_COMPANION_REASON];
} outcome;

static outcome *run_for(const char *path, int steps, const char *const *sets) {
    outcome *o = calloc(1, sizeof *o);
    check_arena(arena);
    bough_run r;
    bough_status status = bough_run_create(arena, scene_read(arena, path, sets), &r);
    check_ok(status);
    assert_true(r.channels.count <= MOST);
    o->n = r.channels.count;
    for (int i = 0; i < o->n; i++) strcpy(o->name[i], r.channels.channel[i].name);
    for (int k = 0; k < steps; k++) {
        do {
            status = bough_run_step(&r);
            check_ok(status);
        } while (r.simulation->master->time < 0.02 * (k + 1) - 1e-9);
        memcpy(o->value[k], bough_run_values(&r), (size_t)o->n * sizeof(double));
        for (int i = 0; i < o->n; i++) o->largest[i] = fmax(o->largest[i], fabs(o->value[k][i]));
    }
    for (int i = 0; i < o->n; i++)
        o->error[i] = bough_companion_knows(r.companion, i) ? r.companion->error[i] : (double)NAN;
    o->compared = r.companion->compared > 0;
    memcpy(o->reason, r.companion->reason, sizeof o->reason);
    return o;
}

static double true_error(const outcome *o, const outcome *truth, int channel, int steps) {
    double error = 0;
    for (int k = 0; k < steps; k++)
        error = fmax(error, fabs(o->value[k][channel] - truth->value[k][channel]));
    return error;
}

// The whole error of motion, by mesh, air, steps and coupling, for two schemes.
TEST(the_whole_error_is_estimated) {
    const char *const truth_sets[] = {"simulation.duration=2 s",
                                      "simulation.coupling={scheme: monolithic}",
                                      "simulation.master={solver: rosenbrock, step: 5 ms, rtol: 1e-6}",
                                      "simulation.macro_step=5 ms",
                                      "simulation.error_estimate=none",
                                      "bodies[3-5].rod.segments=72",
                                      "aero.rate=200",
                                      NULL};
    outcome *truth = run_for("apps/turbine/runup.yaml", STEPS, truth_sets);
    assert_false(truth->compared);
    static const char *const coupling[] = {"simulation.coupling={scheme: ramp, theta: auto}",
                                           "simulation.coupling={scheme: monolithic}"};
    static const char *const watched[] = {"RotSpeed", "TipDxb1",  "TipDyb1",  "TwstDefl1",
                                          "RootMyb1", "RootMxb1", "RootFyb1", "RootFzb1"};
    for (int c = 0; c < 2; c++) {
        const char *const sets[] = {"simulation.duration=2 s", coupling[c],
                                    "simulation.master={solver: rosenbrock, step: 10 ms, rtol: 3e-4}", NULL};
        outcome *o = run_for("apps/turbine/runup.yaml", STEPS, sets);
        assert_true(o->compared);
        for (size_t w = 0; w < sizeof watched / sizeof *watched; w++) {
            int i = 0;
            while (strcmp(o->name[i], watched[w]) != 0) i++;
            double error = true_error(o, truth, i, STEPS);
            print_message("%s: true %.2g, estimate %.2g: %.2f\n", watched[w], error, o->error[i],
                          o->error[i] / error);
            bool force = strncmp(watched[w], "RootF", 5) == 0 && c == 1;
            assert_true(o->error[i] > error / (force ? 2 : 3) && o->error[i] < 5 * error);
        }
        free(o);
    }
    free(truth);
}

// Six segments under air at half the rate lose the solution. With either as in the run they keep it, and
// these two solutions give the error.
TEST(a_companion_that_loses_the_solution_is_replaced) {
    const char *const sets[] = {"simulation.duration=20 s", "simulation.output.from=8 s",
                                "simulation.error_estimate=companion", "bodies[3-5].rod.segments=12", NULL};
    check_arena(arena);
    bough_run r;
    bough_error_shares shares;
    check_ok(bough_run_create(arena, scene_read(arena, "apps/turbine/land-operation.yaml", sets), &r));
    while (!bough_run_done(&r)) check_ok(bough_run_step(&r));
    int twist = 0;
    while (strcmp(r.channels.channel[twist].name, "TwstDefl1") != 0) twist++;
    assert_true(bough_error_relative(r.companion, twist, r.companion->error[twist]) > 0.5);
    check_ok(bough_error_shares_find(arena, r.companion, NULL, &shares));
    double relative = bough_error_relative(r.companion, twist, r.companion->error[twist]);
    print_message("TwstDefl1: %.2g of its range\n", relative);
    assert_true(relative > 2e-3 && relative < 0.15);
}

// A load that comes in the second half of the last macro step, of which the further runs know, too.
TEST(the_last_half_step_has_shares) {
    const char *const sets[] = {"simulation.coupling.scheme=frozen", "bodies[arm].rod.segments=10",
                                "loads[0].factor={times: [0.795, 0.7951], values: [0, 1]}", NULL};
    check_arena(arena);
    bough_run r;
    bough_error_shares shares;
    check_ok(bough_run_create(arena, scene_read(arena, "tests/data/scenes/small-vibration.yaml", sets), &r));
    while (!bough_run_done(&r)) check_ok(bough_run_step(&r));
    int tip = bough_channels_find(&r.channels, "armTipX");
    double error = r.companion->error[tip];
    assert_true(error > 0);
    check_ok(bough_error_shares_find(arena, r.companion, NULL, &shares));
    check_near(r.companion->error[tip], error, 0.5, 0);
    assert_true(shares.share[BOUGH_SHARE_TIME].largest[tip] > 0.1 * error);
}

// A short run whose steps are as long as its macro step: half of them would be the companion's own steps.
TEST(steps_of_a_macro_step_have_an_error) {
    const char *const truth_sets[] = {"simulation.macro_step=20 ms", "simulation.error_estimate=none", NULL};
    outcome *truth = run_for("apps/mechanisms/pendulum.yaml", STEPS, truth_sets);
    static const char *const solver[] = {
        "simulation.master={solver: generalized-alpha, step: 20 ms, rtol: 1e-4}",
        "simulation.master={solver: rosenbrock, step: 20 ms, rtol: 3e-3}"};
    for (int k = 0; k < 2; k++) {
        const char *const sets[] = {"simulation.macro_step=20 ms", solver[k], NULL};
        outcome *o = run_for("apps/mechanisms/pendulum.yaml", STEPS, sets);
        for (int i = 0; i < 2; i++) {
            double error = true_error(o, truth, i, STEPS);
            print_message("%s: true %.2g, estimate %.2g\n", o->name[i], error, o->error[i]);
            assert_true(o->error[i] > error / 2 && o->error[i] < 4 * error);
        }
        free(o);
    }
    free(truth);
}

// Before a run fails by its steps, finer ones say what these err by: more closely than the companion does.
TEST(finer_steps_prove_an_error_in_time) {
    static const char scene[] = "apps/mechanisms/pendulum.yaml";
    const char *const truth_sets[] = {"simulation.macro_step=20 ms", "simulation.error_estimate=none", NULL};
    const char *const sets[] = {"simulation.duration=2 s", "simulation.macro_step=20 ms",
                                "simulation.error_bound=1e-6",
                                "simulation.master={solver: rosenbrock, rtol: 1e-2}", NULL};
    outcome *truth = run_for(scene, STEPS, truth_sets), *o = run_for(scene, STEPS, sets);
    check_arena(arena);
    bough_run r;
    bough_error_shares shares;
    check_ok(bough_run_create(arena, scene_read(arena, scene, sets), &r));
    for (int k = 0; k < STEPS; k++) check_ok(bough_run_step(&r));
    check_ok(bough_error_shares_find(arena, r.companion, NULL, &shares));
    for (int i = 0; i < 2; i++) {
        double error = true_error(o, truth, i, STEPS), proved = r.companion->error[i];
        print_message("%s: true %.3g, companion %.3g, finer steps %.3g\n", o->name[i], error, o->error[i],
                      proved);
        assert_true(o->error[i] > 1.05 * proved);
        check_near(proved, error, 0.2, 0);
        check_near(shares.share[BOUGH_SHARE_TIME].largest[i], proved, 1e-9, 0);
    }
    free(o);
    free(truth);
}

static int asked; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables): by one test

static bool count_and_go_on(void) {
    asked++;
    return false;
}

// Steps of generalised-α are given; a method that keeps such a tolerance needs a hundred times as many, and
// is given up.
TEST(a_proof_of_too_many_steps_is_none) {
    const char *const sets[] = {"simulation.macro_step=20 ms", "simulation.error_bound=1e-6",
                                "simulation.master={solver: generalized-alpha, step: 20 ms, rtol: 1e-11}",
                                NULL};
    check_arena(arena);
    bough_run r;
    bough_error_shares shares;
    check_ok(bough_run_create(arena, scene_read(arena, "apps/mechanisms/pendulum.yaml", sets), &r));
    while (!bough_run_done(&r)) check_ok(bough_run_step(&r));
    asked = 0;
    check_ok(bough_error_shares_find(arena, r.companion, count_and_go_on, &shares));
    print_message("%d macro steps\n", asked);
    assert_true(asked > 250 && asked < 400); // 250 of the companion; the proof would take 500
}

// Estimating changes no bit of the run.
TEST(a_companion_changes_nothing) {
    const char *const with[] = {"simulation.duration=1 s", NULL};
    const char *const without[] = {"simulation.duration=1 s", "simulation.error_estimate=none", NULL};
    outcome *a = run_for(example, 50, with), *b = run_for(example, 50, without);
    assert_true(a->compared);
    assert_false(b->compared);
    assert_string_equal(b->reason, "simulation.error_estimate is none");
    assert_memory_equal(a->value, b->value, sizeof a->value);
    free(a);
    free(b);
}

// Every channel has an error, forces, air and control too.
TEST(every_channel_has_an_error) {
    const char *const sets[] = {"simulation.duration=1 s", NULL};
    outcome *o = run_for("apps/turbine/power.yaml", 50, sets);
    for (int i = 0; i < o->n; i++) {
        if (!isfinite(o->error[i])) fail_msg("%s has none", o->name[i]);
    }
    free(o);
}

// What the mesh changes before the first step is an error, too: here of the forces of the air.
TEST(the_start_is_compared) {
    static const char *const none[] = {NULL};
    check_arena(arena);
    bough_run r;
    check_ok(bough_run_create(arena, scene_read(arena, example, none), &r));
    double most = 0;
    for (int i = 0; i < r.channels.count; i++) most = fmax(most, r.companion->error[i]);
    assert_true(most > 0);
    assert_false(bough_companion_knows(r.companion, 0));
}

// What a sampled channel errs by is what happens while the run holds it: nothing where it is sampled at every
// macro step, though the companion holds it at the end of an odd number of them.
TEST(a_held_sample_errs_by_its_age) {
    static const struct {
        const char *macro_step;
        double age; // of the oldest sample that the run shows [s]
    } cases[] = {{"simulation.macro_step=20 ms", 0},
                 {"simulation.macro_step=10 ms", 10e-3},
                 {"simulation.macro_step=5 ms", 15e-3}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const sets[] = {"simulation.duration=1.02 s", cases[k].macro_step,
                                    "aero.wind={kind: uniform, table: {times: [0, 1.02], speeds: [6, 12]}}",
                                    NULL};
        outcome *o = run_for("apps/turbine/runup-stages.yaml", 51, sets);
        int i = 0;
        while (strcmp(o->name[i], "RtVAvgxh") != 0) i++;
        double held = 6 / 1.02 * cases[k].age;
        print_message("error %.2g m/s, held %.2g\n", o->error[i], held);
        check_near(o->error[i], held, 0, 0.02);
        free(o);
    }
}

#define LIBRARY                                                                                              \
    "control={kind: bladed, rate: 50, gear_ratio: 97, input: memory, library: " BOUGH_SAMPLE_DISCON "}"

// A library has a memory, and the companion one of its own: the run's values are those without it.
// A gust that comes and stays between two samples of the run, and between the companion's, is seen by
// neither.
TEST(a_change_between_samples_is_an_error_until_the_next) {
    const char *const sets[] = {
        "simulation.duration=1.02 s", "simulation.macro_step=5 ms",
        "aero.wind={kind: uniform, table: {times: [0, 0.5, 0.505, 1.02], speeds: [12, 12, 6, 6]}}", NULL};
    outcome *o = run_for("apps/turbine/runup-stages.yaml", 51, sets);
    int i = 0;
    while (strcmp(o->name[i], "RtVAvgxh") != 0) i++;
    print_message("error %.2g m/s\n", o->error[i]);
    assert_true(o->error[i] > 0.7 * 6 && o->error[i] < 1.2 * 6);
    free(o);
}

TEST(a_library_is_copied) {
    const char *const with[] = {"simulation.duration=1 s", LIBRARY, NULL};
    const char *const without[] = {"simulation.duration=1 s", LIBRARY, "simulation.error_estimate=none",
                                   NULL};
    outcome *a = run_for("apps/turbine/power.yaml", 50, with),
            *b = run_for("apps/turbine/power.yaml", 50, without);
    assert_true(a->compared);
    assert_memory_equal(a->value, b->value, sizeof a->value);
    free(a);
    free(b);
}

// -- the coarser scene ----------------------------------------------------------------------------

TEST(a_scene_is_coarser_in_everything) {
    check_arena(arena);
    const char *const sets[] = {NULL};
    bough_scene *scene = scene_read(arena, "apps/turbine/runup-stages.yaml", sets);
    const bough_scene *c = bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL);
    check_near(c->simulation.macro_step, 40e-3, 1e-15, 0);
    check_near(c->simulation.master.step, 20e-3, 1e-15, 0);
    check_near(c->simulation.master.rtol, 3e-3, 1e-15, 0);
    check_near(c->aero.rate, 25, 1e-15, 0);
    for (int i = 0; i < c->n_body; i++) {
        if (scene->body[i].rod.node) assert_int_equal(c->body[i].rod.n_segment, 12);
    }
    assert_true(c->simulation.halves);
    // of the time alone: the air's samples do not let the macro step be longer
    c = bough_coarser_scene(arena, scene, BOUGH_COARSER_TIME);
    check_near(c->simulation.macro_step, 20e-3, 1e-15, 0);
    assert_false(c->simulation.halves);
    check_near(c->aero.rate, 50, 1e-15, 0);
    for (int i = 0; i < c->n_body; i++)
        assert_int_equal(c->body[i].rod.n_segment, scene->body[i].rod.n_segment);
}

// Rods of few segments get more, all blades as many, and the part of the difference follows; it is the whole
// one where a coupling is explicit.
TEST(meshes_differ_as_far_as_they_can) {
    static const struct {
        const char *segments, *coupling;
        int other;
        double share;
    } cases[] = {
        {"bodies[3-5].rod.segments=20", "simulation.coupling={scheme: monolithic}", 10, 0.25},
        {"bodies[3-5].rod.segments=16", "simulation.coupling={scheme: monolithic}", 10, 0.75 / (2.56 - 1)},
        {"bodies[3-5].rod.segments=9", "simulation.coupling={scheme: monolithic}", 5, 0.75 / (81.0 / 25 - 1)},
        {"bodies[3-5].rod.segments=8", "simulation.coupling={scheme: ramp}", 16, 1},
        {"bodies[3-5].rod.segments=1", "simulation.coupling={scheme: ramp}", 8, 1},
        {"bodies[3-5].fidelity=modal", "simulation.coupling={scheme: monolithic}", 48, 1},
        {"bodies[3-5].rod.segments=16", "simulation.coupling={scheme: ramp}", 10, 0.5},
        {"bodies[3-5].rod.segments=16", "simulation.coupling={scheme: iterated}", 10, 1},
        {"bodies[3-5].rod.segments=16", "simulation.coupling={scheme: frozen}", 10, 1}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const sets[] = {cases[k].segments, cases[k].coupling, NULL};
        bough_scene *scene = scene_read(arena, "apps/turbine/runup.yaml", sets);
        const bough_scene *c = bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL);
        for (int i = 3; i <= 5; i++) assert_int_equal(c->body[i].rod.n_segment, cases[k].other);
        check_near(bough_coarser_share(scene, c), cases[k].share, 1e-12, 0);
    }
}

// A wave takes 0.1 ms through a segment.
TEST(short_pulses_have_a_finer_companion) {
    static const struct {
        const char *loads;
        int other;
    } cases[] = {
        {"loads=[{body: arm, at: tip, force: [0, 0, 1], factor: {times: [0, 10 us, 40 us, 50 us], values: [0, 1, 1, 0]}}]",
         40},
        {"loads=[{body: arm, at: tip, force: [0, 0, 1], factor: {times: [0, 10 us, 140 us, 150 us], values: [0, 1, 1, 0]}}]",
         10},
        {"loads=[{body: arm, at: tip, force: [0, 0, 1], factor: {times: [0, 10 us, 40 us, 50 us], values: [0, 1, 1, 2]}}]",
         10}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const sets[] = {cases[k].loads, NULL};
        bough_scene *scene = scene_read(arena, "apps/beams/spin-up.yaml", sets);
        assert_int_equal(bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL)->body[0].rod.n_segment,
                         cases[k].other);
    }
}

// A jump within a macro step makes a coupling one of first order: the whole difference counts.
TEST(jumps_of_loads_count_in_a_coupling) {
    static const struct {
        const char *loads;
        double share;
    } cases[] = {{"loads=[{joint: hub, torque: 1 MN m, ramp: [1 s, 1.01 s]}]", 1},
                 {"loads=[{joint: hub, torque: 1 MN m, ramp: [1 s, 2 s]}]", 0.5},
                 {"loads=[{joint: hub, torque: {times: [0, 5 s, 5.01 s], values: [0, 1 MN m, 2 MN m]}}]", 1},
                 {"loads=[{joint: hub, torque: 1 MN m}]", 0.5}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const sets[] = {cases[k].loads, NULL};
        bough_scene *scene = scene_read(arena, "apps/turbine/runup.yaml", sets);
        check_near(bough_coarser_share(scene, bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL)),
                   cases[k].share, 1e-12, 0);
    }
}

// The delay of loads that are held between samples is of first order.
TEST(half_of_the_difference_counts_where_loads_are_held) {
    check_arena(arena);
    const char *const sets[] = {"aero.hold=constant", "simulation.coupling={scheme: monolithic}", NULL};
    bough_scene *scene = scene_read(arena, "apps/turbine/runup.yaml", sets);
    check_near(bough_coarser_share(scene, bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL)), 0.5, 1e-12,
               0);
}

// Vibrations that no air damps err at a lower order.
TEST(two_fifths_of_the_difference_count_without_air) {
    check_arena(arena);
    const char *const sets[] = {"simulation.coupling={scheme: monolithic}", "simulation.micro=null", NULL};
    bough_scene *scene = scene_read(arena, "apps/beams/spin-up.yaml", sets);
    check_near(bough_coarser_share(scene, bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL)), 0.4, 1e-12,
               0);
}

// The vector of the wind over a rotor in axes that turn with it changes without a new sample, which is no
// error.
TEST(turning_axes_are_no_age) {
    const char *const sets[] = {"simulation.duration=1.02 s", "simulation.macro_step=5 ms", "aero.tower=null",
                                NULL};
    outcome *o = run_for("apps/turbine/rotor.yaml", 51, sets);
    int i = 0;
    while (strcmp(o->name[i], "RtVAvgyh") != 0) i++;
    double moves = 0;
    for (int k = 1; k < 51; k++) moves = fmax(moves, fabs(o->value[k][i] - o->value[k - 1][i]));
    print_message("error %.2g m/s, change in a step %.2g\n", o->error[i], moves);
    assert_true(o->error[i] < 0.2 * moves);
    free(o);
}

// With a finer mesh the air is finer too where macro steps allow it: errors of one sign would cancel in the
// difference.
TEST(beside_a_finer_mesh_the_air_is_finer_where_it_can_be) {
    static const struct {
        const char *segments, *macro_step;
        double rate; // of 50 Hz
    } cases[] = {{"bodies[3-5].rod.segments=24", "simulation.macro_step=20 ms", 25},
                 {"bodies[3-5].rod.segments=4", "simulation.macro_step=20 ms", 25},
                 {"bodies[3-5].rod.segments=4", "simulation.macro_step=10 ms", 100}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const sets[] = {cases[k].segments, cases[k].macro_step, NULL};
        bough_scene *scene = scene_read(arena, "apps/turbine/runup-stages.yaml", sets);
        check_near(bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL)->aero.rate, cases[k].rate, 0, 1e-12);
    }
}

// The whole difference counts beside a finer mesh and an explicit coupling: that of the steps is to be small.
TEST(steps_are_little_longer_where_the_whole_difference_counts) {
    static const struct {
        const char *segments, *coupling;
        double step, rtol, share;
    } cases[] = {
        {"bodies[3-5].rod.segments=8", "simulation.coupling={scheme: monolithic}", 20e-3, 1.8e-3, 0.25},
        {"bodies[3-5].rod.segments=16", "simulation.coupling={scheme: frozen}", 15e-3, 9e-4, 1}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const sets[] = {cases[k].segments, cases[k].coupling,
                                    "simulation.master={solver: rosenbrock, step: 10 ms, rtol: 3e-4}",
                                    "simulation.micro={solver: rosenbrock, step: 10 ms, rtol: 3e-4}", NULL};
        bough_scene *scene = scene_read(arena, "apps/turbine/runup-stages.yaml", sets);
        const bough_scene *c = bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL);
        check_near(c->simulation.master.step, cases[k].step, 1e-15, 0);
        check_near(c->simulation.master.rtol, cases[k].rtol, 1e-15, 0);
        check_near(bough_coarser_time_share(scene), cases[k].share, 1e-15, 0);
    }
}

// Another scheme than one system leaves the companion no error of a coupling, but the sub-solvers' steps,
// twice as long.
TEST(a_coupling_has_a_monolithic_companion) {
    check_arena(arena);
    const char *const sets[] = {NULL};
    bough_scene *scene = scene_read(arena, "apps/turbine/runup.yaml", sets);
    const bough_scene *c = bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL);
    assert_string_equal(bough_scheme_name(c->simulation.coupling.scheme), "monolithic");
    check_near(c->simulation.master.step, 20e-3, 1e-15, 0);
    check_near(c->simulation.master.rtol, 4e-3, 1e-15, 0);
    check_near(bough_coarser_share(scene, c), 0.5, 1e-12, 0);
    // fixed steps have an error that the companion's, by tolerance, do not share
    const char *const fixed[] = {"simulation.micro={solver: generalized-alpha, step: 10 ms}", NULL};
    scene = scene_read(arena, "apps/turbine/runup.yaml", fixed);
    c = bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL);
    check_near(bough_coarser_share(scene, c), 1, 1e-12, 0);
    // a weight other than 1/2 makes the coupling's error one of first order: the whole difference
    scene->simulation.micro.solver = BOUGH_ROSENBROCK;
    scene->simulation.coupling.options.theta = 0.5;
    check_near(bough_coarser_share(scene, c), 0.5, 1e-12, 0);
    scene->simulation.coupling.options.theta = 0.89;
    check_near(bough_coarser_share(scene, c), 1, 1e-12, 0);
}

// -- what counts ----------------------------------------------------------------------------------

typedef struct row {
    const char *name, *unit;
    double range, error;
} row;

// Of channels that start at 0: the worst, and the words for its error.
static int worst_in(int n, const row *rows, char words[BOUGH_ERROR_SIZE]) {
    bough_arena *arena = bough_arena_create();
    bough_channels channels = bough_channels_start(arena);
    bough_companion c = {.channels = &channels, .compared = 1, .length = 60};
    bough_arena_each(arena, (size_t)n, &c.low, &c.high, &c.other_low, &c.other_high, &c.error, &c.noticed);
    bough_channels_group(&channels, NULL, NULL);
    for (int i = 0; i < n; i++) {
        bough_channels_add(&channels, rows[i].unit, "%s", rows[i].name);
        c.high[i] = c.other_high[i] = rows[i].range;
        c.error[i] = rows[i].error;
    }
    int worst = bough_error_verdict_of(&c, true, c.error).channel;
    if (worst >= 0) bough_error_size(&c, worst, words);
    bough_arena_destroy(arena);
    return worst;
}

static int worst_of(int n, const row *rows) {
    char words[BOUGH_ERROR_SIZE];
    return worst_in(n, rows, words);
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

// Blades of one segment change the speed of their hub by 4 %, many times what it had changed by: an error of
// the mesh, which ends no run early.
TEST(a_coarse_mesh_is_no_lost_solution) {
    const char *const sets[] = {NULL};
    check_arena(arena);
    bough_run r;
    check_ok(bough_run_create(arena, scene_read(arena, "tests/data/scenes/uneven-rotor.yaml", sets), &r));
    while (!bough_run_done(&r)) {
        check_ok(bough_run_step(&r));
        assert_false(bough_companion_parted(r.companion));
    }
    assert_true(bough_error_exceeds(r.companion, 1));
}

// A hinge of a rotor, before a load comes: it has hardly moved, so that a difference is many ranges.
TEST(a_difference_shows_beside_the_values_of_its_kind) {
    two_channels v = {.low = {700, 0},
                      .high = {700, 1e-4},
                      .other_low = {700, 0},
                      .other_high = {700, 7e-3},
                      .error = {0, 7e-3},
                      .unit = {"deg/s", "deg/s"},
                      .name = {"shaftVel", "hingeVel"}};
    check_arena(arena);
    bough_companion *c = compared(arena, &v);
    bough_error_notice(c, 1);
    assert_true(bough_error_relative(c, 1, v.error[1]) > 10);
    assert_false(bough_error_shows(c, 1, v.error[1]));
    assert_false(bough_error_shows(c, 1, 69));
    assert_true(bough_error_shows(c, 1, 71));
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
}

// A range of rounding is none to measure an error by.
TEST(an_error_far_beyond_its_range_has_no_figure) {
    char words[BOUGH_ERROR_SIZE];
    assert_int_equal(worst_in(1, (row[]){{"TipDxb1", "m", 4, .01}}, words), 0);
    assert_string_equal(words, "0.01 m, 0.0025 of its range");
    assert_int_equal(worst_in(1, (row[]){{"Pos", "deg", 3e-14, 5}}, words), 0);
    assert_string_equal(words, "5 deg, more than 10 times its range");
}

// A twist of rounding or of next to nothing is not judged by itself, beside blades that bend.
TEST(what_hardly_moves_does_not_count) {
    assert_int_equal(worst_of(2, (row[]){{"TipDxb1", "m", 4, .01}, {"TwstDefl1", "deg", 4e-16, 3e-16}}), 0);
    assert_int_equal(
        worst_of(
            3, (row[]){{"TipDxb1", "m", 4, .01}, {"TwstDefl1", "deg", 2.5e-4, 2e-4}, {"Pos", "deg", 3, .01}}),
        2);
    assert_int_equal(worst_of(2, (row[]){{"TipDxb1", "m", 4, .01}, {"TwstDefl1", "deg", 2.5e-3, 2e-3}}), 0);
    assert_int_equal(worst_of(2, (row[]){{"TipDxb1", "m", 4, .01}, {"TwstDefl1", "deg", 5e-3, 4e-3}}), 1);
    assert_int_equal(worst_of(2, (row[]){{"TipDxb1", "m", 4e-13, 1e-14}, {"TwstDefl1", "deg", 4e-16, 3e-16}}),
                     -1);
    assert_int_equal(worst_of(2, (row[]){{"one", "m", 1, .01}, {"other", "m", 2e-3, 1e-3}}), 1);
    assert_int_equal(worst_of(2, (row[]){{"one", "m", 1, .01}, {"other", "m", 5e-4, 4e-4}}), 0);
}

// What follows from simulation.accuracy: the settings that a scene does not name, and the error that they
// leave.
#include "apps/bough/model/run.h"
#include "tests/unit/built_scene.h"
#include "tests/unit/scene_text.h"

// -- settings -------------------------------------------------------------------------------------

#define BAR(keys)                                                                                            \
    "simulation: {duration: 1.2 s" keys "}\nbodies:\n"                                                       \
    "  - {name: b, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: {length: 2,\n"                  \
    "      stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}}\n"

TEST(everything_follows_from_the_default) {
    fixture f = accepts(BAR(""));
    const bough_scene_simulation *s = &f.scene->simulation;
    check_near(s->accuracy, 0.005, 0, 0);
    assert_string_equal(bough_scheme_name(s->coupling.scheme), "monolithic");
    assert_int_equal(s->master.solver, BOUGH_AUTOMATIC);
    check_near(s->master.rtol, 5e-5, 1e-12, 0);
    check_near(s->master.step, 0, 0, 0);
    check_near(s->micro.rtol, 1e-4, 1e-12, 0);
    check_near(s->micro.step, 5e-3, 1e-12, 0);
    check_near(s->macro_step, 0.01, 1e-12, 0); // at least a hundred, of which the duration is a multiple
    check_near(s->output.interval, s->macro_step, 0, 0);
    assert_int_equal(f.scene->body[0].rod.n_segment, 32);
}

TEST(everything_scales_with_the_accuracy) {
    fixture f = accepts(BAR(", accuracy: 0.02"));
    check_near(f.scene->simulation.master.rtol, 2e-4, 1e-12, 0);
    check_near(f.scene->simulation.micro.step, 10e-3, 1e-12, 0);
    assert_int_equal(f.scene->body[0].rod.n_segment, 16);
    f = accepts(BAR(", accuracy: 0.001, macro_step: 20 ms"));
    check_near(f.scene->simulation.master.rtol, 1e-5, 1e-12, 0);
    assert_int_equal(f.scene->body[0].rod.n_segment, 72);
    f = accepts(BAR(", accuracy: 5e-6"));
    check_near(f.scene->simulation.master.rtol, 5e-8, 1e-12, 0);
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_IDA); // as with that rtol named
}

// A tenth of the period of a rod's second bending, f₂ = (4.694/l)² √(EI/m)/2π, of the softer direction.
TEST(a_longest_step_follows_a_second_mode) {
    static const struct {
        const char *stiffness;
        double step;                                   // [s]; 0: the macro step
    } cases[] = {{"[1, 1, 1, 83.2, 500, 1]", 12.5e-3}, // 8 Hz
                 {"[1, 1, 1, 1e6, 1e6, 1]", 5e-3},     // as of a rod by itself
                 {"[1, 1, 1, 1, 1, 1]", 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char stiffness[64];
        snprintf(stiffness, sizeof stiffness, "bodies[b].rod.stiffness=%s", cases[k].stiffness);
        const char *const sets[] = {stiffness, "simulation.macro_step=40 ms", "simulation.master.step=3 ms"};
        write_file("s.yaml", BAR(""));
        fixture f = read_scene("s.yaml", sets, 2);
        check_near(f.scene->simulation.master.step, cases[k].step, 1e-3, 0);
        f = read_scene("s.yaml", sets, 3);
        check_near(f.scene->simulation.master.step, 3e-3, 1e-12, 0);
    }
    const char *const of_tree[] = {"bodies[b].rod.stiffness=[1, 1, 1, 1e6, 1e6, 1]",
                                   "simulation.macro_step=40 ms", "simulation.coupling.scheme=ramp",
                                   "simulation.master.solver=rosenbrock"};
    fixture f = read_scene("s.yaml", of_tree, 4);
    check_near(f.scene->simulation.master.step, 0, 0, 0);
}

#define RIGID(joint, number)                                                                                 \
    "simulation: {duration: 1 s}\nbodies:\n  - {name: a, fidelity: rigid, mass: 1, repeat: " number          \
    ", joint: {kind: " joint ", parent: ground}}\n"

// Dense matrices suit few states, and long steps loads that are not sampled.
TEST(few_rigid_bodies_are_solved_by_radau) {
    fixture f = accepts(RIGID("free", "5"));
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_RADAU5);
    f = accepts(RIGID("free", "6"));
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_AUTOMATIC);
    f = accepts(RIGID("revolute, axis: y", "1"));
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_RADAU5);
    const char *const rigid[] = {"bodies[blade1].fidelity=rigid"};
    f = read_scene(SCENES "example-turbine.yaml", rigid, 1);
    assert_false(bough_scene_suits_radau(f.scene));
}

// A key that is named holds; those beside it still follow.
TEST(keys_replace_one_by_one) {
    fixture f = accepts(BAR(", master: {rtol: 1e-3}"));
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_AUTOMATIC);
    check_near(f.scene->simulation.master.rtol, 1e-3, 1e-12, 0);
    check_near(f.scene->simulation.micro.rtol, 1e-4, 1e-12, 0);
    f = accepts(BAR(", master: {solver: radau5}"));
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_RADAU5);
    check_near(f.scene->simulation.master.rtol, 5e-5, 1e-12, 0);
    f = accepts(BAR(", coupling: {scheme: monolithic}"));
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_AUTOMATIC);
    f = accepts(BAR(", coupling: {scheme: ramp}, micro: {solver: rosenbrock}"));
    assert_int_equal(f.scene->simulation.master.solver, BOUGH_IDA);
    check_near(f.scene->simulation.master.rtol, 1e-6, 1e-12, 0);
    check_near(f.scene->simulation.micro.rtol, 1e-4, 1e-12, 0);
    check_near(f.scene->simulation.micro.step, 5e-3, 1e-12, 0);
    f = accepts(BAR(", macro_step: 40 ms"));
    check_near(f.scene->simulation.macro_step, 0.04, 1e-12, 0);
    f = accepts(BAR(", output: {interval: 15 ms}"));
    check_near(f.scene->simulation.macro_step, 0.005, 1e-12, 0); // 15 ms and 1.2 s are multiples
}

// Settings that follow lead one to expect the accuracy; those that are named, what their orders say.
TEST(settings_let_errors_be_expected) {
    fixture f = accepts(BAR(""));
    bough_scene_expectation e = bough_scene_expect_errors(f.scene);
    for (int k = 0; k < 3; k++) {
        check_near(e.error[k], k == 1 ? 0 : 1, 1e-12, 0); // no air
        assert_false(e.named[k]);
    }
    f = accepts(BAR(", master: {rtol: 2e-4}"));
    e = bough_scene_expect_errors(f.scene);
    check_near(e.error[2], 4, 1e-12, 0);
    assert_true(e.named[2] && !e.named[0]);
    f.scene->body[0].rod.n_segment = 8;
    check_near(bough_scene_expect_errors(f.scene).error[0], 16, 1e-12, 0);
    f.scene->body[0].fidelity = BOUGH_SCENE_RIGID;
    check_near(bough_scene_expect_errors(f.scene).error[0], 0, 0, 0);
}

// A modal body has a segment for each piece at least.
TEST(pieces_have_segments) {
    fixture f = accepts("simulation: {duration: 1.2 s}\nbodies:\n"
                        "  - {name: b, fidelity: segmented-modal, joint: {kind: fixed, parent: ground},\n"
                        "     modal: {modes: 2, pieces: 40}, rod: {length: 2,\n"
                        "     stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}}\n");
    assert_int_equal(f.scene->body[0].rod.n_segment, 40);
}

TEST(durations_without_a_round_step_are_divided) {
    fixture f = accepts("simulation: {duration: 0.777777777}\nbodies:\n" BODY("a", "ground"));
    double count = 0.777777777 / f.scene->simulation.macro_step;
    check_near(count, 100, 1e-9, 0);
    // not into 7777 steps of 0.1 ms
    f = accepts("simulation: {duration: 0.7777}\nbodies:\n" BODY("a", "ground"));
    check_near(0.7777 / f.scene->simulation.macro_step, 100, 1e-9, 0);
    f = accepts("simulation: {duration: 10.0003, output: {interval: 0.5}}\nbodies:\n" BODY("a", "ground"));
    check_near(f.scene->simulation.macro_step, 1e-4, 1e-12, 0);
}

#define TURBINE(keys)                                                                                        \
    "simulation: {duration: 12 s" keys "}\nbodies:\n"                                                        \
    "  - {name: hub, mass: 1, fidelity: rigid, joint: {kind: revolute, parent: ground, axis: x}}\n"          \
    "  - {name: b, fidelity: rod, joint: {kind: fixed, parent: hub}, rod: {length: 60,\n"                    \
    "      stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}}\n"                                      \
    "turbine: {rotor: hub, blades: [b]}\n"                                                                   \
    "aero: {wind: {speed: 8}, blade: aero.yaml, polars: polars.yaml, hub_radius: 3}\n"

// Samples of the air lie 1.26 degrees of a tip at 80 m/s apart, in whole macro steps.
TEST(the_rate_of_the_air_follows_the_radius) {
    static const struct {
        const char *text;
        double macro_step, rate;
    } cases[] = {
        {TURBINE(""), 12.5e-3, 80},
        {TURBINE(", macro_step: 4 ms"), 4e-3, 1 / 0.016},
        {TURBINE(", macro_step: 50 ms"), 50e-3, 20}, // no finer than the step
        {TURBINE(", accuracy: 0.001"), 10e-3, 100},
        {TURBINE(", accuracy: 0.001, macro_step: 2 ms"), 2e-3, 1 / 0.01},
        {TURBINE(", accuracy: 0.04"), 25e-3, 40},
    };
    write_file("aero.yaml", "stations:\n- {span: 0, chord: 1, polar: p}\n- {span: 60, chord: 1, polar: p}\n");
    write_file("polars.yaml", "polars:\n- name: p\n  table: {columns: [alpha deg, cl, cd, cm],\n"
                              "    rows: [[-180, 0, 0, 0], [180, 0, 0, 0]]}\n");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        fixture f = accepts(cases[k].text);
        check_near(f.scene->simulation.macro_step, cases[k].macro_step, 1e-12, 0);
        check_near(f.scene->aero.rate, cases[k].rate, 1e-9, 0);
    }
}

// -- errors ---------------------------------------------------------------------------------------

enum { MOST_CHANNELS = 160, MOST_ROWS = 301, MOST_SETS = 16 };

typedef struct recorded {
    int n_channel, n_row;
    double row[MOST_ROWS][MOST_CHANNELS];
} recorded;

static void record(const char *path, const char *const *sets, const char *last, recorded *r) {
    const char *all[MOST_SETS] = {"simulation.error_estimate=none"};
    int n = 1;
    for (; *sets; sets++) all[n++] = *sets;
    all[n] = last;
    check_run(arena, run, path, all);
    r->n_channel = run.channels.count;
    assert_true(r->n_channel <= MOST_CHANNELS);
    bough_run_start(&run);
    for (r->n_row = 0; !bough_run_done(&run); r->n_row++) {
        assert_true(r->n_row < MOST_ROWS);
        check_ok(bough_run_step(&run));
        memcpy(r->row[r->n_row], bough_run_values(&run), (size_t)r->n_channel * sizeof(double));
    }
}

// The largest error of a channel over the range of all that is as large as a thousandth of the largest range.
static double error_of(const recorded *r, const recorded *truth) {
    assert_int_equal(r->n_row, truth->n_row);
    double worst = 0;
    for (int i = 0; i < r->n_channel; i++) {
        double low = truth->row[0][i], high = low, error = 0, size = 0;
        for (int k = 0; k < r->n_row; k++) {
            double value = truth->row[k][i];
            low = fmin(low, value);
            high = fmax(high, value);
            size = fmax(size, fabs(value));
            error = fmax(error, fabs(r->row[k][i] - value));
        }
        if (high - low > 1e-3 * fmax(size, 1)) worst = fmax(worst, error / (high - low));
    }
    return worst;
}

static const double enough = 1e-4; // the steps of Radau IIA, which linkages have, err by less at any accuracy

#define NO_SOLVERS "simulation.coupling={}", "simulation.master={}", "simulation.micro={}"

// Of a bar, a four-bar before its first pass, and a turbine.
TEST(errors_follow_the_accuracy) {
    static const struct {
        const char *path, *set[7];
    } runs[] = {
        {"apps/beams/rubber-bar.yaml",
         {NO_SOLVERS, "simulation.macro_step=10 ms", "simulation.output.interval=10 ms"}},
        {"apps/mechanisms/four-bar.yaml",
         {"simulation.master={}", "simulation.duration=0.8 s", "simulation.macro_step=40 ms"}},
        {"apps/turbine/runup.yaml",
         {NO_SOLVERS, "simulation.duration=4 s", "bodies[3-5].rod.segments=6", "aero.ramp=[0 s, 1 s]"}},
    };
    static const char *const accuracies[] = {"simulation.accuracy=0.02", "simulation.accuracy=0.005",
                                             "simulation.accuracy=0.001"};
    static const double bound[] = {0.02, 0.005, 0.001};
    static recorded run, truth;
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        double error[3];
        record(runs[i].path, runs[i].set, "simulation.master={solver: ida, rtol: 1e-9}", &truth);
        for (int k = 0; k < 3; k++) {
            record(runs[i].path, runs[i].set, accuracies[k], &run);
            error[k] = error_of(&run, &truth);
            print_message("%s, %s: %.2g\n", runs[i].path, accuracies[k], error[k]);
            assert_true(error[k] < 2 * bound[k]);
            assert_true(k == 0 || error[k] < fmax(0.7 * error[k - 1], enough));
        }
    }
}

// Without the limit of the longest step, run and companion lose the second mode.
TEST(errors_of_small_vibrations) {
    static const char beam[] = "tests/data/scenes/small-vibration.yaml";
    static recorded run, truth;
    record(beam, no_sets, "simulation.master={solver: ida, rtol: 1e-9}", &truth);
    record(beam, no_sets, "simulation.accuracy=0.005", &run);
    double error = error_of(&run, &truth);
    record(beam, no_sets, "simulation.master.step=20 ms", &run);
    print_message("%.2g, with the macro step %.2g\n", error, error_of(&run, &truth));
    assert_true(error < 0.005);
    assert_true(error_of(&run, &truth) > 2 * error);
}

GROUP(enter, leave)

// A rod that carries a weight around: its tangents change within few steps, and are renewed before steps
// fail.
TEST(tangents_of_what_turns_are_renewed_in_time) {
    check_run(arena, r, "apps/templates/mechanism/scene.yaml",
              sets_of("simulation.duration=3 s", "simulation.error_estimate=none"));
    while (!bough_run_done(&r)) check_ok(bough_run_step(&r));
    bough_statistics sum = bough_run_statistics(&r, r.simulation->master->assembly->n_member);
    print_message("%ld steps, %ld failed\n", (long)sum.steps, (long)sum.failed_steps);
    assert_true(sum.steps < 2500 && 4 * sum.failed_steps < sum.steps);
}

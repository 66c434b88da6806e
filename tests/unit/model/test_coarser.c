// The scene of a companion: what is coarser in it, and which part of the difference is the error.
#include "apps/bough/model/companion.h"
#include "tests/unit/built_scene.h"

static const char runup[] = "apps/turbine/runup.yaml", stages[] = "apps/turbine/runup-stages.yaml",
                  spin_up[] = "apps/beams/spin-up.yaml";

#define MONOLITHIC "simulation.coupling={scheme: monolithic}"
#define SEGMENTS(n) "bodies[3-5].rod.segments=" #n

// A scene with two settings (NULL: none) and the one beside it.
typedef struct coarser {
    bough_scene *scene;
    const bough_scene *other;
} coarser;

static coarser coarser_of(bough_arena *arena, const char *path, const char *first, const char *second) {
    const char *const sets[] = {first, first ? second : NULL, NULL};
    bough_scene *scene = scene_read(arena, path, sets);
    return (coarser){scene, bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL)};
}

// Where rotation pulls a rod so that it bends within less than a segment.
TEST(few_segments_of_a_rope_get_more) {
    static const char slack[] = "bodies[arm].rod.stiffness=[2.8e7, 2.8e7, 2.8e7, 2e3, 2e3, 2e3]";
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        const char *number = k == 1 ? "bodies[arm].rod.segments=24" : "bodies[arm].rod.segments=12";
        coarser c = coarser_of(arena, spin_up, number, k == 2 ? NULL : slack);
        assert_int_equal(c.other->body[0].rod.n_segment, k == 0 ? 24 : k == 1 ? 16 : 8);
    }
}

// A free body that turns pulls what it carries.
TEST(a_rod_that_turns_freely_is_a_rope) {
    static const char slack[] = "bodies[bar].rod.stiffness=[250, 250, 500, 0.5, 0.5, 0.4]";
    check_arena(arena);
    for (int k = 0; k < 2; k++) {
        coarser c = coarser_of(arena, "tests/data/scenes/free-rod.yaml", "bodies[bar].rod.segments=12",
                               k ? slack : NULL);
        assert_int_equal(c.other->body[0].rod.n_segment, k ? 24 : 6);
    }
}

// The errors of a rod of 5 segments can hide those of one of 15.
TEST(beside_a_finer_rod_few_segments_get_more) {
    static const int cases[][4] = {{5, 15, 10, 30}, {5, 16, 10, 8}, {9, 15, 5, 8}};
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        char text[900];
        snprintf(text, sizeof text,
                 "simulation: {duration: 1 s, macro_step: 10 ms}\nbodies:\n"
                 "  - {name: a, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: {length: 1,\n"
                 "     segments: %d, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}}\n"
                 "  - {name: b, fidelity: rod, joint: {kind: fixed, parent: a}, rod: {length: 1,\n"
                 "     segments: %d, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}}\n",
                 cases[k][0], cases[k][1]);
        const bough_scene *scene = scene_build_text(arena, text)->scene;
        const bough_scene *other = bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL);
        for (int i = 0; i < 2; i++) assert_int_equal(other->body[i].rod.n_segment, cases[k][2 + i]);
    }
}

// What is equal has been discretised before.
TEST(another_run_takes_the_meshes_that_are_equal) {
    check_arena(arena);
    const bough_simulation *run = scene_build(arena, runup, no_sets);
    bough_other_run finer, coarse;
    check_ok(bough_other_run_build(arena, run, BOUGH_FINEST_TIME, &finer));
    check_ok(bough_other_run_build(arena, run, BOUGH_COARSER_ALL, &coarse));
    for (int k = 0; k < run->n_beam; k++) {
        assert_ptr_equal(finer.simulation->beam[k].def.position, run->beam[k].def.position);
        assert_ptr_not_equal(finer.simulation->beam[k].mesh, run->beam[k].mesh);
        assert_int_equal(coarse.simulation->beam[k].def.n_segment, 12);
    }
}

TEST(a_scene_is_coarser_in_everything) {
    check_arena(arena);
    coarser x = coarser_of(arena, stages, NULL, NULL);
    const bough_scene *c = x.other;
    check_near(c->simulation.macro_step, 40e-3, 1e-15, 0);
    check_near(c->simulation.master.step, 20e-3, 1e-15, 0);
    check_near(c->simulation.master.rtol, 3e-3, 1e-15, 0);
    check_near(c->aero.rate, 25, 1e-15, 0);
    for (int i = 0; i < c->n_body; i++) {
        if (x.scene->body[i].rod.node) assert_int_equal(c->body[i].rod.n_segment, 12);
    }
    assert_true(c->simulation.halves);
    // of the time alone: the air's samples do not let the macro step be longer
    c = bough_coarser_scene(arena, x.scene, BOUGH_COARSER_TIME);
    check_near(c->simulation.macro_step, 20e-3, 1e-15, 0);
    assert_false(c->simulation.halves);
    check_near(c->aero.rate, 50, 1e-15, 0);
    for (int i = 0; i < c->n_body; i++)
        assert_int_equal(c->body[i].rod.n_segment, x.scene->body[i].rod.n_segment);
    // what follows vibrations is by the Rosenbrock method, whatever the run is by
    x = coarser_of(arena, "tests/data/scenes/prop.yaml", NULL, NULL);
    c = bough_coarser_scene(arena, x.scene, BOUGH_FINEST_TIME);
    assert_int_equal(c->simulation.master.solver, BOUGH_ROSENBROCK);
}

// Rods of few segments get more, all blades as many, and the part of the difference follows; it is the whole
// one where a coupling is explicit. A jump within a macro step makes a coupling one of first order, too. The
// delay of loads that are held between samples is of first order; vibrations that no air damps err at a lower
// one.
TEST(the_error_is_a_part_of_the_difference) {
    static const struct {
        const char *path, *set[2];
        int segments; // of the other's blades; 0: not looked at
        double ratio;
    } cases[] = {
        {runup, {SEGMENTS(20), MONOLITHIC}, 10, 1 / 3.0},
        {runup, {SEGMENTS(16), MONOLITHIC}, 10, 0.75 / (2.56 - 1)},
        {runup, {SEGMENTS(9), MONOLITHIC}, 5, 0.75 / (81.0 / 25 - 1)},
        {runup, {SEGMENTS(8), "simulation.coupling={scheme: ramp}"}, 16, 1},
        {runup, {SEGMENTS(1), "simulation.coupling={scheme: ramp}"}, 8, 1},
        {runup, {"bodies[3-5].fidelity=modal", MONOLITHIC}, 48, 1},
        {runup, {"bodies[3-5].fidelity=segmented-modal", "bodies[3-5].modal={pieces: 5}"}, 50, 1},
        {runup, {SEGMENTS(16), "simulation.coupling={scheme: ramp}"}, 10, 0.5},
        {runup, {SEGMENTS(16), "simulation.coupling={scheme: iterated}"}, 11, 1},
        {runup, {SEGMENTS(30), "simulation.coupling={scheme: frozen}"}, 21, 1},
        {runup, {"loads=[{joint: hub, torque: 1 MN m, ramp: [1 s, 1.01 s]}]"}, 0, 1},
        {runup, {"loads=[{joint: hub, torque: 1 MN m, ramp: [1 s, 2 s]}]"}, 0, 0.5},
        {runup,
         {"loads=[{joint: hub, torque: {times: [0, 5 s, 5.01 s], values: [0, 1 MN m, 2 MN m]}}]"},
         0,
         1},
        {runup, {"loads=[{joint: hub, torque: 1 MN m}]"}, 0, 0.5},
        {runup, {"aero.hold=constant", MONOLITHIC}, 0, 1},
        {spin_up, {"simulation.micro=null", MONOLITHIC}, 0, 0.4},
    };
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        coarser x = coarser_of(arena, cases[k].path, cases[k].set[0], cases[k].set[1]);
        for (int i = 3; i <= 5 && cases[k].segments > 0; i++)
            assert_int_equal(x.other->body[i].rod.n_segment, cases[k].segments);
        double ratio = bough_coarser_ratio(x.scene, x.other), air = bough_coarser_air_ratio(x.scene, x.other);
        check_near(fmax(ratio, air), cases[k].ratio, 1e-12, 0);
    }
}

#define PULSE(fall, end, value)                                                                              \
    "loads=[{body: arm, at: tip, force: [0, 0, 1], factor: {times: [0, 10 us, " fall ", " end                \
    "], values: [0, 1, 1, " value "]}}]"

// A wave takes 0.1 ms through a segment, a bending wave of eight segments 11.8 ms through half its period.
TEST(short_pulses_have_a_finer_companion) {
    static const char *const loads[] = {PULSE("40 us", "50 us", "0"), PULSE("11.5 ms", "11.6 ms", "0"),
                                        PULSE("12 ms", "12.1 ms", "0"), PULSE("40 us", "50 us", "2")};
    static const int segments[] = {40, 40, 14, 14};
    check_arena(arena);
    for (int k = 0; k < 4; k++) {
        coarser x = coarser_of(arena, spin_up, loads[k], NULL);
        assert_int_equal(x.other->body[0].rod.n_segment, segments[k]);
    }
}

// With a finer mesh the air is finer too, in shorter macro steps if need be: errors of one sign would cancel
// in the difference.
TEST(beside_a_finer_mesh_the_air_is_finer) {
    static const struct {
        const char *segments, *macro_step;
        double rate; // of 50 Hz
    } cases[] = {{SEGMENTS(24), "simulation.macro_step=20 ms", 25},
                 {SEGMENTS(4), "simulation.macro_step=20 ms", 100},
                 {SEGMENTS(4), "simulation.macro_step=10 ms", 100}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        coarser x = coarser_of(arena, stages, cases[k].segments, cases[k].macro_step);
        check_near(x.other->aero.rate, cases[k].rate, 0, 1e-12);
    }
}

// The whole difference counts beside a finer mesh and an explicit coupling: that of the steps is to be small.
TEST(steps_are_little_longer_where_the_whole_difference_counts) {
    static const struct {
        const char *segments, *coupling;
        double step, rtol, ratio;
    } cases[] = {{SEGMENTS(8), MONOLITHIC, 20e-3, 2e-3, 1 / 3.0}, // of 3.6e-3, too loose for a finer mesh
                 {SEGMENTS(8), "simulation.coupling={scheme: frozen}", 15e-3, 3e-4, 1}, // likewise
                 {SEGMENTS(16), "simulation.coupling={scheme: frozen}", 15e-3, 9e-4, 1}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *const sets[] = {cases[k].segments, cases[k].coupling,
                                    "simulation.master={solver: rosenbrock, step: 10 ms, rtol: 3e-4}",
                                    "simulation.micro={solver: rosenbrock, step: 10 ms, rtol: 3e-4}", NULL};
        bough_scene *scene = scene_read(arena, stages, sets);
        const bough_scene *c = bough_coarser_scene(arena, scene, BOUGH_COARSER_ALL);
        check_near(c->simulation.master.step, cases[k].step, 1e-15, 0);
        check_near(c->simulation.master.rtol, cases[k].rtol, 1e-15, 0);
        check_near(bough_coarser_time_ratio(scene), cases[k].ratio, 1e-15, 0);
    }
}

// Integrators of a tight tolerance have a high order, and beside a finer mesh its error is small.
TEST(a_tight_tolerance_becomes_much_larger) {
    static const char pendulum[] = "apps/mechanisms/pendulum.yaml",
                      rod[] = "tests/data/scenes/tip-weight.yaml";
    static const struct {
        const char *path, *set;
        double rtol, step, macro_step, ratio;
        int solver;
    } cases[] = {{pendulum, "simulation.master.solver=ida", 3e-9, 20e-3, 40e-3, 0.3, BOUGH_RADAU5},
                 {pendulum, "simulation.master={solver: ida, rtol: 1e-6}", 1e-5, 0, 20e-3, 0.4, BOUGH_IDA},
                 {rod, "simulation.master.rtol=1e-9", 1e-7, 0, 20e-3, 1, BOUGH_IDA},
                 {rod, "simulation.master.rtol=4e-8", 1e-6, 0, 20e-3, 1, BOUGH_IDA},
                 {rod, "simulation.master.rtol=2e-7", 2.4e-6, 0, 20e-3, 1, BOUGH_IDA}};
    check_arena(arena);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        coarser x = coarser_of(arena, cases[k].path, cases[k].set, NULL);
        assert_int_equal(x.other->simulation.master.solver, cases[k].solver);
        check_near(x.other->simulation.master.rtol, cases[k].rtol, 0, 1e-12);
        check_near(x.other->simulation.master.step, cases[k].step, 0, 1e-12);
        check_near(x.other->simulation.macro_step, cases[k].macro_step, 0, 1e-12);
        check_near(bough_coarser_ratio(x.scene, x.other), cases[k].ratio, 0, 1e-12);
    }
}

// Dense matrices limit Radau IIA to 400 states, which a finer mesh may pass.
TEST(a_finer_mesh_may_be_too_large_for_radau) {
    static const char bar[] = "tests/data/scenes/struck-bar.yaml";
    static const int segments[] = {12, 24}, solver[] = {BOUGH_RADAU5, BOUGH_AUTOMATIC};
    check_arena(arena);
    for (int k = 0; k < 2; k++) {
        char set[40];
        snprintf(set, sizeof set, "bodies[bar].rod.segments=%d", segments[k]);
        coarser x = coarser_of(arena, bar, "simulation.master.solver=radau5", set);
        assert_int_equal(x.other->simulation.master.solver, solver[k]);
    }
}

// Another scheme than one system leaves the companion no error of a coupling, but the sub-solvers' steps,
// twice as long.
TEST(a_coupling_has_a_monolithic_companion) {
    check_arena(arena);
    coarser x = coarser_of(arena, runup, NULL, NULL);
    const bough_scene *c = x.other;
    assert_string_equal(bough_scheme_name(c->simulation.coupling.scheme), "monolithic");
    assert_int_equal(c->simulation.master.solver, BOUGH_AUTOMATIC);
    check_near(c->simulation.master.step, 20e-3, 1e-15, 0);
    check_near(c->simulation.master.rtol, 4e-3, 1e-15, 0);
    check_near(bough_coarser_ratio(x.scene, c), 0.5, 1e-12, 0);
    // it begins as rods by BDF do, but not between samples of the air
    assert_false(c->simulation.master.by_bdf);
    assert_true(coarser_of(arena, "apps/beams/buckling.yaml", NULL, NULL).other->simulation.master.by_bdf);
    // fixed steps have an error that the companion's, by tolerance, do not share
    x = coarser_of(arena, runup, "simulation.micro={solver: generalized-alpha, step: 10 ms}", NULL);
    check_near(bough_coarser_ratio(x.scene, x.other), 1, 1e-12, 0);
    // a weight other than 1/2 makes the coupling's error one of first order: the whole difference
    x = coarser_of(arena, runup, NULL, NULL);
    x.scene->simulation.coupling.options.theta = 0.5;
    check_near(bough_coarser_ratio(x.scene, x.other), 0.5, 1e-12, 0);
    x.scene->simulation.coupling.options.theta = 0.89;
    check_near(bough_coarser_ratio(x.scene, x.other), 1, 1e-12, 0);
}

// The companion of a run in air: what it states beside solutions whose air is sampled more often.
#include "tests/unit/beside.h"

static const char operation[] = "apps/turbine/land-operation.yaml";

// Six segments under air at half the rate lose the solution. With either as in the run they keep it, and
// these two solutions give the error.
TEST(a_companion_that_loses_the_solution_is_replaced) {
    const char *const sets[] = {"simulation.duration=20 s", "simulation.output.from=8 s",
                                "simulation.error_estimate=companion", "bodies[3-5].rod.segments=12", NULL};
    check_ended_run(arena, r, operation, sets);
    int twist = bough_channels_find(&r.channels, "TwstDefl1");
    assert_true(bough_error_relative(r.companion, twist, r.companion->error[twist]) > 0.5);
    find_shares(arena, &r);
    double relative = bough_error_relative(r.companion, twist, r.companion->error[twist]);
    print_message("TwstDefl1: %.2g of its range\n", relative);
    assert_true(relative > 2e-3 && relative < 0.15);
}

#define COARSE_BLADES                                                                                        \
    "simulation.duration=6 s", "simulation.output.interval=0.02", "simulation.output.from=0",                \
        "bodies[3-5].rod.segments=12", "bodies[tower].rod.segments=3",                                       \
        "aero.wind={kind: iec, condition: ews, speed: 20, start: 0.5, shear: horizontal, reference_height: 90}"

// Six segments of a blade under air at 25 Hz vibrate in torsion, twelve at 50 Hz do not. Finer samples show
// that the run does not err by its own, so that the mesh is left as the cause, which ends no run.
TEST(finer_samples_prove_an_error_of_the_air) {
    const char *const truth_sets[] = {COARSE_BLADES, "simulation.macro_step=5 ms", "aero.rate=200", NULL};
    const char *const *sets =
        sets_of(COARSE_BLADES, "simulation.macro_step=20 ms",
                "simulation.master={solver: rosenbrock, step: 10 ms, rtol: 3e-4}",
                "simulation.error_estimate=companion", "simulation.error_shares=true", "aero.rate=50");
    static const char *const channel[] = {"TwstDefl3", NULL};
    check_arena(arena);
    char warning[BOUGH_ERROR_WARNING];
    beside *b = run_beside(arena, operation, sets, truth_sets, 0, channel);
    bough_run *r = &b->r;
    bough_error_shares shares = find_shares(arena, r);
    double air = shares.share[BOUGH_SHARE_AIR].largest[bough_channels_find(&r->channels, channel[0])];
    print_message("TwstDefl3: by the air %.2g deg, estimate %.2g\n", b->error[0], air);
    assert_true(air > b->error[0] / 3 && air < 3 * b->error[0]);
    check_ok(bough_error_judge(arena, r->companion, NULL, 0.05, &shares, warning));
    assert_non_null(strstr(warning, "cause: the mesh"));
}

// Modal blades vibrate under air at half the rate, whatever the mesh is beside it; finer samples show what is
// left of their error, and with it of the other parts.
TEST(a_proof_bounds_the_other_parts) {
    check_ended_run(arena, r, "apps/turbine/land.yaml",
                    sets_of("simulation.duration=12 s", "bodies[blade1].fidelity=modal",
                            "bodies[blade2].fidelity=modal", "bodies[blade3].fidelity=modal"));
    bough_error_shares shares = find_shares(arena, &r);
    int twist = bough_channels_find(&r.channels, "TwstDefl1");
    double sum = 0, whole = r.companion->error[twist];
    for (int k = 0; k < BOUGH_SHARES; k++) sum += shares.share[k].largest[twist];
    print_message("TwstDefl1: whole %.3g deg, sum of the parts %.3g\n", whole, sum);
    assert_true(sum > 0.5 * whole && sum < 1.5 * whole);
}

#define OPERATION "simulation.output.from=0", "simulation.duration=3.2 s"
#define FOUR_TIMES "simulation.macro_step=10 ms", "aero.rate=100"
#define OVERSPEED "bodies[hub].joint.speed=16 rpm", "aero.wind={kind: uniform, speed: 12}"

// Blades in deep negative stall vibrate about as fast as the samples of the air follow each other, so that
// half of these err no more.
TEST(samples_that_resolve_no_vibration_err_by_the_whole_difference) {
    const char *const truth_sets[] = {OPERATION, OVERSPEED, FOUR_TIMES, NULL};
    const char *const sets[] = {OPERATION, OVERSPEED, "simulation.error_estimate=companion", NULL};
    static const char *const channel[] = {"GenSpeed", "RtAeroPwr", "RtAeroMxh", "RotPwr", "blade2Trq", NULL};
    check_arena(arena);
    check_estimates(run_beside(arena, operation, sets, truth_sets, 80, channel), 1 / 3., 4);
}

// In the first samples the speed of the blades' vibrations is not resolved, whenever the controller is
// sampled.
TEST(samples_of_the_start_have_an_error) {
    static const char *const control[] = {"control.rate=25", "control.rate=1"};
    static const char *const channel[] = {"RtVAvgxh", "RtVAvgyh", "RtVAvgzh", "RtTSR", NULL};
    check_arena(arena);
    for (int k = 0; k < 2; k++) {
        const char *const truth_sets[] = {OPERATION, FOUR_TIMES, control[k], NULL};
        const char *const sets[] = {OPERATION, "simulation.error_estimate=companion", control[k], NULL};
        check_estimates(run_beside(arena, operation, sets, truth_sets, 10, channel), 0.8, 3);
    }
}

#define SLOW_PITCH                                                                                           \
    "simulation.duration=14 s", "simulation.output.interval=0.02", "simulation.output.from=0",               \
        "bodies[tower].rod.segments=10",                                                                     \
        "aero.wind={kind: uniform, table: {times: [0, 5, 6, 10], speeds: [11, 11, 20, 20]}}",                \
        "control={kind: variable-speed, rate: 25 Hz, gear_ratio: 97, law: {pitch_rate: 1 deg/s},"            \
        " events: [{kind: emergency-stop, channel: GenSpeed, above: 1300}]}"

// Ten segments of a blade under air at 25 Hz flutter in an overspeed, sixteen at 50 Hz do not. Solutions that
// have either as in the run say what it errs by.
TEST(a_companion_whose_blades_flutter_is_replaced) {
    static const char solver[] = "simulation.master={solver: rosenbrock, step: 10 ms, rtol: 3e-4}";
    static const char *const watched[] = {"RootMyb2", "RootMxb1", NULL};
    const char *const truth_sets[] = {
        SLOW_PITCH,      solver, "bodies[3-5].rod.segments=32", "simulation.macro_step=10 ms",
        "aero.rate=100", NULL};
    const char *const *sets =
        sets_of(SLOW_PITCH, solver, "bodies[3-5].rod.segments=16", "simulation.macro_step=20 ms",
                "simulation.error_estimate=companion", "simulation.error_bound=0.002", "aero.rate=50");
    check_arena(arena);
    beside *b = run_beside(arena, operation, sets, truth_sets, 0, watched);
    bough_run *r = &b->r;
    assert_true(r->companion->flutters);
    find_shares(arena, r);
    for (int w = 0; w < 2; w++) {
        double before = b->estimate[w];
        b->estimate[w] = r->companion->error[bough_channels_find(&r->channels, watched[w])];
        print_message("%s: replaced %.2g\n", watched[w], b->estimate[w]);
        assert_true(b->estimate[w] < 0.5 * before);
    }
    check_estimates(b, 0.8, 10);
}

#define TABLE(times, speeds) "aero.wind={kind: uniform, table: {times: " times ", speeds: " speeds "}}"

// What a sampled channel errs by is what happens while the run holds it: nothing where it is sampled at every
// macro step, though the companion holds it at the end of an odd number of them. A gust that comes and stays
// between two samples of the run, and between the companion's, is seen by neither.
TEST(a_held_sample_errs_by_its_age) {
    static const char rising[] = TABLE("[0, 1.02]", "[6, 12]");
    static const struct {
        const char *macro_step, *wind;
        double change, tolerance; // since the oldest sample that the run shows [m/s]
    } cases[] = {{"simulation.macro_step=20 ms", rising, 0, 0.025}, // with the error of the start
                 {"simulation.macro_step=10 ms", rising, 6 / 1.02 * 10e-3, 0.025},
                 {"simulation.macro_step=5 ms", rising, 6 / 1.02 * 15e-3, 0.025},
                 {"simulation.macro_step=5 ms", TABLE("[0, 0.5, 0.505]", "[12, 12, 6]"), 6, 1.8}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        outcome *o = run_for("apps/turbine/runup-stages.yaml", 51,
                             sets_of("simulation.duration=1.02 s", cases[k].macro_step, cases[k].wind));
        double error = o->error[find(o, "RtVAvgxh")];
        check_near(error, cases[k].change, 0, cases[k].tolerance);
        free(o);
    }
}

// Normal to a turning shaft, in the hub's axes, a held wind changes with the angle, which is no error: that
// is the change of its part normal to the shaft, by the tilt of 5 deg.
TEST(a_held_vector_errs_by_less_than_its_components_turn) {
    outcome *o = run_for("apps/turbine/runup-stages.yaml", 51,
                         sets_of("simulation.duration=1.02 s", "simulation.output.from=0.8 s",
                                 "simulation.macro_step=5 ms", "bodies[hub].joint.speed=30 rpm",
                                 "bodies[3-5].fidelity=rigid", TABLE("[0, 1.02]", "[6, 12]")));
    double error = o->error[find(o, "RtVAvgzh")], change = 6 / 1.02 * 15e-3 * sin(5 * BOUGH_DEGREE);
    check_near(error, change, 0, 1e-3);
    free(o);
}

// Where the wind nearly ceases the rotor's flow may pass zero within its error, and the tip-speed ratio is
// not known.
TEST(a_quotient_by_what_may_vanish_is_not_known) {
    const char *const *sets =
        sets_of("simulation.duration=1.02 s", TABLE("[0, 0.5, 0.505]", "[12, 12, 0.2]"));
    outcome *o = run_for("apps/turbine/runup-stages.yaml", 51, sets);
    assert_true(isnan(o->error[find(o, "RtTSR")]) && isfinite(o->error[find(o, "RtVAvgxh")]));
    free(o);
}

// A jump beside a sample is half a sample late, as it is in the companion's longer one, or nearly one sample
// where loads are held: in both solutions from the same sample on if it were not delayed in the companion.
TEST(a_jump_of_the_air_has_an_error) {
    static const struct {
        const char *jump, *hold;
    } cases[] = {{TABLE("[0, 0.62, 0.621]", "[6, 6, 20]"), "aero.hold=linear"},
                 {TABLE("[0, 0.622, 0.623]", "[6, 6, 14]"), "aero.hold=constant"},
                 {"aero.ramp=[0.6195 s, 0.6195 s]", "aero.hold=linear"},
                 {"aero.ramp=[0.622 s, 0.622 s]", "aero.hold=constant"}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        const char *const sets[] = {"simulation.duration=1.02 s", cases[n].jump, cases[n].hold, NULL};
        const char *const *truth_sets = sets_of(sets[0], sets[1], "simulation.macro_step=2.5 ms",
                                                "aero.rate=400 Hz", "simulation.error_estimate=none");
        static const char *const channel[] = {"TwstDefl1", "OoPDefl1", "RotSpeed", NULL};
        check_arena(arena);
        check_estimates(run_beside(arena, "apps/turbine/runup-stages.yaml", sets, truth_sets, 51, channel),
                        0.4, 4);
    }
}

// The vector of the wind over a rotor in axes that turn with it changes without a new sample, which is no
// error.
TEST(turning_axes_are_no_age) {
    const char *const sets[] = {"simulation.duration=1.02 s", "simulation.macro_step=5 ms", "aero.tower=null",
                                NULL};
    outcome *o = run_for("apps/turbine/rotor.yaml", 51, sets);
    int i = find(o, "RtVAvgyh");
    double moves = 0;
    for (int k = 1; k < 51; k++) moves = fmax(moves, fabs(o->value[k][i] - o->value[k - 1][i]));
    print_message("error %.2g m/s, change in a step %.2g\n", o->error[i], moves);
    assert_true(o->error[i] < 0.2 * moves);
    free(o);
}

// Loads that are held between samples of every macro step leave no room for a finer air: the companion takes
// two steps in one of the run's, and half of what the run errs by remains in both. An event within one, where
// both show older samples, is no error of theirs.
TEST(beside_a_finer_mesh_held_loads_are_sampled_in_shorter_steps) {
#define HELD_LOADS                                                                                           \
    "simulation.duration=1.02 s", "aero.hold=constant",                                                      \
        "aero.wind={kind: uniform, table: {times: [0, 1.02], speeds: [6, 12]}}",                             \
        "loads=[{joint: hub, torque: 1, ramp: [0.113 s, 0.113 s]}]"
#define FINE_AIR "simulation.macro_step=2.5 ms", "aero.rate=400", "simulation.error_estimate=none"
    static const char *const sets[] = {HELD_LOADS, "bodies[3-5].rod.segments=8", NULL};
    static const char *const truth[] = {HELD_LOADS, "bodies[3-5].rod.segments=16", FINE_AIR, NULL};
    static const char *const channel[] = {"RotSpeed", "TipDxb1", "RootMyb1", NULL};
    check_arena(arena);
    beside *b = run_beside(arena, "apps/turbine/runup-stages.yaml", sets, truth, 11, channel);
    const bough_companion *c = b->r.companion;
    check_near(c->coarser.simulation->scene->aero.rate, 100, 1e-12, 0);
    check_near(c->coarser.simulation->master->time, b->r.simulation->master->time, 1e-12, 0);
    assert_int_equal(c->compared, 10);
    assert_true(c->error[bough_channels_find(&b->r.channels, "RtVAvgxh")] < 0.02);
    check_estimates(b, 0.8, 2);
}

// An error of order 1 is the whole difference to half the rate; what the mesh and the steps err by is not.
TEST(held_loads_err_by_the_whole_difference) {
    static const char *const sets[] = {HELD_LOADS, "bodies[3-5].rod.segments=24", NULL};
    static const char *const truth[] = {HELD_LOADS, "bodies[3-5].rod.segments=24", FINE_AIR, NULL};
    static const char *const channel[] = {"RotSpeed", "TipDxb1", "RootMyb1", NULL};
    check_arena(arena);
    beside *b = run_beside(arena, "apps/turbine/runup-stages.yaml", sets, truth, 11, channel);
    check_estimates(b, 0.8, 2);
    bough_error_shares shares = find_shares(arena, &b->r);
    const bough_error_share *s = shares.share;
    for (int w = 0; w < 3; w++) {
        int i = bough_channels_find(&b->r.channels, channel[w]);
        assert_true(s[BOUGH_SHARE_AIR].others[i] <
                    1.5 * (s[BOUGH_SHARE_MESH].largest[i] + s[BOUGH_SHARE_TIME].largest[i]));
    }
}

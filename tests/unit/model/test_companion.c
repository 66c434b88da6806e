// The companion of a run: what it states beside solutions that are finer in mesh and time.
#include "apps/bough/model/validity.h"
#include "tests/unit/beside.h"

static const char example[] = "tests/data/scenes/example-turbine.yaml";
// The whole error of motion, by mesh, air, steps and coupling, for two schemes.
TEST(the_whole_error_is_estimated) {
    const char *const *truth_sets = sets_of(
        "simulation.duration=2 s", "simulation.coupling={scheme: monolithic}",
        "simulation.master={solver: rosenbrock, step: 5 ms, rtol: 1e-6}", "simulation.macro_step=5 ms",
        "simulation.error_estimate=none", "bodies[3-5].rod.segments=72", "aero.rate=200");
    static const char *const coupling[] = {"simulation.coupling={scheme: ramp, theta: auto}",
                                           "simulation.coupling={scheme: monolithic}"};
    static const char *const watched[] = {"RotSpeed", "TipDxb1",  "TipDyb1",  "TwstDefl1", "RootMyb1",
                                          "RootMxb1", "RootFyb1", "RootFzb2", NULL};
    for (int c = 0; c < 2; c++) {
        const char *const sets[] = {"simulation.duration=2 s", coupling[c],
                                    "simulation.master={solver: rosenbrock, step: 10 ms, rtol: 3e-4}", NULL};
        check_arena(arena);
        beside *b = run_beside(arena, "apps/turbine/runup.yaml", sets, truth_sets, 0, watched);
        check_estimates(b, 1 / 3., 6);
        assert_true(b->estimate[7] < 2 * b->error[7]); // of the first steps
        for (int w = 6; w < 8 && c == 1; w++) assert_true(b->estimate[w] > b->error[w] / 2); // RootF
        // tangents serve at least half as many steps as the run's
        bough_statistics own = bough_master_statistics(b->r.companion->run->master);
        bough_statistics coarser = bough_master_statistics(b->r.companion->coarser.simulation->master);
        assert_true(2 * coarser.steps * own.jacobians >= own.steps * coarser.jacobians);
    }
}

// Rigid bodies without air have a share of time alone, which no other solutions replace.
TEST(rigid_bodies_that_lose_the_solution_have_its_error) {
    const char *const sets[] = {"simulation.duration=30 s",
                                "simulation.master={solver: rosenbrock, rtol: 1e-3}", NULL};
    check_ended_run(arena, r, "apps/mechanisms/double-pendulum.yaml", sets);
    int x = bough_channels_find(&r.channels, "bob1X");
    assert_true(bough_error_relative(r.companion, x, r.companion->error[x]) > 0.3);
    find_shares(arena, &r);
    assert_true(bough_error_relative(r.companion, x, r.companion->error[x]) > 0.1);
}

// A load that comes in the second half of the last macro step, of which the further runs know, too.
TEST(the_last_half_step_has_shares) {
    const char *const sets[] = {"simulation.coupling.scheme=frozen", "bodies[arm].rod.segments=10",
                                "loads[0].factor={times: [0.795, 0.7951], values: [0, 1]}", NULL};
    check_ended_run(arena, r, "tests/data/scenes/small-vibration.yaml", sets);
    int tip = bough_channels_find(&r.channels, "armTipX");
    double error = r.companion->error[tip];
    assert_true(error > 0);
    bough_error_shares shares = find_shares(arena, &r);
    check_near(r.companion->error[tip], error, 0.5, 0);
    assert_true(shares.share[BOUGH_SHARE_TIME].largest[tip] > 0.1 * error);
}

// A short run whose steps are as long as its macro step: half of them would be the companion's own steps.
TEST(steps_of_a_macro_step_have_an_error) {
    static const char scene[] = "apps/mechanisms/pendulum.yaml";
    const char *const truth_sets[] = {"simulation.macro_step=20 ms", "simulation.error_estimate=none", NULL};
    static const char *const channel[] = {"bobPos", "bobVel", NULL};
    // a torque of no weight, whose corners are as close as the steps, and twice as far apart
    char corners[2][40 * STEPS];
    for (int i = 0; i < 2; i++) {
        char *end = corners[i] + sprintf(corners[i], "loads=[{joint: bob, torque: {times: [0");
        for (int k = 1; k < STEPS; k++) end += sprintf(end, ", %.3f", 0.02 * (i + 1) * k);
        end += sprintf(end, "], values: [0");
        for (int k = 1; k < STEPS; k++) end += sprintf(end, ", %s", k % 2 ? "1e-9" : "0");
        sprintf(end, "]}}]");
    }
    // solver, load, scheme
    const char *const run[][3] = {
        {"simulation.master={solver: generalized-alpha, step: 20 ms, rtol: 1e-4}"},
        {"simulation.master={solver: rosenbrock, step: 20 ms, rtol: 3e-3}"},
        {"simulation.master={solver: generalized-alpha, step: 20 ms, rtol: 1e-4}", corners[0]},
        {"simulation.master={solver: rosenbrock, rtol: 3e-3}", corners[0]},
        {"simulation.master={solver: rosenbrock, rtol: 3e-3}", corners[1]},
        {"simulation.master={solver: rosenbrock, rtol: 3e-3}", corners[1],
         "simulation.coupling={scheme: ramp}"},
        {"simulation.master={solver: rosenbrock, rtol: 3e-3}",
         "loads=[{joint: bob, torque: 0, input: push}]"},
        {"simulation.master={solver: rosenbrock, rtol: 0.02}",
         "loads=[{joint: bob, torque: 0, input: push}]"},
        {"simulation.master={solver: rosenbrock, rtol: 0.02}", corners[0], "simulation.macro_step=80 ms"}};
    for (int k = 0; k < 9; k++) {
        const char *const sets[] = {"simulation.macro_step=20 ms", run[k][0], run[k][1], run[k][2], NULL};
        check_arena(arena);
        check_estimates(run_beside(arena, scene, sets, truth_sets, k == 8 ? STEPS / 4 : STEPS, channel), 0.5,
                        4);
    }
}

// Nine corners within a millisecond are one: the steps after them are as long as before.
TEST(a_burst_of_corners_splits_no_steps) {
    const char *const sets[] = {
        "simulation.duration=1 s", "simulation.macro_step=20 ms",
        "simulation.master={solver: rosenbrock, rtol: 3e-3}",
        "loads=[{joint: bob, torque: {times: [0.1, 0.1001, 0.1002, 0.1003, 0.1004, 0.1005, "
        "0.1006, 0.1007, 0.1008], values: [0, 1e-9, 0, 1e-9, 0, 1e-9, 0, 1e-9, 0]}}]",
        NULL};
    check_ended_run(arena, r, "apps/mechanisms/pendulum.yaml", sets);
    assert_false(r.companion->coarser.simulation->master->split);
}

// A tolerance that leaves no room for a looser one: the companion's is tighter, and its steps are shorter.
// That 7 times 0.05 s, where a load begins, is a number next to 0.35 does not end the comparison.
TEST(a_loose_tolerance_has_an_error) {
#define LONG_STEPS "simulation.duration=2 s", "simulation.macro_step=0.1", "simulation.output.interval=0.1"
    static const struct {
        const char *scene, *channel, *solver, *load;
    } run[] = {{"apps/mechanisms/four-bar.yaml", "rightVel", "{solver: cvode-bdf, rtol: 0.03}", NULL},
               {"apps/mechanisms/double-pendulum.yaml", "bob1X", "{solver: rosenbrock, rtol: 0.1}", NULL},
               {"apps/mechanisms/double-pendulum.yaml", "bob1X", "{solver: rosenbrock, rtol: 0.1}",
                "loads=[{body: upper, force: [1e-9, 0, 0], ramp: [0.35, 0.45]}]"}};
    for (int k = 0; k < 3; k++) {
        char master[80];
        snprintf(master, sizeof master, "simulation.master=%s", run[k].solver);
        const char *const sets[] = {LONG_STEPS, master, run[k].load, NULL};
        const char *const truth_sets[] = {LONG_STEPS, "simulation.master={solver: ida, rtol: 1e-9}",
                                          "simulation.error_estimate=none", run[k].load, NULL};
        check_arena(arena);
        const char *const channel[] = {run[k].channel, NULL};
        check_estimates(run_beside(arena, run[k].scene, sets, truth_sets, 0, channel), 0.5, 4);
    }
}

// A weight that is let go on a stiff rod, or pushed later, sinks by s (1 - exp(-D w t) (cos w' t + D w/w' sin
// w' t)), at 250 Hz. One whose base is moved at s w from some time on follows it with s exp(-D w t) sin w' t.
// Steps of 20 ms pass over these vibrations, and the companion's do, too.
TEST(a_vibration_that_both_lose_is_an_error) {
    const double s = 0.2 * 9.8 * 2 / 1e6, w = 1581, damping = 5e-6 * w / 2;
    enum { LET_GO, PUSHED, MOVED };
    static const struct {
        const char *gravity, *cause;
        double start; // [s]
    } way[] = {
        {"gravity=[9.8, 0, 0]", "loads=[]", 0},
        {"gravity=[0, 0, 0]", "loads=[{body: weight, force: [1.96, 0, 0], ramp: [1.007 s, 1.007 s]}]", 1.007},
        {"gravity=[0, 0, 0]",
         "bodies[0].joint={kind: prismatic, axis: z, parent: ground, placement: [rotate y 90 deg], "
         "motion: {speed: {from: 0, to: 6.197e-3, ramp: [1.007 s, 1.0072 s]}}}",
         1.0071}};
    for (int k = LET_GO; k <= MOVED; k++) {
        const char *const *sets =
            sets_of("simulation.duration=2 s", "simulation.macro_step=20 ms",
                    "simulation.master={solver: rosenbrock, rtol: 3e-4}", way[k].gravity, way[k].cause,
                    "bodies[0].rod.damping=[5e-6, 5e-6, 5e-6, 5e-6, 5e-6, 5e-6]", "bodies[1].mass=0.2");
        outcome *o = run_for("tests/data/scenes/tip-weight.yaml", STEPS, sets);
        int i = find(o, "beamTipX");
        double error = 0, of = w * sqrt(1 - damping * damping);
        for (int j = 0; j < STEPS; j++) {
            double t = fmax(0.02 * (j + 1) - way[k].start, 0), phase = of * t,
                   decay = s * exp(-damping * w * t);
            double sunk = k == MOVED ? s * w * t - decay * sin(phase)
                                     : s - decay * (cos(phase) + damping * w / of * sin(phase));
            error = fmax(error, fabs(o->value[j][i] - 2 - sunk));
        }
        print_message("error %.2g of %.2g m, estimate %.2g\n", error, s, o->error[i]);
        assert_true(error > s / 3);
        assert_true(o->error[i] > error / 2 && o->error[i] < 3 * error);
        free(o);
    }
}

// A finer solution that joins a run later stays beside it: what lies between them is what the steps err by.
TEST(a_finer_solution_joins_the_run) {
    const char *const sets[] = {
        "simulation.duration=0.6 s",
        "loads=[{joint: hub, torque: {times: [0, 0.405, 0.406], values: [0, -1e4, -3e4]}}]", NULL};
    check_run(arena, r, example, sets);
    const bough_finer *f = &r.companion->finer;
    const bough_master *m = r.simulation->master;
    int joined = 0, tip = bough_channels_find(&r.channels, "TipDxb1");
    while (!bough_run_done(&r)) {
        check_ok(bough_run_step(&r));
        if (m->time < 0.402 || !f->follows || f->other.simulation->master->time < m->time) continue;
        double range = bough_error_range(r.companion, tip);
        check_near(f->other.value[tip], bough_run_values(&r)[tip], 0, 0.02 * range);
        joined++;
    }
    assert_true(joined >= 8);
}

// The steps of run and companion damp the axial vibration of a rod that is let go. The finer solution goes on
// beside it.
TEST(an_error_that_grows_is_followed) {
    static const char *const sets[] = {"simulation.coupling={scheme: iterated}",
                                       "simulation.micro={solver: cvode-bdf, rtol: 1e-4}", NULL};
    static const char *const truth[] = {"simulation.error_estimate=none",
                                        "simulation.master={solver: rosenbrock, rtol: 1e-6, step: 1 ms}",
                                        NULL};
    static const char *const channel[] = {"rodTipZ", NULL};
    check_arena(arena);
    check_estimates(run_beside(arena, "tests/data/scenes/let-go.yaml", sets, truth, 0, channel), 0.7, 1.5);
}

// Where its work ends before, the error that grew grows on, and the run says that it may err by more.
TEST(an_error_that_grew_grows_on) {
    check_run(arena, r, "tests/data/scenes/let-go.yaml",
              sets_of("simulation.coupling={scheme: iterated}",
                      "simulation.micro={solver: cvode-bdf, rtol: 1e-4}"));
    int tip = bough_channels_find(&r.channels, "rodTipZ");
    while (r.simulation->master->time < 0.1) check_ok(bough_run_step(&r));
    double grown = r.companion->least[tip];
    r.companion->finer.work = HUGE_VAL, r.companion->shown[tip] = 0; // as if the companion lost it, too
    while (!bough_run_done(&r)) check_ok(bough_run_step(&r));
    assert_true(r.companion->error[tip] > 1.4 * grown);
    assert_true(r.simulation->validity->limit[BOUGH_LIMIT_FAST].passed);
}

// A blow excites bending waves that half as many segments do not resolve: the companion has twice as many.
TEST(beside_waves_of_a_blow_the_mesh_is_finer) {
    static const char *const truth[] = {"bodies[bar].rod.segments=40", "simulation.master.rtol=1e-6",
                                        "simulation.error_estimate=none", NULL};
    static const char *const channel[] = {"barTipX", "barSpn1TDx", "barSpn1RDy", NULL};
    check_arena(arena);
    beside *b = run_beside(arena, "tests/data/scenes/struck-bar.yaml", no_sets, truth, 0, channel);
    assert_int_equal(b->r.companion->coarser.simulation->beam[0].def.n_segment, 20);
    check_estimates(b, 0.7, 1.5);
}

// Where a macro step takes Radau IIA one step, twice its length takes two: equal ones would be the run's.
TEST(companions_by_radau_take_other_steps) {
#define OSCILLATOR                                                                                           \
    "simulation={duration: 2 s, macro_step: 10 ms, accuracy: 0.1}", "gravity=[0, 0, 0]",                     \
        "bodies[ball].mass=1",                                                                               \
        "bodies[ball].joint={kind: prismatic, axis: z, parent: ground, position: 0.1 m, stiffness: 2116}"
    static const char *const sets[] = {OSCILLATOR, NULL}, *const channel[] = {"ballPos", "ballVel", NULL},
                             *const truth[] = {OSCILLATOR, "simulation.master.rtol=1e-10", NULL};
    check_arena(arena);
    check_estimates(run_beside(arena, "tests/data/scenes/ball.yaml", sets, truth, 0, channel), 1, 3);
}

// It stands beside sub-solvers with a loose tolerance, whatever that of the master is, and beside a coupling
// that errs more than they do.
TEST(loose_sub_solvers_have_a_finer_solution) {
    static const char *const way[][2] = {
        {"simulation.coupling={scheme: ramp}", "simulation.micro={rtol: 1e-6}"},
        {"simulation.coupling={scheme: ramp}", "simulation.micro={rtol: 3e-4}"},
        {"simulation.coupling={scheme: frozen}", "simulation.micro={rtol: 1e-6}"}};
    for (int k = 0; k < 3; k++) {
        const char *const *sets =
            sets_of(way[k][0], way[k][1], "simulation.master={rtol: 1e-6}", "simulation.macro_step=5 ms",
                    "bodies[weight].mass=50", "bodies[weight].inertia=[50, 50, 50]");
        check_run(arena, r, "tests/data/scenes/mid-weight.yaml", sets);
        assert_int_equal(r.companion->finer.other.simulation != NULL, k > 0);
    }
}

// Stiff rods without damping: followed by its tolerance, the finer solution would take forty times the work
// of the run. Beside Beck's column its first macro step alone would take more than all may. It gives up, and
// the run says so.
TEST(the_finer_solution_takes_little_work) {
    static const char *const scene[] = {"tests/data/scenes/mid-weight.yaml", "apps/beams/beck.yaml"};
    for (int k = 0; k < 2; k++) {
        check_ended_run(arena, r, scene[k], no_sets);
        double finer = r.companion->finer.work, both = bough_companion_work(r.companion);
        print_message("work: %.2g, of run and companion %.2g\n", finer, both);
        assert_true(finer > 0 && finer < 0.05 * both + 1000);
        assert_true(r.simulation->validity->limit[BOUGH_LIMIT_FAST].passed);
    }
}

// What grows in a turbine at rest is rounding, and beside a weight on a rod what stays below the mesh's
// error.
TEST(what_errs_little_is_not_followed) {
    static const char *const scene[] = {"apps/turbine/parked.yaml", "tests/data/scenes/carrying.yaml"};
    for (int k = 0; k < 2; k++) {
        check_ended_run(arena, r, scene[k], sets_of("simulation.duration=0.1 s", NULL));
        assert_true(r.companion->finer.until < 5 * r.simulation->master->macro_step);
    }
}

// Before a run fails by its steps, finer ones say what these err by: more closely than the companion does.
TEST(finer_steps_prove_an_error_in_time) {
    static const char scene[] = "apps/mechanisms/pendulum.yaml";
    const char *const truth_sets[] = {"simulation.macro_step=10 ms", "simulation.error_estimate=none", NULL};
    const char *const sets[] = {"simulation.duration=2 s", "simulation.macro_step=10 ms",
                                "simulation.error_bound=1e-6",
                                "simulation.master={solver: rosenbrock, rtol: 4e-3}", NULL};
    static const char *const channel[] = {"bobPos", "bobVel", NULL};
    check_arena(arena);
    beside *b = run_beside(arena, scene, sets, truth_sets, 0, channel);
    bough_error_shares shares = find_shares(arena, &b->r);
    for (int i = 0; i < 2; i++) { // the first two channels
        double proved = b->r.companion->error[i];
        print_message("finer steps %.3g\n", proved);
        assert_true(b->estimate[i] > 1.05 * proved);
        check_near(proved, b->error[i], 0.2, 0);
        check_near(shares.share[BOUGH_SHARE_TIME].largest[i], proved, 1e-9, 0);
    }
}

static int asked;

static bool count_steps(void) {
    asked++;
    return false;
}

// Five segments: the search needs a part of one further run, whose rest stays small.
TEST(a_mesh_far_beyond_the_bound_is_proved_early) {
    check_ended_run(arena, r, "tests/data/scenes/tumbling.yaml", no_sets);
    bough_error_shares shares;
    asked = 0;
    check_ok(bough_error_shares_find(arena, r.companion, count_steps, &shares));
    double mesh = bough_error_verdict_of(r.companion, true, shares.share[BOUGH_SHARE_MESH].largest).relative;
    double time = bough_error_verdict_of(r.companion, true, shares.share[BOUGH_SHARE_TIME].largest).relative;
    double whole = bough_error_verdict_of(r.companion, true, r.companion->error).relative;
    print_message("%d macro steps of %ld; error %.2g, mesh %.2g, time %.2g\n", asked,
                  r.simulation->master->steps, whole, mesh, time);
    assert_true(asked > 0 && asked < 0.9 * (double)r.simulation->master->steps);
    assert_true(mesh > 0.05 && mesh >= whole && time < 0.05 * mesh);
}

// An iteration that does not converge goes on where errors are known, and a copy of such a run does, too.
TEST(a_further_run_goes_on_as_the_run_does) {
    check_run(arena, r, example,
              sets_of("simulation.coupling={scheme: iterated, iterations: 1, tolerance: 1e-12}"));
    bough_other_run copy;
    check_ok(bough_other_run_build(arena, r.simulation, 0, &copy));
    for (int k = 0; k < 4; k++) {
        check_ok(bough_run_step(&r));
        check_ok(bough_step(copy.simulation->master));
    }
    bough_other_run_sample(&copy);
    for (int i = 0; i < r.channels.count; i++) check_near(copy.value[i], bough_run_values(&r)[i], 0, 0);
}

#define LIBRARY                                                                                              \
    "control={kind: bladed, rate: 50, gear_ratio: 97, input: memory, library: " BOUGH_SAMPLE_DISCON "}"

// Estimating changes no bit of the run; a library has a memory, and the companion one of its own.
TEST(a_companion_changes_nothing) {
    static const char *const scene[] = {example, "apps/turbine/power.yaml"}, *const more[] = {
                                                                                 "title=no library", LIBRARY};
    for (int k = 0; k < 2; k++) {
        const char *const with[] = {"simulation.duration=1 s", more[k], NULL};
        const char *const without[] = {with[0], more[k], "simulation.error_estimate=none", NULL};
        outcome *a = run_for(scene[k], 50, with), *b = run_for(scene[k], 50, without);
        assert_true(a->compared);
        assert_false(b->compared);
        assert_string_equal(b->reason, "simulation.error_estimate is none");
        assert_memory_equal(a->value, b->value, sizeof a->value);
        free(a);
        free(b);
    }
}

// Every channel has an error, forces, air and control too; equal quantities have equal ones.
TEST(every_channel_has_an_error) {
    const char *const sets[] = {"simulation.duration=1 s", "bodies[hub].inertia=[1e5, 1e5, 1e5]", NULL};
    outcome *o = run_for("apps/turbine/power.yaml", 50, sets);
    for (int i = 0; i < o->n; i++) {
        if (!isfinite(o->error[i])) fail_msg("%s has none", o->name[i]);
    }
    check_near(o->error[find(o, "GenSpeed")], 97 * o->error[find(o, "RotSpeed")], 1e-6, 0);
    free(o);
}

// What the mesh changes before the first step is an error, too: here of the forces of the air.
TEST(the_start_is_compared) {
    check_run(arena, r, example, no_sets);
    double most = 0;
    for (int i = 0; i < r.channels.count; i++) most = fmax(most, r.companion->error[i]);
    assert_true(most > 0);
    assert_false(bough_companion_knows(r.companion, 0));
}

// Both solutions notice a contact by chance, and its velocities are compared only in halves of macro steps.
TEST(a_contact_has_its_error) {
    static const char *const truth[] = {"simulation.error_estimate=none", "simulation.macro_step=2.5 ms",
                                        "simulation.master={solver: ida, rtol: 1e-8}", NULL};
    static const char *const channel[] = {"ballVel", NULL};
    check_arena(arena);
    check_estimates(run_beside(arena, "tests/data/scenes/ball.yaml", no_sets, truth, 0, channel), 1 / 3., 10);
}

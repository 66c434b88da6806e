// The one run object: what is recorded when, stopping and going on, copies.
#include "apps/bough/model/run.h"
#include "tests/unit/built_scene.h"

enum { MOST = 64 };

typedef struct sampled {
    int n;
    double time[MOST];
} sampled;

static bough_status sample(void *self, double t) {
    sampled *s = self;
    assert_true(s->n < MOST);
    s->time[s->n++] = t;
    return bough_ok();
}

static const char *const short_run[] = {"simulation.duration=0.1 s", "simulation.macro_step=10 ms",
                                        "simulation.output.interval=10 ms", NULL};

static bough_run create(bough_arena *arena) {
    bough_run run;
    check_ok(bough_run_create(arena, scene_read(arena, "apps/mechanisms/pendulum.yaml", short_run), &run));
    return run;
}

// Every 40 ms of 100 in steps of 10, and every 25 ms at the step after it; the end where it is asked for.
TEST(records_are_taken_when_due) {
    check_arena(arena);
    bough_run run = create(arena);
    sampled coarse = {0}, between = {0};
    bough_run_record_at(&run, (bough_run_record){0.04, true, .sample = sample, .self = &coarse});
    bough_run_record_at(&run, (bough_run_record){0.025, .sample = sample, .self = &between});
    bough_run_all(&run);
    assert_int_equal(run.outcome.code, BOUGH_OK);
    assert_true(bough_run_done(&run));
    static const double expected[] = {0, 0.04, 0.08, 0.1}, after[] = {0, 0.03, 0.05, 0.08, 0.1};
    assert_int_equal(coarse.n, 4);
    for (int k = 0; k < 4; k++) check_near(coarse.time[k], expected[k], 1e-12, 1e-12);
    assert_int_equal(between.n, 5);
    for (int k = 0; k < 5; k++) check_near(between.time[k], after[k], 1e-12, 1e-12);
}

static bough_status stop_at_half(void *self) {
    const bough_run *run = self;
    return run->simulation->master->time > 0.045 ? bough_fail(BOUGH_INTERRUPTED, "enough") : bough_ok();
}

// A stopped run has its last record and goes on to the values of the one that was not stopped.
TEST(a_stopped_run_goes_on) {
    check_arena(arena);
    bough_run run = create(arena), whole = create(arena);
    sampled rows = {0};
    bough_run_record_at(&run, (bough_run_record){0.04, true, .sample = sample, .self = &rows});
    run.after = stop_at_half;
    run.self = &run;
    bough_run_all(&run);
    assert_int_equal(run.outcome.code, BOUGH_INTERRUPTED);
    assert_string_equal(run.outcome.message, "enough");
    assert_int_equal(rows.n, 3); // 0, 40 and 50 ms
    check_near(rows.time[2], 0.05, 1e-12, 0);
    run.after = NULL;
    bough_run_all(&run);
    bough_run_all(&whole);
    assert_int_equal(run.outcome.code, BOUGH_OK);
    assert_memory_equal(bough_run_values(&run), bough_run_values(&whole),
                        (size_t)run.channels.count * sizeof(double));
}

// A copy holds what is due when: after it the same records follow.
TEST(a_copy_goes_on_with_its_records) {
    check_arena(arena);
    bough_run run = create(arena), other = create(arena);
    sampled rows = {0}, later = {0};
    bough_run_record_at(&run, (bough_run_record){0.04, true, .sample = sample, .self = &rows});
    bough_run_record_at(&other, (bough_run_record){0.04, true, .sample = sample, .self = &later});
    bough_run_start(&run);
    for (int k = 0; k < 5; k++) bough_run_step(&run);
    check_ok(bough_run_storable(&run));
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    bough_run_snapshot(&run, &measure);
    char *copy = malloc(measure.used);
    bough_run_snapshot(&run, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, copy, 0});
    bough_run_snapshot(&run, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, copy, 0});
    bough_run_snapshot(&other, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, copy, 0});
    free(copy);
    bough_run_all(&run);
    bough_run_all(&other);
    assert_int_equal(rows.n, 4);
    assert_int_equal(later.n, 2); // 80 and 100 ms
    assert_true(later.time[0] == rows.time[2] && later.time[1] == rows.time[3]);
    assert_memory_equal(bough_run_values(&run), bough_run_values(&other),
                        (size_t)run.channels.count * sizeof(double));
    assert_int_equal(bough_run_statistics(&run, 0).steps, bough_run_statistics(&other, 0).steps);
    // what a search for the cause of an error may take is the same, too
    check_near(bough_companion_work(other.companion), bough_companion_work(run.companion), 1e-12, 0);
}

typedef struct ahead {
    const bough_run *run;
    double most; // [s]
} ahead;

static bough_status look_ahead(void *self) {
    ahead *x = self;
    const bough_simulation *other = x->run->companion->coarser.simulation;
    x->most = fmax(x->most, other->master->time - x->run->simulation->master->time);
    return bough_ok();
}

// Its companion goes ahead of a run where no comparison may change its steps, as corners of a load may, and
// where no thread would wait for it; its errors have the same bits, and it fails at the same time where its
// segments turn too far.
TEST(a_companion_ahead_states_the_same) {
    static const char turbine[] = "tests/data/scenes/example-turbine.yaml";
    static const struct {
        const char *path, *duration, *loads, *mesh;
    } scene[] = {
        {turbine, "simulation.duration=0.6 s", "title=free", "title=as it is"},
        {turbine, "simulation.duration=0.6 s",
         "loads=[{joint: hub, torque: {times: [0, .1, .2, .21, .22, .23, .24, .25, .26], values: [0, 0, 0, 1, "
         "0, 1, 0, 1, 0]}}]",
         "title=as it is"},
        {"apps/beams/roll-up.yaml", "simulation.duration=2 s",
         "loads=[{body: beam, at: tip, moment: [0, 150, 0], ramp: [0 s, 2 s]}]",
         "bodies[beam].rod.segments=10"}};
    for (int k = 0; k < 6; k++) {
        int i = k / 2;
        const char *const *sets = sets_of(scene[i].duration, scene[i].loads, scene[i].mesh,
                                          k % 2 ? "simulation.threads=2" : "simulation.threads=1");
        check_run(arena, run, scene[i].path, sets);
        bough_run other;
        check_ok(bough_run_create(arena, run.simulation->scene, &other));
        ahead x = {.run = &run};
        run.steps_together = true;
        run.after = look_ahead;
        run.self = &x;
        bough_run_all(&run);
        assert_int_equal(run.outcome.code, BOUGH_OK);
        assert_int_equal(x.most > 0.05, k % 2 == 0 && i != 1);
        other.side_by_side = false;
        while (!bough_run_done(&other)) check_ok(bough_run_step(&other));
        assert_memory_equal(run.companion->error, other.companion->error,
                            (size_t)run.channels.count * sizeof(double));
        assert_int_equal(run.companion->reason[0] != '\0', i == 2);
        check_near(run.companion->from, other.companion->from, 0, 0);
    }
}

// An undamped bar under a scheme that cannot hold it.
TEST(a_failed_run_has_no_values) {
    check_run(arena, run, "apps/beams/rubber-bar.yaml", sets_of("simulation.coupling.scheme=frozen"));
    sampled rows = {0};
    assert_non_null(bough_run_values(&run));
    bough_run_record_at(&run, (bough_run_record){10, true, .sample = sample, .self = &rows});
    bough_run_all(&run);
    assert_int_equal(run.outcome.code, BOUGH_FAILED);
    assert_null(bough_run_values(&run));
    assert_int_equal(rows.n, 1); // none at the end
}

// -- starts ----------------------------------------------------------------------------------------

// A silicon beam of 0.3 mm, whose waves along its axis are 5e4 times faster than the macro step, on a slider
// under the force 0.01 N/s t. The first macro step ends at rest: what the next step's rates foresee is too
// long by nine decades.
static const char resonator[] =
    "simulation: {duration: 5e-5, macro_step: 5e-6, error_estimate: none, coupling: {scheme: frozen},\n"
    "             micro: {solver: %s, rtol: 2e-7}}\n"
    "bodies:\n"
    "  - {name: slider, fidelity: rigid, mass: 1e-9, joint: {kind: prismatic, parent: ground, axis: x}}\n"
    "  - name: beam\n"
    "    fidelity: rod\n"
    "    joint: {kind: fixed, parent: slider}\n"
    "    rod:\n"
    "      length: 0.3 mm\n"
    "      segments: 10\n"
    "      stiffness: [2, 2, 6.4, 2.1e-10, 2.1e-12, 3e-12]\n"
    "      mass: [9.3e-8, 0, 0, 3.1e-18, 3.1e-20, 0]\n"
    "      damping: [20e-9, 20e-9, 20e-9, 20e-9, 20e-9, 20e-9]\n"
    "loads:\n"
    "  - {joint: slider, force: {times: [0, 1e-4], values: [0, 1e-6]}}\n";

TEST(solvers_find_their_first_step_however_small) {
    static const char *const solver[] = {"cvode-bdf", "ida", "arkode-esdirk"};
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        char text[1024];
        snprintf(text, sizeof text, resonator, solver[k]);
        bough_simulation *s = scene_build_text(arena, text);
        bough_channels list = scene_channels(arena, s);
        for (int step = 0; step < 10; step++) scene_step(s);
        double mass = 1e-9 + 9.3e-8 * 0.3e-3, t = 5e-5;
        check_near(scene_channel(s, &list, "sliderPos"), 0.01 * t * t * t / 6 / mass, 0.02, 0);
    }
}

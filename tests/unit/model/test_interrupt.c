// A run that is asked to stop within a macro step ends there, with time, states and inputs of its start.
#include "tests/unit/built_scene.h"

enum { MOST = 64, BEFORE = 3 };

static long evaluations; // left until the request comes

static bool stop(void) { return evaluations-- <= 0; }

// The request comes after `left` evaluations of the fourth step.
static void stop_within(const char *scheme, long left) {
    const char *const sets[] = {scheme, "simulation.macro_step=2 ms", "simulation.duration=200 ms", NULL};
    check_build(arena, s, "tests/data/scenes/arms.yaml", sets);
    bough_channels channels = bough_channels_start(arena);
    double before[MOST], after[MOST];
    bough_simulation_channels(s, &channels);
    assert_in_range(channels.count, 5, MOST);
    for (int k = 0; k < BEFORE; k++) scene_step(s);
    double time = s->master->time;
    bough_simulation_update(s);
    bough_channels_sample(&channels, time, before);
    evaluations = left;
    bough_master_stop_by(s->master, stop);
    bough_status status = bough_step(s->master);
    assert_int_equal(status.code, BOUGH_INTERRUPTED);
    assert_string_equal(status.message, "interrupted at 0.006 s of 0.2 s");
    assert_true(s->master->time == time);
    bough_simulation_update(s);
    bough_channels_sample(&channels, time, after);
    for (int i = 0; i < channels.count; i++) check_near(after[i], before[i], 1e-12, 1e-12);
}

// The request ends the run, too, if its companion or the finer solution notices first: what follows would
// have no errors.
TEST(a_request_to_the_companion_ends_the_run) {
    for (long left = 0; left < 20; left += 6) {
        check_run(arena, run, "tests/data/scenes/arms.yaml", sets_of("simulation.duration=200 ms"));
        for (int k = 0; k < BEFORE; k++) check_ok(bough_run_step(&run));
        while (!bough_companion_due(run.companion)) check_ok(bough_run_step(&run));
        evaluations = left;
        bough_companion_stop_by(run.companion, stop);
        assert_int_equal(bough_run_step(&run).code, BOUGH_INTERRUPTED);
        assert_string_equal(run.companion->reason, "");
    }
}

TEST(a_macro_step_is_left_as_it_began) {
    static const char *const schemes[] = {
        "simulation.coupling.scheme=frozen", "simulation.coupling.scheme=ramp",
        "simulation.coupling.scheme=iterated", "simulation.coupling.scheme=monolithic"};
    for (int k = 0; k < 4; k++) {
        for (long left = 0; left < 20; left += 6) stop_within(schemes[k], left);
    }
}

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

TEST(a_macro_step_is_left_as_it_began) {
    static const char *const schemes[] = {
        "simulation.coupling.scheme=frozen", "simulation.coupling.scheme=ramp",
        "simulation.coupling.scheme=iterated", "simulation.coupling.scheme=monolithic"};
    for (int k = 0; k < 4; k++) {
        for (long left = 0; left < 20; left += 6) stop_within(schemes[k], left);
    }
}

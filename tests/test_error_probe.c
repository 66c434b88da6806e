// The estimated coupling error of a scene's channels against the true one, the difference to the
// monolithic run.
#include "apps/scene/error_probe.h"
#include "tests/built_scene.h"

#include <stdlib.h>

static const char scene_path[] = "tests/scenes/arms.yaml";
enum { STEPS = 100, MOST = 64 };

typedef struct recorded {
    int n;                      // channels
    double value[STEPS][MOST];  // at the end of each step
    double estimate[MOST];      // told
    bool known[MOST];
    int hub;                    // the channel hubVel
} recorded;

static recorded *run(const char *scheme, bool probing) {
    const char *const sets[] = {scheme, "simulation.macro_step=2 ms", "simulation.duration=200 ms",
                                "simulation.micro.rtol=1e-8", "simulation.master.rtol=1e-9", NULL};
    recorded *r = calloc(1, sizeof *r);
    bough_arena *arena = bough_arena_create();
    bough_simulation *s = scene_build(arena, scene_path, sets);
    bough_channels channels = bough_channels_start(arena);
    bough_error_probe probe;
    bough_simulation_channels(s, &channels);
    bough_status status = bough_error_probe_create(arena, s, &channels, &probe);
    assert_true(bough_is_ok(&status));
    assert_true(channels.count <= MOST);
    r->n = channels.count;
    r->hub = bough_channels_find(&channels, "hubVel");
    for (int k = 0; k < STEPS; k++) {
        scene_step(s);
        if (probing) bough_error_probe_update(&probe);
        bough_simulation_update(s);
        bough_channels_sample(&channels, s->master->time, r->value[k]);
    }
    for (int i = 0; i < r->n; i++) {
        r->known[i] = bough_error_probe_knows(&probe, i);
        r->estimate[i] = probe.largest[i];
    }
    bough_arena_destroy(arena);
    return r;
}

static double largest_error(const recorded *r, const recorded *reference, int channel) {
    double largest = 0;
    for (int k = 0; k < STEPS; k++) {
        largest = fmax(largest, fabs(r->value[k][channel] - reference->value[k][channel]));
    }
    return largest;
}

static void channels_err_by_what_is_told(void **state) {
    (void)state;
    recorded *reference = run("simulation.coupling.scheme=monolithic", true);
    recorded *r = run("simulation.coupling.scheme=gauss-seidel", true);
    int checked = 0;
    for (int i = 0; i < r->n; i++) {
        assert_true(r->known[i]);
        assert_false(reference->known[i]);
        double error = largest_error(r, reference, i);
        if (error < 1e-7) continue; // of the integrators
        checked++;
        if (error < 3 * r->estimate[i] && error > r->estimate[i] / 100) continue;
        fail_msg("channel %d: %g estimated, %g true", i, r->estimate[i], error);
    }
    assert_true(checked >= 7); // the hub and two tips
    assert_true(largest_error(r, reference, r->hub) > 1e-4);
    free(reference);
    free(r);
}

static void probing_changes_nothing(void **state) {
    (void)state;
    recorded *with = run("simulation.coupling.scheme=ramp", true);
    recorded *without = run("simulation.coupling.scheme=ramp", false);
    assert_memory_equal(with->value, without->value, sizeof with->value);
    free(with);
    free(without);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_err_by_what_is_told),
        cmocka_unit_test(probing_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

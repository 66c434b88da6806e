// What another mesh changes in modes in the air, beside the modes of that mesh itself.
#include "apps/bough/analysis/vibration.h"
#include "apps/bough/model/companion.h"
#include "tests/unit/built_scene.h"

#include <math.h>

// The nearest eigenvalue of the other scene, |λ − λ'|/|λ|.
static double nearest(const bough_scene_mode *mode, const bough_vibration *other) {
    double least = HUGE_VAL;
    for (int k = 0; k < other->found; k++) {
        const bough_scene_mode *there = &other->mode[k];
        double growth = there->growth - mode->growth;
        double turn = 2 * BOUGH_PI * (there->damped_frequency - mode->damped_frequency);
        least = fmin(least, hypot(growth, turn) / (2 * BOUGH_PI * mode->frequency));
    }
    return least;
}

// Compares each mode's `moved`; returns the largest.
static double check_modes(bough_arena *arena, int count, const char *const *sets) {
    bough_simulation *s = scene_build(arena, "apps/turbine/land-operation.yaml", sets), *coarser;
    bough_vibration v, other;
    bool compared;
    check_ok(bough_vibration_find(arena, s, count, &v));
    check_ok(bough_vibration_compare(arena, s, &v, &compared));
    assert_true(compared);
    const bough_scene *scene = bough_coarser_scene_beside(arena, s, BOUGH_COARSER_MESH);
    check_ok(bough_simulation_build(arena, scene, &coarser));
    check_ok(bough_vibration_find(arena, coarser, count + 4, &other));
    double largest = 0;
    int known = 0;
    for (int k = 0; k < v.found; k++) {
        if (isnan(v.mode[k].moved)) continue;
        check_near(v.mode[k].moved, nearest(&v.mode[k], &other), 1e-3, 1e-8);
        largest = fmax(largest, v.mode[k].moved);
        known++;
    }
    assert_true(known >= 8);
    return largest;
}

// With and without states of the air.
TEST(another_mesh_moves_modes_as_its_own_modes_say) {
    static const struct {
        const char *modes;
        int count;
        double least;
    } air[] = {{"modes={of: scene, air: quasi-steady}", 10, 1e-3},
               {"modes={of: scene, air: dynamic}", 20, 1e-4}};
    for (int k = 0; k < 2; k++) {
        check_arena(arena);
        const char *const sets[] = {"aero.wind={kind: uniform, speed: 12 m/s}", air[k].modes, NULL};
        double largest = check_modes(arena, air[k].count, sets);
        assert_true(largest > air[k].least && largest < 1e-2);
    }
}

// What another mesh changes in modes in the air, beside the modes of that mesh itself.
#include "apps/bough/analysis/vibration.h"
#include "apps/bough/model/companion.h"
#include "tests/unit/built_scene.h"

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

// Compares each mode's `moved` within `error` of it; returns the largest.
static double check_modes(bough_arena *arena, int count, double error, const char *const *sets) {
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
        check_near(v.mode[k].moved, nearest(&v.mode[k], &other), error, 1e-8);
        largest = fmax(largest, v.mode[k].moved);
        known++;
    }
    assert_true(known >= 8);
    return largest;
}

// With and without states of the air by the vectors of the modes; where ten segments in place of twenty
// change them by much, by a search.
TEST(another_mesh_moves_modes_as_its_own_modes_say) {
    static const struct {
        const char *modes, *segments;
        int count;
        double error, least, most;
    } air[] = {{"modes={of: scene, air: quasi-steady}", "20", 10, 0.1, 1e-3, 1e-2},
               {"modes={of: scene, air: dynamic}", "20", 20, 0.1, 1e-4, 1e-2},
               {"modes={of: scene, air: quasi-steady}", "10", 10, 1e-3, 1e-2, 0.1}};
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        char segments[64];
        snprintf(segments, sizeof segments, "bodies[3-5].rod.segments=%s", air[k].segments);
        const char *const sets[] = {"aero.wind={kind: uniform, speed: 12 m/s}", air[k].modes, segments, NULL};
        double largest = check_modes(arena, air[k].count, air[k].error, sets);
        assert_true(largest > air[k].least && largest < air[k].most);
    }
}

// A search on the other mesh lacks partners of ten of these modes, to which their vectors lead.
TEST(no_mode_of_the_blades_is_missing_on_another_mesh) {
    check_arena(arena);
    const char *const sets[] = {"modes={of: scene, air: dynamic}", "aero.induction.inflow=oye", NULL};
    bough_simulation *s = scene_build(arena, "apps/iea22/rotor.yaml", sets);
    bough_vibration v;
    bool compared;
    check_ok(bough_vibration_find(arena, s, 40, &v));
    check_ok(bough_vibration_compare(arena, s, &v, &compared));
    for (int k = 0; k < v.found; k++) assert_false(isinf(v.mode[k].moved));
}

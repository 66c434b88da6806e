// Modes of a rotor in the mean over its azimuths: the same from whatever azimuth, and what one of them
// changes.
#include "apps/bough/analysis/vibration.h"
#include "tests/unit/built_scene.h"

enum { COUNT = 8 };

// Six segments on each blade; a blade passes the tower at 60 degrees.
static const char *const coarse[] = {
    "bodies[blade1].rod.segments=6",        "bodies[blade2].rod.segments=6",
    "bodies[blade3].rod.segments=6",        "aero.wind={kind: uniform, speed: 12 m/s}",
    "modes={of: scene, air: quasi-steady}",
};
enum { SETS = sizeof coarse / sizeof *coarse, MOST = SETS + 4 };

static bough_vibration modes_with(bough_arena *arena, const char *const *more) {
    const char *sets[MOST + 1] = {NULL};
    bough_vibration v;
    memcpy(sets, coarse, sizeof coarse);
    for (int k = 0; more[k] != NULL; k++) sets[SETS + k] = more[k];
    check_ok(
        bough_vibration_find(arena, scene_build(arena, "apps/turbine/land-operation.yaml", sets), COUNT, &v));
    assert_int_equal(v.found, COUNT);
    return v;
}

// Azimuths a quarter of 120 degrees apart are those of one mean; between them, modes differ by less than what
// an azimuth changes.
TEST(modes_are_those_of_the_mean_over_azimuths) {
    check_arena(arena);
    const bough_vibration here = modes_with(arena, no_sets);
    const bough_vibration there = modes_with(arena, sets_of("bodies[hub].joint.angle=60 deg"));
    const bough_vibration between = modes_with(arena, sets_of("bodies[hub].joint.angle=15 deg"));
    double change = 0;
    assert_int_equal(here.n_azimuth, 4);
    for (int k = 0; k < COUNT; k++) {
        const bough_scene_mode *mode = &here.mode[k];
        change = fmax(change, mode->damping_change);
        check_near(there.mode[k].frequency, mode->frequency, 3e-4, 0);
        check_near(there.mode[k].damping, mode->damping, 0, 5e-4);
        check_near(between.mode[k].damping, mode->damping, 0, mode->damping_change + 5e-4);
    }
    assert_true(change > 0.005); // as that of the tower and of the tilt
}

// Upright, and the tower thin: nothing depends on the azimuth.
TEST(azimuths_of_a_symmetric_rotor_change_nothing) {
    check_arena(arena);
    const bough_vibration v = modes_with(
        arena, sets_of("gravity=[0, 0, 0]",
                       "aero.tower={influence: potential, diameter: [1e-3, 1e-3], height: [0 m, 87.6 m]}",
                       "aero.induction.skew=none",
                       "bodies[hub].joint.placement=[move z 1.96256 m, move x -5.0191 m]"));
    for (int k = 0; k < COUNT; k++) {
        assert_true(v.mode[k].frequency_change < 1e-3);
        assert_true(v.mode[k].damping_change < 2e-4); // 4e-4 where blades blend in the wrong direction
    }
}

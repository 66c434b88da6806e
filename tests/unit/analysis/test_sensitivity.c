// Sensitivities of modes against differences of whole searches.
#include "apps/bough/analysis/sensitivity.h"
#include "tests/unit/built_scene.h"

enum { COUNT = 8 };
#define STEP 0.1

static bough_vibration modes_of(bough_arena *arena, bough_scene *scene, bough_simulation **s) {
    bough_vibration v;
    check_ok(bough_simulation_build(arena, scene, s));
    check_ok(bough_vibration_find(arena, *s, COUNT, &v));
    return v;
}

// The mode whose eigenvalue is nearest.
static const bough_scene_mode *nearest(const bough_vibration *v, const bough_scene_mode *of) {
    const bough_scene_mode *found = NULL;
    double least = HUGE_VAL;
    for (int k = 0; k < v->found; k++) {
        double off = hypot(v->mode[k].growth - of->growth,
                           2 * BOUGH_PI * (v->mode[k].damped_frequency - of->damped_frequency));
        if (off < least) least = off, found = &v->mode[k];
    }
    return found;
}

static const bough_sensitivity *named(const bough_sensitivities *x, const char *name) {
    for (int k = 0; k < x->n; k++)
        if (strcmp(x->list[k].name, name) == 0) return &x->list[k];
    return NULL;
}

// The figures of every parameter, or of every n-th, against the differences of two searches, to 1 % of the
// change of the eigenvalue; returns their number.
static int check_all(const char *path, const char *const *sets, int k, int every) {
    check_arena(arena);
    bough_simulation *s;
    bough_scene *scene = scene_read(arena, path, sets);
    bough_vibration v = modes_of(arena, scene, &s);
    bough_sensitivities found;
    check_ok(bough_sensitivity_find(arena, s, bough_equilibrium_time(s), &v.mode[k], &found));
    int n, compared = 0;
    const bough_parameter *list = bough_parameters_of(arena, scene, &n);
    for (int i = 0; i < n; i += every) {
        const bough_sensitivity *x = named(&found, list[i].name);
        bough_arena *own = bough_arena_create();
        bough_simulation *other;
        bough_vibration more = modes_of(own, bough_parameter_change(own, scene, &list[i], STEP), &other);
        bough_vibration less = modes_of(own, bough_parameter_change(own, scene, &list[i], -STEP), &other);
        const bough_scene_mode *a = nearest(&more, &v.mode[k]), *b = nearest(&less, &v.mode[k]);
        double frequency = 0.5 / STEP * (a->frequency - b->frequency) / v.mode[k].frequency;
        double damping = 0.5 / STEP * (a->damping - b->damping), size = hypot(frequency, damping);
        if (x != NULL && size > 1e-6) {
            check_near(x->frequency, frequency, 0, 0.01 * size);
            check_near(x->damping, damping, 0, 0.01 * size);
            compared++;
        }
        bough_arena_destroy(own);
    }
    return compared;
}

// The differences jump, by 4e-5 of a frequency, at 7.7, 8 and 8.2 m/s; why is not known.
#define ROTOR(air)                                                                                           \
    sets_of("bodies[3-5].rod.segments=6", "aero.wind.speed=7.9 m/s", "modes={of: scene, air: " air "}")
TEST(of_a_rotor_in_a_wind_at_rest) {
    assert_true(check_all("apps/iea22/rotor.yaml", ROTOR("frozen"), 4, 1) >= 8);
}
TEST(of_a_rotor_in_air_without_memory) {
    assert_true(check_all("apps/iea22/rotor.yaml", ROTOR("quasi-steady"), 2, 1) >= 8);
}
TEST(of_a_rotor_in_air_with_memory) {
    assert_true(check_all("apps/iea22/rotor.yaml", ROTOR("dynamic"), 4, 4) >= 3);
}

// Two planes of bending of one stiffness.
TEST(one_of_two_equal_modes_has_none) {
    check_arena(arena);
    bough_simulation *s;
    const char *sets[] = {"modes={of: scene}", NULL};
    bough_vibration v = modes_of(arena, scene_read(arena, "tests/data/scenes/tip-weight.yaml", sets), &s);
    bough_sensitivities found;
    check_fails(bough_sensitivity_find(arena, s, 0, &v.mode[0], &found), BOUGH_INVALID,
                "one of several modes");
}

// How the loads of the air follow the motion, of equal blades at once beside each by itself.
#include "apps/bough/analysis/air_tangent.h"
#include "apps/bough/analysis/vibration.h"
#include "tests/unit/built_scene.h"

// With tilt and tower, inflow and stall that have memory; a blade before the tower.
static const char *const before_the_tower[] = {
    "bodies[hub].joint.angle=60 deg",
    "aero.ramp=[0 s, 0 s]",
    "aero.wind={kind: power, speed: 10 m/s, exponent: 0.2, reference_height: 90 m}",
    "modes={of: scene, air: dynamic}",
    NULL,
};

// The largest of one of four blocks of a, and of what b has in place of it.
static void compare(const bough_air_tangent *a, const bough_air_tangent *b, int block, double *difference,
                    double *size) {
    *difference = *size = 0;
    for (int k = 0; k < a->all * a->all; k++) {
        if ((k % a->all >= a->n) + 2 * (k / a->all >= a->n) != block) continue;
        *difference = fmax(*difference, fabs(a->matrix[k] - b->matrix[k]));
        *size = fmax(*size, fabs(a->matrix[k]));
    }
}

TEST(equal_blades_at_once_have_the_tangent_of_each) {
    check_build(arena, s, "apps/turbine/land-operation.yaml", before_the_tower);
    bough_vibration_point x;
    bough_air_tangent each = {0}, at_once = {0};
    check_ok(bough_vibration_point_find(arena, s, 0, &x));
    assert_int_equal(x.group.n, 3);
    bough_air_azimuth about = {.simulation = s, .whole = x.whole, .state = x.state};
    check_ok(bough_air_tangent_add(arena, &about, NULL, &each));
    about.group = &x.group;
    check_ok(bough_air_tangent_add(arena, &about, NULL, &at_once));
    assert_true(each.n_air > 0);
    bool other = false;
    for (int k = 0; k < 4; k++) {
        double difference, size;
        compare(&each, &at_once, k, &difference, &size);
        assert_true(size > 0 && difference < 5e-5 * size);
        other = other || difference > 0;
    }
    assert_true(other); // means over the disk: states were changed at once
}

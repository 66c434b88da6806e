// How the loads of the air follow the motion, of equal blades at once beside each by itself.
#include "apps/bough/analysis/air_tangent.h"
#include "apps/bough/analysis/vibration.h"
#include "tests/unit/built_scene.h"

// With tilt and tower, inflow and stall that have memory; a blade before the tower.
static const char *const before_the_tower[] = {
    "bodies[hub].joint.angle=60 deg",
    "aero.ramp=[0 s, 0 s]",
    "aero.wind={kind: power, speed: 10 m/s, exponent: 0.2, reference_height: 90 m}",
    "modes.of=scene",
    NULL,
};

// The largest of a, and of what b has in place of it.
static void compare(const double *a, const double *b, size_t n, double *difference, double *size) {
    *difference = *size = 0;
    for (size_t i = 0; i < n; i++) {
        *difference = fmax(*difference, fabs(a[i] - b[i]));
        *size = fmax(*size, fabs(a[i]));
    }
}

TEST(equal_blades_at_once_have_the_tangent_of_each) {
    check_build(arena, s, "apps/turbine/land-operation.yaml", before_the_tower);
    bough_vibration_point x;
    bough_air_tangent each = {0}, at_once = {0};
    check_ok(bough_vibration_point_find(arena, s, 0, &x));
    assert_int_equal(x.group.n, 3);
    bough_air_azimuth about = {.simulation = s, .whole = x.whole, .state = x.state};
    check_ok(bough_air_tangent_add(arena, &about, true, NULL, &each));
    about.group = &x.group;
    check_ok(bough_air_tangent_add(arena, &about, true, NULL, &at_once));
    size_t n = (size_t)each.n, m = (size_t)each.n_air;
    assert_true(m > 0);
    const struct {
        const double *each, *at_once;
        size_t entries;
    } matrix[] = {{each.motion, at_once.motion, n * n},
                  {each.lift, at_once.lift, n * m},
                  {each.drive, at_once.drive, m * n},
                  {each.lag, at_once.lag, m * m}};
    bool other = false;
    for (int k = 0; k < 4; k++) {
        double difference, size;
        compare(matrix[k].each, matrix[k].at_once, matrix[k].entries, &difference, &size);
        assert_true(size > 0 && difference < 5e-5 * size);
        other = other || difference > 0;
    }
    assert_true(other); // means over the disk: states were changed at once
}

#include "aero/wind.h"

#include "tests/check.h"

static void default_is_calm(void **state) {
    (void)state;
    bough_wind_def wind = bough_wind_def_default();
    bough_vec3 v = bough_wind_at(&wind, bough_v3(1, 2, 3), 4);
    check_near(bough_norm(v), 0, 0, 0);
}

static void uniform_wind_blows_along_x_everywhere(void **state) {
    (void)state;
    bough_wind_def wind = bough_wind_def_default();
    wind.speed = 8;
    for (double z = -10; z < 200; z += 30) {
        bough_vec3 v = bough_wind_at(&wind, bough_v3(z, -z, z), z);
        check_near(v.x, 8, 0, 0);
        check_near(hypot(v.y, v.z), 0, 0, 0);
    }
}

static void shear_follows_power_law(void **state) {
    (void)state;
    bough_wind_def wind = {.speed = 10, .shear_exponent = 0.2, .reference_height = 90};
    check_near(bough_wind_at(&wind, bough_v3(0, 0, 90), 0).x, 10, 1e-15, 0);
    check_near(bough_wind_at(&wind, bough_v3(0, 0, 45), 0).x, 8.705505632961241, 1e-14, 0);
    check_near(bough_wind_at(&wind, bough_v3(0, 0, -1), 0).x, 0, 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(default_is_calm),
        cmocka_unit_test(uniform_wind_blows_along_x_everywhere),
        cmocka_unit_test(shear_follows_power_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

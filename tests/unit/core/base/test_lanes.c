#include "core/base/lanes.h"

#include "tests/unit/check.h"

// Against the mathematical library, whose own error is below one unit in the last place.
TEST(functions_agree_with_the_library) {
    enum { POINTS = 20001 };
    for (int i = 0; i < POINTS; i++) {
        double u = (double)i / (POINTS - 1), x = BOUGH_PI * (2 * u - 1);
        sine_cosine k = lane_sine_cosine(x);
        check_near(k.sine, sin(x), 0, 3e-16);
        check_near(k.cosine, cos(x), 0, 3e-16);
        check_near(lane_exp(-700 * u * u), exp(-700 * u * u), 7e-16, 0);
        check_near(lane_expm1(-700 * u * u * u * u), expm1(-700 * u * u * u * u), 1e-15, 0);
        check_near(lane_arc_sine(0.5 * u), asin(0.5 * u), 7e-16, 0);
        double radius = exp(20 * (u - 0.5));
        double angle = lane_angle(radius * sin(x), radius * cos(x));
        check_near(angle, atan2(radius * sin(x), radius * cos(x)), 7e-16, 0);
        check_near(lane_round(1000 * x), nearbyint(1000 * x), 0, 0);
    }
}

TEST(angles_on_the_axes) {
    static const double v[5] = {0, 1, -1, 1e-310, 1e300};
    for (int i = 0; i < 5; i++) {
        for (int j = 0; j < 5; j++) {
            if (fabs(v[i]) < 1e-300 && fabs(v[j]) < 1e-300) continue;
            check_near(lane_angle(v[i], v[j]), atan2(v[i], v[j]), 4e-16, 1e-300);
        }
    }
    check_near(lane_angle(0, 0), 0, 0, 0);
}

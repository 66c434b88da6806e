#include "tests/unit/check.h"
#include "tests/unit/nrel5mw_control.h"

static const double rpm = BOUGH_PI / 30, gear = 97, inertia = 43784725; // slow shaft [kg m²]

// The report derives its gains from a damping ratio of 0.7 and 0.6 rad/s at rated, where a pitch of
// 1 rad takes 25.52 MW: KP = 2 J Ω ζ ω/(N·25.52e6), KI = J Ω ω²/(N·25.52e6).
TEST(gains_are_those_of_the_design) {
    bough_controller_def d = nrel5mw_control;
    double speed = 12.1 * rpm, unit = inertia * speed / (gear * 25.52e6);
    check_near(d.proportional, 2 * 0.7 * 0.6 * unit, 1e-3, 0);
    check_near(d.integral, 0.36 * unit, 1e-3, 0);
    check_near(d.reference_speed, gear * speed, 1e-4, 0);
    check_near(d.most_torque, 1.1 * 43093.55, 1e-5, 0);
    check_ok(bough_controller_check(&d));
}

// Torque of the regions and where they meet: the report's figure 7-1.
TEST(torque_follows_the_regions) {
    bough_controller_def d = nrel5mw_control;
    static const double table[][3] = {{500, 0, 0},        {669.9, 0, 0},           {871, 0, 19403.3},
                                      {1000, 0, 25576.4}, {1161.963, 0, 43528.7},  {1173.7, 0, 43093.5},
                                      {1300, 0, 38906.9}, {1100, 0.0175, 45980.8}, {1000, 0.2, 47402.9}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const double *t = table[i];
        check_near(bough_controller_torque(&d, t[0] * rpm, t[1]), t[2], 2e-5, 0.5);
    }
    double before = 0;
    for (double w = 60; w < d.rated_speed; w += 0.01) { // without a jump
        double torque = bough_controller_torque(&d, w, 0);
        assert_true(torque >= before && torque < before + 80);
        before = torque;
    }
}

// From -1 to 1.3 of rated speed, at any pitch: no torque up to cut-in, positive above, without a jump up to
// where the pitched turbine has constant power.
TEST(torque_never_drives) {
    static const double pitches[] = {0, 0.018, 0.3, 1.57};
    for (int k = 0; k < 8; k++) {
        bough_controller_def d = nrel5mw_control;
        if (k >= 4) d.cut_in = 0;
        double pitch = pitches[k % 4], before = 0;
        for (double w = -d.rated_speed; w < 1.3 * d.rated_speed; w += 0.01) {
            double torque = bough_controller_torque(&d, w, pitch);
            assert_true(w <= d.cut_in ? torque == 0 : torque > 0);
            assert_true(w >= d.optimal_from || fabs(torque - before) < 25);
            before = torque;
        }
    }
}

// From the synchronous speed the line of the slip goes both ways, to the most torque of either sign; GenModel
// 1 of OpenFAST's ServoDyn.
TEST(an_induction_generator_drives_below_its_synchronous_speed) {
    bough_controller_def d = nrel5mw_control;
    const double most = 450, synchronous = 600 * rpm, slip = 0.03;
    d.motoring = true, d.optimal_gain = 0, d.cut_in = 0, d.optimal_from = 1e-3;
    d.above_rated = BOUGH_CONSTANT_TORQUE, d.slip = slip, d.most_torque = most, d.torque_rate = 1e9;
    d.rated_speed = synchronous * (1 + slip), d.rated_power = most * d.rated_speed;
    check_ok(bough_controller_check(&d));
    for (double w = -2 * synchronous; w < 2 * synchronous; w += 0.1) {
        double expected = bough_clamp(most * (w - synchronous) / (slip * synchronous), -most, most);
        check_near(bough_controller_torque(&d, w, 0), expected, 1e-9, 1e-9);
    }
    bough_controller_state s = {0};
    for (int k = 0; k < 2; k++) bough_controller_advance(&d, 0, 0, 0.02, &s);
    check_near(s.torque, -most, 1e-12, 0);
    d.optimal_gain = 1e-3;
    bough_status status = bough_controller_check(&d);
    assert_int_equal(status.code, BOUGH_INVALID);
}

// A rotor that something else stops and turns back: the filter and the rate of the torque keep none.
TEST(a_rotor_that_reverses_has_no_torque) {
    bough_controller_def d = nrel5mw_control;
    bough_controller_state s = {0};
    bough_controller_advance(&d, 110, 0, 0.02, &s);
    assert_true(s.torque > 20000);
    for (double speed = 110; speed > -50; speed -= 2) {
        bough_controller_advance(&d, speed, 0, 0.02, &s);
        if (speed <= 0) check_near(s.torque, 0, 0, 0);
    }
}

// Constant torque instead, and a line that is as good as vertical.
TEST(torque_may_stay) {
    bough_controller_def d = nrel5mw_control;
    d.above_rated = BOUGH_CONSTANT_TORQUE;
    double rated = d.rated_power / d.rated_speed;
    check_near(bough_controller_torque(&d, 1.5 * d.rated_speed, 0), rated, 1e-12, 0);
    d.slip = 1e-9;
    check_ok(bough_controller_check(&d));
    check_near(bough_controller_torque(&d, d.rated_speed * (1 + 1e-9), 0), rated, 1e-12, 0);
    double below = d.rated_speed * (1 - 1e-6);
    check_near(bough_controller_torque(&d, below, 0), d.optimal_gain * below * below, 1e-12, 0);
}

TEST(limits_hold) {
    bough_controller_def d = nrel5mw_control;
    bough_controller_state s = {0};
    bough_controller_advance(&d, 90, 0.1, 0.02, &s);
    check_near(s.pitch, 0.1, 0, 0);
    for (int k = 0; k < 400; k++) {
        bough_controller_state last = s;
        bough_controller_advance(&d, k < 200 ? 200 : 10, s.pitch, 0.02, &s);
        assert_true(fabs(s.pitch - last.pitch) <= d.pitch_rate * 0.02 * (1 + 1e-9));
        assert_true(fabs(s.torque - last.torque) <= d.torque_rate * 0.02 * (1 + 1e-9));
        assert_true(s.pitch >= d.least_pitch && s.pitch <= d.most_pitch);
    }
    // The integral does not run away while the pitch is at its least.
    for (int k = 0; k < 50000; k++) bough_controller_advance(&d, 10, s.pitch, 0.02, &s);
    check_near(s.pitch, 0, 0, 0);
    check_near(s.integral, 0, 0, 0);
}

// A rotor of that inertia whose power falls with the pitch as the report says comes back to the
// reference speed after a gust, from either side.
TEST(speed_is_regulated) {
    bough_controller_def d = nrel5mw_control;
    const double step = 0.0125, rated = 5296610;
    for (int sign = -1; sign <= 1; sign += 2) {
        bough_controller_state s = {0};
        double speed = (12.1 + sign) * rpm, pitch = 0.2, largest = 0;
        for (double t = 0; t < 120; t += step) {
            bough_controller_advance(&d, gear * speed, pitch, step, &s);
            pitch = s.pitch;
            double lost = 25.52e6 * (pitch + pitch * pitch / (2 * d.halving_pitch));
            double wind = 25.52e6 * (0.2 + 0.04 / (2 * d.halving_pitch));
            double power = rated + wind - lost;
            speed += step / inertia * (power / speed - gear * s.torque);
            if (t > 60) largest = fmax(largest, fabs(speed / (12.1 * rpm) - 1));
        }
        assert_true(largest < 2e-3);
        check_near(pitch, 0.2, 1e-2, 0);
        check_near(gear * s.torque * speed, rated, 1e-3, 0);
    }
}

TEST(senseless_constants_are_refused) {
    for (int i = 0; i < 6; i++) {
        bough_controller_def d = nrel5mw_control;
        if (i == 4) d.cut_in = -1;
        if (i == 5) d.optimal_gain = -1;
        if (i == 0) d.slip = 0;
        if (i == 1) d.least_pitch = 2;
        if (i == 2) d.cut_in = 100;
        if (i == 3) d.optimal_gain = 40;
        bough_status status = bough_controller_check(&d);
        assert_int_equal(status.code, BOUGH_INVALID);
    }
}

// The line of a nearly vertical slip meets the parabola at its synchronous speed.
TEST(slip_of_nearly_nothing_is_a_vertical_line) {
    bough_controller_def d = nrel5mw_control;
    d.slip = 1e-7;
    d.optimal_from = 1e-3, d.cut_in = 0;
    check_ok(bough_controller_check(&d));
    double below = d.rated_speed * (1 - 1e-6);
    check_near(bough_controller_torque(&d, below, 0), d.optimal_gain * below * below, 1e-12, 0);
}

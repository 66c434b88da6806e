#include "tests/unit/nrel5mw_aero.h"
#include "tests/unit/one_element.h"
#include "tests/unit/sample_numbers.h"

// Lift 2π sin α as a fine table, no drag.
enum { PLATE = 3601 };
static double plate_row[PLATE][4];

static int set_up(void **state) {
    for (int i = 0; i < PLATE; i++) {
        plate_row[i][0] = -180 + 0.1 * i;
        plate_row[i][1] = 2 * BOUGH_PI * sin(plate_row[i][0] * BOUGH_PI / 180);
    }
    return airfoils_make(state, &(bough_polar_def){.n = PLATE, .row = &plate_row[0][0]});
}

static bough_induction_options lossless(void) {
    bough_induction_options o = bough_induction_options_default();
    o.tip_loss = o.hub_loss = false;
    return o;
}

static bough_element element_of(const bough_polar *polar) {
    return (bough_element){.polar = polar,
                           .solidity = 0.05,
                           .cone = 1,
                           .tip_factor = 1,
                           .hub_factor = 10,
                           .twist = 0.05,
                           .inflow_x = 8,
                           .inflow_y = 40};
}

// Without swirl and loss, thrust from momentum 4a(1 − a) equals thrust from the blade.
TEST(thrust_balances_momentum) {
    airfoils *foils = *context;
    bough_induction_options options = lossless();
    options.tangential = false;
    for (double twist = 0.03; twist < 0.2; twist += 0.01) {
        bough_element e = element_of(&foils->plate);
        e.twist = twist;
        bough_induction i = induction_at(&options, &e);
        double u = e.inflow_x * (1 - i.axial), phi = atan2(u, e.inflow_y);
        double lift = 2 * BOUGH_PI * sin(phi - twist); // the plate's table has chords of 0.1°
        double ct = e.solidity * lift * cos(phi) * (u * u + 40 * 40) / 64;
        assert_true(i.axial > -0.2 && i.axial < 0.35);
        check_near(ct, 4 * i.axial * (1 - i.axial), 1e-4, 1e-5);
        check_near(i.tangential, 0, 0, 0);
    }
}

// A heavily loaded tip in hardly any wind, a > 1: the induced velocity follows the wind without a jump.
TEST(hardly_any_wind_has_one_answer) {
    airfoils *foils = *context;
    const double step = 1e-3;
    for (int skewed = 0; skewed < 2; skewed++) {
        bough_induction_options options = bough_induction_options_default();
        options.skewed_momentum = skewed;
        bough_element e = element_of(foils->polar + 7);
        e.solidity = 0.011;
        e.tip_factor = 0.033;
        e.twist = 0.0205;
        e.inflow_y = 76.4;
        e.skew = 0.087;
        double axial = 0, tangential = 0;
        for (double wind = 0.01; wind < 3; wind += step) {
            e.inflow_x = wind;
            bough_induction i = induction_at(&options, &e);
            double a = wind * i.axial, t = e.inflow_y * i.tangential;
            assert_true(i.axial > 1);
            if (wind > 0.01) check_near(a, axial, 0, 2 * step);
            if (wind > 0.01) check_near(t, tangential, 0, 2 * step);
            axial = a;
            tangential = t;
        }
    }
}

// Below 1 mm/s of either component.
TEST(too_slow_an_inflow_has_no_wake) {
    airfoils *foils = *context;
    bough_induction_options options = bough_induction_options_default();
    for (int k = 0; k < 4; k++) {
        bough_element e = element_of(foils->polar + 7);
        *(k % 2 ? &e.inflow_x : &e.inflow_y) = k < 2 ? 0.99e-3 : 1.01e-3;
        bough_induction i = induction_at(&options, &e);
        assert_true((i.axial == 0 && i.tangential == 0 && i.loss == 0) == (k < 2));
    }
}

// For small angles, lift 2πα and no twist φ = (1 − a)/λ, and 4a(1 − a) = 2πσλ²φ gives a = πσλ/2.
TEST(small_angles_agree_with_closed_form) {
    airfoils *foils = *context;
    bough_induction_options options = lossless();
    options.tangential = false;
    bough_element e = element_of(&foils->plate);
    e.solidity = 1e-3;
    e.twist = 0;
    e.inflow_x = 1;
    e.inflow_y = 100;
    double a = BOUGH_PI * e.solidity * 100 / 2;
    check_near(induction_at(&options, &e).axial, a, 2e-4, 0);
    e.cone = 0.5; // the blade stands 45° out of the rotor plane: half the thrust on the wake
    check_near(induction_at(&options, &e).axial, a / 2, 2e-4, 0);
}

// Torque from the blade equals angular momentum 4a'(1 − a) λ_r; ideal rotor without drag.
TEST(torque_balances_angular_momentum) {
    airfoils *foils = *context;
    bough_induction_options options = lossless();
    bough_element e = element_of(&foils->plate);
    e.inflow_y = 12;
    e.twist = 0.3;
    bough_induction i = induction_at(&options, &e);
    double u = 8 * (1 - i.axial), v = 12 * (1 + i.tangential);
    double lift = 2 * BOUGH_PI * sin(atan2(u, v) - e.twist), w2 = u * u + v * v;
    double cq = e.solidity * lift * u * sqrt(w2) / 64;
    assert_true(i.tangential > 0.005);
    check_near(cq, 4 * i.tangential * (1 - i.axial) * 12 / 8, 1e-4, 0);
    // The ideal rotor: a'(1 + a')λ² = a(1 − a).
    check_near(i.tangential * (1 + i.tangential) * 2.25, i.axial * (1 - i.axial), 1e-6, 0);
}

static double thrust(const bough_element *e, double axial) {
    double u = e->inflow_x * (1 - axial), phi = atan2(u, e->inflow_y);
    bough_coefficients k = bough_polar_at(e->polar, phi - e->twist);
    double w2 = u * u + e->inflow_y * e->inflow_y;
    return e->solidity * (k.lift * cos(phi) + k.drag * sin(phi)) * w2 / e->inflow_x / e->inflow_x;
}

// Beyond momentum theory the thrust lies on the parabola of the option.
TEST(high_thrust_lies_on_parabola) {
    airfoils *foils = *context;
    bough_induction_options options = lossless();
    options.tangential = false;
    int seen = 0;
    for (double solidity = 0.05; solidity < 0.3; solidity += 0.02) {
        bough_element e = element_of(foils->polar + 7);
        e.solidity = solidity;
        options.high_thrust = BOUGH_HIGH_THRUST_SMOOTH;
        double a = induction_at(&options, &e).axial, b = a - 0.35;
        if (a > 0.4) {
            seen++;
            check_near(thrust(&e, a), 0.91 + b * (1.2 + b * (2 - 0.91 - 1.2 * 0.65) / 0.4225), 1e-9, 0);
        }
        options.high_thrust = BOUGH_HIGH_THRUST_BUHL;
        a = induction_at(&options, &e).axial;
        if (a > 0.4 && a < 1) {
            seen++;
            check_near(thrust(&e, a), 8. / 9 - 4. / 9 * a + 14. / 9 * a * a, 1e-9, 0);
        }
    }
    assert_true(seen > 5);
}

// In a skewed wake thrust and torque balance the momentum of the flow through a disk across the wind,
// up to a = 0.35/cos χ; beyond, the thrust lies on the parabola that goes on there.
TEST(skewed_momentum_is_that_of_glauert) {
    airfoils *foils = *context;
    bough_induction_options options = lossless();
    options.skewed_momentum = true;
    int low = 0, high = 0;
    for (double solidity = 0.02; solidity < 0.4; solidity *= 1.3) {
        for (int degrees = 0; degrees <= 60; degrees += 15) {
            bough_element e = element_of(&foils->plate);
            e.solidity = solidity;
            e.skew = degrees * BOUGH_PI / 180;
            double t = tan(e.skew), critical = fmin(0.35 / cos(e.skew), 0.5);
            bough_induction i = induction_at(&options, &e);
            double a = i.axial, u = 8 * (1 - a), v = 40 * (1 + i.tangential);
            double phi = atan2(u, v), w2 = u * u + v * v;
            double lift = bough_polar_at(e.polar, phi - e.twist).lift;
            double ct = e.solidity * lift * cos(phi) * w2 / 64;
            double cq = e.solidity * lift * sin(phi) * w2 / 64;
            if (a < critical) {
                low++;
                double flow = sqrt((1 - a) * (1 - a) + t * t);
                check_near(ct, 4 * a * flow, 1e-9, 0);
                check_near(cq, 4 * i.tangential * flow * 5, 1e-9, 0);
                continue;
            }
            high++;
            double x = 1 - critical, root = sqrt(x * x + t * t), b = a - critical;
            double start = 4 * critical * root;
            double slope = 4 * root + 4 * critical * -x / root;
            double end = fmax(2 + 2.113 * pow(t, 1.527), start + slope * x + 0.001);
            double bend = (end - start - slope * x) / (x * x);
            check_near(ct, start + b * (slope + b * bend), 1e-9, 0);
        }
    }
    assert_true(low > 10 && high > 10);
}

// Speeds from nothing to a thousand m/s, now and then exactly none; any angle, loss and cone.
static bough_element random_element(const airfoils *foils, unsigned *seed) {
    double strong = exp(sample_between(seed, -12, 3)), kind = sample_between(seed, 0, 1);
    bough_element e = {.polar = foils->polar + (int)sample_between(seed, 0, 7.999),
                       .solidity = exp(sample_between(seed, -9, 1)),
                       .tip_factor = exp(sample_between(seed, -14, 5)),
                       .hub_factor = exp(sample_between(seed, -14, 5)),
                       .cone = sample_between(seed, 0, 1),
                       .twist = sample_between(seed, -BOUGH_PI, BOUGH_PI),
                       .inflow_x = sample_between(seed, -30, 30) * (kind < 0.1 ? strong : 1),
                       .inflow_y = sample_between(seed, -90, 90) * (kind > 0.9 ? strong : 1)};
    if (kind > 0.40 && kind < 0.43) e.inflow_x = 0;
    if (kind > 0.42 && kind < 0.45) e.inflow_y = 0;
    if (kind > 0.50 && kind < 0.55) e.twist = BOUGH_PI / 2 * floor(sample_between(seed, -2, 3));
    if (kind > 0.55 && kind < 0.60) e.tip_factor = 0;
    return e;
}

TEST(any_state_is_finite_and_repeats) {
    airfoils *foils = *context;
    unsigned seed = 1;
    long evaluations = 0, worst = 0;
    for (int n = 0; n < 100000; n++) {
        bough_induction_options options = bough_induction_options_default();
        if (n % 2) options.high_thrust = BOUGH_HIGH_THRUST_BUHL;
        if (n % 7 == 0) options.tangential_drag = options.axial_drag = false;
        bough_element e = random_element(foils, &seed), other = random_element(foils, &seed);
        bough_induction first = induction_at(&options, &e);
        induction_at(&options, &other);
        bough_induction second = induction_at(&options, &e);
        assert_true(first.axial >= -1 && first.axial <= 1.5);
        assert_true(first.tangential >= -1 && first.tangential <= 1);
        assert_true(first.axial == second.axial && first.tangential == second.tangential);
        evaluations += first.evaluations;
        worst = first.evaluations > worst ? first.evaluations : worst;
    }
    print_message("evaluations: %.1f on average, at most %ld\n", (double)evaluations / 1e5, worst);
    assert_true(worst < 130);
}

// Side by side or one by one: the same search. A residual that is close to zero on both sides of a
// double root may fall out differently; none does here.
TEST(lanes_give_what_one_gives) {
    airfoils *foils = *context;
    enum { N = 40, TIMES = 2000 };
    unsigned seed = 3;
    for (int n = 0; n < TIMES; n++) {
        bough_induction_options options = bough_induction_options_default();
        if (n % 2) options.high_thrust = BOUGH_HIGH_THRUST_BUHL;
        if (n % 3 == 0) options.tip_loss = options.tangential_drag = false;
        if (n % 7 < 3) options.skewed_momentum = true;
        double skew = n % 7 == 0 ? 0 : sample_between(&seed, 0, 1.5);
        if (n % 5 == 0) options.hub_loss = options.tangential = false;
        bough_element e[N];
        const bough_polar *polar[N];
        double value[9][N], axial[N], tangential[N], loss[N];
        for (int i = 0; i < N; i++) {
            e[i] = random_element(foils, &seed);
            e[i].skew = skew;
            e[i].skew_normal = sample_between(&seed, -0.05, 0.05);
            e[i].skew_chord = sample_between(&seed, 0, 0.01);
            if (n % 4 == 0) e[i].inflow_x = fabs(e[i].inflow_x), e[i].twist *= 0.1;
            polar[i] = e[i].polar;
            const double row[9] = {e[i].solidity, e[i].tip_factor,  e[i].hub_factor,
                                   e[i].cone,     e[i].twist,       e[i].inflow_x,
                                   e[i].inflow_y, e[i].skew_normal, e[i].skew_chord};
            for (int c = 0; c < 9; c++) value[c][i] = row[c];
        }
        bough_elements all = {N,        polar,    value[0], value[1], value[2], value[3],
                              value[4], value[5], value[6], value[7], value[8], skew};
        BOUGH_OF_LEVEL(bough_induction_solve, bough_level_chosen())(&options, &all, axial, tangential, loss);
        for (int i = 0; i < N; i++) {
            bough_induction one = induction_at(&options, e + i);
            check_near(axial[i], one.axial, 1e-8, 1e-9);
            check_near(tangential[i], one.tangential, 1e-8, 1e-9);
            check_near(loss[i], one.loss, 1e-8, 1e-9);
        }
    }
}

// A rotor seen from behind, or turning the other way, is the mirrored rotor.
TEST(mirrored_flow_gives_same_induction) {
    airfoils *foils = *context;
    bough_induction_options options = bough_induction_options_default();
    unsigned seed = 7;
    for (int n = 0; n < 1000; n++) {
        bough_element e = random_element(foils, &seed);
        e.polar = &foils->plate; // symmetric in both ways
        bough_induction i = induction_at(&options, &e);
        e.inflow_x = -e.inflow_x;
        e.twist = -e.twist;
        bough_induction back = induction_at(&options, &e);
        check_near(back.axial, i.axial, 1e-6, 1e-8);
        check_near(back.tangential, i.tangential, 1e-6, 1e-8);
    }
}

GROUP(set_up, airfoils_drop)

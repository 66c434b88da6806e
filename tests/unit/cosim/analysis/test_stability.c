// The verdict on a coupling by its eigenvalues: the limits of the two-mass oscillator, which long
// runs confirm (test_scheme.c), within 2 %.
#include "tests/unit/contract.h"
#include "tests/unit/two_mass.h"

static void build(bough_two_mass *m, const char *scheme, double macro_step) {
    check_ok(bough_two_mass_build(check_memory(), m, two_mass_def(scheme, macro_step, 10)));
}

static bough_stability judge(const bough_two_mass *m, const bough_scheme_options *options, double h) {
    bough_stability result;
    check_ok(bough_stability_judge(m->master->assembly, options, h, &result));
    return result;
}

static void check_limit(const bough_two_mass *m, const bough_scheme_options *options, double limit) {
    assert_true(judge(m, options, .98 * limit).growth < 0);
    assert_true(judge(m, options, 1.02 * limit).growth > 0);
}

TEST(limits_come_out_of_the_eigenvalues) {
    bough_scheme_options options = bough_scheme_options_default();
    bough_two_mass m = bough_two_mass_default();
    build(&m, "ramp", .01);
    options.name = "frozen";
    check_limit(&m, &options, polynomial_limits[2].limit[0]);
    for (int k = 0; k < 3; k++) {
        options.name = polynomial_limits[k].scheme;
        for (options.order = 0; options.order < 3; options.order++) {
            check_limit(&m, &options, polynomial_limits[k].limit[options.order]);
        }
    }
}

// Masses, and springs and dampers from wall to wall, with the macro steps that were searched [s].
static const struct {
    double mass[2], stiffness[3], damping[3], from, to;
} systems[] = {{{1, 1}, {10, 10, 20}, {.2, .5, .3}, .02, .6},
               {{1, 1}, {1, 1, 1}, {.1, .1, .1}, .1, 3},
               {{1, .01}, {1, 1, .01}, {.1, .1, .001}, .05, 3}};

#define MOTION_OUT BOUGH_CUT_DISPLACEMENT_DISPLACEMENT
#define FORCES_IN BOUGH_CUT_FORCE_FORCE
#define AT_ONCE "polynomial-at-once"

// Largest stable macro steps by degree, from the same program; 0: none was found.
static const struct {
    int system;
    bough_cut cut;
    const char *scheme;
    double limit[3];
} limits[] = {{0, MOTION_OUT, AT_ONCE, {.3187, .2673, .2066}},
              {0, FORCES_IN, AT_ONCE, {.1279, .1984, .2316}},
              {1, 0, AT_ONCE, {.4039, .6300, .7648}},
              {1, 0, "polynomial", {.4020, .7630, .8427}},
              {1, 0, "polynomial-reversed", {.4020, .7616, .8429}},
              {1, MOTION_OUT, AT_ONCE, {.6275, .7545, .7780}},
              {1, MOTION_OUT, "polynomial", {0, 1.2558, 1.0929}},
              {1, FORCES_IN, AT_ONCE, {.3008, .5724, .7206}},
              {2, 0, AT_ONCE, {1.2264, .9915, .5256}},
              {2, 0, "polynomial", {0, 0, 0}},
              {2, 0, "polynomial-reversed", {0, 1.7240, 1.1916}},
              {2, MOTION_OUT, AT_ONCE, {1.6308, 1.0581, .4636}},
              {2, FORCES_IN, AT_ONCE, {.1967, .1085, .0586}}};

// The verdict, and the eigenvalues of a macro step that the run takes.
static void check_step(bough_two_mass *m, double h, bool stable) {
    double radius;
    check_ok(bough_two_mass_radius(m, h, &radius));
    assert_int_equal(radius <= 1 + 1e-9, stable);
    assert_int_equal(judge(m, &m->master->coupling->options, h).growth < 1e-9, stable);
}

// Stability need not be monotone: every macro step up to the limit is stable.
TEST(limits_depend_on_the_cut_and_the_masses) {
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        const double *mass = systems[limits[k].system].mass, *c = systems[limits[k].system].damping;
        const double *stiffness = systems[limits[k].system].stiffness, from = systems[limits[k].system].from;
        for (int order = 0; order < 3; order++) {
            bough_two_mass m = {.s1 = {mass[0], stiffness[0], c[0]},
                                .s2 = {mass[1], stiffness[2], c[2]},
                                .k = stiffness[1],
                                .c = c[1],
                                .y0 = {1, 0, .5, -1},
                                .cut = limits[k].cut};
            bough_master_def def = two_mass_def(limits[k].scheme, from, 10);
            def.scheme.order = order;
            check_ok(bough_two_mass_build(check_memory(), &m, def));
            double limit = limits[k].limit[order];
            double to = limit > 0 ? .98 * limit : systems[limits[k].system].to;
            for (int i = 0; i <= 10; i++) check_step(&m, from * pow(to / from, i / 10.), true);
            if (limit > 0) check_step(&m, 1.02 * limit, false);
        }
    }
}

// A small macro step shows the slowest mode of the two masses themselves.
TEST(growth_and_frequency_are_those_of_the_slowest_mode) {
    bough_scheme_options options = bough_scheme_options_default();
    options.name = "ramp";
    bough_two_mass m = bough_two_mass_default();
    build(&m, "ramp", .01);
    bough_stability slowest = judge(&m, &options, .005);
    check_near(slowest.growth, -.1406, .01, 0);
    check_near(slowest.frequency, .5916, .01, 0);
    assert_false(bough_stability_grows(&slowest));
}

TEST(ramp_holds_on_a_light_interface_body) {
    bough_scheme_options options = bough_scheme_options_default();
    options.name = "ramp";
    bough_two_mass m = two_mass_light();
    build(&m, "ramp", .02);
    for (int k = 1; k <= 16; k *= 2) assert_true(judge(&m, &options, .005 * k).growth < 0);
    options.name = "gauss-seidel";
    // a sweep turns the sign over and multiplies by more than e^pi
    bough_stability wild = judge(&m, &options, .02);
    assert_true(wild.growth > 3.14159 / .02);
    check_near(wild.frequency, 25, .05, 0);
    options.name = "monolithic";
    bough_stability result;
    bough_status status = bough_stability_judge(m.master->assembly, &options, .02, &result);
    assert_int_equal(status.code, BOUGH_INVALID);
}

// What the iterated scheme converges to is judged, not what its tolerance leaves; growth as runs of
// the two masses show it.
TEST(iterated_is_judged_as_if_converged) {
    bough_scheme_options options = bough_scheme_options_default();
    bough_two_mass m = two_mass_light();
    build(&m, "ramp", .02);
    options.name = "iterated";
    options.accelerator = BOUGH_ACCELERATE_NONE;
    options.exchange = BOUGH_EXCHANGE_END_VALUES;
    options.tolerance = .1;
    check_near(judge(&m, &options, .02).growth, 4.428, .01, 0);
    assert_true(judge(&m, &options, .01).growth < 0);
    options.order = 0;
    for (int k = 1; k <= 8; k *= 2) assert_true(judge(&m, &options, .005 * k).growth < 0);
}

TEST(the_master_warns_of_an_unstable_coupling) {
    bough_two_mass m = bough_two_mass_default();
    build(&m, "gauss-seidel", .25); // the motion interpolated by cubics: holds to .205
    assert_non_null(strstr(m.master->verdict, "gauss-seidel"));
    assert_non_null(strstr(m.master->verdict, "macro_step: 0.125 s is stable"));
    assert_non_null(strstr(m.master->verdict, "scheme: ramp is stable"));
    m = bough_two_mass_default();
    build(&m, "gauss-seidel", .19);
    assert_string_equal(m.master->verdict, "");
}

// A mass pushed away by its wall oscillates with no other: what grows is not the coupling's doing.
TEST(growth_of_the_mechanics_is_no_verdict) {
    bough_two_mass m = bough_two_mass_default();
    m.s1.c = m.s2.c = -.2;
    m.c = 0;
    build(&m, "extrapolated", .01);
    bough_stability now = judge(&m, &m.master->coupling->options, .01);
    check_near(now.growth, .1, .02, 0);
    assert_string_equal(m.master->verdict, "");
}

TEST(judging_changes_nothing) {
    bough_scheme_options options = bough_scheme_options_default();
    options.name = "ramp";
    bough_two_mass m = bough_two_mass_default(), n = bough_two_mass_default();
    build(&m, "ramp", .02);
    build(&n, "ramp", .02);
    for (int k = 0; k < 100; k++) {
        if (k % 10 == 0) judge(&m, &options, .05);
        bough_step(m.master);
        bough_step(n.master);
    }
    assert_memory_equal(m.mass[0].y, n.mass[0].y, sizeof m.mass[0].y);
    assert_memory_equal(m.mass[1].y, n.mass[1].y, sizeof m.mass[1].y);
}

TEST(linear_members_fulfil_the_contract) {
    const double y[2] = {.3, -.7}, u[2] = {.4, .2};
    bough_two_mass m = bough_two_mass_default();
    build(&m, "ramp", .02);
    for (int i = 0; i < 2; i++) {
        bough_member linear_member;
        bough_linear_member_create(m.arena, &m.member[i], u, 5e-3, &linear_member);
        contract_point at = {.t = 0, .state = y, .input = u, .tolerance = 1e-5};
        contract_check(&linear_member, at, .05, .1);
        contract_set_state(&linear_member, at, 1e-4);
    }
}

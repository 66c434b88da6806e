// Weights of a load set's cases and what their sums are, beside formulas by hand.
#include "apps/bough/cases/perform.h"

#include "apps/bough/cases/study.h"
#include "tests/unit/scratch.h"

static const char text[] =
    "kind: load-set\n"
    "scene: scene.yaml\n"
    "slopes: [4, 10]\n"
    "equivalent_cycles: 1e6\n"
    "lifetime: 25\n"
    "wind: {average: 8, shape: 2}\n"
    "channels: [bobPos]\n"
    "cases:\n"
    "  - {name: A, weibull: 0.9, grid: {aero.wind.speed: [6, 8, 12 m/s], x.seed: [1, 2]}}\n"
    "  - {name: B, hours: 50, factor: 1.1, grid: {y: [1, 2, 3, 4]}}\n"
    "  - {name: C, events: 1000, extremes: false, grid: {y: [1, 2]}}\n"
    "  - {name: D, factor: 2}\n";

enum { CASES = 13 };

// The set without its scenes: groups and cases alone.
static bough_study made(bough_case cases[CASES], bough_load_group group[4]) {
    static double slope[] = {4, 10};
    static const char *channel[] = {"load", "other"}, *unit[] = {"kN-m", "rpm"};
    static bool load[] = {true, false};
    bough_study set = {.n_slope = 2,
                       .slope = slope,
                       .cycles = 1e6,
                       .lifetime = 25,
                       .wind = {.average = 8, .shape = 2},
                       .n_group = 2,
                       .group = group,
                       .n_case = 3,
                       .cases = cases,
                       .n_channel = 2,
                       .channel = channel,
                       .unit = unit,
                       .load = load};
    group[0] = (bough_load_group){.hours = 50, .factor = 1.5, .favourable = 0.9, .extremes = true};
    group[1] = (bough_load_group){.events = 100, .factor = 1, .favourable = 0.9, .extremes = true};
    cases[0] = (bough_case){.group = 0, .fraction = 0.5};
    cases[1] = (bough_case){.group = 0, .fraction = 0.5};
    cases[2] = (bough_case){.group = 1, .fraction = 1};
    return set;
}

#define check_set(arena, set, cases, group)                                                                  \
    check_arena(arena);                                                                                      \
    bough_case cases[CASES];                                                                                 \
    bough_load_group group[4];                                                                               \
    bough_study set = made(cases, group)

// A result of a sine of range 2a about m over n periods, sampled 8 times each, every 0.5 s.
static bough_case_result sine(bough_arena *arena, const bough_study *set, double m, double a, int n) {
    bough_case_result r = bough_case_take(arena, set);
    for (int i = 0; i <= 8 * n; i++) {
        const double value[2] = {m + a * cos(0.25 * 3.14159265358979323846 * i), i};
        bough_counts_add(&r.counts, 0.5 * i, value);
    }
    bough_counts_finish(&r.counts);
    r.counted = r.time = 4. * n;
    r.done = true;
    return r;
}

TEST(sums_are_those_by_hand) {
    check_set(arena, set, cases, group);
    bough_lifetime l = bough_lifetime_take(arena, &set);
    const double amplitude[3] = {1, 3, 5}, mean[3] = {0, 10, 0};
    for (int i = 0; i < 3; i++) {
        bough_case_result r = sine(arena, &set, mean[i], amplitude[i], 20);
        bough_lifetime_add(&l, i, &r);
    }
    // Two cases with 25 hours a year each, in runs of 80 s with 20 cycles; 100 events a year.
    double runs = 25 * 25 * 3600 / 80., events = 2500;
    for (int k = 0; k < 2; k++) {
        double m = set.slope[k];
        double damage = 20 * (runs * (pow(2, m) + pow(6, m)) + events * pow(10, m));
        check_near(bough_lifetime_equivalent(&l, 0, k), pow(damage / 1e6, 1 / m), 1e-12, 0);
    }
    check_near(l.channel[0].cycles, 20 * (2 * runs + events), 1e-12, 0);
    check_near(l.hours, 2 * 625 + events * 80 / 3600, 1e-12, 0);
    double hours = 0;
    for (int64_t k = l.channel[0].levels.low; k <= l.channel[0].levels.high; k++)
        hours += bough_levels_inside(&l.channel[0].levels, k);
    check_near(hours, l.hours, 1e-12, 0);
    // Factors count: 1.5·13 stands above 1·5, −5 below 1.5·(−1).
    check_near(l.channel[0].most.value, 13, 1e-14, 0);
    check_near(l.channel[0].most.factor, 1.5, 0, 0);
    assert_int_equal(l.channel[0].most.number, 1);
    check_near(l.channel[0].least.value, -5, 1e-14, 0);
    assert_int_equal(l.channel[0].least.number, 2);
    check_near(l.channel[0].least.at, 2, 1e-14, 0);
    check_near(l.channel[0].least.row[1], 4, 1e-14, 0); // the other channel then
    check_near(l.missing, 0, 0, 0);
}

TEST(what_is_missing_is_reported) {
    check_set(arena, set, cases, group);
    bough_lifetime l = bough_lifetime_take(arena, &set);
    bough_case_result good = sine(arena, &set, 0, 1, 5), failed = good, missing = good;
    failed.outcome = bough_fail(BOUGH_FAILED, "broke");
    missing.done = false;
    group[1] = (bough_load_group){.hours = 150, .factor = 1, .favourable = 0.9, .extremes = true};
    l = bough_lifetime_take(arena, &set);
    bough_lifetime_add(&l, 0, &good);
    bough_lifetime_add(&l, 1, &failed);
    bough_lifetime_add(&l, 2, &missing);
    assert_int_equal(l.n_failed, 1);
    assert_int_equal(l.n_missing, 1);
    check_near(l.missing, 1 - 25. / 200, 1e-12, 0);
}

// A message may fill its buffer.
TEST_IN_FOLDER(the_longest_message_is_kept) {
    check_set(arena, set, cases, group);
    bough_case_result r = sine(arena, &set, 0, 1, 5), again = r;
    char longest[BOUGH_MESSAGE];
    memset(longest, 'm', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    r.outcome = bough_fail(BOUGH_FAILED, "%s", longest);
    cases[0].settings = "";
    check_ok(bough_store_open(*context));
    check_ok(bough_store_write(*context, &set, cases, &r));
    check_ok(bough_store_read(*context, &set, cases, &again));
    assert_string_equal(again.outcome.message, longest);
}

// Companions of the first two cases: an equivalent load that is larger by its error for each.
TEST(errors_are_those_of_companions) {
    check_set(arena, set, cases, group);
    bough_lifetime l = bough_lifetime_take(arena, &set);
    assert_true(isnan(bough_lifetime_equivalent_error(&l, 0, 0)));
    const double amplitude[3] = {1, 3, 5}, larger[2] = {1.01, 1.02};
    for (int i = 0; i < 3; i++) {
        bough_case_result r = sine(arena, &set, i < 2 ? 0 : -4, amplitude[i], 20);
        r.has_companion = i < 2;
        if (i < 2) r.load_error[0] = (bough_load_error){.least = 0.1, .most = 0.2 * i};
        for (int k = 0; k < 2 && i < 2; k++) {
            double damage = r.counts.channel[0].rainflow.damage[k];
            r.load_error[0].damage[k] = damage;
            r.load_error[0].larger[k] = damage * pow(larger[i], set.slope[k]);
        }
        bough_lifetime_add(&l, i, &r);
    }
    for (int k = 0; k < 2; k++) {
        double m = set.slope[k], load = pow(2, m) + pow(6, m);
        double with_error = pow(2 * 1.01, m) + pow(6 * 1.02, m);
        double relative = pow(with_error / load, 1 / m) - 1;
        check_near(bough_lifetime_equivalent_error(&l, 0, k), relative * bough_lifetime_equivalent(&l, 0, k),
                   1e-10, 0);
    }
    // The largest value is of the first load case, the smallest of the second, which has no companion.
    const double squares = 4 + 36;
    assert_int_equal(l.channel[0].most.number, 1);
    check_near(bough_lifetime_extreme_error(&l, 0, &l.channel[0].most), sqrt(0.04 / squares) * 6, 1e-12, 0);
    assert_int_equal(l.channel[0].least.number, 2);
    check_near(bough_lifetime_extreme_error(&l, 0, &l.channel[0].least), sqrt(0.02 / squares) * 10, 1e-12, 0);
    // A channel whose companions show no error has none.
    check_near(bough_lifetime_extreme_error(&l, 1, &l.channel[1].most), 0, 0, 0);
    check_near(bough_lifetime_equivalent_error(&l, 1, 0), 0, 0, 0);
}

static bough_study *read_with(bough_arena *arena, const char *line, bough_errors *errors) {
    char with[2000];
    snprintf(with, sizeof with, "%s%s", line, text);
    bough_node *root = bough_text_parse(arena, "set.yaml", with, strlen(with), errors);
    return bough_study_parse(arena, "set.yaml", root, errors);
}

// Which cases have a companion depends on their numbers alone.
TEST(companions_are_spread_by_number) {
    static const struct {
        const char *line;
        int every;
    } sets[] = {{"", 20}, {"companions: 1 in 3\n", 3}, {"companions: all\n", 1}, {"companions: none\n", 0}};
    check_arena(arena);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        bough_errors errors = {.arena = arena};
        bough_study *set = read_with(arena, sets[i].line, &errors);
        assert_non_null(set);
        for (int k = 0; k < set->n_case; k++) {
            bool has_one = sets[i].every > 0 && k % sets[i].every == 0;
            assert_string_equal(set->cases[k].set[0], has_one ? "simulation.error_estimate=companion"
                                                              : "simulation.error_estimate=none");
        }
    }
    static const char *const bad[] = {"companions: 1 in 0\n", "companions: 20\n", "companions: [all]\n"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        bough_errors errors = {.arena = arena};
        assert_null(read_with(arena, bad[i], &errors));
        assert_non_null(strstr(errors.item[0].text, "expected '1 in N'"));
    }
}

// A load of 7 to 13 and one of -13 to -7: what is nearest to zero relieves. A speed of 0 to 160 and what else
// there is at that moment have no factor.
TEST(factors_are_of_loads_and_on_the_safe_side) {
    check_set(arena, set, cases, group);
    for (int sign = -1; sign <= 1; sign += 2) {
        bough_lifetime l = bough_lifetime_take(arena, &set);
        bough_case_result r = sine(arena, &set, 10 * sign, 3, 20);
        bough_lifetime_add(&l, 0, &r);
        const bough_lifetime_channel *load = &l.channel[0], *speed = &l.channel[1];
        const bough_extreme *near = sign > 0 ? &load->least : &load->most;
        const bough_extreme *far = sign > 0 ? &load->most : &load->least;
        check_near(near->value, 7 * sign, 1e-14, 0);
        check_near(near->factor, 0.9, 0, 0);
        check_near(far->value, 13 * sign, 1e-14, 0);
        check_near(far->factor, 1.5, 0, 0);
        check_near(speed->most.value, 160, 0, 0);
        check_near(speed->most.factor, 1, 0, 0);
        check_near(speed->most.row[0], 10 * sign + 3, 1e-14, 0);
        check_near(speed->least.factor, 1, 0, 0);
    }
}

// Shares of the hours: bins half way between the speeds of a Rayleigh distribution.
TEST(speeds_weigh_by_weibull) {
    check_arena(arena);
    bough_errors errors = {.arena = arena};
    bough_node *root = bough_text_parse(arena, "set.yaml", text, strlen(text), &errors);
    bough_study *set = bough_study_parse(arena, "set.yaml", root, &errors);
    bough_errors_print(&errors, stderr);
    assert_non_null(set);
    assert_int_equal(set->n_case, CASES);
    const double edge[4] = {5, 7, 10, 14};
    for (int i = 0; i < 3; i++) {
        double below = exp(-0.25 * 3.14159265358979323846 * pow(edge[i] / 8, 2));
        double above = exp(-0.25 * 3.14159265358979323846 * pow(edge[i + 1] / 8, 2));
        for (int seed = 0; seed < 2; seed++) {
            double weight = bough_case_weight(set, &set->cases[2 * i + seed], 600);
            check_near(weight, 0.5 * (below - above) * 0.9 * 8766 * 25 * 6, 1e-12, 0);
        }
    }
    check_near(bough_case_weight(set, &set->cases[6], 600), 50 * 25 * 6 / 4., 1e-12, 0);
    check_near(bough_case_weight(set, &set->cases[11], 600), 1000 * 25 / 2., 1e-12, 0);
    check_near(bough_case_weight(set, &set->cases[12], 600), 0, 0, 0);
    assert_string_equal(set->cases[3].settings, "speed=8, seed=2");
    check_near(set->group[1].favourable, 0.9, 0, 0);
}

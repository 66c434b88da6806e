#include "cosim/analysis/equilibrium.h"
#include "tests/unit/two_mass.h"

enum { N = 4 };

typedef struct setup {
    bough_two_mass m;
    bough_whole *whole;
    double y[N];
} setup;

static void build(setup *s) {
    s->m = bough_two_mass_default();
    bough_master_def def = bough_master_def_default();
    def.macro_step = def.duration = .1;
    bough_status status = bough_two_mass_build(check_memory(), &s->m, def);
    check_ok(status);
    s->whole = bough_whole_create(s->m.arena, s->m.master->assembly, NULL);
    assert_true(bough_is_ok(&status));
    memcpy(s->y, s->m.y0, sizeof s->y);
}

static bough_equilibrium_report find(setup *s, bough_equilibrium_def def, bough_code code) {
    bough_equilibrium_report report;
    bough_status status = bough_equilibrium_find(s->m.arena, s->whole, &def, s->y, &report);
    assert_int_equal(status.code, code);
    return report;
}

TEST(coupled_masses_come_to_rest) {
    setup s;
    build(&s);
    find(&s, bough_equilibrium_def_default(), BOUGH_OK);
    for (int k = 0; k < N; k++) check_near(s.y[k], 0, 0, 1e-9);
}

// The first mass held at 0.3: springs of 10 and 20 share it at the second.
TEST(held_states_stay) {
    const int held[2] = {0, 1};
    setup s;
    build(&s);
    s.y[0] = .3;
    bough_whole_hold(s.m.arena, s.whole, 2, held);
    find(&s, bough_equilibrium_def_default(), BOUGH_OK);
    check_near(s.y[0], .3, 0, 0);
    check_near(s.y[1], 0, 0, 0);
    check_near(s.y[2], .3 * 10 / 30, 0, 1e-9);
    check_near(s.y[3], 0, 0, 1e-9);
}

TEST(too_few_steps_are_reported) {
    setup s;
    build(&s);
    bough_equilibrium_def def = bough_equilibrium_def_default();
    def.steps = 2;
    bough_equilibrium_report report = find(&s, def, BOUGH_FAILED);
    assert_int_equal(report.steps, 2);
    assert_true(report.change > 0);
}

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
    check_ok(bough_two_mass_build(check_memory(), &s->m, def));
    s->whole = bough_whole_create(s->m.arena, s->m.master->assembly, NULL);
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

static int linearised; // members, since it was set to 0
static const bough_system_ops *uncounted;

static bool linearise(void *self, double t, const double *state, const double *input, void *factors) {
    linearised++;
    return uncounted->linearise(self, t, state, input, factors);
}

TEST(kept_factors_serve_a_state_near_and_others_are_replaced) {
    setup s;
    build(&s);
    bough_assembly *a = s.m.master->assembly;
    bough_equilibrium_def def = bough_equilibrium_def_default();
    uncounted = a->member[0]->system.ops;
    bough_system_ops counted = *uncounted;
    counted.linearise = linearise;
    for (int i = 0; i < a->n_member; i++) {
        assert_ptr_equal(a->member[i]->system.ops, uncounted);
        a->member[i]->system.ops = &counted;
    }
    assert_true(find(&s, def, BOUGH_OK).kept);
    assert_true(linearised > 0);
    def.step = BOUGH_EQUILIBRIUM_LONGEST;
    for (int k = 0; k < N; k++) s.y[k] = .01 * (k + 1);
    int steps = find(&s, def, BOUGH_OK).steps;
    def.kept = true;
    for (int foreign = 0; foreign < 2; foreign++) {
        linearised = 0;
        for (int k = 0; k < N; k++) s.y[k] = .01 * (k + 1);
        bough_whole_inputs(s.whole, 0, s.y);
        // of a step that is much shorter
        if (foreign) check_ok(bough_whole_setup(s.whole, 0, s.y, s.whole->input, 1e-3));
        int taken = find(&s, def, BOUGH_OK).steps;
        for (int k = 0; k < N; k++) check_near(s.y[k], 0, 0, 1e-9);
        assert_int_equal(linearised > a->n_member, foreign);
        assert_true(!foreign || taken == steps);
    }
}

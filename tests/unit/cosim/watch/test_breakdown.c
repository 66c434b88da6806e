// A member that breaks down within a macro step: two masses, of which the first cannot be moved far.
#include "cosim/watch/monitor.h"
#include "tests/unit/two_mass.h"

#include <stdlib.h>

static bough_integrator_ops fragile; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static bough_status (*whole)(void *self, double *t, double pause, double t1, bool restart, double *y);

static bough_status advance(void *self, double *t, double pause, double t1, bool restart, double *y) {
    const bough_oscillator *o = self;
    if (!(fabs(o->y[0]) < .6)) return bough_fail(BOUGH_FAILED, "mass1 at t = %g s: torn", t1);
    return whole(self, t, pause, t1, restart, y);
}

// Runs to the failure.
static bough_status run(bough_two_mass *m, double macro_step, double start, bool judged) {
    bough_master_def def = bough_master_def_default();
    def.scheme.name = "gauss-seidel";
    def.macro_step = macro_step;
    def.duration = 1000;
    *m = bough_two_mass_default();
    m->y0[0] = start;
    bough_status status = bough_two_mass_build(check_memory(), m, def);
    check_ok(status);
    fragile = *m->member[0].integrator.ops;
    whole = fragile.advance;
    fragile.advance = advance;
    m->member[0].integrator.ops = &fragile;
    if (!judged) m->master->advice = (bough_stability_advice){0};
    while (bough_is_ok(&status) && !bough_master_done(m->master)) status = bough_step(m->master);
    check_fails(status, BOUGH_FAILED, "mass1 at t = ");
    return status;
}

// Gauss–Seidel holds to 0.205 s; at 0.25 s its error grows as the eigenvalues of the macro step say,
// whether that was known before the run or is found after it.
TEST(a_growing_coupling_is_the_cause) {
    for (int judged = 0; judged < 2; judged++) {
        bough_two_mass m;
        bough_status status = run(&m, .25, 0, judged == 1);
        const char *at = strstr(status.message, "grows by a factor of ");
        assert_non_null(at);
        double factor = strtod(at + strlen("grows by a factor of "), NULL), radius;
        assert_non_null(strstr(at, "try macro_step: 0.125 s or scheme: monolithic"));
        assert_non_null(strstr(status.message, "(scheme gauss-seidel, macro step 0.25 s from "));
        fragile.advance = whole;
        check_ok(bough_two_mass_radius(&m, .25, &radius));
        check_near(factor, radius, 1e-2, 0);
    }
}

// A stable coupling is not blamed.
TEST(a_sound_coupling_is_not) {
    bough_two_mass m;
    bough_status status = run(&m, .02, .7, true);
    assert_null(strstr(status.message, "grows"));
    assert_non_null(strstr(status.message, "; try scheme: monolithic"));
}

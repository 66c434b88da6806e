// The two-mass oscillator for tests: its runs, and an exact run that must succeed.
#pragma once

#include "tests/unit/check.h"
#include "tests/verification/two_mass.h"

static inline bough_master_def two_mass_def(const char *scheme, double macro_step, double duration) {
    bough_master_def def = bough_master_def_default();
    def.scheme.name = scheme;
    def.macro_step = macro_step;
    def.duration = duration;
    return def;
}

// Mass 1 without a spring of its own and 1e-4 of mass 2: 59 times lighter than what it moves.
static inline bough_two_mass two_mass_light(void) {
    bough_two_mass m = bough_two_mass_default();
    m.s1 = (bough_spring_mass){1e-4, 0, 0};
    return m;
}

static inline double two_mass_error(bough_two_mass *m) {
    double worst;
    check_ok(bough_two_mass_error(m, &worst));
    return worst;
}

// With 3 ports on either side: the leader takes the sum of three forces and sends (v, x, x), a
// follower takes the mean of the two positions.
static inline void oscillator_widen(bough_oscillator *leader, bough_oscillator *follower) {
    for (int j = 1; j < 3; j++) leader->b[1][j] = leader->b[1][0];
    leader->c[2][0] = leader->c[1][0];
    leader->n_input = leader->n_output = 3;
    follower->b[1][1] /= 2;
    follower->d[0][1] /= 2;
    follower->b[1][2] = follower->b[1][1];
    follower->d[0][2] = follower->d[0][1];
    follower->n_input = 3;
}

// Largest stable macro steps of the polynomials of scheme_polynomial.c by degree, from an independent program
// [s].
static const struct {
    const char *scheme;
    double limit[3];
} polynomial_limits[] = {{"polynomial", {.0777, .3175, .2839}},
                         {"polynomial-reversed", {.0777, .3069, .2831}},
                         {"polynomial-at-once", {.2254, .2277, .2501}}};

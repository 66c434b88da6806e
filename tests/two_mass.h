// The two-mass oscillator coupled by a scheme, and its exact solution.
#ifndef BOUGH_TESTS_TWO_MASS_H
#define BOUGH_TESTS_TWO_MASS_H

#include "cosim/master.h"
#include "tests/check.h"
#include "tests/oscillator.h"

typedef struct two_mass {
    spring s1, s2;
    double k, c;  // coupling
    double y0[4]; // (x1, v1, x2, v2) at time 0
    bool kinematic;
    oscillator mass[2];
    bough_subsystem subsystem[2];
    bough_arena *arena;
    bough_master *master;
} two_mass;

// The reference case; mass 1 leads.
static inline two_mass two_mass_default(void) {
    return (two_mass){.s1 = {1, 10, .2}, .s2 = {1, 20, .3}, .k = 10, .c = .5, .y0 = {0, 0, .5, 0}};
}

static inline void two_mass_at(const two_mass *m, double t, double y[4]) {
    memcpy(y, m->y0, sizeof m->y0);
    if (t != 0) two_mass_exact(m->s1, m->s2, m->k, m->c, t, y);
}

static inline bough_status two_mass_build(two_mass *m, bough_master_def def) {
    m->mass[0] = oscillator_told_force(m->s1, m->y0[0]);
    m->mass[1] = oscillator_told_motion(m->s2, m->k, m->c, m->y0[2]);
    m->mass[0].y[1] = m->y0[1];
    m->mass[1].y[1] = m->y0[3];
    m->subsystem[0] = oscillator_subsystem(&m->mass[0], "mass1");
    m->subsystem[1] = oscillator_subsystem(&m->mass[1], "mass2");
    bough_member member[2] = {{&m->subsystem[0], 0}, {&m->subsystem[1], 1}};
    bough_connection connection[2] = {
        {.from = 0, .to = 1, .count = 2, .kinematic = m->kinematic},
        {.from = 1, .to = 0, .count = 1},
    };
    def.assembly = (bough_assembly_def){
        .n_member = 2, .member = member, .n_connection = 2, .connection = connection};
    m->arena = bough_arena_create();
    return bough_master_build(m->arena, &def, &m->master);
}

static inline void two_mass_destroy(two_mass *m) {
    bough_arena_destroy(m->arena);
    m->arena = NULL;
}

// Replaces the start-up by exact history.
static inline void two_mass_history(two_mass *m) {
    bough_coupling *c = m->master->coupling;
    c->n_past = BOUGH_HISTORY;
    for (int p = 0; p < BOUGH_HISTORY; p++) {
        double y[4];
        c->past_time[p] = -p * m->master->macro_step;
        two_mass_at(m, c->past_time[p], y);
        c->past[p][0] = m->k * (y[2] - y[0]) + m->c * (y[3] - y[1]);
        c->past[p][1] = y[1];
        c->past[p][2] = y[0];
    }
}

// Largest error of either position at the synchronisation points; the run must succeed.
static inline double two_mass_error(two_mass *m) {
    double worst = 0, y[4];
    memcpy(y, m->y0, sizeof y);
    while (!bough_master_done(m->master)) {
        double t = m->master->time;
        bough_status status = bough_step(m->master);
        if (!bough_is_ok(&status)) fail_msg("%s", status.message);
        two_mass_exact(m->s1, m->s2, m->k, m->c, m->master->time - t, y);
        worst = fmax(worst, fmax(fabs(m->mass[0].y[0] - y[0]), fabs(m->mass[1].y[0] - y[2])));
    }
    return worst;
}

#endif

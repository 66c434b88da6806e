#include "tests/verification/two_mass.h"

#include "core/base/linalg.h"

bough_two_mass bough_two_mass_default(void) {
    return (bough_two_mass){.s1 = {1, 10, .2}, .s2 = {1, 20, .3}, .k = 10, .c = .5, .y0 = {0, 0, .5, 0}};
}

// -- exact solution -------------------------------------------------------------------------------

// Taylor series over short steps.
void bough_two_mass_exact(const bough_two_mass *m, double duration, double y[4]) {
    bough_spring_mass s1 = m->s1, s2 = m->s2;
    double rate =
        sqrt((s1.k + m->k) / s1.m + (s2.k + m->k) / s2.m) + (s1.c + m->c) / s1.m + (s2.c + m->c) / s2.m + 1;
    int n = (int)ceil(fabs(duration) * rate);
    double h = duration / n;
    for (int step = 0; step < n; step++) {
        double z[4] = {y[0], y[1], y[2], y[3]};
        for (int p = 1; p < 24; p++) {
            double force = m->k * (z[2] - z[0]) + m->c * (z[3] - z[1]);
            double next[4] = {z[1], (force - s1.k * z[0] - s1.c * z[1]) / s1.m, z[3],
                              (-force - s2.k * z[2] - s2.c * z[3]) / s2.m};
            for (int i = 0; i < 4; i++) {
                z[i] = next[i] * h / p;
                y[i] += z[i];
            }
        }
    }
}

void bough_two_mass_at(const bough_two_mass *m, double t, double y[4]) {
    memcpy(y, m->y0, sizeof m->y0);
    bough_two_mass_exact(m, t, y);
}

// -- building -------------------------------------------------------------------------------------

static void make_masses(bough_two_mass *m) {
    const double *y = m->y0;
    if (m->cut == BOUGH_CUT_DISPLACEMENT_DISPLACEMENT) {
        m->mass[0] = bough_oscillator_motion_in_and_out(m->s1, m->k, m->c, y[0]);
        m->mass[1] = bough_oscillator_motion_in_and_out(m->s2, m->k, m->c, y[2]);
    } else {
        m->mass[0] = bough_oscillator_force_in(m->s1, 1, y[0]);
        m->mass[1] = m->cut == BOUGH_CUT_FORCE_FORCE ? bough_oscillator_force_in(m->s2, -1, y[2])
                                                     : bough_oscillator_motion_in(m->s2, m->k, m->c, y[2]);
    }
    m->mass[2] = bough_oscillator_link(m->k, m->c);
    m->mass[0].y[1] = y[1];
    m->mass[1].y[1] = y[3];
    static const char *const names[3] = {"mass1", "mass2", "spring"};
    for (int i = 0; i < 3; i++) {
        bough_oscillator_member(&m->mass[i], names[i], &m->member[i]);
    }
}

bough_status bough_two_mass_build(bough_arena *arena, bough_two_mass *m, bough_master_def def) {
    bool kin = m->kinematic;
    make_masses(m);
    bough_assembly_member member[3] = {{&m->member[0], 0}, {&m->member[1], 1}, {&m->member[2], 0}};
    bough_connection connection[3][4] = {
        [BOUGH_CUT_FORCE_DISPLACEMENT] = {{.from = 0, .to = 1, .count = 2, .kinematic = kin},
                                          {.from = 1, .to = 0, .count = 1}},
        [BOUGH_CUT_DISPLACEMENT_DISPLACEMENT] = {{.from = 0, .to = 1, .count = 2, .kinematic = kin},
                                                 {.from = 1, .to = 0, .count = 2, .kinematic = kin}},
        [BOUGH_CUT_FORCE_FORCE] = {{.from = 0, .to = 2, .count = 2, .kinematic = kin},
                                   {.from = 1, .to = 2, .to_offset = 2, .count = 2, .kinematic = kin},
                                   {.from = 2, .to = 0, .count = 1},
                                   {.from = 2, .to = 1, .count = 1}},
    };
    bool three = m->cut == BOUGH_CUT_FORCE_FORCE;
    def.assembly = (bough_assembly_def){.n_member = three ? 3 : 2,
                                        .member = member,
                                        .n_connection = three ? 4 : 2,
                                        .connection = connection[m->cut]};
    m->arena = arena;
    return bough_master_build(arena, &def, &m->master);
}

// -- running --------------------------------------------------------------------------------------

static void exact_inputs(const bough_two_mass *m, double t, double *input) {
    double y[4];
    bough_two_mass_at(m, t, y);
    double force = m->k * (y[2] - y[0]) + m->c * (y[3] - y[1]);
    const double inputs[3][6] = {
        [BOUGH_CUT_FORCE_DISPLACEMENT] = {force, y[1], y[0]},
        [BOUGH_CUT_DISPLACEMENT_DISPLACEMENT] = {y[3], y[2], y[1], y[0]},
        [BOUGH_CUT_FORCE_FORCE] = {force, force, y[1], y[0], y[3], y[2]},
    };
    memcpy(input, inputs[m->cut], (size_t)m->master->assembly->n_input * sizeof(double));
}

void bough_two_mass_history(bough_two_mass *m) {
    bough_coupling *c = m->master->coupling;
    c->past.n = BOUGH_HISTORY;
    for (int p = 0; p < BOUGH_HISTORY; p++) {
        c->past.time[p] = -p * m->master->macro_step;
        exact_inputs(m, c->past.time[p], c->past.input[p]);
    }
}

bough_status bough_two_mass_error(bough_two_mass *m, double *worst) {
    double y[4];
    memcpy(y, m->y0, sizeof y);
    *worst = 0;
    while (!bough_master_done(m->master)) {
        double t = m->master->time;
        BOUGH_TRY(bough_step(m->master));
        bough_two_mass_exact(m, m->master->time - t, y);
        *worst = fmax(*worst, fmax(fabs(m->mass[0].y[0] - y[0]), fabs(m->mass[1].y[0] - y[2])));
    }
    return bough_ok();
}

// -- the macro step as a map ----------------------------------------------------------------------

enum { STATES = 4, INPUTS = 6, MOST = STATES + 4 * INPUTS };

static bough_status map_step(bough_two_mass *m, double h, const double *z, double *image) {
    bough_coupling *c = m->master->coupling;
    bough_scheme_load(c, h, z);
    c->t0 = 0;
    c->t1 = h;
    bough_status status = bough_scheme_step(c);
    bough_scheme_store(c, image);
    return status;
}

bough_status bough_two_mass_radius(bough_two_mass *m, double macro_step, double *radius) {
    int n = bough_scheme_n_memory(m->master->coupling);
    double matrix[MOST * MOST] = {0}, column[MOST], unit[MOST];
    double value[2 * MOST], vector[MOST * MOST], work[BOUGH_EIGEN_WORK(MOST)];
    for (int k = 0; k < n; k++) {
        memset(unit, 0, sizeof unit);
        unit[k] = 1;
        BOUGH_TRY(map_step(m, macro_step, unit, column));
        memcpy(matrix + k * n, column, (size_t)n * sizeof(double));
    }
    if (!bough_dense_eigen(n, matrix, value, vector, work)) {
        return bough_fail(BOUGH_FAILED, "the eigenvalues of a macro step were not found");
    }
    *radius = 0;
    for (int k = 0; k < n; k++) *radius = fmax(*radius, hypot(value[k], value[n + k]));
    return bough_ok();
}

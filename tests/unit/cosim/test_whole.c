#include "cosim/whole.h"
#include "tests/unit/two_mass.h"

#include <float.h>

enum { N = 4 };

static void build(bough_two_mass *m, bough_whole **whole, int threads) {
    bough_pool *pool;
    *m = bough_two_mass_default();
    bough_master_def def = bough_master_def_default();
    def.macro_step = def.duration = .1;
    check_ok(bough_two_mass_build(check_memory(), m, def));
    pool = bough_pool_create(m->arena, threads);
    *whole = bough_whole_create(m->arena, m->master->assembly, pool);
}

// A solution is that of a member by itself and what all states follow of its outputs.
TEST(a_member_moves_the_whole_by_its_outputs) {
    bough_whole *whole;
    bough_two_mass m;
    build(&m, &whole, 1);
    const double y[N] = {.1, -.2, .5, .3};
    const bough_assembly *a = whole->assembly;
    int compared = 0;
    check_ok(bough_whole_setup(whole, 0, y, whole->input, .1));
    for (int i = 0; i < a->n_member; i++) {
        const int first = a->output_offset[i], n_output = a->member[i]->system.n_output;
        if (whole->interface->part[i].by_state) continue;
        for (int j = a->state_offset[i]; j < a->state_offset[i + 1]; j++) {
            double x[N] = {0}, sum[N] = {0}, by_one[N], moved[N];
            x[j] = sum[j] = 1;
            bough_whole_solve(whole, x);
            bough_whole_begin_solution(whole, sum);
            bough_whole_solve_of(whole, i);
            memcpy(moved, whole->output_change + first, (size_t)n_output * sizeof *moved);
            for (int o = 0; o < n_output; o++) {
                bough_whole_follow(whole, first + o, by_one);
                for (int k = 0; k < N; k++) sum[k] += moved[o] * by_one[k];
            }
            for (int k = 0; k < N; k++, compared++) check_near(sum[k], x[k], 1e-12, 1e-15);
        }
    }
    assert_true(compared > 0);
}

// The system is linear: (I − γJ) x = r is x − γ (F(y + x) − F(y)) = r.
TEST(solves_the_coupled_system) {
    bough_whole *whole;
    bough_two_mass m;
    build(&m, &whole, 1);
    const double y[N] = {.1, -.2, .5, .3}, r[N] = {1, 2, -3, .5}, gammas[] = {1e-3, .1, 1e4};
    for (size_t g = 0; g < sizeof gammas / sizeof *gammas; g++) {
        double x[N], moved[N], before[N], after[N], gamma = gammas[g];
        memcpy(x, r, sizeof x);
        check_ok(bough_whole_rate(whole, 0, y, before));
        check_ok(bough_whole_setup(whole, 0, y, whole->input, gamma));
        bough_whole_solve(whole, x);
        for (int k = 0; k < N; k++) moved[k] = y[k] + x[k];
        check_ok(bough_whole_rate(whole, 0, moved, after));
        for (int k = 0; k < N; k++) {
            check_near(x[k] - gamma * (after[k] - before[k]), r[k], 1e-9, 1e-12 * gamma);
        }
    }
}

// F of two masses on springs, by hand.
TEST(rates_are_those_of_the_coupled_masses) {
    bough_whole *whole;
    bough_two_mass m;
    build(&m, &whole, 2);
    const double y[N] = {.1, -.2, .5, .3};
    double rate[N], force = m.k * (y[2] - y[0]) + m.c * (y[3] - y[1]);
    check_ok(bough_whole_rate(whole, 0, y, rate));
    check_near(rate[0], y[1], 0, 0);
    check_near(rate[1], -10 * y[0] - .2 * y[1] + force, 1e-14, 0);
    check_near(rate[2], y[3], 0, 0);
    check_near(rate[3], -20 * y[2] - .3 * y[3] - force, 1e-14, 0);
}

// A trial step may leave the range of numbers: of mass 1, which leads, by 20 N/m, of mass 2 not by 10 N/m.
TEST(a_state_without_a_rate_does_not_spoil_the_next_one) {
    bough_whole *whole;
    bough_two_mass m;
    build(&m, &whole, 1);
    const double beyond[N] = {DBL_MAX / 15}, y[N] = {.1, -.2, .5, .3};
    double rate[N];
    check_fails(bough_whole_rate(whole, 0, beyond, rate), BOUGH_FAILED, "no finite rate of change");
    check_ok(bough_whole_rate(whole, 0, y, rate));
}

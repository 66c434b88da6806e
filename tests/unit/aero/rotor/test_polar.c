#include "aero/rotor/polar.h"

#include "tests/unit/nrel5mw_aero.h"

static bough_polar build(bough_arena *arena, const bough_polar_def *def) {
    bough_polar polar;
    bough_polar_build(arena, def, &polar);
    return polar;
}

TEST(knots_are_reproduced) {
    check_arena(arena);
    for (int p = 0; p < 8; p++) {
        bough_polar polar = build(arena, nrel5mw_polars + p);
        for (int i = 0; i < nrel5mw_polars[p].n; i++) {
            const double *row = nrel5mw_polars[p].row + 4 * i;
            bough_coefficients c = bough_polar_at(&polar, row[0] * BOUGH_DEGREE);
            check_near(c.lift, row[1], 1e-11, 1e-11);
            check_near(c.drag, row[2], 1e-11, 1e-11);
            check_near(c.moment, row[3], 1e-11, 1e-11);
        }
    }
}

// Against a plain search of the table.
TEST(interpolation_is_linear) {
    check_arena(arena);
    const bough_polar_def *def = nrel5mw_polars + 7;
    bough_polar polar = build(arena, def);
    for (double a = -179.99; a < 180; a += 0.0371) {
        int i = 0;
        while (i < def->n - 2 && def->row[4 * (i + 1)] < a) i++;
        const double *r = def->row + 4 * i;
        double w = (a - r[0]) / (r[4] - r[0]);
        bough_coefficients c = bough_polar_at(&polar, a * BOUGH_DEGREE);
        check_near(c.lift, r[1] + w * (r[5] - r[1]), 1e-10, 1e-11);
        check_near(c.drag, r[2] + w * (r[6] - r[2]), 1e-10, 1e-11);
        check_near(c.moment, r[3] + w * (r[7] - r[3]), 1e-10, 1e-11);
    }
}

TEST(turns_repeat) {
    check_arena(arena);
    bough_polar polar = build(arena, nrel5mw_polars + 3);
    for (double a = -3; a < 3; a += 0.07) {
        bough_coefficients here = bough_polar_at(&polar, a);
        for (int turn = -3; turn <= 3; turn++) {
            bough_coefficients there = bough_polar_at(&polar, a + 2 * BOUGH_PI * turn);
            check_near(there.lift, here.lift, 1e-11, 1e-12);
            check_near(there.drag, here.drag, 1e-11, 1e-12);
        }
    }
}

// Of states that have run away: no place outside the table is read.
TEST(any_angle_has_an_answer) {
    check_arena(arena);
    bough_polar polar = build(arena, nrel5mw_polars + 3);
    for (double a = 1; a < 1e308; a *= 7) {
        for (int sign = -1; sign <= 1; sign += 2) {
            bough_coefficients here = bough_polar_at(&polar, sign * a);
            assert_true(fabs(here.lift) < 3 && fabs(bough_polar_slope(&polar, sign * a).lift) < 100);
        }
    }
    assert_true(isnan(bough_polar_at(&polar, (double)NAN).lift));
    assert_true(isnan(bough_polar_at(&polar, HUGE_VAL).lift));
}

// A table of less than a turn goes on from its last row to its first.
TEST(gap_is_bridged) {
    const double row[] = {-90, 1, 0, 0, 90, 3, 0, 0};
    check_arena(arena);
    bough_polar polar = build(arena, &(bough_polar_def){.n = 2, .row = row});
    check_near(bough_polar_at(&polar, 180 * BOUGH_DEGREE).lift, 2, 1e-12, 0);
    check_near(bough_polar_at(&polar, -135 * BOUGH_DEGREE).lift, 1.5, 1e-12, 0);
    check_near(bough_polar_at(&polar, 45 * BOUGH_DEGREE).lift, 2.5, 1e-12, 0);
}

// Knots stay, slopes are continuous, and nothing overshoots; across the seam of the turn too. A
// smooth function is met to the third order at least.
TEST(smooth_polars_are_monotone_and_smooth) {
    check_arena(arena);
    for (int p = 0; p < 8; p++) {
        const bough_polar_def *def = nrel5mw_polars + p;
        bough_polar polar = build(arena, def);
        bough_polar_smoothen(arena, &polar);
        for (int i = 0; i + 1 < def->n; i++) {
            const double *r = def->row + 4 * i;
            double a = r[0] * BOUGH_DEGREE, b = r[4] * BOUGH_DEGREE, h = 1e-7;
            check_near(bough_polar_at(&polar, a).lift, r[1], 1e-11, 1e-11);
            double at = bough_polar_at(&polar, a).lift;
            double left = (at - bough_polar_at(&polar, a - h).lift) / h;
            double right = (bough_polar_at(&polar, a + h).lift - at) / h;
            check_near(left, right, 1e-4, 1e-3);
            double low = fmin(r[1], r[5]), high = fmax(r[1], r[5]);
            for (int k = 1; k < 20; k++) {
                double lift = bough_polar_at(&polar, a + (b - a) * k / 20).lift;
                assert_true(lift >= low - 1e-12 && lift <= high + 1e-12);
            }
        }
    }
    double error[2];
    for (int fine = 0; fine < 2; fine++) {
        int n = fine ? 73 : 37;
        double row[4 * 73] = {0};
        error[fine] = 0;
        for (int i = 0; i < n; i++) {
            row[4 * i] = -180 + 360. * i / (n - 1);
            row[4 * i + 1] = sin(row[4 * i] * BOUGH_DEGREE);
        }
        bough_polar polar = build(arena, &(bough_polar_def){.n = n, .row = row});
        bough_polar_smoothen(arena, &polar);
        for (double a = -1; a < 1; a += 0.01) // away from the extrema, where monotony costs order
            error[fine] = fmax(error[fine], fabs(bough_polar_at(&polar, a).lift - sin(a)));
    }
    assert_true(error[0] < 1e-3 && error[1] < error[0] / 6);
}

// A mixture is the mixture of the coefficients at any angle, whatever the knots.
TEST(blends_are_exact) {
    check_arena(arena);
    const double gap[] = {-90, 1, 0.1, 0, 90, 3, 0, 0.2};
    bough_polar a = build(arena, nrel5mw_polars + 2), b = build(arena, nrel5mw_polars + 7), mixed;
    bough_polar c = build(arena, &(bough_polar_def){.n = 2, .row = gap});
    for (int i = 0; i < 3; i++) {
        const bough_polar *other = i == 1 ? &c : &b;
        double share = i == 2 ? 1 : 0.3;
        bough_polar_blend(arena, &a, other, share, &mixed);
        for (double x = -3.5; x < 3.5; x += 0.0317) {
            bough_coefficients p = bough_polar_at(&a, x), q = bough_polar_at(other, x);
            bough_coefficients m = bough_polar_at(&mixed, x);
            check_near(m.lift, (1 - share) * p.lift + share * q.lift, 1e-9, 1e-9);
            check_near(m.drag, (1 - share) * p.drag + share * q.drag, 1e-9, 1e-9);
            check_near(m.moment, (1 - share) * p.moment + share * q.moment, 1e-9, 1e-9);
        }
    }
}

// A table that ends short of the full turn leaves a gap, unless it only lacks a row; of a mixture
// both must have a row at an angle.
TEST(gaps_are_known) {
    static const double part[3][4] = {{-20, -1, 0, 0}, {0, 0, 0, 0}, {25, 1, 0, 0}};
    static const double shifted[3][4] = {{-30, -1, 0, 0}, {0, 0, 0, 0}, {15, 1, 0, 0}};
    check_arena(arena);
    bough_polar a = build(arena, &(bough_polar_def){.n = 3, .row = &part[0][0]});
    bough_polar b = build(arena, &(bough_polar_def){.n = 3, .row = &shifted[0][0]});
    bough_polar whole = build(arena, nrel5mw_polars + 4), mixed;
    for (int k = -4; k <= 4; k++) {
        double turned = 2 * BOUGH_PI * k;
        assert_false(bough_polar_outside_table(&a, turned - 19.9 * BOUGH_DEGREE));
        assert_false(bough_polar_outside_table(&a, turned + 24.9 * BOUGH_DEGREE));
        assert_true(bough_polar_outside_table(&a, turned + 25.1 * BOUGH_DEGREE));
        assert_true(bough_polar_outside_table(&a, turned - 20.1 * BOUGH_DEGREE));
        for (double d = -180; d <= 180; d += 7.5) {
            assert_false(bough_polar_outside_table(&whole, turned + d * BOUGH_DEGREE));
        }
    }
    bough_polar_blend(arena, &a, &b, 0.5, &mixed);
    check_near(mixed.low, -20 * BOUGH_DEGREE, 1e-12, 0);
    check_near(mixed.high, 15 * BOUGH_DEGREE, 1e-12, 0);
    bough_polar_blend(arena, &a, &whole, 0.5, &mixed);
    check_near(mixed.high, 25 * BOUGH_DEGREE, 1e-12, 0);
}

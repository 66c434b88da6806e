#include "aero/rotor/stall.h"

#include "tests/unit/nrel5mw_aero.h"
#include "tests/unit/sample_numbers.h"

#include <complex.h>

typedef struct flow {
    double speed, alpha, rate;
} flow;

typedef struct slopes {
    bough_coefficients angle, rate;
    double fixed;
} slopes;

// Of one section; k may be NULL.
static bough_coefficients advance(const bough_polar *foil, double chord, flow in, double step,
                                  bough_stall_state *state, slopes *k) {
    double row[10][BOUGH_LANES];
    bough_stall_results to = {
        {row[0], row[1], row[2]}, k != NULL, {row[3], row[4], row[5]}, {row[6], row[7], row[8]}, row[9]};
    BOUGH_OF_LEVEL(bough_stall_advance, bough_level_chosen())
    (&(bough_stall_sections){1, &foil, &chord, &in.speed, &in.alpha, &in.rate, state}, step, &to);
    if (k) *k = (slopes){{*row[3], *row[4], *row[5]}, {*row[6], *row[7], *row[8]}, *row[9]};
    return (bough_coefficients){*row[0], *row[1], *row[2]};
}

// Lift 2π(α − 1°) up to 20° from there, without drag.
static const double plate_rows[4][4] = {{-180, 0, 0, 0},
                                        {-19, -20 * 2 * BOUGH_PI *BOUGH_PI / 180, 0, 0},
                                        {21, 20 * 2 * BOUGH_PI *BOUGH_PI / 180, 0, 0},
                                        {180, 0, 0, 0}};

static int set_up(void **state) {
    return airfoils_make(state, &(bough_polar_def){.n = 4, .row = &plate_rows[0][0]});
}

static void check_static(const bough_polar *polar, double alpha, bough_coefficients k) {
    bough_coefficients s = bough_polar_at(polar, alpha);
    check_near(k.lift, s.lift, 1e-8, 1e-8);
    check_near(k.drag, s.drag, 1e-8, 1e-8);
    check_near(k.moment, s.moment, 1e-8, 1e-8);
}

// In equilibrium lift is the mixture of attached and separated, at every angle of every airfoil; f is one
// somewhere in attached flow and zero in deep stall.
TEST(parts_make_the_static_polar) {
    airfoils *a = *context;
    for (int p = 2; p < 8; p++) {
        const bough_polar *foil = a->polar + p;
        double most = 0;
        assert_true(foil->slope > 5 && foil->slope < 9);
        check_near(bough_polar_at(foil, foil->zero_lift).lift, 0, 0, 1e-12);
        for (double alpha = -BOUGH_PI; alpha < BOUGH_PI; alpha += 0.1234 * BOUGH_DEGREE) {
            bough_stall_state s = {0};
            double lift = advance(foil, 3, (flow){50, alpha, 0}, 0, &s, NULL).lift;
            check_near(lift, bough_polar_at(foil, alpha).lift, 0, 1e-9);
            assert_true(s.separation >= 0 && s.separation <= 1);
            if (fabs(alpha) > 60 * BOUGH_DEGREE) check_near(s.separation, 0, 0, 0);
            most = fmax(most, s.separation);
        }
        assert_true(most > 0.95);
    }
    check_near(a->polar[0].slope, 0, 0, 0); // a cylinder
}

// From wherever it comes, steady flow ends on the static polar, with steps of any length.
TEST(steady_limit_is_the_static_polar) {
    airfoils *a = *context;
    for (int p = 0; p < 8; p++) {
        bough_polar foil = a->polar[p];
        for (double angle = -178; angle < 180; angle += 7.3) {
            bough_stall_state s = {0};
            bough_coefficients k = advance(&foil, 3, (flow){50, angle * BOUGH_DEGREE, 0}, 0, &s, NULL);
            check_static(&a->polar[p], angle * BOUGH_DEGREE, k); // started in equilibrium
            advance(&foil, 3, (flow){30, (angle + 170) * BOUGH_DEGREE, 0.3}, 0.02, &s, NULL);
            for (int i = 0; i < 4; i++)
                k = advance(&foil, 3, (flow){50, angle * BOUGH_DEGREE, 0}, 1e3, &s, NULL);
            check_static(&a->polar[p], angle * BOUGH_DEGREE, k);
        }
    }
}

// In the steps of a run: a section that comes from the angle without lift and stays where it is has the
// coefficients of its polar within 20 s, to 1e-3 at every angle of operation; of joined straight lines, of
// cubics, and of mixtures of neighbours.
TEST(a_run_settles_on_the_static_polar) {
    airfoils *a = *context;
    enum { N = 8, STEPS = 1000 };
    bough_polar polar[3 * N - 1];
    memcpy(polar, a->polar, sizeof a->polar);
    for (int i = 0; i < N; i++) {
        bough_polar *smooth = polar + N + i, *mixed = polar + 2 * N + i;
        bough_polar_build(a->arena, nrel5mw_polars + i, smooth);
        bough_polar_smoothen(a->arena, smooth);
        if (i + 1 < N) bough_polar_blend(a->arena, a->polar + i, a->polar + i + 1, 0.4, mixed);
    }
    // all angles side by side
    enum { ANGLES = 101, ROW = 104 };
    double chord[ROW], speed[ROW], from[ROW], alpha[ROW], row[3][ROW], still[ROW] = {0}, worst = 0;
    const bough_polar *foil[ANGLES];
    bough_stall_results to = {.coefficients = {row[0], row[1], row[2]}};
    for (int p = 0; p < 3 * N - 1; p++) {
        bough_stall_state state[ANGLES] = {0};
        for (int i = 0; i < ANGLES; i++) {
            foil[i] = polar + p;
            chord[i] = 3, speed[i] = 50, from[i] = polar[p].zero_lift;
            alpha[i] = (i / 4. - 10) * BOUGH_DEGREE;
        }
        bough_stall_sections s = {ANGLES, foil, chord, speed, from, still, state};
        for (int i = 0; i <= STEPS; i++, s.alpha = alpha)
            BOUGH_OF_LEVEL(bough_stall_advance, bough_level_chosen())(&s, 0.02, &to);
        for (int i = 0; i < ANGLES; i++) {
            bough_coefficients fixed = bough_polar_at(foil[i], alpha[i]);
            worst = fmax(worst, fmax(fabs(row[0][i] - fixed.lift), fabs(row[1][i] - fixed.drag)));
            worst = fmax(worst, fabs(row[2][i] - fixed.moment));
        }
    }
    assert_true(worst < 1e-3);
}

// Attached flow: lift at the reduced frequency k is slope·C(k) with Jones' approximation of
// Theodorsen's function, C = 1 − Σ A ik/(ik + b).
TEST(attached_lift_is_indicial) {
    airfoils *a = *context;
    bough_polar foil = a->plate;
    check_near(foil.slope, 2 * BOUGH_PI, 1e-9, 0);
    check_near(foil.zero_lift, BOUGH_DEGREE, 1e-9, 0);
    const double speed = 40, chord = 2, amplitude = BOUGH_DEGREE;
    const double complex i1 = I;
    for (double k = 0.02; k < 0.7; k *= 2) {
        enum { PER_CYCLE = 400, CYCLES = 60 };
        double omega = 2 * k * speed / chord, step = 2 * BOUGH_PI / omega / PER_CYCLE;
        double complex got = 0, ik = i1 * k;
        double complex c = 1 - 0.165 * ik / (ik + 0.0455) - 0.335 * ik / (ik + 0.3);
        bough_stall_state s = {0};
        for (int i = 0; i <= PER_CYCLE * CYCLES; i++) {
            double phase = 2 * BOUGH_PI * (i % PER_CYCLE) / PER_CYCLE;
            flow inflow = {speed, 4 * BOUGH_DEGREE + amplitude * sin(phase), 0};
            double lift = advance(&foil, chord, inflow, step, &s, NULL).lift;
            if (i > PER_CYCLE * (CYCLES - 1)) got += lift * cexp(-i1 * phase) * 2 / PER_CYCLE;
        }
        double complex expected = -i1 * foil.slope * amplitude * c; // of a sine
        check_near(cabs(got - expected), 0, 0, 1e-4 * cabs(expected));
    }
}

// A rotation that goes on lifts by the downwash at three quarters of the chord and by the apparent
// mass: slope·x + πx with x = c·rate/(2U). The circulation's part stands square to the flow there, and
// the rotation leans it back by x more.
TEST(rotation_lifts) {
    airfoils *a = *context;
    bough_polar foil = a->plate;
    bough_stall_state s = {0};
    bough_coefficients k = {0};
    for (int i = 0; i < 3; i++) k = advance(&foil, 2, (flow){40, 4 * BOUGH_DEGREE, 0.4}, 100, &s, NULL);
    double x = 2 * 0.4 / 80;
    check_near(k.lift, foil.slope * (3 * BOUGH_DEGREE + x) + BOUGH_PI * x, 1e-9, 0);
    check_near(k.drag, foil.slope * (3 * BOUGH_DEGREE + x) * x, 1e-9, 0);
    check_near(k.moment, -BOUGH_PI * x / 2, 1e-9, 0);
}

// Right after a step of the angle of attack, attached, half of the step lies between the angle and
// the effective one: drag (α − α_E) Cl of the circulation.
TEST(withheld_lift_leans_back) {
    airfoils *a = *context;
    bough_polar foil = a->plate;
    bough_stall_state s = {0};
    advance(&foil, 2, (flow){40, 4 * BOUGH_DEGREE, 0}, 0, &s, NULL);
    advance(&foil, 2, (flow){40, 4 * BOUGH_DEGREE, 0}, 100, &s, NULL);
    bough_coefficients k = advance(&foil, 2, (flow){40, 6 * BOUGH_DEGREE, 0}, 1e-7, &s, NULL);
    check_near(k.lift, foil.slope * 4 * BOUGH_DEGREE, 1e-5, 0);
    check_near(k.drag, BOUGH_DEGREE * k.lift, 1e-4, 0);
}

// After a small step of the angle of attack the attached lift follows the polar's own indicial function.
TEST(indicial_lift_is_the_polars) {
    airfoils *a = *context;
    static const double k[] = {0.3, 0.7, 0.14, 0.53};
    const double chord = 2, speed = 40, step = 0.01 * BOUGH_DEGREE;
    bough_polar_def def = {.n = 4, .row = &plate_rows[0][0], .indicial = k};
    bough_polar foil;
    bough_polar_build(a->arena, &def, &foil);
    bough_stall_state s = {0};
    advance(&foil, chord, (flow){speed, 4 * BOUGH_DEGREE, 0}, 0, &s, NULL);
    double before = bough_polar_at(&foil, 4 * BOUGH_DEGREE).lift;
    flow after = {speed, 4 * BOUGH_DEGREE + step, 0};
    advance(&foil, chord, after, 1e-9, &s, NULL);
    for (int i = 1; i <= 10; i++) {
        double lift = advance(&foil, chord, after, 0.5 * chord / speed, &s, NULL).lift;
        double expected = 1 - k[0] * exp(-k[2] * i) - k[1] * exp(-k[3] * i);
        check_near((lift - before) / (foil.slope * step), expected, 0, 1e-6);
    }
}

// Lift against angle over one period, after `cycles`.
typedef struct loop {
    double area;     // ∮ Cl dα, positive: the air does work on the section
    double gap;      // between its ends
    double up, down; // lift at the mean angle
    double highest;
} loop;

static loop run_loop(const bough_polar *foil, double mean, double amplitude, int cycles, int per_cycle) {
    const double speed = 50, chord = 3, k = 0.08, omega = 2 * k * speed / chord;
    double step = 2 * BOUGH_PI / omega / per_cycle, before = 0, angle = mean, first = 0;
    bough_stall_state s = {0};
    loop l = {0};
    for (int i = 0; i <= cycles * per_cycle; i++) {
        double phase = 2 * BOUGH_PI * (i % per_cycle) / per_cycle;
        double alpha = mean + amplitude * sin(phase);
        double lift = advance(foil, chord, (flow){speed, alpha, 0}, step, &s, NULL).lift;
        int last = i - (cycles - 1) * per_cycle;
        if (last == 0) first = l.up = lift;
        if (last > 0) l.area += (lift + before) / 2 * (alpha - angle);
        if (last == per_cycle / 2) l.down = lift;
        if (last >= 0) l.highest = fmax(l.highest, lift);
        before = lift;
        angle = alpha;
    }
    l.gap = fabs(before - first);
    return l;
}

// Pressure and separation go back to equilibrium in 1.7 and 3 semi-chords.
TEST(lags_are_those_of_the_theory) {
    airfoils *a = *context;
    const double lag[] = {1.7, 3}, away = 1e-3, step = 0.01;
    flow in = {20, 14 * BOUGH_DEGREE, 0};
    for (int k = 0; k < 2; k++) {
        bough_stall_state state = {0};
        advance(&a->polar[7], 1, in, 0, &state, NULL);
        double *x = k ? &state.separation : &state.pressure, rest = *x;
        *x += away;
        advance(&a->polar[7], 1, in, step, &state, NULL);
        check_near(*x - rest, away * exp(-2 * in.speed * step / lag[k]), 1e-12, 1e-9);
    }
}

// In stall lift is higher while the angle grows; the loop closes, and halving the step moves it at
// second order.
TEST(stall_loop_is_closed) {
    airfoils *a = *context;
    bough_polar foil = a->polar[7];
    loop coarse = run_loop(&foil, 12 * BOUGH_DEGREE, 5 * BOUGH_DEGREE, 6, 200);
    loop middle = run_loop(&foil, 12 * BOUGH_DEGREE, 5 * BOUGH_DEGREE, 6, 400);
    loop fine = run_loop(&foil, 12 * BOUGH_DEGREE, 5 * BOUGH_DEGREE, 6, 800);
    assert_true(fine.gap < 1e-6);
    assert_true(fine.up > fine.down + 0.1);
    double most = 0;
    for (double d = 7; d <= 17; d += 0.1)
        most = fmax(most, bough_polar_at(&a->polar[7], d * BOUGH_DEGREE).lift);
    assert_true(fine.highest > most + 0.05); // stall is late
    print_message("loop: up %.4f, down %.4f, highest %.4f (static %.4f), area %.5f\n", fine.up, fine.down,
                  fine.highest, most, fine.area);
    double ratio = (coarse.area - middle.area) / (middle.area - fine.area);
    assert_true(ratio > 3 && ratio < 5);
}

// The slopes are those of an advance from the same state whose angle or rotation differs, in attached,
// stalled and partly static flow. A step of a hundredth of a chord leaves the separation as it is.
TEST(slopes_are_those_of_an_advance) {
    airfoils *a = *context;
    const double chord = 3, step = 6e-4, d = 1e-3, turning = 0.2;
    static const double angle[] = {4.03, 13.03, 24.03, 43.03, -45.03, 75.03};
    for (int p = 0; p < 8; p++) {
        bough_polar foil = a->polar[p];
        for (int i = 0; i < 6; i++) {
            double alpha = angle[i] * BOUGH_DEGREE;
            bough_stall_state before = {0};
            flow inflow = {50, alpha - 3 * BOUGH_DEGREE, 0};
            advance(&foil, chord, inflow, 0, &before, NULL);
            bough_coefficients change[2][2];
            for (int k = 0; k < 4; k++) {
                double by = k % 2 == 0 ? -d / 2 : d / 2;
                bough_stall_state s = before;
                inflow = (flow){50, alpha + (k < 2 ? by : 0), turning + (k < 2 ? 0 : 20 * by)};
                change[k / 2][k % 2] = advance(&foil, chord, inflow, step, &s, NULL);
            }
            bough_stall_state s = before;
            inflow = (flow){50, alpha, turning};
            slopes k;
            advance(&foil, chord, inflow, step, &s, &k);
            check_near(k.fixed, bough_polar_slope(&foil, alpha).lift, 0, 0);
            const bough_coefficients slope[2] = {k.angle, k.rate};
            for (int j = 0; j < 2; j++) {
                double by = j == 0 ? d : 20 * d, whole = j == 0 ? 1 : chord / 100;
                check_near(slope[j].lift, (change[j][1].lift - change[j][0].lift) / by, 1e-2, 2e-2 * whole);
                check_near(slope[j].drag, (change[j][1].drag - change[j][0].drag) / by, 1e-2, 2e-2 * whole);
                check_near(slope[j].moment, (change[j][1].moment - change[j][0].moment) / by, 1e-2,
                           2e-2 * whole);
            }
        }
    }
}

// Any flow, however it jumps, gives finite coefficients.
TEST(odd_flow_is_finite) {
    airfoils *a = *context;
    unsigned seed = 3;
    for (int p = 0; p < 8; p++) {
        bough_polar foil = a->polar[p];
        bough_stall_state s = {0};
        for (int i = 0; i < 20000; i++) {
            double r[4];
            for (int c = 0; c < 4; c++) r[c] = sample_between(&seed, 0, 1);
            flow inflow = {i % 9 ? 90 * r[0] : 0, 20 * (r[1] - 0.5), 1e3 * (r[2] - 0.5) * (i % 5 == 0)};
            double step = i % 7 ? 0.02 * r[3] : (i % 14 ? 0 : 1e6);
            bough_coefficients k = advance(&foil, 3, inflow, step, &s, NULL);
            assert_true(fabs(k.lift) < 1e2 && fabs(k.drag) < 1e3 && fabs(k.moment) < 1e2);
        }
    }
}

GROUP(set_up, airfoils_drop)

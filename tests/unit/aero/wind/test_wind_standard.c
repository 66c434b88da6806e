// Conditions of IEC 61400-1 by name: their formulas by hand, and the statistics of an ensemble of
// turbulent boxes beside theory.
#include "aero/wind/wind.h"

#include "aero/wind/wind_iec.h"
#include "tests/unit/check.h"
#include "tests/unit/scratch_name.h"

#include <unistd.h>

static bough_wind_def standard(int condition, double speed) {
    bough_wind_def def = bough_wind_def_default();
    def.source = BOUGH_WIND_STANDARD;
    def.iec = (bough_wind_iec_def){.condition = condition,
                                   .wind_class = BOUGH_WIND_IA,
                                   .speed = speed,
                                   .height = 90,
                                   .diameter = 126,
                                   .exponent = 0.2,
                                   .seed = 1,
                                   .points = 7,
                                   .width = 150,
                                   .time_step = 0.3,
                                   .period = 600};
    return def;
}

static bough_wind built(bough_arena *arena, const bough_wind_def *def) {
    bough_wind wind;
    check_ok(bough_wind_build(arena, def, &wind));
    return wind;
}

// -- formulas -------------------------------------------------------------------------------------

TEST(turbulence_is_that_of_the_class) {
    bough_wind_iec_def ntm = standard(BOUGH_WIND_NTM, 10).iec, etm = standard(BOUGH_WIND_ETM, 10).iec;
    check_near(bough_wind_iec_deviation(&ntm), 0.16 * (0.75 * 10 + 5.6), 1e-14, 0);
    check_near(bough_wind_iec_deviation(&etm), 2 * 0.16 * (0.072 * 8 * 1 + 10), 1e-14, 0);
    ntm.wind_class = BOUGH_WIND_IIIC;
    check_near(bough_wind_iec_deviation(&ntm), 0.12 * 13.1, 1e-14, 0);
    ntm.intensity = 0.2;
    check_near(bough_wind_iec_deviation(&ntm), 2, 1e-14, 0);
    bough_wind_iec_def ewm = standard(BOUGH_WIND_EWM, 0).iec;
    ewm.wind_class = BOUGH_WIND_IIB;
    check_near(bough_wind_iec_speed(&ewm), 42.5, 1e-14, 0);
    check_near(bough_wind_iec_deviation(&ewm), 0.11 * 42.5, 1e-14, 0);
    ewm.yearly = 1;
    check_near(bough_wind_iec_speed(&ewm), 34, 1e-14, 0);
    ewm.condition = BOUGH_WIND_EWM_STEADY;
    check_near(bough_wind_iec_speed(&ewm), 1.4 * 34, 1e-14, 0);
}

// V 25 m/s, class IA, D 126 m, hub at 90 m: σ₁ = 0.16·24.35 = 3.896, D/Λ₁ = 3.
TEST(gusts_reach_what_the_formulas_say) {
    check_arena(arena);
    const bough_vec3 hub = {0, 0, 90}, top = {0, 0, 150}, left = {0, 63, 90};
    bough_wind_def eog = standard(BOUGH_WIND_EOG, 25);
    eog.iec.start = 5;
    bough_wind w = built(arena, &eog);
    double gust = 3.3 * 3.896 / 1.3;
    check_near(bough_wind_at(&w, hub, 4).x, 25, 1e-14, 0);
    check_near(bough_wind_at(&w, hub, 10.25).x, 25 + 0.74 * gust, 1e-13, 0);
    check_near(bough_wind_at(&w, hub, 16).x, 25, 1e-13, 0);

    bough_wind_def edc = standard(BOUGH_WIND_EDC, 25);
    w = built(arena, &edc);
    double turn = 4 * atan(3.896 / (25 * 1.3));
    bough_vec3 half = bough_wind_at(&w, hub, 3), end = bough_wind_at(&w, hub, 99);
    check_near(atan2(-half.y, half.x), turn / 2, 1e-13, 0);
    check_near(atan2(-end.y, end.x), turn, 1e-13, 0);
    check_near(hypot(end.x, end.y), 25, 1e-14, 0);

    bough_wind_def ecd = standard(BOUGH_WIND_ECD, 12);
    ecd.iec.negative = 1;
    w = built(arena, &ecd);
    end = bough_wind_at(&w, hub, 10);
    check_near(atan2(end.y, end.x), 60 * BOUGH_DEGREE, 1e-13, 0);
    check_near(hypot(end.x, end.y), 27, 1e-13, 0);

    bough_wind_def ews = standard(BOUGH_WIND_EWS, 25);
    w = built(arena, &ews);
    double shear = (2.5 + 0.2 * 6.4 * 3.896 * pow(3, 0.25)) / 126;
    double profile = 25 * pow(150. / 90, 0.2);
    check_near(bough_wind_at(&w, top, 6).x, profile + 2 * 60 * shear, 1e-13, 0);
    check_near(bough_wind_at(&w, top, 12).x, profile, 1e-13, 0);
    ews.iec.horizontal = 1;
    w = built(arena, &ews);
    check_near(bough_wind_at(&w, left, 6).x, 25 + 2 * 63 * shear, 1e-13, 0);

    bough_wind_def ewm = standard(BOUGH_WIND_EWM_STEADY, 0);
    ewm.iec.exponent = 0.11;
    w = built(arena, &ewm);
    check_near(bough_wind_at(&w, top, 1).x, 70 * pow(150. / 90, 0.11), 1e-13, 0);
}

TEST(upflow_and_veer_turn_any_wind) {
    check_arena(arena);
    bough_wind_def def = {.speed = 10,
                          .vertical = 1,
                          .upflow = 8 * BOUGH_DEGREE,
                          .veer = 0.1 * BOUGH_DEGREE,
                          .reference_height = 90};
    bough_wind w = built(arena, &def);
    double c = cos(8 * BOUGH_DEGREE), s = sin(8 * BOUGH_DEGREE);
    bough_vec3 hub = bough_wind_at(&w, bough_v3(0, 0, 90), 0);
    check_near(hub.x, 10 * c - s, 1e-14, 0);
    check_near(hub.z, 10 * s + c, 1e-14, 0);
    bough_vec3 above = bough_wind_at(&w, bough_v3(0, 0, 140), 0);
    check_near(atan2(-above.y, above.x), 5 * BOUGH_DEGREE, 1e-13, 0);
    check_near(above.z, hub.z, 1e-14, 0);
    def.direction = 30 * BOUGH_DEGREE;
    w = built(arena, &def);
    above = bough_wind_at(&w, bough_v3(0, 0, 140), 0);
    check_near(atan2(above.y, above.x), 25 * BOUGH_DEGREE, 1e-13, 0);
}

TEST(senseless_conditions_are_refused) {
    check_arena(arena);
    bough_wind_def bad[5];
    for (int i = 0; i < 5; i++) bad[i] = standard(BOUGH_WIND_NTM, 10);
    bad[0].iec.speed = 0;
    bad[1].iec.width = 100;
    bad[2].iec.points = 1;
    bad[3].iec.height = -1;
    bad[4].iec.period = 1e9;
    for (int i = 0; i < 5; i++) {
        bough_wind wind;
        assert_int_equal(bough_wind_build(arena, &bad[i], &wind).code, BOUGH_INVALID);
    }
}

// -- turbulence -----------------------------------------------------------------------------------

enum { SEEDS = 20, TIMES = 2000, POINTS = 49, WAVES = 100 };

typedef struct ensemble {
    bough_wind_iec_def def;
    bough_arena *arena;
    bough_wind_box box[SEEDS];
    double *frequency; // (WAVES)
    // Fourier coefficients of u at the corner, the point beside it, one further and the middle.
    double re[4][SEEDS][WAVES], im[4][SEEDS][WAVES];
} ensemble;

static const int places[4] = {0, 1, 3, 24};

static double velocity(const bough_wind_box *box, int time, int point, int c) {
    double value = box->value[3 * ((int64_t)time * POINTS + point) + c];
    return (value - box->offset[c]) * box->scale[c];
}

// Frequencies at which the waves are equal to those of the box: the first ones and then fewer.
static int wave_of(int i) { return i < 60 ? i + 1 : 60 + (i - 59) * 5; }

static void transform(ensemble *e, int seed, int place) {
    const bough_wind_box *box = &e->box[seed];
    for (int i = 0; i < WAVES; i++) {
        double re = 0, im = 0;
        for (int k = 0; k < TIMES; k++) {
            double angle = 2 * BOUGH_PI * (double)((int64_t)wave_of(i) * k % TIMES) / TIMES;
            double u = velocity(box, k, places[place], 0);
            re += u * cos(angle) / TIMES;
            im -= u * sin(angle) / TIMES;
        }
        e->re[place][seed][i] = re;
        e->im[place][seed][i] = im;
    }
}

static int make_ensemble(void **state) {
    ensemble *e = test_calloc(1, sizeof *e);
    e->def = standard(BOUGH_WIND_NTM, 12).iec;
    e->arena = check_memory();
    for (int s = 0; s < SEEDS; s++) {
        e->def.seed = 100 + s;
        check_ok(bough_turbulence_make(e->arena, &e->def, &e->box[s]));
        assert_int_equal(e->box[s].n_time, TIMES);
        for (int p = 0; p < 4; p++) transform(e, s, p);
    }
    *state = e;
    return 0;
}

static int drop_ensemble(void **state) {
    ensemble *e = *state;
    bough_arena_destroy(e->arena);
    test_free(e);
    return 0;
}

// Mean over the ensemble of the real part of X_a conj(X_b), as a one-sided density.
static double cross(const ensemble *e, int a, int b, int wave) {
    double sum = 0;
    for (int s = 0; s < SEEDS; s++)
        sum += e->re[a][s][wave] * e->re[b][s][wave] + e->im[a][s][wave] * e->im[b][s][wave];
    return 2 * sum / SEEDS * e->box[0].duration;
}

static double frequency(const ensemble *e, int wave) { return wave_of(wave) / e->box[0].duration; }

// Kaimal's spectrum of u, one-sided (C.14): 4 σ² L/U (1 + 6 f L/U)^(−5/3), L = 8.1 Λ, Λ = 42 m [m²/s].
static double kaimal(const bough_wind_iec_def *def, double f) {
    double deviation = bough_wind_iec_deviation(def), scale = 8.1 * 42 / def->speed;
    return deviation * deviation * 4 * scale / pow(1 + 6 * f * scale, 5. / 3);
}

// The mean of 20 estimates with two degrees of freedom each lies in 24.43/40 … 59.34/40 of the
// spectrum with 95 % probability: χ² with 40 degrees. What the time step folds is at most 4 % here.
TEST(spectra_are_kaimals) {
    const ensemble *e = *context;
    int inside = 0, counted = 0;
    double mean = 0;
    for (int p = 0; p < 4; p++) {
        for (int i = 1; i < WAVES; i++) {
            double theory = kaimal(&e->def, frequency(e, i));
            double ratio = cross(e, p, p, i) / theory;
            inside += ratio > 24.43 / 40 && ratio < 59.34 / 40;
            mean += ratio;
            counted++;
        }
    }
    assert_true(inside >= 0.93 * counted);
    check_near(mean / counted, 1, 0.05, 0);
}

// The estimate's standard deviation is √((1 + γ²)/2/20) of the spectrum at most.
TEST(coherence_is_exponential) {
    const ensemble *e = *context;
    static const int pair[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    static const double steps[3] = {1, 3, 2};
    int inside = 0, counted = 0;
    double sum = 0, expected = 0;
    for (int k = 0; k < 3; k++) {
        for (int i = 1; i < WAVES; i++) {
            double f = frequency(e, i), density = kaimal(&e->def, f);
            double theory = bough_turbulence_coherence(&e->def, 25 * steps[k], f);
            double estimate = cross(e, pair[k][0], pair[k][1], i) / density;
            inside += fabs(estimate - theory) < 1.96 * sqrt((1 + theory * theory) / 2 / SEEDS);
            counted++;
            sum += estimate;
            expected += theory;
        }
    }
    assert_true(inside >= 0.93 * counted);
    check_near(sum, expected, 0.1, 0);
}

TEST(deviations_are_those_of_the_standard) {
    const ensemble *e = *context;
    static const double share[3] = {1, 0.8, 0.5};
    for (int c = 0; c < 3; c++) {
        double variance = 0, middle = 0;
        for (int s = 0; s < SEEDS; s++) {
            for (int p = 0; p < POINTS; p++) {
                double sum = 0, squares = 0;
                for (int k = 0; k < TIMES; k++) {
                    double v = velocity(&e->box[s], k, p, c);
                    sum += v / TIMES;
                    squares += v * v / TIMES;
                }
                variance += (squares - sum * sum) / POINTS / SEEDS;
                if (p == 24) middle = squares - sum * sum;
                if (c == 0 && p == 24) check_near(sum, 12, 1e-4, 0);
            }
            check_near(sqrt(middle), share[c] * bough_wind_iec_deviation(&e->def), 2e-3, 0);
        }
        check_near(sqrt(variance), share[c] * bough_wind_iec_deviation(&e->def), 0.02, 0);
    }
}

TEST(a_seed_gives_the_same_bits) {
    ensemble *e = *context;
    bough_wind_box again, other;
    size_t size = 3 * (size_t)POINTS * TIMES * sizeof *again.value;
    e->def.seed = 100;
    bough_turbulence_make(e->arena, &e->def, &again);
    assert_memory_equal(again.value, e->box[0].value, size);
    e->def.seed = 120;
    bough_turbulence_make(e->arena, &e->def, &other);
    assert_memory_not_equal(other.value, e->box[0].value, size);
}

// A second wind that is given the box of the first one has its turbulence without generating it.
TEST(a_box_is_shared) {
    check_arena(arena);
    bough_wind_def def = standard(BOUGH_WIND_NTM, 10);
    def.upflow = 4 * BOUGH_DEGREE;
    bough_wind first = built(arena, &def);
    def.box = first.box;
    bough_wind second = built(arena, &def);
    assert_ptr_equal(second.box, first.box);
    const bough_vec3 place = {3, 20, 110};
    bough_vec3 a = bough_wind_at(&first, place, 31.7), b = bough_wind_at(&second, place, 31.7);
    assert_memory_equal(&a, &b, sizeof a);
}

TEST(a_box_that_is_written_reads_the_same) {
    ensemble *e = *context;
    char path[SCRATCH_NAME];
    int file = mkstemp(scratch_name(path));
    assert_true(file >= 0);
    FILE *stream = fdopen(file, "wb");
    assert_true(bough_wind_box_write(&e->box[0], "seed 100", stream));
    fclose(stream);
    bough_wind_box box;
    bough_status status = bough_wind_box_read(e->arena, path, &box);
    unlink(path);
    assert_int_equal(status.code, BOUGH_OK);
    for (int i = 0; i < 200; i++) {
        const bough_vec3 at = {-5 + i * 0.1, 75 - i * 0.7, 20 + i * 0.6};
        bough_vec3 a = bough_wind_box_at(&e->box[0], at, 1.37 * i);
        bough_vec3 b = bough_wind_box_at(&box, at, 1.37 * i);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

GROUP(make_ensemble, drop_ensemble)

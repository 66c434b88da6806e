// Veers' method, theory (96, 97, 98), for Kaimal's spectrum.
#include "aero/wind/wind_iec.h"

#include "core/base/base.h"
#include "core/base/lanes.h"
#include "core/base/linalg.h"

#include <complex.h>
#include <fftw3.h>
#include <float.h>
#include <pthread.h>

// The library's planner is one for the process.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

static void destroy_plan(void *plan) {
    pthread_mutex_lock(&planner);
    fftw_destroy_plan(plan);
    pthread_mutex_unlock(&planner);
}

// Below NEGLIGIBLE, points next to each other are taken as not coherent.
static const double NEGLIGIBLE = 1e-3;
enum { ALIASES = 8 };

enum { BATCH = 8 }; // points whose series are stored together, since they lie side by side in the box

// -- spectra --------------------------------------------------------------------------------------

static double deviation_of(const bough_wind_iec_def *d, int component) {
    static const double ratio[] = {1, 0.8, 0.5};
    return ratio[component] * bough_wind_iec_deviation(d);
}

// L/U [s]
static double time_scale(const bough_wind_iec_def *d, int component) {
    static const double length[] = {8.1, 2.7, 0.66};
    return length[component] * bough_wind_iec_scale(d->height) / bough_wind_iec_speed(d);
}

// Variance below f, over all variance: the integral of the spectrum (C.14).
static double fraction_below(double f, double scale) { return 1 - pow(1 + 6 * f * scale, -2. / 3); }

double bough_turbulence_coherence(const bough_wind_iec_def *d, double distance, double f) {
    double waves = f * distance / bough_wind_iec_speed(d);
    double lengths = 0.12 * distance / (8.1 * bough_wind_iec_scale(d->height));
    return exp(-12 * sqrt(waves * waves + lengths * lengths)); // (C.15)
}

bool bough_turbulence_equal(const bough_wind_iec_def *a, const bough_wind_iec_def *b) {
    return a->condition == b->condition && a->wind_class == b->wind_class && a->speed == b->speed &&
           a->intensity == b->intensity && a->height == b->height && a->exponent == b->exponent &&
           a->yearly == b->yearly && a->seed == b->seed && a->points == b->points && a->width == b->width &&
           a->time_step == b->time_step && a->period == b->period;
}

// -- the maker ------------------------------------------------------------------------------------

typedef struct maker {
    const bough_wind_iec_def *def;
    bough_wind_box *box;
    int16_t *value;      // of the box
    int n_point, n_wave; // waves 1 … n_wave
    int n_coherent;      // the slowest of them, whose points are mixed
    double step;         // between frequencies [Hz]
    double *amplitude;   // (3 × (n_wave + 1)) of a wave's complex amplitude, half the wave's
    int *order;          // (n_point) points from the middle outwards
    float *mixed;        // (n_coherent × n_point × 2) complex amplitudes; the box has 16 bits
    float *wave;         // (2 × n_point) one wave of all points in `order`, real parts before imaginary ones
    float *factor;       // (n_point × n_point) column-major
    double *distance;    // (points × points) by the distances in steps of the grid [m]
    float *table;        // (points × points) coherence, likewise
    uint16_t *pair;      // (n_point × n_point), lower triangle of columns in `order`: entry of the tables
    int16_t *series;     // (BATCH × 3 × n_time)
    // x_k = A₀ + Σ 2 Re(A_m e^{2πi m k/n}) over m = 1 … n/2 − 1, with the amplitude n/2 once, by FFTW:
    double *waves; // (n_time/2 + 1) A_m, real and imaginary part next to each other; a sum overwrites them
    double *sum;   // (n_time) x
    fftw_plan plan;
} maker;

static uint64_t scramble(uint64_t x) {
    // S. Vigna's splitmix64
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

static uint64_t random_stream(const maker *m, int component, int point) {
    return scramble(scramble((uint64_t)m->def->seed) + (uint64_t)component) + ((uint64_t)point << 32);
}

// e^{iφ} with a phase from seed, component, point and wave, equally distributed over [0, 2π): 52 random bits.
static inline sine_cosine random_wave(uint64_t stream, int wave) {
    uint64_t bits = scramble(stream + (uint64_t)wave) >> 12 | UINT64_C(0x3FF) << 52;
    double one_to_two;
    memcpy(&one_to_two, &bits, sizeof one_to_two);
    sine_cosine w = lane_sine_cosine(2 * BOUGH_PI * (one_to_two - 1.5)); // φ − π
    return (sine_cosine){-w.sine, -w.cosine};
}

// Fraction of the variance up to a wave, and of the frequencies that sampling folds onto it.
static double fraction_up_to(const maker *m, double wave, double scale) {
    double rate = 2 * (m->n_wave + 1) * m->step, f = wave * m->step, fraction = fraction_below(f, scale);
    for (int k = 1; k <= ALIASES; k++) {
        fraction += fraction_below(k * rate + f, scale) - fraction_below(k * rate - f, scale);
    }
    return fraction;
}

static double *amplitude_of(const maker *m, int component) {
    return m->amplitude + (size_t)component * ((size_t)m->n_wave + 1);
}

// theory (98): a wave has the variance of the band about it, and a part of that beyond the aliases.
static void set_amplitudes(maker *m, int component) {
    double deviation = deviation_of(m->def, component), scale = time_scale(m->def, component);
    double rest = (1 - fraction_below((2 * ALIASES + 1) * (m->n_wave + 1) * m->step, scale)) / m->n_wave;
    double below = fraction_up_to(m, 0, scale);
    for (int i = 1; i <= m->n_wave; i++) {
        double above = fraction_up_to(m, i == m->n_wave ? i + 1 : i + 0.5, scale);
        amplitude_of(m, component)[i] = deviation * sqrt(0.5 * (above - below + rest));
        below = above;
    }
}

// -- coherence ------------------------------------------------------------------------------------

// Distances on a grid of equal steps are few: one for each difference of rows and of columns.
static void set_distances(maker *m) {
    int n = m->def->points;
    for (int z = 0; z < n; z++) {
        for (int y = 0; y < n; y++) m->distance[z * n + y] = hypot(z * m->box->dz, y * m->box->dy);
    }
    for (int j = 0; j < m->n_point; j++) {
        int zj = m->order[j] / n, yj = m->order[j] % n;
        uint16_t *pair = m->pair + (size_t)j * (size_t)m->n_point;
        for (int i = j; i < m->n_point; i++) {
            pair[i] = (uint16_t)(abs(m->order[i] / n - zj) * n + abs(m->order[i] % n - yj));
        }
    }
}

// The lower triangle of the coherence of all points, in `order`. Values below rounding would have denormal
// products, which processors compute a hundred times as slowly.
static void fill_coherence(maker *m, double f) {
    for (int k = 0; k < m->n_point; k++) {
        double coherence = bough_turbulence_coherence(m->def, m->distance[k], f);
        m->table[k] = coherence > (double)FLT_EPSILON ? (float)coherence : 0;
    }
    for (int j = 0; j < m->n_point; j++) {
        size_t column = (size_t)j * (size_t)m->n_point;
        for (int i = j; i < m->n_point; i++) m->factor[column + i] = m->table[m->pair[column + i]];
    }
}

// theory (96): the amplitudes of all points at one wave, L e^{iφ}. In single precision, for a box of 16 bits.
static void mix_points(maker *m, int wave) {
    int n = m->n_point;
    float *restrict real = m->wave, *restrict imaginary = m->wave + n;
    memset(m->wave, 0, 2 * (size_t)n * sizeof *m->wave);
    for (int j = 0; j < n; j++) {
        sine_cosine w = random_wave(random_stream(m, 0, m->order[j]), wave);
        float re = (float)(m->amplitude[wave] * w.cosine), im = (float)(m->amplitude[wave] * w.sine);
        const float *restrict column = m->factor + (size_t)j * (size_t)n;
        for (int i = j; i < n; i++) {
            real[i] += column[i] * re;
            imaginary[i] += column[i] * im;
        }
    }
    // into the order of the grid
    float *to = m->mixed + 2 * (size_t)n * (size_t)(wave - 1);
    for (int i = 0; i < n; i++) {
        to[2 * m->order[i]] = real[i];
        to[2 * m->order[i] + 1] = imaginary[i];
    }
}

// The coherence matrix of each wave, its Cholesky factor L, the amplitudes.
static bough_status mix_all(maker *m) {
    set_distances(m);
    for (int i = 1; i <= m->n_coherent; i++) {
        fill_coherence(m, i * m->step);
        if (!bough_cholesky_lower(m->n_point, m->factor)) {
            return bough_fail(BOUGH_FAILED,
                              "Wind: the coherence of %d points at %g Hz has no "
                              "Cholesky factor.",
                              m->n_point, i * m->step);
        }
        mix_points(m, i);
    }
    return bough_ok();
}

// -- series ---------------------------------------------------------------------------------------

// The plan is chosen without measuring, so that the same number of times always gives the same bits.
static void make_plan(bough_arena *arena, maker *m) {
    size_t n = (size_t)m->box->n_time;
    m->waves = bough_arena_doubles(arena, n + 2);
    m->sum = bough_arena_doubles(arena, n);
    pthread_mutex_lock(&planner);
    m->plan = fftw_plan_dft_c2r_1d(m->box->n_time, (fftw_complex *)m->waves, m->sum, FFTW_ESTIMATE);
    pthread_mutex_unlock(&planner);
    if (!m->plan) bough_arena_leave(arena);
    bough_arena_on_destroy(arena, destroy_plan, m->plan);
}

static void set_waves(maker *m, int component, int point) {
    double *restrict a = m->waves;
    const double *restrict amplitude = amplitude_of(m, component);
    int n = m->n_wave, mixed = component == 0 ? m->n_coherent : 0;
    a[0] = a[1] = a[2 * n + 2] = a[2 * n + 3] = 0;
    // coherent waves first, then those of the point alone
    for (int i = 1; i <= mixed; i++) {
        const float *from = m->mixed + 2 * ((size_t)m->n_point * (size_t)(i - 1) + (size_t)point);
        a[2 * i] = (double)from[0];
        a[2 * i + 1] = (double)from[1];
    }
    uint64_t stream = random_stream(m, component, point);
#pragma omp simd
    for (int i = mixed + 1; i <= n; i++) {
        sine_cosine w = random_wave(stream, i);
        a[2 * i] = amplitude[i] * w.cosine;
        a[2 * i + 1] = amplitude[i] * w.sine;
    }
}

static double height_of(const bough_wind_box *box, int point) {
    return box->bottom + box->dz * (point / box->n_y);
}

// A series in the units of the box.
static void quantise(const maker *m, int component, int point, const double *restrict series,
                     int16_t *restrict to) {
    const bough_wind_box *box = m->box;
    double mean = component == 0 ? bough_wind_iec_profile(m->def, height_of(box, point)) : 0;
    double slope = 1 / box->scale[component], offset = box->offset[component];
#pragma omp simd
    for (int k = 0; k < box->n_time; k++) {
        double units = (mean + series[k]) * slope + offset;
        to[k] = (int16_t)(int)lane_round(lane_clamp(units, INT16_MIN, INT16_MAX));
    }
}

static void store(const maker *m, int first, int count) {
    size_t n = (size_t)m->box->n_time, stride = 3 * (size_t)m->n_point;
    for (size_t k = 0; k < n; k++) {
        int16_t *to = m->value + k * stride + 3 * first;
        for (int i = 0; i < 3 * count; i++) to[i] = m->series[i * n + k];
    }
}

// Inverse Fourier transforms, a batch of points at a time.
static void make_series(maker *m) {
    size_t n = (size_t)m->box->n_time;
    for (int first = 0; first < m->n_point; first += BATCH) {
        int count = m->n_point - first < BATCH ? m->n_point - first : BATCH;
        for (int i = 0; i < 3 * count; i++) {
            int component = i % 3, point = first + i / 3;
            set_waves(m, component, point);
            fftw_execute(m->plan);
            quantise(m, component, point, m->sum, m->series + i * n);
        }
        store(m, first, count);
    }
}

// -- the box --------------------------------------------------------------------------------------

// As the file holds it, so that a box that is written and read again is the same.
static double as_float(double x) { return (double)(float)x; }

// The least even number from n on without prime factors above 5.
static int smooth(int n) {
    for (int even = n + n % 2;; even += 2) {
        int rest = even;
        while (rest % 2 == 0) rest /= 2;
        while (rest % 3 == 0) rest /= 3;
        while (rest % 5 == 0) rest /= 5;
        if (rest == 1) return even;
    }
}

// 16 bits over seven standard deviations and the mean's range.
static void set_resolution(const bough_wind_iec_def *d, bough_wind_box *box) {
    double top = bough_wind_iec_profile(d, box->bottom + d->width);
    double foot = bough_wind_iec_profile(d, box->bottom);
    for (int c = 0; c < 3; c++) {
        double reach = 7 * deviation_of(d, c), low = c == 0 ? fmin(foot, top) - reach : -reach;
        double high = c == 0 ? fmax(foot, top) + reach : reach;
        double slope = as_float(65000 / (high - low));
        box->scale[c] = 1 / slope;
        box->offset[c] = as_float(-32500 - low * slope);
    }
}

static int count_times(double period, double time_step) {
    return smooth((int)fmax(4, ceil(period / time_step - 1e-9)));
}

double bough_turbulence_period(double period, double time_step) {
    return period / time_step < 1e8 ? time_step * count_times(period, time_step) : period;
}

static void lay_out(const bough_wind_iec_def *d, bough_wind_box *box) {
    *box = (bough_wind_box){.periodic = true, .n_z = d->points, .n_y = d->points};
    box->dz = box->dy = as_float(d->width / (d->points - 1));
    box->dt = as_float(d->time_step);
    box->mean = as_float(bough_wind_iec_speed(d));
    box->hub = as_float(d->height);
    box->bottom = as_float(d->height - 0.5 * d->width);
    box->n_time = count_times(d->period, d->time_step);
    box->duration = box->dt * box->n_time;
    box->half_width = box->dy * (box->n_y - 1) / 2;
    set_resolution(d, box);
}

typedef struct place {
    double distance; // squared, from the middle, in steps of the grid
    int point;
} place;

static int nearer(const void *a, const void *b) {
    const place *p = a, *q = b;
    if (p->distance != q->distance) return p->distance < q->distance ? -1 : 1;
    return (p->point > q->point) - (p->point < q->point);
}

// The factor's first point has its own waves alone: the middle, whose deviation is then exact.
static void set_order(maker *m, place *scratch) {
    int n = m->def->points;
    for (int i = 0; i < m->n_point; i++) {
        double z = i / n - 0.5 * (n - 1), y = i % n - 0.5 * (n - 1);
        scratch[i] = (place){z * z + y * y, i};
    }
    qsort(scratch, (size_t)m->n_point, sizeof *scratch, nearer);
    for (int i = 0; i < m->n_point; i++) m->order[i] = scratch[i].point;
}

// Waves in which neighbouring points are coherent; coherence falls with the frequency.
static int count_coherent(const maker *m) {
    int n = 0;
    while (n < m->n_wave && bough_turbulence_coherence(m->def, m->box->dy, (n + 1) * m->step) > NEGLIGIBLE)
        n++;
    return n;
}

static bough_status make_in(bough_arena *scratch, maker *m) {
    size_t n = (size_t)m->n_point;
    m->n_wave = m->box->n_time / 2 - 1;
    m->step = 1 / m->box->duration;
    m->n_coherent = count_coherent(m);
    m->amplitude = bough_arena_doubles(scratch, 3 * ((size_t)m->n_wave + 1));
    m->order = bough_arena_take(scratch, n * sizeof *m->order);
    m->mixed = bough_arena_take(scratch, (2 * n * (size_t)m->n_coherent + 1) * sizeof *m->mixed);
    m->wave = bough_arena_take(scratch, 2 * n * sizeof *m->wave);
    m->factor = bough_arena_take(scratch, n * n * sizeof *m->factor);
    m->distance = bough_arena_doubles(scratch, n);
    m->table = bough_arena_take(scratch, n * sizeof *m->table);
    m->pair = bough_arena_take(scratch, n * n * sizeof *m->pair);
    m->series = bough_arena_take(scratch, 3 * BATCH * (size_t)m->box->n_time * sizeof *m->series);
    place *places = bough_arena_take(scratch, n * sizeof *places);
    // amplitudes by the spectra, phases mixed by the coherence, series by Fourier transforms
    make_plan(scratch, m);
    set_order(m, places);
    for (int c = 0; c < 3; c++) set_amplitudes(m, c);
    bough_status status = mix_all(m);
    if (bough_is_ok(&status)) make_series(m);
    return status;
}

bough_status bough_turbulence_make(bough_arena *arena, const bough_wind_iec_def *def, bough_wind_box *box) {
    maker m = {.def = def, .box = box, .n_point = def->points * def->points};
    if (!(def->period / def->time_step * m.n_point < 5e8)) {
        return bough_fail(BOUGH_INVALID,
                          "Wind: %d x %d points every %g s over %g s are too many: "
                          "take fewer points or a longer time step.",
                          def->points, def->points, def->time_step, def->period);
    }
    lay_out(def, box);
    size_t values = 3 * (size_t)m.n_point * (size_t)box->n_time;
    box->value = m.value = bough_arena_take(arena, values * sizeof *m.value);
    bough_arena *scratch = bough_arena_child(arena);
    bough_status status = make_in(scratch, &m);
    bough_arena_destroy(scratch);
    return status;
}

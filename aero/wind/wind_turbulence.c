#include "aero/wind/wind_turbulence.h"

#include "core/base/base.h"
#include "core/base/linalg.h"

#include <complex.h>
#include <fftw3.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

// The sum of n waves, by FFTW.
typedef struct fourier {
    fftw_complex *amplitude; // (n/2 + 1)
    double *sum;             // (n)
    fftw_plan plan;
} fourier;

// The library's planner is one for the process.
static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

static void fourier_destroy(fourier *f) {
    if (!f) return;
    pthread_mutex_lock(&planner);
    if (f->plan) fftw_destroy_plan(f->plan);
    pthread_mutex_unlock(&planner);
    fftw_free(f->amplitude);
    fftw_free(f->sum);
    free(f);
}

// For n times, even; NULL without memory. The plan is chosen without measuring, so that the same n
// always gives the same bits.
static fourier *fourier_create(int n) {
    fourier *f = calloc(1, sizeof *f);
    if (!f) return NULL;
    f->amplitude = fftw_malloc(((size_t)n / 2 + 1) * sizeof *f->amplitude);
    f->sum = fftw_malloc((size_t)n * sizeof *f->sum);
    if (f->amplitude && f->sum) {
        pthread_mutex_lock(&planner);
        f->plan = fftw_plan_dft_c2r_1d(n, f->amplitude, f->sum, FFTW_ESTIMATE);
        pthread_mutex_unlock(&planner);
    }
    if (f->plan) return f;
    fourier_destroy(f);
    return NULL;
}

// Complex amplitudes of the waves 0 … n/2, real and imaginary part next to each other: set them
// before each sum, which overwrites them.
static double *fourier_amplitude(fourier *f) { return (double *)f->amplitude; }

// x_k = A₀ + Σ 2 Re(A_m e^{2πi m k/n}) over m = 1 … n/2 − 1, with the amplitude n/2 once; x (n) is
// valid until the next sum.
static const double *fourier_sum(fourier *f) {
    fftw_execute(f->plan);
    return f->sum;
}

// Below NEGLIGIBLE, points next to each other are taken as not coherent.
static const double NEGLIGIBLE = 1e-3;
enum { ALIASES = 8 };

// -- spectra --------------------------------------------------------------------------------------

static double deviation_of(const bough_wind_iec_def *d, int component) {
    static const double share[] = {1, 0.8, 0.5};
    return share[component] * bough_wind_iec_deviation(d);
}

// L/U [s]
static double time_scale(const bough_wind_iec_def *d, int component) {
    static const double length[] = {8.1, 2.7, 0.66};
    return length[component] * bough_wind_iec_scale(d->height) / bough_wind_iec_speed(d);
}

double bough_turbulence_spectrum(const bough_wind_iec_def *d, int component, double f) {
    double deviation = deviation_of(d, component), scale = time_scale(d, component);
    return deviation * deviation * 4 * scale / pow(1 + 6 * f * scale, 5. / 3); // (C.14)
}

// Variance below f, over all variance: the integral of the spectrum.
static double share_below(double f, double scale) { return 1 - pow(1 + 6 * f * scale, -2. / 3); }

double bough_turbulence_coherence(const bough_wind_iec_def *d, double distance, double f) {
    double waves = f * distance / bough_wind_iec_speed(d);
    double lengths = 0.12 * distance / (8.1 * bough_wind_iec_scale(d->height));
    return exp(-12 * sqrt(waves * waves + lengths * lengths)); // (C.15)
}

// -- the maker ------------------------------------------------------------------------------------

typedef struct maker {
    const bough_wind_iec_def *def;
    bough_wind_box *box;
    int16_t *value; // of the box
    fourier *fourier;
    int n_point, n_wave; // waves 1 … n_wave
    int n_coherent;      // the slowest of them, whose points are mixed
    double step;         // between frequencies [Hz]
    double *amplitude;   // (n_wave + 1) of a wave's complex amplitude, half the wave's
    int *order;          // (n_point) points from the middle outwards
    double *mixed;       // (n_coherent × n_point × 2) complex amplitudes
    double *factor;      // (n_point × n_point) column-major
    double *table;       // (points × points) coherence by the distances in steps of the grid
} maker;

// A number that follows from what it is for, equally distributed over a turn.
static uint64_t scramble(uint64_t x) {
    // S. Vigna's splitmix64
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

static double random_phase(const maker *m, int component, int point, int wave) {
    uint64_t stream = scramble(scramble((uint64_t)m->def->seed) + (uint64_t)component);
    uint64_t bits = scramble(stream + ((uint64_t)point << 32) + (uint64_t)wave);
    return 2 * BOUGH_PI * (double)(bits >> 11) * 0x1p-53;
}

// Share of the variance in a band about f, and in those that sampling folds onto it.
static double share_of_band(const maker *m, int wave, double scale) {
    double half = 0.5 * m->step, f = wave * m->step, rate = 2 * (m->n_wave + 1) * m->step;
    double low = wave == 1 ? 0 : f - half, high = wave == m->n_wave ? f + m->step : f + half;
    double share = share_below(high, scale) - share_below(low, scale);
    double from = wave == 1 ? 0 : wave - 0.5, to = wave == m->n_wave ? wave + 1 : wave + 0.5;
    for (int k = 1; k <= ALIASES; k++) {
        double above = k * rate + from * m->step, up = k * rate + to * m->step;
        double below = k * rate - to * m->step, down = k * rate - from * m->step;
        share += share_below(up, scale) - share_below(above, scale);
        share += share_below(down, scale) - share_below(below, scale);
    }
    return share + (1 - share_below((ALIASES + 0.5) * rate, scale)) / m->n_wave;
}

static void set_amplitudes(maker *m, int component) {
    double deviation = deviation_of(m->def, component), scale = time_scale(m->def, component);
    for (int i = 1; i <= m->n_wave; i++) m->amplitude[i] = deviation * sqrt(0.5 * share_of_band(m, i, scale));
}

// -- coherence ------------------------------------------------------------------------------------

static void tabulate(maker *m, double f) {
    int n = m->def->points;
    for (int z = 0; z < n; z++)
        for (int y = 0; y < n; y++)
            m->table[z * n + y] =
                bough_turbulence_coherence(m->def, hypot(z * m->box->dz, y * m->box->dy), f);
}

// The lower triangle of the coherence of all points, in `order`.
static void fill_coherence(maker *m) {
    int n = m->def->points;
    for (int j = 0; j < m->n_point; j++) {
        int zj = m->order[j] / n, yj = m->order[j] % n;
        double *column = m->factor + (size_t)j * (size_t)m->n_point;
        for (int i = j; i < m->n_point; i++) {
            int z = abs(m->order[i] / n - zj), y = abs(m->order[i] % n - yj);
            column[i] = m->table[z * n + y];
        }
    }
}

// The amplitudes of all points at one wave: L e^{iφ}.
static void mix_points(maker *m, int wave) {
    double *to = m->mixed + 2 * (size_t)m->n_point * (size_t)(wave - 1);
    for (int j = 0; j < m->n_point; j++) {
        double phase = random_phase(m, 0, m->order[j], wave);
        double re = m->amplitude[wave] * cos(phase), im = m->amplitude[wave] * sin(phase);
        const double *column = m->factor + (size_t)j * (size_t)m->n_point;
        for (int i = j; i < m->n_point; i++) {
            to[2 * m->order[i]] += column[i] * re;
            to[2 * m->order[i] + 1] += column[i] * im;
        }
    }
}

static bough_status mix_all(maker *m) {
    for (int i = 1; i <= m->n_coherent; i++) {
        tabulate(m, i * m->step);
        fill_coherence(m);
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

static void set_waves(maker *m, int component, int point) {
    double *a = fourier_amplitude(m->fourier);
    memset(a, 0, 2 * ((size_t)m->n_wave + 2) * sizeof *a);
    for (int i = 1; i <= m->n_wave; i++) {
        if (component == 0 && i <= m->n_coherent) {
            const double *mixed = m->mixed + 2 * ((size_t)m->n_point * (size_t)(i - 1) + (size_t)point);
            a[2 * i] = mixed[0];
            a[2 * i + 1] = mixed[1];
        } else {
            double phase = random_phase(m, component, point, i);
            a[2 * i] = m->amplitude[i] * cos(phase);
            a[2 * i + 1] = m->amplitude[i] * sin(phase);
        }
    }
}

static double height_of(const bough_wind_box *box, int point) {
    return box->bottom + box->dz * (point / box->n_y);
}

static void store(maker *m, int component, int point, const double *series) {
    const bough_wind_box *box = m->box;
    double mean = component == 0 ? bough_wind_iec_profile(m->def, height_of(box, point)) : 0;
    double slope = 1 / box->scale[component], offset = box->offset[component];
    int16_t *to = m->value + 3 * point + component;
    for (int k = 0; k < box->n_time; k++, to += 3 * m->n_point) {
        double units = (mean + series[k]) * slope + offset;
        *to = (int16_t)lrint(bough_clamp(units, INT16_MIN, INT16_MAX));
    }
}

static bough_status make_component(maker *m, int component) {
    set_amplitudes(m, component);
    if (component == 0) {
        bough_status status = mix_all(m);
        if (!bough_is_ok(&status)) return status;
    }
    for (int p = 0; p < m->n_point; p++) {
        set_waves(m, component, p);
        store(m, component, p, fourier_sum(m->fourier));
    }
    return bough_ok();
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

static void lay_out(const bough_wind_iec_def *d, bough_wind_box *box) {
    *box = (bough_wind_box){.periodic = true, .n_z = d->points, .n_y = d->points};
    box->dz = box->dy = as_float(d->width / (d->points - 1));
    box->dt = as_float(d->time_step);
    box->mean = as_float(bough_wind_iec_speed(d));
    box->hub = as_float(d->height);
    box->bottom = as_float(d->height - 0.5 * d->width);
    box->n_time = smooth((int)ceil(d->period / d->time_step - 1e-9));
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
    m->amplitude = bough_arena_doubles(scratch, (size_t)m->n_wave + 1);
    m->order = bough_arena_take(scratch, n * sizeof *m->order);
    m->mixed = bough_arena_doubles(scratch, 2 * n * (size_t)m->n_coherent + 1);
    m->factor = bough_arena_doubles(scratch, n * n);
    m->table = bough_arena_doubles(scratch, n);
    place *places = bough_arena_take(scratch, n * sizeof *places);
    m->fourier = fourier_create(m->box->n_time);
    if (!m->fourier) bough_arena_leave(scratch);
    set_order(m, places);
    bough_status status = bough_ok();
    for (int c = 0; c < 3 && bough_is_ok(&status); c++) status = make_component(m, c);
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
    fourier_destroy(m.fourier);
    bough_arena_destroy(scratch);
    return status;
}

#include "apps/bough/cases/case_run.h"

#include <assert.h>
#include <math.h>

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study) {
    bough_study_series series = {.n_row = (int)(study->duration / study->interval + 1e-6) + 1,
                                 .n_channel = study->n_channel};
    series.value = bough_arena_doubles(arena, (size_t)series.n_row * (size_t)series.n_channel);
    return series;
}

// The larger of the two; a NaN wins and stays.
static double larger(double a, double b) { return isnan(b) || b > a ? b : a; }

// Norm of a − b (n); of a where b is NULL.
static double difference(const double *a, const double *b, int n, int norm) {
    double sum = 0, largest = 0;
    for (int i = 0; i < n; i++) {
        double d = b ? a[i] - b[i] : a[i];
        sum += d * d;
        largest = larger(largest, fabs(d));
    }
    return norm == BOUGH_STUDY_EUCLID ? sqrt(sum) : largest;
}

// The largest norm of the vectors of a measure in a row.
static double measured(const bough_study_measure *m, const double *a, const double *b) {
    double largest = 0;
    for (int k = 0, first = 0; k < m->channels.n; first += m->channels.item[k++].n) {
        const double *other = b ? b + first : NULL;
        largest = larger(largest, difference(a + first, other, m->channels.item[k].n, m->norm));
    }
    return largest;
}

static int width_of(const bough_study_measure *m) {
    int n = 0;
    for (int k = 0; k < m->channels.n; k++) n += m->channels.item[k].n;
    return n;
}

void bough_study_norms(const bough_study *study, const double *value, double *norm) {
    for (int i = 0; i < study->n_measure; value += width_of(&study->measure[i++]))
        norm[i] = study->measure[i].scale * measured(&study->measure[i], value, NULL);
}

void bough_study_compare(const bough_study *study, const bough_study_series *series,
                         const bough_study_series *reference, double *error) {
    assert(series->filled == series->n_row && reference->filled == series->n_row);
    size_t first = 0;
    for (int i = 0; i < study->n_measure; first += (size_t)width_of(&study->measure[i++])) {
        const bough_study_measure *m = &study->measure[i];
        error[i] = 0;
        for (int row = 0; row < series->n_row; row++) {
            size_t at = (size_t)row * (size_t)series->n_channel + first;
            error[i] = larger(error[i], measured(m, series->value + at, reference->value + at));
        }
        error[i] *= m->scale;
    }
}

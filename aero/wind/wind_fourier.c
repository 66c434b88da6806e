#include "aero/wind/wind_fourier.h"

#include <complex.h>
#include <fftw3.h>
#include <pthread.h>
#include <stdlib.h>

struct bough_fourier {
    fftw_complex *amplitude; // (n/2 + 1)
    double *sum;             // (n)
    fftw_plan plan;
};

// The library's planner is one for the process.
static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

bough_fourier *bough_fourier_create(int n) {
    bough_fourier *f = calloc(1, sizeof *f);
    if (!f) return NULL;
    f->amplitude = fftw_malloc(((size_t)n / 2 + 1) * sizeof *f->amplitude);
    f->sum = fftw_malloc((size_t)n * sizeof *f->sum);
    if (f->amplitude && f->sum) {
        pthread_mutex_lock(&planner);
        f->plan = fftw_plan_dft_c2r_1d(n, f->amplitude, f->sum, FFTW_ESTIMATE);
        pthread_mutex_unlock(&planner);
    }
    if (f->plan) return f;
    bough_fourier_destroy(f);
    return NULL;
}

void bough_fourier_destroy(bough_fourier *f) {
    if (!f) return;
    pthread_mutex_lock(&planner);
    if (f->plan) fftw_destroy_plan(f->plan);
    pthread_mutex_unlock(&planner);
    fftw_free(f->amplitude);
    fftw_free(f->sum);
    free(f);
}

double *bough_fourier_amplitude(bough_fourier *f) { return (double *)f->amplitude; }

const double *bough_fourier_sum(bough_fourier *f) {
    fftw_execute(f->plan);
    return f->sum;
}

// Sums of harmonic waves at equal times. The only user of FFTW.
#ifndef BOUGH_AERO_WIND_FOURIER_H
#define BOUGH_AERO_WIND_FOURIER_H

typedef struct bough_fourier bough_fourier;

// For n times, even; NULL without memory. The plan is chosen without measuring, so that the same n
// always gives the same bits.
bough_fourier *bough_fourier_create(int n);
void bough_fourier_destroy(bough_fourier *f);

// Complex amplitudes of the waves 0 … n/2, real and imaginary part next to each other: set them
// before each sum, which overwrites them.
double *bough_fourier_amplitude(bough_fourier *f);

// x_k = A₀ + Σ 2 Re(A_m e^{2πi m k/n}) over m = 1 … n/2 − 1, with the amplitude n/2 once; x (n) is
// valid until the next sum.
const double *bough_fourier_sum(bough_fourier *f);

#endif

// Eigenvalues of the Jacobian of the whole, λ x = J x, nearest to a point 1/γ of the real axis,
// in tangents of the motion: no changes of a quaternion's length. Or, where equal parts of the
// system rotate steadily, of the system in the coordinates of an observer at rest.
//
// Let part k of n carry its states b_k in rotating axes at the azimuth ψ + 2πk/n. The multi-part
// (Coleman) transform writes them as z₀ + z_c cos ψ_k + z_s sin ψ_k + …; with ψ growing by Ω its
// rates add to J
//     −S,  S_kl = (Ω/n) Σ_h i h exp(i 2πh (k − l)/n),  |h| <= (n − 1)/2,
// in the parts' own coordinates, at whatever azimuth. If the parts are equal and evenly spaced and
// what carries them is symmetric, J − S is the constant matrix of the transformed system.
#pragma once

#include "core/base/eigen.h"
#include "cosim/whole.h"

typedef struct bough_modes_def {
    double time;         // [s]
    const double *state; // (n_state)
    const double *input; // (n_input), usually whole->input
    double point;        // 1/γ [1/s]
    double spin;         // Ω [rad/s]; 0: no part rotates
    int n_part, n_row;   // parts by growing azimuth; rows of each
    const int *row;      // (n_part × n_row) corresponding rows of the state
    int n_axes;          // first states whose axes turn; 0: none
    const double *axes;  // N dN⁺/dt of these, theory (123), column-major (n_axes × n_axes) [1/s]
} bough_modes_def;

// Harmonic h of a pattern over n parts, complex: (1/n) Σ_k y_k exp(−i 2πhk/n), y (n) and harmonic as real and
// imaginary part.
void bough_modes_harmonic(int n, int h, const double *real, const double *imaginary, double harmonic[2]);

// S of the parts (n_part × n_part), row-major; 0 where nothing rotates.
double *bough_modes_rate(bough_arena *arena, const bough_modes_def *def);

// sum += factor S x in the n corresponding rows of the parts, row (n_part × n).
void bough_modes_add_rate(const bough_modes_def *def, const double *rate, int n, const int *row,
                          double factor, const double *x, double *sum);

// Finds pairs as bough_eigen_nearest does, shapes (n_state). BOUGH_FAILED also where the
// spin is too fast for the point: it should be several times the largest h Ω, and the speed of the axes.
bough_status bough_modes_find(bough_arena *arena, bough_whole *whole, const bough_modes_def *def,
                              bough_eigen_pair *pair, bough_eigen_count *count);

// What every file of the program has: the usual headers of the C library, constants, small helpers.
#pragma once

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BOUGH_PI 3.14159265358979323846
#define BOUGH_DEGREE (BOUGH_PI / 180) // [rad]
#define BOUGH_RPM (BOUGH_PI / 30)     // [rad/s]

// In a function (…, format, ...): prints its arguments to the array `text`, cut at its size.
#define BOUGH_PRINT(text, format)                                                                            \
    do {                                                                                                     \
        va_list arguments_;                                                                                  \
        va_start(arguments_, format);                                                                        \
        vsnprintf(text, sizeof(text), format, arguments_);                                                   \
        va_end(arguments_);                                                                                  \
    } while (0)

// For functions called in loops over vector lanes: a loop with a call in it is not vectorised. Of a static
// function clang passes the members of structures one by one, and then cannot see that iterations are
// independent; hence extern inline.
#ifdef __clang__
#define BOUGH_INLINE extern inline __attribute__((always_inline, gnu_inline))
#else
#define BOUGH_INLINE static inline __attribute__((always_inline))
#endif

// Doubles per SIMD lane group; arrays over vertices and segments are padded to a multiple of it.
enum { BOUGH_LANES = 8 };

// Doubles of a column of six that is padded to one vector (core/base/block_tridiagonal.h).
enum { BOUGH_COLUMN = 8 };

static inline int bough_padded(int n) { return (n + BOUGH_LANES - 1) / BOUGH_LANES * BOUGH_LANES; }

static inline bool bough_all_zero(int n, const double *x) {
    for (int i = 0; i < n; i++)
        if (x[i] != 0) return false;
    return true;
}

// x − x is 0 where x is finite, else NaN; without a branch, for vector instructions.
static inline bool bough_all_finite(size_t n, const double *x) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++) sum += x[i] - x[i];
    return sum == 0;
}

static inline double bough_scalar_product(int n, const double *x, const double *y) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += x[i] * y[i];
    return sum;
}

// The largest |x|/scale.
static inline double bough_largest(int n, const double *x, const double *scale) {
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(x[i]) / scale[i]);
    return largest;
}

static inline double bough_clamp(double x, double low, double high) {
    return x < low ? low : x > high ? high : x;
}

// What follows the last '/' of a path: the name of a file.
static inline const char *bough_file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static inline bool bough_ends_with(const char *text, const char *end) {
    size_t length = strlen(text), n = strlen(end);
    return n <= length && strcmp(text + length - n, end) == 0;
}

// For qsort: doubles in rising order.
static inline int bough_ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// -- cubics ---------------------------------------------------------------------------------------

// The cubic q(x) = c₀ + c₁ x + c₂ x² + c₃ x³ over a length d that has given values and slopes at its ends
// (Hermite).

// c[0] = c₂ and c[1] = c₃ for the slopes s0 at 0 and s1 at d and that of the chord, (q(d) − q(0))/d.
static inline void bough_cubic_bend(double chord, double s0, double s1, double d, double c[2]) {
    c[0] = (3 * chord - 2 * s0 - s1) / d;
    c[1] = (s0 + s1 - 2 * chord) / (d * d);
}

// The slope at a knot between chords of slopes s0, s1 over h0, h1 for cubics as monotone as the knots: none
// at an extremum, else the harmonic mean weighted towards the shorter side.
static inline double bough_cubic_slope(double h0, double s0, double h1, double s1) {
    if (!(s0 * s1 > 0)) return 0;
    double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
    return (w0 + w1) / (w0 / s0 + w1 / s1);
}

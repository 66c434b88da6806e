// Elementary functions without branches, so that loops over them run in vector lanes, with
// errors of a few units in the last place. Polynomials of sine, cosine and arc tangent are those of
// fdlibm (Sun Microsystems, 1993).
#pragma once

#include "core/base/rotation.h"

// The nearest integer, for |x| < 2⁵¹.
BOUGH_INLINE double lane_round(double x) {
    const double big = 0x1.8p52;
    return (x + big) - big;
}

// An angle less multiples of 2π, in [−π, π].
BOUGH_INLINE double lane_remainder(double x) { return x - 2 * BOUGH_PI * lane_round(x * (0.5 / BOUGH_PI)); }

BOUGH_INLINE double lane_clamp(double x, double low, double high) {
    x = x > low ? x : low;
    return x < high ? x : high;
}

typedef struct sine_cosine {
    double sine, cosine;
} sine_cosine;

// For |x| ≤ π.
BOUGH_INLINE sine_cosine lane_sine_cosine(double x) {
    double n = lane_round(x * (2 / BOUGH_PI));
    double r = (x - n * 1.5707963267948966) - n * 6.123233995736766e-17, z = r * r;
    double s = 1.58969099521155010221e-10;
    s = -2.50507602534068634195e-08 + z * s;
    s = 2.75573137070700676789e-06 + z * s;
    s = -1.98412698298579493134e-04 + z * s;
    s = 8.33333333332248946124e-03 + z * s;
    s = r + r * z * (-1.66666666666666324348e-01 + z * s);
    double c = -1.13596475577881948265e-11;
    c = 2.08757232129817482790e-09 + z * c;
    c = -2.75573143513906633035e-07 + z * c;
    c = 2.48015872894767294178e-05 + z * c;
    c = -1.38888888888741095749e-03 + z * c;
    c = 1 - 0.5 * z + z * z * (4.16666666666666019037e-02 + z * c);
    double half = n * n > 2 ? -1 : 1, quarter = n * n == 1 ? 1 : 0;
    double sine = quarter > 0 ? n * c : half * s, cosine = quarter > 0 ? -n * s : half * c;
    return (sine_cosine){sine, cosine};
}

// eˣ = scale (1 + rest)
typedef struct exponential {
    double scale, rest;
} exponential;

// For −700 ≤ x ≤ 0.
BOUGH_INLINE exponential lane_exponential(double x) {
    const double big = 0x1.8p52;
    double shifted = x * 1.4426950408889634 + big, n = shifted - big;
    double r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10;
    double p = 1. / 6227020800;
    p = 1. / 479001600 + r * p;
    p = 1. / 39916800 + r * p;
    p = 1. / 3628800 + r * p;
    p = 1. / 362880 + r * p;
    p = 1. / 40320 + r * p;
    p = 1. / 5040 + r * p;
    p = 1. / 720 + r * p;
    p = 1. / 120 + r * p;
    p = 1. / 24 + r * p;
    p = 1. / 6 + r * p;
    // The low bits of `shifted` are n; moved into the exponent they make 2ⁿ.
    uint64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    bits = (bits + 1023) << 52;
    exponential e = {.rest = r * (1 + r * (0.5 + r * p))};
    memcpy(&e.scale, &bits, sizeof e.scale);
    return e;
}

BOUGH_INLINE double lane_exp(double x) {
    exponential e = lane_exponential(x);
    return (1 + e.rest) * e.scale;
}

// eˣ − 1
BOUGH_INLINE double lane_expm1(double x) {
    exponential e = lane_exponential(x);
    return e.scale * e.rest + (e.scale - 1);
}

// For |t| ≤ ½: asin(t)/t by its best polynomial of degree 12 in t².
BOUGH_INLINE double lane_arc_sine(double t) {
    double z = t * t, p = 0.028169218060881412899;
    p = -0.010749050339697807562 + z * p;
    p = 0.016035514349148823079 + z * p;
    p = 0.0078029494773533171436 + z * p;
    p = 0.0118754943826369232 + z * p;
    p = 0.013929652902326633248 + z * p;
    p = 0.017355259955786321748 + z * p;
    p = 0.022372047631744510379 + z * p;
    p = 0.030381947367098481126 + z * p;
    p = 0.044642857103423643363 + z * p;
    p = 0.075000000000207643609 + z * p;
    p = 0.16666666666666648628 + z * p;
    return t + t * z * p;
}

// atan2(y, x); 0 for both 0.
BOUGH_INLINE double lane_angle(double y, double x) {
    double ax = fabs(x), ay = fabs(y);
    double low = ax < ay ? ax : ay, high = ax < ay ? ay : ax;
    double wide = low > 0.4142135623730951 * high ? 1 : 0;
    double over = low - wide * high, under = high + wide * low;
    double t = over / (under > 1e-300 ? under : 1), z = t * t, p = 1.62858201153657823623e-02;
    p = -3.65315727442169155270e-02 + z * p;
    p = 4.97687799461593236017e-02 + z * p;
    p = -5.83357013379057348645e-02 + z * p;
    p = 6.66107313738753120669e-02 + z * p;
    p = -7.69187620504482999495e-02 + z * p;
    p = 9.09088713343650656196e-02 + z * p;
    p = -1.11111104054623557880e-01 + z * p;
    p = 1.42857142725034663711e-01 + z * p;
    p = -1.99999999998764832476e-01 + z * p;
    p = 3.33333333333329318027e-01 + z * p;
    double angle = wide * (BOUGH_PI / 4) + (t - t * z * p);
    angle = ax < ay ? BOUGH_PI / 2 - angle : angle;
    angle = x < 0 ? BOUGH_PI - angle : angle;
    return copysign(angle, y);
}

BOUGH_INLINE bough_vec3 lane_load(const double *restrict a, int stride, int i) {
    return (bough_vec3){a[i], a[stride + i], a[2 * stride + i]};
}

BOUGH_INLINE void lane_store(double *restrict a, int stride, int i, bough_vec3 v) {
    a[i] = v.x;
    a[stride + i] = v.y;
    a[2 * stride + i] = v.z;
}

BOUGH_INLINE void lane_add(double *restrict a, int stride, int i, bough_vec3 v) {
    lane_store(a, stride, i, bough_add(lane_load(a, stride, i), v));
}

BOUGH_INLINE bough_quaternion lane_load_quaternion(const double *restrict a, int stride, int i) {
    return (bough_quaternion){a[i], a[stride + i], a[2 * stride + i], a[3 * stride + i]};
}

// A matrix by its columns.
BOUGH_INLINE bough_mat3 lane_load_matrix(const double *restrict a, int stride, int i) {
    return (bough_mat3){lane_load(a, stride, i), lane_load(a + 3 * stride, stride, i),
                        lane_load(a + 6 * stride, stride, i)};
}

BOUGH_INLINE void lane_store_matrix(double *restrict a, int stride, int i, bough_mat3 m) {
    lane_store(a, stride, i, m.c1);
    lane_store(a + 3 * stride, stride, i, m.c2);
    lane_store(a + 6 * stride, stride, i, m.c3);
}

#include "apps/bough/results/number.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { DIGITS = 8, MOST = 22 }; // after the point; powers of ten up to 10²² are exact in any format

static const long double power[MOST + 1] = {1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,  1e7L,
                                            1e8L,  1e9L,  1e10L, 1e11L, 1e12L, 1e13L, 1e14L, 1e15L,
                                            1e16L, 1e17L, 1e18L, 1e19L, 1e20L, 1e21L, 1e22L};

// x·10^(8 − e): one rounding.
static long double scaled(double x, int e) {
    return e <= DIGITS ? x * power[DIGITS - e] : x / power[e - DIGITS];
}

// The nine digits of |x| as a whole number and the exponent of the first. False where rounding may
// decide otherwise than exact arithmetic, or x is too large or too small.
static bool nine_digits(double x, uint32_t *digits, int *exponent) {
    const long double doubtful = 4e9L * LDBL_EPSILON;
    int binary, e;
    if (x == 0) {
        *digits = *exponent = 0;
        return true;
    }
    if (!(x >= 1e-13 && x < 1e29)) return false;
    frexp(x, &binary);
    e = (int)floor((binary - 1) * 0.30102999566398120);
    long double v = scaled(x, e);
    if (v >= 1e9L) v = scaled(x, ++e);
    if (v < 1e8L) v = scaled(x, --e);
    uint32_t whole = (uint32_t)v;
    long double rest = v - whole;
    if (fabsl(rest - 0.5L) < doubtful) return false;
    if (rest > 0.5L) whole++;
    if (whole == 1000000000) {
        whole = 100000000;
        e++;
    }
    *digits = whole;
    *exponent = e;
    return whole >= 100000000 && e < 100;
}

void bough_number_write(char *to, int width, double x) {
    enum { LENGTH = DIGITS + 6 }; // "d.ddddddddE+dd"
    uint32_t digits;
    int e;
    if (!nine_digits(fabs(x), &digits, &e)) {
        snprintf(to, (size_t)width + 1, "%*.*E", width, DIGITS, x);
        return;
    }
    memset(to, ' ', (size_t)(width - LENGTH));
    char *out = to + width - LENGTH;
    if (signbit(x)) out[-1] = '-';
    for (int k = DIGITS + 1; k > 1; k--, digits /= 10) out[k] = (char)('0' + digits % 10);
    out[0] = (char)('0' + digits);
    out[1] = '.';
    int size = e < 0 ? -e : e;
    const char tail[5] = {'E', e < 0 ? '-' : '+', (char)('0' + size / 10), (char)('0' + size % 10), 0};
    memcpy(out + DIGITS + 2, tail, sizeof tail);
}

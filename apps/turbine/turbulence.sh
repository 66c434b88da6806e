#!/bin/sh
# Writes turbulence.bts beside this script: a TurbSim full-field box of 64 s that repeats, 5 x 5 points
# over 144 m, 18 m/s at 90 m with a power law of 0.14 and Kaimal's spectrum. Every frequency is one plane
# wave of random phase and slope in y and z, steeper the higher it is, which decorrelates distant points.
cd "$(dirname "$0")" || exit 1
export LC_ALL=C
escapes=$(awk '
function byte(b) { printf "\\%03o", b }
function int16(i) {
    i = int(i + (i < 0 ? -0.5 : 0.5))
    if (i < 0) i += 65536
    byte(i % 256); byte(int(i / 256))
}
function int32(i) { int16(i); int16(0) } # of small numbers
function float32(x,   s, e, m) { # of normal numbers and zero
    if (x == 0) { int32(0); return }
    s = x < 0; if (s) x = -x
    for (e = 127; x >= 2; e++) x /= 2
    for (; x < 1; e--) x *= 2
    m = int((x - 1) * 8388608 + 0.5)
    byte(m % 256); byte(int(m / 256) % 256); byte(int(m / 65536) + (e % 2) * 128)
    byte(int(e / 2) + s * 128)
}
function random() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
BEGIN {
    pi = 3.14159265358979; seed = 4711
    n = 5; times = 128; d = 36; dt = 0.5; U = 18; sigma = 1.8; L = 340.2; waves = 40
    T = times * dt
    split("1 0.8 0.5", share, " ")
    for (c = 1; c <= 3; c++) for (k = 1; k <= waves; k++) {
        f = k / T
        S = 4 * sigma * sigma * L / U / exp(5 / 3 * log(1 + 6 * f * L / U))
        a[c, k] = share[c] * sqrt(2 * S / T); phase[c, k] = 2 * pi * random()
        ky[c, k] = 12 * f / U * (2 * random() - 1); kz[c, k] = 12 * f / U * (2 * random() - 1)
    }
    int16(8); int32(n); int32(n); int32(0); int32(times)
    float32(d); float32(d); float32(dt); float32(U); float32(90); float32(18)
    for (c = 1; c <= 3; c++) { float32(1000); float32(c == 1 ? -18000 : 0) }
    int32(0)
    for (t = 0; t < times; t++) for (z = 0; z < n; z++) for (y = 0; y < n; y++)
        for (c = 1; c <= 3; c++) {
            v = c == 1 ? U * exp(0.14 * log((18 + d * z) / 90)) : 0
            for (k = 1; k <= waves; k++) {
                place = ky[c, k] * d * (y - 2) + kz[c, k] * d * (z - 2)
                v += a[c, k] * cos(2 * pi * k * t / times + phase[c, k] + place)
            }
            int16(1000 * v + (c == 1 ? -18000 : 0))
        }
}')
printf "$escapes" > turbulence.bts

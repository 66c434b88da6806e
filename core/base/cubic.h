// The cubic q(x) = c₀ + c₁ x + c₂ x² + c₃ x³ over a length d that has given values and slopes at its ends
// (Hermite).
#ifndef BOUGH_CORE_BASE_CUBIC_H
#define BOUGH_CORE_BASE_CUBIC_H

// c[0] = c₂ and c[1] = c₃ for the slopes s0 at 0 and s1 at d and that of the chord, (q(d) − q(0))/d.
static inline void bough_cubic_bend(double chord, double s0, double s1, double d, double c[2]) {
    c[0] = (3 * chord - 2 * s0 - s1) / d;
    c[1] = (s0 + s1 - 2 * chord) / (d * d);
}

#endif

#include "cosim/signal.h"

bough_signal bough_signal_create(bough_arena *arena, int n) {
    return (bough_signal){.n = n, .t0 = 0, .t1 = 1, .coefficient = bough_arena_doubles(arena, 4 * (size_t)n)};
}

// Component j is c0 + c1 τ + c2 τ² + c3 τ³.
static void set(bough_signal *s, int j, double c0, double c1, double c2, double c3) {
    double *c = s->coefficient + j;
    c[0] = c0;
    c[s->n] = c1;
    c[2 * s->n] = c2;
    c[3 * s->n] = c3;
}

void bough_signal_hold(bough_signal *s, int j, double value) { set(s, j, value, 0, 0, 0); }

void bough_signal_hold_rate(bough_signal *s, int j, double value, double rate) {
    set(s, j, value, (s->t1 - s->t0) * rate, 0, 0);
}

void bough_signal_linear(bough_signal *s, int j, double start, double end) {
    set(s, j, start, end - start, 0, 0);
}

void bough_signal_hermite(bough_signal *s, int j, bough_signal_end start, bough_signal_end end) {
    // the slopes per step, and the bend that gives value and slope at t1
    double length = s->t1 - s->t0, r0 = length * start.rate, r1 = length * end.rate, bend[2];
    bough_cubic_bend(end.value - start.value, r0, r1, 1, bend);
    set(s, j, start.value, r0, bend[0], bend[1]);
}

// Coefficients in τ of the Lagrange polynomial that is 1 at tau[p] and 0 at the other points.
static void lagrange(int n_point, const double *tau, int p, double c[4]) {
    // the product of (τ − τ_q)/(τ_p − τ_q), factor by factor
    c[0] = 1;
    c[1] = c[2] = c[3] = 0;
    for (int q = 0; q < n_point; q++) {
        if (q == p) continue;
        double scale = 1 / (tau[p] - tau[q]);
        for (int k = 3; k > 0; k--) c[k] = scale * (c[k - 1] - tau[q] * c[k]);
        c[0] *= -scale * tau[q];
    }
}

void bough_signal_polynomial(bough_signal *s, int j, int n_point, const double *time, const double *value) {
    assert(n_point >= 1 && n_point <= 4);
    double tau[4], basis[4], c[4] = {0};
    for (int p = 0; p < n_point; p++) tau[p] = (time[p] - s->t0) / (s->t1 - s->t0);
    // Σ value_p basis_p
    for (int p = 0; p < n_point; p++) {
        lagrange(n_point, tau, p, basis);
        for (int k = 0; k < 4; k++) c[k] += value[p] * basis[k];
    }
    set(s, j, c[0], c[1], c[2], c[3]);
}

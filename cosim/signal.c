#include "cosim/signal.h"

#include "core/base/base.h"

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

void bough_signal_hold(bough_signal *s, int first, int count, const double *value) {
    for (int j = 0; j < count; j++) set(s, first + j, value[j], 0, 0, 0);
}

void bough_signal_hold_rate(bough_signal *s, int first, int count, const double *value, const double *rate) {
    double length = s->t1 - s->t0;
    for (int j = 0; j < count; j++) set(s, first + j, value[j], length * rate[j], 0, 0);
}

void bough_signal_linear(bough_signal *s, int first, int count, const double *start, const double *end) {
    for (int j = 0; j < count; j++) set(s, first + j, start[j], end[j] - start[j], 0, 0);
}

void bough_signal_hermite(bough_signal *s, int first, int count, bough_signal_end start,
                          bough_signal_end end) {
    double length = s->t1 - s->t0;
    // the slopes per step, and the bend that meets value and slope at t1
    for (int j = 0; j < count; j++) {
        double r0 = length * start.rate[j], r1 = length * end.rate[j], bend[2];
        bough_cubic_bend(end.value[j] - start.value[j], r0, r1, 1, bend);
        set(s, first + j, start.value[j], r0, bend[0], bend[1]);
    }
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

void bough_signal_polynomial(bough_signal *s, int first, int count, int n_point, const double *time,
                             const double *const *value) {
    assert(n_point >= 1 && n_point <= 4);
    double tau[4], basis[4][4];
    // the basis at these times
    for (int p = 0; p < n_point; p++) tau[p] = (time[p] - s->t0) / (s->t1 - s->t0);
    for (int p = 0; p < n_point; p++) lagrange(n_point, tau, p, basis[p]);
    // Σ value_p basis_p
    for (int j = 0; j < count; j++) {
        double c[4] = {0};
        for (int p = 0; p < n_point; p++) {
            for (int k = 0; k < 4; k++) c[k] += value[p][j] * basis[p][k];
        }
        set(s, first + j, c[0], c[1], c[2], c[3]);
    }
}

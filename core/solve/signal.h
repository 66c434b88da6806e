// A vector-valued cubic in time.
#ifndef BOUGH_CORE_SIGNAL_H
#define BOUGH_CORE_SIGNAL_H

// On [t0, t1]: value(t) = Σ_k coefficient[k*n + i] τᵏ, τ = (t − t0)/(t1 − t0), k = 0..3.
typedef struct bough_signal {
    int n;
    double t0, t1;       // [s]
    double *coefficient; // (4 × n), in the units of the port
} bough_signal;

static inline void bough_signal_value(const bough_signal *s, double t, double *value) {
    double tau = (t - s->t0) / (s->t1 - s->t0);
    const double *c = s->coefficient;
    for (int i = 0; i < s->n; i++) {
        value[i] = c[i] + tau * (c[s->n + i] + tau * (c[2 * s->n + i] + tau * c[3 * s->n + i]));
    }
}

static inline void bough_signal_rate(const bough_signal *s, double t, double *rate) {
    double length = s->t1 - s->t0, tau = (t - s->t0) / length;
    const double *c = s->coefficient;
    for (int i = 0; i < s->n; i++) {
        double slope = c[s->n + i] + tau * (2 * c[2 * s->n + i] + tau * 3 * c[3 * s->n + i]);
        rate[i] = slope / length;
    }
}

#endif

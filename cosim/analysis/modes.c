// Modes of the whole, theory (74, 75, 76).
#include "cosim/analysis/modes.h"

enum { TERMS = 400 }; // of the series for the spin

static const double series = 1e-13; // of the solution: terms below are left out

typedef struct modes {
    bough_whole *whole;
    const bough_modes_def *def;
    double *term, *moved; // (n_state)
    double *rate;         // S (n_part × n_part)
    bool diverged;
} modes;

// A discrete Fourier transform, one harmonic of it.
void bough_modes_harmonic(int n, int h, const double *real, const double *imaginary, double harmonic[2]) {
    harmonic[0] = harmonic[1] = 0;
    for (int k = 0; k < n; k++) {
        double angle = -2 * BOUGH_PI * h * k / n, c = cos(angle), s = sin(angle);
        harmonic[0] += (c * real[k] - s * imaginary[k]) / n;
        harmonic[1] += (c * imaginary[k] + s * real[k]) / n;
    }
}

// theory (75). The sum over ±h of i h exp(i 2πh (k − l)/n) is −2 h sin(2πh (k − l)/n).
double *bough_modes_rate(bough_arena *arena, const bough_modes_def *def) {
    int n = def->n_part;
    double *rate = bough_arena_doubles(arena, (size_t)(n * n) + 1);
    for (int k = 0; k < n; k++) {
        for (int l = 0; l < n; l++) {
            double sum = 0;
            for (int h = 1; h <= (n - 1) / 2; h++) {
                sum -= 2 * h * sin(2 * BOUGH_PI * h * (k - l) / n);
            }
            rate[k * n + l] = def->spin / n * sum;
        }
    }
    return rate;
}

void bough_modes_add_rate(const bough_modes_def *def, const double *rate, int n, const int *row,
                          double factor, const double *x, double *sum) {
    for (int k = 0; k < def->n_part * def->n_part; k++) {
        const int *to = row + k / def->n_part * n, *from = row + k % def->n_part * n;
        for (int j = 0; j < n; j++) sum[to[j]] += factor * rate[k] * x[from[j]];
    }
}

// The maximum norm.
static double largest(const double *x, int n) {
    double most = 0;
    for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
    return most;
}

// sum ← γ(N dN⁺/dt − S) x
static void add_rates(const modes *m, const double *x, double *sum) {
    const bough_modes_def *def = m->def;
    memset(sum, 0, (size_t)m->whole->assembly->n_state * sizeof *sum);
    bough_modes_add_rate(def, m->rate, def->n_row, def->row, -1 / def->point, x, sum);
    for (int j = 0; j < def->n_axes; j++)
        for (int i = 0; i < def->n_axes; i++) sum[i] += def->axes[j * def->n_axes + i] * x[j] / def->point;
}

// theory (76): (I − γ(J − S))⁻¹ z = Σ (−(I − γJ)⁻¹ γS)ᵏ (I − γJ)⁻¹ z, with (123) in −S
static void apply_once(modes *m, const double *z, double *image) {
    int n = m->whole->assembly->n_state;
    // the first term, without rotation
    memcpy(image, z, (size_t)n * sizeof *image);
    bough_whole_solve(m->whole, image);
    bough_whole_project(m->whole, m->def->state, image);
    if ((m->def->spin == 0 && m->def->n_axes == 0) || m->diverged) return;
    // further terms until they are negligible
    double size = largest(image, n);
    memcpy(m->term, image, (size_t)n * sizeof *image);
    for (int k = 0; k < TERMS; k++) {
        add_rates(m, m->term, m->moved);
        memcpy(m->term, m->moved, (size_t)n * sizeof *m->term);
        bough_whole_solve(m->whole, m->term);
        bough_whole_project(m->whole, m->def->state, m->term);
        for (int i = 0; i < n; i++) image[i] += m->term[i];
        if (largest(m->term, n) <= series * size) return;
    }
    m->diverged = true;
}

static void apply(void *self, int n, const double *z, double *image) {
    modes *m = self;
    size_t length = (size_t)m->whole->assembly->n_state;
    for (int k = 0; k < n; k++) apply_once(m, z + (size_t)k * length, image + (size_t)k * length);
}

static void take(bough_arena *arena, modes *m, bough_eigen_operator *op) {
    const bough_assembly *a = m->whole->assembly;
    size_t n = (size_t)a->n_state;
    bough_arena_each(arena, n, &m->term, &m->moved, &op->weight);
    m->rate = bough_modes_rate(arena, m->def);
    bough_assembly_scales(a, op->weight);
    // states in units of their scales
    for (size_t k = 0; k < n; k++) op->weight[k] = 1 / (op->weight[k] * op->weight[k]);
}

bough_status bough_modes_find(bough_arena *arena, bough_whole *whole, const bough_modes_def *def,
                              bough_eigen_pair *pair, bough_eigen_count *count) {
    modes m = {.whole = whole, .def = def};
    bough_eigen_operator op = {.name = "whole scene",
                               .length = whole->assembly->n_state,
                               .n_shape = whole->assembly->n_state,
                               .gamma = 1 / def->point,
                               .self = &m,
                               .apply = apply};
    take(arena, &m, &op);
    // factors of I − γJ, then Arnoldi's method on their solutions
    bough_status status = bough_whole_setup(whole, def->time, def->state, def->input, op.gamma);
    if (!bough_is_ok(&status)) return bough_fail(BOUGH_FAILED, "%s", status.message);
    status = bough_eigen_nearest(arena, &op, pair, count);
    if (m.diverged) {
        return bough_fail(BOUGH_FAILED,
                          "the rotation is too fast for the transform's"
                          " series about %g /s",
                          def->point);
    }
    return status;
}

#include "flexbody/rod_static.h"

#include <string.h>

enum { W8 = 8 };

static const double most_turn = 0.5; // of a vertex in one Newton step [rad]

bough_rod_static_options bough_rod_static_options_default(void) {
    return (bough_rod_static_options){1e-10, 1, 12, 30};
}

bool bough_rod_static_init(bough_rod_static *work, bough_arena *arena, const bough_rod_model *m) {
    size_t states = (size_t)BOUGH_ROD_STATES * m->n;
    bool ok = bough_rod_scratch_init(&work->scratch, arena, m);
    ok = bough_rod_tangent_init(&work->tangent, arena, m) && ok;
    ok = bough_rod_loads_init(&work->scaled, arena, m) && ok;
    work->rate = bough_arena_doubles(arena, states);
    work->trial = bough_arena_doubles(arena, states);
    work->step = bough_arena_doubles(arena, (size_t)W8 * m->n);
    return ok && !bough_arena_exhausted(arena);
}

// Residual forces M v̇ of all vertices into step (n × 8); returns the largest component, forces and
// moments measured against `reference`.
static double residual(const bough_rod_model *m, bough_rod_static *w, double reference) {
    int n = m->n;
    const double *a = w->rate + (size_t)BOUGH_ROD_U * n;
    double largest = 0;
    for (int i = 0; i < n; i++) {
        double *row = w->step + (size_t)W8 * i;
        const double minus[W8] = {-a[i],         -a[n + i],     -a[2 * n + i], -a[3 * n + i],
                                  -a[4 * n + i], -a[5 * n + i], 0,             0};
        memset(row, 0, W8 * sizeof *row);
        bough_block_subtract(w->tangent.mass + (size_t)i * BOUGH_BLOCK, minus, row);
        for (int c = 0; c < 6; c++) largest = fmax(largest, fabs(row[c]));
    }
    return largest / reference;
}

// The largest stress resultant and load: what a residual is small against.
static double magnitude(const bough_rod_model *m, const bough_rod_static *w) {
    double largest = 1e-300;
    for (int c = 0; c < 9; c++) {
        for (int i = 0; i < m->n; i++) {
            largest = fmax(largest, fabs(w->scratch.segment[c * m->stride + i]));
        }
    }
    for (int k = 0; k < 6 * m->stride; k++) largest = fmax(largest, fabs(w->scratch.load[k]));
    return largest;
}

// x += δx, p ← p∘exp(δφ), shortened so that no vertex turns by more than most_turn. Returns the
// largest change, lengths measured against the rod's.
static double update(const bough_rod_model *m, const double *step, double *state) {
    int n = m->n;
    double turn = 0, shift = 0;
    for (int i = 0; i < n; i++) {
        const double *d = step + (size_t)W8 * i;
        turn = fmax(turn, bough_norm(bough_v3(d[3], d[4], d[5])));
        shift = fmax(shift, bough_norm(bough_v3(d[0], d[1], d[2])) / m->span[n]);
    }
    double share = turn > most_turn ? most_turn / turn : 1;
    for (int i = 0; i < n; i++) {
        const double *d = step + (size_t)W8 * i;
        bough_quaternion p = {state[3 * n + i], state[4 * n + i], state[5 * n + i],
                              state[6 * n + i]};
        bough_vec3 phi = bough_scale(share, bough_v3(d[3], d[4], d[5]));
        p = bough_quaternion_product(p, bough_quaternion_exponential(phi));
        p = bough_quaternion_normalised(p);
        for (int c = 0; c < 3; c++) state[c * n + i] += share * d[c];
        state[3 * n + i] = p.w;
        state[4 * n + i] = p.x;
        state[5 * n + i] = p.y;
        state[6 * n + i] = p.z;
    }
    return fmax(turn, shift);
}

// −K δq = residual, in place in step.
static bool newton_step(bough_rod_static *w) {
    bough_block_tridiagonal *k = &w->tangent.position, *a = &w->tangent.matrix;
    size_t count = (size_t)k->n * BOUGH_BLOCK;
    for (size_t j = 0; j < count; j++) {
        a->lower[j] = -k->lower[j];
        a->diagonal[j] = -k->diagonal[j];
        a->upper[j] = -k->upper[j];
    }
    if (!bough_block_tridiagonal_factor(a)) return false;
    bough_block_tridiagonal_solve(a, w->step);
    return true;
}

// Newton's method under w->scaled. False when it does not converge.
static bool converge(const bough_rod_model *m, bough_vec3 gravity,
                     const bough_rod_static_options *options, bough_rod_static *w, double *state) {
    const double input[BOUGH_ROD_INPUTS] = {0, 0, 0, 0, 0, 0, gravity.x, gravity.y, gravity.z};
    for (int k = 0; k < options->iterations; k++) {
        w->iterations++;
        if (!bough_rod_linearise(m, &w->scaled, 0, state, input, &w->scratch, &w->tangent)) {
            return false;
        }
        bough_rod_derivative(m, &w->scaled, 0, state, input, &w->scratch, w->rate);
        if (residual(m, w, magnitude(m, w)) < options->tolerance) return true;
        if (!newton_step(w)) return false;
        // rounding in a stiff rod keeps the residual up; then the steps tell
        if (update(m, w->step, state) < options->tolerance) return true;
    }
    return false;
}

static void scale_loads(const bough_rod_model *m, const bough_rod_loads *loads, double share,
                        bough_rod_static *w) {
    for (int k = 0; k < 6 * m->stride; k++) w->scaled.value[k] = share * loads->value[k];
}

bough_status bough_rod_equilibrium(const bough_rod_model *m, const bough_rod_loads *loads,
                                   bough_vec3 gravity, const bough_rod_static_options *options,
                                   bough_rod_static *work, double *state) {
    size_t bytes = (size_t)BOUGH_ROD_STATES * m->n * sizeof *state;
    memset(state + (size_t)BOUGH_ROD_U * m->n, 0, 6 * (size_t)m->n * sizeof *state);
    double reached = 0, increment = 1.0 / options->increments;
    work->iterations = 0;
    for (int halvings = 0; reached < 1;) {
        double target = fmin(reached + increment, 1);
        scale_loads(m, loads, target, work);
        memcpy(work->trial, state, bytes);
        if (converge(m, bough_scale(target, gravity), options, work, work->trial)) {
            memcpy(state, work->trial, bytes);
            reached = target;
        } else if (++halvings > options->halvings) {
            return bough_fail(BOUGH_FAILED, "rod %s: no static equilibrium found beyond %.4g %% of"
                              " the load; the rod may buckle there, or more segments are needed",
                              m->name, 100 * reached);
        } else {
            increment /= 2;
        }
    }
    return bough_ok();
}

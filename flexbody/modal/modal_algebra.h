// Small algebra of modal pieces: vectors over the shapes, matrices by columns (m × stride).
#ifndef BOUGH_FLEXBODY_MODAL_ALGEBRA_H
#define BOUGH_FLEXBODY_MODAL_ALGEBRA_H

#include "flexbody/modal/modal_piece.h"

#include <string.h>

static inline double dot(int n, const double *restrict x, const double *restrict y) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int k = 0; k < n; k++) sum += x[k] * y[k];
    return sum;
}

static inline void add_scaled(int n, double c, const double *restrict x, double *restrict y) {
#pragma omp simd
    for (int k = 0; k < n; k++) y[k] += c * x[k];
}

// y += c A x; of a unit vector x one column
static inline void add_product(const bough_modal_piece *p, double c, const double *a, const double *x,
                               double *y) {
    for (int l = 0; l < p->m; l++) {
        if (x[l] != 0) add_scaled(p->m, c * x[l], a + (size_t)l * p->stride, y);
    }
}

// y += Σ c_a A_a x of three matrices, one after the other in memory
static inline void add_products3(const bough_modal_piece *p, const double *c, const double *list,
                                 const double *x, double *restrict y) {
    size_t size = (size_t)p->m * p->stride;
    for (int l = 0; l < p->m; l++) {
        const double *restrict a = list + (size_t)l * p->stride;
        double c0 = c[0] * x[l], c1 = c[1] * x[l], c2 = c[2] * x[l];
#pragma omp simd
        for (int k = 0; k < p->m; k++) {
            y[k] += c0 * a[k] + c1 * a[size + k] + c2 * a[2 * size + k];
        }
    }
}

// y += Aᵀ x
static inline void add_transposed(const bough_modal_piece *p, const double *a, const double *x, double *y) {
    for (int l = 0; l < p->m; l++) y[l] += dot(p->m, a + (size_t)l * p->stride, x);
}

static inline const double *matrix(const bough_modal_piece *p, const double *list, int j) {
    return list + (size_t)j * p->m * p->stride;
}

static inline void clear(const bough_modal_piece *p, int rows, double *x) {
    memset(x, 0, (size_t)rows * p->stride * sizeof *x);
}

static inline double component(bough_vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

// The products of three rows with x, and their sum weighted by c.
static inline bough_vec3 dot3(const bough_modal_piece *p, const double *rows, const double *x) {
    const double *restrict a = rows, *restrict b = rows + p->stride;
    const double *restrict c = rows + 2 * p->stride, *restrict v = x;
    double sum_a = 0, sum_b = 0, sum_c = 0;
#pragma omp simd reduction(+ : sum_a, sum_b, sum_c)
    for (int k = 0; k < p->m; k++) {
        sum_a += a[k] * v[k];
        sum_b += b[k] * v[k];
        sum_c += c[k] * v[k];
    }
    return bough_v3(sum_a, sum_b, sum_c);
}

static inline void add3(const bough_modal_piece *p, double sign, const double *rows, bough_vec3 c,
                        double *y) {
    const double *restrict a = rows, *restrict b = rows + p->stride;
    const double *restrict d = rows + 2 * p->stride;
    double *restrict to = y;
    bough_vec3 w = bough_scale(sign, c);
#pragma omp simd
    for (int k = 0; k < p->m; k++) to[k] += w.x * a[k] + w.y * b[k] + w.z * d[k];
}

// Displacement and turn of moving vertex i = 1..n, in frame axes, for modal coordinates.
static inline bough_twist vertex_of(const bough_modal_piece *p, int i, const double *q) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    return (bough_twist){dot3(p, rows, q), dot3(p, rows + 3 * p->stride, q)};
}

// Φᵢᵀ(force, moment)
static inline void add_force(const bough_modal_piece *p, int i, bough_wrench w, double *to) {
    const double *rows = p->shape + (size_t)6 * (i - 1) * p->stride;
    add3(p, 1, rows, w.force, to);
    add3(p, 1, rows + 3 * p->stride, w.moment, to);
}

// A load of the body at vertex i, in frame axes.
static inline bough_wrench vertex_load(const bough_modal_point *at, const double *load, int stride, int i) {
    const double *f = load + at->piece->first + i;
    bough_mat3 r = at->frame.pose.rotation;
    return (bough_wrench){bough_mat3_tmul(r, bough_v3(f[0], f[stride], f[2 * stride])),
                          bough_mat3_tmul(r, bough_v3(f[3 * stride], f[4 * stride], f[5 * stride]))};
}

static inline bough_twist frame_twist(const bough_modal_frame *f) {
    return (bough_twist){f->velocity, f->spin};
}

// ω_aω_b in the order of the fields, of the symmetric product of two vectors.
static inline void squares(bough_vec3 v, bough_vec3 w, double *to) {
    const double values[6] = {v.x * w.x,
                              v.y * w.y,
                              v.z * w.z,
                              0.5 * (v.x * w.y + v.y * w.x),
                              0.5 * (v.x * w.z + v.z * w.x),
                              0.5 * (v.y * w.z + v.z * w.y)};
    memcpy(to, values, sizeof values);
}

// (C_a + G_a q)ᵀx
static inline bough_vec3 arms_times(const bough_modal_point *at, const double *x) {
    const bough_modal_piece *p = at->piece;
    return bough_add(dot3(p, p->rigid + 3 * p->stride, x), dot3(p, at->turn_q, x));
}

// Momentum (P, L) about the frame's origin.
static inline bough_wrench momentum_of(const bough_modal_point *at) {
    return (bough_wrench){dot3(at->piece, at->piece->rigid, at->eta), arms_times(at, at->eta)};
}

#endif

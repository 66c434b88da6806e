// Vectors of three components, by value.
#pragma once

#include "core/base/base.h"

typedef struct bough_vec3 {
    double x, y, z;
} bough_vec3;

// A 3×3 matrix by its columns; for a rotation these are the directors d1, d2, d3.
typedef struct bough_mat3 {
    bough_vec3 c1, c2, c3;
} bough_mat3;

BOUGH_INLINE bough_vec3 bough_v3(double x, double y, double z) { return (bough_vec3){x, y, z}; }
BOUGH_INLINE void bough_v3_store(bough_vec3 v, double *out) {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

BOUGH_INLINE bough_vec3 bough_v3_load(const double *x) { return (bough_vec3){x[0], x[1], x[2]}; }

// The unit vector along axis k = 0, 1, 2.
BOUGH_INLINE bough_vec3 bough_unit3(int k) { return (bough_vec3){k == 0, k == 1, k == 2}; }

BOUGH_INLINE bough_vec3 bough_add(bough_vec3 a, bough_vec3 b) {
    return (bough_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
BOUGH_INLINE bough_vec3 bough_sub(bough_vec3 a, bough_vec3 b) {
    return (bough_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
BOUGH_INLINE bough_vec3 bough_scale(double s, bough_vec3 a) {
    return (bough_vec3){s * a.x, s * a.y, s * a.z};
}
// a + s b
BOUGH_INLINE bough_vec3 bough_axpy(double s, bough_vec3 b, bough_vec3 a) {
    return (bough_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
// The point between a and b at a fraction of the way.
BOUGH_INLINE bough_vec3 bough_between(bough_vec3 a, bough_vec3 b, double fraction) {
    return (bough_vec3){a.x + fraction * (b.x - a.x), a.y + fraction * (b.y - a.y),
                        a.z + fraction * (b.z - a.z)};
}
BOUGH_INLINE double bough_dot(bough_vec3 a, bough_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
BOUGH_INLINE bough_vec3 bough_cross(bough_vec3 a, bough_vec3 b) {
    return (bough_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BOUGH_INLINE double bough_norm(bough_vec3 a) { return sqrt(bough_dot(a, a)); }

// A v and Aᵀ v
BOUGH_INLINE bough_vec3 bough_mat3_mul(bough_mat3 a, bough_vec3 v) {
    return (bough_vec3){a.c1.x * v.x + a.c2.x * v.y + a.c3.x * v.z,
                        a.c1.y * v.x + a.c2.y * v.y + a.c3.y * v.z,
                        a.c1.z * v.x + a.c2.z * v.y + a.c3.z * v.z};
}
BOUGH_INLINE bough_vec3 bough_mat3_tmul(bough_mat3 a, bough_vec3 v) {
    return (bough_vec3){bough_dot(a.c1, v), bough_dot(a.c2, v), bough_dot(a.c3, v)};
}
BOUGH_INLINE bough_mat3 bough_mat3_product(bough_mat3 a, bough_mat3 b) {
    return (bough_mat3){bough_mat3_mul(a, b.c1), bough_mat3_mul(a, b.c2), bough_mat3_mul(a, b.c3)};
}
BOUGH_INLINE bough_mat3 bough_mat3_transpose(bough_mat3 a) {
    return (bough_mat3){{a.c1.x, a.c2.x, a.c3.x}, {a.c1.y, a.c2.y, a.c3.y}, {a.c1.z, a.c2.z, a.c3.z}};
}
// The symmetric matrix of the entries xx yy zz xy xz yz.
BOUGH_INLINE bough_mat3 bough_mat3_symmetric(const double *j) {
    return (bough_mat3){{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}};
}
BOUGH_INLINE bough_mat3 bough_mat3_identity(void) { return (bough_mat3){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }

// Rotations: unit quaternions p = (w, x, y, z), their matrices and the exponential.
#ifndef BOUGH_CORE_ROTATION_H
#define BOUGH_CORE_ROTATION_H

#include "core/base/vec3.h"

typedef struct bough_quaternion {
    double w, x, y, z;
} bough_quaternion;

static inline bough_quaternion bough_quaternion_identity(void) { return (bough_quaternion){1, 0, 0, 0}; }

// p ∘ q
static inline bough_quaternion bough_quaternion_product(bough_quaternion p, bough_quaternion q) {
    return (bough_quaternion){
        p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
        p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x, p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}

static inline bough_quaternion bough_quaternion_conjugate(bough_quaternion p) {
    return (bough_quaternion){p.w, -p.x, -p.y, -p.z};
}

// p / |p|; the identity for the zero quaternion.
bough_quaternion bough_quaternion_normalised(bough_quaternion p);

// The rotation by the vector `phi` [rad], any angle.
bough_quaternion bough_quaternion_exponential(bough_vec3 phi);

// The rotation vector of p, of norm at most π [rad].
bough_vec3 bough_quaternion_logarithm(bough_quaternion p);

// (3): R(p) = (p₀² − |𝐩|²)E + 2 𝐩𝐩ᵀ + 2 p₀ ξ(𝐩), for |p| = 1.
static inline bough_mat3 bough_rotation_matrix(bough_quaternion p) {
    double w = p.w, x = p.x, y = p.y, z = p.z;
    return (bough_mat3){{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                        {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                        {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

// The quaternion of a rotation matrix, with w >= 0.
bough_quaternion bough_quaternion_of_matrix(bough_mat3 r);

#endif

// Rotations: unit quaternions p = (w, x, y, z), their matrices, exponential, logarithm and their tangents.
#pragma once

#include "core/base/vec3.h"

typedef struct bough_quaternion {
    double w, x, y, z;
} bough_quaternion;

BOUGH_INLINE bough_quaternion bough_quaternion_identity(void) { return (bough_quaternion){1, 0, 0, 0}; }

// p ∘ q
BOUGH_INLINE bough_quaternion bough_quaternion_product(bough_quaternion p, bough_quaternion q) {
    return (bough_quaternion){
        p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
        p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x, p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}

BOUGH_INLINE bough_quaternion bough_quaternion_conjugate(bough_quaternion p) {
    return (bough_quaternion){p.w, -p.x, -p.y, -p.z};
}

// p / |p|; the identity for the zero quaternion.
bough_quaternion bough_quaternion_normalised(bough_quaternion p);

// p / |p| for p ≠ 0, in loops over vector lanes.
BOUGH_INLINE bough_quaternion bough_quaternion_unit(bough_quaternion p) {
    double scale = 1 / sqrt(p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z);
    return (bough_quaternion){scale * p.w, scale * p.x, scale * p.y, scale * p.z};
}

// The rotation by the vector `phi` [rad], any angle.
bough_quaternion bough_quaternion_exponential(bough_vec3 phi);

// The rotation vector of p, of norm at most π [rad].
bough_vec3 bough_quaternion_logarithm(bough_quaternion p);

// theory (2, 3): R(p) = (p₀² − |𝐩|²)E + 2 𝐩𝐩ᵀ + 2 p₀ ξ(𝐩), for |p| = 1.
BOUGH_INLINE bough_mat3 bough_rotation_matrix(bough_quaternion p) {
    double w = p.w, x = p.x, y = p.y, z = p.z;
    return (bough_mat3){{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                        {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                        {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

// The quaternion of a rotation matrix, with w >= 0.
bough_quaternion bough_quaternion_of_matrix(bough_mat3 r);

// The rotation by an angle about a unit axis: cos E + sin ξ(a) + (1 − cos) a aᵀ
BOUGH_INLINE bough_mat3 bough_rotation_about(bough_vec3 a, double angle) {
    double c = cos(angle), s = sin(angle);
    return (bough_mat3){
        bough_axpy((1 - c) * a.x, a, bough_v3(c, s * a.z, -s * a.y)),
        bough_axpy((1 - c) * a.y, a, bough_v3(-s * a.z, c, s * a.x)),
        bough_axpy((1 - c) * a.z, a, bough_v3(s * a.y, -s * a.x, c)),
    };
}

// -- tangents of exponential and logarithm ---------------------------------------------------------

// The tangent of the exponential at ψ, J(ψ) v = v + b ψ×v + c ψ×(ψ×v), which takes ψ̇ to the angular velocity
// in fixed axes.
typedef struct bough_exp_factors {
    double b, c, db, dc; // and their derivatives by |ψ|²
} bough_exp_factors;

BOUGH_INLINE bough_exp_factors bough_exp_factors_of(bough_vec3 psi) {
    double t = bough_dot(psi, psi);
    if (t < 0.05) {
        return (bough_exp_factors){1 / 2. - t * (1 / 24. - t * (1 / 720. - t * (1 / 40320. - t / 3628800))),
                                   1 / 6. -
                                       t * (1 / 120. - t * (1 / 5040. - t * (1 / 362880. - t / 39916800))),
                                   -1 / 24. + t * (1 / 360. - t * (1 / 13440. - t / 907200)),
                                   -1 / 120. + t * (1 / 2520. - t * (1 / 120960. - t / 9979200))};
    }
    double angle = sqrt(t), b = (1 - cos(angle)) / t, c = (1 - sin(angle) / angle) / t;
    return (bough_exp_factors){b, c, (sin(angle) / angle - 2 * b) / (2 * t), (b - 3 * c) / (2 * t)};
}

BOUGH_INLINE bough_vec3 bough_exp_tangent(bough_exp_factors j, bough_vec3 psi, bough_vec3 v) {
    bough_vec3 once = bough_cross(psi, v);
    return bough_add(v, bough_axpy(j.c, bough_cross(psi, once), bough_scale(j.b, once)));
}

// Derivative of J(ψ) v along dψ, v held.
BOUGH_INLINE bough_vec3 bough_exp_tangent_change(bough_exp_factors j, bough_vec3 psi, bough_vec3 d,
                                                 bough_vec3 v) {
    double dt = 2 * bough_dot(psi, d);
    bough_vec3 once = bough_cross(psi, v), other = bough_cross(d, v);
    bough_vec3 twice = bough_add(bough_cross(d, once), bough_cross(psi, other));
    bough_vec3 first = bough_axpy(j.db * dt, once, bough_scale(j.b, other));
    return bough_add(first, bough_axpy(j.dc * dt, bough_cross(psi, once), bough_scale(j.c, twice)));
}

// Factors of the tangent of the logarithm, θ̇ = (E − ½ξ(θ) + β ξ(θ)²) ω, the inverse of J, at |θ| = `angle`:
// β = (1 − θ/2 cot θ/2)/θ², and *slope = β′/θ.
BOUGH_INLINE void bough_log_factors(double angle, double *beta, double *slope) {
    double a2 = angle * angle;
    if (angle < 0.1) {
        *beta = 1.0 / 12 + a2 * (1.0 / 720 + a2 * (1.0 / 30240 + a2 / 1209600));
        *slope = 1.0 / 360 + a2 * (1.0 / 7560 + a2 / 201600);
        return;
    }
    double half = 0.5 * angle, sine = sin(half), cotangent = cos(half) / sine;
    *beta = (1 - half * cotangent) / a2;
    *slope = (0.25 / (sine * sine) - 2 / a2 + 0.5 * cotangent / angle) / a2;
}

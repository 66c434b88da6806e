// Quaternion algebra that is not on the rod's hot path.
#include "core/base/rotation.h"

bough_quaternion bough_quaternion_normalised(bough_quaternion p) {
    double norm = sqrt(p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z);
    if (norm == 0) return bough_quaternion_identity();
    return (bough_quaternion){p.w / norm, p.x / norm, p.y / norm, p.z / norm};
}

bough_quaternion bough_quaternion_exponential(bough_vec3 phi) {
    double angle = bough_norm(phi);
    // sin(θ/2)/θ by its series where the quotient would lose digits
    double s = angle < 1e-4 ? 0.5 - angle * angle / 48 : sin(angle / 2) / angle;
    return (bough_quaternion){cos(angle / 2), s * phi.x, s * phi.y, s * phi.z};
}

// 2 atan2(|v|, w) v/|v|; p and −p are the same rotation.
bough_vec3 bough_quaternion_logarithm(bough_quaternion p) {
    double sign = p.w < 0 ? -1 : 1;
    bough_vec3 v = bough_scale(sign, bough_v3(p.x, p.y, p.z));
    double s = bough_norm(v);
    double factor = s < 1e-8 ? 2 : 2 * atan2(s, sign * p.w) / s;
    return bough_scale(factor, v);
}

bough_quaternion bough_quaternion_of_matrix(bough_mat3 r) {
    // Shepperd's choice of the largest component keeps every digit.
    double t = r.c1.x + r.c2.y + r.c3.z;
    bough_quaternion p;
    if (t > 0) {
        p = (bough_quaternion){1 + t, r.c2.z - r.c3.y, r.c3.x - r.c1.z, r.c1.y - r.c2.x};
    } else if (r.c1.x >= r.c2.y && r.c1.x >= r.c3.z) {
        p = (bough_quaternion){r.c2.z - r.c3.y, 1 + r.c1.x - r.c2.y - r.c3.z, r.c1.y + r.c2.x,
                               r.c3.x + r.c1.z};
    } else if (r.c2.y >= r.c3.z) {
        p = (bough_quaternion){r.c3.x - r.c1.z, r.c1.y + r.c2.x, 1 + r.c2.y - r.c1.x - r.c3.z,
                               r.c2.z + r.c3.y};
    } else {
        p = (bough_quaternion){r.c1.y - r.c2.x, r.c3.x + r.c1.z, r.c2.z + r.c3.y,
                               1 + r.c3.z - r.c1.x - r.c2.y};
    }
    p = bough_quaternion_normalised(p);
    return p.w < 0 ? (bough_quaternion){-p.w, -p.x, -p.y, -p.z} : p;
}

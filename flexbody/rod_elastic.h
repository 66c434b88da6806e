// The elastic law of one rod segment, whose curvature changes along it. Of the sections' energy
// ½∫κ·F⁻¹κ the mean strains e = (γ, κ) tell ½ e·C e; the moment that changes along the segment,
// m' = m×(κ⁰ + κ) − t×n, adds
//     −χΠ,  Π = y·L e + ½ y·G y,  y = m×κ,  (n, m) = C e,  χ = 1/(1 + R κ·κ),
// Π the part of h²/24 m'·F m' that is beyond linear statics: without it a rod that bends two ways at
// once twists wrongly by a share of h² (docs/theory.md). χ is 1 up to higher orders and keeps the
// energy positive whatever the strains: R = h²/12 times at least the ratio of the largest to the least
// stiffness. Inline, for loops over lanes.
#ifndef BOUGH_FLEXBODY_ROD_ELASTIC_H
#define BOUGH_FLEXBODY_ROD_ELASTIC_H

#include "flexbody/rod_segment.h"

// L e and G y of segment n, its arrays L by rows and G's upper triangle of the given stride.
static inline bough_vec3 gradient_linear(const double *restrict gradient, int stride, int n, strain e) {
#define L(k) gradient[(k) * stride + n]
    return (bough_vec3){
        L(0) * e.v.x + L(1) * e.v.y + L(2) * e.v.z + L(3) * e.u.x + L(4) * e.u.y + L(5) * e.u.z,
        L(6) * e.v.x + L(7) * e.v.y + L(8) * e.v.z + L(9) * e.u.x + L(10) * e.u.y + L(11) * e.u.z,
        L(12) * e.v.x + L(13) * e.v.y + L(14) * e.v.z + L(15) * e.u.x + L(16) * e.u.y + L(17) * e.u.z};
}

static inline bough_vec3 gradient_bend(const double *restrict gradient, int stride, int n, bough_vec3 y) {
    return (bough_vec3){L(18) * y.x + L(19) * y.y + L(20) * y.z,
                        L(19) * y.x + L(21) * y.y + L(22) * y.z,
                        L(20) * y.x + L(22) * y.y + L(23) * y.z};
}

// Lᵀ y
static inline strain gradient_transposed(const double *restrict gradient, int stride, int n, bough_vec3 y) {
#define COLUMN(j) (L(j) * y.x + L(6 + (j)) * y.y + L(12 + (j)) * y.z)
    return (strain){{COLUMN(0), COLUMN(1), COLUMN(2)}, {COLUMN(3), COLUMN(4), COLUMN(5)}};
#undef COLUMN
}

// C (0, p)
static inline strain moment_times(const double *restrict c, int stride, int n, bough_vec3 p) {
#define C(k) c[(k) * stride + n]
    return (strain){{C(3) * p.x + C(4) * p.y + C(5) * p.z, C(8) * p.x + C(9) * p.y + C(10) * p.z,
                     C(12) * p.x + C(13) * p.y + C(14) * p.z},
                    {C(15) * p.x + C(16) * p.y + C(17) * p.z, C(16) * p.x + C(18) * p.y + C(19) * p.z,
                     C(17) * p.x + C(19) * p.y + C(20) * p.z}};
#undef C
}

// What a segment's energy varies by.
typedef struct elastic_state {
    strain stress;   // C e
    bough_vec3 y, b; // m×κ, L e + G y
    double value;    // Π
    double limit;    // χ
    double slope;    // ∂χ/∂κ = slope κ
} elastic_state;

static inline elastic_state elastic_at(const double *restrict c, const double *restrict gradient,
                                       int stride, int n, strain e) {
    elastic_state s = {.stress = symmetric_times(c, stride, n, e)};
    s.y = bough_cross(s.stress.u, e.u);
    bough_vec3 linear = gradient_linear(gradient, stride, n, e);
    bough_vec3 bend = gradient_bend(gradient, stride, n, s.y);
    s.b = bough_add(linear, bend);
    s.value = bough_dot(s.y, bough_axpy(0.5, bend, linear));
    s.limit = 1 / (1 + L(24) * bough_dot(e.u, e.u));
    s.slope = -2 * L(24) * s.limit * s.limit;
    return s;
}

// ∂Π/∂e, δΠ = δm·(κ×b) + δκ·(b×m) + y·L δe.
static inline strain gradient_stress(const double *restrict c, const double *restrict gradient,
                                     int stride, int n, strain e, elastic_state s) {
    strain x = moment_times(c, stride, n, bough_cross(e.u, s.b));
    strain y = gradient_transposed(gradient, stride, n, s.y);
    bough_vec3 u = bough_add(bough_add(x.u, y.u), bough_cross(s.b, s.stress.u));
    return (strain){bough_add(x.v, y.v), u};
}

// The derivative of the energy: C e − χ ∂Π/∂e − Π ∂χ/∂e.
static inline strain segment_stress(const double *restrict c, const double *restrict gradient,
                                    int stride, int n, strain e) {
    elastic_state s = elastic_at(c, gradient, stride, n, e);
    strain p = gradient_stress(c, gradient, stride, n, e, s);
    bough_vec3 u = bough_axpy(-s.limit, p.u, s.stress.u);
    return (strain){bough_axpy(-s.limit, p.v, s.stress.v), bough_axpy(-s.value * s.slope, e.u, u)};
}

// Per length [N].
static inline double segment_energy(const double *restrict c, const double *restrict gradient,
                                    int stride, int n, strain e) {
    elastic_state s = elastic_at(c, gradient, stride, n, e);
    double straight = 0.5 * (bough_dot(e.v, s.stress.v) + bough_dot(e.u, s.stress.u));
    return straight - s.limit * s.value;
}

// The derivative of the stress: 21 entries of a symmetric matrix as C's, of stride `lanes`, at place l.
static inline void segment_stiffness(const double *restrict c, const double *restrict gradient,
                                     int stride, int n, strain e, int lanes, int l,
                                     double *restrict tangent) {
    static const int place[6][6] = {{0, 1, 2, 3, 4, 5},     {1, 6, 7, 8, 9, 10},
                                    {2, 7, 11, 12, 13, 14}, {3, 8, 12, 15, 16, 17},
                                    {4, 9, 13, 16, 18, 19}, {5, 10, 14, 17, 19, 20}};
    elastic_state s = elastic_at(c, gradient, stride, n, e);
    strain p = gradient_stress(c, gradient, stride, n, e, s);
    bough_vec3 m = s.stress.u;
    const double first[6] = {p.v.x, p.v.y, p.v.z, p.u.x, p.u.y, p.u.z};
    const double kappa[6] = {0, 0, 0, e.u.x, e.u.y, e.u.z};
    const bough_vec3 turned[6] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0},
                                  {0, m.z, -m.y}, {-m.z, 0, m.x}, {m.y, -m.x, 0}}; // m×δκ
    double bend = s.slope * s.value, twice = -4 * L(24) * s.limit * bend; // of Π ∂²χ/∂κ²
    bough_vec3 a[6], g[6];
    double q[6][6]; // δm of strain i times δκ of strain j, times b
    for (int j = 0; j < 6; j++) {
        bough_vec3 dm = {c[place[3][j] * stride + n], c[place[4][j] * stride + n],
                         c[place[5][j] * stride + n]};
        bough_vec3 row = {L(j), L(6 + j), L(12 + j)}, cross = bough_cross(s.b, dm);
        a[j] = bough_add(bough_cross(dm, e.u), turned[j]);
        g[j] = bough_axpy(0.5, gradient_bend(gradient, stride, n, a[j]), row);
        q[j][0] = q[j][1] = q[j][2] = 0;
        q[j][3] = cross.x, q[j][4] = cross.y, q[j][5] = cross.z;
    }
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            double second = bough_dot(a[i], g[j]) + bough_dot(g[i], a[j]) + q[i][j] + q[j][i];
            double sum = s.limit * second + s.slope * (first[i] * kappa[j] + kappa[i] * first[j]);
            sum += twice * kappa[i] * kappa[j] + (i == j && i > 2 ? bend : 0);
            tangent[place[i][j] * lanes + l] = c[place[i][j] * stride + n] - sum;
        }
    }
}

#undef L

#endif

// The elastic law of one rod segment, whose curvature changes along it. The mean strains e = (γ, κ) give the
// part ½ e·C e of the sections' energy ½∫κ·F⁻¹κ; the moment that changes along the segment, m' = m×(κ⁰ + κ) −
// t×n, adds
//     −χΠ,  Π = y·L e + ½ y·G y,  y = m×κ,  (n, m) = C e,  χ = 1/(1 + R κ·κ),
// Π the part of h²/24 m'·F m' that is beyond linear statics: without it a rod that bends two ways at
// once twists wrongly in proportion to h², theory (21). χ is 1 up to higher orders and keeps the
// energy positive whatever the strains: R = h²/12 times at least the ratio of the largest to the least
// stiffness. The sections lean against the segment's middle where it bends, so that its axis is longer than
// by the strains of the middle: e₃ is larger by ½ q·B q, q shear and bending of the segment, theory (107).
// Inline, for loops over lanes.
#pragma once

#include "flexbody/rod/rod_segment.h"

BOUGH_INLINE strain add_strain(strain a, strain b) {
    return (strain){bough_add(a.v, b.v), bough_add(a.u, b.u)};
}

// L e and G y of segment n, its arrays L by rows and G's upper triangle of the given stride.
BOUGH_INLINE bough_vec3 gradient_linear(const double *restrict gradient, int stride, int n, strain e) {
#define L(k) gradient[(k)*stride + n]
    return (bough_vec3){
        L(0) * e.v.x + L(1) * e.v.y + L(2) * e.v.z + L(3) * e.u.x + L(4) * e.u.y + L(5) * e.u.z,
        L(6) * e.v.x + L(7) * e.v.y + L(8) * e.v.z + L(9) * e.u.x + L(10) * e.u.y + L(11) * e.u.z,
        L(12) * e.v.x + L(13) * e.v.y + L(14) * e.v.z + L(15) * e.u.x + L(16) * e.u.y + L(17) * e.u.z};
}

BOUGH_INLINE bough_vec3 gradient_bend(const double *restrict gradient, int stride, int n, bough_vec3 y) {
    return (bough_vec3){L(18) * y.x + L(19) * y.y + L(20) * y.z, L(19) * y.x + L(21) * y.y + L(22) * y.z,
                        L(20) * y.x + L(22) * y.y + L(23) * y.z};
}

// Lᵀ y
BOUGH_INLINE strain gradient_transposed(const double *restrict gradient, int stride, int n, bough_vec3 y) {
#define COLUMN(j) (L(j) * y.x + L(6 + (j)) * y.y + L(12 + (j)) * y.z)
    return (strain){{COLUMN(0), COLUMN(1), COLUMN(2)}, {COLUMN(3), COLUMN(4), COLUMN(5)}};
#undef COLUMN
}

// C (0, p)
BOUGH_INLINE strain moment_times(const double *restrict c, int stride, int n, bough_vec3 p) {
#define C(k) c[(k)*stride + n]
    return (strain){{C(3) * p.x + C(4) * p.y + C(5) * p.z, C(8) * p.x + C(9) * p.y + C(10) * p.z,
                     C(12) * p.x + C(13) * p.y + C(14) * p.z},
                    {C(15) * p.x + C(16) * p.y + C(17) * p.z, C(16) * p.x + C(18) * p.y + C(19) * p.z,
                     C(17) * p.x + C(19) * p.y + C(20) * p.z}};
#undef C
}

// q: shear and bending.
typedef struct bow_strain {
    double x, y, a, b;
} bow_strain;

// The law at one strain.
typedef struct elastic_state {
    strain stress;       // C e, its moment m
    strain bent;         // ∂Π/∂e
    bough_vec3 kappa, b; // κ, L e + G y
    double value;        // Π
    double limit;        // χ
    double slope;        // ∂χ/∂κ = slope κ
    bow_strain pull;     // B q
    double tension;      // ∂/∂e₃ of the energy
} elastic_state;

// B q, the upper triangle of B by columns behind L, G and R.
BOUGH_INLINE bow_strain bow_times(const double *restrict gradient, int stride, int n, bow_strain q) {
    return (bow_strain){L(25) * q.x + L(26) * q.y + L(28) * q.a + L(31) * q.b,
                        L(26) * q.x + L(27) * q.y + L(29) * q.a + L(32) * q.b,
                        L(28) * q.x + L(29) * q.y + L(30) * q.a + L(33) * q.b,
                        L(31) * q.x + L(32) * q.y + L(33) * q.a + L(34) * q.b};
}

BOUGH_INLINE double bow_dot(bow_strain p, strain e) {
    return p.x * e.v.x + p.y * e.v.y + p.a * e.u.x + p.b * e.u.y;
}

BOUGH_INLINE bow_strain bow_of(strain e) { return (bow_strain){e.v.x, e.v.y, e.u.x, e.u.y}; }

BOUGH_INLINE strain add_bow(double tension, bow_strain p, strain e) {
    return (strain){{e.v.x + tension * p.x, e.v.y + tension * p.y, e.v.z},
                    {e.u.x + tension * p.a, e.u.y + tension * p.b, e.u.z}};
}

// ∂Π/∂e by δΠ = δm·(κ×b) + δκ·(b×m) + y·L δe.
BOUGH_INLINE elastic_state elastic_at(const double *restrict c, const double *restrict gradient, int stride,
                                      int n, strain e) {
    bow_strain pull = bow_times(gradient, stride, n, bow_of(e));
    e.v.z += 0.5 * bow_dot(pull, e);
    elastic_state s = {.stress = symmetric_times(c, stride, n, e), .kappa = e.u, .pull = pull};
    bough_vec3 m = s.stress.u, y = bough_cross(m, e.u);
    bough_vec3 linear = gradient_linear(gradient, stride, n, e);
    bough_vec3 bend = gradient_bend(gradient, stride, n, y);
    s.b = bough_add(linear, bend);
    s.bent = add_strain(moment_times(c, stride, n, bough_cross(e.u, s.b)),
                        gradient_transposed(gradient, stride, n, y));
    s.bent.u = bough_add(s.bent.u, bough_cross(s.b, m));
    s.value = bough_dot(y, bough_axpy(0.5, bend, linear));
    s.limit = 1 / (1 + L(24) * bough_dot(e.u, e.u));
    s.slope = -2 * L(24) * s.limit * s.limit;
    s.tension = s.stress.v.z - s.limit * s.bent.v.z;
    return s;
}

// The derivative of the energy: C e − χ ∂Π/∂e − Π ∂χ/∂e.
BOUGH_INLINE strain elastic_stress(elastic_state s) {
    bough_vec3 u = bough_axpy(-s.limit, s.bent.u, s.stress.u);
    strain stress = {bough_axpy(-s.limit, s.bent.v, s.stress.v), bough_axpy(-s.value * s.slope, s.kappa, u)};
    return add_bow(s.tension, s.pull, stress);
}

BOUGH_INLINE strain segment_stress(const double *restrict c, const double *restrict gradient, int stride,
                                   int n, strain e) {
    return elastic_stress(elastic_at(c, gradient, stride, n, e));
}

// Its variation: C δe − δχ ∂Π/∂e − χ δ∂Π/∂e − δ(Π slope) κ − Π slope δκ.
BOUGH_INLINE strain elastic_variation(const double *restrict c, const double *restrict gradient, int stride,
                                      int n, elastic_state s, strain de) {
    bow_strain dpull = bow_times(gradient, stride, n, bow_of(de));
    de.v.z += bow_dot(s.pull, de);
    strain stress = symmetric_times(c, stride, n, de);
    bough_vec3 m = s.stress.u, dm = stress.u;
    bough_vec3 dy = bough_add(bough_cross(dm, s.kappa), bough_cross(m, de.u));
    bough_vec3 db =
        bough_add(gradient_linear(gradient, stride, n, de), gradient_bend(gradient, stride, n, dy));
    bough_vec3 dp = bough_add(bough_cross(de.u, s.b), bough_cross(s.kappa, db));
    strain bent = add_strain(moment_times(c, stride, n, dp), gradient_transposed(gradient, stride, n, dy));
    bent.u = bough_add(bent.u, bough_add(bough_cross(db, m), bough_cross(s.b, dm)));
    double along = bough_dot(s.kappa, de.u), dlimit = s.slope * along;
    double dvalue = bough_dot(s.bent.v, de.v) + bough_dot(s.bent.u, de.u);
    double dslope = -4 * L(24) * s.limit * dlimit;
    bough_vec3 u = bough_axpy(-(dvalue * s.slope + s.value * dslope), s.kappa, stress.u);
    u = bough_axpy(-s.value * s.slope, de.u, u);
    strain sum = {bough_axpy(-dlimit, s.bent.v, bough_axpy(-s.limit, bent.v, stress.v)),
                  bough_axpy(-dlimit, s.bent.u, bough_axpy(-s.limit, bent.u, u))};
    return add_bow(sum.v.z, s.pull, add_bow(s.tension, dpull, sum));
}

#undef L

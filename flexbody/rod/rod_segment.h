// The kernel of one rod segment: strains, strain rates and the forces that are the exact gradient
// of its energy, theory (17, 18, 19, 20), with their directional derivative. Inline, so that
// loops over segments vectorise.
//
// Everything rotational is resolved in the segment's mid frame R_mid = Rₙ exp(φ/2), φ = log(RₙᵀRₙ₊₁).
// With the relative quaternion d = p̄ₙ∘pₙ₊₁ = (w, v), w = cos θ/2, v = sin θ/2 n, t = tan θ/4 n:
//     φ = c(w) v,  c = 2 acos(w)/√(1 − w²),            strain U = φ/h
//     exp(φ/2) y = y + v×y + t×(v×y)
//     δφ_mid = ½(a + b) + ½ (b − a)×t,                 a, b: vertex rotations in the mid frame
//     δφ = H (b − a),  H = ½ (c E − g v vᵀ),  g = (c − 2)/(1 − w²)
// The chord y = R_midᵀ Δx/h of a bent segment is shorter than its axis: V = y − v×(v×y)/6, that of
// constant strains to fourth order in φ. So tension stiffens the bow within a segment.
#pragma once

#include "core/base/rotation.h"

// A vertex as a segment sees it, and its variation.
typedef struct vertex_state {
    bough_vec3 x, u, w; // position, velocity (BRF axes), angular velocity (section axes)
    bough_quaternion p; // unit
} vertex_state;

typedef struct vertex_variation {
    bough_vec3 x, phi, u, w; // phi: rotation increment in section axes
} vertex_variation;

typedef struct strain {
    bough_vec3 v, u; // shear and extension; bending and twist
} strain;

typedef struct segment_geometry {
    bough_mat3 r;       // R_mid
    bough_vec3 v, t;    // sin θ/2 n, tan θ/4 n
    double w, c, g;     // cos θ/2 >= 0
    double e, slope;    // 1/(1 + w), dg/dw
    bough_vec3 chord;   // R_midᵀ Δx/h
    bough_vec3 stretch; // V
    bough_vec3 phi;     // φ
} segment_geometry;

typedef struct segment_rate {
    bough_vec3 du;       // R_midᵀ (uₙ₊₁ − uₙ)
    bough_vec3 middle;   // angular velocity of the mid frame
    bough_vec3 relative; // b − a of the angular velocities
    bough_vec3 wl, wr;   // section-axes angular velocities of the two vertices
} segment_rate;

typedef struct segment_force {
    bough_vec3 f;      // on the left vertex, in BRF axes; −f on the right one
    bough_vec3 ll, lr; // moments on the left and right vertex, in their section axes
} segment_force;

// g(w) for w in [½, 1], that is relative rotations up to 120°: Chebyshev interpolation of degree
// 13 in 1 − w, relative error 3e-15.
#define GEOMETRY_DEGREE 13
static const double geometry_g[GEOMETRY_DEGREE + 1] = {
    0.3333333333333328,    0.30000000000042426,   0.20714285708788696,   0.128968256765497,
    0.07602806449043223,   0.0433432440191777,    0.0241455286901389,    0.013330651083026,
    0.006789708601738262,  0.0051402607408433205, -0.000883989726343168, 0.00555548493648075,
    -0.003622265067882274, 0.0022922422065466564};

BOUGH_INLINE double geometry_value(double w) {
    double z = 1 - w, sum = geometry_g[GEOMETRY_DEGREE];
    for (int k = GEOMETRY_DEGREE - 1; k >= 0; k--) sum = sum * z + geometry_g[k];
    return sum;
}

// dg/dw
BOUGH_INLINE double geometry_slope(double w) {
    double z = 1 - w, sum = GEOMETRY_DEGREE * geometry_g[GEOMETRY_DEGREE];
    for (int k = GEOMETRY_DEGREE - 1; k >= 1; k--) sum = sum * z + k * geometry_g[k];
    return -sum;
}

BOUGH_INLINE bough_vec3 half_forward(bough_vec3 v, bough_vec3 t, bough_vec3 y) {
    bough_vec3 z = bough_cross(v, y);
    return bough_add(bough_add(y, z), bough_cross(t, z));
}

BOUGH_INLINE bough_vec3 half_backward(bough_vec3 v, bough_vec3 t, bough_vec3 y) {
    bough_vec3 z = bough_cross(v, y);
    return bough_add(bough_sub(y, z), bough_cross(t, z));
}

// H y
BOUGH_INLINE bough_vec3 rotation_tangent(double c, double g, bough_vec3 v, bough_vec3 y) {
    return bough_axpy(-0.5 * g * bough_dot(v, y), v, bough_scale(0.5 * c, y));
}

// Of unit quaternions, whose sum has the square 2 (1 + w) = 2/s.
BOUGH_INLINE bough_mat3 mid_frame(bough_quaternion l, bough_quaternion r, double sign, double s) {
    double w = l.w + sign * r.w, x = l.x + sign * r.x, y = l.y + sign * r.y, z = l.z + sign * r.z;
    return (bough_mat3){{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
                        {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
                        {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}};
}

BOUGH_INLINE bough_mat3 mid_frame_between(bough_quaternion l, bough_quaternion r) {
    double w = l.w * r.w + l.x * r.x + l.y * r.y + l.z * r.z;
    return mid_frame(l, r, copysign(1.0, w), 1 / (1 + fabs(w)));
}

// y − v×(v×y)/6, its variation with v, the gradient of n·(y − v×(v×y)/6) by v, and the variation with both.
BOUGH_INLINE bough_vec3 along_axis(bough_vec3 v, bough_vec3 y) {
    return bough_axpy(-1. / 6 * bough_dot(v, y), v, bough_scale(1 + 1. / 6 * bough_dot(v, v), y));
}

BOUGH_INLINE bough_vec3 along_axis_turned(bough_vec3 v, bough_vec3 dv, bough_vec3 y) {
    bough_vec3 sum = bough_axpy(bough_dot(dv, y), v, bough_scale(bough_dot(v, y), dv));
    return bough_axpy(-1. / 6, sum, bough_scale(1. / 3 * bough_dot(v, dv), y));
}

BOUGH_INLINE bough_vec3 bow_moment(bough_vec3 v, bough_vec3 y, bough_vec3 n) {
    bough_vec3 sum = bough_axpy(bough_dot(v, n), y, bough_scale(bough_dot(v, y), n));
    return bough_axpy(-1. / 6, sum, bough_scale(1. / 3 * bough_dot(y, n), v));
}

BOUGH_INLINE bough_vec3 along_axis_variation(bough_vec3 v, bough_vec3 dv, bough_vec3 y, bough_vec3 dy) {
    return bough_add(along_axis(v, dy), along_axis_turned(v, dv, y));
}

// δv for the rotations of the ends, `turn` their difference b − a.
BOUGH_INLINE bough_vec3 half_turn(bough_vec3 v, bough_vec3 t, bough_vec3 turn) {
    return bough_scale(0.5, bough_axpy(-bough_dot(v, turn), t, turn));
}

BOUGH_INLINE segment_geometry segment_shape(vertex_state l, vertex_state r, double inverse_h) {
    segment_geometry s;
    bough_quaternion d = bough_quaternion_product(bough_quaternion_conjugate(l.p), r.p);
    double sign = copysign(1.0, d.w); // p and −p are the same rotation
    s.w = sign * d.w;
    s.v = bough_scale(sign, bough_v3(d.x, d.y, d.z));
    s.e = 1 / (1 + s.w);
    s.t = bough_scale(s.e, s.v);
    s.g = geometry_value(s.w);
    s.slope = geometry_slope(s.w);
    s.c = 2 + s.g * bough_dot(s.v, s.v);
    s.phi = bough_scale(s.c, s.v);
    s.r = mid_frame(l.p, r.p, sign, s.e);
    s.chord = bough_scale(inverse_h, bough_mat3_tmul(s.r, bough_sub(r.x, l.x)));
    s.stretch = along_axis(s.v, s.chord);
    return s;
}

// That of a segment between two vertices at rest.
BOUGH_INLINE segment_geometry shape_between(const bough_vec3 x[2], const bough_quaternion p[2],
                                            double inverse_h) {
    return segment_shape((vertex_state){.x = x[0], .p = p[0]}, (vertex_state){.x = x[1], .p = p[1]},
                         inverse_h);
}

BOUGH_INLINE segment_rate segment_motion(segment_geometry s, vertex_state l, vertex_state r) {
    segment_rate m;
    bough_vec3 a = half_backward(s.v, s.t, l.w), b = half_forward(s.v, s.t, r.w);
    m.relative = bough_sub(b, a);
    m.middle = bough_scale(0.5, bough_add(bough_add(a, b), bough_cross(m.relative, s.t)));
    m.du = bough_mat3_tmul(s.r, bough_sub(r.u, l.u));
    m.wl = l.w;
    m.wr = r.w;
    return m;
}

// ẏ = (R_midᵀ Δu)/h + y×ω_mid
BOUGH_INLINE bough_vec3 chord_rate(segment_geometry s, segment_rate m, double inverse_h) {
    return bough_axpy(inverse_h, m.du, bough_cross(s.chord, m.middle));
}

// ė by ẏ and H (b − a)/h; a rigid motion gives zero.
BOUGH_INLINE strain strain_rate(segment_geometry s, segment_rate m, double inverse_h) {
    bough_vec3 turning = half_turn(s.v, s.t, m.relative);
    bough_vec3 v = along_axis_variation(s.v, turning, s.chord, chord_rate(s, m, inverse_h));
    bough_vec3 u = bough_scale(inverse_h, rotation_tangent(s.c, s.g, s.v, m.relative));
    return (strain){v, u};
}

// C e for the symmetric matrix of segment n, stored as 21 arrays of the given stride.
BOUGH_INLINE strain symmetric_times(const double *c, int stride, int n, strain e) {
#define C(k) c[(k)*stride + n]
    strain y;
    y.v.x = C(0) * e.v.x + C(1) * e.v.y + C(2) * e.v.z + C(3) * e.u.x + C(4) * e.u.y + C(5) * e.u.z;
    y.v.y = C(1) * e.v.x + C(6) * e.v.y + C(7) * e.v.z + C(8) * e.u.x + C(9) * e.u.y + C(10) * e.u.z;
    y.v.z = C(2) * e.v.x + C(7) * e.v.y + C(11) * e.v.z + C(12) * e.u.x + C(13) * e.u.y + C(14) * e.u.z;
    y.u.x = C(3) * e.v.x + C(8) * e.v.y + C(12) * e.v.z + C(15) * e.u.x + C(16) * e.u.y + C(17) * e.u.z;
    y.u.y = C(4) * e.v.x + C(9) * e.v.y + C(13) * e.v.z + C(16) * e.u.x + C(18) * e.u.y + C(19) * e.u.z;
    y.u.z = C(5) * e.v.x + C(10) * e.v.y + C(14) * e.v.z + C(17) * e.u.x + C(19) * e.u.y + C(20) * e.u.z;
#undef C
    return y;
}

// Vertex forces of the stress (n, m): virtual work n·δ(h V) + m·δφ.
BOUGH_INLINE segment_force stress_force(segment_geometry s, strain stress, double h) {
    bough_vec3 n = along_axis(s.v, stress.v);
    bough_vec3 tau = bough_scale(0.5 * h, bough_cross(n, s.chord));
    bough_vec3 bow = bow_moment(s.v, s.chord, stress.v);
    bough_vec3 bend = rotation_tangent(s.c, s.g, s.v, stress.u);
    bend = bough_axpy(0.5 * h, bough_axpy(-bough_dot(s.t, bow), s.v, bow), bend);
    bough_vec3 conjugate = bough_add(bough_cross(s.t, tau), bend);
    bough_vec3 a = bough_sub(tau, conjugate), b = bough_add(tau, conjugate);
    segment_force f;
    f.f = bough_mat3_mul(s.r, n);
    f.ll = bough_scale(-1, half_forward(s.v, s.t, a));
    f.lr = bough_scale(-1, half_backward(s.v, s.t, b));
    return f;
}

// -- directional derivative ---------------------------------------------------------------------

// Variation of the segment's shape and motion along vertex variations.
typedef struct segment_variation {
    bough_vec3 v, t, middle; // of v, of t, rotation of the mid frame
    double w, c, g;
    bough_vec3 chord, stretch, phi;
} segment_variation;

// δ of half_forward(v, t, y) and half_backward with δy given
BOUGH_INLINE bough_vec3 half_forward_variation(segment_geometry s, segment_variation d, bough_vec3 y,
                                               bough_vec3 dy) {
    bough_vec3 z = bough_cross(s.v, y);
    bough_vec3 dz = bough_add(bough_cross(d.v, y), bough_cross(s.v, dy));
    return bough_add(bough_add(dy, dz), bough_add(bough_cross(d.t, z), bough_cross(s.t, dz)));
}

BOUGH_INLINE bough_vec3 half_backward_variation(segment_geometry s, segment_variation d, bough_vec3 y,
                                                bough_vec3 dy) {
    bough_vec3 z = bough_cross(s.v, y);
    bough_vec3 dz = bough_add(bough_cross(d.v, y), bough_cross(s.v, dy));
    return bough_add(bough_sub(dy, dz), bough_add(bough_cross(d.t, z), bough_cross(s.t, dz)));
}

// δ(H y) with δy given
BOUGH_INLINE bough_vec3 tangent_variation(segment_geometry s, segment_variation d, bough_vec3 y,
                                          bough_vec3 dy) {
    double vy = bough_dot(s.v, y), dvy = bough_dot(d.v, y) + bough_dot(s.v, dy);
    bough_vec3 sum = bough_add(bough_scale(d.c, y), bough_scale(s.c, dy));
    sum = bough_axpy(-d.g * vy - s.g * dvy, s.v, sum);
    return bough_scale(0.5, bough_axpy(-s.g * vy, d.v, sum));
}

BOUGH_INLINE segment_variation shape_variation(segment_geometry s, vertex_variation l, vertex_variation r,
                                               double inverse_h) {
    segment_variation d;
    bough_vec3 a = half_backward(s.v, s.t, l.phi), b = half_forward(s.v, s.t, r.phi);
    bough_vec3 turn = bough_sub(b, a);
    d.middle = bough_scale(0.5, bough_add(bough_add(a, b), bough_cross(turn, s.t)));
    d.w = -0.5 * bough_dot(s.v, turn);
    d.v = half_turn(s.v, s.t, turn);
    d.t = bough_scale(s.e, bough_axpy(-d.w, s.t, d.v));
    d.c = (s.g - s.c * s.e) * d.w;
    d.g = s.slope * d.w;
    d.phi = rotation_tangent(s.c, s.g, s.v, turn);
    d.chord =
        bough_axpy(inverse_h, bough_mat3_tmul(s.r, bough_sub(r.x, l.x)), bough_cross(s.chord, d.middle));
    d.stretch = along_axis_variation(s.v, d.v, s.chord, d.chord);
    return d;
}

// δ of half_turn, its `turn` varying by dturn
BOUGH_INLINE bough_vec3 half_turn_variation(segment_geometry s, segment_variation d, bough_vec3 turn,
                                            bough_vec3 dturn) {
    double dot = bough_dot(s.v, turn), change = bough_dot(d.v, turn) + bough_dot(s.v, dturn);
    bough_vec3 sum = bough_axpy(-change, s.t, bough_axpy(-dot, d.t, dturn));
    return bough_scale(0.5, sum);
}

BOUGH_INLINE strain rate_variation(segment_geometry s, segment_rate m, segment_variation d,
                                   const vertex_variation *l, const vertex_variation *r, double inverse_h) {
    bough_vec3 da = half_backward_variation(s, d, m.wl, l->w);
    bough_vec3 db = half_forward_variation(s, d, m.wr, r->w);
    bough_vec3 relative = bough_sub(db, da);
    bough_vec3 twist = bough_add(bough_cross(relative, s.t), bough_cross(m.relative, d.t));
    bough_vec3 middle = bough_scale(0.5, bough_add(bough_add(da, db), twist));
    bough_vec3 du = bough_add(bough_mat3_tmul(s.r, bough_sub(r->u, l->u)), bough_cross(m.du, d.middle));
    bough_vec3 y =
        bough_axpy(inverse_h, du, bough_add(bough_cross(d.chord, m.middle), bough_cross(s.chord, middle)));
    bough_vec3 turning = half_turn(s.v, s.t, m.relative);
    bough_vec3 dturning = half_turn_variation(s, d, m.relative, relative);
    bough_vec3 v = along_axis_variation(s.v, d.v, chord_rate(s, m, inverse_h), y);
    v = bough_add(v, along_axis_turned(s.v, dturning, s.chord));
    v = bough_add(v, along_axis_turned(s.v, turning, d.chord));
    v = bough_add(v, along_axis_turned(d.v, turning, s.chord));
    bough_vec3 u = bough_scale(inverse_h, tangent_variation(s, d, m.relative, relative));
    return (strain){v, u};
}

// δ of stress_force with δ(stress) given
BOUGH_INLINE segment_force force_variation(segment_geometry s, segment_variation d, strain stress,
                                           strain dstress, double h) {
    bough_vec3 n = along_axis(s.v, stress.v);
    bough_vec3 dn = along_axis_variation(s.v, d.v, stress.v, dstress.v);
    bough_vec3 tau = bough_scale(0.5 * h, bough_cross(n, s.chord));
    bough_vec3 dtau = bough_scale(0.5 * h, bough_add(bough_cross(dn, s.chord), bough_cross(n, d.chord)));
    bough_vec3 bow = bow_moment(s.v, s.chord, stress.v), dbow = bow_moment(d.v, s.chord, stress.v);
    dbow = bough_add(dbow, bow_moment(s.v, d.chord, stress.v));
    dbow = bough_add(dbow, bow_moment(s.v, s.chord, dstress.v));
    double dot = bough_dot(s.t, bow), ddot = bough_dot(d.t, bow) + bough_dot(s.t, dbow);
    bough_vec3 bend = rotation_tangent(s.c, s.g, s.v, stress.u);
    bend = bough_axpy(0.5 * h, bough_axpy(-dot, s.v, bow), bend);
    bough_vec3 dbend = bough_axpy(-dot, d.v, bough_axpy(-ddot, s.v, dbow));
    dbend = bough_axpy(0.5 * h, dbend, tangent_variation(s, d, stress.u, dstress.u));
    bough_vec3 conjugate = bough_add(bough_cross(s.t, tau), bend);
    bough_vec3 dconjugate = bough_add(bough_add(bough_cross(d.t, tau), bough_cross(s.t, dtau)), dbend);
    bough_vec3 a = bough_sub(tau, conjugate), da = bough_sub(dtau, dconjugate);
    bough_vec3 b = bough_add(tau, conjugate), db = bough_add(dtau, dconjugate);
    segment_force f;
    f.f = bough_mat3_mul(s.r, bough_add(dn, bough_cross(d.middle, n)));
    f.ll = bough_scale(-1, half_forward_variation(s, d, a, da));
    f.lr = bough_scale(-1, half_backward_variation(s, d, b, db));
    return f;
}

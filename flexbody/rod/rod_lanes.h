// Vertices and segments in structures of arrays: loads and stores for loops over vector lanes.
#ifndef BOUGH_FLEXBODY_ROD_ROD_LANES_H
#define BOUGH_FLEXBODY_ROD_ROD_LANES_H

#include "core/base/lanes.h"
#include "flexbody/rod/rod.h"
#include "flexbody/rod/rod_elastic.h"

BOUGH_INLINE vertex_state load_vertex(const double *restrict v, int s, int i) {
    return (vertex_state){lane_load(v, s, i), lane_load(v + 7 * s, s, i), lane_load(v + 10 * s, s, i),
                          lane_load_quaternion(v + 3 * s, s, i)};
}

// The shape of segment n in the configuration in scratch->vertex.
BOUGH_INLINE segment_geometry shape_at(const bough_rod_model *m, const bough_rod_scratch *scratch, int n) {
    return segment_shape(load_vertex(scratch->vertex, m->stride, n),
                         load_vertex(scratch->vertex, m->stride, n + 1), m->inverse_length[n]);
}

// I W for the tensor entries Ixx Iyy Izz Ixy Ixz Iyz.
BOUGH_INLINE bough_vec3 inertia_times(const double *restrict j, int s, int i, bough_vec3 w) {
    double xx = j[i], yy = j[s + i], zz = j[2 * s + i], xy = j[3 * s + i], xz = j[4 * s + i];
    double yz = j[5 * s + i];
    return (bough_vec3){xx * w.x + xy * w.y + xz * w.z, xy * w.x + yy * w.y + yz * w.z,
                        xz * w.x + yz * w.y + zz * w.z};
}

// e − e⁰ − D q of a segment, `rest` the strains without stress
BOUGH_INLINE strain elastic_strain(segment_geometry shape, double inverse_h, const double *restrict rest,
                                   int s, int n) {
    return (strain){bough_sub(shape.stretch, lane_load(rest, s, n)),
                    bough_axpy(inverse_h, shape.phi, bough_scale(-1, lane_load(rest + 3 * s, s, n)))};
}

// D q of a load per length in the axes of the segment's middle: force, moment, and their slopes
BOUGH_INLINE strain line_strain(const double *restrict line, int s, int n, const bough_vec3 q[4]) {
#define D(part, i, j) line[(36 * (part) + 6 * (i) + (j)) * s + n]
#define HALF(part, i, f, m)                                                                                  \
    (D(part, i, 0) * (f).x + D(part, i, 1) * (f).y + D(part, i, 2) * (f).z + D(part, i, 3) * (m).x +         \
     D(part, i, 4) * (m).y + D(part, i, 5) * (m).z)
#define ROW(i) (HALF(0, i, q[0], q[1]) + HALF(1, i, q[2], q[3]))
    return (strain){{ROW(0), ROW(1), ROW(2)}, {ROW(3), ROW(4), ROW(5)}};
#undef HALF
#undef ROW
#undef D
}

// Change of the elastic strain where dead loads `along` the segment turn against its middle.
BOUGH_INLINE strain add_turned(strain change, const double *restrict line, const double *restrict along,
                               int s, int n, bough_vec3 middle) {
    const bough_vec3 q[4] = {bough_cross(lane_load(along, s, n), middle),
                             bough_cross(lane_load(along + 3 * s, s, n), middle),
                             bough_cross(lane_load(along + 6 * s, s, n), middle),
                             bough_cross(lane_load(along + 9 * s, s, n), middle)};
    strain e = line_strain(line, s, n, q);
    return (strain){bough_sub(change.v, e.v), bough_sub(change.u, e.u)};
}

// Beside the chord of a bent segment its axis lies by −(h/12) of the tangent's change in the mean, where a
// load per length acts: its moment on each of the two vertices.
BOUGH_INLINE bough_vec3 chord_moment(double h, bough_vec3 change, bough_vec3 load) {
    return bough_scale(-h * h / 24, bough_cross(change, load));
}

// theory (23): the same of a load that rotates with the sections, in the axes of the middle: the end couples
// t×q h²/12 that D q represents rotate with it, and their differences between segments remain.
BOUGH_INLINE bough_vec3 following_moment(double h, bough_vec3 bend, bough_vec3 load) {
    return bough_scale(-h * h / 24, bough_cross(bend, (bough_vec3){-load.y, load.x, 0}));
}

// Adds what the turns phi of the sections change in these moments of the loads along segment n, dead ones and
// followers.
// NOLINTNEXTLINE(readability-function-size): what the equation names
BOUGH_INLINE segment_force add_chord_moments(segment_force f, segment_geometry shape, segment_variation d,
                                             bough_mat3 rl, bough_mat3 rr, bough_vec3 phi_l, bough_vec3 phi_r,
                                             bough_vec3 bend0, bough_vec3 turn0, bough_vec3 along,
                                             bough_vec3 following, double h) {
    const bough_vec3 tangent = {0, 0, 1};
    bough_vec3 change = bough_sub(bough_mat3_mul(rr, bough_cross(phi_r, tangent)),
                                  bough_mat3_mul(rl, bough_cross(phi_l, tangent)));
    change = bough_sub(change, bough_mat3_mul(shape.r, bough_cross(d.middle, bend0)));
    bough_vec3 moment = chord_moment(h, change, bough_mat3_mul(shape.r, along));
    bough_vec3 bend = bough_axpy(-h, turn0, shape.phi);
    bough_vec3 turned = bough_cross(d.middle, following_moment(h, bend, following));
    turned = bough_add(turned, following_moment(h, d.phi, following));
    moment = bough_add(moment, bough_mat3_mul(shape.r, turned));
    f.ll = bough_add(f.ll, bough_mat3_tmul(rl, moment));
    f.lr = bough_add(f.lr, bough_mat3_tmul(rr, moment));
    return f;
}

// Derivative of the forces of segment n along variations of its vertices.
BOUGH_INLINE segment_force segment_tangent(const bough_rod_model *m, const bough_rod_scratch *scratch, int n,
                                           const vertex_variation *dl, const vertex_variation *dr) {
    int s = m->stride;
    double h = m->length[n], inverse = m->inverse_length[n];
    vertex_state l = load_vertex(scratch->vertex, s, n), r = load_vertex(scratch->vertex, s, n + 1);
    segment_geometry shape = segment_shape(l, r, inverse);
    segment_rate motion = segment_motion(shape, l, r);
    strain e = elastic_strain(shape, inverse, scratch->rest, s, n);
    strain rate = strain_rate(shape, motion, inverse);
    const double *c = bough_rod_tile(m->stiffness, 21, n), *viscous = bough_rod_tile(m->damping, 21, n);
    const double *gradient = bough_rod_tile(m->gradient, 35, n);
    elastic_state elastic = elastic_at(c, gradient, BOUGH_LANES, 0, e);
    strain stress = add_strain(elastic_stress(elastic), symmetric_times(viscous, BOUGH_LANES, 0, rate));
    segment_variation d = shape_variation(shape, *dl, *dr, inverse);
    strain de = {d.stretch, bough_scale(inverse, d.phi)};
    if (scratch->turning) de = add_turned(de, m->line, scratch->along, s, n, d.middle);
    strain drate = rate_variation(shape, motion, d, dl, dr, inverse);
    strain dstress = add_strain(elastic_variation(c, gradient, BOUGH_LANES, 0, elastic, de),
                                symmetric_times(viscous, BOUGH_LANES, 0, drate));
    segment_force f = force_variation(shape, d, stress, dstress, h);
    if (!scratch->turning) return f;
    return add_chord_moments(f, shape, d, bough_rotation_matrix(l.p), bough_rotation_matrix(r.p), dl->phi,
                             dr->phi, lane_load(m->bend0, s, n), lane_load(m->strain0 + 3 * s, s, n),
                             lane_load(scratch->along, s, n), lane_load(scratch->following, s, n), h);
}

#endif

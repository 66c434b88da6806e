// Vertices and segments in structures of arrays: loads and stores for loops over vector lanes.
#pragma once

#include "core/base/lanes.h"
#include "flexbody/rod/rod.h"
#include "flexbody/rod/rod_elastic.h"

// The name of bough_rod_NAME in a file of kernels (core/base/level.h).
#define AT(name) BOUGH_AT_LEVEL(bough_rod_##name)

// How many of n vertices fill whole vectors of a kernel's width.
BOUGH_INLINE int whole_vectors(int n, int width) { return n - n % width; }

// Calls the expression behind `last` for `count` vertices from v on, through the vertices first to last: for
// whole vectors of the kernel's width, then for one that ends with the last vertex. This one repeats some of
// the vector before, and takes less time than a call for each vertex that is left.
#define FOR_VECTORS(first, last, ...)                                                                        \
    do {                                                                                                     \
        int left_ = (last) + 1 - (first), end_ = (first) + whole_vectors(left_, BOUGH_WIDTH);                \
        bool repeats_ = left_ > BOUGH_WIDTH && (last) > end_;                                                \
        {                                                                                                    \
            enum { count = BOUGH_WIDTH };                                                                    \
            for (int v = (first); v < end_; v += count) __VA_ARGS__;                                         \
            if (repeats_) {                                                                                  \
                int v = (last) + 1 - count;                                                                  \
                __VA_ARGS__;                                                                                 \
            }                                                                                                \
        }                                                                                                    \
        enum { count = 1 };                                                                                  \
        for (int v = end_; v <= (last) && !repeats_; v++) __VA_ARGS__;                                       \
    } while (0)

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

BOUGH_INLINE strain subtract_strain(strain a, strain b) {
    return (strain){bough_sub(a.v, b.v), bough_sub(a.u, b.u)};
}

// Dead loads along a segment: force, moment and their slopes in the axes of its middle, their strain D q, and
// the segment's stress under the forces on its ends alone.
typedef struct dead_line {
    bough_vec3 q[4];
    strain own, stress;
} dead_line;

BOUGH_INLINE dead_line dead_line_at(const double *restrict c, int lane, const double *restrict line,
                                    const double *restrict along, int s, int n, elastic_state elastic) {
    dead_line x = {.q = {lane_load(along, s, n), lane_load(along + 3 * s, s, n),
                         lane_load(along + 6 * s, s, n), lane_load(along + 9 * s, s, n)}};
    x.own = line_strain(line, s, n, x.q);
    x.stress = add_strain(elastic_stress(elastic), symmetric_times(c, BOUGH_LANES, lane, x.own));
    return x;
}

// Its change where the middle turns; of the stress only by that.
BOUGH_INLINE dead_line dead_line_turned(const double *restrict c, int lane, const double *restrict line,
                                        int s, int n, const dead_line *x, bough_vec3 middle) {
    dead_line d = {.q = {bough_cross(x->q[0], middle), bough_cross(x->q[1], middle),
                         bough_cross(x->q[2], middle), bough_cross(x->q[3], middle)}};
    d.own = line_strain(line, s, n, d.q);
    d.stress = symmetric_times(c, BOUGH_LANES, lane, d.own);
    return d;
}

// theory (22): forces q per length act on the axis, Dᵀ S beside the chord: their moment on the middle.
BOUGH_INLINE bough_vec3 axis_moment(const double *restrict line, int s, int n, double h, strain stress,
                                    const bough_vec3 q[4]) {
#define D(part, i, j) line[(36 * (part) + 6 * (i) + (j)) * s + n]
#define COLUMN(part, j)                                                                                      \
    (D(part, 0, j) * stress.v.x + D(part, 1, j) * stress.v.y + D(part, 2, j) * stress.v.z +                  \
     D(part, 3, j) * stress.u.x + D(part, 4, j) * stress.u.y + D(part, 5, j) * stress.u.z)
    bough_vec3 mean = {COLUMN(0, 0), COLUMN(0, 1), COLUMN(0, 2)};
    bough_vec3 slope = {COLUMN(1, 0), COLUMN(1, 1), COLUMN(1, 2)};
#undef COLUMN
#undef D
    return bough_scale(h, bough_add(bough_cross(mean, q[0]), bough_cross(slope, q[2])));
}

// Moments on the two vertices of a segment, in their axes.
typedef struct end_moments {
    bough_vec3 left, right;
} end_moments;

// A moment on the middle, in its axes, does the work of these; and their variation.
BOUGH_INLINE end_moments middle_moment(segment_geometry shape, bough_vec3 moment) {
    bough_vec3 half = bough_scale(0.5, moment), tilt = bough_cross(shape.t, half);
    return (end_moments){half_forward(shape.v, shape.t, bough_sub(half, tilt)),
                         half_backward(shape.v, shape.t, bough_add(half, tilt))};
}

BOUGH_INLINE end_moments middle_moment_variation(segment_geometry shape, segment_variation d,
                                                 bough_vec3 moment, bough_vec3 change) {
    bough_vec3 half = bough_scale(0.5, moment), dhalf = bough_scale(0.5, change);
    bough_vec3 tilt = bough_cross(shape.t, half);
    bough_vec3 dtilt = bough_add(bough_cross(d.t, half), bough_cross(shape.t, dhalf));
    return (end_moments){half_forward_variation(shape, d, bough_sub(half, tilt), bough_sub(dhalf, dtilt)),
                         half_backward_variation(shape, d, bough_add(half, tilt), bough_add(dhalf, dtilt))};
}

// Moment on each vertex of a load per length that acts on the axis of a bent segment: this lies beside the
// chord, in the mean by −(h/12) of the tangent's change.
BOUGH_INLINE bough_vec3 chord_moment(double h, bough_vec3 change, bough_vec3 load) {
    return bough_scale(-h * h / 24, bough_cross(change, load));
}

// theory (23): the same of a load that rotates with the sections, in the axes of the middle: the end couples
// t×q h²/12 that D q represents rotate with it, and their differences between segments remain.
BOUGH_INLINE bough_vec3 following_moment(double h, bough_vec3 bend, bough_vec3 load) {
    return bough_scale(-h * h / 24, bough_cross(bend, (bough_vec3){-load.y, load.x, 0}));
}

// Adds what the turns phi of the sections change in the moments of the loads along segment n: dead ones,
// whose stress changes by dstress with the elastic strain, and followers.
// NOLINTNEXTLINE(readability-function-size): what the equations name
BOUGH_INLINE segment_force add_line_moments(segment_force f, segment_geometry shape, segment_variation d,
                                            const double *restrict line, int s, int n, double h,
                                            const dead_line *dead, const dead_line *turned, strain dstress,
                                            bough_mat3 rl, bough_mat3 rr, vertex_variation dl,
                                            vertex_variation dr, bough_vec3 turn0, bough_vec3 following) {
    bough_vec3 moment = axis_moment(line, s, n, h, dead->stress, dead->q);
    bough_vec3 change = axis_moment(line, s, n, h, dead->stress, turned->q);
    change = bough_add(change, axis_moment(line, s, n, h, add_strain(dstress, turned->stress), dead->q));
    end_moments on = middle_moment(shape, moment);
    end_moments don = middle_moment_variation(shape, d, moment, change);
    bough_vec3 bend = bough_axpy(-h, turn0, shape.phi);
    bough_vec3 follower = bough_cross(d.middle, following_moment(h, bend, following));
    follower = bough_add(follower, following_moment(h, d.phi, following));
    f.ll = bough_add(f.ll, bough_add(don.left, bough_cross(dl.phi, on.left)));
    f.lr = bough_add(f.lr, bough_add(don.right, bough_cross(dr.phi, on.right)));
    follower = bough_mat3_mul(shape.r, follower);
    f.ll = bough_add(f.ll, bough_mat3_tmul(rl, follower));
    f.lr = bough_add(f.lr, bough_mat3_tmul(rr, follower));
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
    dead_line dead = {0}, turned = {0};
    if (scratch->turning) {
        dead = dead_line_at(c, 0, m->line, scratch->along, s, n, elastic);
        turned = dead_line_turned(c, 0, m->line, s, n, &dead, d.middle);
        de = subtract_strain(de, turned.own);
    }
    strain drate = rate_variation(shape, motion, d, dl, dr, inverse);
    strain delastic = elastic_variation(c, gradient, BOUGH_LANES, 0, elastic, de);
    strain dstress = add_strain(delastic, symmetric_times(viscous, BOUGH_LANES, 0, drate));
    segment_force f = force_variation(shape, d, stress, dstress, h);
    if (!scratch->turning) return f;
    return add_line_moments(f, shape, d, m->line, s, n, h, &dead, &turned, delastic,
                            bough_rotation_matrix(l.p), bough_rotation_matrix(r.p), *dl, *dr,
                            lane_load(m->strain0 + 3 * s, s, n), lane_load(scratch->following, s, n));
}

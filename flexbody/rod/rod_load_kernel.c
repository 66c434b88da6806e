// Loads along the segments: the strains that they cause, and their axes.
#include "flexbody/rod/rod_lanes.h"
#include "flexbody/rod/rod_load.h"

// Row by row D q = D₀ (mean) + D₁ (slope).
void AT(line_strain)(const bough_rod_model *m, const double *line, double *along) {
    int s = m->stride, n = m->n_segment;
    for (int i = 0; i < 6; i++) {
        const double *restrict d = m->line + 6 * i * s;
        double *restrict row = along + i * s;
#pragma omp simd
        for (int k = 0; k < n; k++) {
            double sum = 0;
            for (int j = 0; j < 6; j++) {
                sum += d[j * s + k] * line[j * n + k] + d[(36 + j) * s + k] * line[(6 + j) * n + k];
            }
            row[k] = sum;
        }
    }
}

// d₃ of the section with the quaternion p.
BOUGH_INLINE bough_vec3 tangent_of(bough_quaternion p) {
    return (bough_vec3){2 * (p.x * p.z + p.w * p.y), 2 * (p.y * p.z - p.w * p.x),
                        1 - 2 * (p.x * p.x + p.y * p.y)};
}

// Segments first..first + count − 1: their line loads in the axes of their middles, and the moments of these
// about the chords.
BOUGH_INLINE void turn_line(const bough_rod_model *m, const double *restrict rotation,
                            const double *restrict line, int first, int count, double *restrict turned,
                            double *restrict moment) {
    int n = m->n_segment, v = n + 1, s = m->stride;
    const double *restrict bend = m->bend0 + first, *restrict h = m->length + first;
#pragma omp simd
    for (int l = 0; l < count; l++) {
        int k = first + l;
        bough_quaternion p = bough_quaternion_unit(lane_load_quaternion(rotation, v, k));
        bough_quaternion q = bough_quaternion_unit(lane_load_quaternion(rotation, v, k + 1));
        bough_mat3 r = mid_frame_between(p, q);
        // mean force and moment, slopes of force and moment
        for (int part = 0; part < 4; part++) {
            lane_store(turned + 3 * part * n, n, k, bough_mat3_tmul(r, lane_load(line + 3 * part * n, n, k)));
        }
        // how much more the tangent changes over the segment than in the undeformed rod
        bough_vec3 change = bough_sub(tangent_of(q), tangent_of(p));
        change = bough_sub(change, bough_mat3_mul(r, lane_load(bend, s, l)));
        lane_store(moment, BOUGH_LANES, l, chord_moment(h[l], change, lane_load(line, n, k)));
    }
}

void AT(take_line)(const bough_rod_model *m, const double *rotation, const double *line, double *turned,
                   double *load) {
    int n = m->n_segment, v = n + 1;
    for (int first = 0; first < n; first += BOUGH_LANES) {
        int count = n - first < BOUGH_LANES ? n - first : BOUGH_LANES;
        double moment[3 * BOUGH_LANES];
        turn_line(m, rotation, line, first, count, turned, moment);
        // a pass for the left and one for the right vertices, because neighbours share one
        for (int c = 0; c < 3; c++) {
            double *restrict to = load + (3 + c) * v + first;
            const double *restrict from = moment + c * BOUGH_LANES;
#pragma omp simd
            for (int l = 0; l < count; l++) to[l] += from[l];
#pragma omp simd
            for (int l = 0; l < count; l++) to[l + 1] += from[l];
        }
    }
}

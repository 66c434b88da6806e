// Wrenches and stresses of a rod.
#include "flexbody/rod/rod_lanes.h"

void bough_rod_present_root_wrench(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                   double *wrench) {
    int s = m->stride;
    const double *f = scratch->segment;
    // the first segment's pull on vertex 0, with its moment in BRF axes, and the loads there
    bough_vec3 moment = bough_mat3_mul(m->root, bough_v3(f[3 * s], f[4 * s], f[5 * s]));
    const double inner[6] = {f[0], f[s], f[2 * s], moment.x, moment.y, moment.z};
    for (int c = 0; c < 6; c++) wrench[c] = inner[c] + scratch->load[c * s];
}

void bough_rod_present_end_wrench(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                  double *wrench) {
    int s = m->stride, end = m->n_segment;
    bough_mat3 r = bough_rotation_matrix(load_vertex(scratch->vertex, s, end).p);
    const double *f = scratch->segment + end - 1, *load = scratch->load + end;
    // the loads on the last vertex, their moment in section axes, and the pull of the last segment
    bough_vec3 moment = bough_mat3_tmul(r, lane_load(load + 3 * s, s, 0));
    lane_store(wrench, 1, 0, bough_sub(lane_load(load, s, 0), lane_load(f, s, 0)));
    lane_store(wrench + 3, 1, 0, bough_add(moment, lane_load(f + 6 * s, s, 0)));
}

// By the balance of the segment's left half: pretwist and curvature make it differ a little from what
// the strains are conjugate to.
void bough_rod_stress(const bough_rod_model *m, const bough_rod_scratch *scratch, int n, double stress[6]) {
    // the stress that the strains are conjugate to
    segment_geometry shape = shape_at(m, scratch, n);
    strain e = elastic_strain(shape, m->inverse_length[n], scratch->rest, m->stride, n);
    strain s = segment_stress(bough_rod_tile(m->stiffness, 21, n), bough_rod_tile(m->gradient, 35, n),
                              BOUGH_LANES, 0, e);
    // forces of the segment on its vertices, then the moment in its middle from that on the left one
    segment_force f = stress_force(shape, s, m->length[n]);
    bough_vec3 half = bough_scale(0.5 * m->length[n], shape.chord);
    bough_vec3 force = along_axis(shape.v, s.v);
    bough_vec3 moment = bough_sub(half_backward(shape.v, shape.t, f.ll), bough_cross(half, force));
    lane_store(stress, 1, 0, s.v);
    lane_store(stress + 3, 1, 0, moment);
}

enum { TWIST = 20 }; // C₆₆ in the upper triangle by rows

// theory (111)
double bough_rod_twist_reserve(const bough_rod_model *m, const bough_rod_scratch *scratch) {
    double least = INFINITY;
    for (int n = 0; n < m->n_segment; n++) {
        double stress[6], h = m->length[n];
        bough_vec3 phi = shape_at(m, scratch, n).phi;
        bough_rod_stress(m, scratch, n, stress);
        double needed = 0.04 * (phi.x * phi.x + phi.y * phi.y) * stress[2] * h * h;
        if (needed > 0)
            least = fmin(least, bough_rod_tile(m->stiffness, 21, n)[TWIST * BOUGH_LANES] / needed);
    }
    return least;
}

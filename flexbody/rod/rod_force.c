// Wrenches and stresses of a rod.
#include "flexbody/rod/rod_lanes.h"

// theory (12): all that the carrier feels is the first segment's pull on the root, and the loads there;
// moment in BRF axes.
static void root_wrench(const bough_rod_model *m, const bough_rod_scratch *scratch, double *wrench) {
    int s = m->stride;
    const double *f = scratch->segment;
    bough_vec3 moment = bough_mat3_mul(m->root, bough_v3(f[3 * s], f[4 * s], f[5 * s]));
    const double inner[6] = {f[0], f[s], f[2 * s], moment.x, moment.y, moment.z};
    for (int c = 0; c < 6; c++) wrench[c] = inner[c] + scratch->load[c * s];
}

void bough_rod_present_wrenches(const bough_rod_model *m, const bough_rod_scratch *scratch, double *wrench) {
    int s = m->stride, end = m->n_segment;
    root_wrench(m, scratch, wrench);
    if (!bough_rod_carries(m)) return;
    // the loads on the last vertex, their moment in section axes, and the pull of the last segment
    bough_mat3 r = bough_rotation_matrix(load_vertex(scratch->vertex, s, end).p);
    const double *f = scratch->segment + end - 1, *load = scratch->load + end;
    bough_vec3 moment = bough_mat3_tmul(r, lane_load(load + 3 * s, s, 0));
    wrench += BOUGH_ROD_OUTPUTS;
    lane_store(wrench, 1, 0, bough_sub(lane_load(load, s, 0), lane_load(f, s, 0)));
    lane_store(wrench + 3, 1, 0, bough_add(moment, lane_load(f + 6 * s, s, 0)));
}

enum { TWIST = 20 }; // C₆₆ in the upper triangle by rows

// theory (111)
double bough_rod_twist_reserve(const bough_rod_model *m, const bough_rod_scratch *scratch) {
    double least = INFINITY;
    for (int n = 0; n < m->n_segment; n++) {
        const double *stiffness = bough_rod_tile(m->stiffness, 21, n);
        segment_geometry shape = shape_at(m, scratch, n);
        strain e = elastic_strain(shape, m->inverse_length[n], scratch->rest, m->stride, n);
        double tension = segment_stress(stiffness, bough_rod_tile(m->gradient, 35, n), BOUGH_LANES, 0, e).v.z;
        double h = m->length[n], bend = shape.phi.x * shape.phi.x + shape.phi.y * shape.phi.y;
        double needed = 0.04 * bend * tension * h * h;
        if (needed > 0) least = fmin(least, stiffness[TWIST * BOUGH_LANES] / needed);
    }
    return least;
}

// The elastic energy of a rod, for balances: no run needs it.
#pragma once

#include "flexbody/rod/rod_lanes.h"

// Per length [N].
static inline double segment_energy(const double *c, const double *gradient, int stride, int n, strain e) {
    elastic_state s = elastic_at(c, gradient, stride, n, e);
    e.v.z += 0.5 * bow_dot(s.pull, e);
    double straight = 0.5 * (bough_dot(e.v, s.stress.v) + bough_dot(e.u, s.stress.u));
    return straight - s.limit * s.value;
}

// Of the configuration in scratch->vertex, under the loads that scratch had last [J].
static inline double rod_elastic_energy(const bough_rod_model *m, const bough_rod_scratch *scratch) {
    double energy = 0;
    for (int n = 0; n < m->n_segment; n++) {
        vertex_state l = load_vertex(scratch->vertex, m->stride, n);
        vertex_state r = load_vertex(scratch->vertex, m->stride, n + 1);
        segment_geometry shape = segment_shape(l, r, m->inverse_length[n]);
        strain e = elastic_strain(shape, m->inverse_length[n], scratch->rest, m->stride, n);
        energy += m->length[n] * segment_energy(bough_rod_tile(m->stiffness, 21, n),
                                                bough_rod_tile(m->gradient, 35, n), BOUGH_LANES, 0, e);
    }
    return energy;
}

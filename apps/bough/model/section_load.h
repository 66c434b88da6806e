// Forces and moments in the sections of a rod: what its outer part does to its inner part.
#ifndef BOUGH_APPS_SIMULATION_SECTION_LOAD_H
#define BOUGH_APPS_SIMULATION_SECTION_LOAD_H

#include "apps/bough/model/simulation.h"

typedef struct bough_section_load {
    bough_vec3 force, moment; // [N], [N m] in the axes of the rod's body
} bough_section_load;

// Evaluates the rod of a beam at the current synchronisation point, time t, into the scratch of its
// mesh: vertices and segments. False when the forces are not finite.
bool bough_section_evaluate(const bough_simulation *s, const bough_beam *beam, double t,
                            bough_rod_scratch *scratch);

// Load within a segment, at a share of its length, after an evaluation. A segment's force is constant
// over its length and its moment is linear.
bough_section_load bough_section_in_segment(const bough_beam *beam, const bough_rod_scratch *scratch,
                                            int segment, double share);

// Load at a vertex, from 0 to n_segment: the mean of both segments, whose loads differ by the load that
// acts on the vertex; at the ends that of the only segment.
bough_section_load bough_section_at_vertex(const bough_beam *beam, const bough_rod_scratch *scratch,
                                           int vertex);

#endif

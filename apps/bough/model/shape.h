// The shape of a simulation as polylines in ground axes: the axis of each rod; for a rigid body the line from
// its parent over its origin to its mass centre.
#ifndef BOUGH_APPS_MODEL_SHAPE_H
#define BOUGH_APPS_MODEL_SHAPE_H

#include "apps/bough/model/simulation.h"
#include "apps/bough/results/frames.h"
#include "core/base/rotation.h"

typedef struct bough_shape {
    bough_simulation *simulation;
    int n_line;
    bough_polyline *line;        // (n_line) one for each body of the scene, in its order
    bough_vertex_motion *vertex; // scratch of the longest beam
    bough_rod_scratch *scratch;  // (n_line) of each flexible rod
} bough_shape;

void bough_shape_create(bough_arena *arena, bough_simulation *s, bough_shape *shape);

// The points of all lines (Σ n_point × 3) [m], from the simulation's `view`. `self`: the shape.
void bough_shape_points(void *self, double *point);

// Section loads at these points (Σ n_point × 3) [N], [N m] in ground axes, at time t: what the outer part
// of a rod does to the inner one; 0 for bodies of other fidelities. `self`: the shape.
void bough_shape_loads(void *self, double t, double *force, double *moment);

// -- forces and moments in the sections of a rod --------------------------------------------------

// Axes between two rotations: p at fraction 0, q at fraction 1.
static inline bough_mat3 bough_axes_between(bough_quaternion p, bough_quaternion q, double fraction) {
    bough_quaternion step = bough_quaternion_product(bough_quaternion_conjugate(p), q);
    bough_vec3 part = bough_scale(fraction, bough_quaternion_logarithm(step));
    return bough_rotation_matrix(bough_quaternion_product(p, bough_quaternion_exponential(part)));
}

typedef struct bough_section_load {
    bough_vec3 force, moment; // [N], [N m] in the axes of the rod's body
} bough_section_load;

// Evaluates vertices and segments of a beam's rod at the current synchronisation point, time t, into scratch.
// False when the forces are not finite.
bool bough_section_evaluate(const bough_simulation *s, const bough_beam *beam, double t,
                            bough_rod_scratch *scratch);

// The rotation of a section at a vertex in the body's frame, after an evaluation.
bough_quaternion bough_section_vertex_rotation(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                               int vertex);

// Load within a segment, at a fraction of its length, after an evaluation. A segment's force is constant
// over its length and its moment is linear.
bough_section_load bough_section_in_segment(const bough_beam *beam, const bough_rod_scratch *scratch,
                                            int segment, double fraction);

#endif

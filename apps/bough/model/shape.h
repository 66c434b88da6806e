// The shape of a simulation as polylines in ground axes: the axis of each rod; for a rigid body the line from
// its parent over its origin to its mass centre.
#pragma once

#include "apps/bough/model/section_loads.h"
#include "apps/bough/results/frames.h"

typedef struct bough_shape {
    bough_simulation *simulation;
    int n_line;
    bough_polyline *line;        // (n_line) one for each body of the scene, in its order
    bough_vertex_motion *vertex; // scratch of the longest beam
    bough_section_loads *loads;  // (n_line) of each rod
} bough_shape;

void bough_shape_create(bough_arena *arena, bough_simulation *s, bough_shape *shape);

// The points of all lines (Σ n_point × 3) [m], from the simulation's `view`. `self`: the shape.
void bough_shape_points(void *self, double *point);

// Section loads at these points (Σ n_point × 3) [N], [N m] in ground axes, at time t: what the outer part
// of a rod does to the inner one; 0 for bodies of other fidelities. `self`: the shape.
void bough_shape_loads(void *self, double t, double *force, double *moment);

// The shape of a simulation as polylines in ground axes: the axis of each rod; for a rigid body the line from
// its parent over its origin to its mass centre.
#ifndef BOUGH_APPS_SIMULATION_SHAPE_H
#define BOUGH_APPS_SIMULATION_SHAPE_H

#include "apps/bough/results/frames.h"
#include "apps/bough/model/simulation.h"

typedef struct bough_shape {
    bough_simulation *simulation;
    int n_line;
    bough_polyline *line;     // (n_line) one for each body of the scene, in its order
    bough_beam_motion motion; // scratch of the longest beam
    bough_rod_scratch *scratch; // (n_line) of each body with a rod of its own
} bough_shape;

bough_status bough_shape_create(bough_arena *arena, bough_simulation *s, bough_shape *shape);

// The points of all lines (Σ n_point × 3) [m], from the simulation's `view`. `self`: the shape.
void bough_shape_points(void *self, double *point);

// Section loads at these points (Σ n_point × 3) [N], [N m] in ground axes, at time t: what the outer part
// of a rod does to the inner one; 0 for bodies of other fidelities. `self`: the shape.
void bough_shape_loads(void *self, double t, double *force, double *moment);

// Of each body, what vertices.h5 holds: the vertices of its rod, or the one of its origin (n_line).
bough_polyline *bough_shape_bodies(bough_arena *arena, const bough_shape *shape);

// The section loads of these bodies' vertices, as bough_shape_loads. `self`: the shape.
void bough_shape_vertex_loads(void *self, double t, double *force, double *moment);

// Their positions (Σ n_point × 3) [m] and rotations (Σ n_point × 9, row by row), from the simulation's
// `view`. `self`: the shape.
void bough_shape_motion(void *self, double *position, double *rotation);

#endif

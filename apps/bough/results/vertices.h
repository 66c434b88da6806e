// All vertices over time in vertices.h5 (HDF5): /time, and for each body /body/NAME/position, rotation,
// force and moment, chunked along time, each with an attribute `units`. The file is complete or not
// there: it grows as vertices.h5.partial. In a program built without HDF5 opening it is refused.
#ifndef BOUGH_OUTPUT_VERTICES_H
#define BOUGH_OUTPUT_VERTICES_H

#include "apps/bough/results/frames.h"

typedef struct bough_vertices bough_vertices;

typedef struct bough_vertices_def {
    const char *folder; // an existing folder
    int n_body;
    const bough_polyline *body; // (n_body) name and number of vertices; outlives the file
    // Fills what all vertices have, in order, in ground axes: position (Σ n_point × 3) [m] and
    // rotation (Σ n_point × 3 × 3), whose columns are the vertex's own axes.
    void (*motion)(void *self, double *position, double *rotation);
    // Fills the section loads at the vertices at time t (Σ n_point × 3), in ground axes [N], [N m].
    void (*loads)(void *self, double t, double *force, double *moment);
    void *self;
} bough_vertices_def;

// All memory of our own is taken here.
bough_status bough_vertices_open(bough_arena *arena, const bough_vertices_def *def,
                                 bough_vertices **vertices);

// Appends the vertices at time t [s].
bough_status bough_vertices_sample(bough_vertices *vertices, double t);

// Closes the file and gives it its name.
bough_status bough_vertices_finish(bough_vertices *vertices);

#endif

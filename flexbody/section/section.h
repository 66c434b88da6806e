// Section tables of a rod and their discretisation: stiffness integrated over segments, inertia
// over the half-segments of each vertex. Between stations everything is linear in arc length.
#pragma once

#include "flexbody/rod/rod.h"

// A section at a station of the reference axis.
typedef struct bough_section_station {
    bough_vec3 position;  // of the reference axis in the BRF [m]
    double twist;         // section axes are rotated by −twist about the axis' tangent [rad]
    double stiffness[21]; // theory (6): upper triangle by rows, in section axes [N, N m, N m²]
    double mass;          // per length [kg/m]
    double centre[2];     // mass centre in section axes [m]
    double inertia[4];    // Ixx Iyy Ixy Izz about the reference axis per length [kg m]
} bough_section_station;

// Inertia about the mass centre: central (Ixx Iyy Ixy Izz) [kg m].
void bough_section_central(const bough_section_station *x, double central[4]);

// The section between two stations, at a fraction of the way to the upper one.
bough_section_station bough_section_between(const bough_section_station *low,
                                            const bough_section_station *high, double fraction);

typedef struct bough_section_table {
    const char *name;
    int n_station; // 1: a uniform rod of `length` along z
    const bough_section_station *station;
    double length;     // used when n_station is 1 [m]
    double damping[6]; // D = diag(√μ) C diag(√μ), μ per strain component [s]
    double grading;    // of the segments: see bough_section_graded
} bough_section_table;

// Where vertex i of n segments lies, relative to the length: x + g x (1 − x) with x = i/n. Segments
// shorten evenly from the root, the first (1 + g)/(1 − g) times as long as the last, and the vertices of n/2
// segments are every second one of n.
static inline double bough_section_graded(double grading, double x) { return x + grading * x * (1 - x); }

// A definition with `n_segment` segments in the arena.
bough_status bough_section_discretise(bough_arena *arena, const bough_section_table *table, int n_segment,
                                      bough_rod_def *def);

// The whole rod as one rigid body, in the BRF about its origin: first moment and tensor.
bough_vertex_inertia bough_section_rigid(const bough_rod_def *def);

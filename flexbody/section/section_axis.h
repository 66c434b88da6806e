// The reference axis of a section table by arc length: sections on it and integrals along it; for
// section*.c only.
#pragma once

#include "flexbody/section/section.h"

// The stations of a table with the arc length of each, its own copy.
typedef struct bough_section_axis {
    int n; // stations, 2 or more
    const bough_section_station *station;
    double *arc;       // (n) [m]
    bool *even;        // (n − 1) whether a piece up to the next station is integrated in one
    double damping[6]; // of the table [s]
} bough_section_axis;

void bough_section_axis_init(bough_section_axis *a, bough_arena *arena, const bough_section_table *table);

// Where s lies between two stations.
typedef struct bough_section_place {
    const bough_section_station *low, *high;
    double fraction; // of the way to the upper station
} bough_section_place;
bough_section_place bough_section_find(const bough_section_axis *a, double s);

static inline double bough_section_mix(double fraction, double low, double high) {
    return low + fraction * (high - low);
}

// The section at a place, or at arc length s.
bough_section_station bough_section_of(bough_section_place place);
bough_section_station bough_section_at(const bough_section_axis *a, double s);

// The axes in the BRF of a section with a twist whose axis has a direction (a unit vector), and of a
// place between stations, which are joined by straight lines.
bough_vec3 bough_section_direction(bough_vec3 from, bough_vec3 to);
bough_quaternion bough_section_rotation(bough_vec3 direction, double twist);
bough_quaternion bough_section_rotation_in(bough_section_place place);

// A point of a quadrature on the axis.
typedef struct bough_section_point {
    double s, weight; // [m]
    bough_section_place place;
} bough_section_point;

// Calls visit(context, point) at the points of a quadrature from one arc length to another: exact
// for polynomials of degree 15 between stations, and for compliances to 1e-9.
typedef void (*bough_section_visitor)(void *context, const bough_section_point *p);
void bough_section_integrate(const bough_section_axis *a, double from, double to, bough_section_visitor visit,
                             void *context);

// Mass and first moment of a segment at one of its vertices, in the axes of the segment's middle.
typedef struct bough_section_mass {
    double mass;       // [kg]
    bough_vec3 moment; // [kg m]
} bough_section_mass;

// Mass of segment n of a def up to an arc length, theory (121).
bough_axial_mass bough_section_mass_below(const void *axis, const bough_rod_def *def, int n, double to);

// Inertia lumped to the vertices of a def that has its mesh (section_inertia.c): vertex (N + 1). Per
// segment (N), gain is the mass of its left vertex beyond lumping by hat functions.
void bough_section_lump(bough_arena *arena, const bough_section_axis *a, const bough_rod_def *def,
                        const bough_section_mass *gain, bough_vertex_inertia *vertex);

// (11) for vertices that carry lumped rigid inertias: mass, inertial forces and their tangents.
// Every array is over the n vertices; forces and accelerations as in structure.h.
#ifndef BOUGH_TESTS_REFERENCE_LUMPED_H
#define BOUGH_TESTS_REFERENCE_LUMPED_H

#include "tests/reference/structure.h"

typedef struct bough_lumped {
    int n;
    const bough_inertia *inertia; // in vertex axes about the vertex (n)
} bough_lumped;

// M = [mE, −R ξ(s); ξ(s) Rᵀ, I], s = mζ: mass (n × 6 × 6), row-major.
void bough_lumped_mass(const bough_lumped *b, const bough_vertex *vertex, double *mass);

// (δM) a along a change of the vertices.
void bough_lumped_mass_tangent(const bough_lumped *b, const bough_vertex *vertex,
                               const bough_vertex_change *change, const bough_twist *acceleration,
                               bough_wrench *product);

// (−R Ω×(Ω×s), −Ω×IΩ) and its derivative along a change of the vertices.
void bough_lumped_inertial(const bough_lumped *b, const bough_vertex *vertex, bough_wrench *force);
void bough_lumped_inertial_tangent(const bough_lumped *b, const bough_vertex *vertex,
                                   const bough_vertex_change *change, bough_wrench *force_change);

#endif

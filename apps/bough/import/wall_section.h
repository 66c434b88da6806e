// Stiffness and mass of a thin-walled section of laminates with any number of cells: bending and
// tension by Euler-Bernoulli's plane sections, shear and torsion by the shear flow that follows from
// them. The stiffness of a wall is that of its plies without hoop force.
//
// A. Kollár, G. S. Springer, Mechanics of Composite Structures (Cambridge 2003), chapter 6. Warping u
// at the nodes and twist rate θ are found from the balance of shear flows q = (G t/L)(Δu + θ h), h
// twice the area that the wall sees from the origin, as in the theory of Saint-Venant.
#ifndef BOUGH_APPS_IMPORT_WALL_SECTION_H
#define BOUGH_APPS_IMPORT_WALL_SECTION_H

#include "core/base/arena.h"
#include "core/base/status.h"

typedef struct bough_ply {
    double young[2], shear, poisson; // along and across its fibres [Pa, Pa], [Pa], [-]
    double density;                  // [kg/m3]
    double angle;                    // of the fibres from the span [rad]
    double thickness;                // [m]
} bough_ply;

// Between two nodes; its plies lie from the line that joins them to the left of the way from the first
// to the second, or on both sides of it.
typedef struct bough_wall {
    int from, to;
    int n_ply;
    const bough_ply *ply; // (n_ply), from the line on
    int centred;          // 1: half of them on each side
} bough_wall;

// Stiffness and mass (6 × 6 each, rows) about the origin, of strains in the order shear x, shear y,
// axial, bend x, bend y, twist, of a section with nodes at x, y (n_node) [m]. The walls must connect all
// nodes. BOUGH_INVALID: a wall has no thickness or no length.
bough_status bough_wall_section(bough_arena *arena, int n_node, const double *x, const double *y, int n_wall,
                                const bough_wall *wall, double stiffness[36], double mass[36]);

#endif

// Writes sections of slender bodies as rows of a scene's table of structure.
#pragma once

#include "apps/bough/import/draft.h"

enum { BOUGH_IMPORT_MATRIX = 36 };

// Whether a scene accepts both matrices: stiffness and inertia about the centre of mass positive definite.
bool bough_section_possible(const double k[BOUGH_IMPORT_MATRIX], const double m[BOUGH_IMPORT_MATRIX]);

// The deviation of m from the matrix of a mass with centre and inertias: the largest, relative to the
// neighbouring entries [-].
double bough_section_deviation(const double m[BOUGH_IMPORT_MATRIX]);

// The first bending frequency [rad/s] of a clamped beam without twist and shear, given at n
// stations from the root: span [m], bending stiffness [N m2] and mass [kg/m], linear between.
double bough_section_frequency(int n, const double *span, const double *stiffness, const double *mass);

// The head of a table of sections with matrices, and a row of it: span [m], twist [deg], place of the axis
// [m], 6 × 6 stiffness and mass, row by row, in the scene's order (shear x, shear y, axial, bend x, bend y,
// twist). The row has the six diagonal entries of a diagonal stiffness, else the 21 of its upper triangle,
// then mass, centre and inertias.
typedef struct bough_section_place {
    double x, y, z, twist;
} bough_section_place;
void bough_section_matrix_head(FILE *file);
void bough_section_matrix_put(FILE *file, const bough_section_place *at, const double k[BOUGH_IMPORT_MATRIX],
                              const double m[BOUGH_IMPORT_MATRIX]);

// Notes the largest deviation of the mass matrices.
void bough_section_note(bough_draft *d, double deviation);

// A section of one material without offsets.
typedef struct bough_section {
    double span, twist;                           // [m, deg]
    double mass;                                  // [kg/m]
    double axial, shear, bend_x, bend_y, torsion; // [N, N m2]
} bough_section;

// The table's head, with damping times (6) [s], and a row.
void bough_section_head(FILE *file, double length, const double *time);
void bough_section_put(FILE *file, const bough_section *s);

// -- sections of walls (wall_section.c) -----------------------------------------------------------

// Stiffness and mass of a thin-walled section of laminates with any number of cells: bending and
// tension by Euler-Bernoulli's plane sections, shear and torsion by the shear flow that follows from
// them. The stiffness of a wall is that of its plies without hoop force.
//
// A. Kollár, G. S. Springer, Mechanics of Composite Structures (Cambridge 2003), chapter 6. Warping u
// at the nodes and twist rate θ are found from the balance of shear flows q = (G t/L)(Δu + θ h), h
// twice the area that the wall sees from the origin, as in the theory of Saint-Venant.

typedef struct bough_ply {
    double young[2], shear, poisson; // along and across its fibres [Pa, Pa], [Pa], [-]
    double density;                  // [kg/m3]
    double angle;                    // of the fibres from the span [rad]
    double thickness;                // [m]
} bough_ply;

// A wall between two nodes. Its plies lie to the left of the line from the first node to the second, or half
// of them on each side.
typedef struct bough_wall {
    int from, to;
    int n_ply;
    const bough_ply *ply; // (n_ply), the first at the line
    int centred;          // 1: half of them on each side
} bough_wall;

// Stiffness and mass (6 × 6 each, rows) about the origin, of strains in the order shear x, shear y,
// axial, bend x, bend y, twist, of a section with nodes at x, y (n_node) [m]. The walls must connect all
// nodes. BOUGH_INVALID: a wall has no thickness or no length.
bough_status bough_wall_section(bough_arena *arena, int n_node, const double *x, const double *y, int n_wall,
                                const bough_wall *wall, double stiffness[36], double mass[36]);

// Writes sections of slender bodies as rows of a scene's table of structure.
#ifndef BOUGH_IMPORT_SECTION_H
#define BOUGH_IMPORT_SECTION_H

#include <stdbool.h>
#include <stdio.h>

enum { BOUGH_IMPORT_MATRIX = 36 };

// A 6 × 6 stiffness, row by row, in the scene's order (shear x, shear y, axial, bend x, bend y,
// twist): its six diagonal entries where there are no others, else the 21 of its upper triangle.
void bough_section_stiffness(FILE *file, const double k[BOUGH_IMPORT_MATRIX]);

// A 6 × 6 mass matrix as mass, centre and inertias.
void bough_section_mass(FILE *file, const double m[BOUGH_IMPORT_MATRIX]);

// Whether a scene takes them: stiffness and inertia about the centre of mass positive definite.
bool bough_section_possible(const double k[BOUGH_IMPORT_MATRIX],
                            const double m[BOUGH_IMPORT_MATRIX]);

// How far m is from the matrix of a mass with centre and inertias: the largest wrong entry, relative to the
// entries beside it.
double bough_section_strangeness(const double m[BOUGH_IMPORT_MATRIX]);

// The first bending frequency [rad/s] of a clamped beam without twist and shear, given at n
// stations from the root: span [m], bending stiffness [N m2] and mass [kg/m], linear between.
double bough_section_frequency(int n, const double *span, const double *stiffness,
                               const double *mass);

// A section of one material without offsets.
typedef struct bough_section {
    double span, twist;                           // [m, deg]
    double mass;                                  // [kg/m]
    double axial, shear, bend_x, bend_y, torsion; // [N, N m2]
} bough_section;

// The table's head, with damping times (6) [s], and a row.
void bough_section_head(FILE *file, double length, const double *time);
void bough_section_put(FILE *file, const bough_section *s);

#endif

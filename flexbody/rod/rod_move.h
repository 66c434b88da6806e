// Finite changes of a rod's shape, as Newton's method takes them in statics.
#ifndef BOUGH_FLEXBODY_ROD_MOVE_H
#define BOUGH_FLEXBODY_ROD_MOVE_H

#include "flexbody/rod/rod.h"

enum { BOUGH_ROD_CHANGE = 8 }; // numbers of a vertex' change: δx [m, BRF axes], δφ [rad, section axes], 0, 0

// The change of vertices 1 … n_segment that a tangent to the state, `rate` (13 n), means: its δx, and
// δφ = 2 Im(p̄∘δp). `end` and `end_rate` (7 each): x and p of the last vertex of a rod that carries
// bodies; not read of others. change (n_segment × BOUGH_ROD_CHANGE).
void bough_rod_change(const bough_rod_model *m, const double *state, const double *end, const double *rate,
                      const double *end_rate, double *change);

// Turns the vertices, p ← p∘exp(share δφ), and moves them from the root on by the strains that the
// change gives to first order: a slender rod then turns without stretching. With x ← x + δx its
// axial stiffness would answer to the square of the turn. Velocities stay. `end` as above.
void bough_rod_move(const bough_rod_model *m, const double *change, double share, double *state, double *end);

// The largest turn of a vertex in a change [rad].
double bough_rod_turn(const bough_rod_model *m, const double *change);

#endif

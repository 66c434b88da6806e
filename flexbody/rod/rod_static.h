// Equilibrium of a rod whose root is held, at rest or in steady rotation: Newton–Raphson on the
// analytic tangent, unsymmetric under follower loads, with increments of load, following large
// rotations.
#pragma once

#include "flexbody/rod/rod.h"
#include "flexbody/rod/rod_tangent.h"

// Work of the solution; build with the rod.
typedef struct bough_rod_static {
    bough_rod_scratch scratch;
    bough_rod_tangent tangent;
    bough_rod_loads scaled;                 // the loads of the present increment
    bough_rod_ramped_load *follower, *dead; // its ramped ones
    double *rate;                           // (13 n)
    double *step;                           // (n × 8)
    double *trial;                          // (13 n)
    double *force, *band;                   // (6 n), (34 × 6 n) K in LAPACK's band storage
    int *pivot;                             // (6 n)
    int iterations;                         // of the last solution, all increments together
} bough_rod_static;

void bough_rod_static_init(bough_rod_static *work, bough_arena *arena, const bough_rod_model *m);

// Brings `state` (13 n), from where it is, to rest in a BRF of constant twist and gravity, `input`
// (9, BRF axes), under loads->value (its rates are ignored) and the whole of the ramped loads. An
// increment is a fraction of loads, gravity and the square of the twist: all at first, halved where Newton's
// method does not converge, and doubled again where it does easily. BOUGH_FAILED names the rod and the
// fraction of load reached; the state is then the last equilibrium.
bough_status bough_rod_steady(const bough_rod_model *m, const bough_rod_loads *loads, const double *input,
                              bough_rod_static *work, double *state);

// -- finite changes of shape, as Newton's method takes them ------------------------------------

enum { BOUGH_ROD_CHANGE = 8 }; // numbers of a vertex' change: δx [m, BRF axes], δφ [rad, section axes], 0, 0

// The change of vertices 1 … n_segment along a tangent to the state, `rate` (13 n): its δx, and
// δφ = 2 Im(p̄∘δp). `end` and `end_rate` (7 each): x and p of the last vertex of a rod that carries
// bodies; not read of others. change (n_segment × BOUGH_ROD_CHANGE).
void bough_rod_change(const bough_rod_model *m, const double *state, const double *end, const double *rate,
                      const double *end_rate, double *change);

// Rotates the vertices, p ← p∘exp(fraction δφ), and moves them from the root on by the strains that the
// change gives to first order: a slender rod then rotates without stretching. With x ← x + δx it would
// stretch by the square of the rotation. Velocities stay. `end` as above.
void bough_rod_move(const bough_rod_model *m, const double *change, double fraction, double *state,
                    double *end);

// The largest rotation of a vertex in a change [rad].
double bough_rod_turn(const bough_rod_model *m, const double *change);

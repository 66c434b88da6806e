// Micro steps by SUNDIALS ARKODE: a singly diagonally implicit Runge–Kutta method with an explicit
// first stage (ESDIRK), order 4 with error control, L-stable, with the body's own Newton solver. One
// step at a time, so that a jump of the inputs costs a start, not an order. The only user of ARKODE.
#ifndef BOUGH_FLEXBODY_MICRO_ARKODE_H
#define BOUGH_FLEXBODY_MICRO_ARKODE_H

#include "flexbody/micro.h"

typedef struct bough_micro_arkode bough_micro_arkode;

// Builds the integrator in the arena with tolerance rtol · scale per state (n).
bough_status bough_micro_arkode_create(bough_arena *arena, const bough_ode *ode,
                                       const double *scale, double rtol,
                                       bough_micro_arkode **micro);

// As bough_micro_cvode_advance. `restart`: f is evaluated anew, as after any jump it must be.
bough_status bough_micro_arkode_advance(bough_micro_arkode *micro, double t, double t1,
                                        bool restart, double *y);

void bough_micro_arkode_statistics(const bough_micro_arkode *micro, bough_statistics *sum);

#endif

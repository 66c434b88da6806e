// Micro steps by SUNDIALS CVODE (variable-order BDF) with the body's own Newton solver. The only
// user of CVODE.
#ifndef BOUGH_FLEXBODY_MICRO_CVODE_H
#define BOUGH_FLEXBODY_MICRO_CVODE_H

#include "flexbody/micro.h"

typedef struct bough_micro_cvode bough_micro_cvode;

// Builds the integrator in the arena with tolerance rtol · scale per state (n).
bough_status bough_micro_cvode_create(bough_arena *arena, const bough_ode *ode,
                                      const double *scale, double rtol, bough_micro_cvode **micro);

// Integrates y (n) from t to exactly t1, never evaluating f beyond it. `restart`: y was changed or
// f jumps at t, so the history is dropped and order 1 begins.
bough_status bough_micro_cvode_advance(bough_micro_cvode *micro, double t, double t1, bool restart,
                                       double *y);

// (n) sum of the local errors of all steps, which a reader sets to zero; NULL without integrator.
double *bough_micro_cvode_error(const bough_micro_cvode *micro);

void bough_micro_cvode_statistics(const bough_micro_cvode *micro, bough_statistics *sum);

#endif

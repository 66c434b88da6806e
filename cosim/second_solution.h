// A second solution beside the run: all members as one system under the same loads, coupled at the
// stages of the Rosenbrock method. What the run errs by is then measured instead of estimated: whatever
// made the error, coupling, sub-solvers or a macro step that does not resolve what happens in it, and
// however the mechanics lets it grow.
//
// Either it is far finer than the run, and the difference is the run's error; or the run is itself such
// a solution, and the second takes steps of twice the length to eight times the tolerance: of a method
// of order p the run then errs by 1/(2ᵖ − 1) of the difference (Richardson). The order is 3 for smooth
// motion and 2 or less where stiff members reduce it; a third is told.
//
// Not seen: the answer of loads from outside the members, such as the air's, to the error.
#ifndef BOUGH_COSIM_SECOND_SOLUTION_H
#define BOUGH_COSIM_SECOND_SOLUTION_H

#include "core/integrator.h"
#include "cosim/coupling.h"

typedef struct bough_second_solution bough_second_solution;

typedef struct bough_second_solution_def {
    bough_integrator_kind kind; // method
    double rtol;  // of its steps, relative to the members' scales
    double step;  // longest [s]
    double share; // of the difference between run and second solution that the run errs by
} bough_second_solution_def;

// Starts from the members' current states.
bough_status bough_second_solution_create(bough_arena *arena, const bough_coupling *c,
                                          const bough_second_solution_def *def,
                                          bough_second_solution **second);

// Follows the run over the macro step that has just been exchanged.
void bough_second_solution_step(bough_second_solution *s, const bough_coupling *c);

// What the run's states err by (n_state), in their units; NULL when the second solution broke down.
const double *bough_second_solution_error(const bough_second_solution *s);

// What the inputs should be given errs by (n_input), in the ports' units; NULL likewise.
const double *bough_second_solution_input_error(const bough_second_solution *s);

// Largest error so far of what input j should be given, in the port's unit; NaN when broken down.
double bough_second_solution_input(const bough_second_solution *s, int j);

void bough_second_solution_snapshot(bough_second_solution *s, bough_snapshot *snapshot);

#endif

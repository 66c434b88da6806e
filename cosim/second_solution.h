// A second solution beside the run: all members as one system under the same loads. It measures the error of
// the run instead of estimating it, whether coupling, sub-solvers or too long a macro step cause the error,
// and however the mechanics amplifies it.
//
// It is finer than the run. Beside a run as one system it takes steps of at most half the length to 1/64 of
// the tolerance. Its error by the Rosenbrock method then is 1/8 (order 3) to 1/4 (order 2, to which stiff
// members reduce it) of the run's where the length binds, and 1/4 where the tolerance does. An eighth of the
// tolerance is not enough: undamped vibrations below it are lost in both solutions.
//
// Under the loads of the run, the reaction of loads to the error, such as that of the air or a controller, is
// missing. Where there are such loads, a second model of the scene with loads of its own takes the same macro
// steps (def.beside).
#ifndef BOUGH_COSIM_SECOND_SOLUTION_H
#define BOUGH_COSIM_SECOND_SOLUTION_H

#include "core/integrator.h"
#include "cosim/coupling.h"

typedef struct bough_second_solution bough_second_solution;

// A monolithic model with the same members, whose memory is its owner's.
typedef struct bough_second_model {
    void *self;
    const bough_coupling *coupling; // NULL: there is none
    bough_status (*step)(void *self); // a whole macro step; a run under step control takes several meanwhile
    double (*end)(void *self); // of that step [s]
    void (*stop_by)(void *self, bool (*stop)(void)); // see below
} bough_second_model;

enum { BOUGH_SECOND_SOLUTION_REASON = 320 };

typedef struct bough_second_solution_def {
    bough_integrator_kind kind; // method
    double rtol;  // of its steps, relative to the members' scales
    double step;  // longest [s]
    bough_second_model beside; // at the same time; without, the members of the run are taken as one system
} bough_second_solution_def;

// Starts from the members' current states.
bough_status bough_second_solution_create(bough_arena *arena, const bough_coupling *c,
                                          const bough_second_solution_def *def,
                                          bough_second_solution **second);

// Advances the second solution over the last macro step of the run, or, under step control, when a whole one
// is over. False: it was stopped on the way, and must not go on.
bool bough_second_solution_step(bough_second_solution *s, const bough_coupling *c);

// Asks stop() at each of its evaluations; NULL: never.
void bough_second_solution_stop_by(bough_second_solution *s, bool (*stop)(void));

// Number of comparisons with the run so far.
long bough_second_solution_compared(const bough_second_solution *s);

// Error of the run's states (n_state), in their units; NULL if the second solution has failed.
const double *bough_second_solution_error(const bough_second_solution *s);

// Error of the inputs' values (n_input), in the ports' units; NULL if the second solution has failed.
const double *bough_second_solution_input_error(const bough_second_solution *s);

// Largest error so far of the value of input j, in the port's unit; NaN if the second solution has failed.
double bough_second_solution_input(const bough_second_solution *s, int j);

// Whether its loads are its own and react to its motion.
bool bough_second_solution_has_loads(const bough_second_solution *s);

// When and why it was given up; NULL while it follows the run.
const char *bough_second_solution_reason(const bough_second_solution *s);

void bough_second_solution_snapshot(bough_second_solution *s, bough_snapshot *snapshot);

#endif

// Macro-step control: each span between two synchronisation points of the fixed grid (where loads are
// sampled, events occur and results are recorded) is divided into 2ⁿ equal macro steps. A step whose defects
// exceed the tolerance is undone, by a stored copy of members and coupling, and halved. When the defects
// are well below the tolerance, the length is doubled again. Halving and doubling keep the factors of
// sub-solvers, and the results for any number of threads.
#pragma once

#include "cosim/coupling.h"

typedef struct bough_step_control_def {
    double tolerance; // of the defects, relative to the largest value of their port so far; 0: fixed
    double least;     // shortest macro step [s]
} bough_step_control_def;

// What the decisions so far leave for the next step.
typedef struct bough_step_decisions {
    int level, part; // the next step is the part-th of 2^level of the span
    double from;     // where the span begins [s]
    long accepted, rejected;
    long forced;     // accepted above the tolerance, because it was the shortest
    double shortest; // step accepted [s]
    int n_point;     // synchronisation points before the step with no jump between
} bough_step_decisions;

typedef struct bough_step_control {
    // constant
    double tolerance, easy; // below `easy` the steps may be twice as long
    int most;               // levels
    bough_step_decisions now;
    // by each step
    double *size; // (n_input) of a vector's first: its largest norm so far
    char *copy;   // of the coupling at the start of the step
    // scratch
    bough_signal curve;        // (n_input) through these points and the step's end
    double *obtained, *square; // (n_input)
} bough_step_control;

// `order`: of the defects in the macro step. Takes the memory for the copy from the arena.
bough_step_control *bough_step_control_create(bough_arena *arena, bough_coupling *c,
                                              const bough_step_control_def *def, double macro_step,
                                              int order);

// End of the next step of a span that ends at `to` and, for its first step, begins at `from` [s].
double bough_step_control_end(bough_step_control *s, double from, double to);

void bough_step_control_save(bough_step_control *s, bough_coupling *c);
void bough_step_control_restore(bough_step_control *s, bough_coupling *c);

// The worst difference of applied and obtained inputs in the step just exchanged, at its middle and its end:
// of a vector of up to three inputs relative to its largest norm so far [1].
double bough_step_control_defect(bough_step_control *s, const bough_coupling *c);

// What the control itself remembers.
void bough_step_control_snapshot(bough_step_control *s, bough_snapshot *snapshot);

// Whether the step is accepted; if not, the next steps are shorter. A step that failed has
// an infinite error and is never accepted.
bool bough_step_control_accept(bough_step_control *s, const bough_coupling *c, double error);

// Whether a step cannot become shorter.
bool bough_step_control_exhausted(const bough_step_control *s);

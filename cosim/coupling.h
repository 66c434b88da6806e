// Working data of the macro steps of an assembly under a coupling scheme, and the moves that schemes consist
// of.
#pragma once

#include "core/base/pool.h"
#include "core/base/snapshot.h"
#include "core/solve/integrator.h"
#include "cosim/accelerate.h"
#include "cosim/assembly.h"

// The unknowns of the iterated scheme.
typedef enum bough_exchange {
    BOUGH_EXCHANGE_END_VALUES, // values at t1
    BOUGH_EXCHANGE_WAVEFORM,   // values at the Lobatto points: a cubic over the step
} bough_exchange;

// The user's choices. A scheme ignores the fields that it does not use.
typedef struct bough_scheme_options {
    const char *name; // of the scheme, see scheme.h
    int order;        // extrapolated, iterated: degree of the polynomial, 0 … 2
    double theta;     // ramp: 1/2 … 1; 0: 1/2, and a scene on which that is unstable is refused
    bough_integrator_options integrator; // monolithic
    bough_exchange exchange;             // iterated
    bough_acceleration accelerator;      // iterated
    double relaxation;                   // iterated: the accelerator's first factor, 0 … 1
    double tolerance; // iterated: of the interface relative to its largest values so far [1]
    int iterations;   // iterated: most per macro step
} bough_scheme_options;

// Number of past synchronisation points that a scheme may use, and number that is stored.
enum { BOUGH_HISTORY = 3, BOUGH_PAST = 4 };

// The last synchronisation points, newest first.
typedef struct bough_history {
    int n;                     // points that schemes may use, at most BOUGH_HISTORY
    double time[BOUGH_PAST];   // [s]
    double *input[BOUGH_PAST]; // (n_input each) the inputs obtained there
} bough_history;

// Outputs over the step of the members that have advanced, numbered over all outputs (n_output each).
typedef struct bough_output_curve {
    double *start_rate;       // at t0
    double *value, *end_rate; // at t1
} bough_output_curve;

typedef struct bough_scheme bough_scheme;                     // see scheme.h
typedef struct bough_coupling_scratch bough_coupling_scratch; // private to coupling.c

typedef struct bough_coupling {
    // constant once built
    const bough_assembly *assembly;
    const bough_scheme *scheme; // set by bough_scheme_couple
    bough_scheme_options options;
    bough_pool *pool; // NULL: one thread
    void *scheme_data;

    // the step to take, by the master
    double t0, t1; // [s]
    bool restart;  // a load jumped at t0: integrators restart
    bool compared; // another solution shows the error, so a step that has not converged may go on

    // by bough_scheme_step and bough_coupling_record, at the end of the last step
    double *output;  // (n_output) of all members at their current states
    double *input;   // (n_input) the same, as their receivers get it
    double *applied; // (n_input) end values of the signals: what the receivers have got
    bough_history past;

    // during a step, by the scheme and the moves that it calls
    bough_signal *signal; // (n_member) input of each member over the step
    bool *followed;       // (n_input) the input is the actual motion: there is no defect
    bough_output_curve advanced;
    bough_status *status; // (n_member) of the last move
    bough_coupling_scratch *scratch;
} bough_coupling;

// Builds the working data and evaluates the outputs at the members' current states; the scheme's own
// memory is bough_scheme_couple's.
bough_coupling *bough_coupling_create(bough_arena *arena, const bough_assembly *assembly,
                                      const bough_scheme_options *options, bough_pool *pool);

// -- moves --------------------------------------------------------------------------------------

enum { BOUGH_ALL_LEVELS = -1 };

// work(c, member) for every member of a level, by the threads of the pool. Returns the first failure, in the
// order of the members, that the work left in c->status.
bough_status bough_coupling_each(bough_coupling *c, int level, void (*work)(bough_coupling *c, int member));

// Clears c->status, and the first failure in it.
void bough_coupling_clear(bough_coupling *c);
bough_status bough_coupling_failure(const bough_coupling *c);

// Sets the time span of every signal to that of the step.
void bough_coupling_begin(bough_coupling *c);

// Advances a member to t under its signal; c->status[member] is BOUGH_RETRY if its integrator fails.
void bough_coupling_advance_to(bough_coupling *c, int member, double t, bool restart);

// Advances the members of a level to t1 under their signals.
bough_status bough_coupling_advance(bough_coupling *c, int level, bool restart);

// The same, with the outputs that later levels follow, into c->advanced.
bough_status bough_coupling_advance_leaders(bough_coupling *c, int level, bool restart);

// Outputs of a member at t, at its current state under its signal: output (n_output of the member).
void bough_coupling_outputs(bough_coupling *c, int member, double t, double *output);

// Rates of a member's outputs at t, at its current state under the input, whose rate may be NULL
// for 0: rate (n_output of the member). A rate that is not finite is a failure in c->status.
void bough_coupling_output_rate(bough_coupling *c, int member, double t, const double *input,
                                const double *input_rate, double *rate);

// Fill the signal of input j (numbered over all inputs): from the outputs of a member that has advanced, by a
// cubic through values and rates at both ends; and by the polynomial of `degree` through the last
// synchronisation points.
void bough_coupling_interpolate(bough_coupling *c, int j);
void bough_coupling_extrapolate(bough_coupling *c, int j, int degree);

// Second derivative at the step of the parabola through the last two values of input j (numbered
// over all inputs) and `end` at t1; 0 if there are no such values, or a jump between them.
double bough_coupling_curvature(const bough_coupling *c, int j, double end);

// Sets c->status[member] to BOUGH_RETRY: no finite rate of change.
void bough_coupling_not_finite(bough_coupling *c, int member);

// -- the end of a step ----------------------------------------------------------------------------

// Stores the end values of the signals and appends the inputs to the history.
void bough_coupling_record(bough_coupling *c);

// The memory that a step changes and the next step needs: the members' states and the exchanged values,
// without the scheme's own memory.
void bough_coupling_snapshot(bough_coupling *c, bough_snapshot *s);

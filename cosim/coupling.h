// Working data of the macro steps, and the operations that schemes consist of.
#ifndef BOUGH_COSIM_COUPLING_H
#define BOUGH_COSIM_COUPLING_H

#include "core/base/pool.h"
#include "core/base/snapshot.h"
#include "core/solve/integrator.h"
#include "cosim/accelerate.h"
#include "cosim/interface.h"

// How a later level interpolates the outputs that an earlier level has already obtained.
typedef enum bough_interpolation {
    BOUGH_HERMITE,    // cubic from values and rates at both ends
    BOUGH_POLYNOMIAL, // through the new value and `order` earlier ones; order 0 holds the new value
} bough_interpolation;

// The unknowns of the iterated scheme.
typedef enum bough_exchange {
    BOUGH_EXCHANGE_END_VALUES, // values at t1
    BOUGH_EXCHANGE_WAVEFORM,   // values at the Lobatto points: a cubic over the step
} bough_exchange;

// The user's choices. A scheme ignores the fields that it does not use.
typedef struct bough_scheme_options {
    const char *name;                  // of the scheme, see scheme.h
    int order;                         // extrapolated, iterated: degree of the polynomial, 0 … 2
    bool parallel;                     // extrapolated: all levels at once instead of one after the other
    bool reversed;                     // sequential schemes take the last level first
    bough_interpolation interpolation; // sequential schemes
    double theta; // ramp: 1/2 … 1; 0: 1/2, and a scene on which that is unstable is refused
    bough_integrator_options integrator; // monolithic
    bough_exchange exchange;             // iterated
    bough_acceleration accelerator;      // iterated
    double relaxation;                   // iterated: the accelerator's first factor, 0 … 1
    double tolerance; // iterated: of the interface relative to its largest values so far [1]
    int iterations;   // iterated: most per macro step
} bough_scheme_options;

// Number of past synchronisation points that a scheme may use, and number that is stored.
enum { BOUGH_HISTORY = 3, BOUGH_PAST = 4 };

typedef struct bough_scheme bough_scheme; // see scheme.h

typedef struct bough_coupling {
    const bough_assembly *assembly;
    const bough_scheme *scheme; // set by bough_scheme_couple
    bough_scheme_options options;
    bough_pool *pool;  // NULL: one thread
    void *scheme_data; // what the scheme created

    // the step to take, set by the master
    double t0, t1; // [s]
    bool restart;  // a load jumped at t0: integrators start anew

    // by bough_coupling_exchange: at the end of the last step
    double *output;  // (n_output) of all members at their current states
    double *input;   // (n_input) the same, as their receivers see it
    double *applied; // (n_input) the values applied to the receivers at the end of the step
    double *deficit; // (n_input) ∫ (obtained − applied value) over all steps, of the leaders' inputs;
                     // NULL unless the scheme compensates it
    int n_past;      // number of entries of the next two that schemes may use, at most BOUGH_HISTORY
    double past_time[BOUGH_PAST]; // the last synchronisation points, newest first [s]
    double *past[BOUGH_PAST];     // (n_input each) inputs there

    // during a step, by the scheme
    bough_signal *signal; // (n_member) input of each member over the step
    bool *followed;       // (n_input) the input is the actual motion: there is no defect
    double *start_rate;   // (n_output) rates of the outputs at t0, of members already advanced
    double *end_output;   // (n_output) outputs at t1, likewise
    double *end_rate;     // (n_output)
    bough_status *status; // (n_member) of the last move
    int *turn;            // (n_member) the members of the level in progress
    bool leaders_restart; // integrators of the level in progress start anew
    int failed_member;    // −1, or the member whose move failed

    // scratch
    double *state_rate;       // (n_state)
    double *output_drift;     // (n_output)
    double *seen, *seen_rate; // (n_input)

    // by the ramp scheme, for the summary
    double interface_ratio; // spectral radius of the interface's gain about the initial state;
                            // NaN: not known

    // by a scheme that integrates all members as one system; NULL
    bough_member *whole;

    long sweeps;     // by the iterated scheme: runs of all members over a macro step so far
    long unfinished; // macro steps that went on before they had converged
    bool measured;   // another solution shows the error of such steps
} bough_coupling;

// Builds the working data and evaluates the outputs at the members' current states; the scheme's own
// memory is bough_scheme_couple's.
bough_coupling *bough_coupling_create(bough_arena *arena, const bough_assembly *assembly,
                                      const bough_scheme_options *options, bough_pool *pool);

// -- moves --------------------------------------------------------------------------------------

enum { BOUGH_ALL_LEVELS = -1 };

// Runs work(c, member) for every member of a level, shared out by the pool, and returns the
// first failure in member order that the work left in c->status.
bough_status bough_coupling_each(bough_coupling *c, int level, void (*work)(bough_coupling *c, int member));

// The same for advance_leader(c, member) of the leaders (level 0) beside prepare(c, member) of all
// others, and then advance_follower(c, member) of those whose preparation has not failed.
typedef struct bough_staged_work {
    void (*advance_leader)(bough_coupling *c, int member);
    void (*prepare)(bough_coupling *c, int member);
    void (*advance_follower)(bough_coupling *c, int member);
} bough_staged_work;
bough_status bough_coupling_each_staged(bough_coupling *c, bough_staged_work work);

// Sets the time span of every signal to that of the step.
void bough_coupling_begin(bough_coupling *c);

// Rates of a member's outputs at t, of its current state under the input, whose rate may be NULL
// for 0: rate (n_output of the member). False when its derivative has no finite value.
bool bough_coupling_output_rate(bough_coupling *c, int member, double t, const double *input,
                                const double *input_rate, double *rate);

// Advances a member to t under its signal; c->status[member] is BOUGH_RETRY if its integrator fails.
void bough_coupling_advance_to(bough_coupling *c, int member, double t, bool restart);

// Advances the members of a level to t1 under their signals.
bough_status bough_coupling_advance(bough_coupling *c, int level, bool restart);

// The same, and computes the values that a later level needs: start_rate, end_output, end_rate.
bough_status bough_coupling_advance_leaders(bough_coupling *c, int level, bool restart);

// Fills input j (numbered over all inputs) of its member from the new output that feeds it.
void bough_coupling_interpolate(bough_coupling *c, int member, int j);

// Second derivative at the step of the parabola through the last two values of input j (numbered
// over all inputs) and `end` at t1; 0 if there are no such values, or a jump between them.
double bough_coupling_curvature(const bough_coupling *c, int j, double end);

// Computes outputs and inputs at t1 and the end values of the signals, and updates the history.
void bough_coupling_exchange(bough_coupling *c);

// The memory of a macro step as one vector z: the members' states (n_state), the inputs one and two steps
// ago, the inputs applied last and, for schemes that compensate it, the deficit (n_input each). The
// functions: the length of z; set the coupling from z, for the step that begins at time 0 after steps
// of length h; get z from the coupling.
int bough_coupling_n_memory(const bough_coupling *c);
void bough_coupling_load(bough_coupling *c, double h, const double *z);
void bough_coupling_store(const bough_coupling *c, double *z);

// The memory that a step changes and the next step needs: the members' states and the exchanged values,
// without the scheme's own memory.
void bough_coupling_snapshot(bough_coupling *c, bough_snapshot *s);

// BOUGH_RETRY with a message that names the member.
bough_status bough_coupling_not_finite(const bough_coupling *c, int member);

#endif

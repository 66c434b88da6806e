// Coupling schemes: how the members of an assembly are taken over one macro step, and what they see
// of each other while they integrate themselves. One file per scheme; this is the table by name.
#ifndef BOUGH_COSIM_SCHEME_H
#define BOUGH_COSIM_SCHEME_H

#include "cosim/assembly.h"

// What a later stage sees of the motion or force an earlier stage has already found.
typedef enum bough_interpolation {
    BOUGH_HERMITE,    // cubic from values and rates at both ends
    BOUGH_POLYNOMIAL, // through the new value and `order` earlier ones; order 0 holds the new value
} bough_interpolation;

// What the user chose. Unused fields are ignored by a scheme.
typedef struct bough_scheme_options {
    const char *name;  // one of bough_scheme_names()
    int order;         // extrapolated: degree of the extrapolation, 0 … 2
    bool parallel;     // extrapolated: all stages at once instead of one after the other
    bool reversed;     // sequential schemes take the last stage first
    bough_interpolation interpolation; // sequential schemes
    double theta;      // ramp: 1/2 … 1; 0 chooses by the ratio of interface inertias
    double rtol;       // monolithic: tolerance relative to the members' scales
} bough_scheme_options;

// name "ramp", order 1, sequential, Hermite, theta automatic, rtol 1e-6.
bough_scheme_options bough_scheme_options_default(void);

enum { BOUGH_HISTORY = 3 };

// Working data of the macro steps, shared by schemes, monitor and master.
typedef struct bough_coupling {
    const bough_assembly *assembly;
    bough_scheme_options options;
    int threads;
    void *scheme_data; // what the scheme created

    // the step to take, set by the master
    double t0, t1; // [s]
    bool restart;  // a load jumped at t0: integrators start anew

    // at the end of the last step, by bough_coupling_exchange
    double *output; // (n_output) of all members at their current states
    double *input;  // (n_input) the same, as their receivers see it

    // during a step, by the scheme
    bough_signal *signal; // (n_member) what each member saw on the step
    double *used;         // (n_input) end values of the signals, by bough_coupling_exchange

    int n_past;            // valid entries of the two below
    double past_time[BOUGH_HISTORY]; // newest first: the last synchronisation points
    double *past[BOUGH_HISTORY];     // (n_input each) inputs obtained there

    double *rate, *end_rate; // (n_input) scratch: rates of the inputs at both ends
    double *end;             // (n_input) scratch: new values at the end
    double *state_rate;      // (n_state) scratch
    double *output_rate;     // (n_output) scratch
    bough_status *status;    // (n_member) of the last advance
    double theta;            // ramp: in use
    double interface_ratio;  // ramp: spectral radius of the interface gain at the first step
    int failed_member;       // −1, or the member whose advance failed
} bough_coupling;

typedef struct bough_scheme {
    const char *name;
    const char *summary; // one line for help: what is exchanged, order, stability
    // Takes the scheme's memory; NULL when it needs none.
    bough_status (*create)(bough_coupling *c, bough_arena *arena);
    // Takes all members from t0 to t1.
    bough_status (*step)(bough_coupling *c);
} bough_scheme;

// The scheme of that name; NULL when unknown.
const bough_scheme *bough_scheme_find(const char *name);

// All names, NULL-terminated, for messages and help.
const char *const *bough_scheme_names(void);

// Builds the working data, evaluates outputs at the members' current states and creates the scheme.
bough_status bough_coupling_create(bough_arena *arena, const bough_assembly *assembly,
                                   const bough_scheme_options *options, int threads,
                                   bough_coupling **coupling);

// -- what schemes are made of ----------------------------------------------------------------

enum { BOUGH_ALL_STAGES = -1 };

// Runs work(c, member) for every member of a stage, in parallel when threads > 1.
void bough_coupling_each(bough_coupling *c, int stage, void (*work)(bough_coupling *c, int member));

// Advances the members of a stage to t1 under their signals; the first failure in member order.
bough_status bough_coupling_advance(bough_coupling *c, int stage, bool restart);

// state_rate and input_rate of everything at time t under the given inputs (n_input).
// False when a derivative has no finite value.
bool bough_coupling_rates(bough_coupling *c, double t, const double *input, double *input_rate);

// Outputs and inputs at t1; end values of the signals; the history moves on.
void bough_coupling_exchange(bough_coupling *c);

extern const bough_scheme bough_scheme_frozen, bough_scheme_gauss_seidel,
    bough_scheme_extrapolated, bough_scheme_ramp, bough_scheme_monolithic;

#endif

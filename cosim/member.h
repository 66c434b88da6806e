// A member of an assembly: a system, its current time and state, and the integrator that takes it over
// a macro step by its own steps. An integrator need not be one of the table: a foreign simulator is a
// member whose integrator advances it.
#ifndef BOUGH_COSIM_MEMBER_H
#define BOUGH_COSIM_MEMBER_H

#include "core/integrator.h"
#include "core/signal.h"
#include "core/system.h"

typedef struct bough_member {
    bough_system system;
    const char *solver;  // its integrator, for messages: "IDA", "CVODE BDF", …
    double time;         // current [s]
    double *state;       // current (n_state)
    double *own_error;   // (n_state) sum of its own steps' errors, by their estimate, since a reader
                         // last set it to zero; NULL: it does not tell
    bough_integrator integrator; // ops NULL: there are no states

    // own steps
    const bough_signal *signal; // the input on the step in progress
    double *input;              // (n_input) at the evaluation's time
    double *integrated;         // (n_state) of the integrator, as `constrain` has not seen it
    void *factors;              // of its Newton matrix
    bool started;               // the integrator's history belongs to the state
    bool paused;                // on the way: `integrated` is what it goes on from
} bough_member;

// Builds a member in the arena, at time `start` [s] and the system's initial state. BOUGH_INVALID
// where the method does not suit the system. The member must stay where it is.
bough_status bough_member_create(bough_arena *arena, const bough_system *system, double start,
                                 const bough_integrator_options *options, bough_member *member);

// Integrates the current state to t1 by own steps under input(t), which covers [time, t1]. `restart`
// says that the input or a load jumped at the current time: a multistep method starts anew. On
// failure time and state are those of before; its next step starts anew.
bough_status bough_member_advance(bough_member *m, double t1, const bough_signal *input,
                                  bool restart);

// The same, but may stop on the way, at the first of its own steps' ends at or after `pause`: the current
// time tells. To advance to t1 under the same input, without restart, then goes on to the bits of an
// advance in one go.
bough_status bough_member_advance_part(bough_member *m, double pause, double t1,
                                       const bough_signal *input, bool restart);

// Replaces the current time and state (n_state); the integrator starts anew.
void bough_member_set(bough_member *m, double t, const double *state);

// All that its next step depends on, the integrator's memory included where that can be kept. A copy
// restored twice and advanced twice gives the same bits.
void bough_member_snapshot(bough_member *m, bough_snapshot *s);

// Work of its own steps so far.
bough_statistics bough_member_statistics(const bough_member *m);

#endif

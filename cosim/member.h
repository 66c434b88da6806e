// A member of an assembly: a system, its current time and state, and the integrator that advances it over
// a macro step by its own steps. The integrator need not be in the table of core/solve/integrator.h: a
// foreign simulator is a member with an integrator of its own.
#pragma once

#include "core/solve/integrator.h"
#include "core/solve/system.h"
#include "cosim/signal.h"

typedef struct bough_member {
    bough_system system;
    const char *solver;          // its integrator, for messages: "IDA", "CVODE BDF", …
    double time;                 // current [s]
    double *state;               // current (n_state)
    bough_integrator integrator; // ops NULL: there are no states
    bool opaque; // a foreign simulator, which has outputs and own steps, but no states that could be
                 // linearised: its system has no operations from `input_columns` on

    // own steps
    const bough_signal *signal; // the input on the step in progress
    double *input;              // (n_input) at the evaluation's time
    double *first_input;        // (n_input) at the first of two times
    double *integrated;         // (n_state) of the step in progress, before `constrain`
    void *factors;              // of its Newton matrix
    bool started;               // the integrator's history belongs to the state
    bool (*stop)(void); // called at each evaluation: true ends the step in progress as a failure; NULL: none
} bough_member;

// Builds a member in the arena, at time `start` [s] and the system's initial state. BOUGH_INVALID
// where the method does not suit the system. The member must stay where it is.
bough_status bough_member_create(bough_arena *arena, const bough_system *system, double start,
                                 const bough_integrator_options *options, bough_member *member);

// Integrates the current state to t1 by its own steps under input(t), which covers [time, t1]. `restart`:
// the input or a load jumps at the current time, so a multistep method restarts. On failure, time and
// state are unchanged and the next step restarts the method.
bough_status bough_member_advance(bough_member *m, double t1, const bough_signal *input, bool restart);

// Replaces the current time and state (n_state); the integrator restarts.
void bough_member_set(bough_member *m, double t, const double *state);

// The memory that its next step depends on, including the integrator's where that can be stored. Restoring
// a copy twice and advancing twice gives the same bits.
void bough_member_snapshot(bough_member *m, bough_snapshot *s);

// Work of its own steps so far.
bough_statistics bough_member_statistics(const bough_member *m);

// All members of an assembly as one system ẏ = F(t, y), whose inputs follow from the outputs, theory (54):
// its rate, and solutions of (I − γ ∂F/∂y) x = r. The matrix is an arrowhead matrix, theory (55), solved by
// static condensation: each member is factored separately, and the interface system is that of interface.h.
#pragma once

#include "core/base/pool.h"
#include "cosim/interface.h"

typedef struct bough_whole {
    const bough_assembly *assembly;
    bough_pool *pool;       // NULL: one thread
    double *output, *input; // (n_output), (n_input) of the last bough_whole_inputs
    bough_status *status;   // (n_member) of the last work on each

    // the evaluation in progress
    double time;      // [s]
    const double *at; // (n_state)
    double *x;        // (n_state) its rate, or the solution in progress

    // by bough_whole_setup
    double setup_time;   // [s]
    double *setup_state; // (n_state)
    double *setup_input; // (n_input)
    bool linearised;     // members are linearised there
    bool keeps;          // those with kept_tangent are not: they keep tangents and factors
    double gamma;        // [s]
    bough_interface *interface;

    // by a solution
    double *change;        // (n_input) of the inputs
    double *output_change; // (n_output) of each member by itself

    // by bough_whole_hold: states that are held
    int n_held;
    const int *held;    // (n_held)
    double *border;     // (n_held × n_state): (I − γJ)⁻¹ of each held state's unit vector
    double *multiplier; // (n_held × n_held) their held entries, factored
    double *held_force; // (n_held) multipliers of the last solution
    int *held_pivot;    // (n_held)
} bough_whole;

// Builds the memory in the arena; members are worked on by the pool.
bough_whole *bough_whole_create(bough_arena *arena, const bough_assembly *assembly, bough_pool *pool);

// The same without factors: for bough_whole_inputs and the rates only.
bough_whole *bough_whole_create_evaluation(bough_arena *arena, const bough_assembly *assembly,
                                           bough_pool *pool);

// The assembly as a system without ports, from the members' current states on; `name` is borrowed. Its
// self is a bough_whole for evaluations. All members' systems are in use while it is asked.
bough_system bough_whole_system(bough_arena *arena, const bough_assembly *assembly, bough_pool *pool,
                                const char *name);

// Solutions keep these states from now on (n, borrowed): x is 0 there, by constraint forces.
void bough_whole_hold(bough_arena *arena, bough_whole *whole, int n, const int *held);

// Outputs and inputs at a state (n_state) into whole->output and whole->input.
void bough_whole_inputs(bough_whole *whole, double t, const double *state);

// F: rate (n_state). BOUGH_FAILED names the member whose rate is not finite.
bough_status bough_whole_rate(bough_whole *whole, double t, const double *state, double *rate);

// Factors I − γJ about (t, state, input); input (n_input), usually whole->input. BOUGH_RETRY when a tangent
// is not finite or the matrix singular.
bough_status bough_whole_setup(bough_whole *whole, double t, const double *state, const double *input,
                               double gamma);

// x ← (I − γJ)⁻¹ x, x (n_state); whole->change is then the change of the inputs with it.
void bough_whole_solve(bough_whole *whole, double *x);

// Response x (n_state) of all states to a change by 1 of one output of a member that does not move by itself.
void bough_whole_follow(bough_whole *whole, int output, double *x);

// Removes the changes of quaternions' lengths from a change x (n_state) of `state`.
void bough_whole_project(const bough_whole *whole, const double *state, double *x);

// The change of all inputs that closes the interface over a change (n_input) of the leaders' inputs from
// outside, members being at x = 0 by themselves; in place.
void bough_whole_close(bough_whole *whole, double *change);

// -- member by member, for a scheme that does several of these in one task -----------------------

// Begins F at a state (n_state) for `rate` (n_state): finds the outputs that the inputs of members need.
void bough_whole_begin_rates(bough_whole *whole, double t, const double *state, double *rate);

// Whether bough_whole_begin_rates computes the member's outputs, for which it needs the member's state; if
// not, they are computed with its rates.
bool bough_whole_outputs_first(const bough_whole *whole, int member);

enum { BOUGH_WHOLE_TIMES = 2 };

// The member's rate in n ≤ BOUGH_WHOLE_TIMES evaluations of one state; leaders after all followers. A
// failure is kept in the status of the first evaluation.
void bough_whole_rates_of(bough_whole *const *evaluation, int n, int member);

// The first failure, followers first: after the failure of a follower the leaders' inputs are not known.
bough_status bough_whole_failure(const bough_whole *whole);

// Begins a solution of x (n_state) in place.
void bough_whole_begin_solution(bough_whole *whole, double *x);

// x_i = (I − γJ_i)⁻¹ r_i of one member by itself.
void bough_whole_solve_of(bough_whole *whole, int member);

// The changes of all inputs, once every member is solved by itself.
void bough_whole_solve_interface(bough_whole *whole);

// Adds the member's response to that, which completes its states in x (n_state).
void bough_whole_respond(const bough_whole *whole, int member, double *x);

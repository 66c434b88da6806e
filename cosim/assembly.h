// An assembly: members, the level in which each advances, and the connections that copy outputs to
// inputs. It is constant after building. Arrays over all inputs contain input j of member i at
// input_offset[i] + j; arrays over outputs and states likewise.
#pragma once

#include "cosim/member.h"

// A member and its level. Members of one level advance in parallel; sequential schemes advance the levels
// in order.
typedef struct bough_assembly_member {
    bough_member *member; // borrowed; outlives the assembly
    int level;
} bough_assembly_member;

// Outputs from_offset … from_offset + count − 1 of one member are inputs to_offset … of another.
typedef struct bough_connection {
    int from, from_offset, to, to_offset, count;
    bool kinematic; // a motion: a scheme with constant values keeps its rate constant instead
} bough_connection;

typedef struct bough_assembly_def {
    int n_member;
    const bough_assembly_member *member; // (n_member)
    int n_connection;
    const bough_connection *connection; // (n_connection)
} bough_assembly_def;

// A pair of ports that exchange power: wrench · twist.
typedef struct bough_port_pair {
    int body;   // the member that returns the wrench
    int wrench; // first input of the wrench's receiver, numbered over all inputs
    int twist;  // first input of the body, numbered over all inputs
    int count;  // components of the wrench
} bough_port_pair;

typedef struct bough_assembly {
    int n_member, n_level;
    bough_member **member;          // (n_member)
    bool opaque;                    // one of them is: the whole has no tangents
    int *level;                     // (n_member)
    int n_state, n_input, n_output; // sums over the members
    int *state_offset;              // (n_member + 1)
    int *input_offset;              // (n_member + 1)
    int *output_offset;             // (n_member + 1)
    int *receiver;                  // (n_input) the member that gets each input
    int *source;                    // (n_input) the output that feeds each input
    int *source_member;             // (n_input) the member of that output
    bool *kinematic;                // (n_input)
    int *vector;       // (n_input) first of the up to three inputs that form a vector with this one
    bool *feedthrough; // (n_member) whether outputs depend on inputs directly
    int *order;        // (n_member) outputs evaluated in this order need no iteration
    bool *leads; // (n_member) leaders: members of level 0, and others that are connected with each other. The
                 // other members are followers, which are connected with members of level 0 only
    int n_follower;
    int *by_role;        // (n_member) the followers, then the leaders
    bool followers_last; // no outputs of leaders depend on those of followers directly
    int n_pair;
    bough_port_pair *pair; // (n_pair)
} bough_assembly;

// Builds the assembly in the arena; every input is connected once. BOUGH_INVALID when the outputs
// form an algebraic loop. Feedthrough is found by probing output_tangent at the members' current
// states.
bough_status bough_assembly_build(bough_arena *arena, const bough_assembly_def *def,
                                  bough_assembly **assembly);

// Outputs and inputs of all members at their current states: output (n_output), input (n_input).
void bough_assembly_outputs(const bough_assembly *a, double t, double *output, double *input);

// All members' current states: state (n_state).
void bough_assembly_states(const bough_assembly *a, double *state);

// All members' error scales: scale (n_state).
void bough_assembly_scales(const bough_assembly *a, double *scale);

// input[j] = output[source[j]] for the inputs of one member.
void bough_assembly_gather(const bough_assembly *a, int member, const double *output, double *input);

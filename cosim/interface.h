// The interface of linearised members, condensed to the coordinates in which the leading members
// move all others.
//
// A leader's outputs change by Σ w_c ∂o/∂w_c. Its coordinates w are its states if these are fewer than its
// inputs and its outputs depend on states only, else its inputs. A follower is connected with leaders only.
// After its elimination the equations of all leaders are theory (56):
//     w = Z u,   u = b + K w,   hence   (I − Z K) w = Z b
// with the leaders' inputs u, the response Z of their coordinates to them (1 for inputs), and the response
// K of the inputs to the coordinates through leaders and followers. So many bodies on one leader with two
// states cost two unknowns, and work in proportion to their number.
#pragma once

#include "core/base/level.h"
#include "cosim/assembly.h"

// One member's linearisation, its factors and its response to the interface.
typedef struct bough_interface_member {
    // constant
    bool is_leader;
    bool by_state; // leader: its coordinates are its states, else its inputs
    int leader;    // follower: its directions are the coordinates of that member; −1: its own inputs
    int first;     // leader: its coordinates begin there among all
    int n;         // number of coordinates of a leader, of directions of a follower; the coordinates of a
                   // leader by inputs are its directions, too

    // by linearising, factoring and responding
    void *factors;         // of its I − γJ
    double *column;        // (n_input × n_state) ∂f/∂u; of a leader by states γ ∂f/∂u
    double *inverse;       // leader by states: (n_state × n_state) (I − γJ)⁻¹ by columns
    double *direction;     // others: (n × n_input) change of its inputs along each direction
    double *state_change;  // others: (n × n_state) response of its states to that
    double *output_change; // (n × n_output) of its outputs to each coordinate or direction
} bough_interface_member;

typedef struct bough_interface {
    // constant
    const bough_assembly *assembly;
    bough_level level;            // of the kernels
    bough_interface_member *part; // (n_member)
    int n_leader_input;           // of all leaders
    int *leader_input;            // (n_leader_input) numbered over all inputs
    int n;                        // coordinates of all leaders

    // by bough_interface_close
    double *gain;   // (n_leader_input × n, column-major, as the next) K
    double *loop;   // (n × n) Z K
    double *matrix; // (n × n) I − Z K, factored
    int *pivot;     // (n)

    // by bough_interface_solve
    double *coordinate; // (n) w
    double *moved;      // (n_output) the leaders' outputs' change with it

    // scratch
    double *sum, *right; // (n), (n_leader_input)
    double *eigen;       // eigenvectors and eigenvalues of Z K, and room for them
    double *work;        // (n_state) of each member
} bough_interface;

bough_interface *bough_interface_create(bough_arena *arena, const bough_assembly *assembly);

// The point at which a member is linearised.
typedef struct bough_operating_point {
    double time;
    const double *state, *input; // (n_state), (n_input) of the member
    double gamma;
} bough_operating_point;

// Linearises a member. False when its tangents are not finite.
bool bough_interface_linearise(bough_interface *k, int member, const bough_operating_point *at);

// Factors a member at its last linearisation; of a leader computes columns and responses too. False when
// singular.
bool bough_interface_factor(bough_interface *k, int member, const bough_operating_point *at);

// The follower's columns and responses, once its leaders have been factored.
void bough_interface_respond(bough_interface *k, int member, const bough_operating_point *at);

// Change of a member's outputs with its state and its inputs, by its last linearisation, at `at` or near it;
// either change may be NULL.
void bough_interface_output_change(const bough_interface *k, int member, const bough_operating_point *at,
                                   const double *state_change, const double *input_change, double *change);

// Solves (I − γJ) x = b of the member by itself, in place.
void bough_interface_solve_member(const bough_interface *k, int member, double *x);

// K and the factors of I − Z K. False when that is singular.
bool bough_interface_close(bough_interface *k);

// Solves the interface: w into `coordinate`, and all changes of inputs into change (n_input). Before the
// call, `coordinate` holds r of (I − γJ) x = r for leaders by states and 0 for leaders by inputs; `change`
// holds the changes of all inputs without what the coordinates add to them.
void bough_interface_solve(bough_interface *k, double *change);

// Adds to x (n_state of the member) its response to the coordinates. A follower with its own inputs as
// directions responds to their change by the leaders, `change` (n_input of the member).
void bough_interface_add_response(const bough_interface *k, int member, const double *change, double *x);

// Of a follower with its own inputs as directions: adds its response to their change to output_change. One
// that follows a leader's states adds nothing.
void bough_interface_add_output_response(const bough_interface *k, int member, const double *change,
                                         double *output_change);

// sum (n_state of the member) += factor Σ_j weight_j column_j
void bough_interface_add_columns(const bough_interface *k, int member, double factor, const double *weight,
                                 double *sum);

// The spectral radius of Z K, which is overwritten, the gain of the interface; NaN: not found.
double bough_interface_radius(bough_interface *k);

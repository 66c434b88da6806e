// The common part of searches for an equilibrium, for growth from it and of paths of equilibria: the system
// of all members at rest at a time, finite changes of its states, and one search.
#pragma once

#include "apps/bough/model/equilibrium.h"
#include "cosim/analysis/equilibrium.h"

// Length and time of a scene, relative to those for which the constants of the search are chosen; 1 without a
// length or without forces.
typedef struct bough_equilibrium_units {
    double length;        // of its longest rod, link or spring [500 m]
    double time;          // in which gravity, loads, springs and rotation move it by its length [8 s]
    double period;        // the same [s]
    double force, moment; // all these forces, and times the length [N], [N m]; 0 without them
} bough_equilibrium_units;

// An equilibrium, its growth or a path of equilibria, within bough_arena_use.
typedef struct bough_equilibrium_search {
    bough_simulation *simulation;
    double time;
    bough_equilibrium_def limits; // step, least, tolerance and steps of an equilibrium
    bough_equilibrium_work *work; // of an equilibrium
    bough_growth *growth;         // of a state
    int points;                   // number of points near which growth is searched for
    bough_path_listener listener; // of a path
    bough_path_report *report;

    // by bough_equilibrium_search_set_up
    bough_whole *whole;
    double *state; // (n_state) at rest
    double *scale; // (n_state) of the members' scales, in units of the scene
    bough_equilibrium_units unit;
    bool rests;     // states are set to rest between steps
    double *change; // of one rod's vertices, see rod_static.h
} bough_equilibrium_search;

// The units of a scene.
bough_equilibrium_units bough_equilibrium_measure(bough_simulation *s);

// The same, and with them the scales of the states (n_state).
bough_equilibrium_units bough_equilibrium_find_units(bough_simulation *s, double *scale);

// The system and its states at rest at the time.
void bough_equilibrium_search_set_up(bough_arena *arena, bough_equilibrium_search *x);

// Whether a held joint moves.
bool bough_equilibrium_search_turns(const bough_equilibrium_search *x);

// The limits with the functions that move states and set them to rest. After set_up.
bough_equilibrium_def bough_equilibrium_search_def(bough_equilibrium_search *x);

// The functions `move`, `rest` and `kinetic` of bough_equilibrium_def; self: a bough_equilibrium_search.
double bough_equilibrium_search_move(void *self, const double *state, const double *change, double *moved);
void bough_equilibrium_search_rest(void *self, double *state);
double bough_equilibrium_search_kinetic(void *self, const double *state);

// Finds the states in equilibrium under the last sample of the air's forces. After set_up.
bough_status bough_equilibrium_search_balance(bough_arena *arena, bough_equilibrium_search *x,
                                              bough_equilibrium_def *def);

// One search from the members' states, with samples of the air.
bough_status bough_equilibrium_search_within(bough_equilibrium_def limits, bough_simulation *s, double time,
                                             bough_equilibrium_work *work);

// Measures the time that the parts of a simulation take: its members and its sampled loads.
#ifndef BOUGH_APPS_STUDY_STUDY_CLOCK_H
#define BOUGH_APPS_STUDY_STUDY_CLOCK_H

#include "apps/simulation/build.h"

typedef enum bough_clock_part {
    BOUGH_CLOCK_LEADERS,         // own steps of the leader, the tree
    BOUGH_CLOCK_FOLLOWERS,       // own steps of the other members
    BOUGH_CLOCK_LEADER_MODEL,    // derivatives, outputs, tangents and factors for the coupling
    BOUGH_CLOCK_FOLLOWER_MODEL,
    BOUGH_CLOCK_LOADS,           // sampled loads: the aerodynamics
    BOUGH_CLOCK_RECORDING,       // set by the caller
    BOUGH_CLOCK_PARTS,
} bough_clock_part;

// Name of a part in a table.
const char *bough_clock_name(bough_clock_part part);

typedef struct bough_clock bough_clock;

// Measures every call of a member or load of the simulation from now on; a call then takes two readings of
// the clock more.
bough_status bough_clock_create(bough_arena *arena, bough_simulation *s, bough_clock **clock);

// Time spent so far, summed over the threads: seconds (BOUGH_CLOCK_PARTS); recording stays 0.
void bough_clock_read(const bough_clock *clock, double *seconds);

#endif

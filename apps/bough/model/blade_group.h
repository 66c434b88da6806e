// A turbine's blades as equal parts of its rotor, for the multi-blade transform.
#pragma once

#include "apps/bough/model/simulation.h"

typedef struct bough_blade_group {
    int n;                    // blades; 0: unequal, not evenly spaced, fewer than three, rigid
    const bough_beam **blade; // (n) by azimuth
    int *first;               // (n) row of the first state of each
    int *first_input;         // (n) row of its first input
    double azimuth;           // of the first, about the shaft from the vertical [rad]
    double speed;             // of the rotor [rad/s]
    int n_row, *row;          // (n × n_row) all rows of their states
} bough_blade_group;

// The blades in the simulation's present pose and motion.
bough_status bough_blade_group_find(bough_arena *arena, const bough_simulation *s, bough_blade_group *group);

// Gives every blade the mean of the blades' shapes, at rest in its frame: state (n_state), whose
// inputs are `input` (n_input); mean (n_row) is work.
void bough_blade_group_average(const bough_blade_group *group, const double *input, double *mean,
                               double *state);

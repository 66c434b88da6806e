// The whole scene as a linear system about its equilibrium or the state it begins in,
//     δẏ = A δy + B δu ,   δo = C δy + D δu ,
// y the states of all members as they are, and of the air where it follows in time (air_tangent.h), u what
// acts on the scene from outside, o the channels that follow from the states. All by central differences of
// the program's own equations. A turning rotor keeps its azimuth.
#pragma once

#include "apps/bough/model/simulation.h"

typedef struct bough_signal_name {
    char name[80];
    const char *unit;
    double value; // operating point, in that unit
} bough_signal_name;

typedef struct bough_state_space {
    int n, n_input, n_output; // states of the air included, behind those of the members
    double *a, *b, *c, *d; // (n × n), (n × n_input), (n_output × n), (n_output × n_input), column-major
    bough_signal_name *state;  // (n) SI
    bough_signal_name *input;  // (n_input) SI
    bough_signal_name *output; // (n_output) channels, in their units
} bough_state_space;

// About the state in which the simulation is, at `time`; it is left in it. Inputs: the loads that the scene
// names as inputs, torque of the generator and collective pitch where it has a controller, and the speed of a
// wind by a formula where the air follows (modes.air). A change of pitch is a new angle at rest.
bough_status bough_state_space_find(bough_arena *arena, bough_simulation *s, double time,
                                    bough_state_space *space);

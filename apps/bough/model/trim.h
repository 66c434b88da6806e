// The steady operation of a turbine in the wind at time 0 as the start of a run: the rotor turns at the
// speed, and the blades are pitched to the angle, at which the air's torque is the generator's under the
// control law. Below rated power the pitch is the law's least and the speed is sought; else the speed is the
// pitch controller's and the pitch is sought. The bodies are in equilibrium there (equilibrium.h).
#ifndef BOUGH_APPS_SIMULATION_TRIM_H
#define BOUGH_APPS_SIMULATION_TRIM_H

#include "apps/bough/model/equilibrium.h"

typedef struct bough_trim {
    double speed, pitch; // of the rotor [rad/s], of the blades [rad]
    double torque;       // of the air, about the shaft [N m]
    int tries;           // speeds and pitches whose equilibrium was found
} bough_trim;

// Needs a control law. BOUGH_FAILED where there is no steady operation.
bough_status bough_simulation_trim(bough_arena *arena, bough_simulation *s,
                                   const bough_assembly *assembly, bough_trim *trim);

#endif

// Channels that observe.c takes from other files.
#ifndef BOUGH_APPS_SIMULATION_OBSERVE_H
#define BOUGH_APPS_SIMULATION_OBSERVE_H

#include "apps/simulation/simulation.h"

// Motion and section loads of rods at the places of the scene's sensors.
void bough_observe_sections(bough_simulation *s, bough_channels *list);

// Torque and power in the rotor's shaft; the wrench of the nacelle on the tower's top.
void bough_observe_shaft(bough_simulation *s, bough_channels *list);
void bough_observe_yaw_bearing(bough_simulation *s, bough_channels *list);

#endif

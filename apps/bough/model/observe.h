// Channels that observe.c takes from other files.
#ifndef BOUGH_APPS_MODEL_OBSERVE_H
#define BOUGH_APPS_MODEL_OBSERVE_H

#include "apps/bough/model/simulation.h"

// Puts a vector in this unit; what follows it.
static inline double *bough_observe_vector(bough_vec3 x, double unit, double *value) {
    value[0] = x.x / unit, value[1] = x.y / unit, value[2] = x.z / unit;
    return value + 3;
}

// Motion and section loads of rods at the places of the scene's sensors.
void bough_observe_sections(bough_simulation *s, bough_channels *list);

// Speed and azimuth of the hub; torque and power of the hub on the drive train.
void bough_observe_turn(bough_simulation *s, bough_channels *list);
void bough_observe_shaft(bough_simulation *s, bough_channels *list);

// The wrench of the nacelle on the tower's top.
void bough_observe_yaw_bearing(bough_simulation *s, bough_channels *list);

#endif

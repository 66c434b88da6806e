// Joins a controller to the turbine of a simulation: rotor speed and pitch in, generator torque and
// pitch out, sampled at the scene's rate. Between samples torque goes linearly to what was demanded,
// and the blades' pitch joints by cubics without a jump in speed: both arrive one sample late.
#ifndef BOUGH_APPS_MODEL_CONTROL_LINK_H
#define BOUGH_APPS_MODEL_CONTROL_LINK_H

#include "apps/bough/model/simulation.h"

typedef struct bough_control_link bough_control_link;

// Builds the scene's control, if it has one: the last load of the tree, on the rotor's joint, is the
// generator's.
bough_status bough_control_link_build(bough_arena *arena, bough_simulation *simulation);

// Takes the scene's events into account; called when all else is built.
bough_status bough_control_link_watch(bough_arena *arena, bough_control_link *link);

// Whether it turns the blades on their pitch joints.
bool bough_control_link_pitches(const bough_control_link *link);

// Pitch joints and the generator's torque as in steady operation at a speed of the rotor [rad/s] and a
// pitch [rad]; the law starts from there.
void bough_control_link_stand(bough_control_link *link, double speed, double pitch);

// The generator's torque on the fast shaft [N m], and blades that are turned at a pitch [rad], from now on.
void bough_control_link_put(bough_control_link *link, double torque, double pitch);

// The generator at the last sample.
typedef struct bough_generator {
    double speed, torque, power; // [rad/s], on the fast shaft [N m], electrical [W]
} bough_generator;
bough_generator bough_control_link_generator(const bough_control_link *link);

#endif

// Connects a controller with the turbine of a simulation: it measures rotor speed and pitch and sets
// generator torque and pitch, sampled at the scene's rate. Between samples the torque changes linearly to the
// demand and the pitch joints by cubics without a jump in speed: both reach the demand one sample late.
#pragma once

#include "apps/bough/model/simulation.h"

typedef struct bough_control_link bough_control_link;

// Builds the scene's control, if it has one: the last load of the tree, on the rotor's joint, is the
// generator's.
bough_status bough_control_link_build(bough_arena *arena, bough_simulation *simulation);

// Prepares the scene's events; called after all other parts are built.
bough_status bough_control_link_watch(bough_arena *arena, bough_control_link *link);

// Whether it pitches the blades.
bool bough_control_link_pitches(const bough_control_link *link);

// The last time at which the rate of a pitch changed suddenly, by more than 1 deg/s at a sample [s].
double bough_control_link_sudden(const bough_control_link *link);

// Sets pitch joints and generator torque to steady operation at a rotor speed [rad/s] and a pitch [rad], from
// which the law starts.
void bough_control_link_stand(bough_control_link *link, double speed, double pitch);

// Sets the generator's torque on the fast shaft [N m] and, if it pitches the blades, their pitch [rad].
void bough_control_link_put(bough_control_link *link, double torque, double pitch);

// The generator at the last sample.
typedef struct bough_generator {
    double speed, torque, power; // [rad/s], on the fast shaft [N m], electrical [W]
} bough_generator;
bough_generator bough_control_link_generator(const bough_control_link *link);

// Bladed's interface to a turbine controller: a shared library whose function
//     void DISCON(float *avrSWAP, int *aviFAIL, char *accINFILE, char *avcOUTNAME, char *avcMSG)
// reads and writes numbered records. Here records count from 1, as its manual does.
//
// docs/import.md lists the records that are served.
//
// The library has its own memory: samples of a run cannot be repeated, and a process can use a library in
// one run at a time only.
#pragma once

#include "core/base/arena.h"
#include "core/base/status.h"

enum {
    BOUGH_DISCON_BLADES = 3, // that the interface has records for
    BOUGH_MOST_BLADES = 16,  // of a rotor that is controlled
};

// The measured values for the controller; those of the generator are at the fast shaft.
typedef struct bough_discon_sensed {
    double time, step; // [s]
    bool last;         // of the run
    int n_blade;
    double pitch[BOUGH_MOST_BLADES];       // [rad]
    double root_moment[BOUGH_MOST_BLADES]; // out of plane [N m]
    double in_plane[BOUGH_MOST_BLADES];    // in plane [N m]
    bool individual;                       // each blade is to follow its own demand
    double yaw_error;                      // wind's direction less the nacelle's [rad]
    double heading;                        // of the nacelle, from ground x about z [rad]
    double acceleration[2];                // of the nacelle's origin, fore-aft and side-side [m/s2]
    double nodding;                        // its angular acceleration about the nacelle's y [rad/s2]
    double generator_speed, rotor_speed;   // [rad/s]
    double torque;                         // of the generator [N m]
    double shaft_power, electrical_power;  // [W]
    double wind;                           // undisturbed, at the hub, horizontal [m/s]
    double azimuth;                        // of blade 1 [rad]
} bough_discon_sensed;

typedef struct bough_discon_demand {
    double torque;                   // of the generator [N m]
    double pitch[BOUGH_MOST_BLADES]; // [rad]
} bough_discon_demand;

typedef struct bough_discon bough_discon;

// Loads the library; `input` is the controller's own input file, "" for none. `copy`: loads a copy of the
// library, which has variables of its own. BOUGH_INVALID: the file is missing, is
// not a library, or has no function DISCON.
bough_status bough_discon_open(bough_arena *arena, const char *library, const char *input, bool copy,
                               bough_discon **discon);

// Calls the controller. BOUGH_FAILED with its own message when it reports a failure or demands a value
// that is not finite; warnings are not failures.
bough_status bough_discon_call(bough_discon *discon, const bough_discon_sensed *sensed,
                               bough_discon_demand *demand);

// The field's interface to a turbine controller: a shared library in the style of Bladed whose
// function
//     void DISCON(float *avrSWAP, int *aviFAIL, char *accINFILE, char *avcOUTNAME, char *avcMSG)
// reads and writes numbered records. Here records count from 1, as its manual does.
//
// The library keeps its own memory: a run's samples cannot be repeated, and one process can use a
// library in one run at a time.
#ifndef BOUGH_AERO_DISCON_H
#define BOUGH_AERO_DISCON_H

#include "core/arena.h"
#include "core/status.h"

enum { BOUGH_DISCON_BLADES = 3 };

// What the controller is told, on the fast shaft where it is of the generator.
typedef struct bough_discon_sensed {
    double time, step;       // [s]
    bool last;               // of the run
    int n_blade;             // 1 to 3
    double pitch[BOUGH_DISCON_BLADES];       // [rad]
    double root_moment[BOUGH_DISCON_BLADES]; // out of plane [N m]
    double generator_speed, rotor_speed;     // [rad/s]
    double torque;           // of the generator [N m]
    double shaft_power, electrical_power;    // [W]
    double wind;             // at the hub, along the shaft [m/s]
    double azimuth;          // of blade 1 [rad]
} bough_discon_sensed;

typedef struct bough_discon_demand {
    double torque;                     // of the generator [N m]
    double pitch[BOUGH_DISCON_BLADES]; // [rad]
} bough_discon_demand;

typedef struct bough_discon bough_discon;

// Loads the library; `input` is the controller's own input file, "" for none. BOUGH_INVALID says
// whether the file is missing, is no library, or has no such function.
bough_status bough_discon_open(bough_arena *arena, const char *library, const char *input,
                               bough_discon **discon);

// Calls the controller. BOUGH_FAILED with its own message when it reports a failure or demands what
// is no number; warnings are not failures.
bough_status bough_discon_call(bough_discon *discon, const bough_discon_sensed *sensed,
                               bough_discon_demand *demand);

#endif

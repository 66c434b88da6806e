// Variable speed and variable pitch: the baseline control of the NREL 5 MW turbine. Generator torque
// over the filtered generator speed, region by region; above rated speed collective pitch by a PI
// law whose gains decrease with the pitch, because the sensitivity of the power increases with it.
//
// J. Jonkman, S. Butterfield, W. Musial, G. Scott, "Definition of a 5-MW Reference Wind Turbine for
// Offshore System Development", NREL/TP-500-38060 (2009), section 7. All speeds are the generator's.
#pragma once

#include "core/base/status.h"

typedef enum bough_above_rated { BOUGH_CONSTANT_POWER, BOUGH_CONSTANT_TORQUE } bough_above_rated;

typedef struct bough_controller_def {
    double corner;       // of the low-pass filter of the speed [rad/s]
    double cut_in;       // no torque below [rad/s]
    double optimal_from; // torque = gain·speed² from here … [rad/s]
    double optimal_gain; // … at the best tip-speed ratio [N m s²/rad²]
    double rated_speed;  // constant power or torque from here [rad/s]
    int above_rated;     // bough_above_rated: which of the two
    double rated_power;  // mechanical [W]
    double slip;         // of the line between the two, relative to its synchronous speed [-]
    double most_torque;  // [N m]
    bool motoring; // an induction generator: below its synchronous speed it drives, down to −most_torque
    double torque_rate;             // the most [N m/s]
    double power_pitch;             // pitch above which the power is constant from optimal_from on [rad]
    double reference_speed;         // of the pitch [rad/s]
    double proportional;            // gain at no pitch [s]
    double integral;                // [-]
    double halving_pitch;           // where both gains are halved [rad]
    double least_pitch, most_pitch; // [rad]
    double pitch_rate;              // the most [rad/s]
} bough_controller_def;

// BOUGH_INVALID: the message names the value that is out of range.
bough_status bough_controller_check(const bough_controller_def *def);

// Doubles only, saved and restored as a row of them.
typedef struct bough_controller_state {
    double started;  // 0: the next advance starts from the measured values
    double speed;    // filtered [rad/s]
    double integral; // of the speed error [rad]
    double torque;   // of the generator [N m]
    double pitch;    // demanded [rad]
} bough_controller_state;

// The torque at a filtered speed and a pitch, without its limit in time [N m]. Without `motoring` it never
// drives: none at and below cut-in, positive above.
double bough_controller_torque(const bough_controller_def *def, double speed, double pitch);

// Advances by `step` [s] with the measured generator speed [rad/s] and pitch [rad]. The demanded torque and
// pitch are in the state.
void bough_controller_advance(const bough_controller_def *def, double speed, double pitch, double step,
                              bough_controller_state *state);

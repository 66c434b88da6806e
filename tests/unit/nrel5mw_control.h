// The law of variable speed of the NREL 5 MW turbine: J. Jonkman et al., NREL/TP-500-38060 (2009); the
// defaults of a scene.
#pragma once

#include "aero/control/controller.h"

static const bough_controller_def nrel5mw_control = {.corner = 1.570796,
                                                     .cut_in = 70.16224,
                                                     .optimal_from = 91.21091,
                                                     .optimal_gain = 2.332287,
                                                     .rated_speed = 121.6805,
                                                     .rated_power = 5296610,
                                                     .slip = 0.1,
                                                     .most_torque = 47402.91,
                                                     .torque_rate = 15000,
                                                     .power_pitch = 0.01745329,
                                                     .reference_speed = 122.9096,
                                                     .proportional = 0.01882681,
                                                     .integral = 0.008068634,
                                                     .halving_pitch = 0.1099965,
                                                     .most_pitch = 1.570796,
                                                     .pitch_rate = 0.1396263};

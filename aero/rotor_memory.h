// Dynamic inflow and stall of a whole rotor: when its stations' states advance, and saving them.
#ifndef BOUGH_AERO_ROTOR_MEMORY_H
#define BOUGH_AERO_ROTOR_MEMORY_H

#include "aero/rotor.h"

// Before and after the stations of a sample are solved.
void bough_rotor_resume(const bough_rotor_motion *motion, bough_rotor_data *data);
void bough_rotor_remember(const bough_rotor *rotor, const bough_rotor_motion *motion,
                          bough_rotor_data *data);

const bough_inflow_def *bough_rotor_inflow(const bough_rotor *rotor);
bool bough_rotor_has_stall(const bough_rotor *rotor);

#endif

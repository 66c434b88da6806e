// Dynamic inflow and stall of a whole rotor: when its stations' states advance, and saving them.
#ifndef BOUGH_AERO_ROTOR_MEMORY_H
#define BOUGH_AERO_ROTOR_MEMORY_H

#include "aero/rotor/rotor.h"

// Advances the states of all stations; to be called after the stations of a sample are solved.
void bough_rotor_remember(const bough_rotor *rotor, const bough_rotor_motion *motion, bough_rotor_data *data);

#endif

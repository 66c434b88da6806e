// What bough check tells of a turbine: its geometry, its wind, its control.
#ifndef BOUGH_APPS_BOUGH_CHECK_TURBINE_H
#define BOUGH_APPS_BOUGH_CHECK_TURBINE_H

#include "apps/bough/model/build.h"

#include <stdio.h>

// Writes lines "rotor: …", "blade blade1: …", "aero: …", "wind: …", "control: …" of the simulation
// as it starts; that there is none, of what the scene does not have.
void bough_check_turbine(bough_simulation *s, FILE *stream);

#endif

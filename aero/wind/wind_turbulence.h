// Turbulence of IEC 61400-1:2019, annex C.2: Kaimal's spectra and exponential coherence of the
// longitudinal component, as a box that repeats; a seed gives the same box whatever the threads.
//
// P. S. Veers, "Three-dimensional wind simulation", SAND88-0152 (1988): every frequency is a wave of
// deterministic amplitude and random phases, mixed between the points by the Cholesky factor of their
// coherence. Each wave has the variance of the spectrum around its frequency; the slowest wave also has that
// of all lower frequencies, and frequencies above the Nyquist frequency are aliased as in any sampled
// process. The standard deviations are therefore those of the standard. The lateral and vertical
// components have no coherence, because the standard defines none.
#ifndef BOUGH_AERO_WIND_WIND_TURBULENCE_H
#define BOUGH_AERO_WIND_WIND_TURBULENCE_H

#include "aero/wind/wind_box.h"
#include "aero/wind/wind_iec.h"

// Coherence of u between points at a distance [m]: the cross spectrum over the spectrum, 0 … 1.
double bough_turbulence_coherence(const bough_wind_iec_def *def, double distance, double f);

// Whether two definitions make the same box.
bool bough_turbulence_equal(const bough_wind_iec_def *a, const bough_wind_iec_def *b);

// Makes the box, in which the mean wind by its profile is contained.
bough_status bough_turbulence_make(bough_arena *arena, const bough_wind_iec_def *def, bough_wind_box *box);

#endif

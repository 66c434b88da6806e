// Wind conditions of IEC 61400-1:2019, clause 6: normal and extreme turbulence, normal profile,
// gusts and extreme winds, by name.
//
// Axes: x downwind, y to the left, z up from the ground. A positive change of direction is one where
// the wind comes from further clockwise, seen from above.
#pragma once

#include "aero/wind/wind_box.h"
#include "core/base/status.h"
#include "core/base/vec3.h"

typedef enum bough_wind_condition {
    BOUGH_WIND_NTM,        // normal turbulence
    BOUGH_WIND_ETM,        // extreme turbulence
    BOUGH_WIND_EWM,        // extreme wind, turbulent
    BOUGH_WIND_EWM_STEADY, // extreme wind with the gust in its speed
    BOUGH_WIND_NWP,        // normal profile
    BOUGH_WIND_EOG,        // extreme operating gust
    BOUGH_WIND_EDC,        // extreme change of direction
    BOUGH_WIND_ECD,        // extreme coherent gust with change of direction
    BOUGH_WIND_EWS,        // extreme shear
} bough_wind_condition;

typedef enum bough_wind_class {
    BOUGH_WIND_IA_PLUS,
    BOUGH_WIND_IA,
    BOUGH_WIND_IB,
    BOUGH_WIND_IC,
    BOUGH_WIND_IIA_PLUS,
    BOUGH_WIND_IIA,
    BOUGH_WIND_IIB,
    BOUGH_WIND_IIC,
    BOUGH_WIND_IIIA_PLUS,
    BOUGH_WIND_IIIA,
    BOUGH_WIND_IIIB,
    BOUGH_WIND_IIIC,
} bough_wind_class;

typedef struct bough_wind_iec_def {
    int condition;    // bough_wind_condition
    int wind_class;   // bough_wind_class: of reference speed and turbulence
    double speed;     // mean at hub height; not of EWM [m/s]
    double intensity; // longitudinal, in place of the class's; 0: the class's [-]
    double height;    // of the hub [m]
    double diameter;  // of the rotor [m]
    double exponent;  // of the power law [-]
    double start;     // of a gust [s]
    int negative;     // 1: the change of direction or shear is negative
    int horizontal;   // 1: EWS across the wind, 0: over the height
    int yearly;       // 1: EWM once a year, 0: once in 50 years
    // of turbulence
    int seed;
    int points;       // of the grid, over height and breadth
    double width;     // of the grid [m]
    double time_step; // [s]
    double period;    // after which it repeats [s]
} bough_wind_iec_def;

bool bough_wind_iec_is_turbulent(int condition);
bool bough_wind_iec_is_extreme_speed(int condition); // the class gives the speed

// Mean wind at hub height [m/s].
double bough_wind_iec_speed(const bough_wind_iec_def *def);

// Longitudinal standard deviation σ₁ at hub height, of gusts that of normal turbulence [m/s].
double bough_wind_iec_deviation(const bough_wind_iec_def *def);

// Longitudinal turbulence scale Λ₁ at a height [m].
double bough_wind_iec_scale(double height);

// A condition without turbulence, at its start.
typedef struct bough_wind_iec {
    bough_wind_iec_def def;
    double speed;  // at hub height [m/s]
    double gust;   // amplitude: EOG and ECD [m/s], EWS per height or breadth [1/s]
    double change; // of the direction [rad]
    double length; // of the event [s]
} bough_wind_iec;

// BOUGH_INVALID: the message names the value that is out of range.
bough_status bough_wind_iec_check(const bough_wind_iec_def *def);

bough_wind_iec bough_wind_iec_start(const bough_wind_iec_def *def);
bough_vec3 bough_wind_iec_at(const bough_wind_iec *wind, bough_vec3 position, double t);

// Its mean speed at a height [m/s]; nothing below ground.
double bough_wind_iec_profile(const bough_wind_iec_def *def, double height);

// -- turbulence (wind_turbulence.c) ---------------------------------------------------------------

// Turbulence of IEC 61400-1:2019, annex C.2: Kaimal's spectra and exponential coherence of the
// longitudinal component, as a box that repeats; a seed gives the same box whatever the threads.
//
// P. S. Veers, "Three-dimensional wind simulation", SAND88-0152 (1988): every frequency is a wave of
// deterministic amplitude and random phases, mixed between the points by the Cholesky factor of their
// coherence. Each wave has the variance of the spectrum around its frequency; the slowest wave also has that
// of all lower frequencies, and frequencies above the Nyquist frequency are aliased as in any sampled
// process. The standard deviations are therefore those of the standard. The lateral and vertical
// components have no coherence, because the standard defines none.

// Coherence of u between points at a distance [m]: the cross spectrum over the spectrum, 0 … 1.
double bough_turbulence_coherence(const bough_wind_iec_def *def, double distance, double f);

// Whether two definitions make the same box.
bool bough_turbulence_equal(const bough_wind_iec_def *a, const bough_wind_iec_def *b);

// The shortest period of a box that is not shorter than the given one [s]: an even number of time steps
// without factors other than 2, 3 and 5. One of more than 1e8 steps is refused when the box is made.
double bough_turbulence_period(double period, double time_step);

// Makes the box, in which the mean wind by its profile is contained.
bough_status bough_turbulence_make(bough_arena *arena, const bough_wind_iec_def *def, bough_wind_box *box);

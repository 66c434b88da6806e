// Connects the rotor's aerodynamics with the bodies of a simulation: it gets the motion of the blades'
// vertices and sets the loads on them, sampled at the scene's rate.
#ifndef BOUGH_APPS_SIMULATION_AERO_LINK_H
#define BOUGH_APPS_SIMULATION_AERO_LINK_H

#include "aero/rotor/rotor.h"
#include "apps/bough/model/simulation.h"

typedef struct bough_aero_link bough_aero_link;

// Builds the rotor of the scene's aero block for the simulation's blades.
bough_status bough_aero_link_build(bough_arena *arena, bough_simulation *simulation,
                                   bough_aero_link **link);

// The sampled load for the master's loop.
bough_sampled_load bough_aero_link_load(bough_aero_link *link);

// Samples the blades at their present motion and keeps the loads constant from t on. Dynamic inflow and stall
// are in equilibrium, at the next sample again.
void bough_aero_link_hold(bough_aero_link *link, double t);

// The same, but dynamic inflow and stall continue from the last sample, and the next sample from this one.
void bough_aero_link_go_on(bough_aero_link *link, double t);

// Saves or restores dynamic inflow and stall: memory (bough_rotor_memory_size).
void bough_aero_link_memory(bough_aero_link *link, bough_snapshot_move move, double *memory);

// All that the next samples depend on, and the loads that the bodies have, for schemes that repeat samples:
// restoring puts the loads back.
void bough_aero_link_snapshot(bough_aero_link *link, bough_snapshot *snapshot);

const bough_rotor *bough_aero_link_rotor(const bough_aero_link *link);

// bough_aero_signal_missed of a blade.
double bough_aero_link_missed(const bough_aero_link *link, int blade);

// Changes the speed of a wind by a formula [m/s] from the next sample on.
void bough_aero_link_set_wind(bough_aero_link *link, double speed);

// The time of that evaluation [s]; NAN: none that is up to date.
double bough_aero_link_evaluated(const bough_aero_link *link);

// To be called when state or wind have been changed from outside: the next sample is evaluated in any case.
void bough_aero_link_renew(bough_aero_link *link);

// Results of the last evaluation, at the last multiple of the period, with the ramp's factor at its time.
const bough_rotor_data *bough_aero_link_data(const bough_aero_link *link, double *factor);

// The wind at the place where the hub stood at the start, at a time [s], undisturbed, ground axes [m/s].
bough_vec3 bough_aero_link_hub_wind(const bough_aero_link *link, double t);

#endif

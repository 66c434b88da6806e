// Connects the rotor's aerodynamics with the bodies of a simulation: it gets the motion of the blades'
// vertices and sets the loads on them, sampled at the scene's rate.
#ifndef BOUGH_APPS_MODEL_AERO_LINK_H
#define BOUGH_APPS_MODEL_AERO_LINK_H

#include "aero/rotor/rotor.h"
#include "apps/bough/model/simulation.h"

typedef struct bough_aero_link bough_aero_link;

// Builds the rotor of the scene's aero block, if it has one, for the simulation's blades.
bough_status bough_aero_link_build(bough_arena *arena, bough_simulation *simulation);

// The turbulence by name of a scene's wind, with what the scene leaves to choose. False: it has none.
bool bough_aero_link_turbulence(const bough_scene *scene, bough_wind_iec_def *def);

// Samples the blades, and the drag of tower and hub, at their present motion and keeps the loads constant
// from t on. Dynamic inflow and stall are brought to equilibrium, for this sample and before the next.
void bough_aero_link_hold(bough_aero_link *link, double t);

// The same, but dynamic inflow and stall go on from the last sample to this one and to the next.
void bough_aero_link_continue(bough_aero_link *link, double t);

// Saves or restores dynamic inflow and stall: memory (bough_rotor_memory_size).
void bough_aero_link_memory(bough_aero_link *link, bough_snapshot_move move, double *memory);

// Saves or restores the present loads on a blade: memory (bough_aero_link_loads_size).
void bough_aero_link_loads(bough_aero_link *link, bough_snapshot_move move, int blade, double *memory);
int bough_aero_link_loads_size(bough_aero_link *link, int blade);

const bough_rotor *bough_aero_link_rotor(const bough_aero_link *link);

// bough_aero_signal_missed of a blade.
double bough_aero_link_missed(const bough_aero_link *link, int blade);

// Changes the speed of a wind by a formula [m/s] from the next sample on.
void bough_aero_link_set_wind(bough_aero_link *link, double speed);

// To be called when state or wind have been changed from outside: the next sample is evaluated in any case.
void bough_aero_link_renew(bough_aero_link *link);

// Results of the last evaluation, at the last multiple of the period, with the ramp's factor at its time
// (NULL: not wanted).
const bough_rotor_data *bough_aero_link_data(const bough_aero_link *link, double *factor);

// The time of that evaluation [s]; NAN: none that is up to date.
double bough_aero_link_evaluated(const bough_aero_link *link);

// The wind at the place where the hub stood at the start, at a time [s], undisturbed, ground axes [m/s].
bough_vec3 bough_aero_link_hub_wind(const bough_aero_link *link, double t);

// -- the motion of the blades (aero_motion.c) -----------------------------------------------------

// How a rotor's blades move: as they do at present, and as expected at the next sample of the air.

typedef struct bough_aero_motion bough_aero_motion;

// `beam` (n_blade) must stay.
bough_aero_motion *bough_aero_motion_build(bough_arena *arena, bough_simulation *simulation,
                                           const bough_beam *const *beam);

// The motion as it is at the present time t. First the whole rotor's, then each blade's, which may be
// given to different threads.
void bough_aero_motion_rotor(bough_aero_motion *m, double t);
void bough_aero_motion_blade(bough_aero_motion *m, int blade);

// The motion expected at t + ahead, the time of the next such call. Within each blade's frame the rows are
// extrapolated by the parabola through this call and the last two. The frame moves on by its velocity with
// Adams' formula of third order. Lower orders are used where they would have predicted this call better.
void bough_aero_motion_expect_rotor(bough_aero_motion *m, double t, double ahead);
void bough_aero_motion_expect_blade(bough_aero_motion *m, int blade);

// The result of the last calls above.
const bough_rotor_motion *bough_aero_motion_found(const bough_aero_motion *m);

// A blade's motion, rows as in bough_blade_motion: at the call before (this, if there is none), at this one,
// and as found.
typedef struct bough_aero_course {
    const double *before, *now, *next;
} bough_aero_course;
bough_aero_course bough_aero_motion_course(const bough_aero_motion *m, int blade);

// Makes the next call the first.
void bough_aero_motion_forget(bough_aero_motion *m);

// All that the next calls depend on.
void bough_aero_motion_snapshot(bough_aero_motion *m, bough_snapshot *snapshot);

// -- loads between the samples of the air (aero_signal.c) -----------------------------------------

// The aerodynamic loads on one blade as functions of time between two samples.

// For a rod: force and moment on each vertex in the body's axes (6 × vertices), then force and moment per
// length along each segment in the axes of its middle, mean and slope (12 × segments). For a modal body:
// the first of these. For a rigid body: the resultant (6).
typedef struct bough_aero_signal bough_aero_signal;

// A rotor's loads on the blade: on vertices (6 × n), mean and slope per length of segments
// (12 × (n − 1)), both in the axes of the blade's frame; their slopes (bough_rotor_data.slope; NULL: none);
// all by a factor.
typedef struct bough_aero_fresh {
    const double *load, *line, *slope;
    double factor;
} bough_aero_fresh;

bough_aero_signal *bough_aero_signal_build(bough_arena *arena, bough_simulation *simulation,
                                           const bough_beam *beam);

// The loads stay as they are from `start` on. `next` is the motion that they belong to.
void bough_aero_signal_hold(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course,
                            double start);

// They go from what they are now to the fresh ones over the span [s]. A signal that has been held or
// followed before is continuous.
void bough_aero_signal_follow(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course,
                              double start, double span);

// The recent difference between the loads and those at the body's actual motion, relative to the loads; 0 for
// a rod, whose loads follow its motion. About 1: the sampling rate is too low for the body's vibrations,
// which then grow.
double bough_aero_signal_missed(const bough_aero_signal *s);

// All that the signal depends on; restoring gives it to the body.
void bough_aero_signal_snapshot(bough_aero_signal *s, bough_snapshot *snapshot);

// -- drag of tower and hub (drag_link.c) ----------------------------------------------------------

// Joins the drag of tower and hub to the bodies of a simulation, sampled with the aerodynamics;
// forces go linearly to what was sampled and arrive one sample late.

typedef struct bough_drag_link bough_drag_link;

// After the aerodynamics.
void bough_drag_link_build(bough_arena *arena, bough_simulation *simulation);

// Sets the drag of the present motion, constant, as bough_aero_link_hold does the rotor's loads.
void bough_drag_link_hold(bough_drag_link *link, double t);

#endif

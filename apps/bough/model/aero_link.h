// Connects the rotor's aerodynamics with the bodies of a simulation: takes the motion of the blades' vertices
// and sets the loads on them, sampled at the scene's rate.
#pragma once

#include "aero/rotor/rotor.h"
#include "apps/bough/model/simulation.h"

typedef struct bough_aero_link bough_aero_link;

// Builds the rotor of the scene's aero block, if it has one, for the simulation's blades.
bough_status bough_aero_link_build(bough_arena *arena, bough_simulation *simulation);

// The definition of a scene's turbulence, with defaults. False: its wind is not turbulent.
bool bough_aero_link_turbulence(const bough_scene *scene, bough_wind_iec_def *def);

// Samples the blades, and the drag of tower and hub, at their present motion and keeps the loads constant
// from t on. Dynamic inflow and stall are set to equilibrium, for this sample and before the next.
void bough_aero_link_hold(bough_aero_link *link, double t);

// The same, but dynamic inflow and stall continue from the last sample to this one and to the next. `moved`
// false: time, motion and wind, and so the induction in equilibrium, are those of the last such call.
void bough_aero_link_continue(bough_aero_link *link, double t, bool moved);

// Only continues dynamic inflow and stall in this way: the loads on the blades stay as they are.
void bough_aero_link_remember(bough_aero_link *link, double t, bool moved);

// Saves or restores dynamic inflow and stall: memory (bough_rotor_memory_size).
void bough_aero_link_memory(bough_aero_link *link, bough_snapshot_move move, double *memory);

// Saves, restores or measures the present loads on a blade; returns the size of `memory`.
int bough_aero_link_loads(bough_aero_link *link, bough_snapshot_move move, int blade, double *memory);

// The place of the ground [m] on which the tower of the scene's air stands: below its body, or the origin.
bough_vec3 bough_aero_link_foot(const bough_simulation *simulation);

const bough_rotor *bough_aero_link_rotor(const bough_aero_link *link);

// bough_aero_signal_missed of a blade.
double bough_aero_link_missed(const bough_aero_link *link, int blade);

// Changes the speed of a wind by a formula [m/s] from the next sample on.
void bough_aero_link_set_wind(bough_aero_link *link, double speed);

// To be called after a change of the state or the wind from outside: the next sample is evaluated anew.
void bough_aero_link_renew(bough_aero_link *link);

// Results of the last sample, with the factor of the ramp at its time (NULL: not wanted).
const bough_rotor_data *bough_aero_link_data(const bough_aero_link *link, double *factor);

// The time of that sample [s]; NAN: there is none that is up to date.
double bough_aero_link_evaluated(const bough_aero_link *link);

// The wind at the place where the hub stood at the start, at a time [s], undisturbed, ground axes [m/s].
bough_vec3 bough_aero_link_hub_wind(const bough_aero_link *link, double t);

// -- the motion of the blades (aero_motion.c) -----------------------------------------------------

// The motion of a rotor's blades, at present and as predicted for the next sample of the air.

typedef struct bough_aero_motion bough_aero_motion;

// `beam` (n_blade) is borrowed.
bough_aero_motion *bough_aero_motion_build(bough_arena *arena, bough_simulation *simulation,
                                           const bough_beam *const *beam);

// Sets the motion at the present time t, first that of the rotor, then that of each blade, which may be on
// different threads.
void bough_aero_motion_rotor(bough_aero_motion *m, double t);
void bough_aero_motion_blade(bough_aero_motion *m, int blade);

// The motion expected at t + ahead, the time of the next such call. Within each blade's frame the rows are
// extrapolated by the parabola through this call and the last two. The frame moves on by its velocity with
// Adams' formula of third order. Lower orders are used where they would have predicted this call better.
void bough_aero_motion_expect_rotor(bough_aero_motion *m, double t, double ahead);
void bough_aero_motion_expect_blade(bough_aero_motion *m, int blade);

// The result of these calls.
const bough_rotor_motion *bough_aero_motion_found(const bough_aero_motion *m);

// Motion of a blade, rows as in bough_blade_motion: at the previous call (this one if there is none), at this
// call, and the result.
typedef struct bough_aero_course {
    const double *before, *now, *next;
} bough_aero_course;
bough_aero_course bough_aero_motion_course(const bough_aero_motion *m, int blade);

// Discards all previous calls.
void bough_aero_motion_forget(bough_aero_motion *m);

// The memory of the next calls.
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

// Constant loads from `start` on, which belong to the motion course.next.
void bough_aero_signal_hold(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course,
                            double start);

// Loads that change from the present ones to the new ones over the span [s], continuously after an earlier
// call.
void bough_aero_signal_follow(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course,
                              double start, double span);

// Recent difference between the loads and those at the actual motion of the body, relative to the loads; 0
// for a rod, whose loads follow its motion. Near 1 the sampling rate is too low for the vibrations of the
// body, which then grow.
double bough_aero_signal_missed(const bough_aero_signal *s);

// The memory of the signal; restoring sets it on the body.
void bough_aero_signal_snapshot(bough_aero_signal *s, bough_snapshot *snapshot);

// -- drag of tower and hub (drag_link.c) ----------------------------------------------------------

// Drag of tower and hub, sampled with the aerodynamics; forces change linearly to the sampled values, which
// they reach one sample late.

typedef struct bough_drag_link bough_drag_link;

// After the aerodynamics.
void bough_drag_link_build(bough_arena *arena, bough_simulation *simulation);

// Sets the drag at the present motion, constant, as bough_aero_link_hold sets the rotor's loads.
void bough_drag_link_hold(bough_drag_link *link, double t);

// How a rotor's blades move: as they do at present, and as expected at the next sample of the air.
#ifndef BOUGH_APPS_SIMULATION_AERO_MOTION_H
#define BOUGH_APPS_SIMULATION_AERO_MOTION_H

#include "aero/rotor/rotor.h"
#include "apps/bough/model/build.h"

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

// A blade's rows, BOUGH_BLADE_ROWS × n_vertex, at this call and the one before (this, if there is none).
const double *bough_aero_motion_now(const bough_aero_motion *m, int blade);
const double *bough_aero_motion_before(const bough_aero_motion *m, int blade);

// Makes the next call the first.
void bough_aero_motion_forget(bough_aero_motion *m);

// All that the next calls depend on.
void bough_aero_motion_snapshot(bough_aero_motion *m, bough_snapshot *snapshot);

#endif

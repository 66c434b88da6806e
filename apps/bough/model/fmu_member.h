// An FMU as a member: it advances by its own steps from communication point to communication point, under
// the motion of a body's frame, and answers with the wrench on the carrier. Its equations are not known, so
// the system has outputs only: those of the last communication point.
#ifndef BOUGH_APPS_SIMULATION_FMU_MEMBER_H
#define BOUGH_APPS_SIMULATION_FMU_MEMBER_H

#include "apps/bough/scene/scene.h"
#include "cosim/member.h"

// Loads the FMU's library and makes an instance, which the arena releases, at time 0 under `motion`
// (BOUGH_SCENE_MOTION); `duration` [s] is that of the run. BOUGH_INVALID: the library is missing or lacks a
// function of the standard. BOUGH_FAILED: the FMU reports an error; the message is its own. The member must
// stay where it is.
bough_status bough_fmu_member_create(bough_arena *arena, const bough_scene_body *body,
                                     const double *motion, double duration, bough_member *member);

#endif

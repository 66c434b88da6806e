// A rod behind the contract of core/subsystem.h: kind "rod". Inputs are the twist of the body
// reference frame and gravity, in its axes; outputs the root wrench on the carrier, in its axes. Of a
// rod that carries bodies the motion of its last vertex and the wrench there follow, see rod.h.
#ifndef BOUGH_FLEXBODY_ROD_SUBSYSTEM_H
#define BOUGH_FLEXBODY_ROD_SUBSYSTEM_H

#include "core/subsystem.h"
#include "core/integrator.h"
#include "flexbody/rod.h"

typedef struct bough_rod_body bough_rod_body;

// Builds state, solvers and scratch in the arena. Starts at rest relative to its frame, which moves
// with `input` (the first 9) at time `start`; tolerances are relative to 1 m, 0.1 rad, 1 m/s,
// 0.1 rad/s.
bough_status bough_rod_body_create(bough_arena *arena, const bough_rod_model *model, double start,
                                   bough_integrator_options micro, const double *input,
                                   bough_rod_body **body);

// The contract's view; valid as long as the arena.
bough_subsystem bough_rod_body_subsystem(bough_rod_body *body);

// The loads, to be changed between steps only.
bough_rod_loads *bough_rod_body_loads(bough_rod_body *body);

const bough_rod_model *bough_rod_body_model(const bough_rod_body *body);

// Current state (13 n), as rod.h lays it out.
const double *bough_rod_body_state(const bough_rod_body *body);

#endif

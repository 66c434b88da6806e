// A rod behind the contract of core/solve/system.h: kind "rod". Inputs are the twist of the body
// reference frame and gravity, in its axes; outputs the root wrench on the carrier, in its axes. The state is
// rod.h's. Of a rod that carries bodies the motion of its last vertex and the wrench there follow, see rod.h.
#pragma once

#include "core/solve/system.h"
#include "flexbody/rod/rod.h"

typedef struct bough_rod_body bough_rod_body;

// Builds the body in the arena. It starts at rest relative to its frame, which moves with `input`; one that
// carries bodies bends to where its end is. Tolerances are relative to 1 m, 0.1 rad, 1 m/s, 0.1 rad/s.
bough_rod_body *bough_rod_body_create(bough_arena *arena, const bough_rod_model *model, const double *input);

// The contract's view; valid as long as the arena.
bough_system bough_rod_body_system(bough_rod_body *body);

// The loads, to be changed between steps only.
bough_rod_loads *bough_rod_body_loads(bough_rod_body *body);

const bough_rod_model *bough_rod_body_model(const bough_rod_body *body);

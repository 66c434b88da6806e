// Loads on a rod or a modal body that keep their directions in the ground while the body's frame turns: a
// system around the body's own, with the ground's axes as nine more inputs.
#pragma once

#include "core/solve/system.h"
#include "flexbody/rod/rod_load.h"

enum { BOUGH_GROUND_AXES = 9 }; // components of the ground's x, y and z axis in BRF axes

typedef struct bough_ground_body bough_ground_body;

// `inner` is the system of the body with this mesh and these loads, which are borrowed; `vertices_only`: it
// takes no loads between its vertices.
bough_ground_body *bough_ground_body_create(bough_arena *arena, const bough_system *inner,
                                            const bough_rod_model *mesh, bough_rod_loads *loads,
                                            bool vertices_only);

// The inner system with inputs for the axes after its own.
bough_system bough_ground_body_system(bough_ground_body *body);

// Adds a load as bough_rod_lump does, `wrench` and `end` in ground axes; its table is
// borrowed.
typedef struct bough_ground_load_def {
    bough_rod_reach reach;
    double wrench[6], end[6]; // at both ends of the reach
    bough_schedule schedule;  // of the factor
} bough_ground_load_def;
void bough_ground_body_load(bough_ground_body *body, bough_arena *arena, const bough_ground_load_def *def);

// Resolves all loads in BRF axes for these ground axes (9), as readers of the body's loads need.
void bough_ground_body_turn(bough_ground_body *body, const double *axes);

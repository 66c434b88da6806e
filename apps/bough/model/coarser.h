// A copy of a scene that is coarser by about a factor of two: for the companion of a run (companion.h).
#ifndef BOUGH_APPS_MODEL_COARSER_H
#define BOUGH_APPS_MODEL_COARSER_H

#include "apps/bough/model/simulation.h"

// What the copy is coarser in. A set of these.
enum {
    BOUGH_COARSER_MESH = 1, // half the segments of each rod, or more where it has few
    BOUGH_COARSER_AIR = 2,  // half the aerodynamic sampling rate
    // Twice the macro step and the longest step, ten times the tolerance (six beside a finer mesh; 1.5 and
    // 3 times beside an explicit coupling); all bodies as one system, whose steps know no error of a
    // coupling.
    BOUGH_COARSER_TIME = 4,
    BOUGH_COARSER_ALL = 7,
};

// In the arena; it shares what no run changes with the scene. It estimates no error itself.
bough_scene *bough_coarser_scene(bough_arena *arena, const bough_scene *scene, int parts);

// The same of the scene of a simulation, whose turbulence it shares: neither is generated or read twice.
bough_scene *bough_coarser_scene_beside(bough_arena *arena, const bough_simulation *run, int parts);

// The part of the difference between solutions of the scene and of such a copy that the scene's solution errs
// by: a quarter, between an order of 2 and of 3; half with a coupling, whose error the copy does not share;
// more where meshes differ by less than a factor of two; the whole one where the mesh is finer or the
// coupling is explicit.
double bough_coarser_share(const bough_scene *scene, const bough_scene *other);

// The same for a copy that is coarser in time alone.
double bough_coarser_time_share(const bough_scene *scene);

#endif

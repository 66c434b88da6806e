// Joins the drag of tower and hub to the bodies of a simulation, sampled with the aerodynamics;
// forces go linearly to what was sampled and arrive one sample late.
#ifndef BOUGH_APPS_MODEL_DRAG_LINK_H
#define BOUGH_APPS_MODEL_DRAG_LINK_H

#include "apps/bough/model/aero_link.h"

typedef struct bough_drag_link bough_drag_link;

// Whether the scene has such drag.
bool bough_drag_link_wanted(const bough_scene *scene);

// After the aerodynamics. `hub_marker` of the tree, on the rotor; −1: no drag of the hub.
bough_status bough_drag_link_build(bough_arena *arena, bough_simulation *simulation, int hub_marker,
                                   bough_drag_link **link);

// The sampled load for the master's loop.
bough_sampled_load bough_drag_link_load(bough_drag_link *link);

// Sets the drag of the present motion, constant, as bough_aero_link_hold does the rotor's loads.
void bough_drag_link_hold(bough_drag_link *link, double t);

// The memory, as bough_aero_link_snapshot.
void bough_drag_link_snapshot(bough_drag_link *link, bough_snapshot *snapshot);

#endif

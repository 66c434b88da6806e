// Boxes of turbulence that the runs of a study share: one of 600 s takes as long to make as a dozen seconds
// of a turbine's run, and more memory than all else of it.
#ifndef BOUGH_APPS_CASES_BOXES_H
#define BOUGH_APPS_CASES_BOXES_H

#include "apps/bough/scene/scene.h"
#include "core/base/arena.h"

typedef struct bough_boxes bough_boxes;

// For so many runs at the same time; keeps as many boxes.
bough_boxes *bough_boxes_create(bough_arena *arena, int runs);

// The box of the scene's turbulence, made unless it is there, for a run until it gives it back. NULL: the
// scene has none, or it cannot be made, as its own run will report.
const bough_wind_box *bough_boxes_lend(bough_boxes *boxes, const bough_scene *scene);
void bough_boxes_give_back(bough_boxes *boxes, const bough_wind_box *box);

#endif

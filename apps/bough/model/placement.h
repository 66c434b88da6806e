// Placements and axes of a scene as transforms and vectors.
#ifndef BOUGH_APPS_SIMULATION_PLACEMENT_H
#define BOUGH_APPS_SIMULATION_PLACEMENT_H

#include "apps/bough/scene/scene.h"
#include "core/tree/joint.h"

// The unit vector of a bough_scene_axis.
bough_vec3 bough_placement_axis(int axis);

// The rotation by an angle [rad] about one of the axes.
bough_mat3 bough_placement_turn(int axis, double angle);

// The frame after n steps, in the frame they start from.
bough_transform bough_placement(int n, const bough_scene_step *step);

#endif

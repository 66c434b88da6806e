// What a mode of the whole scene is, read from its shape: whose energy, in which direction, in
// which pattern over the blades.
#ifndef BOUGH_APPS_SCENE_MODE_SHARE_H
#define BOUGH_APPS_SCENE_MODE_SHARE_H

#include "apps/scene/mode_shape.h"
#include "apps/scene/vibration.h"

// Sets mode->share (n_body, zero before), body, blades, direction, pattern and whirl.
void bough_mode_share_set(const bough_mode_shape *x, bough_scene_mode *mode);

#endif

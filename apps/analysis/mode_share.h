// What a mode of the whole scene is, read from its shape: whose energy, in which direction, in
// which pattern over the blades.
#ifndef BOUGH_APPS_ANALYSIS_MODE_SHARE_H
#define BOUGH_APPS_ANALYSIS_MODE_SHARE_H

#include "apps/analysis/mode_shape.h"
#include "apps/analysis/vibration.h"

// Sets mode->share (n_body, zero before), body, blades, direction, pattern and whirl.
void bough_mode_share_set(const bough_mode_shape *x, bough_scene_mode *mode);

#endif

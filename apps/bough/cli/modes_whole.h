// The part of `bough modes` for whole scenes.
#ifndef BOUGH_APPS_BOUGH_MODES_WHOLE_H
#define BOUGH_APPS_BOUGH_MODES_WHOLE_H

#include "apps/bough/analysis/vibration.h"
#include "apps/bough/cli/options.h"
#include "apps/bough/model/build.h"

// Finds, prints and writes them.
bough_status bough_modes_whole(bough_arena *arena, const bough_options *options, bough_simulation *s);

// What moves most in a mode, and how.
const char *bough_modes_body(const bough_simulation *s, const bough_scene_mode *mode);
const char *bough_modes_shape(const bough_simulation *s, const bough_scene_mode *mode);

#endif

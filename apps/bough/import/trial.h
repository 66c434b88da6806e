// The first steps of an imported scene, as a run takes them.
#ifndef BOUGH_IMPORT_TRIAL_H
#define BOUGH_IMPORT_TRIAL_H

#include "apps/bough/scene/scene.h"
#include "core/base/arena.h"
#include "core/base/status.h"

// Builds the scene and takes at most `steps` macro steps, with one thread and the calls of the controller's
// library, in a process of its own: a library that crashes ends the trial, not the import. `bound`: of the
// errors relative to the channels' ranges [1]; 0: none. BOUGH_INVALID: there is no such model, or its library
// crashes; BOUGH_FAILED: it cannot be stepped, or its errors exceed the bound.
bough_status bough_import_trial(bough_arena *arena, bough_scene *scene, int steps, double bound);

#endif

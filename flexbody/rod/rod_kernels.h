// The rod's kernels at their levels (core/base/level.h): what each does is described where the function
// without a level is declared.
#ifndef BOUGH_FLEXBODY_ROD_ROD_KERNELS_H
#define BOUGH_FLEXBODY_ROD_ROD_KERNELS_H

#include "core/base/level.h"
#include "flexbody/rod/rod_load.h"
#include "flexbody/rod/rod_tangent.h"

// The name of bough_rod_NAME in a file of kernels.
#define AT(name) BOUGH_AT_LEVEL(bough_rod_##name)

BOUGH_DECLARE_LEVELS(bough_rod_form_blocks);

#endif

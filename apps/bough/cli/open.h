// The way from the command line to a built simulation, the same for every command with a scene.
#ifndef BOUGH_APPS_BOUGH_OPEN_H
#define BOUGH_APPS_BOUGH_OPEN_H

#include "apps/bough/cli/options.h"
#include "apps/bough/model/build.h"

// Reads the scene with the options' replacements and threads. Errors in it are written to stderr, one
// a line, and the status then has no message.
bough_status bough_open_scene(bough_arena *arena, const bough_options *options, bough_scene **scene);

// Reads the scene with the options' replacements and builds it, with the errors told likewise.
bough_status bough_open(bough_arena *arena, const bough_options *options, bough_simulation **simulation);

// Those channels of `all`, which outlives the list, that the scene records. BOUGH_INVALID at a name or
// pattern that none matches.
bough_status bough_open_channels(const bough_scene *scene, const bough_channels *all,
                                 bough_channels *recorded);

// The folder for results: as the options say, else out/ and the operand's file name without its
// extension.
const char *bough_out_folder(bough_arena *arena, const bough_options *options);

#endif

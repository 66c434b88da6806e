// One run, from the built simulation to its results.
#ifndef BOUGH_APPS_BOUGH_RUN_H
#define BOUGH_APPS_BOUGH_RUN_H

#include "apps/bough/options.h"
#include "apps/output/channels.h"
#include "apps/output/recorder.h"
#include "apps/scene/error_probe.h"
#include "apps/scene/shape.h"

typedef struct bough_run {
    const bough_options *options;
    bough_arena *arena;
    bough_simulation *simulation;
    bough_channels channels;
    bough_error_probe probe;
    bough_recorder *recorder;
    bough_shape shape;
    bough_frames *frames; // NULL: none are stored
    long next_frame;      // multiple of the frames' interval that is due next
    const char *folder;
    long next_row;   // multiple of the output interval that is due next
    double recorded; // time of the last row [s]
    double build_s;  // wall time of reading and building [s]
    double wall_s;   // of the stepping [s]
    double cpu_s;    // of the stepping, all threads [s]
    bough_status outcome;
} bough_run;

// Writes summary.json into the run's folder.
bough_status bough_run_summarise(const bough_run *run);

// Tells the user how it went: a few lines "key: value".
void bough_run_tell(const bough_run *run, FILE *stream);

#endif

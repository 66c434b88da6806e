// One run, from the built simulation to its results.
#ifndef BOUGH_APPS_BOUGH_RUN_H
#define BOUGH_APPS_BOUGH_RUN_H

#include "apps/bough/checkpoint.h"
#include "apps/bough/options.h"
#include "apps/output/channels.h"
#include "apps/output/recorder.h"
#include "apps/output/vertices.h"
#include "apps/simulation/error_probe.h"
#include "apps/simulation/shape.h"

typedef struct bough_run {
    const bough_options *options;
    bough_arena *arena;
    bough_simulation *simulation;
    bough_channels channels;
    bough_error_probe probe;
    bough_recorder *recorder;
    bough_shape shape;
    bough_frames *frames; // NULL: none are stored
    bough_vertices *vertices; // NULL: none are stored
    long next_vertices;   // multiple of their interval that is due next
    long next_frame;      // multiple of the frames' interval that is due next
    const char *folder;
    long next_row;   // multiple of the output interval that is due next
    double recorded; // time of the last row [s]
    bough_checkpoint checkpoint;
    bough_kept rows, frames_kept; // at the last checkpoint
    bough_statistics *earlier; // (n_member) work of the processes that this one continues
    double wall_from, cpu_from; // of the clocks, counted below so far [s]
    double build_s;  // wall time of reading and building [s]
    double wall_s;   // of the stepping [s]
    double cpu_s;    // of the stepping, all threads [s]
    bough_status outcome;
} bough_run;

// Work of a member over the whole run.
bough_statistics bough_run_statistics(const bough_run *run, int member);

// Brings wall_s and cpu_s to the present.
void bough_run_settle_clock(bough_run *run);

// Writes summary.json into the run's folder.
bough_status bough_run_summarise(const bough_run *run);

// Tells the user how it went: a few lines "key: value".
void bough_run_tell(const bough_run *run, FILE *stream);

#endif

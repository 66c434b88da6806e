// bough run: one run, its files and its checkpoints.
#ifndef BOUGH_APPS_BOUGH_RUN_H
#define BOUGH_APPS_BOUGH_RUN_H

#include "apps/bough/checkpoint.h"
#include "apps/bough/options.h"
#include "apps/output/recorder.h"
#include "apps/output/statistics.h"
#include "apps/output/vertices.h"
#include "apps/simulation/run.h"
#include "apps/simulation/shape.h"

typedef struct bough_job {
    const bough_options *options;
    bough_arena *arena;
    bough_run run;
    bough_channels recorded; // those of the run's channels that are
    const char *folder;
    bough_recorder *recorder;
    bough_sample_statistics *statistics; // (recorded.count) of the rows
    bough_shape shape;
    bough_frames *frames;     // NULL: none are stored
    bough_vertices *vertices; // NULL: none are stored
    bough_checkpoint checkpoint;
    bough_kept rows, frames_kept; // at the last checkpoint
    double build_s;               // wall time of reading and building [s]
} bough_job;

// Reads and builds the scene of the options, with what the run records and estimates. Errors in the
// scene are told as by bough_open_scene.
bough_status bough_job_build(bough_job *job);

// Writes summary.json into the job's folder.
bough_status bough_run_summarise(const bough_job *job);

// Tells the user how it went: a few lines "key: value".
void bough_run_tell(bough_job *job, FILE *stream);

#endif

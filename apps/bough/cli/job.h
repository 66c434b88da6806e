// One run on the command line: its files and its checkpoints.
#ifndef BOUGH_APPS_BOUGH_JOB_H
#define BOUGH_APPS_BOUGH_JOB_H

#include "apps/bough/cli/options.h"
#include "apps/bough/model/error_shares.h"
#include "apps/bough/model/run.h"
#include "apps/bough/model/shape.h"
#include "apps/bough/results/recorder.h"
#include "apps/bough/results/statistics.h"

#include <stdint.h>

typedef struct bough_checkpoint {
    double interval;         // [s]; 0: none are written
    uint64_t program, input; // fingerprints
    size_t size;             // of a copy [bytes]
    char *copy;              // (size)
} bough_checkpoint;

typedef struct bough_job {
    const bough_options *options;
    bough_arena *arena;
    bough_run run;
    bough_channels recorded; // those of the run's channels that are
    const char *folder;
    bough_recorder *recorder;
    bough_sample_statistics *statistics; // (recorded.count) of the rows
    bough_shape shape;
    bough_frames *frames; // NULL: none are stored
    bough_checkpoint checkpoint;
    bough_kept rows, frames_kept;      // at the last checkpoint
    bough_error_shares shares;         // of mesh, air and time
    char warning[BOUGH_ERROR_WARNING]; // about the error of motion, or ""
    bough_status verdict;              // on the error of a complete run
    bool warned;                       // of the work, while it runs
    double build_s;                    // wall time of reading and building [s]
} bough_job;

#endif

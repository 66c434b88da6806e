// bough run: a run on the command line, with its files, checkpoints and report.
#pragma once

#include "apps/bough/cli/command.h"
#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/run.h"
#include "apps/bough/model/shape.h"
#include "apps/bough/results/recorder.h"

typedef struct bough_checkpoint {
    double interval;         // [s]; 0: none are written
    uint64_t program, input; // fingerprints
    size_t size;             // of a copy [bytes]
    char *copy;              // (size)
} bough_checkpoint;

typedef struct bough_run_options {
    bough_options common;
    double checkpoint; // interval of simulated time between checkpoints [s]; 0: none
    bool resume;       // from the last one
} bough_run_options;

typedef struct bough_run_command {
    const bough_run_options *options;
    bough_arena *arena;
    bough_run run;
    bough_channels recorded; // channels of the run that are recorded
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
    bool warned;                       // about the work, during the run
    double build_s;                    // wall time of reading and building [s]
} bough_run_command;

// Reads and builds the scene of the options, its records and its companion. Errors in the scene are reported
// by bough_open_scene.
bough_status bough_run_command_build(bough_run_command *command);

// Writes summary.json into the command's folder.
bough_status bough_run_summarise(const bough_run_command *command);

// Prints the report for the user: run, speed, results with their errors, warnings, next command.
void bough_run_report(bough_run_command *command);

// -- checkpoints (checkpoint.c) -------------------------------------------------------------------

// Reads the options and, to resume, the checkpoint in the run's folder, which sets the simulation to its
// time. BOUGH_INVALID if the interval does not suit the scene, or if the checkpoint is missing, damaged or of
// another program, scene or setting.
bough_status bough_checkpoint_open(bough_run_command *command);

// After a step of a bough_run_command: writes a checkpoint if one is due.
bough_status bough_checkpoint_update(void *command);

// Removes the checkpoint of an earlier or a complete run.
bough_status bough_checkpoint_remove(const char *folder);

// -- size of results and time of a step, before a run starts (run.c) ------------------------------

// The size of the results of a run.
typedef struct bough_forecast {
    double rows;  // of channels.out
    double bytes; // of all files
} bough_forecast;

// For the recorded channels and the stored shape.
bough_forecast bough_run_results(const bough_simulation *simulation, const bough_channels *channels,
                                 const bough_shape *shape);

// Wall time of one evaluation of a member's derivative, the shortest of `tries` [s]; rate (n_state): scratch.
double bough_forecast_derivative(const bough_coupling *c, int member, int tries, double *rate);

// Writes "results: 101 rows of 6 columns, 0.012 MB".
void bough_forecast_print(bough_forecast forecast, const bough_channels *channels);

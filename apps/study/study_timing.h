// Studies of kind timing: the cells of a grid are run in turns many times, so that other load of the
// machine affects all cells alike. Ratios of times are computed within a turn.
#ifndef BOUGH_APPS_STUDY_STUDY_TIMING_H
#define BOUGH_APPS_STUDY_STUDY_TIMING_H

#include "apps/study/study_options.h"

// One run of a cell with all channels written.
typedef struct bough_timing_run {
    double wall, cpu; // of the stepping and recording [s]
    double build;     // reading and building [s]
} bough_timing_run;

// Runs a cell, the channels going to the folder.
bough_status bough_timing_run_cell(const bough_study *study, const bough_study_cell *cell,
                                   const bough_study_options *options, bough_timing_run *run);

// Runs all, prints the table and writes timing.csv into the folder.
bough_status bough_timing_perform(bough_arena *arena, const bough_study *study,
                                  const bough_study_options *options);

#endif

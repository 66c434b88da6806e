// Studies of kind timing: the cells of a grid are run in turns many times, so that other load of the
// machine affects all cells alike. Ratios of times are computed within a turn.
#ifndef BOUGH_APPS_STUDY_STUDY_TIMING_H
#define BOUGH_APPS_STUDY_STUDY_TIMING_H

#include "apps/bough/cases/study_options.h"

// Runs all, prints the table and writes timing.csv into the folder.
bough_status bough_timing_perform(bough_arena *arena, const bough_study *study,
                                  const bough_study_options *options);

#endif

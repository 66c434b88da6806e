// Performs a study of any kind.
#ifndef BOUGH_APPS_STUDY_STUDY_PERFORM_H
#define BOUGH_APPS_STUDY_STUDY_PERFORM_H

#include "apps/study/study.h"

#include <stdio.h>

typedef struct bough_study_options {
    const char *folder; // for the results; made if missing
    int part, parts;    // which of how many shares of the cells, from 1; parts 0: all
    const char *only;   // load case; NULL: all
    bool quiet;         // no progress line
    bool (*stop)(void); // asked before each step; NULL: never stops
    FILE *stream;       // receives the table
} bough_study_options;

// Runs what the folder does not hold yet and writes the results there. Runs that fail are results.
// BOUGH_FAILED when the reference fails, BOUGH_INTERRUPTED when stopped: then a repetition goes on.
bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options);

#endif

// How a study is performed.
#ifndef BOUGH_APPS_STUDY_STUDY_OPTIONS_H
#define BOUGH_APPS_STUDY_STUDY_OPTIONS_H

#include "apps/bough/cases/study.h"

#include <stdio.h>

typedef struct bough_study_options {
    const char *folder; // for the results; made if missing
    int part, parts;    // which of how many shares of the cells, from 1; parts 0: all
    const char *only;   // load case; NULL: all
    bool quiet;         // no progress line
    bool (*stop)(void); // asked before each step; NULL: never stops
    FILE *stream;       // receives the table
} bough_study_options;

#endif

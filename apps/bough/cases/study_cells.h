// The runs of a study's cells against their references. Each result is a file of the study's folder, so that
// an interrupted study goes on where it was and a grid may grow.
#ifndef BOUGH_APPS_STUDY_STUDY_CELLS_H
#define BOUGH_APPS_STUDY_STUDY_CELLS_H

#include "apps/bough/cases/case_run.h"
#include "apps/bough/cases/study_options.h"

// What the runs came to; those that are not done show so.
typedef struct bough_study_results {
    const bough_study *study;
    bough_case_result *reference; // (n_reference)
    bough_case_result *result;    // (n_case)
    int ran;                      // cells in this call
} bough_study_results;

// Takes the results that are in the folder and runs what is missing of the options' part. Cells with the same
// reference are run one after the other. Of a study of kind stability these groups are run in parallel, each
// run on one thread, and a reference that fails leaves its cells without errors; else it ends the study.
bough_status bough_study_cells(bough_arena *arena, const bough_study *study,
                               const bough_study_options *options, bough_study_results *results);

// Cells without a result.
int bough_study_missing(const bough_study_results *results);

#endif

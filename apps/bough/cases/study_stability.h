// A study of kind stability: a table over the macro step and parameters of the model. A cell is a run that
// either held, with an error against the monolithic solution of the same model, or was stopped with a
// diagnosis. Cells with the same reference are run one after the other; such groups are run in parallel.
#ifndef BOUGH_APPS_STUDY_STUDY_STABILITY_H
#define BOUGH_APPS_STUDY_STUDY_STABILITY_H

#include "apps/bough/cases/study_options.h"

// Runs the cells that have no result in the folder yet, or a part of them. When all results are there,
// prints a table and writes table.csv. BOUGH_FAILED when a cell is silent: it held with a large
// error, without a warning before the run, and its own estimate is far below the error.
bough_status bough_stability_perform(bough_arena *arena, const bough_study *study,
                                     const bough_study_options *options);

#endif

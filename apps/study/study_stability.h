// A study of kind stability: a map over macro step and parameters of the model. Every cell is a run: it
// held, with an error against the monolithic solution of the same model, or was stopped with a
// diagnosis. Cells with one reference are run one after the other, several such groups side by side.
#ifndef BOUGH_APPS_STUDY_STUDY_STABILITY_H
#define BOUGH_APPS_STUDY_STUDY_STABILITY_H

#include "apps/study/study_options.h"

// Runs what the folder does not hold yet, or a part of it. When all is there prints a table and writes
// table.csv and plot.svg. BOUGH_FAILED when a cell is silent: held, far off, and neither warned of nor
// told by its own estimate.
bough_status bough_stability_perform(bough_arena *arena, const bough_study *study,
                                     const bough_study_options *options);

#endif

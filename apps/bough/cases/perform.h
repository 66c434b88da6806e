// Performs a study of any kind.
#ifndef BOUGH_APPS_CASES_PERFORM_H
#define BOUGH_APPS_CASES_PERFORM_H

#include "apps/bough/cases/tables.h"

// Runs the cases that have no result in the folder and that no other process runs, and writes the results
// there. A run that fails is a result too. BOUGH_FAILED when the reference fails, when cases with statistics
// have failed, or when a cell of kind stability is silent; BOUGH_INTERRUPTED when the study is stopped: the
// next call continues it.
bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options);

#endif

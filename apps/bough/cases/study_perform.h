// Performs a study of any kind.
#ifndef BOUGH_APPS_STUDY_STUDY_PERFORM_H
#define BOUGH_APPS_STUDY_STUDY_PERFORM_H

#include "apps/bough/cases/study_options.h"

// Runs the cells that have no result in the folder yet, and writes the results there. A run that fails is
// a result too. BOUGH_FAILED when the reference fails; BOUGH_INTERRUPTED when the study is stopped: the next
// call continues it.
bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options);

#endif

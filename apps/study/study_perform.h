// Performs a study of any kind.
#ifndef BOUGH_APPS_STUDY_STUDY_PERFORM_H
#define BOUGH_APPS_STUDY_STUDY_PERFORM_H

#include "apps/study/study_options.h"

// Runs what the folder does not hold yet and writes the results there. Runs that fail are results.
// BOUGH_FAILED when the reference fails, BOUGH_INTERRUPTED when stopped: then a repetition goes on.
bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options);

#endif

// Performs a sweep or a load set.
#ifndef BOUGH_APPS_STUDY_LOAD_SET_PERFORM_H
#define BOUGH_APPS_STUDY_LOAD_SET_PERFORM_H

#include "apps/bough/cases/study_options.h"

// Runs the cases that have no result in the folder and that no other process runs, each on one thread.
// Writes the tables when all results are there. BOUGH_FAILED when cases have failed; the others are run.
bough_status bough_load_set_perform(bough_arena *arena, const bough_study *study,
                                    const bough_study_options *options);

#endif

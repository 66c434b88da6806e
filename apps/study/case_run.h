// One case of a load set: its run, and what its channels come to.
#ifndef BOUGH_APPS_STUDY_CASE_RUN_H
#define BOUGH_APPS_STUDY_CASE_RUN_H

#include "apps/study/load_set.h"

typedef struct bough_case_result {
    bough_status outcome; // BOUGH_FAILED with a diagnosis: the run ended there
    double time;          // reached [s]
    double counted;       // of it after the load set's `from` [s]
    double cpu, wall;     // of building and stepping [s]
    bough_counts counts;
    bool done;
} bough_case_result;

// An empty result whose memory is the arena's.
bough_case_result bough_case_take(bough_arena *arena, const bough_load_set *set);

// Runs the case on one thread. What the run itself comes to is in the result; the status tells what
// ends the study: BOUGH_INTERRUPTED, no memory, a file. `folder` receives its series where asked for.
bough_status bough_case_run(const bough_load_set *set, const bough_load_case *c, const char *folder,
                            bool (*stop)(void), bough_case_result *result);

#endif

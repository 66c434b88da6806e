// One case of a load set: its run and the counts of its channels.
#ifndef BOUGH_APPS_STUDY_CASE_RUN_H
#define BOUGH_APPS_STUDY_CASE_RUN_H

#include "apps/bough/cases/load_set.h"

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

// Runs the case on one thread. The outcome of the run is in the result; the status is not BOUGH_OK when
// the whole study must end: BOUGH_INTERRUPTED, BOUGH_OUT_OF_MEMORY, BOUGH_IO. The series, if the set asks for
// them, are written to `folder`.
bough_status bough_case_run(const bough_load_set *set, const bough_load_case *c, const char *folder,
                            bool (*stop)(void), bough_case_result *result);

#endif

// Pieces of a study on several threads, until all are done or one of them ends the study.
#ifndef BOUGH_APPS_STUDY_STUDY_BATCH_H
#define BOUGH_APPS_STUDY_STUDY_BATCH_H

#include "apps/bough/cases/study_options.h"
#include "core/base/pool.h"

#include <pthread.h>

typedef struct bough_batch {
    const bough_study_options *options;
    const char *what; // the runs' name, "cases"
    int n, to_do;     // pieces, runs in them
    bool counts;      // shows on the terminal how many runs are done
    bough_status (*perform)(bough_arena *arena, void *self, int piece); // in memory of its own
    void *self;

    // by bough_batch_run
    int done; // runs
    bough_status worst;
    bough_pool *pool;
    pthread_mutex_t mutex; // of done, worst and what the pieces have in common
} bough_batch;

// Performs all pieces; threads 0: as many as processors. BOUGH_INTERRUPTED says how far it came.
bough_status bough_batch_run(bough_arena *arena, bough_batch *batch, int threads);

// For `perform`: between these two calls no other piece is there. The second one counts a run as done.
void bough_batch_enter(bough_batch *batch);
void bough_batch_leave(bough_batch *batch);

#endif

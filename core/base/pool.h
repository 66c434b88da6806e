// Lists of short tasks, a few microseconds each and many lists per step, distributed over the threads
// of one parallel region of OpenMP. Only core/base/pool.c uses OpenMP.
//
// One region contains all steps, because opening and closing a region takes longer than a list. Without a
// region the caller does all tasks itself. OMP_PLACES, OMP_PROC_BIND and OMP_THREAD_LIMIT act as on every
// parallel region.
//
// Each task belongs to one thread, in all lists of the same length to the same thread, so that its data
// stay in the cache of one processor: of three tasks the caller has the first and one thread the others.
// A thread does its own tasks in order and then takes tasks of threads that are late; so no thread waits
// for a thread that does not run, and after a list in which nobody has helped the caller does not wait at
// all. Results do not depend on the threads if no sum crosses tasks.
//
// A waiting thread polls for about 0.5 ms, yielding its processor, and then sleeps; at once where another
// program takes the processor, or if there are more threads than processors.
#pragma once

#include "core/base/arena.h"

typedef struct bough_pool bough_pool;

typedef void (*bough_task)(void *data, int task);

// The default number of threads: OMP_NUM_THREADS, or `otherwise` if that is not set; 0: the number of
// processors.
int bough_pool_default(int otherwise);

// A pool for regions of so many threads. For one thread it is NULL, which all functions below accept: the
// tasks of a list are then done one after the other, without memory or cost.
bough_pool *bough_pool_create(bough_arena *arena, int threads);

// The caller included: as many as requested, and after a region as many as OpenMP has given it, for instance
// one inside a parallel region of the application.
int bough_pool_threads(const bough_pool *pool);

// work(data) on the caller, whose lists are done by the threads of a parallel region until it returns. Inside
// a region of the same pool it is a plain call.
void bough_pool_region(bough_pool *pool, void (*work)(void *data), void *data);

// Does task(data, 0 … n − 1) and returns when all are done. One list at a time: no task may call it. The list
// has two tasks for each body: `before` tasks of the caller, the first tasks, the second ones in the same
// order, each of which awaits the first, and again tasks of the caller. Both belong to one thread, but the
// second ones of bodies beyond equally many for each thread belong to whoever comes first: two threads share
// three bodies evenly.
void bough_pool_run_pairs(bough_pool *pool, int before, int bodies, int n, bough_task task, void *data);

// The same of a list of single tasks.
static inline void bough_pool_run(bough_pool *pool, int n, bough_task task, void *data) {
    bough_pool_run_pairs(pool, 0, 0, n, task, data);
}

// Inside a task: returns when the task `earlier` of the list, which comes before it, is done.
void bough_pool_await(bough_pool *pool, int earlier);

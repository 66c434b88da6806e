#include "core/pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// Longer lists are done in portions.
enum { MOST_TASKS = 1024, LINE = 64 };

static const long patience = 50000; // before sleep [ns]

// Where threads sleep: until there is a task to take, or until one is done.
typedef struct bedroom {
    atomic_int sleepers;
    pthread_cond_t door;
} bedroom;

struct bough_pool {
    int n_worker;
    pthread_t *worker; // (n_worker)
    bool impatient;    // more threads than processors
    // the list in progress, written before `list` tells of it
    bough_task task;
    void *data;
    int first; // number of its first task
    // generation << 32 | number of tasks << 16 | next one: one word, so that nobody who comes late
    // takes a task of another list
    _Alignas(LINE) atomic_uint_least64_t list;
    _Alignas(LINE) atomic_int left;            // tasks of the list not done yet
    atomic_uint_least32_t done[MOST_TASKS];    // the generation in which each was done
    _Alignas(LINE) atomic_bool ended;
    bedroom idle, waiting;
    pthread_mutex_t mutex; // of both
};

static uint32_t generation_of(uint64_t list) { return (uint32_t)(list >> 32); }
static int count_of(uint64_t list) { return (int)(list >> 16 & 0xffff); }
static int next_of(uint64_t list) { return (int)(list & 0xffff); }

// -- waiting --------------------------------------------------------------------------------------

typedef bool (*condition)(bough_pool *p, int argument);

static bool has_work(bough_pool *p, int unused) {
    (void)unused;
    uint64_t list = atomic_load(&p->list);
    return next_of(list) < count_of(list) || atomic_load(&p->ended);
}

static bool is_complete(bough_pool *p, int unused) {
    (void)unused;
    return atomic_load(&p->left) == 0;
}

static bool is_done(bough_pool *p, int task) {
    return atomic_load(&p->done[task]) == generation_of(atomic_load(&p->list));
}

static void pause_briefly(void) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause(); // leaves the core to its other thread
#endif
}

static long clock_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long)now.tv_sec * 1000000000L + now.tv_nsec;
}

static bool spin(bough_pool *p, condition ready, int argument) {
    enum { LOOKS = 32 }; // between looks at the clock
    if (ready(p, argument)) return true;
    if (p->impatient) return false;
    for (long until = clock_ns() + patience; clock_ns() < until;) {
        for (int k = 0; k < LOOKS; k++) {
            if (ready(p, argument)) return true;
            pause_briefly();
        }
    }
    return false;
}

// A sleeper counts itself before its last look, and who changes something looks for sleepers after:
// one of the two sees the other.
static void wait_until(bough_pool *p, bedroom *room, condition ready, int argument) {
    if (spin(p, ready, argument)) return;
    pthread_mutex_lock(&p->mutex);
    atomic_fetch_add(&room->sleepers, 1);
    while (!ready(p, argument)) pthread_cond_wait(&room->door, &p->mutex);
    atomic_fetch_sub(&room->sleepers, 1);
    pthread_mutex_unlock(&p->mutex);
}

static void wake(bough_pool *p, bedroom *room) {
    if (atomic_load(&room->sleepers) == 0) return;
    pthread_mutex_lock(&p->mutex);
    pthread_cond_broadcast(&room->door);
    pthread_mutex_unlock(&p->mutex);
}

// -- working --------------------------------------------------------------------------------------

// Takes and does tasks while the list has any that nobody has taken.
static void work(bough_pool *p) {
    uint64_t list = atomic_load(&p->list);
    while (next_of(list) < count_of(list)) {
        if (!atomic_compare_exchange_weak(&p->list, &list, list + 1)) continue;
        int k = next_of(list);
        p->task(p->data, p->first + k);
        atomic_store(&p->done[k], generation_of(list));
        atomic_fetch_sub(&p->left, 1);
        wake(p, &p->waiting);
        list = atomic_load(&p->list);
    }
}

static void *live(void *self) {
    bough_pool *p = self;
    for (;;) {
        wait_until(p, &p->idle, has_work, 0);
        if (atomic_load(&p->ended)) return NULL;
        work(p);
    }
}

static void run_portion(bough_pool *p, int first, int n, bough_task task, void *data) {
    p->task = task;
    p->data = data;
    p->first = first;
    atomic_store(&p->left, n);
    uint64_t generation = generation_of(atomic_load(&p->list)) + UINT64_C(1);
    atomic_store(&p->list, generation << 32 | (uint64_t)n << 16);
    wake(p, &p->idle);
    work(p);
    wait_until(p, &p->waiting, is_complete, 0);
}

void bough_pool_run(bough_pool *pool, int n, bough_task task, void *data) {
    if (!pool || n == 1) {
        for (int k = 0; k < n; k++) task(data, k);
        return;
    }
    for (int first = 0; first < n; first += MOST_TASKS) {
        run_portion(pool, first, n - first < MOST_TASKS ? n - first : MOST_TASKS, task, data);
    }
}

void bough_pool_await(bough_pool *pool, int earlier) {
    if (!pool || earlier < pool->first) return;
    wait_until(pool, &pool->waiting, is_done, earlier - pool->first);
}

int bough_pool_threads(const bough_pool *pool) { return pool ? pool->n_worker + 1 : 1; }

// -- life -----------------------------------------------------------------------------------------

static void end(void *self) {
    bough_pool *p = self;
    atomic_store(&p->ended, true);
    wake(p, &p->idle);
    for (int k = 0; k < p->n_worker; k++) pthread_join(p->worker[k], NULL);
    pthread_cond_destroy(&p->idle.door);
    pthread_cond_destroy(&p->waiting.door);
    pthread_mutex_destroy(&p->mutex);
}

bough_status bough_pool_create(bough_arena *arena, int threads, bough_pool **pool) {
    *pool = NULL;
    if (threads <= 1) return bough_ok();
    bough_pool *p = bough_arena_take(arena, sizeof *p);
    if (p) p->worker = bough_arena_take(arena, (size_t)threads * sizeof *p->worker);
    if (!p || !p->worker) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    p->impatient = threads > sysconf(_SC_NPROCESSORS_ONLN);
    pthread_mutex_init(&p->mutex, NULL);
    pthread_cond_init(&p->idle.door, NULL);
    pthread_cond_init(&p->waiting.door, NULL);
    while (p->n_worker < threads - 1) {
        int error = pthread_create(&p->worker[p->n_worker], NULL, live, p);
        if (error == 0) {
            p->n_worker++;
            continue;
        }
        end(p);
        return bough_fail(BOUGH_IO, "cannot start thread %d of %d: %s", p->n_worker + 2, threads,
                          strerror(error));
    }
    bough_arena_on_destroy(arena, end, p);
    *pool = p;
    return bough_ok();
}

#include "core/pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// Longer lists are done in portions.
enum { MOST_TASKS = 256, LINE = 64 };

static const long patience = 50000; // before sleep [ns]
static const long courtesy = 5000;  // before a thread takes what is another's turn [ns]

// Where threads sleep: until there is a list, or until a task is done.
typedef struct bedroom {
    atomic_int sleepers;
    pthread_cond_t door;
} bedroom;

// A task of the list in progress: the numbers of the last lists in which it was taken and done.
typedef struct slot {
    _Alignas(LINE) atomic_uint_least64_t taken, done;
} slot;

typedef struct worker {
    struct bough_pool *pool;
    int number; // the caller's is 0
    pthread_t thread;
} worker;

struct bough_pool {
    int n_thread;
    worker *worker; // (n_thread), the caller's unused
    bool impatient; // more threads than processors
    // the list in progress, written before `list` tells of it
    bough_task task;
    void *data;
    int first; // number of its first task
    _Alignas(LINE) atomic_uint_least64_t list; // its number << 16 | how many tasks
    atomic_bool ended;
    slot slot[MOST_TASKS];
    bedroom idle, waiting;
    pthread_mutex_t mutex; // of both
};

static uint64_t number_of(uint64_t list) { return list >> 16; }
static int count_of(uint64_t list) { return (int)(list & 0xffff); }

// -- waiting --------------------------------------------------------------------------------------

typedef bool (*condition)(bough_pool *p, uint64_t argument);

static bool has_news(bough_pool *p, uint64_t known_list) {
    return atomic_load(&p->list) != known_list || atomic_load(&p->ended);
}

static bool is_done(bough_pool *p, uint64_t task) {
    return atomic_load(&p->slot[task].done) == number_of(atomic_load(&p->list));
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

// Looks for so long; false when it has not come.
static bool look(bough_pool *p, long duration, condition ready, uint64_t argument) {
    enum { LOOKS = 16 }; // between looks at the clock
    if (ready(p, argument)) return true;
    if (p->impatient) return false;
    for (long until = clock_ns() + duration; clock_ns() < until;) {
        for (int k = 0; k < LOOKS; k++) {
            if (ready(p, argument)) return true;
            pause_briefly();
        }
    }
    return false;
}

// A sleeper counts itself before its last look, and who changes something looks for sleepers after:
// one of the two sees the other.
static void wait_until(bough_pool *p, bedroom *room, condition ready, uint64_t argument) {
    if (look(p, patience, ready, argument)) return;
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

// Does task k of the list unless it is taken. A thread that comes late finds all of them taken; who
// has taken one keeps the list from ending, so that task and data stand.
static void do_task(bough_pool *p, uint64_t list, int k) {
    uint64_t number = number_of(list), taken = atomic_load(&p->slot[k].taken);
    if (taken >= number || !atomic_compare_exchange_strong(&p->slot[k].taken, &taken, number)) {
        return;
    }
    p->task(p->data, p->first + k);
    atomic_store(&p->slot[k].done, number);
    wake(p, &p->waiting);
}

// Whose task k is: 0, 1, …, n − 1, n − 1, …, 1, 0, 0, 1, … for n threads.
static int owner(const bough_pool *p, int k) {
    int place = k % p->n_thread;
    return k / p->n_thread % 2 == 0 ? place : p->n_thread - 1 - place;
}

// A thread's own tasks, then those of threads that do not come.
static void do_list(bough_pool *p, uint64_t list, int self) {
    for (int k = 0; k < count_of(list); k++) {
        if (owner(p, k) == self) do_task(p, list, k);
    }
    if (self > 0 && look(p, courtesy, has_news, list)) return;
    for (int k = 0; k < count_of(list); k++) {
        if (self == 0 && look(p, courtesy, is_done, (uint64_t)k)) continue;
        do_task(p, list, k);
    }
}

static void *live(void *self) {
    const worker *w = self;
    bough_pool *p = w->pool;
    for (uint64_t list = 0;;) {
        wait_until(p, &p->idle, has_news, list);
        if (atomic_load(&p->ended)) return NULL;
        list = atomic_load(&p->list);
        do_list(p, list, w->number);
    }
}

static void run_portion(bough_pool *p, int first, int n, bough_task task, void *data) {
    p->task = task;
    p->data = data;
    p->first = first;
    uint64_t number = number_of(atomic_load(&p->list)) + 1, list = number << 16 | (uint64_t)n;
    atomic_store(&p->list, list);
    wake(p, &p->idle);
    do_list(p, list, 0);
    for (int k = 0; k < n; k++) wait_until(p, &p->waiting, is_done, (uint64_t)k);
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

typedef struct turns {
    bough_pool *pool;
    int n, rest, before; // before: items in the first turn that are done as a whole
    void (*work)(void *data, int item, bough_part part);
    void *data;
} turns;

static void take_turn(void *self, int k) {
    const turns *w = self;
    int split = w->n - w->rest; // the first item that is
    if (k < w->before) {
        w->work(w->data, k, BOUGH_WHOLE);
    } else if (k < w->before + w->rest) {
        w->work(w->data, split + k - w->before, BOUGH_FIRST_HALF);
    } else if (k < w->n) {
        w->work(w->data, k - w->rest, BOUGH_WHOLE);
    } else {
        bough_pool_await(w->pool, w->before + k - w->n);
        w->work(w->data, split + k - w->n, BOUGH_SECOND_HALF);
    }
}

void bough_pool_run_turns(bough_pool *pool, int n,
                          void (*work)(void *data, int item, bough_part part), void *data) {
    int threads = bough_pool_threads(pool);
    turns w = {.pool = pool, .n = n, .work = work, .data = data};
    if (n > threads) w.rest = n % threads;
    if (w.rest > 0) w.before = threads - w.rest;
    bough_pool_run(pool, n + w.rest, take_turn, &w);
}

void bough_pool_await(bough_pool *pool, int earlier) {
    if (!pool || earlier < pool->first) return;
    int k = earlier - pool->first;
    if (!look(pool, courtesy, is_done, (uint64_t)k)) do_task(pool, atomic_load(&pool->list), k);
    wait_until(pool, &pool->waiting, is_done, (uint64_t)k);
}

int bough_pool_threads(const bough_pool *pool) { return pool ? pool->n_thread : 1; }

// -- life -----------------------------------------------------------------------------------------

static void end(void *self) {
    bough_pool *p = self;
    atomic_store(&p->ended, true);
    wake(p, &p->idle);
    for (int k = 1; k < p->n_thread; k++) pthread_join(p->worker[k].thread, NULL);
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
    int error = 0, started = 1;
    p->n_thread = threads; // read by the threads
    for (; started < threads && error == 0; started += error == 0) {
        p->worker[started] = (worker){.pool = p, .number = started};
        error = pthread_create(&p->worker[started].thread, NULL, live, &p->worker[started]);
    }
    if (error != 0) {
        p->n_thread = started;
        end(p);
        return bough_fail(BOUGH_IO, "cannot start thread %d of %d: %s", started + 1, threads,
                          strerror(error));
    }
    bough_arena_on_destroy(arena, end, p);
    *pool = p;
    return bough_ok();
}

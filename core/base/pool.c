#include "core/base/pool.h"

#include <omp.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <time.h>

// Longer lists are done in portions.
enum { MOST_TASKS = 256, LINE = 64 };

static const long spin_time = 500000; // polling before sleep; to wake it costs the other thread 25 µs [ns]
static const long steal_time = 5000;  // before a thread takes what is another's task, or yields [ns]

// Where threads sleep: until there is a list, or until a task is done.
typedef struct wait_queue {
    atomic_int sleepers;
    pthread_cond_t woken;
} wait_queue;

// A task of the list in progress: the numbers of the last lists in which it was taken and done.
typedef struct slot {
    _Alignas(LINE) atomic_uint_least64_t taken, done;
} slot;

struct bough_pool {
    int n_asked;  // threads
    int n_thread; // of the last region; n_asked before the first
    bool open;    // a region is
    bool listing; // a list is in progress; the caller's
    bool crowded; // more threads than processors
    // the list in progress, written before its number in `list`; a thread that comes late reads the integers
    bough_task task;
    void *data;
    atomic_int first;                          // index of its first task
    atomic_int before, bodies;                 // as of bough_pool_run_pairs; 0 of other lists
    _Alignas(LINE) atomic_uint_least64_t list; // its number << 16 | how many tasks
    uint64_t list_before;                      // `list` when the region began
    atomic_bool ended;                         // the work of the region has returned
    slot slot[MOST_TASKS];
    wait_queue idle, waiting;
    pthread_mutex_t mutex; // of both
    _Alignas(
        LINE) int n_alone; // tasks of the list in progress that the caller has done, in a line of its own
    atomic_bool alone;     // the caller did all tasks of the last list
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

// Polls for the condition; false when it does not hold after the duration [ns], or when another program wants
// the processor and has had it.
static bool look(bough_pool *p, long duration, condition ready, uint64_t argument) {
    enum { LOOKS = 16 }; // between looks at the clock
    if (ready(p, argument)) return true;
    if (p->crowded || duration == 0) return false;
    long start = clock_ns();
    for (long now = start, before = start; now < start + duration; now = clock_ns()) {
        if (now > before + 2 * steal_time) return ready(p, argument);
        for (int k = 0; k < LOOKS; k++) {
            if (ready(p, argument)) return true;
            pause_briefly();
        }
        before = now;
        if (now > start + steal_time) sched_yield();
    }
    return false;
}

// A sleeper counts itself before its last look, and who changes something looks for sleepers after:
// one of the two sees the other.
static void wait_until(bough_pool *p, wait_queue *queue, condition ready, uint64_t argument) {
    if (look(p, spin_time, ready, argument)) return;
    pthread_mutex_lock(&p->mutex);
    atomic_fetch_add(&queue->sleepers, 1);
    while (!ready(p, argument)) pthread_cond_wait(&queue->woken, &p->mutex);
    atomic_fetch_sub(&queue->sleepers, 1);
    pthread_mutex_unlock(&p->mutex);
}

static void wake(bough_pool *p, wait_queue *queue) {
    if (atomic_load(&queue->sleepers) == 0) return;
    pthread_mutex_lock(&p->mutex);
    pthread_cond_broadcast(&queue->woken);
    pthread_mutex_unlock(&p->mutex);
}

// -- working --------------------------------------------------------------------------------------

// Does task k of the list unless it is taken. A thread that comes late finds all of them taken; who
// has taken one keeps the list from ending, so that task and data stand.
static void do_task(bough_pool *p, uint64_t list, int k, int self) {
    uint64_t number = number_of(list), taken = atomic_load(&p->slot[k].taken);
    if (taken >= number || !atomic_compare_exchange_strong(&p->slot[k].taken, &taken, number)) {
        return;
    }
    if (self == 0) p->n_alone++;
    p->task(p->data, p->first + k);
    atomic_store(&p->slot[k].done, number);
    wake(p, &p->waiting);
}

// The thread of a place in the list, of n threads: 0, 1, …, n − 1, n − 1, …, 1, 0, 0, …
static int thread_of(int n, int place) { return place / n % 2 == 0 ? place % n : n - 1 - place % n; }

// The thread whose task k is; −1: anyone's. Both tasks of a body belong to one, the last body's to thread 0.
static int owner(const bough_pool *p, int k) {
    int n = p->n_thread, bodies = p->bodies, place = p->first + k - p->before;
    if (bodies == 0) return thread_of(n, place);
    if (place < 0 || place >= 2 * bodies) return 0;
    // one of the bodies beyond an equal number for each thread
    bool left_over = bodies > n && place - bodies < bodies % n;
    if (place >= bodies && left_over) return -1;
    return thread_of(n, bodies - 1 - place % bodies);
}

// The caller's time to wait for a task's owner [ns]: none where no other thread has come, so that lists cost
// no more than on one thread.
static long time_to_wait(const bough_pool *p) { return atomic_load(&p->alone) ? 0 : steal_time; }

// A thread's own tasks and anyone's, then those of threads that are late.
static void do_list(bough_pool *p, uint64_t list, int self) {
    for (int k = 0; k < count_of(list); k++) {
        int whose = owner(p, k);
        if (whose == self || whose < 0) do_task(p, list, k, self);
    }
    if (self > 0 && look(p, steal_time, has_news, list)) return;
    for (int k = 0; k < count_of(list); k++) {
        if (self == 0 && look(p, time_to_wait(p), is_done, (uint64_t)k)) continue;
        do_task(p, list, k, self);
    }
}

static void do_lists(bough_pool *p, int self) {
    for (uint64_t list = p->list_before;;) {
        wait_until(p, &p->idle, has_news, list);
        if (atomic_load(&p->ended)) return;
        list = atomic_load(&p->list);
        do_list(p, list, self);
    }
}

static void run_portion(bough_pool *p, int first, int n, bough_task task, void *data) {
    p->task = task;
    p->data = data;
    atomic_store_explicit(&p->first, first, memory_order_relaxed);
    p->n_alone = 0;
    // publish the list: its number last
    uint64_t number = number_of(atomic_load(&p->list)) + 1, list = number << 16 | (uint64_t)n;
    atomic_store(&p->list, list);
    wake(p, &p->idle);
    do_list(p, list, 0);
    // the caller works, then waits for the tasks that others have taken
    for (int k = 0; k < n; k++) wait_until(p, &p->waiting, is_done, (uint64_t)k);
    atomic_store(&p->alone, p->n_alone == n);
}

void bough_pool_run_pairs(bough_pool *pool, int before, int bodies, int n, bough_task task, void *data) {
    if (!pool || !pool->open || pool->n_thread == 1 || n == 1) {
        for (int k = 0; k < n; k++) task(data, k);
        return;
    }
    assert(omp_get_thread_num() == 0 && !pool->listing); // no task may
    pool->listing = true;
    atomic_store_explicit(&pool->before, before, memory_order_relaxed);
    atomic_store_explicit(&pool->bodies, bodies, memory_order_relaxed);
    for (int first = 0; first < n; first += MOST_TASKS) {
        run_portion(pool, first, n - first < MOST_TASKS ? n - first : MOST_TASKS, task, data);
    }
    pool->listing = false;
}

void bough_pool_await(bough_pool *pool, int earlier) {
    if (!pool || !pool->open || pool->n_thread == 1 || earlier < pool->first) return;
    int k = earlier - pool->first;
    // the caller of await does the task itself where nobody has begun it
    if (!look(pool, time_to_wait(pool), is_done, (uint64_t)k)) {
        do_task(pool, atomic_load(&pool->list), k, omp_get_thread_num());
    }
    wait_until(pool, &pool->waiting, is_done, (uint64_t)k);
}

int bough_pool_threads(const bough_pool *pool) { return pool ? pool->n_thread : 1; }

// -- regions --------------------------------------------------------------------------------------

void bough_pool_region(bough_pool *pool, void (*work)(void *data), void *data) {
    if (!pool || pool->open) {
        work(data);
        return;
    }
    pool->list_before = atomic_load(&pool->list);
    atomic_store(&pool->ended, false);
    pool->open = true;
#pragma omp parallel num_threads(pool->n_asked)
    {
        int self = omp_get_thread_num();
        if (self > 0) {
            do_lists(pool, self);
        } else {
            pool->n_thread = omp_get_num_threads(); // others read it after the first list
            work(data);
            atomic_store(&pool->ended, true);
            wake(pool, &pool->idle);
        }
    }
    pool->open = false;
}

// -- life -----------------------------------------------------------------------------------------

int bough_pool_default(int otherwise) {
    if (getenv("OMP_NUM_THREADS")) return omp_get_max_threads();
    return otherwise > 0 ? otherwise : omp_get_num_procs();
}

static void destroy(void *self) {
    bough_pool *p = self;
    pthread_cond_destroy(&p->idle.woken);
    pthread_cond_destroy(&p->waiting.woken);
    pthread_mutex_destroy(&p->mutex);
}

bough_pool *bough_pool_create(bough_arena *arena, int threads) {
    if (threads <= 1) return NULL;
    bough_pool *p = bough_arena_take(arena, sizeof *p);
    p->n_asked = p->n_thread = threads;
    p->crowded = threads > omp_get_num_procs();
    pthread_mutex_init(&p->mutex, NULL);
    pthread_cond_init(&p->idle.woken, NULL);
    pthread_cond_init(&p->waiting.woken, NULL);
    bough_arena_on_destroy(arena, destroy, p);
    return p;
}

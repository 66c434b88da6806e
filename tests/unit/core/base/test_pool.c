// Lists of tasks on threads: each task once, in order where it is asked for, however late a thread
// comes and however often it sleeps.
#include "core/base/pool.h"
#include "tests/unit/check.h"

#include <stdatomic.h>
#include <time.h>

enum { MOST = 3000 };

typedef struct list {
    bough_pool *pool;
    atomic_int count[MOST];
    int sum[MOST]; // of the tasks up to each, where they wait for the one before
} list;

static bough_arena *make(int threads, list *l) {
    bough_arena *arena = bough_arena_create();
    l->pool = bough_pool_create(arena, threads);
    assert_int_equal(bough_pool_threads(l->pool), threads);
    return arena;
}

static void reset(list *l) {
    for (int k = 0; k < MOST; k++) atomic_store(&l->count[k], 0);
}

static void count(void *data, int k) {
    list *l = data;
    atomic_fetch_add(&l->count[k], 1);
}

static void each_size(void *data) {
    static const int sizes[] = {0, 1, 2, 3, 57, MOST};
    list *l = data;
    for (int repeat = 0; repeat < 60; repeat++) {
        int n = sizes[repeat % 6];
        reset(l);
        bough_pool_run(l->pool, n, count, l);
        for (int k = 0; k < MOST; k++) assert_int_equal(atomic_load(&l->count[k]), k < n);
    }
}

TEST(each_task_is_done_once) {
    list l;
    for (int threads = 1; threads <= 8; threads *= 2) {
        bough_arena *arena = make(threads, &l);
        each_size(&l); // without a region, on the caller
        bough_pool_region(l.pool, each_size, &l);
        assert_int_equal(bough_pool_threads(l.pool), threads);
        bough_arena_destroy(arena);
    }
}

static void add_to_the_one_before(void *data, int k) {
    list *l = data;
    if (k > 0) bough_pool_await(l->pool, k - 1);
    l->sum[k] = k == 0 ? 0 : l->sum[k - 1] + k; // plain numbers: waiting makes them visible
}

static void add_up(void *data) {
    list *l = data;
    for (int repeat = 0; repeat < 3; repeat++) {
        bough_pool_run_pairs(l->pool, repeat, repeat * 7, MOST, add_to_the_one_before, l);
        for (int k = 0; k < MOST; k++) assert_int_equal(l->sum[k], k * (k + 1) / 2);
    }
}

TEST(tasks_wait_for_earlier_ones) {
    list l;
    for (int threads = 1; threads <= 8; threads *= 2) {
        bough_arena *arena = make(threads, &l);
        add_up(&l);
        bough_pool_region(l.pool, add_up, &l);
        bough_arena_destroy(arena);
    }
}

static void nap(long ns) { nanosleep(&(struct timespec){.tv_nsec = ns}, NULL); }

// The first task is slow, so that its waiters and the caller sleep.
static void wait_for_the_first(void *data, int k) {
    list *l = data;
    if (k == 0) nap(2000000);
    if (k > 0) bough_pool_await(l->pool, 0);
    l->sum[k] = k == 0 ? 7 : l->sum[0];
}

static void sleep_and_wake(void *data) {
    list *l = data;
    for (int repeat = 0; repeat < 10; repeat++) {
        nap(1000000); // longer than the threads look for work
        l->sum[0] = 0;
        bough_pool_run(l->pool, 9, wait_for_the_first, l);
        for (int k = 0; k < 9; k++) assert_int_equal(l->sum[k], 7);
    }
}

TEST(sleepers_wake) {
    list l;
    for (int threads = 2; threads <= 8; threads *= 2) {
        bough_arena *arena = make(threads, &l);
        bough_pool_region(l.pool, sleep_and_wake, &l);
        bough_arena_destroy(arena);
    }
}

// Lists that follow at once: a thread that comes late finds another list.
static void follow_at_once(void *data) {
    list *l = data;
    for (int repeat = 0; repeat < 5000; repeat++) bough_pool_run(l->pool, 3, count, l);
}

TEST(lists_follow_at_once) {
    list l;
    bough_arena *arena = make(4, &l);
    reset(&l);
    bough_pool_region(l.pool, follow_at_once, &l);
    for (int k = 0; k < MOST; k++) assert_int_equal(atomic_load(&l.count[k]), k < 3 ? 5000 : 0);
    bough_arena_destroy(arena);
}

static void one_list(void *data) {
    list *l = data;
    bough_pool_run(l->pool, 3, count, l);
}

TEST(regions_follow_at_once) {
    list l;
    bough_arena *arena = make(3, &l);
    reset(&l);
    for (int repeat = 0; repeat < 200; repeat++) bough_pool_region(l.pool, one_list, &l);
    for (int k = 0; k < MOST; k++) assert_int_equal(atomic_load(&l.count[k]), k < 3 ? 200 : 0);
    bough_arena_destroy(arena);
}

// Tasks that open regions of their own pools; a region within one of the same pool is that one.
enum { INNER = 5 };
typedef struct nest {
    list outer, inner[INNER];
} nest;

static void open_inner(void *data, int k) {
    nest *n = data;
    bough_pool_region(n->inner[k].pool, add_up, &n->inner[k]);
}

static void open_all(void *data) {
    nest *n = data;
    bough_pool_run(n->outer.pool, INNER, open_inner, n);
    bough_pool_region(n->outer.pool, one_list, &n->outer);
}

TEST(regions_nest) {
    static nest n;
    bough_arena *arena[INNER + 1] = {make(2, &n.outer)};
    for (int k = 0; k < INNER; k++) arena[k + 1] = make(3, &n.inner[k]);
    reset(&n.outer);
    bough_pool_region(n.outer.pool, open_all, &n);
    for (int k = 0; k < 3; k++) assert_int_equal(atomic_load(&n.outer.count[k]), 1);
    for (int k = 0; k <= INNER; k++) bough_arena_destroy(arena[k]);
}

TEST(one_thread_takes_no_memory) {
    list l;
    bough_arena *arena = make(1, &l);
    assert_null(l.pool);
    assert_int_equal(bough_arena_bytes(arena), 0);
    bough_arena_destroy(arena);
}

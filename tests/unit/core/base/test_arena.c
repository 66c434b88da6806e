// The arena: alignment, zeroing, work that is left where memory ends, release in reverse order.
#define _DEFAULT_SOURCE // mincore
#include "tests/unit/check.h"

#include <sys/mman.h>

TEST(blocks_are_aligned_zeroed_and_apart) {
    check_arena(arena);
    assert_non_null(arena);
    unsigned char *blocks[50];
    for (int i = 0; i < 50; i++) {
        size_t size = (size_t)(1 + 37 * i);
        blocks[i] = bough_arena_take(arena, size);
        assert_int_equal((uintptr_t)blocks[i] % 64, 0);
        for (size_t k = 0; k < size; k++) assert_int_equal(blocks[i][k], 0);
        memset(blocks[i], i + 1, size);
    }
    for (int i = 0; i < 50; i++) {
        assert_int_equal(blocks[i][0], i + 1);
        assert_int_equal(blocks[i][37 * i], i + 1);
    }
    assert_true(bough_arena_bytes(arena) >= 50 * (1 + 37 * 49) / 2);
}

TEST(large_blocks_are_aligned_and_zeroed_also_where_memory_is_used_again) {
    enum { SIZE = (5 << 20) + 8, STRIDE = 4096 };
    check_arena(arena);
    for (int k = 0; k < 3; k++) {
        bough_arena *child = bough_arena_child(arena);
        unsigned char *both[2] = {bough_arena_take(child, SIZE), bough_arena_take(child, SIZE)};
        for (int i = 0; i < 2; i++) {
            assert_int_equal((uintptr_t)both[i] % 64, 0);
            for (size_t at = 0; at < SIZE; at += STRIDE) assert_int_equal(both[i][at], 0);
            assert_int_equal(both[i][SIZE - 1], 0);
            memset(both[i], i + 1, SIZE);
        }
        assert_int_equal(both[0][SIZE - 1], 1);
#ifndef __SANITIZE_ADDRESS__ // in the same pages, unless malloc is watched
        assert_true(both[1] > both[0] && both[1] - both[0] < SIZE + STRIDE);
#endif
        bough_arena_destroy(child);
    }
}

TEST(of_a_large_page_only_the_small_ones_of_a_block_are_taken) {
    check_arena(arena);
    char *block = bough_arena_take(arena, 5 << 19); // in pages of 2 MB and 4 kB
    memset(block, 1, 5 << 19);
#ifndef __SANITIZE_ADDRESS__ // which watches malloc
    unsigned char present, *behind = (unsigned char *)block + (3 << 20);
    assert_true(mincore(behind - (uintptr_t)behind % 4096, 1, &present) != 0 || (present & 1) == 0);
#endif
}

TEST(strings_are_copied) {
    check_arena(arena);
    char text[] = "hub";
    char *copy = bough_arena_string(arena, text);
    text[0] = 'x';
    assert_string_equal(copy, "hub");
    assert_null(bough_arena_string(arena, NULL));
}

static bool reached;

static bough_status take_too_much(bough_arena *arena, void *self) {
    bough_arena *child = bough_arena_child(bough_arena_child(arena));
    bough_arena_take(child, 8);
    if (*(bool *)self)
        bough_arena_doubles(child, (size_t)-1 / 4); // its bytes overflow
    else
        bough_arena_take(arena, (size_t)-1 - 1024); // its pages overflow
    reached = true;
    return bough_ok();
}

static bough_status take_little(bough_arena *arena, void *self) {
    bough_arena_take(arena, 8);
    reached = true;
    return *(bool *)self ? bough_fail(BOUGH_FAILED, "its own") : bough_ok();
}

// The guards outside stay as they are.
static bough_status guard_both(bough_arena *arena, void *self) {
    assert_int_equal(bough_arena_guard(arena, take_too_much, self).code, BOUGH_OUT_OF_MEMORY);
    return take_too_much(arena, self);
}

TEST(work_is_left_where_memory_ends) {
    bool of_child = false, fails = true;
    reached = false;
    assert_int_equal(bough_arena_use(take_too_much, &of_child).code, BOUGH_OUT_OF_MEMORY);
    of_child = true;
    check_fails(bough_arena_use(guard_both, &of_child), BOUGH_OUT_OF_MEMORY, "memory");
    assert_false(reached);
    assert_int_equal(bough_arena_use(take_little, &fails).code, BOUGH_FAILED);
    fails = false;
    assert_int_equal(bough_arena_use(take_little, &fails).code, BOUGH_OK);
    assert_true(reached);
}

typedef struct record {
    int order[3], count, id[3];
} record;

typedef struct handle {
    record *into;
    int id;
} handle;

static void note(void *object) {
    handle *h = object;
    h->into->order[h->into->count++] = h->id;
}

TEST(objects_are_released_newest_first) {
    record r = {0};
    bough_arena *arena = bough_arena_create();
    for (int i = 0; i < 3; i++) {
        // the handle lives in the arena: it must outlast its own release
        handle *h = bough_arena_take(arena, sizeof *h);
        *h = (handle){&r, i};
        bough_arena_on_destroy(arena, note, h);
    }
    assert_int_equal(r.count, 0);
    bough_arena_destroy(arena);
    assert_int_equal(r.count, 3);
    for (int i = 0; i < 3; i++) assert_int_equal(r.order[i], 2 - i);
    bough_arena_destroy(NULL);
}

// The arena: alignment, zeroing, remembered exhaustion, release in reverse order.
#include "tests/check.h"

#include "core/arena.h"

#include <string.h>

static void blocks_are_aligned_zeroed_and_apart(void **state) {
    (void)state;
    bough_arena *arena = bough_arena_create();
    assert_non_null(arena);
    unsigned char *blocks[50];
    for (int i = 0; i < 50; i++) {
        size_t size = (size_t)(1 + 37 * i);
        blocks[i] = bough_arena_take(arena, size);
        assert_int_equal((uintptr_t)blocks[i] % 64, 0);
        for (size_t k = 0; k < size; k++)
            assert_int_equal(blocks[i][k], 0);
        memset(blocks[i], i + 1, size);
    }
    for (int i = 0; i < 50; i++) {
        assert_int_equal(blocks[i][0], i + 1);
        assert_int_equal(blocks[i][37 * i], i + 1);
    }
    assert_true(bough_arena_bytes(arena) >= 50 * (1 + 37 * 49) / 2);
    assert_false(bough_arena_exhausted(arena));
    bough_arena_destroy(arena);
}

static void strings_are_copied(void **state) {
    (void)state;
    bough_arena *arena = bough_arena_create();
    char text[] = "hub";
    char *copy = bough_arena_string(arena, text);
    text[0] = 'x';
    assert_string_equal(copy, "hub");
    assert_null(bough_arena_string(arena, NULL));
    bough_arena_destroy(arena);
}

static void exhaustion_is_remembered(void **state) {
    (void)state;
    bough_arena *arena = bough_arena_create();
    assert_null(bough_arena_take(arena, (size_t)-1));
    assert_true(bough_arena_exhausted(arena));
    assert_non_null(bough_arena_take(arena, 8));
    assert_true(bough_arena_exhausted(arena));
    bough_arena_destroy(arena);
    arena = bough_arena_create();
    assert_null(bough_arena_doubles(arena, (size_t)-1 / 4)); // its bytes overflow
    assert_true(bough_arena_exhausted(arena));
    bough_arena_destroy(arena);
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

static void objects_are_released_newest_first(void **state) {
    (void)state;
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
    for (int i = 0; i < 3; i++)
        assert_int_equal(r.order[i], 2 - i);
    bough_arena_destroy(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_aligned_zeroed_and_apart),
        cmocka_unit_test(strings_are_copied),
        cmocka_unit_test(exhaustion_is_remembered),
        cmocka_unit_test(objects_are_released_newest_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

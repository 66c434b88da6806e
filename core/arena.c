#include "core/arena.h"

#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64 };

typedef struct block {
    struct block *next;
    void (*release)(void *); // NULL for plain memory
    void *object;
} block;

struct bough_arena {
    block *newest;
    size_t bytes;
    int exhausted;
};

bough_arena *bough_arena_create(void) {
    return calloc(1, sizeof(bough_arena));
}

void bough_arena_destroy(bough_arena *arena) {
    if (arena == NULL) return;
    for (block *b = arena->newest, *next; b != NULL; b = next) {
        next = b->next;
        if (b->release != NULL) b->release(b->object);
        free(b);
    }
    free(arena);
}

// A block of `size` payload bytes behind an aligned header.
static block *push(bough_arena *arena, size_t size) {
    if (size > (size_t)-1 - 3 * ALIGNMENT) {
        arena->exhausted = 1;
        return NULL;
    }
    size_t whole = ALIGNMENT + (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    block *b = aligned_alloc(ALIGNMENT, whole);
    if (b == NULL) {
        arena->exhausted = 1;
        return NULL;
    }
    memset(b, 0, whole);
    b->next = arena->newest;
    arena->newest = b;
    arena->bytes += whole;
    return b;
}

void *bough_arena_take(bough_arena *arena, size_t size) {
    block *b = push(arena, size);
    return b == NULL ? NULL : (char *)b + ALIGNMENT;
}

double *bough_arena_doubles(bough_arena *arena, size_t count) {
    if (count > (size_t)-1 / sizeof(double)) {
        arena->exhausted = 1;
        return NULL;
    }
    return bough_arena_take(arena, count * sizeof(double));
}

char *bough_arena_string(bough_arena *arena, const char *text) {
    if (text == NULL) return NULL;
    size_t size = strlen(text) + 1;
    char *copy = bough_arena_take(arena, size);
    if (copy != NULL) memcpy(copy, text, size);
    return copy;
}

void bough_arena_on_destroy(bough_arena *arena, void (*release)(void *), void *object) {
    block *b = push(arena, 0);
    if (b == NULL) {
        release(object);
        return;
    }
    b->release = release;
    b->object = object;
}

int bough_arena_exhausted(const bough_arena *arena) {
    return arena->exhausted;
}

size_t bough_arena_bytes(const bough_arena *arena) {
    return arena->bytes;
}

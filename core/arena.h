// Memory of a built model: blocks are taken while building, all released at once, and nothing is
// taken while stepping. Every block is zeroed and aligned to 64 bytes.
#ifndef BOUGH_CORE_ARENA_H
#define BOUGH_CORE_ARENA_H

#include <stddef.h>

typedef struct bough_arena bough_arena;

// A new, empty arena; NULL when memory is exhausted.
bough_arena *bough_arena_create(void);

// Releases the arena and every block taken from it; NULL is allowed.
void bough_arena_destroy(bough_arena *arena);

// A zeroed block of `size` bytes. Exhausted memory is remembered (bough_arena_exhausted) and a
// NULL returned, so that a builder may check once at its end.
void *bough_arena_take(bough_arena *arena, size_t size);

// A zeroed array of `count` doubles.
double *bough_arena_doubles(bough_arena *arena, size_t count);

// A copy of the string, NULL for NULL.
char *bough_arena_string(bough_arena *arena, const char *text);

// Calls `release(object)` when the arena is destroyed, newest first: for handles of libraries.
// Exhausted memory releases the object at once.
void bough_arena_on_destroy(bough_arena *arena, void (*release)(void *), void *object);

// Whether any request failed; bytes taken so far.
int bough_arena_exhausted(const bough_arena *arena);
size_t bough_arena_bytes(const bough_arena *arena);

#endif

// Memory of a built model: blocks are taken while building, all released at once, and nothing is
// taken while stepping. Every block is zeroed and aligned to 64 bytes.
//
// When memory is exhausted, the work is abandoned by a jump: bough_arena_guard returns BOUGH_OUT_OF_MEMORY.
// So code that takes memory always gets it, and need not check. Files and objects of libraries that are open
// during the work must belong to the arena (bough_arena_on_destroy).
#pragma once

#include "core/base/status.h"

typedef struct bough_arena bough_arena;

// A new, empty arena; NULL when memory is exhausted.
bough_arena *bough_arena_create(void);

// A new, empty arena for the scratch memory of one task. It is destroyed with its parent at the latest.
// When it exhausts memory, the parent's work is abandoned.
bough_arena *bough_arena_child(bough_arena *parent);

// Releases the arena and every block taken from it; NULL is allowed.
void bough_arena_destroy(bough_arena *arena);

// Returns work(arena, self), or BOUGH_OUT_OF_MEMORY as soon as the arena or a child of it exhausts memory.
// Without a guard the process then ends with exit code 1.
bough_status bough_arena_guard(bough_arena *arena, bough_status (*work)(bough_arena *arena, void *self),
                               void *self);

// The same with a new arena, which is destroyed at the end.
bough_status bough_arena_use(bough_status (*work)(bough_arena *arena, void *self), void *self);

// A zeroed block of `size` bytes; never NULL.
void *bough_arena_take(bough_arena *arena, size_t size);

// A zeroed array of `count` doubles.
double *bough_arena_doubles(bough_arena *arena, size_t count);

// Several such arrays; the addresses of the pointers that receive them follow.
#define bough_arena_each(arena, count, ...)                                                                  \
    bough_arena_arrays(arena, count, (double **const[]){__VA_ARGS__, NULL})
void bough_arena_arrays(bough_arena *arena, size_t count, double **const *array);

// A copy of the string, NULL for NULL.
char *bough_arena_string(bough_arena *arena, const char *text);

// A copy of `size` bytes.
void *bough_arena_copy(bough_arena *arena, const void *from, size_t size);

// A text as printf makes it.
char *bough_arena_print(bough_arena *arena, const char *format, ...) __attribute__((format(printf, 2, 3)));

// The n items with room for one more: the same array, or a copy with twice the room. *room: how many items of
// `size` bytes fit in it. The arena keeps the outgrown arrays: at most as much again.
void *bough_arena_grow(bough_arena *arena, void *items, int n, int *room, size_t size);

// Calls `release(object)` when the arena is destroyed, newest first: for handles of libraries.
// Exhausted memory releases the object at once.
void bough_arena_on_destroy(bough_arena *arena, void (*release)(void *), void *object);

// Abandons the work in the same way: for a library that has exhausted memory.
_Noreturn void bough_arena_leave(bough_arena *arena);

// Bytes taken so far.
size_t bough_arena_bytes(const bough_arena *arena);

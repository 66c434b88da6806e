// Memory that is copied out of where it lives and back. Each module lists once, in order,
// what it keeps; the list serves to measure the copy, to save and to restore.
#pragma once

#include <stddef.h>
#include <string.h>

typedef enum bough_snapshot_move {
    BOUGH_SNAPSHOT_MEASURE, // nothing but `used` changes
    BOUGH_SNAPSHOT_SAVE,
    BOUGH_SNAPSHOT_RESTORE,
} bough_snapshot_move;

typedef struct bough_snapshot {
    bough_snapshot_move move;
    char *copy;  // aligned for doubles; NULL to measure
    size_t used; // so far [bytes]
} bough_snapshot;

// The next `size` bytes of the copy, aligned for doubles; not to be touched when measuring.
static inline void *bough_snapshot_room(bough_snapshot *s, size_t size) {
    char *room = s->copy ? s->copy + s->used : NULL;
    s->used += (size + sizeof(double) - 1) / sizeof(double) * sizeof(double);
    return room;
}

static inline void bough_snapshot_take(bough_snapshot *s, void *memory, size_t size) {
    void *room = bough_snapshot_room(s, size);
    if (size == 0) return;
    if (s->move == BOUGH_SNAPSHOT_SAVE) memcpy(room, memory, size);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) memcpy(memory, room, size);
}

static inline void bough_snapshot_doubles(bough_snapshot *s, double *x, int n) {
    bough_snapshot_take(s, x, (size_t)n * sizeof *x);
}

// Variables of any types, up to six, in their order.
#define BOUGH_SNAPSHOT(s, ...)                                                                               \
    BOUGH_SNAPSHOT_OF(__VA_ARGS__, BOUGH_SNAPSHOT_6, BOUGH_SNAPSHOT_5, BOUGH_SNAPSHOT_4, BOUGH_SNAPSHOT_3,   \
                      BOUGH_SNAPSHOT_2, BOUGH_SNAPSHOT_1, )                                                  \
    (s, __VA_ARGS__)
#define BOUGH_SNAPSHOT_OF(a, b, c, d, e, f, name, ...) name
#define BOUGH_SNAPSHOT_1(s, x) bough_snapshot_take(s, &(x), sizeof(x))
#define BOUGH_SNAPSHOT_2(s, x, ...) BOUGH_SNAPSHOT_1(s, x), BOUGH_SNAPSHOT_1(s, __VA_ARGS__)
#define BOUGH_SNAPSHOT_3(s, x, ...) BOUGH_SNAPSHOT_1(s, x), BOUGH_SNAPSHOT_2(s, __VA_ARGS__)
#define BOUGH_SNAPSHOT_4(s, x, ...) BOUGH_SNAPSHOT_1(s, x), BOUGH_SNAPSHOT_3(s, __VA_ARGS__)
#define BOUGH_SNAPSHOT_5(s, x, ...) BOUGH_SNAPSHOT_1(s, x), BOUGH_SNAPSHOT_4(s, __VA_ARGS__)
#define BOUGH_SNAPSHOT_6(s, x, ...) BOUGH_SNAPSHOT_1(s, x), BOUGH_SNAPSHOT_5(s, __VA_ARGS__)

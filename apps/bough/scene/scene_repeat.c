// Bodies in a row: a body with `repeat: n` becomes n, each hung on the one before by the same
// joint, named with numbers from 1. The first stays where it is in the list, the others come last, so that
// places in the text keep their index.
#include "apps/bough/scene/scene_internal.h"

#include <stdio.h>
#include <string.h>

enum { MOST_BODIES = 10000, MOST_SEGMENTS = 1000000 };

static const char *numbered(bough_arena *arena, const char *name, int number) {
    char text[160];
    snprintf(text, sizeof text, "%.140s%d", name, number);
    return bough_arena_string(arena, text);
}

// Bodies after repetition; 0 after an error: a few lines must not ask for any amount of memory.
static size_t count_bodies(bough_schema_reader *r, const bough_scene *s) {
    size_t bodies = 0, segments = 0;
    for (int i = 0; i < s->n_body; i++) {
        bodies += (size_t)s->body[i].repeat;
        if (s->body[i].rod.node == NULL) continue;
        segments += (size_t)s->body[i].repeat * (size_t)s->body[i].rod.n_segment;
    }
    if (bodies > MOST_BODIES || segments > MOST_SEGMENTS) {
        bough_schema_error(r, s->node, "bodies",
                           "expected at most %d bodies and %d segments of "
                           "rods in all, got %zu and %zu",
                           MOST_BODIES, MOST_SEGMENTS, bodies, segments);
        return 0;
    }
    return bodies;
}

void bough_scene_repeat(bough_schema_reader *r, bough_scene *s) {
    bough_arena *arena = r->arena;
    int n = s->n_body, next = n;
    size_t total = count_bodies(r, s);
    if (total == 0) return;
    bough_scene_body *body = bough_arena_take(arena, total * sizeof *body);
    memcpy(body, s->body, (size_t)n * sizeof *body);
    for (int i = 0; i < n; i++) {
        if (bough_node_find(body[i].node, "repeat") == NULL) continue;
        const char *name = body[i].name, *before;
        before = body[i].name = numbered(arena, name, 1);
        for (int k = 2; k <= body[i].repeat; k++, next++) {
            body[next] = body[i];
            body[next].joint.parent_name = before;
            before = body[next].name = numbered(arena, name, k);
        }
    }
    s->body = body;
    s->n_body = next;
}

// Bodies in a row: a body with `repeat: n` becomes n, each hung on the one before by the same
// joint, named with numbers from 1. The first stays where it is in the list, the others come last, so that
// places in the text keep their index.
#include "apps/scene/scene_parts.h"

#include <stdio.h>
#include <string.h>

static const char *numbered(bough_arena *arena, const char *name, int number) {
    char text[160];
    if (name == NULL) return NULL;
    snprintf(text, sizeof text, "%.140s%d", name, number);
    return bough_arena_string(arena, text);
}

void bough_scene_repeat(bough_arena *arena, bough_scene *s) {
    int n = s->n_body, next = n;
    size_t total = (size_t)n;
    for (int i = 0; i < n; i++)
        total += (size_t)s->body[i].repeat - 1;
    bough_scene_body *body = bough_arena_take(arena, total * sizeof *body);
    if (body == NULL) return;
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

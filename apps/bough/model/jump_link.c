#include "apps/bough/model/jump_link.h"

#include <math.h>

// A ramp of the model whose two times are 0 once the load acts, and beyond all times before.
typedef struct jump {
    double at; // [s]
    bough_schedule *ramp;
} jump;

struct bough_jump_link {
    int n;
    jump *jump; // (n)
};

static void add(bough_jump_link *link, bough_schedule *ramp) {
    if (!(ramp->start > 0) || ramp->end > ramp->start) return;
    link->jump[link->n++] = (jump){ramp->start, ramp};
}

void bough_jump_link_build(bough_arena *arena, bough_simulation *s) {
    bough_jump_link *link = bough_arena_take(arena, sizeof *link);
    *link = (bough_jump_link){0, bough_arena_take(arena, (size_t)s->scene->n_load * sizeof(jump))};
    for (int k = 0; k < s->tree->n_loads; k++) {
        add(link, &s->tree->loads[k].schedule);
    }
    for (int k = 0; k < s->tree->n_applied; k++) {
        add(link, &s->tree->applied[k].schedule);
    }
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].port < 0) continue;
        bough_rod_ramped_load *l = bough_beam_loads(&s->beam[k])->ramped;
        for (; l != NULL; l = l->next) add(link, &l->schedule);
    }
    if (link->n > 0) s->jump = link;
}

void bough_jump_link_begin(bough_jump_link *link, double t) {
    for (int k = 0; k < link->n; k++) {
        jump *j = &link->jump[k];
        j->ramp->start = j->ramp->end = t >= j->at ? 0 : HUGE_VAL;
    }
}

static void begin(void *self, double t) { bough_jump_link_begin(self, t); }

bough_sampled_load bough_jump_link_load(bough_jump_link *link, double macro_step) {
    return (bough_sampled_load){.period = macro_step, .self = link, .begin = begin};
}

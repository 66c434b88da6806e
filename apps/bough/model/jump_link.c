#include "apps/bough/model/build_internal.h"

#include <math.h>

// A ramp of the model whose two times are 0 once the load acts, and beyond all times before.
typedef struct jump {
    double at; // [s]
    bough_schedule *ramp;
} jump;

typedef struct jumps {
    int n;
    jump *jump; // (n)
} jumps;

static void add(jumps *j, bough_schedule *ramp) {
    if (ramp->start > 0 && ramp->end <= ramp->start) j->jump[j->n++] = (jump){ramp->start, ramp};
}

static void begin(void *self, double t) {
    const jumps *j = self;
    for (int k = 0; k < j->n; k++)
        j->jump[k].ramp->start = j->jump[k].ramp->end = t >= j->jump[k].at ? 0 : HUGE_VAL;
}

void bough_jump_link_build(bough_arena *arena, bough_simulation *s) {
    jumps *j = bough_arena_take(arena, sizeof *j);
    j->jump = bough_arena_take(arena, (size_t)s->scene->n_load * sizeof *j->jump);
    for (int k = 0; k < s->tree->n_loads; k++) add(j, &s->tree->loads[k].schedule);
    for (int k = 0; k < s->tree->n_applied; k++) add(j, &s->tree->applied[k].schedule);
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].port < 0) continue;
        bough_rod_ramped_load *l = s->beam[k].loads->ramped;
        for (; l != NULL; l = l->next) add(j, &l->schedule);
    }
    s->jumps = j->n > 0;
    if (!s->jumps) return;
    s->sampled[s->n_sampled++] =
        (bough_sampled_load){.period = s->scene->simulation.macro_step, .self = j, .begin = begin};
}

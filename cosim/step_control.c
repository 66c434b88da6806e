#include "cosim/step_control.h"

#include <math.h>

bough_step_control *bough_step_control_create(bough_arena *arena, bough_coupling *c,
                                              const bough_step_control_def *def, double macro_step,
                                              int order) {
    bough_step_control *s = bough_arena_take(arena, sizeof *s);
    s->tolerance = def->tolerance;
    s->easy = 0.5 * def->tolerance * pow(0.5, order);
    s->most = def->least > 0 ? (int)floor(log2(macro_step / def->least) + 1e-6) : 0;
    s->shortest = HUGE_VAL;
    bough_snapshot size = {.move = BOUGH_SNAPSHOT_MEASURE};
    bough_coupling_snapshot(c, &size);
    s->copy = bough_arena_take(arena, size.used);
    return s;
}

double bough_step_control_end(bough_step_control *s, double from, double to) {
    int n = 1 << s->level;
    if (s->part == 0) s->from = from;
    s->to = to;
    return s->part + 1 == n ? to : s->from + (to - s->from) * (s->part + 1) / n;
}

// -- copies ---------------------------------------------------------------------------------------

void bough_step_control_save(bough_step_control *s, bough_coupling *c) {
    bough_coupling_snapshot(c, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, s->copy, 0});
}

void bough_step_control_restore(bough_step_control *s, bough_coupling *c) {
    bough_coupling_snapshot(c, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, s->copy, 0});
}

void bough_step_control_snapshot(bough_step_control *s, bough_snapshot *snapshot) {
    char *copy = s->copy;
    bough_snapshot_take(snapshot, s, sizeof *s);
    s->copy = copy;
}

// -- decisions ------------------------------------------------------------------------------------

bool bough_step_control_exhausted(const bough_step_control *s) { return s->level >= s->most; }

static void refine(bough_step_control *s) {
    s->level++;
    s->part *= 2;
    s->rejected++;
}

bool bough_step_control_accept(bough_step_control *s, double error, double length) {
    bool good = error <= s->tolerance;
    if (!good && !bough_step_control_exhausted(s)) {
        refine(s);
        return false;
    }
    if (!isfinite(error)) return false;
    s->accepted++;
    s->forced += !good;
    s->shortest = fmin(s->shortest, length);
    s->part++;
    if (s->part == 1 << s->level) s->part = 0;
    if (error < s->easy && s->level > 0 && s->part % 2 == 0) {
        s->level--;
        s->part /= 2;
    }
    return true;
}

#include "cosim/step_control.h"

#include <assert.h>
#include <math.h>
#include <string.h>

bough_status bough_step_control_create(bough_arena *arena, const bough_coupling *c,
                                       const bough_step_control_def *def, double macro_step,
                                       int order, bough_step_control **control) {
    const bough_assembly *a = c->assembly;
    bough_step_control *s = bough_arena_take(arena, sizeof *s);
    if (!s) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    s->tolerance = def->tolerance;
    s->easy = 0.5 * def->tolerance * pow(0.5, order);
    s->most = def->least > 0 ? (int)floor(log2(macro_step / def->least) + 1e-6) : 0;
    s->shortest = HUGE_VAL;
    s->member = bough_arena_take(arena, (size_t)a->n_member * sizeof *s->member);
    for (int i = 0; i < a->n_member && s->member; i++) {
        const bough_subsystem *member = a->member[i];
        s->member[i] = bough_arena_take(arena, member->ops->save_size(member->self));
    }
    s->array = bough_arena_doubles(arena, (size_t)(a->n_output + (3 + BOUGH_HISTORY) * a->n_input));
    *control = s;
    return bough_arena_exhausted(arena) ? bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory")
                                        : bough_ok();
}

double bough_step_control_end(bough_step_control *s, double from, double to) {
    int n = 1 << s->level;
    if (s->part == 0) s->from = from;
    s->to = to;
    return s->part + 1 == n ? to : s->from + (to - s->from) * (s->part + 1) / n;
}

// -- copies ---------------------------------------------------------------------------------------

// Moves every array of the coupling that outlives a step into the copy, or back.
static void exchange(bough_step_control *s, bough_coupling *c, bool save) {
    size_t n = (size_t)c->assembly->n_input, n_output = (size_t)c->assembly->n_output;
    double *const part[] = {c->output, c->input, c->used, c->owed, c->past[0], c->past[1],
                            c->past[2]};
    double *at = s->array;
    static_assert(BOUGH_HISTORY == 3, "the arrays above");
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        size_t count = k == 0 ? n_output : n;
        if (!part[k]) continue;
        memcpy(save ? at : part[k], save ? part[k] : at, count * sizeof(double));
        at += count;
    }
}

void bough_step_control_save(bough_step_control *s, bough_coupling *c) {
    for (int i = 0; i < c->assembly->n_member; i++) {
        const bough_subsystem *member = c->assembly->member[i];
        member->ops->save(member->self, s->member[i]);
    }
    exchange(s, c, true);
    memcpy(s->past_time, c->past_time, sizeof s->past_time);
    s->n_past = c->n_past;
}

void bough_step_control_restore(bough_step_control *s, bough_coupling *c) {
    for (int i = 0; i < c->assembly->n_member; i++) {
        const bough_subsystem *member = c->assembly->member[i];
        member->ops->restore(member->self, s->member[i]);
    }
    exchange(s, c, false);
    memcpy(c->past_time, s->past_time, sizeof s->past_time);
    c->n_past = s->n_past;
}

// -- decisions ------------------------------------------------------------------------------------

bool bough_step_control_exhausted(const bough_step_control *s) {
    return s->level >= s->most;
}

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

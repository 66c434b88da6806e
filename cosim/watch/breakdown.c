#include "cosim/watch/breakdown.h"

#include "cosim/scheme.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct bough_breakdown {
    const bough_assembly *assembly;
    double *state; // (n_state)
    double *input; // (n_input)
};

enum { ADVICE = 240 };

bough_breakdown *bough_breakdown_create(bough_arena *arena, const bough_assembly *assembly) {
    bough_breakdown *b = bough_arena_take(arena, sizeof *b);
    b->assembly = assembly;
    b->state = bough_arena_doubles(arena, (size_t)assembly->n_state);
    b->input = bough_arena_doubles(arena, (size_t)assembly->n_input);
    return b;
}

void bough_breakdown_keep(bough_breakdown *b, const bough_coupling *c) {
    bough_assembly_states(b->assembly, b->state);
    memcpy(b->input, c->input, (size_t)b->assembly->n_input * sizeof *b->input);
}

static void restore_members(const bough_breakdown *b, const bough_coupling *c) {
    const bough_assembly *a = b->assembly;
    for (int i = 0; i < a->n_member; i++) {
        bough_member_set(a->member[i], c->t0, b->state + a->state_offset[i]);
    }
}

void bough_breakdown_undo(const bough_breakdown *b, bough_coupling *c) {
    restore_members(b, c);
    memcpy(c->input, b->input, (size_t)b->assembly->n_input * sizeof *b->input);
}

// Nothing when the judgement fails too: the state may be past judging.
static bough_stability_advice judge_again(bough_breakdown *b, bough_coupling *c) {
    const bough_assembly *a = b->assembly;
    bough_stability_advice advice;
    restore_members(b, c);
    bough_status status = bough_stability_advise(a, &c->options, c->t1 - c->t0, &advice);
    return bough_is_ok(&status) ? advice : (bough_stability_advice){0};
}

// Shorter macro steps and other tolerances seldom help a member that fails under a stable coupling; one
// system of all members does. What stops that stops every method: vibrations that nothing damps, a mesh that
// is too coarse. Of an opaque member nothing is known.
static void advise(const bough_coupling *c, const bough_stability_advice *advice, char *text) {
    if (!advice->unstable) {
        snprintf(text, ADVICE, "; try %s",
                 c->scheme->one_system ? "damping of flexible bodies, more segments or another master.rtol"
                 : c->assembly->opaque ? "a smaller macro step or another micro.rtol"
                                       : "scheme: " BOUGH_SCHEME_DEFAULT);
        return;
    }
    int n = snprintf(text, ADVICE, ": the coupling grows by a factor of %.3g in each macro step; try ",
                     exp(advice->now.growth * (c->t1 - c->t0)));
    if (advice->macro_step > 0) {
        n += snprintf(text + n, (size_t)(ADVICE - n), "macro_step: %.9g s or ", advice->macro_step);
    }
    snprintf(text + n, (size_t)(ADVICE - n), "scheme: " BOUGH_SCHEME_DEFAULT);
}

bough_status bough_breakdown_explain(bough_breakdown *b, bough_coupling *c,
                                     const bough_stability_advice *before, bough_status cause) {
    if (cause.code != BOUGH_FAILED && cause.code != BOUGH_RETRY) return cause;
    char text[ADVICE];
    bough_stability_advice advice = *before;
    if (!advice.unstable && !c->scheme->one_system) advice = judge_again(b, c);
    advise(c, &advice, text);
    return bough_fail(BOUGH_FAILED, "%s (scheme %s, macro step %.6g s from %.6g s)%s", cause.message,
                      c->scheme->name, c->t1 - c->t0, c->t0, text);
}

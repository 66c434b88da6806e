// A run beside a finer one: what its channels differ by, and what the run states.
#pragma once

#include "apps/bough/model/companion.h"
#include "apps/bough/model/error_verdict.h"
#include "tests/unit/built_scene.h"

enum { MOST = 256, STEPS = 100 };

typedef struct outcome {
    int n; // channels
    char name[MOST][BOUGH_CHANNEL_NAME];
    double value[STEPS][MOST]; // at multiples of 20 ms
    double error[MOST];        // estimate
    bool compared;
    char reason[BOUGH_MESSAGE];
} outcome;

static inline outcome *run_for(const char *path, int steps, const char *const *sets) {
    outcome *o = calloc(1, sizeof *o);
    check_run(arena, r, path, sets);
    assert_true(r.channels.count <= MOST);
    o->n = r.channels.count;
    for (int i = 0; i < o->n; i++) strcpy(o->name[i], r.channels.channel[i].name);
    for (int k = 0; k < steps; k++) {
        do {
            check_ok(bough_run_step(&r));
        } while (r.simulation->master->time < 0.02 * (k + 1) - 1e-9);
        memcpy(o->value[k], bough_run_values(&r), (size_t)o->n * sizeof(double));
    }
    for (int i = 0; i < o->n; i++)
        o->error[i] = bough_companion_knows(r.companion, i) ? r.companion->error[i] : (double)NAN;
    o->compared = r.companion->compared > 0;
    memcpy(o->reason, r.companion->reason, sizeof o->reason);
    return o;
}

static inline int find(const outcome *o, const char *name) {
    int i = 0;
    while (i < o->n && strcmp(o->name[i], name) != 0) i++;
    assert_true(i < o->n);
    return i;
}

// A run to its end.
#define check_ended_run(arena, r, scene, sets)                                                               \
    check_run(arena, r, scene, sets);                                                                        \
    while (!bough_run_done(&r)) check_ok(bough_run_step(&r))

static inline bough_error_shares find_shares(bough_arena *arena, bough_run *r) {
    bough_error_shares shares;
    check_ok(bough_error_shares_find(arena, r->companion, NULL, &shares));
    return shares;
}

typedef struct beside {
    bough_run r;
    int n; // channels
    double error[8], estimate[8];
} beside;

// A run over so many steps (0: to its end) beside one whose macro steps are a part of its own: what its
// channels (up to NULL) differ by, and the run's estimates.
static inline beside *run_beside(bough_arena *arena, const char *scene, const char *const *sets,
                                 const char *const *truth_sets, int steps, const char *const *channel) {
    beside *b = bough_arena_take(arena, sizeof *b);
    bough_run truth, *r = &b->r;
    check_ok(bough_run_create(arena, scene_read(arena, scene, sets), r));
    check_ok(bough_run_create(arena, scene_read(arena, scene, truth_sets), &truth));
    for (int k = 0; steps > 0 ? k < steps : !bough_run_done(r); k++) {
        check_ok(bough_run_step(r));
        double time = r->simulation->master->time - 1e-9;
        while (truth.simulation->master->time < time) check_ok(bough_run_step(&truth));
        for (int w = 0; channel[w]; w++) {
            int i = bough_channels_find(&r->channels, channel[w]);
            b->estimate[w] = r->companion->error[i];
            b->error[w] = fmax(b->error[w], fabs(bough_run_values(r)[i] - bough_run_values(&truth)[i]));
        }
    }
    for (; channel[b->n]; b->n++)
        print_message("%s: true %.2g, estimate %.2g: %.2f\n", channel[b->n], b->error[b->n],
                      b->estimate[b->n], b->estimate[b->n] / b->error[b->n]);
    return b;
}

// Each estimate over its error lies between these.
static inline void check_estimates(const beside *b, double least, double most) {
    for (int w = 0; w < b->n; w++)
        assert_true(b->estimate[w] > least * b->error[w] && b->estimate[w] < most * b->error[w]);
}

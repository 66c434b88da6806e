// Members for tests.
#pragma once

#include "cosim/member.h"
#include "tests/unit/check.h"

// The system as a member in the arena, at time 0.
static inline bough_member *member_of(bough_arena *arena, const bough_system *system,
                                      bough_integrator_options options) {
    bough_member *m = bough_arena_take(arena, sizeof *m);
    assert_non_null(m);
    check_ok(bough_member_create(arena, system, 0, &options, m));
    return m;
}

// A copy of the member in the arena; the member as it was.
static inline char *member_save(bough_arena *arena, bough_member *m) {
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    bough_member_snapshot(m, &measure);
    char *copy = bough_arena_take(arena, measure.used);
    assert_non_null(copy);
    bough_member_snapshot(m, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, copy, 0});
    return copy;
}

static inline void member_restore(bough_member *m, char *copy) {
    bough_member_snapshot(m, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, copy, 0});
}

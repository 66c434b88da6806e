// A simulation of a scene file with values replaced, for tests that start from a whole scene.
#ifndef BOUGH_TESTS_UNIT_BUILT_SCENE_H
#define BOUGH_TESTS_UNIT_BUILT_SCENE_H

#include "apps/bough/model/simulation.h"
#include "tests/unit/check.h"

// Reads the scene at `path` within the sources; `sets` ends with NULL.
static inline bough_scene *scene_read(bough_arena *arena, const char *path, const char *const *sets) {
    bough_errors errors = {.arena = arena};
    bough_scene *scene = NULL;
    char file[512];
    int n = 0;
    while (sets[n] != NULL) n++;
    snprintf(file, sizeof file, BOUGH_SOURCE_DIR "/%s", path);
    bough_status status = bough_scene_read(arena, file, sets, n, &errors, &scene);
    bough_errors_print(&errors, stderr);
    assert_int_equal(status.code, BOUGH_OK);
    return scene;
}

static inline bough_simulation *scene_build(bough_arena *arena, const char *path, const char *const *sets) {
    bough_simulation *s = NULL;
    check_ok(bough_simulation_build(arena, scene_read(arena, path, sets), &s));
    return s;
}

static inline void scene_step(bough_simulation *s) { check_ok(bough_step(s->master)); }

// The value now of a channel of that name, of at most 64.
static inline double scene_channel(bough_simulation *s, bough_channels *list, const char *name) {
    double value[64];
    int index = bough_channels_find(list, name);
    assert_true(index >= 0 && list->count <= 64);
    bough_simulation_update(s);
    bough_channels_sample(list, s->master->time, value);
    return value[index];
}

#endif

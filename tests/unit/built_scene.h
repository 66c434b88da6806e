// A simulation of a scene file with values replaced, for tests that start from a whole scene.
#pragma once

#include "apps/bough/model/run.h"
#include "tests/unit/check.h"
#include "tests/unit/scratch_name.h"

#include <unistd.h>

// The values that are replaced, one text each; or none.
#define sets_of(...) ((const char *const[]){__VA_ARGS__, NULL})
static const char *const no_sets[] = {NULL};

// Reads the scene in that file; `sets` ends with NULL.
static inline bough_scene *scene_read_file(bough_arena *arena, const char *file, const char *const *sets) {
    bough_errors errors = {.arena = arena};
    bough_scene *scene = NULL;
    int n = 0;
    while (sets[n] != NULL) n++;
    bough_status status = bough_scene_read(arena, NULL, file, sets, n, &errors, &scene);
    bough_errors_print(&errors, stderr);
    assert_int_equal(status.code, BOUGH_OK);
    return scene;
}

// … at `path` within the sources.
static inline bough_scene *scene_read(bough_arena *arena, const char *path, const char *const *sets) {
    char file[512];
    snprintf(file, sizeof file, BOUGH_SOURCE_DIR "/%s", path);
    return scene_read_file(arena, file, sets);
}

static inline bough_simulation *scene_build(bough_arena *arena, const char *path, const char *const *sets) {
    bough_simulation *s = NULL;
    check_ok(bough_simulation_build(arena, scene_read(arena, path, sets), &s));
    return s;
}

// Memory until the end of the block, and in it a simulation, or a run, of the scene at `path`.
#define check_build(arena, s, path, sets)                                                                    \
    check_arena(arena);                                                                                      \
    bough_simulation *s = scene_build(arena, path, sets)

// The same with the values that are replaced, one text each.
#define check_build_with(arena, s, path, ...) check_build(arena, s, path, sets_of(__VA_ARGS__))

#define check_run(arena, r, path, sets)                                                                      \
    check_arena(arena);                                                                                      \
    bough_run r;                                                                                             \
    check_ok(bough_run_create(arena, scene_read(arena, path, sets), &r))

// A scene of this text.
static inline bough_simulation *scene_build_text(bough_arena *arena, const char *text) {
    char file[SCRATCH_NAME];
    bough_simulation *s = NULL;
    FILE *stream = fdopen(mkstemp(scratch_name(file)), "w");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
    bough_scene *scene = scene_read_file(arena, file, no_sets);
    unlink(file);
    check_ok(bough_simulation_build(arena, scene, &s));
    return s;
}

// With this replacement the scene, or a run of it, must be refused, by an error that says so.
static inline void scene_refused(const char *path, const char *set, const char *says) {
    check_arena(arena);
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_run run;
    char file[512];
    snprintf(file, sizeof file, BOUGH_SOURCE_DIR "/%s", path);
    bough_status status = bough_scene_read(arena, NULL, file, &set, 1, &errors, &scene);
    if (bough_is_ok(&status)) status = bough_run_create(arena, scene, &run);
    assert_int_equal(status.code, BOUGH_INVALID);
    bool said = strstr(status.message, says) != NULL;
    for (int i = 0; i < errors.n; i++) said = said || strstr(errors.item[i].text, says);
    if (!said) fail_msg("no '%s' for %s: %s", says, set, status.message);
}

static inline void scene_step(bough_simulation *s) { check_ok(bough_step(s->master)); }

static inline bough_channels scene_channels(bough_arena *arena, bough_simulation *s) {
    bough_channels list = bough_channels_start(arena);
    check_ok(bough_simulation_channels(s, &list));
    return list;
}

// The value now of a channel of that name.
static inline double scene_channel(bough_simulation *s, bough_channels *list, const char *name) {
    double value[256];
    int index = bough_channels_find(list, name);
    if (index < 0) print_error("no channel %s\n", name);
    assert_true(index >= 0 && list->count <= 256);
    bough_simulation_update(s);
    bough_channels_sample(list, s->master->time, value);
    return value[index];
}

// A simulation with its channels; the arena ends with the program unless it is destroyed before.
typedef struct built {
    bough_arena *arena;
    bough_simulation *s;
    bough_channels channels;
} built;

static inline built built_from(bough_arena *arena, bough_simulation *s) {
    return (built){arena, s, scene_channels(arena, s)};
}

static inline built built_open(const char *path, const char *const *sets) {
    bough_arena *arena = check_memory();
    return built_from(arena, scene_build(arena, path, sets));
}

static inline double channel(built *b, const char *name) { return scene_channel(b->s, &b->channels, name); }

static inline void run_until(built *b, double t) {
    while (b->s->master->time < t - 1e-9) scene_step(b->s);
}

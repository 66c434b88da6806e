// Scenes that tests read: files of the source, and texts written into a directory of their own, so
// that paths in messages are short.
#pragma once

#include "apps/bough/scene/scene.h"
#include "tests/unit/check.h"
#include "tests/unit/printed.h"
#include "tests/unit/scratch.h"

#define SCENES BOUGH_SOURCE_DIR "/tests/data/scenes/"

static const double degree = 3.14159265358979323846 / 180;

typedef struct fixture {
    bough_arena *arena;
    bough_errors errors;
    bough_scene *scene;
    bough_status status;
    const char *printed;
} fixture;

static inline fixture read_scene(const char *path, const char *const *sets, int n_set) {
    fixture f = {.arena = check_memory()};
    f.errors.arena = f.arena;
    f.status = bough_scene_read(f.arena, NULL, path, sets, n_set, &f.errors, &f.scene);
    f.printed = printed_errors(&f.errors);
    return f;
}

static inline void write_file(const char *name, const char *text) { scratch_write(".", name, text); }

static inline int enter(void **state) { return scratch_make(state) == 0 ? chdir(*state) : -1; }

static inline int leave(void **state) { return chdir("/") == 0 ? scratch_remove(state) : -1; }

// Reading the scene must fail with exactly these lines; without one it is read.
static inline fixture refuses(const char *text, const char *lines) {
    write_file("s.yaml", text);
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, lines);
    assert_int_equal(f.status.code, lines[0] == '\0' ? BOUGH_OK : BOUGH_INVALID);
    if (lines[0] != '\0') assert_null(f.scene);
    return f;
}

static inline fixture accepts(const char *text) { return refuses(text, ""); }

// A scene with one body, whose text (four spaces deep) goes on in line 6.
#define SIMULATION "simulation: {duration: 1 s, macro_step: 10 ms}\n"
#define JOINT "    joint: {kind: fixed, parent: ground}\n"
#define ONE_BODY SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n" JOINT
#define ROD_BODY SIMULATION "bodies:\n  - name: a\n    fidelity: rod\n" JOINT

// Parts of scenes that need more.
#define BODY(name, parent) "  - {name: " name ", fidelity: rigid, joint: {kind: fixed, parent: " parent "}}\n"
#define SMALL_ROD "rod: {length: 2, segments: 4, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}"
#define TWO_RODS                                                                                              \
    SIMULATION "bodies:\n" BODY(                                                                              \
        "a",                                                                                                  \
        "ground") "  - {name: b, fidelity: rod, joint: {kind: fixed, parent: ground}, " SMALL_ROD "}\n"       \
                  "  - {name: c, fidelity: rod, joint: {kind: revolute, parent: ground, axis: x}, " SMALL_ROD \
                  "}\nloads:\n"
#define ROTOR                                                                                                \
    SIMULATION                                                                                               \
    "bodies:\n  - {name: hub, mass: 1, fidelity: rigid, joint: {kind: revolute, parent: ground, "            \
    "axis: x}}\n"                                                                                            \
    "  - {name: b1, fidelity: rod, joint: {kind: fixed, parent: hub}, rod: &r {length: 5,\n"                 \
    "      stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}}\n"                                      \
    "  - {name: b2, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: *r}\n"

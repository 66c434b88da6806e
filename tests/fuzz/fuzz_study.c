#include "apps/bough/cases/study.h"
#include "tests/fuzz/fuzz.h"
#include "tests/verification/verification.h"

static const char scene_text[] =
    "simulation: {duration: 2 s, macro_step: 10 ms}\n"
    "bodies:\n"
    "  - {name: bob, fidelity: rigid, mass: 1 kg, inertia: [1, 1, 1], joint: {kind: revolute, parent: "
    "ground, axis: y}}\n"
    "markers: [{name: bob, body: bob}]\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_study *study;
    fuzz_file("scene.yaml", scene_text, strlen(scene_text));
    const char *path = fuzz_file("study.yaml", data, size);
    bough_status status = bough_study_read(arena, path, 1, &errors, &study);
    fuzz_demand((study == NULL) == !bough_is_ok(&status), "a study, or why there is none");
    bough_arena_destroy(arena);
    arena = bough_arena_create();
    errors = (bough_errors){.arena = arena};
    bough_verification verification;
    status = bough_verification_read(arena, path, &errors, &verification);
    fuzz_demand((errors.n == 0) == bough_is_ok(&status), "a verification, or why there is none");
    bough_arena_destroy(arena);
    return 0;
}

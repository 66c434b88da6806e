#include "apps/bough/scene/scene.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    const char *path = fuzz_file("scene.yaml", data, size);
    bough_status status = bough_scene_read(arena, NULL, path, NULL, 0, &errors, &scene);
    fuzz_demand((scene == NULL) == (errors.n > 0), "a scene, or why there is none");
    fuzz_demand(bough_is_ok(&status) == (errors.n == 0), "the status says so");
    bough_arena_destroy(arena);
    return 0;
}

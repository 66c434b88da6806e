#include "apps/bough/import/import.h"
#include "apps/bough/scene/scene.h"
#include "tests/fuzz/fuzz.h"

// What becomes a scene can be read as one.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char out[SCRATCH_PATH], path[SCRATCH_PATH + 32];
    snprintf(out, sizeof out, "%s/out", fuzz_folder());
    snprintf(path, sizeof path, "%s/scene.yaml", out);
    bough_status status =
        bough_import_windio(fuzz_file("turbine.yaml", data, size), out, &(bough_import_options){0}, NULL);
    fuzz_demand(bough_is_ok(&status) || status.message[0], "a reason");
    if (!bough_is_ok(&status)) return 0;
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    status = bough_scene_read(arena, NULL, path, NULL, 0, &errors, &scene);
    bool good = bough_is_ok(&status);
    if (!good) bough_errors_print(&errors, stderr);
    fuzz_demand(good, "a scene that can be read");
    bough_arena_destroy(arena);
    return 0;
}

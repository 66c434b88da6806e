#include "apps/bough/scene/scene.h"
#include "tests/fuzz/fuzz.h"

// Names the input as each kind of table.
static const char scene_text[] =
    "simulation: {duration: 2 s, macro_step: 10 ms}\n"
    "bodies:\n"
    "  - {name: hub, fidelity: rigid, mass: 1 kg, inertia: [1, 1, 1], joint: {kind: revolute, parent: "
    "ground, axis: x}}\n"
    "  - {name: blade, fidelity: rod, joint: {kind: fixed, parent: hub}, rod: {table: table.yaml}}\n"
    "turbine: {rotor: hub, blades: [blade]}\n"
    "aero: {rate: 50 Hz, wind: {kind: uniform, speed: 12 m/s}, blade: table.yaml, polars: table.yaml}\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    fuzz_file("table.yaml", data, size);
    const char *path = fuzz_file("scene.yaml", scene_text, strlen(scene_text));
    bough_scene_read(arena, NULL, path, NULL, 0, &errors, &scene);
    fuzz_demand(scene == NULL && errors.n > 0, "no file is all tables at once");
    bough_arena_destroy(arena);
    return 0;
}

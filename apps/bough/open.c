#include "apps/bough/open.h"

static bough_status read_scene(bough_arena *arena, const bough_options *options,
                               bough_scene **scene) {
    bough_errors errors = {.arena = arena};
    bough_status status =
        bough_scene_read(arena, options->operand, options->set, options->n_set, &errors, scene);
    if (errors.n > 0 && status.code == BOUGH_INVALID) {
        bough_errors_print(&errors, stderr);
        status.message[0] = '\0';
    }
    return status;
}

bough_status bough_open(bough_arena *arena, const bough_options *options,
                        bough_simulation **simulation) {
    bough_scene *scene;
    bough_status status = read_scene(arena, options, &scene);
    if (!bough_is_ok(&status)) return status;
    if (options->threads > 0) scene->simulation.threads = options->threads;
    return bough_simulation_build(arena, scene, simulation);
}

#include "apps/bough/open.h"

#include <string.h>

bough_status bough_open_scene(bough_arena *arena, const bough_options *options, bough_scene **scene) {
    bough_errors errors = {.arena = arena};
    bough_status status =
        bough_scene_read(arena, options->operand, options->set, options->n_set, &errors, scene);
    if (errors.n > 0 && status.code == BOUGH_INVALID) {
        bough_errors_print(&errors, stderr);
        status.message[0] = '\0';
    }
    if (!bough_is_ok(&status)) return status;
    bough_scene_warn(*scene, stderr);
    if (options->threads > 0) (*scene)->simulation.threads = options->threads;
    return status;
}

bough_status bough_open(bough_arena *arena, const bough_options *options, bough_simulation **simulation) {
    bough_scene *scene;
    bough_status status = bough_open_scene(arena, options, &scene);
    if (!bough_is_ok(&status)) return status;
    return bough_simulation_build(arena, scene, simulation);
}

const char *bough_out_folder(bough_arena *arena, const bough_options *options) {
    if (options->out) return options->out;
    const char *slash = strrchr(options->operand, '/');
    const char *name = slash ? slash + 1 : options->operand;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    char *folder = bough_arena_take(arena, length + 5);
    if (folder) snprintf(folder, length + 5, "out/%.*s", (int)length, name);
    return folder;
}

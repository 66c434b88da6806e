#include "apps/bough/cli/command.h"

#include "apps/bough/config/schema.h"

#include <string.h>

bough_status bough_open_scene(bough_arena *arena, const bough_options *options, bough_scene **scene) {
    bough_errors errors = {.arena = arena};
    bough_status status =
        bough_scene_read(arena, options->operand, options->set.text, options->set.n, &errors, scene);
    bough_errors_tell(&errors, &status);
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

// The failure of a name or a pattern of simulation.output.channels that no channel matches.
static bough_status no_channel(const bough_scene_output *output, const bough_channels *all, int k) {
    const char *const *names = bough_channels_names(all, all->arena);
    char key[48];
    snprintf(key, sizeof key, "simulation.output.channels[%d]", k);
    bough_status status =
        bough_fail(BOUGH_INVALID,
                   "no channel matches '%.80s'%s; the first of %d is '%s', 'bough help channels' lists them",
                   output->channels[k], bough_suggest(output->channels[k], names, all->count).text,
                   all->count, all->count > 0 ? names[0] : "");
    return bough_scene_blame(bough_node_find(output->node, "channels")->value[k], key, status);
}

bough_status bough_open_channels(const bough_scene *scene, const bough_channels *all,
                                 bough_channels *recorded) {
    const bough_scene_output *output = &scene->simulation.output;
    for (int k = 0; k < output->n_channel; k++) {
        if (!bough_channels_match(all, output->channels[k])) return no_channel(output, all, k);
    }
    bough_channels_choose(all, output->n_channel, output->channels, recorded);
    return bough_ok();
}

const char *bough_out_folder(bough_arena *arena, const bough_options *options) {
    if (options->out) return options->out;
    const char *slash = strrchr(options->operand, '/');
    const char *name = slash ? slash + 1 : options->operand;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    return bough_arena_print(arena, "out/%.*s", (int)length, name);
}

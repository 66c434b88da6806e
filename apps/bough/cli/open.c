#include "apps/bough/cli/command.h"

#include "apps/bough/config/schema.h"
#include "core/base/input_file.h"

#include <dirent.h>

// -- the scene of a directory ---------------------------------------------------------------------

enum { SHOWN = 8, LINE = 4096 };

// Whether a line begins with one of these keys: only scenes have them, not tables and studies.
static bool is_scene(const char *path) {
    static const char *const keys[] = {"bodies:", "turbine:", "base:"};
    char line[LINE], why[BOUGH_INPUT_REASON];
    bool found = false;
    FILE *file = bough_input_open(path, BOUGH_INPUT_TEXT, why);
    while (file && !found && fgets(line, sizeof line, file)) {
        for (int k = 0; k < 3; k++) found = found || strncmp(line, keys[k], strlen(keys[k])) == 0;
    }
    if (file) fclose(file);
    return found;
}

// Whether a file is called scene.yaml or like the directory.
static bool is_first(const char *file, const char *folder) {
    const char *own = bough_file_name(folder);
    bool like = strncmp(file, own, strlen(own)) == 0 && strcmp(file + strlen(own), ".yaml") == 0;
    return like || strcmp(file, "scene.yaml") == 0;
}

bough_status bough_find_scene(bough_arena *arena, bough_options *options) {
    struct dirent **entry;
    char *folder = bough_arena_string(arena, options->operand);
    const char *only = NULL, *first = NULL;
    for (size_t n = strlen(folder); n > 1 && folder[n - 1] == '/'; n--) folder[n - 1] = '\0';
    int n = scandir(folder, &entry, NULL, alphasort), found = 0;
    char list[400] = "";
    for (int k = 0; k < n; k++) {
        const char *name = entry[k]->d_name;
        const char *path = bough_arena_print(arena, "%s/%s", folder, name);
        bool named = bough_ends_with(name + 1, ".yaml") || bough_ends_with(name + 1, ".yml");
        if (named && is_scene(path)) {
            only = path;
            if (is_first(name, folder)) first = path;
            size_t used = strlen(list);
            if (found++ < SHOWN)
                snprintf(list + used, sizeof list - used, "%s%.40s", used > 0 ? ", " : "", name);
        }
        free(entry[k]);
    }
    if (n < 0) return bough_ok(); // no directory
    free(entry);
    if (found == 0) return bough_fail(BOUGH_INVALID, "'%.200s' holds no scene", options->operand);
    if (found > 1 && !first)
        return bough_fail(BOUGH_INVALID, "'%.200s' holds %d scenes; name one of them: %s%s", options->operand,
                          found, list, found > SHOWN ? ", ..." : "");
    options->operand = first ? first : only;
    return bough_ok();
}

// -- a scene --------------------------------------------------------------------------------------

bough_status bough_open_scene(bough_arena *arena, const bough_options *options, bough_scene **scene) {
    bough_errors errors = {.arena = arena};
    bough_status status =
        bough_scene_read(arena, NULL, options->operand, options->set.text, options->set.n, &errors, scene);
    bough_errors_report(&errors, &status);
    if (!bough_is_ok(&status)) return status;
    bough_scene_warn(*scene, stderr);
    if (options->threads > 0) (*scene)->simulation.threads = options->threads;
    return status;
}

bough_status bough_open(bough_arena *arena, const bough_options *options, bough_simulation **simulation) {
    bough_scene *scene;
    BOUGH_TRY(bough_open_scene(arena, options, &scene));
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
    int k = bough_channels_choose(all, output->n_channel, output->channels, recorded);
    return k < 0 ? bough_ok() : no_channel(output, all, k);
}

const char *bough_out_folder(bough_arena *arena, const bough_options *options) {
    if (options->out) return options->out;
    const char *name = bough_file_name(options->operand);
    if (name > options->operand + 1 && strcmp(name, "scene.yaml") == 0) { // named after its directory
        int length = (int)(name - 1 - options->operand);
        name = bough_file_name(bough_arena_print(arena, "%.*s", length, options->operand));
        return bough_arena_print(arena, "out/%s", name);
    }
    const char *dot = strrchr(name, '.');
    int length = (int)(dot && dot > name ? (size_t)(dot - name) : strlen(name));
    return bough_arena_print(arena, "out/%.*s", length, name);
}

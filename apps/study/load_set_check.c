// What cannot be seen in the text of a load set alone: whether every scene takes its replacements and
// has the channels. Found before the first case runs, since the last one may start hours later.
#include "apps/config/schema.h"
#include "apps/scene/fingerprint.h"
#include "apps/simulation/build.h"
#include "apps/study/load_set_internal.h"
#include "apps/study/study_internal.h"

#include <stdio.h>
#include <string.h>

// -- errors ---------------------------------------------------------------------------------------

// Where the set says what the error is about.
static const bough_node *origin(const bough_load_set *s, const bough_load_case *c,
                                const bough_error *e) {
    const bough_load_group *g = &s->group[c->group];
    for (int i = 0; i < g->grid.n; i++) {
        bough_study_settings value = {.n = 1, .item = &g->grid.axis[i].value.item[c->index[i]]};
        if (bough_study_concerned(&value, e)) return value.item->node;
    }
    const bough_study_setting *found = bough_study_concerned(&g->set, e);
    if (!found) found = bough_study_concerned(&s->common, e);
    return found ? found->node : g->node;
}

static bool is_reported(const bough_errors *errors, const char *text) {
    for (int i = 0; i < errors->n; i++)
        if (strcmp(errors->item[i].text, text) == 0) return true;
    return false;
}

// Once for all cases that have it.
static void tell(const bough_load_set *s, const bough_load_case *c, const bough_error *e,
                 bough_errors *errors) {
    bough_node where = {.file = e->file, .line = e->line, .column = e->column};
    if (e->line == 0 && strcmp(e->file, c->scene) != 0) where = *origin(s, c, e);
    if (!is_reported(errors, e->text)) bough_errors_add(errors, &where, e->path, "%s", e->text);
}

// -- channels -------------------------------------------------------------------------------------

static void unknown_channel(const bough_load_set *s, const char *name,
                            const bough_channels *channels, bough_errors *errors) {
    const char **names = bough_arena_take(errors->arena,
                                          (size_t)(channels->count + 1) * sizeof *names);
    for (int i = 0; i < channels->count; i++) names[i] = channels->channel[i].name;
    const char *near = bough_nearest(name, names, channels->count);
    bough_errors_add(errors, bough_node_find(s->node, "channels"), "channels",
                     "the scene has no channel '%.80s'%s%s%s", name,
                     near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "");
}

static void keep_channels(bough_arena *arena, bough_load_set *s, const bough_channels *channels) {
    bool all = s->n_wanted == 0;
    s->n_channel = all ? channels->count : s->n_wanted;
    s->channel = bough_arena_take(arena, (size_t)s->n_channel * sizeof *s->channel);
    s->unit = bough_arena_take(arena, (size_t)s->n_channel * sizeof *s->unit);
    for (int i = 0; i < s->n_channel && s->channel && s->unit; i++) {
        int k = all ? i : bough_channels_find(channels, s->wanted[i]);
        s->channel[i] = bough_arena_string(arena, channels->channel[k].name);
        s->unit[i] = bough_arena_string(arena, channels->channel[k].unit);
    }
}

// The first scene's channels are the set's where it names none.
static bough_status check_channels(bough_arena *arena, bough_arena *own, bough_load_set *s,
                                   const bough_scene *scene, bough_errors *errors) {
    bough_simulation *simulation;
    bough_status status = bough_simulation_build(own, scene, &simulation);
    if (!bough_is_ok(&status)) return status;
    bough_channels channels = bough_channels_start(own);
    status = bough_simulation_channels(simulation, &channels);
    bool known = bough_is_ok(&status);
    for (int i = 0; i < s->n_wanted && known; i++) {
        if (bough_channels_find(&channels, s->wanted[i]) < 0) {
            unknown_channel(s, s->wanted[i], &channels, errors);
        }
    }
    if (known && errors->n == 0 && !s->channel) keep_channels(arena, s, &channels);
    return status;
}

// -- cases ----------------------------------------------------------------------------------------

static uint64_t fingerprint(const bough_load_set *s, const bough_load_case *c, uint64_t program,
                            const bough_scene *scene) {
    uint64_t hash = program;
    char numbers[64];
    bough_mix_scene(&hash, scene);
    for (int i = 0; i < c->n_set; i++) bough_mix_text(&hash, c->set[i]);
    snprintf(numbers, sizeof numbers, "%.17g %d %d %d", s->from, s->sweep, s->series, s->n_wanted);
    bough_mix_text(&hash, numbers);
    for (int i = 0; i < s->n_wanted; i++) bough_mix_text(&hash, s->wanted[i]);
    for (int i = 0; i < s->n_slope; i++) bough_mix(&hash, &s->slope[i], sizeof s->slope[i]);
    return hash;
}

static void check_from(const bough_load_set *s, const bough_scene *scene, const bough_load_case *c,
                       bough_errors *errors) {
    if (s->from < scene->simulation.duration) return;
    char text[200];
    snprintf(text, sizeof text, "%g s is not before the end, %g s, of %.100s", s->from,
             scene->simulation.duration, c->scene);
    const bough_node *node = bough_node_find(s->node, "from");
    if (!is_reported(errors, text)) bough_errors_add(errors, node, "from", "%s", text);
}

static bough_status check_case(bough_arena *arena, bough_load_set *s, int i, uint64_t program,
                               bough_errors *errors) {
    bough_arena *own = bough_arena_child(arena);
    bough_errors found = {.arena = own};
    bough_load_case *c = &s->cases[i];
    bough_scene *scene;
    bough_status status = bough_scene_read(own, c->scene, c->set, c->n_set, &found, &scene);
    for (int k = 0; k < found.n; k++) tell(s, c, &found.item[k], errors);
    if (status.code == BOUGH_INVALID) status = bough_ok();
    if (scene) {
        c->fingerprint = fingerprint(s, c, program, scene);
        check_from(s, scene, c, errors);
    }
    bool first = i == 0 || c->group != s->cases[i - 1].group;
    if (scene && first && errors->n == 0) status = check_channels(arena, own, s, scene, errors);
    bough_arena_destroy(own);
    return status;
}

bough_status bough_load_set_check(bough_arena *arena, bough_load_set *s, bough_errors *errors) {
    uint64_t program = BOUGH_FINGERPRINT_START;
    bough_mix_program(&program);
    bough_status status = bough_ok();
    for (int i = 0; i < s->n_case && bough_is_ok(&status) && errors->dropped == 0; i++)
        status = check_case(arena, s, i, program, errors);
    return status;
}

// What cannot be seen in the text of a load set alone: whether every scene takes its replacements and
// has the channels. Found before the first case runs, since the last one may start hours later.
#include "apps/bough/config/schema.h"
#include "apps/bough/scene/fingerprint.h"
#include "apps/bough/model/build.h"
#include "apps/bough/cases/load_set_internal.h"
#include "apps/bough/cases/study_internal.h"

#include <stdio.h>
#include <string.h>

// -- errors ---------------------------------------------------------------------------------------

// Where the set says what the error is about.
static const bough_node *origin(const bough_load_set *s, const bough_load_case *c, const bough_error *e) {
    const bough_load_group *g = &s->group[c->group];
    const bough_study_setting *found = bough_study_concerned_value(&g->grid, c->index, e);
    if (!found) found = bough_study_concerned(&g->set, e);
    if (!found) found = bough_study_concerned(&s->common, e);
    return found ? found->node : g->node;
}

// -- channels -------------------------------------------------------------------------------------

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
            bough_study_unknown_channel(&channels, s->wanted[i], bough_node_find(s->node, "channels"),
                                        "channels", errors);
        }
    }
    if (known && errors->n == 0 && !s->channel) keep_channels(arena, s, &channels);
    return status;
}

// -- cases ----------------------------------------------------------------------------------------

static uint64_t fingerprint(const bough_load_set *s, const bough_load_case *c, uint64_t program) {
    uint64_t hash = program;
    char numbers[64];
    bough_mix(&hash, &c->files, sizeof c->files);
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
    const bough_node *at = bough_node_find(s->node, "from");
    bough_study_tell(&(bough_error){at->file, at->line, at->column, "from", text}, c->scene, at, errors);
}

static bough_status check_case(bough_arena *arena, bough_load_set *s, int i, uint64_t program,
                               bough_file_sums *sums, bough_errors *errors) {
    bough_arena *own = bough_arena_child(arena);
    bough_errors found = {.arena = own};
    bough_load_case *c = &s->cases[i];
    bough_scene *scene;
    bough_status status = bough_scene_read(own, c->scene, c->set, c->n_set, &found, &scene);
    for (int k = 0; k < found.n; k++)
        bough_study_tell(&found.item[k], c->scene, origin(s, c, &found.item[k]), errors);
    if (status.code == BOUGH_INVALID) status = bough_ok();
    if (scene) {
        c->files = BOUGH_FINGERPRINT_START;
        bough_mix_scene(&c->files, sums, scene);
        c->fingerprint = fingerprint(s, c, program);
        check_from(s, scene, c, errors);
    }
    bool first = i == 0 || c->group != s->cases[i - 1].group;
    if (scene && first && errors->n == 0) status = check_channels(arena, own, s, scene, errors);
    bough_arena_destroy(own);
    return status;
}

bough_status bough_load_set_check(bough_arena *arena, bough_load_set *s, bough_errors *errors) {
    uint64_t program = BOUGH_FINGERPRINT_START;
    bough_file_sums sums = {.arena = arena};
    bough_mix_program(&program);
    bough_status status = bough_ok();
    for (int i = 0; i < s->n_case && bough_is_ok(&status) && errors->dropped == 0; i++)
        status = check_case(arena, s, i, program, &sums, errors);
    return status;
}

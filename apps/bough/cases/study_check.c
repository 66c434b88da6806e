// What cannot be seen in the study file alone: whether the scene takes every replacement, whether
// all runs share their output times, and whether the channels exist. Found before the first run,
// since the last one may start hours later.
#include "apps/bough/cases/study_internal.h"

#include "apps/bough/config/schema.h"
#include "apps/bough/scene/fingerprint.h"
#include "apps/bough/model/build.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// -- fingerprint ----------------------------------------------------------------------------------

static void mix_measure(uint64_t *hash, const bough_study_measure *m) {
    char numbers[80];
    for (int i = 0; i < m->channels.n; i++) {
        for (int k = 0; k < m->channels.item[i].n; k++) bough_mix_text(hash, m->channels.item[i].channel[k]);
        bough_mix_text(hash, "");
    }
    snprintf(numbers, sizeof numbers, "%d %.17g", m->norm, m->scale);
    bough_mix_text(hash, numbers);
}

// The title and the grid's values are not in it: a grid may grow and keeps what was run. The
// program is, where the system shows it: results of another one are not to be mixed in.
static uint64_t fingerprint(const bough_study *s) {
    uint64_t hash = BOUGH_FINGERPRINT_START;
    char numbers[80];
    bough_mix_program(&hash);
    for (int i = 0; i < s->reference_cell->n_set; i++) bough_mix_text(&hash, s->reference_cell->set[i]);
    for (int i = 0; i < s->common.n; i++) bough_mix_text(&hash, s->common.item[i].set);
    for (int i = 0; i < s->grid.n; i++) bough_mix_text(&hash, s->grid.axis[i].key);
    for (int i = 0; i < s->n_measure; i++) mix_measure(&hash, &s->measure[i]);
    // of a stability study they are groups side by side
    snprintf(numbers, sizeof numbers, "%d %d", s->repeat, s->kind == BOUGH_STUDY_STABILITY ? 0 : s->threads);
    bough_mix_text(&hash, numbers);
    return hash;
}

// -- scenes ---------------------------------------------------------------------------------------

// Whether an error in a scene speaks of this replacement: its path is the key, or the key's parent
// when the key itself is unknown and therefore named in the text.
static bool concerns(const bough_error *e, const bough_study_setting *setting) {
    if (strcmp(e->path, setting->key) == 0) return true;
    char word[96];
    const char *dot = strrchr(setting->key, '.');
    snprintf(word, sizeof word, "'%.80s'", dot ? dot + 1 : setting->key);
    size_t parent = dot ? (size_t)(dot - setting->key) : 0;
    return strlen(e->path) == parent && strncmp(e->path, setting->key, parent) == 0 &&
           strstr(e->text, word) != NULL;
}

const bough_study_setting *bough_study_concerned(const bough_study_settings *settings, const bough_error *e) {
    for (int i = 0; i < settings->n; i++) {
        if (concerns(e, &settings->item[i])) return &settings->item[i];
    }
    return NULL;
}

const bough_study_setting *bough_study_concerned_value(const bough_study_grid *grid, const int *index,
                                                       const bough_error *e) {
    for (int i = 0; i < grid->n; i++) {
        const bough_study_setting *value = &grid->axis[i].value.item[index[i]];
        if (concerns(e, value)) return value;
    }
    return NULL;
}

static bool is_reported(const bough_errors *errors, const bough_node *at, const bough_error *e) {
    for (int i = 0; i < errors->n; i++) {
        const bough_error *old = &errors->item[i];
        if (old->line == at->line && old->column == at->column && strcmp(old->file, at->file) == 0 &&
            strcmp(old->path, e->path) == 0 && strcmp(old->text, e->text) == 0) {
            return true;
        }
    }
    return false;
}

void bough_study_tell(const bough_error *e, const char *scene, const bough_node *origin,
                      bough_errors *errors) {
    bough_node where = {.file = e->file, .line = e->line, .column = e->column};
    if (e->line == 0 && strcmp(e->file, scene) != 0) where = *origin;
    if (!is_reported(errors, &where, e)) bough_errors_add(errors, &where, e->path, "%s", e->text);
}

// Where the study says what the error in the cell's scene is about.
static const bough_node *origin(const bough_study *s, const bough_study_cell *cell, const bough_error *e) {
    bool reference = cell->index[0] < 0;
    const bough_study_setting *found = reference ? bough_study_concerned(&s->reference, e)
                                                 : bough_study_concerned_value(&s->grid, cell->index, e);
    if (!found) found = bough_study_concerned(&s->common, e);
    return found ? found->node : bough_node_find(s->node, reference ? "reference" : "grid");
}

static bough_scene *read_scene(bough_arena *arena, const bough_study *s, const bough_study_cell *cell,
                               bough_errors *errors) {
    bough_errors own = {.arena = arena};
    bough_scene *scene;
    bough_scene_read(arena, s->scene, cell->set, cell->n_set, &own, &scene);
    for (int i = 0; i < own.n; i++)
        bough_study_tell(&own.item[i], s->scene, origin(s, cell, &own.item[i]), errors);
    return scene;
}

static void check_times(const bough_study *s, const bough_study_cell *cell, const bough_scene_simulation *sim,
                        bough_errors *errors) {
    const bough_node *grid = bough_node_find(s->node, "grid");
    if (fabs(sim->output.interval - s->interval) > 1e-9 * s->interval) {
        bough_errors_add(errors, grid, "grid",
                         "%s: records every %.9g s, the reference every %.9g s; "
                         "set simulation.output.interval in 'common'",
                         cell->settings, sim->output.interval, s->interval);
    }
    if (fabs(sim->duration - s->duration) > 1e-9 * s->duration) {
        bough_errors_add(errors, grid, "grid", "%s: lasts %.9g s, the reference %.9g s", cell->settings,
                         sim->duration, s->duration);
    }
}

static void check_cell(bough_study *s, bough_study_cell *cell, bool times, bough_file_sums *sums,
                       bough_errors *errors) {
    bough_arena *arena = bough_arena_child(errors->arena);
    const bough_scene *scene = read_scene(arena, s, cell, errors);
    if (scene && times) check_times(s, cell, &scene->simulation, errors);
    if (scene) {
        cell->files = BOUGH_FINGERPRINT_START;
        bough_mix_scene(&cell->files, sums, scene);
    }
    bough_arena_destroy(arena);
}

// Of the references the first says the times.
static void check_cells(bough_study *s, bool times, bough_errors *errors) {
    bough_file_sums sums = {.arena = errors->arena};
    for (int i = 0; i < s->n_reference && errors->dropped == 0; i++)
        check_cell(s, &s->reference_cell[i], false, &sums, errors);
    for (int i = 0; i < s->n_cell && errors->dropped == 0; i++)
        check_cell(s, &s->cell[i], times, &sums, errors);
}

// -- channels -------------------------------------------------------------------------------------

void bough_study_unknown_channel(const bough_channels *channels, const char *name, const bough_node *node,
                                 const char *key, bough_errors *errors) {
    const char **names = bough_arena_take(errors->arena, (size_t)(channels->count + 1) * sizeof *names);
    for (int i = 0; i < channels->count; i++) names[i] = channels->channel[i].name;
    bough_errors_add(errors, node, key, "the scene has no channel '%.80s'%s", name,
                     bough_suggest(name, names, channels->count).text);
}

static void check_unit(bough_study_measure *m, const bough_channel *channel, bough_arena *arena,
                       bough_errors *errors) {
    if (!m->unit) m->unit = bough_arena_string(arena, channel->unit);
    if (bough_node_find(m->node, "scale") || !m->unit || strcmp(m->unit, channel->unit) == 0) return;
    bough_errors_add(errors, m->node, "measures", "channel %s is in %s, not %s: give a 'scale'",
                     channel->name, channel->unit, m->unit);
}

static int count_channels(const bough_study *s) {
    int n = 0;
    for (int i = 0; i < s->n_measure; i++) {
        for (int k = 0; k < s->measure[i].channels.n; k++) n += s->measure[i].channels.item[k].n;
    }
    return n;
}

static void check_vector(bough_study *s, bough_study_measure *m, const bough_study_vector *vector,
                         const bough_channels *channels, bough_errors *errors) {
    for (int i = 0; i < vector->n; i++) {
        int k = bough_channels_find(channels, vector->channel[i]);
        if (k < 0) {
            bough_study_unknown_channel(channels, vector->channel[i], m->node, "measures", errors);
        } else {
            check_unit(m, &channels->channel[k], errors->arena, errors);
        }
        s->channel[s->n_channel++] = vector->channel[i];
    }
}

static bough_status check_channels(bough_arena *arena, bough_study *s, const bough_scene *scene,
                                   bough_errors *errors) {
    bough_simulation *simulation;
    bough_status status = bough_simulation_build(arena, scene, &simulation);
    if (!bough_is_ok(&status)) return status;
    bough_channels channels = bough_channels_start(arena);
    status = bough_simulation_channels(simulation, &channels);
    for (int i = 0; i < s->n_measure && bough_is_ok(&status); i++) {
        for (int k = 0; k < s->measure[i].channels.n; k++)
            check_vector(s, &s->measure[i], &s->measure[i].channels.item[k], &channels, errors);
    }
    return status;
}

bough_status bough_study_check(bough_arena *arena, bough_study *s, bough_errors *errors) {
    assert(errors->arena == arena);
    if (!s->reference_cell) return bough_ok(); // the caller sees the error of the grid
    s->channel = bough_arena_take(arena, (size_t)count_channels(s) * sizeof *s->channel);
    bough_arena *own = bough_arena_child(arena);
    bough_status status = bough_ok();
    const bough_scene *scene = read_scene(own, s, s->reference_cell, errors);
    if (scene) {
        s->duration = scene->simulation.duration;
        s->interval = scene->simulation.output.interval;
        s->fingerprint = fingerprint(s);
        status = check_channels(own, s, scene, errors);
    }
    bough_arena_destroy(own);
    if (bough_is_ok(&status)) check_cells(s, scene != NULL, errors);
    return status;
}

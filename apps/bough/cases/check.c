// Checks that need the scenes: whether every scene is valid with its replacements and has the channels, and
// whether compared runs have common output times. All are made before the first run, since the last one may
// start hours later.
#include "apps/bough/cases/study.h"

#include "aero/wind/wind_iec.h"
#include "apps/bough/config/schema.h"
#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/scene/scene_files.h"

// -- fingerprint ----------------------------------------------------------------------------------

// Adds what the study records of each run.
static void mix_question(uint64_t *hash, const bough_study *s) {
    const double numbers[] = {s->repeat, s->is.parallel ? 0 : s->threads, s->from, s->is.weighted, s->series};
    bough_mix(hash, numbers, sizeof numbers);
    for (int i = 0; i < s->n_measure; i++) {
        const bough_study_vectors *v = &s->measure[i].channels;
        for (int k = 0; k < v->n_channel; k++) bough_mix_text(hash, v->channel[k]);
        bough_mix(hash, v->end, (size_t)v->n_vector * sizeof *v->end);
        bough_mix(hash, &s->measure[i].norm, sizeof s->measure[i].norm);
        bough_mix(hash, &s->measure[i].scale, sizeof s->measure[i].scale);
    }
    for (int i = 0; i < s->n_wanted; i++) bough_mix_text(hash, s->wanted[i]);
    if (s->n_slope > 0) bough_mix(hash, s->slope, (size_t)s->n_slope * sizeof *s->slope);
}

// Adds what defines the run. The text of the settings distinguishes a reference from a cell with the same
// replacements.
static void mix_run(uint64_t *hash, const bough_case *c) {
    bough_mix(hash, &c->files, sizeof c->files);
    for (int i = 0; i < c->n_set; i++) bough_mix_text(hash, c->set[i]);
    bough_mix_text(hash, c->settings);
}

// -- scenes ---------------------------------------------------------------------------------------

// Whether an error in a scene concerns this replacement: it is at the key, or, for an unknown key, at the
// key's parent and names it.
static bool concerns(const bough_error *e, const bough_study_setting *setting) {
    if (strcmp(e->path, setting->key) == 0) return true;
    char word[96];
    const char *dot = strrchr(setting->key, '.');
    snprintf(word, sizeof word, "'%.80s'", dot ? dot + 1 : setting->key);
    size_t parent = dot ? (size_t)(dot - setting->key) : 0;
    return strlen(e->path) == parent && strncmp(e->path, setting->key, parent) == 0 &&
           strstr(e->text, word) != NULL;
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

// Adds an error of a run's scene, once for all runs that have it. An error in a replacement is placed at
// `origin`, where the study has it.
static void report(const bough_error *e, const char *scene, const bough_node *origin, bough_errors *errors) {
    bough_node where = {.file = e->file, .line = e->line, .column = e->column};
    if (e->line == 0 && strcmp(e->file, scene) != 0) where = *origin;
    if (!is_reported(errors, &where, e)) bough_errors_add(errors, &where, e->path, "%s", e->text);
}

// Where the study has the replacement that an error in the case's scene concerns; of one key the last.
static const bough_node *origin(const bough_study *s, const bough_case *c, const bough_error *e) {
    for (int i = c->n_set - 1; i >= 0; i--)
        if (c->setting[i] && concerns(e, c->setting[i])) return c->setting[i]->node;
    if (!s->is.compared) return s->group[c->group].node;
    return bough_node_find(s->node, bough_is_reference(s, c) ? "reference" : "grid");
}

// -- channels -------------------------------------------------------------------------------------

static void add_unknown(const bough_channels *channels, const char *name, const bough_node *node,
                        const char *key, bough_errors *errors) {
    const char *const *names = bough_channels_names(channels, errors->arena);
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

static void check_measures(bough_arena *arena, bough_study *s, const bough_channels *channels,
                           bough_errors *errors) {
    int n = 0;
    for (int i = 0; i < s->n_measure; i++) n += s->measure[i].channels.n_channel;
    s->channel = bough_arena_take(arena, (size_t)n * sizeof *s->channel);
    for (int i = 0; i < s->n_measure; i++) {
        bough_study_measure *m = &s->measure[i];
        for (int k = 0; k < m->channels.n_channel; k++) {
            const char *name = s->channel[s->n_channel++] = m->channels.channel[k];
            int found = bough_channels_find(channels, name);
            if (found < 0)
                add_unknown(channels, name, m->node, "measures", errors);
            else
                check_unit(m, &channels->channel[found], arena, errors);
        }
    }
}

static void keep_channels(bough_arena *arena, bough_study *s, const bough_channels *channels) {
    bool all = s->n_wanted == 0;
    s->n_channel = all ? channels->count : s->n_wanted;
    s->channel = bough_arena_take(arena, (size_t)s->n_channel * sizeof *s->channel);
    s->unit = bough_arena_take(arena, (size_t)s->n_channel * sizeof *s->unit);
    s->load = bough_arena_take(arena, (size_t)s->n_channel * sizeof *s->load);
    for (int i = 0; i < s->n_channel; i++) {
        int k = all ? i : bough_channels_find(channels, s->wanted[i]);
        s->channel[i] = bough_arena_string(arena, channels->channel[k].name);
        s->unit[i] = bough_arena_string(arena, channels->channel[k].unit);
        s->load[i] = channels->channel[k].load;
    }
}

// The first scene's channels are the study's where it names none.
static void check_wanted(bough_arena *arena, bough_study *s, const bough_channels *channels,
                         bough_errors *errors) {
    for (int i = 0; i < s->n_wanted; i++) {
        if (bough_channels_find(channels, s->wanted[i]) < 0)
            add_unknown(channels, s->wanted[i], bough_node_find(s->node, "channels"), "channels", errors);
    }
    if (errors->n == 0 && !s->channel) keep_channels(arena, s, channels);
}

static bough_status check_channels(bough_arena *arena, bough_arena *own, bough_study *s,
                                   const bough_scene *scene, bough_errors *errors) {
    bough_simulation *simulation;
    BOUGH_TRY(bough_simulation_build(own, scene, &simulation));
    bough_channels channels = bough_channels_start(own);
    BOUGH_TRY(bough_simulation_channels(simulation, &channels));
    if (s->is.compared)
        check_measures(arena, s, &channels, errors);
    else
        check_wanted(arena, s, &channels, errors);
    return bough_ok();
}

// -- times ----------------------------------------------------------------------------------------

static void check_times(const bough_study *s, const bough_case *c, const bough_scene_simulation *sim,
                        bough_errors *errors) {
    const bough_node *grid = bough_node_find(s->node, "grid");
    if (fabs(sim->output.interval - s->interval) > 1e-9 * s->interval) {
        bough_errors_add(errors, grid, "grid",
                         "%s: records every %.9g s, the reference every %.9g s; "
                         "set simulation.output.interval in 'common'",
                         c->settings, sim->output.interval, s->interval);
    }
    if (fabs(sim->duration - s->duration) > 1e-9 * s->duration) {
        bough_errors_add(errors, grid, "grid", "%s: lasts %.9g s, the reference %.9g s", c->settings,
                         sim->duration, s->duration);
    }
}

static void check_from(const bough_study *s, const bough_scene *scene, const bough_case *c,
                       bough_errors *errors) {
    if (s->from < scene->simulation.duration) return;
    char text[200];
    snprintf(text, sizeof text, "%g s is not before the end, %g s, of %.100s", s->from,
             scene->simulation.duration, c->scene);
    const bough_node *at = bough_node_find(s->node, "from");
    report(&(bough_error){at->file, at->line, at->column, "from", text}, c->scene, at, errors);
}

// -- cases ----------------------------------------------------------------------------------------

typedef struct turbulence {
    bough_wind_iec_def def;
    bough_case *last; // the last case with it so far
} turbulence;

typedef struct check {
    bough_study *study;
    int n_turbulence;
    turbulence *turbulence; // (n_case) the first n_turbulence
    uint64_t program;       // fingerprint
    bough_file_sums sums;
    bough_errors *errors;
} check;

// Duration and interval are those of the first reference.
static void check_duration(const check *k, const bough_case *c, const bough_scene *scene) {
    bough_study *s = k->study;
    if (c == s->reference_case) {
        s->duration = scene->simulation.duration;
        s->interval = scene->simulation.output.interval;
    } else if (!s->is.compared) {
        check_from(s, scene, c, k->errors);
    } else if (s->duration > 0 && !bough_is_reference(s, c)) {
        check_times(s, c, &scene->simulation, k->errors);
    }
}

// Neither the title nor the other values of the grid count, so that a grid may grow and keeps its results.
// The program counts, where the system gives access to it: results of different programs are not mixed.
static void take_fingerprint(check *k, bough_case *c, const bough_scene *scene) {
    c->files = BOUGH_FINGERPRINT_START;
    bough_mix_scene(&c->files, &k->sums, scene);
    c->fingerprint = k->program;
    mix_question(&c->fingerprint, k->study);
    if (k->study->is.compared) mix_run(&c->fingerprint, &k->study->reference_case[c->reference]);
    mix_run(&c->fingerprint, c);
}

static void link_turbulence(check *k, bough_case *c, const bough_scene *scene) {
    bough_wind_iec_def def;
    if (k->study->is.compared || !bough_aero_link_turbulence(scene, &def)) return;
    for (int i = 0; i < k->n_turbulence; i++) {
        turbulence *t = &k->turbulence[i];
        if (!bough_turbulence_equal(&t->def, &def)) continue;
        t->last->next = (int)(c - k->study->cases);
        t->last = c;
        c->follows = true;
        return;
    }
    k->turbulence[k->n_turbulence++] = (turbulence){def, c};
}

// The channels are looked up in the first reference's scene, or in that of the first case of each group.
static bough_status check_case(bough_arena *arena, check *k, bough_case *c, bool channels) {
    bough_study *s = k->study;
    bough_arena *own = bough_arena_child(arena);
    bough_errors found = {.arena = own};
    bough_scene *scene;
    bough_status status = bough_scene_read(own, s->files, c->scene, c->set, c->n_set, &found, &scene);
    for (int i = 0; i < found.n; i++)
        report(&found.item[i], c->scene, origin(s, c, &found.item[i]), k->errors);
    if (status.code == BOUGH_INVALID) status = bough_ok();
    if (scene) {
        take_fingerprint(k, c, scene);
        link_turbulence(k, c, scene);
        check_duration(k, c, scene);
    }
    if (scene && channels && k->errors->n == 0) status = check_channels(arena, own, s, scene, k->errors);
    bough_arena_destroy(own);
    return status;
}

bough_status bough_study_check(bough_arena *arena, bough_study *s, bough_errors *errors) {
    assert(errors->arena == arena);
    check k = {.study = s, .program = BOUGH_FINGERPRINT_START, .sums = {.arena = arena}, .errors = errors};
    k.turbulence = bough_arena_take(arena, (size_t)s->n_case * sizeof *k.turbulence);
    s->files = bough_arena_take(arena, sizeof *s->files);
    s->files->arena = arena;
    for (int i = 0; i < s->n_case; i++) s->cases[i].next = -1;
    bough_mix_program(&k.program);
    bough_status status = bough_ok();
    for (int i = 0; i < s->n_reference && bough_is_ok(&status) && errors->dropped == 0; i++)
        status = check_case(arena, &k, &s->reference_case[i], i == 0);
    for (int i = 0; i < s->n_case && bough_is_ok(&status) && errors->dropped == 0; i++) {
        bool first = i == 0 || s->cases[i].group != s->cases[i - 1].group;
        status = check_case(arena, &k, &s->cases[i], first && !s->is.compared);
    }
    s->files->complete = true;
    return status;
}

// The keys of a study and their reading.
#include "apps/bough/cases/study.h"

#include "apps/bough/cases/load_set.h"
#include "apps/bough/cases/study_internal.h"
#include "apps/bough/config/schema_keys.h"
#include "core/base/input_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// -- replacements ---------------------------------------------------------------------------------

// A value in one line: 'text', [1, 2], {a: [1, 2]}. False when it is deeper than the stack of calls
// should be.
static bool put_flow(FILE *f, const bough_node *value) {
    enum { DEEPEST = 8 };
    if (value->height > DEEPEST) return false;
    if (value->kind == BOUGH_SCALAR) {
        if (value->quoted) fputc('\'', f);
        for (const char *c = value->text; *c; c++) {
            if (value->quoted && *c == '\'') fputc('\'', f);
            fputc(*c, f);
        }
        if (value->quoted) fputc('\'', f);
        return true;
    }
    bool mapping = value->kind == BOUGH_MAPPING;
    fputc(mapping ? '{' : '[', f);
    for (int i = 0; i < value->n; i++) {
        if (i) fputs(", ", f);
        if (mapping) fprintf(f, "%s: ", value->key[i]->text);
        if (!put_flow(f, value->value[i])) return false;
    }
    fputc(mapping ? '}' : ']', f);
    return true;
}

static const char *write_flow(bough_arena *arena, const bough_node *value) {
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (!f) return NULL;
    bool whole = put_flow(f, value);
    fclose(f);
    const char *kept = whole ? bough_arena_string(arena, text) : NULL;
    free(text);
    return kept;
}

// A value that was quoted is quoted again in the replacement, so that it stays what it is.
static void read_setting(bough_schema_reader *r, const char *key, const bough_node *value,
                         bough_study_setting *setting) {
    char shown[64];
    const char *flow = write_flow(r->arena, value), *text = value->kind == BOUGH_SCALAR ? value->text : flow;
    if (!flow || text[0] == '\0') {
        bough_schema_error(r, value, key, "expected one value, got %s", bough_node_shown(value, shown));
        return;
    }
    size_t size = strlen(key) + strlen(flow) + 2;
    char *set = bough_arena_take(r->arena, size);
    snprintf(set, size, "%s=%s", key, flow);
    *setting = (bough_study_setting){value, key, text, set};
}

static bool is_mapping(bough_schema_reader *r, const bough_node *node, const char *what) {
    char shown[64];
    if (node->kind == BOUGH_MAPPING && node->n > 0) return true;
    bough_schema_error(r, node, "", "expected %s, got %s", what, bough_node_shown(node, shown));
    return false;
}

void bough_study_read_settings(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_study_settings *settings = field;
    if (!is_mapping(r, node, "keys of the scene with their values")) return;
    settings->item = bough_arena_take(r->arena, (size_t)node->n * sizeof *settings->item);
    settings->n = node->n;
    for (int i = 0; i < node->n; i++) read_setting(r, node->key[i]->text, node->value[i], &settings->item[i]);
}

// -- grid -----------------------------------------------------------------------------------------

// A value given twice would be run twice and count double.
static void check_different(bough_schema_reader *r, const bough_study_axis *axis) {
    const bough_study_settings *value = &axis->value;
    for (int i = 1; i < value->n; i++) {
        for (int k = 0; k < i && value->item[i].value && value->item[k].value; k++) {
            if (strcmp(value->item[i].value, value->item[k].value) != 0) continue;
            bough_schema_error(r, value->item[i].node, axis->key, "'%.80s' is given twice",
                               value->item[i].value);
            return;
        }
    }
}

static void read_axis(bough_schema_reader *r, const bough_node *key, const bough_node *values,
                      bough_study_axis *axis) {
    char shown[64];
    *axis = (bough_study_axis){.node = key, .key = key->text, .label = key->text};
    if (values->kind != BOUGH_SEQUENCE || values->n == 0) {
        bough_schema_error(r, values, key->text, "expected a list of values, got %s",
                           bough_node_shown(values, shown));
        return;
    }
    axis->value.item = bough_arena_take(r->arena, (size_t)values->n * sizeof *axis->value.item);
    axis->value.n = values->n;
    for (int i = 0; i < values->n; i++) read_setting(r, key->text, values->value[i], &axis->value.item[i]);
    check_different(r, axis);
}

static bool ends_with(const char *text, const char *end) {
    size_t length = strlen(text), n = strlen(end);
    return n <= length && strcmp(text + length - n, end) == 0;
}

// The last part of the key, or as many parts as tell it from the other axes' keys.
static const char *short_label(const bough_study_grid *grid, int axis) {
    const char *key = grid->axis[axis].key;
    for (const char *label = key + strlen(key); label > key; label--) {
        bool unique = label[-1] == '.' && *label;
        for (int i = 0; unique && i < grid->n; i++)
            unique = i == axis || !ends_with(grid->axis[i].key, label);
        if (unique) return label;
    }
    return key;
}

void bough_study_read_grid(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_study_grid *grid = field;
    if (!is_mapping(r, node, "keys of the scene, each with a list of values")) return;
    if (node->n > BOUGH_STUDY_AXES) {
        bough_schema_error(r, node, "", "expected at most %d keys, got %d", BOUGH_STUDY_AXES, node->n);
        return;
    }
    grid->axis = bough_arena_take(r->arena, (size_t)node->n * sizeof *grid->axis);
    grid->n = node->n;
    for (int i = 0; i < node->n; i++) read_axis(r, node->key[i], node->value[i], &grid->axis[i]);
    for (int i = 0; i < node->n; i++) grid->axis[i].label = short_label(grid, i);
}

// -- measures -------------------------------------------------------------------------------------

static const char channels_form[] = "[A, B, C], or several such lists";

static void read_vector(bough_schema_reader *r, const bough_node *node, bough_study_vector *vector) {
    char shown[64];
    if (node->kind != BOUGH_SEQUENCE || node->n == 0) {
        bough_schema_error(r, node, "", "expected %s, got %s", channels_form,
                           node->kind == BOUGH_SEQUENCE ? "an empty list" : bough_node_shown(node, shown));
        return;
    }
    vector->channel = bough_arena_take(r->arena, (size_t)node->n * sizeof *vector->channel);
    vector->n = node->n;
    for (int i = 0; i < node->n; i++) {
        const bough_node *name = node->value[i];
        vector->channel[i] = name->kind == BOUGH_SCALAR ? name->text : "";
        if (vector->channel[i][0] != '\0') continue;
        bough_schema_error(r, name, "", "expected a channel's name, got %s", bough_node_shown(name, shown));
    }
}

static void read_channels(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_study_vectors *vectors = field;
    bool nested = node->kind == BOUGH_SEQUENCE && node->n > 0 && node->value[0]->kind == BOUGH_SEQUENCE;
    int n = nested ? node->n : 1;
    vectors->item = bough_arena_take(r->arena, (size_t)n * sizeof *vectors->item);
    vectors->n = n;
    for (int i = 0; i < n; i++) read_vector(r, nested ? node->value[i] : node, &vectors->item[i]);
}

static void check_measure(bough_schema_reader *r, void *item) {
    bough_study_measure *m = item;
    bool several = m->channels.n > 0;
    if ((m->channel != NULL) == several) {
        bough_schema_error(r, m->node, "", "expected one of 'channel' and 'channels'");
    }
    if (bough_node_find(m->node, "scale") && !m->unit) {
        bough_schema_error(r, m->node, "scale", "needs a 'unit': of the scaled difference");
    }
    if (several || !m->channel) return;
    m->channels.item = bough_arena_take(r->arena, sizeof *m->channels.item);
    const char **names = bough_arena_take(r->arena, sizeof *names);
    names[0] = m->channel;
    m->channels.item[0] = (bough_study_vector){1, names};
    m->channels.n = 1;
}

// -- keys -----------------------------------------------------------------------------------------

// One line a key would become one line a field:
// clang-format off
#define FILLS bough_study_measure
static const bough_key measure_keys[] = {
    {KEY(TEXT, name), .required = true, .help = "heading of its column"},
    {KEY(TEXT, channel), .help = "name of a channel"},
    {KEY(CUSTOM, channels), .read = read_channels, .form = channels_form,
     .help = "components of a vector; of several vectors the largest difference counts"},
    {KEY(CHOICE, norm), CHOICES("euclid", "largest"), .fallback = "euclid",
     .help = "norm of a vector"},
    {KEY(NUMBER, scale), .range = "> 0", .fallback = "1",
     .help = "factor from the channels' unit to 'unit'"},
    {KEY(TEXT, unit), .help = "unit of the difference after scaling; default the channels' unit"},
};
#undef FILLS
static const bough_schema measure_schema = {
    SCHEMA("a measure", bough_study_measure, measure_keys), .check = check_measure};

#define FILLS bough_study
static const bough_key study_keys[] = {
    {KEY(TEXT, title), .help = "one line of description"},
    {NAMED("scene", TEXT), AT(scene_name), .required = true,
     .help = "file of the scene, relative to the study"},
    {KEY(CHOICE, kind), CHOICES("work-precision", "timing", "stability", "sweep", "load-set"),
     .required = true,
     .help = "work-precision: time and error of every cell of the grid against one reference; "
             "timing: cost of the cells, measured in turns; stability: table of errors and "
             "diagnoses, each cell against a reference with the same model parameters; sweep: "
             "statistics of every cell; load-set: lifetime loads of weighted cases (both: "
             "docs/loads.md)"},
    {KEY(CUSTOM, reference), .read = bough_study_read_settings, .required = true,
     .form = "{KEY: VALUE, ...}", .help = "replaced keys of the reference run"},
    {KEY(CUSTOM, grid), .read = bough_study_read_grid, .required = true,
     .form = "{KEY: [VALUE, ...], ...}", .help = "one run for each combination of the values"},
    {KEY(CUSTOM, common), .read = bough_study_read_settings, .form = "{KEY: VALUE, ...}",
     .help = "replaced keys of every run"},
    {NAMED("measures", LIST), AT(measure), .of = &measure_schema, .count = 1, .required = true,
     COUNT_AT(n_measure),
     .help = "largest differences to the reference at the common output times"},
    {KEY(INTEGER, repeat), .range = "[1, 99]", .fallback = "1",
     .help = "number of runs of each cell; times are medians"},
};
#undef FILLS

static void check_study(bough_schema_reader *r, void *item) {
    const bough_study *s = item;
    if (s->n_measure <= BOUGH_STUDY_MEASURES) return;
    bough_schema_error(r, s->measure[BOUGH_STUDY_MEASURES].node, "measures",
                       "expected at most %d, got %d", BOUGH_STUDY_MEASURES, s->n_measure);
}

static const bough_schema study_schema = {
    SCHEMA("a study", bough_study, study_keys), .check = check_study};
// clang-format on

// -- help -----------------------------------------------------------------------------------------

void bough_study_help(FILE *stream) {
    fputs("# Studies\n\n"
          "A study is a YAML file that names a scene and the runs of that scene. `bough study STUDY` "
          "performs the runs. Keys in\nbraces are keys of the scene, written as for `--set`; values "
          "are written as in scenes. Tutorials:\n[studies](tutorials/study.md), "
          "[load sets](tutorials/loads.md).\n"
          "\n## work-precision, timing, stability\n\n",
          stream);
    bough_schema_help(&study_schema, 0, stream);
    fputs("\n## sweep\n\n", stream);
    bough_schema_help(&bough_sweep_schema, 0, stream);
    fputs("\n## load-set\n\n", stream);
    bough_schema_help(&bough_load_set_schema, 0, stream);
}

void bough_study_json_schema(FILE *stream) {
    const bough_schema *schema[] = {&study_schema, &bough_sweep_schema, &bough_load_set_schema};
    bough_schema_json("A study of bough", schema, 3, stream);
}

// -- reading --------------------------------------------------------------------------------------

const char *bough_study_path(bough_arena *arena, const char *study, const char *scene) {
    const char *slash = scene[0] == '/' ? NULL : strrchr(study, '/');
    int length = slash ? (int)(slash - study) + 1 : 0;
    size_t size = (size_t)length + strlen(scene) + 1;
    char *path = bough_arena_take(arena, size);
    if (path) snprintf(path, size, "%.*s%s", length, study, scene);
    return path;
}

static bool find_scene(bough_arena *arena, bough_study *s, bough_errors *errors) {
    s->scene = bough_study_path(arena, s->file, s->scene_name);
    char why[BOUGH_INPUT_REASON];
    FILE *file = bough_input_open(s->scene, BOUGH_INPUT_TEXT, why);
    if (!file) {
        bough_errors_add(errors, bough_node_find(s->node, "scene"), "scene",
                         "file '%.200s' cannot be read: %s", s->scene, why);
        return false;
    }
    fclose(file);
    return true;
}

static bough_status finish(const char *path, bough_errors *errors) {
    int n = errors->n + errors->dropped;
    if (n == 0) return bough_ok();
    bough_errors_sort(errors, path);
    return bough_fail(BOUGH_INVALID, "%s: %d error%s in the study", path, n, n == 1 ? "" : "s");
}

// A scene is told as such, in place of an error for each of its keys.
static bool is_scene(const char *path, const bough_node *root, bough_errors *errors) {
    const bough_node *bodies = bough_node_find(root, "bodies");
    if (!bodies || bough_node_find(root, "kind")) return false;
    bough_errors_add(errors, bodies, "bodies", "this is a scene, not a study: 'bough run %.200s' runs it",
                     path);
    return true;
}

static bool is_load_set(const bough_node *root) {
    const bough_node *kind = bough_node_find(root, "kind");
    return kind && kind->kind == BOUGH_SCALAR &&
           (strcmp(kind->text, "sweep") == 0 || strcmp(kind->text, "load-set") == 0);
}

// The kinds that have keys of their own.
static bough_status read_load_set(bough_arena *arena, const bough_node *root, bough_errors *errors,
                                  bough_study *s) {
    bough_status status;
    s->load_set = bough_load_set_read(arena, s->file, root, s->threads, errors, &status);
    if (s->load_set) s->kind = s->load_set->sweep ? BOUGH_STUDY_SWEEP : BOUGH_STUDY_LOAD_SET;
    return status;
}

bough_status bough_study_read(bough_arena *arena, const char *path, int threads, bough_errors *errors,
                              bough_study **study) {
    *study = NULL;
    bough_study *s = bough_arena_take(arena, sizeof *s);
    bough_node *root = bough_text_read(arena, path, errors);
    if (!root) return finish(path, errors);
    s->file = bough_arena_string(arena, path);
    s->threads = threads;
    if (is_scene(path, root, errors)) return finish(path, errors);
    if (is_load_set(root)) {
        bough_status status = read_load_set(arena, root, errors, s);
        if (bough_is_ok(&status)) status = finish(path, errors);
        if (bough_is_ok(&status)) *study = s;
        return status;
    }
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = ""};
    bough_schema_read(&reader, &study_schema, root, s);
    bough_status status = finish(path, errors);
    if (!bough_is_ok(&status)) return status;
    if (find_scene(arena, s, errors)) {
        bough_study_expand(arena, s, errors);
        status = bough_study_check(arena, s, errors);
    }
    if (bough_is_ok(&status)) status = finish(path, errors);
    if (bough_is_ok(&status)) *study = s;
    return status;
}

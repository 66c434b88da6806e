// The keys of a study and their reading.
#include "apps/bough/cases/study.h"

#include "apps/bough/cases/counts.h"
#include "apps/bough/config/schema_keys.h"
#include "core/base/input_file.h"

// -- measures -------------------------------------------------------------------------------------

static const char channels_form[] = "[A, B, C], or several such lists";

static void read_vector(bough_schema_reader *r, const bough_node *node, bough_study_vectors *vectors) {
    if (node->kind != BOUGH_SEQUENCE || node->n == 0) bough_schema_expected(r, node, channels_form);
    for (int i = 0; node->kind == BOUGH_SEQUENCE && i < node->n; i++) {
        const bough_node *name = node->value[i];
        const char *text = name->kind == BOUGH_SCALAR ? name->text : "";
        if (text[0] == '\0') bough_schema_expected(r, name, "a channel's name");
        vectors->channel[vectors->n_channel++] = text;
    }
    vectors->end[vectors->n_vector++] = vectors->n_channel;
}

static void take_vectors(bough_arena *arena, int n_channel, int n_vector, bough_study_vectors *vectors) {
    vectors->channel = bough_arena_take(arena, (size_t)n_channel * sizeof *vectors->channel);
    vectors->end = bough_arena_take(arena, (size_t)n_vector * sizeof *vectors->end);
}

static void read_channels(bough_schema_reader *r, const bough_node *node, void *field) {
    bool nested = node->kind == BOUGH_SEQUENCE && node->n > 0 && node->value[0]->kind == BOUGH_SEQUENCE;
    int n_vector = nested ? node->n : 1, n_channel = nested ? 0 : node->n;
    for (int i = 0; nested && i < n_vector; i++) n_channel += node->value[i]->n;
    take_vectors(r->arena, n_channel, n_vector, field);
    for (int i = 0; i < n_vector; i++) read_vector(r, nested ? node->value[i] : node, field);
}

static void check_measure(bough_schema_reader *r, void *item) {
    bough_study_measure *m = item;
    bool several = m->channels.n_vector > 0;
    if ((m->channel != NULL) == several) {
        bough_schema_error(r, m->node, "", "expected one of 'channel' and 'channels'");
    }
    if (bough_node_find(m->node, "scale") && !m->unit) {
        bough_schema_error(r, m->node, "scale", "needs a 'unit': of the scaled difference");
    }
    if (several || !m->channel) return;
    take_vectors(r->arena, 1, 1, &m->channels);
    m->channels.channel[0] = m->channel;
    m->channels.n_channel = m->channels.n_vector = m->channels.end[0] = 1;
}

// -- keys -----------------------------------------------------------------------------------------

// clang-format would give each field of a key a line of its own:
// clang-format off
#define SETTINGS .read = bough_study_read_settings, .form = "{KEY: VALUE, ...}"
#define GRID     .read = bough_study_read_grid, .form = "{KEY: [VALUE, ...], ...}"
#define FILLS bough_study_measure
static const bough_schema measure_schema = {.name = "a measure", .check = check_measure, KEYS(
    {KEY(TEXT, name), .required = true, .help = "heading of its column"},
    {KEY(TEXT, channel), .help = "name of a channel"},
    {KEY(CUSTOM, channels), .read = read_channels, .form = channels_form,
     .help = "components of a vector; of several vectors the largest difference counts"},
    {KEY(CHOICE, norm),
     CHOICES([BOUGH_STUDY_EUCLID] = "euclid", [BOUGH_STUDY_LARGEST] = "largest"),
     .fallback = "euclid",
     .help = "norm of a vector"},
    {KEY(NUMBER, scale), .range = "> 0", .fallback = "1",
     .help = "factor from the channels' unit to 'unit'"},
    {KEY(TEXT, unit), .help = "unit of the difference after scaling; default the channels' unit"},
)};
#undef FILLS

static void check_study(bough_schema_reader *r, void *item) {
    const bough_study *s = item;
    if (s->n_measure <= BOUGH_STUDY_MEASURES) return;
    bough_schema_error(r, s->measure[BOUGH_STUDY_MEASURES].node, "measures",
                       "expected at most %d, got %d", BOUGH_STUDY_MEASURES, s->n_measure);
}

#define FILLS bough_study
static const bough_schema study_schema = {.name = "a study", .check = check_study, KEYS(
    {KEY(TEXT, title), .help = "one line of description"},
    {NAMED("scene", TEXT), AT(scene_name), .required = true,
     .help = "file of the scene, relative to the study"},
    {KEY(CHOICE, kind), CHOICES("work-precision", "timing", "stability", "sweep", "load-set"),
     .required = true,
     .help = "work-precision: time and error of every cell of the grid against one reference; "
             "timing: cost of the cells, measured alternately; stability: table of errors and "
             "diagnoses, each cell against a reference with the same model parameters; sweep: "
             "statistics of every cell; load-set: lifetime loads of weighted cases (both: docs/loads.md)"},
    {KEY(CUSTOM, reference), SETTINGS, .required = true, .help = "replaced keys of the reference run"},
    {KEY(CUSTOM, grid), GRID, .required = true, .help = "one run for each combination of the values"},
    {KEY(CUSTOM, common), SETTINGS, .help = "replaced keys of every run"},
    {NAMED("measures", LIST), AT(measure), .of = &measure_schema, .count = 1, .required = true,
     COUNT_AT(n_measure),
     .help = "largest differences to the reference at the common output times"},
    {KEY(INTEGER, repeat), .range = "[1, 99]", .fallback = "1",
     .help = "number of runs of each cell; times are medians"},
)};
#undef FILLS

static void read_companions(bough_schema_reader *r, const bough_node *node, void *field) {
    const char *text = node->kind == BOUGH_SCALAR ? node->text : "";
    int *every = field;
    if (strcmp(text, "none") == 0) {
        *every = 0;
    } else if (strcmp(text, "all") == 0) {
        *every = 1;
    } else if (strncmp(text, "1 in ", 5) != 0 || !bough_whole_number(text + 5, every) || *every < 1) {
        bough_schema_expected(r, node, "'1 in N' with a whole number N, 'all' or 'none'");
    }
}

static void check_group(bough_schema_reader *r, void *item) {
    const bough_load_group *g = item;
    if ((g->weibull > 0) + (g->hours > 0) + (g->events > 0) > 1) {
        bough_schema_error(r, g->node, "", "expected at most one of 'weibull', 'hours', 'events'");
    }
}

#define FILLS bough_load_group
static const bough_schema group_schema = {.name = "a load case", .check = check_group, KEYS(
    {KEY(TEXT, name), .required = true, .example = "DLC1.2", .help = "name of the load case"},
    {NAMED("scene", TEXT), AT(scene_name), .example = "parked.yaml",
     .help = "scene of this load case; replaces the set's"},
    {KEY(CUSTOM, set), SETTINGS, .help = "replaced keys of its cases"},
    {KEY(CUSTOM, grid), GRID, .help = "one case for each combination of the values; default one case"},
    {KEY(NUMBER, weibull), .range = "[0, 1]", .fallback = "0", .example = "0.95",
     .help = "fraction of all hours, distributed over the values of aero.wind.speed"},
    {KEY(NUMBER, hours), .range = ">= 0", .fallback = "0", .example = "50",
     .help = "hours in a year, of all its cases together"},
    {KEY(NUMBER, events), .range = ">= 0", .fallback = "0", .example = "1000",
     .help = "events in a year, of all its cases together; each run is one event"},
    {KEY(NUMBER, factor), .range = "> 0", .fallback = "1.35", .example = "1.1",
     .help = "partial safety factor of its extreme forces and moments"},
    {KEY(NUMBER, favourable), .range = "(0, 1]", .fallback = "0.9", .example = "1",
     .help = "factor of favourable loads in place of 'factor': of a largest value below zero or a smallest value above zero"},
    {KEY(BOOLEAN, extremes), .fallback = "true", .help = "its extremes count"},
)};
#undef FILLS

#define FILLS bough_load_wind
static const bough_schema wind_schema = {.name = "the wind's distribution", KEYS(
    {KEY(NUMBER, average), UNIT(SPEED), .range = "> 0", .required = true, .example = "10 m/s",
     .help = "yearly mean at hub height"},
    {KEY(NUMBER, shape), .range = "[1, 10]", .fallback = "2", .example = "2.1",
     .help = "shape of the Weibull distribution; 2: Rayleigh distribution"},
)};
#undef FILLS

static void check_set(bough_schema_reader *r, void *item) {
    const bough_study *s = item;
    if (s->n_slope > BOUGH_MOST_SLOPES) {
        bough_schema_error(r, s->node, "slopes",
                           "expected at most %d, got %d", BOUGH_MOST_SLOPES, s->n_slope);
    }
    for (int i = 0; i < s->n_group; i++) {
        const bough_load_group *g = &s->group[i];
        if (g->weibull > 0 && !s->wind.node) {
            bough_schema_error(r, g->node, "weibull", "needs the set's 'wind': its average speed");
        }
        for (int k = 0; k < i; k++) {
            if (strcmp(s->group[k].name, g->name) != 0) continue;
            bough_schema_error(r, g->node, "name", "'%.80s' is given twice", g->name);
        }
    }
}

#define FILLS bough_study
#define HEAD(kinds)                                                                                \
    {KEY(TEXT, title), .help = "one line of description"},                                         \
    {KEY(CHOICE, kind), CHOICES(kinds), .required = true, .help = "kind of study"},                \
    {KEY(CUSTOM, common), SETTINGS, .help = "replaced keys of every case"},                        \
    {KEY(NUMBER, from), UNIT(TIME), .range = ">= 0", .fallback = "0", .example = "30 s",           \
     .help = "start of the statistics"},                                                           \
    {NAMED("channels", TEXTS), AT(wanted), .count = 1, COUNT_AT(n_wanted),                         \
     .example = "[RotSpeed, RootMyb1]", .help = "channels that are kept; default all"},            \
    {KEY(BOOLEAN, series), .fallback = "false",                                                    \
     .help = "every case keeps its channels.out; with 'simulation.output.binary: true' in "        \
             "'common' channels.outb in its place"}

static const bough_schema sweep_schema = {.name = "a sweep", KEYS(
    HEAD("sweep"),
    {NAMED("scene", TEXT), AT(scene_name),
     .help = "file of the scene, relative to the study; not given if the grid has the key 'scene'"},
    {KEY(CUSTOM, grid), GRID, .required = true,
     .help = "one run for each combination of the values; the key 'scene' takes files"},
)};

static const bough_schema set_schema = {.name = "a load set", .check = check_set, KEYS(
    HEAD("load-set"),
    {NAMED("scene", TEXT), AT(scene_name), .required = true,
     .help = "file of the scene, relative to the study"},
    {NAMED("slopes", NUMBERS), AT(slope), .range = "[1, 30]", .count = 1, .required = true,
     COUNT_AT(n_slope), .example = "[4, 10]", .help = "exponents of the S-N curves"},
    {NAMED("equivalent_cycles", NUMBER), AT(cycles), .range = "> 0", .fallback = "1e7",
     .example = "2e6", .help = "number of cycles of the lifetime's damage-equivalent loads"},
    {KEY(NUMBER, lifetime), .range = "> 0", .fallback = "20", .example = "25",
     .help = "lifetime in years"},
    {KEY(CUSTOM, companions), .read = read_companions, .form = "1 in N|all|none", .fallback = "1 in 20",
     .help = "cases that have a companion, regardless of the scene: the errors of equivalent loads and "
             "extremes follow from them"},
    {KEY(MAPPING, wind), .of = &wind_schema,
     .help = "distribution of the wind speed, for 'weibull'"},
    {NAMED("cases", LIST), AT(group), .of = &group_schema, .count = 1, .required = true,
     COUNT_AT(n_group), .help = "design load cases"},
)};
#undef FILLS

// clang-format on

// -- help -----------------------------------------------------------------------------------------

void bough_study_help(FILE *stream) {
    fputs((const char *)bough_study_help_text, stream);
    bough_schema_help(&study_schema, 0, stream);
    fputs("\n## sweep\n\n", stream);
    bough_schema_help(&sweep_schema, 0, stream);
    fputs("\n## load-set\n\n", stream);
    bough_schema_help(&set_schema, 0, stream);
}

void bough_study_json_schema(FILE *stream) {
    const bough_schema *schema[] = {&study_schema, &sweep_schema, &set_schema};
    bough_schema_json("A study of bough", schema, 3, stream);
}

// -- reading --------------------------------------------------------------------------------------

const char *bough_study_path(bough_arena *arena, const char *study, const char *scene) {
    int length = scene[0] == '/' ? 0 : (int)(bough_file_name(study) - study);
    return bough_arena_print(arena, "%.*s%s", length, study, scene);
}

static bool find_scene(bough_arena *arena, bough_study *s, bough_errors *errors) {
    const char *scene = bough_study_path(arena, s->file, s->scene_name);
    char why[BOUGH_INPUT_REASON];
    FILE *file = bough_input_open(scene, BOUGH_INPUT_TEXT, why);
    if (!file) {
        bough_errors_add(errors, bough_node_find(s->node, "scene"), "scene",
                         "file '%.200s' cannot be read: %s", scene, why);
        return false;
    }
    fclose(file);
    return true;
}

// A scene that is read as a study gives one error, not one for each of its keys.
static bool is_scene(const char *path, const bough_node *root, bough_errors *errors) {
    const bough_node *bodies = bough_node_find(root, "bodies");
    if (!bodies || bough_node_find(root, "kind")) return false;
    bough_errors_add(errors, bodies, "bodies", "this is a scene, not a study: 'bough run %.200s' runs it",
                     path);
    return true;
}

// The kinds, by bough_study_kind. An unknown kind is reported by the keys of the first.
static const struct {
    const char *word;
    const bough_schema *schema;
    bough_study_traits is;
} kinds[] = {
    [BOUGH_STUDY_WORK_PRECISION] = {"work-precision", &study_schema, {.compared = true}},
    [BOUGH_STUDY_TIMING] = {"timing", &study_schema, {.compared = true}},
    [BOUGH_STUDY_STABILITY] = {"stability", &study_schema, {.compared = true, .parallel = true}},
    [BOUGH_STUDY_SWEEP] = {"sweep", &sweep_schema, {.parallel = true}},
    [BOUGH_STUDY_LOAD_SET] = {"load-set", &set_schema, {.parallel = true, .weighted = true}},
};

static int find_kind(const bough_node *root) {
    const bough_node *word = bough_node_find(root, "kind");
    int k = word && word->kind == BOUGH_SCALAR ? COUNT(kinds) - 1 : 0;
    while (k > 0 && strcmp(kinds[k].word, word->text) != 0) k--;
    return k;
}

// A study without load cases has one group.
static void make_group(bough_arena *arena, bough_study *s) {
    s->group = bough_arena_take(arena, sizeof *s->group);
    s->n_group = 1;
    *s->group = (bough_load_group){.node = s->node,
                                   .name = kinds[s->kind].word,
                                   .grid = s->grid,
                                   .factor = 1,
                                   .favourable = 1,
                                   .extremes = true};
}

bough_study *bough_study_parse(bough_arena *arena, const char *path, const bough_node *root,
                               bough_errors *errors) {
    bough_study *s = bough_arena_take(arena, sizeof *s);
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = ""};
    int kind = find_kind(root);
    bough_schema_read(&reader, kinds[kind].schema, root, s);
    if (errors->n > 0) return NULL;
    s->file = bough_arena_string(arena, path);
    s->kind = kind;
    s->is = kinds[kind].is;
    if (!s->is.weighted) make_group(arena, s);
    if (!s->is.compared || find_scene(arena, s, errors)) bough_study_expand(arena, s, errors);
    return errors->n > 0 ? NULL : s;
}

bough_status bough_study_read(bough_arena *arena, const char *path, int threads, bough_errors *errors,
                              bough_study **study) {
    *study = NULL;
    bough_study *s = NULL;
    bough_node *root = bough_text_read(arena, path, errors);
    if (root && !is_scene(path, root, errors)) s = bough_study_parse(arena, path, root, errors);
    BOUGH_TRY(bough_errors_status(errors, path, "study"));
    s->threads = threads;
    bough_status status = bough_study_check(arena, s, errors);
    if (bough_is_ok(&status)) status = bough_errors_status(errors, path, "study");
    if (bough_is_ok(&status)) *study = s;
    return status;
}

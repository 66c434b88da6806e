// The keys of sweeps and load sets, and their reading.
#include "apps/study/load_set.h"

#include "apps/config/schema.h"
#include "apps/study/load_set_internal.h"
#include "apps/study/study_internal.h"

#include <math.h>
#include <string.h>

// clang-format off
#define COUNT(table) (int)(sizeof(table) / sizeof(table)[0])
#define CHOICES(...) (const char *const[]){__VA_ARGS__, NULL}

#define AT(member) .offset = offsetof(bough_load_group, member)
static const bough_key group_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name), .example = "DLC1.2",
     .help = "name of the load case"},
    {.name = "scene", .kind = BOUGH_KEY_TEXT, AT(scene_name), .example = "parked.yaml",
     .help = "scene of this load case; replaces the set's"},
    {.name = "set", .kind = BOUGH_KEY_CUSTOM, .read = bough_study_read_settings,
     .form = "{KEY: VALUE, ...}", AT(set), .help = "replaced keys of its cases"},
    {.name = "grid", .kind = BOUGH_KEY_CUSTOM, .read = bough_study_read_grid,
     .form = "{KEY: [VALUE, ...], ...}", AT(grid),
     .help = "one case for each combination of the values; default one case"},
    {.name = "weibull", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0", AT(weibull),
     .example = "0.95",
     .help = "share of all hours, distributed over the values of aero.wind.speed"},
    {.name = "hours", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0", AT(hours),
     .example = "50", .help = "hours in a year, of all its cases together"},
    {.name = "events", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0", AT(events),
     .example = "1000", .help = "events in a year, of all its cases together; each run is one "
                                "event"},
    {.name = "factor", .kind = BOUGH_KEY_NUMBER, .range = "> 0", .fallback = "1.35", AT(factor),
     .example = "1.1", .help = "partial safety factor of its extremes"},
    {.name = "extremes", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true", AT(extremes),
     .help = "its extremes count"},
};
#undef AT

static void check_group(bough_schema_reader *r, void *item) {
    const bough_load_group *g = item;
    if ((g->weibull > 0) + (g->hours > 0) + (g->events > 0) > 1) {
        bough_schema_error(r, g->node, "", "expected at most one of 'weibull', 'hours', 'events'");
    }
}

static const bough_schema group_schema = {
    .name = "a load case", .size = sizeof(bough_load_group), .n_key = COUNT(group_keys),
    .key = group_keys, .check = check_group};

#define AT(member) .offset = offsetof(bough_load_wind, member)
static const bough_key wind_keys[] = {
    {.name = "average", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_SPEED, .range = "> 0",
     .required = true, AT(average), .example = "10 m/s", .help = "yearly mean at hub height"},
    {.name = "shape", .kind = BOUGH_KEY_NUMBER, .range = "[1, 10]", .fallback = "2", AT(shape),
     .example = "2.1", .help = "shape of the Weibull distribution; 2: Rayleigh distribution"},
};
#undef AT
static const bough_schema wind_schema = {.name = "the wind's distribution",
    .size = sizeof(bough_load_wind), .n_key = COUNT(wind_keys), .key = wind_keys};

#define AT(member) .offset = offsetof(bough_load_set, member)
#define HEAD(kinds)                                                                                \
    {.name = "title", .kind = BOUGH_KEY_TEXT, AT(title), .help = "one line of description"},       \
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES(kinds), .required = true,        \
     AT(kind), .help = "kind of study"},                                                           \
    {.name = "common", .kind = BOUGH_KEY_CUSTOM, .read = bough_study_read_settings,                \
     .form = "{KEY: VALUE, ...}", AT(common), .help = "replaced keys of every case"},              \
    {.name = "from", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = ">= 0",           \
     .fallback = "0", AT(from), .example = "30 s", .help = "start of the statistics"},    \
    {.name = "channels", .kind = BOUGH_KEY_TEXTS, .count = 1, AT(wanted),                          \
     .count_offset = offsetof(bough_load_set, n_wanted), .example = "[RotSpeed, RootMyb1]",        \
     .help = "channels that are kept; default all"},                                                      \
    {.name = "series", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false", AT(series),                 \
     .help = "every case keeps its channels.out"}

static const bough_key sweep_keys[] = {
    HEAD("sweep"),
    {.name = "scene", .kind = BOUGH_KEY_TEXT, AT(scene_name),
     .help = "file of the scene, relative to the study; not given if the grid has the key 'scene'"},
    {.name = "grid", .kind = BOUGH_KEY_CUSTOM, .read = bough_study_read_grid, .required = true,
     .form = "{KEY: [VALUE, ...], ...}", AT(grid),
     .help = "one run for each combination of the values; the key 'scene' takes files"},
};
const bough_schema bough_sweep_schema = {.name = "a sweep", .size = sizeof(bough_load_set),
    .n_key = COUNT(sweep_keys), .key = sweep_keys};

static const bough_key set_keys[] = {
    HEAD("load-set"),
    {.name = "scene", .kind = BOUGH_KEY_TEXT, .required = true, AT(scene_name),
     .help = "file of the scene, relative to the study"},
    {.name = "slopes", .kind = BOUGH_KEY_NUMBERS, .range = "[1, 30]", .count = 1, .required = true,
     AT(slope), .count_offset = offsetof(bough_load_set, n_slope), .example = "[4, 10]",
     .help = "exponents of the S-N curves"},
    {.name = "equivalent_cycles", .kind = BOUGH_KEY_NUMBER, .range = "> 0", .fallback = "1e7",
     AT(cycles), .example = "2e6", .help = "number of cycles of the lifetime's damage-equivalent "
                                        "loads"},
    {.name = "lifetime", .kind = BOUGH_KEY_NUMBER, .range = "> 0", .fallback = "20", AT(lifetime),
     .example = "25", .help = "lifetime in years"},
    {.name = "wind", .kind = BOUGH_KEY_MAPPING, .of = &wind_schema, AT(wind),
     .help = "distribution of the wind speed, for 'weibull'"},
    {.name = "cases", .kind = BOUGH_KEY_LIST, .of = &group_schema, .count = 1, .required = true,
     AT(group), .count_offset = offsetof(bough_load_set, n_group), .help = "design load cases"},
};
#undef AT

static void check_set(bough_schema_reader *r, void *item) {
    const bough_load_set *s = item;
    if (s->n_slope > BOUGH_MOST_SLOPES) {
        bough_schema_error(r, bough_node_find(s->node, "slopes"), "slopes",
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

const bough_schema bough_load_set_schema = {.name = "a load set", .size = sizeof(bough_load_set),
    .n_key = COUNT(set_keys), .key = set_keys, .check = check_set};
// clang-format on

// A sweep is one group.
static void make_group(bough_arena *arena, bough_load_set *s) {
    s->group = bough_arena_take(arena, sizeof *s->group);
    s->n_group = 1;
    *s->group = (bough_load_group){
        .node = s->node, .name = "sweep", .grid = s->grid, .factor = 1, .extremes = true};
}

bough_load_set *bough_load_set_parse(bough_arena *arena, const char *path, const bough_node *root,
                                     bough_errors *errors) {
    bough_load_set *s = bough_arena_take(arena, sizeof *s);
    const bough_node *kind = bough_node_find(root, "kind");
    s->sweep = strcmp(kind->text, "sweep") == 0;
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = ""};
    bough_schema_read(&reader, s->sweep ? &bough_sweep_schema : &bough_load_set_schema, root, s);
    if (errors->n > 0) return NULL;
    s->file = bough_arena_string(arena, path);
    if (s->sweep) make_group(arena, s);
    bough_load_set_expand(arena, s, errors);
    return errors->n > 0 ? NULL : s;
}

bough_load_set *bough_load_set_read(bough_arena *arena, const char *path, const bough_node *root,
                                    int threads, bough_errors *errors, bough_status *status) {
    *status = bough_ok();
    bough_load_set *s = bough_load_set_parse(arena, path, root, errors);
    if (!s) return NULL;
    s->threads = threads;
    *status = bough_load_set_check(arena, s, errors);
    return bough_is_ok(status) && errors->n == 0 ? s : NULL;
}

double bough_load_set_weight(const bough_load_set *set, const bough_load_case *c, double counted) {
    const bough_load_group *g = &set->group[c->group];
    if (g->events > 0) return g->events * set->lifetime * c->share;
    double hours = g->weibull > 0 ? 8766 * g->weibull : g->hours;
    return hours * set->lifetime * c->share * 3600 / counted;
}

// The keys of sweeps and load sets, and their reading.
#include "apps/bough/cases/load_set.h"

#include "apps/bough/config/schema_keys.h"
#include "apps/bough/cases/load_set_internal.h"
#include "apps/bough/cases/study_internal.h"

#include <math.h>
#include <string.h>

// clang-format off
#define FILLS bough_load_group
static const bough_key group_keys[] = {
    {KEY(TEXT, name), .required = true, .example = "DLC1.2", .help = "name of the load case"},
    {NAMED("scene", TEXT), AT(scene_name), .example = "parked.yaml",
     .help = "scene of this load case; replaces the set's"},
    {KEY(CUSTOM, set), .read = bough_study_read_settings, .form = "{KEY: VALUE, ...}",
     .help = "replaced keys of its cases"},
    {KEY(CUSTOM, grid), .read = bough_study_read_grid, .form = "{KEY: [VALUE, ...], ...}",
     .help = "one case for each combination of the values; default one case"},
    {KEY(NUMBER, weibull), .range = "[0, 1]", .fallback = "0", .example = "0.95",
     .help = "share of all hours, distributed over the values of aero.wind.speed"},
    {KEY(NUMBER, hours), .range = ">= 0", .fallback = "0", .example = "50",
     .help = "hours in a year, of all its cases together"},
    {KEY(NUMBER, events), .range = ">= 0", .fallback = "0", .example = "1000",
     .help = "events in a year, of all its cases together; each run is one event"},
    {KEY(NUMBER, factor), .range = "> 0", .fallback = "1.35", .example = "1.1",
     .help = "partial safety factor of its extreme forces and moments"},
    {KEY(NUMBER, favourable), .range = "(0, 1]", .fallback = "0.9", .example = "1",
     .help = "factor of favourable loads in place of it: of a largest value below zero and a smallest "
             "value above"},
    {KEY(BOOLEAN, extremes), .fallback = "true", .help = "its extremes count"},
};
#undef FILLS

static void check_group(bough_schema_reader *r, void *item) {
    const bough_load_group *g = item;
    if ((g->weibull > 0) + (g->hours > 0) + (g->events > 0) > 1) {
        bough_schema_error(r, g->node, "", "expected at most one of 'weibull', 'hours', 'events'");
    }
}

static const bough_schema group_schema = {
    SCHEMA("a load case", bough_load_group, group_keys), .check = check_group};

#define FILLS bough_load_wind
static const bough_key wind_keys[] = {
    {KEY(NUMBER, average), UNIT(SPEED), .range = "> 0", .required = true, .example = "10 m/s",
     .help = "yearly mean at hub height"},
    {KEY(NUMBER, shape), .range = "[1, 10]", .fallback = "2", .example = "2.1",
     .help = "shape of the Weibull distribution; 2: Rayleigh distribution"},
};
#undef FILLS
static const bough_schema wind_schema = {
    SCHEMA("the wind's distribution", bough_load_wind, wind_keys)};

#define FILLS bough_load_set
#define HEAD(kinds)                                                                                \
    {KEY(TEXT, title), .help = "one line of description"},                                         \
    {KEY(CHOICE, kind), CHOICES(kinds), .required = true, .help = "kind of study"},                \
    {KEY(CUSTOM, common), .read = bough_study_read_settings, .form = "{KEY: VALUE, ...}",          \
     .help = "replaced keys of every case"},                                                       \
    {KEY(NUMBER, from), UNIT(TIME), .range = ">= 0", .fallback = "0", .example = "30 s",           \
     .help = "start of the statistics"},                                                           \
    {NAMED("channels", TEXTS), AT(wanted), .count = 1, COUNT_AT(n_wanted),                         \
     .example = "[RotSpeed, RootMyb1]", .help = "channels that are kept; default all"},            \
    {KEY(BOOLEAN, series), .fallback = "false", .help = "every case keeps its channels.out"}

static const bough_key sweep_keys[] = {
    HEAD("sweep"),
    {NAMED("scene", TEXT), AT(scene_name),
     .help = "file of the scene, relative to the study; not given if the grid has the key 'scene'"},
    {KEY(CUSTOM, grid), .read = bough_study_read_grid, .required = true,
     .form = "{KEY: [VALUE, ...], ...}",
     .help = "one run for each combination of the values; the key 'scene' takes files"},
};
const bough_schema bough_sweep_schema = {SCHEMA("a sweep", bough_load_set, sweep_keys)};

static const bough_key set_keys[] = {
    HEAD("load-set"),
    {NAMED("scene", TEXT), AT(scene_name), .required = true,
     .help = "file of the scene, relative to the study"},
    {NAMED("slopes", NUMBERS), AT(slope), .range = "[1, 30]", .count = 1, .required = true,
     COUNT_AT(n_slope), .example = "[4, 10]", .help = "exponents of the S-N curves"},
    {NAMED("equivalent_cycles", NUMBER), AT(cycles), .range = "> 0", .fallback = "1e7",
     .example = "2e6", .help = "number of cycles of the lifetime's damage-equivalent loads"},
    {KEY(NUMBER, lifetime), .range = "> 0", .fallback = "20", .example = "25",
     .help = "lifetime in years"},
    {KEY(MAPPING, wind), .of = &wind_schema,
     .help = "distribution of the wind speed, for 'weibull'"},
    {NAMED("cases", LIST), AT(group), .of = &group_schema, .count = 1, .required = true,
     COUNT_AT(n_group), .help = "design load cases"},
};
#undef FILLS

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

const bough_schema bough_load_set_schema = {
    SCHEMA("a load set", bough_load_set, set_keys), .check = check_set};
// clang-format on

// A sweep is one group.
static void make_group(bough_arena *arena, bough_load_set *s) {
    s->group = bough_arena_take(arena, sizeof *s->group);
    s->n_group = 1;
    *s->group = (bough_load_group){
        .node = s->node, .name = "sweep", .grid = s->grid, .factor = 1, .favourable = 1, .extremes = true};
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

bough_load_set *bough_load_set_read(bough_arena *arena, const char *path, const bough_node *root, int threads,
                                    bough_errors *errors, bough_status *status) {
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

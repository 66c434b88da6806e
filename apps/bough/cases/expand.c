// Expands the grids of a study into cases with their fractions of the load case, and into references.
#include "apps/bough/cases/study.h"
#include "apps/bough/config/schema.h"

static const char speed_key[] = "aero.wind.speed", scene_key[] = "scene";

// -- weights --------------------------------------------------------------------------------------

static double speed_of(const bough_study_axis *axis, int i) {
    char why[160];
    double speed = (double)NAN;
    return bough_quantity(axis->value.item[i].value, BOUGH_SPEED, &speed, why) ? speed : (double)NAN;
}

// Fraction of the hours with less wind than this, by the Weibull distribution.
static double fraction_below(const bough_load_wind *wind, double speed) {
    double scale = wind->average / tgamma(1 + 1 / wind->shape);
    return speed > 0 ? 1 - exp(-pow(speed / scale, wind->shape)) : 0;
}

// Fraction of the hours in the bin of value i, whose edges are halfway to its neighbours.
static double fraction_of_speed(const bough_load_wind *wind, const bough_study_axis *axis, int i) {
    int n = axis->value.n;
    double here = speed_of(axis, i);
    double below = i > 0 ? here - speed_of(axis, i - 1) : speed_of(axis, 1) - here;
    double above = i < n - 1 ? speed_of(axis, i + 1) - here : below;
    return fraction_below(wind, here + above / 2) - fraction_below(wind, here - below / 2);
}

// The index of the axis with this key in the grid; −1: there is none.
static int axis_of(const bough_load_group *g, const char *key) {
    int i = g->grid.n - 1;
    while (i >= 0 && strcmp(g->grid.axis[i].key, key) != 0) i--;
    return i;
}

static bool are_rising(const bough_study_axis *axis) {
    for (int i = 1; i < axis->value.n; i++)
        if (!(speed_of(axis, i) > speed_of(axis, i - 1))) return false;
    return axis->value.n >= 2;
}

static void check_speeds(const bough_load_group *g, bough_errors *errors) {
    int speeds = axis_of(g, speed_key);
    if (!(g->weibull > 0) || (speeds >= 0 && are_rising(&g->grid.axis[speeds]))) return;
    bough_errors_add(errors, g->node, "weibull",
                     "'%.80s' needs at least two rising speeds of '%s' in its grid", g->name, speed_key);
}

static double fraction_of(const bough_study *s, const bough_case *c, int n_group) {
    const bough_load_group *g = &s->group[c->group];
    int speeds = axis_of(g, speed_key);
    if (!(g->weibull > 0)) return 1. / n_group;
    const bough_study_axis *axis = &g->grid.axis[speeds];
    return fraction_of_speed(&s->wind, axis, c->index[speeds]) * axis->value.n / n_group;
}

double bough_case_weight(const bough_study *s, const bough_case *c, double counted) {
    const bough_load_group *g = &s->group[c->group];
    if (g->events > 0) return g->events * s->lifetime * c->fraction;
    double hours = g->weibull > 0 ? 8766 * g->weibull : g->hours;
    return hours * s->lifetime * c->fraction * 3600 / counted;
}

// -- combinations ---------------------------------------------------------------------------------

// The number of combinations of a grid, at most BOUGH_MOST_CASES + 1.
static int count(const bough_study_grid *grid) {
    long n = 1;
    for (int i = 0; i < grid->n && n <= BOUGH_MOST_CASES; i++) n *= grid->axis[i].value.n;
    return n <= BOUGH_MOST_CASES ? (int)n : BOUGH_MOST_CASES + 1;
}

// The indices on the axes of combination `number`; the last axis varies fastest.
static void place(const bough_study_grid *grid, int number, int *index) {
    for (int i = grid->n - 1; i >= 0; i--) {
        index[i] = number % grid->axis[i].value.n;
        number /= grid->axis[i].value.n;
    }
}

// These as text, "scheme=ramp, macro_step=5 ms".
static const char *name_settings(bough_arena *arena, const bough_study_grid *grid, const int *index) {
    const char *text = "";
    for (int i = 0; i < grid->n; i++) {
        text = bough_arena_print(arena, "%s%s%s=%s", text, i ? ", " : "", grid->axis[i].label,
                                 grid->axis[i].value.item[index[i]].value);
    }
    return text;
}

// -- cases ----------------------------------------------------------------------------------------

static void add_set(bough_case *c, const bough_study_setting *setting) {
    c->setting[c->n_set] = setting;
    c->set[c->n_set++] = setting->set;
}

static void add_sets(bough_case *c, const bough_study_settings *settings) {
    for (int i = 0; i < settings->n; i++) add_set(c, &settings->item[i]);
}

// The choice depends on the case's number alone, so that all processes agree. The scene's settings are
// replaced: here errors of loads count, and the bound on single channels only if the set gives one.
static void add_companion(const bough_study *s, bough_case *c) {
    bool has_one = s->companions > 0 && (c - s->cases) % s->companions == 0;
    c->set[c->n_set++] = has_one ? "simulation.error_estimate=companion" : "simulation.error_estimate=none";
    if (has_one) c->set[c->n_set++] = "simulation.error_bound=0";
}

static void take_sets(bough_arena *arena, const bough_study *s, int n_own, bough_case *c) {
    size_t most = (size_t)(s->common.n + n_own + 2);
    c->set = bough_arena_take(arena, most * sizeof *c->set);
    c->setting = bough_arena_take(arena, most * sizeof *c->setting);
    if (s->is.weighted) add_companion(s, c);
    add_sets(c, &s->common);
}

// The index of the axis of scenes; −1: there is none. All compared cases have one scene.
static int scene_axis(const bough_study *s, const bough_load_group *g) {
    return s->is.compared ? -1 : axis_of(g, scene_key);
}

static void make_case(bough_arena *arena, bough_study *s, int group, int number, int n_group, bough_case *c) {
    const bough_load_group *g = &s->group[group];
    const char *scene = g->scene_name ? g->scene_name : s->scene_name;
    int scenes = scene_axis(s, g);
    c->group = group;
    place(&g->grid, number, c->index);
    c->fraction = fraction_of(s, c, n_group);
    take_sets(arena, s, g->set.n + g->grid.n, c);
    add_sets(c, &g->set);
    for (int i = 0; i < g->grid.n; i++) {
        const bough_study_setting *value = &g->grid.axis[i].value.item[c->index[i]];
        if (i == scenes)
            scene = value->value;
        else
            add_set(c, value);
    }
    c->scene = bough_study_path(arena, s->file, scene);
    c->settings = name_settings(arena, &g->grid, c->index);
}

// -- references -----------------------------------------------------------------------------------

// Keys outside simulation are parameters of the model.
static bool is_model(const bough_study *s, int axis) {
    return s->is.compared && s->is.parallel &&
           strncmp(s->grid.axis[axis].key, "simulation.", strlen("simulation.")) != 0;
}

// The number of the reference that has the model parameters of a cell.
static int reference_of(const bough_study *s, const bough_case *cell) {
    int number = 0;
    for (int i = 0; i < s->grid.n; i++)
        if (is_model(s, i)) number = number * s->grid.axis[i].value.n + cell->index[i];
    return number;
}

// "reference", or with model parameters "reference: damping=1e-3"
static const char *name_reference(bough_arena *arena, const bough_study *s, const bough_case *cell) {
    const char *text = "reference", *between = ":";
    for (int i = 0; i < s->grid.n; i++) {
        if (!is_model(s, i)) continue;
        text = bough_arena_print(arena, "%s%s %s=%s", text, between, s->grid.axis[i].label,
                                 bough_study_value(s, cell, i));
        between = ",";
    }
    return text;
}

static void make_reference(bough_arena *arena, const bough_study *s, const bough_case *cell, bough_case *c) {
    take_sets(arena, s, s->reference.n + s->grid.n, c);
    for (int i = 0; i < BOUGH_STUDY_AXES; i++) c->index[i] = -1;
    for (int i = s->grid.n - 1; i >= 0; i--) {
        if (!is_model(s, i)) continue;
        c->index[i] = cell->index[i];
        add_set(c, &s->grid.axis[i].value.item[c->index[i]]);
    }
    add_sets(c, &s->reference);
    c->scene = cell->scene;
    c->settings = name_reference(arena, s, c);
}

// In the order of the first cell of each.
static void make_references(bough_arena *arena, bough_study *s) {
    s->n_reference = s->cases[s->n_case - 1].reference + 1;
    s->reference_case = bough_arena_take(arena, (size_t)s->n_reference * sizeof *s->reference_case);
    for (int i = 0; i < s->n_case; i++) {
        bough_case *c = &s->reference_case[s->cases[i].reference];
        if (!c->set) make_reference(arena, s, &s->cases[i], c);
    }
}

// -- all ------------------------------------------------------------------------------------------

static void check_group(const bough_study *s, const bough_load_group *g, bough_errors *errors) {
    check_speeds(g, errors);
    if (s->scene_name || g->scene_name || scene_axis(s, g) >= 0) return;
    bough_errors_add(errors, s->node, "", "required key 'scene' is missing");
}

void bough_study_expand(bough_arena *arena, bough_study *s, bough_errors *errors) {
    long n = 0;
    for (int g = 0; g < s->n_group && n <= BOUGH_MOST_CASES; g++) {
        check_group(s, &s->group[g], errors);
        n += count(&s->group[g].grid);
    }
    if (n > BOUGH_MOST_CASES)
        bough_errors_add(errors, s->node, "", "expected at most %d cases", BOUGH_MOST_CASES);
    if (errors->n > 0) return;
    s->cases = bough_arena_take(arena, (size_t)n * sizeof *s->cases);
    for (int g = 0; g < s->n_group; g++) {
        int n_group = count(&s->group[g].grid);
        for (int i = 0; i < n_group; i++) {
            bough_case *c = &s->cases[s->n_case++];
            make_case(arena, s, g, i, n_group, c);
            c->reference = reference_of(s, c);
        }
    }
    if (s->is.compared) make_references(arena, s);
}

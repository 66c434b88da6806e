// From the groups of a load set to its cases, with the share each has of its group.
#include "apps/bough/config/schema.h"
#include "apps/bough/cases/load_set_internal.h"
#include "apps/bough/cases/study_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char speed_key[] = "aero.wind.speed", scene_key[] = "scene";

static int count_group(const bough_load_group *g) { return bough_grid_count(&g->grid, BOUGH_MOST_CASES); }

static const bough_study_setting *value_of(const bough_load_group *g, const bough_load_case *c, int axis) {
    return &g->grid.axis[axis].value.item[c->index[axis]];
}

// -- weights --------------------------------------------------------------------------------------

static double speed_of(const bough_study_axis *axis, int i) {
    char why[160];
    double speed = (double)NAN;
    return bough_quantity(axis->value.item[i].value, BOUGH_SPEED, &speed, why) ? speed : (double)NAN;
}

// Weibull's share of the hours with less wind than that.
static double share_below(const bough_load_wind *wind, double speed) {
    double scale = wind->average / tgamma(1 + 1 / wind->shape);
    return speed > 0 ? 1 - exp(-pow(speed / scale, wind->shape)) : 0;
}

// Of the speeds nearest to value i of the axis: the bin's edges are half way to its neighbours.
static double share_of_speed(const bough_load_wind *wind, const bough_study_axis *axis, int i) {
    int n = axis->value.n;
    double here = speed_of(axis, i);
    double below = i > 0 ? here - speed_of(axis, i - 1) : speed_of(axis, 1) - here;
    double above = i < n - 1 ? speed_of(axis, i + 1) - here : below;
    return share_below(wind, here + above / 2) - share_below(wind, here - below / 2);
}

// The place of an axis of that key in the grid; −1: there is none.
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

static double share_of(const bough_load_set *s, const bough_load_case *c, int n_group) {
    const bough_load_group *g = &s->group[c->group];
    int speeds = axis_of(g, speed_key);
    if (!(g->weibull > 0)) return 1. / n_group;
    if (speeds < 0) return 0;
    const bough_study_axis *axis = &g->grid.axis[speeds];
    return share_of_speed(&s->wind, axis, c->index[speeds]) * axis->value.n / n_group;
}

// -- cases ----------------------------------------------------------------------------------------

// A piece of text, quoted for a shell where it must be.
static void quote(FILE *f, const char *text) {
    if (!strpbrk(text, " \t\"'\\$`&|;<>()[]{}*?#~!")) {
        fputs(text, f);
        return;
    }
    fputc('\'', f);
    for (const char *c = text; *c; c++) {
        if (*c == '\'')
            fputs("'\\''", f);
        else
            fputc(*c, f);
    }
    fputc('\'', f);
}

static const char *write_command(bough_arena *arena, const bough_load_case *c) {
    char text[8192] = "";
    FILE *f = fmemopen(text, sizeof text - 1, "w");
    if (!f) return NULL;
    fputs("bough run ", f);
    quote(f, c->scene);
    for (int i = 0; i < c->n_set; i++) {
        fputs(" --set ", f);
        quote(f, c->set[i]);
    }
    fclose(f);
    return bough_arena_string(arena, text);
}

static const char *scene_of(const bough_load_set *s, const bough_load_case *c) {
    const bough_load_group *g = &s->group[c->group];
    int scenes = axis_of(g, scene_key);
    if (scenes >= 0) return value_of(g, c, scenes)->value;
    return g->scene_name ? g->scene_name : s->scene_name;
}

static void add_sets(bough_load_case *c, const bough_study_settings *settings) {
    for (int i = 0; i < settings->n; i++) c->set[c->n_set++] = settings->item[i].set;
}

static void make_case(bough_arena *arena, bough_load_set *s, int group, int number, int n_group,
                      bough_load_case *c) {
    const bough_load_group *g = &s->group[group];
    c->group = group;
    bough_grid_place(&g->grid, number, c->index);
    c->share = share_of(s, c, n_group);
    c->scene = bough_study_path(arena, s->file, scene_of(s, c));
    size_t most = (size_t)(s->common.n + g->set.n + g->grid.n) + 1;
    c->set = bough_arena_take(arena, most * sizeof *c->set);
    add_sets(c, &s->common);
    add_sets(c, &g->set);
    for (int i = 0; i < g->grid.n; i++) {
        if (strcmp(g->grid.axis[i].key, scene_key) != 0) c->set[c->n_set++] = value_of(g, c, i)->set;
    }
    c->settings = bough_grid_settings(arena, &g->grid, c->index);
    c->command = write_command(arena, c);
}

void bough_load_set_expand(bough_arena *arena, bough_load_set *s, bough_errors *errors) {
    long n = 0;
    for (int g = 0; g < s->n_group && n <= BOUGH_MOST_CASES; g++) {
        check_speeds(&s->group[g], errors);
        n += count_group(&s->group[g]);
        bool named = s->scene_name || s->group[g].scene_name;
        if (named || axis_of(&s->group[g], scene_key) >= 0) continue;
        bough_errors_add(errors, s->node, "", "required key 'scene' is missing");
    }
    if (n > BOUGH_MOST_CASES) {
        bough_errors_add(errors, s->node, "", "expected at most %d cases", BOUGH_MOST_CASES);
    }
    if (errors->n > 0) return;
    s->cases = bough_arena_take(arena, (size_t)n * sizeof *s->cases);
    for (int g = 0; g < s->n_group && s->cases; g++) {
        int n_group = count_group(&s->group[g]);
        for (int i = 0; i < n_group; i++) make_case(arena, s, g, i, n_group, &s->cases[s->n_case++]);
    }
}

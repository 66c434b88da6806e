// Airfoils with their polars, and the blade elements, whose polars are mixtures of two airfoils.
#include "apps/import/windio.h"
#include "core/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_AIRFOILS = 200, NAME = 64 };

// An airfoil's place on the blade.
typedef struct place {
    const bough_node *airfoil; // its entry in the list of airfoils
    int number;                // in the scene's polars
    double share, thickness;   // of the blade's reference line; relative to the chord
} place;

typedef struct blade_air {
    place *place; // (n)
    int n;
    bool by_thickness; // elements find their airfoils by thickness, not by share
    bough_curve chord, twist, thickness;
    bough_curve pitch_axis;         // version 1: share of the chord before the line
    bough_curve offset_x, offset_y; // version 2: of the chord line [m]
} blade_air;

// -- polars ---------------------------------------------------------------------------------------

// Unique by its number, in letters that a scene's names have.
static void airfoil_name(const bough_node *airfoil, int number, char name[NAME]) {
    const bough_node *own = bough_entry(airfoil, "name");
    int n = snprintf(name, NAME, "%d-", number);
    for (const char *p = own ? own->text : ""; *p && n < NAME - 1; p++)
        name[n++] = bough_import_letter(*p);
    name[n] = '\0';
}

// A coefficient over the angle of attack [deg], from -180 to 180, where it must be the same.
static bough_curve read_coefficient(bough_windio *w, const bough_node *from, const char *names) {
    bough_curve c = bough_entry_curve(&w->draft, from, names);
    double *x = bough_arena_doubles(w->draft.arena, (size_t)c.n + 1);
    double *y = bough_arena_doubles(w->draft.arena, (size_t)c.n + 1);
    if (!x || !y) *w->draft.status = bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (!x || !y || c.n == 0) return (bough_curve){0};
    int last = c.n - 1;
    for (int i = 0; i <= last; i++) {
        x[i] = c.x[i] * w->degree;
        y[i] = c.y[i];
    }
    if (fabs(x[0] + 180) > 1 || fabs(x[last] - 180) > 1) {
        bough_entry_fail(&w->draft, c.node,
                         "grid: expected angles from -180 to 180 deg, got %g to %g", x[0], x[last]);
    }
    x[0] = -180; // files often stop at 3.14
    x[last] = 180;
    if (fabs(y[0] - y[last]) > 1e-6) {
        bough_draft_note(&w->draft, BOUGH_APPROXIMATED,
                         "line %d: %g at -180 deg but %g at 180 deg: the mean", c.node->line, y[0],
                         y[last]);
    }
    y[0] = y[last] = (y[0] + y[last]) / 2;
    return bough_curve_of(&w->draft, c.node, x, y, c.n);
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// One row for each angle at which one of the three has a point.
static void put_polar(bough_windio *w, const bough_curve *c, const char *name) {
    FILE *file = w->draft.file[BOUGH_IMPORT_POLARS];
    int n = 0;
    double *angle = bough_arena_doubles(w->draft.arena, (size_t)(c[0].n + c[1].n + c[2].n));
    if (!angle) *w->draft.status = bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (!bough_is_ok(w->draft.status)) return;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < c[k].n; i++)
            angle[n++] = c[k].x[i];
    }
    qsort(angle, (size_t)n, sizeof *angle, compare);
    fprintf(file, "  - name: %s\n    table:\n      columns: [alpha deg, cl, cd, cm]\n      rows:\n",
            name);
    for (int i = 0; i < n; i++) {
        if (i > 0 && angle[i] - angle[i - 1] < 1e-9) continue;
        const double row[] = {angle[i], bough_curve_at(&c[0], angle[i]),
                              bough_curve_at(&c[1], angle[i]), bough_curve_at(&c[2], angle[i])};
        fputs("        - ", file);
        bough_import_list(file, row, 4);
        fputc('\n', file);
    }
}

static void put_airfoil(bough_windio *w, const bough_node *airfoil, int number) {
    char name[NAME];
    airfoil_name(airfoil, number, name);
    const bough_node *polars = bough_entry_need(&w->draft, airfoil, "polars");
    if (!polars) return;
    if (polars->kind != BOUGH_SEQUENCE || polars->n < 1) {
        bough_entry_fail(&w->draft, polars, "polars: expected a list of polars");
        return;
    }
    const bough_node *from = polars->value[0], *sets = bough_entry(from, "re_sets");
    bool more = polars->n > 1;
    if (sets && sets->kind == BOUGH_SEQUENCE && sets->n > 0) {
        more = more || sets->n > 1;
        from = sets->value[0];
    }
    const bough_curve c[] = {read_coefficient(w, from, "c_l|cl"),
                             read_coefficient(w, from, "c_d|cd"),
                             read_coefficient(w, from, "c_m|cm")};
    put_polar(w, c, name);
    if (more) {
        bough_draft_note(&w->draft, BOUGH_APPROXIMATED,
                         "%s: the first of its polars, whatever the Reynolds number", name);
    }
}

// -- places ---------------------------------------------------------------------------------------

static double thickness_of(bough_windio *w, const bough_node *airfoil) {
    return bough_entry_number_or(&w->draft, airfoil, "relative_thickness|rthick", NAN);
}

static void read_place(bough_windio *w, const bough_node *where, const char *name, double share,
                       place *p) {
    const bough_node *list = bough_entry_need(&w->draft, w->root, "airfoils");
    const bough_node *airfoil = list ? bough_entry_named(list, name) : NULL;
    if (list && !airfoil) {
        bough_entry_fail(&w->draft, where, "no airfoil is named '%.60s'", name);
    }
    *p = (place){.airfoil = airfoil, .share = share};
    if (airfoil) p->thickness = thickness_of(w, airfoil);
}

// Version 1: {grid: [...], labels: [...]}.
static void read_labels(bough_windio *w, const bough_node *from, blade_air *a) {
    int n = 0;
    const double *grid = bough_entry_numbers(&w->draft, from, "grid", &n);
    const bough_node *labels = bough_entry_need(&w->draft, from, "labels");
    if (!grid || !labels) return;
    if (labels->kind != BOUGH_SEQUENCE || labels->n != n || n > MOST_AIRFOILS) {
        bough_entry_fail(&w->draft, labels, "labels: expected %d names, as the grid has", n);
        return;
    }
    for (a->n = 0; a->n < n && bough_is_ok(w->draft.status); a->n++) {
        const bough_node *label = labels->value[a->n];
        const char *name = bough_entry_text(&w->draft, label, "");
        read_place(w, label, name, grid[a->n], &a->place[a->n]);
    }
}

// Version 2: [{name, spanwise_position, ...}, ...].
static void read_items(bough_windio *w, const bough_node *list, blade_air *a) {
    if (list->kind != BOUGH_SEQUENCE || list->n < 1 || list->n > MOST_AIRFOILS) {
        bough_entry_fail(&w->draft, list, "airfoils: expected a list of 1 to %d",
                         (int)MOST_AIRFOILS);
        return;
    }
    bool mixed = false;
    for (a->n = 0; a->n < list->n && bough_is_ok(w->draft.status); a->n++) {
        const bough_node *item = list->value[a->n], *tags = bough_entry(item, "configuration");
        double share = bough_entry_number_or(&w->draft, item, "spanwise_position", NAN);
        read_place(w, item, bough_entry_text(&w->draft, item, "name"), share, &a->place[a->n]);
        mixed = mixed || (tags && tags->kind == BOUGH_SEQUENCE && tags->n > 1);
    }
    if (mixed) {
        bough_draft_note(&w->draft, BOUGH_APPROXIMATED,
                         "airfoils' configurations are not mixed: the first polar of each");
    }
}

// Thickness dominates where it is given and falls from place to place.
static void choose_measure(bough_windio *w, const bough_node *where, blade_air *a) {
    a->by_thickness = a->thickness.n > 0;
    for (int i = 0; i < a->n; i++) {
        double before = i > 0 ? a->place[i - 1].thickness : HUGE_VAL;
        a->by_thickness = a->by_thickness && a->place[i].thickness <= before;
    }
    for (int i = 0; i < a->n && !a->by_thickness; i++) {
        if (a->place[i].share >= (i > 0 ? a->place[i - 1].share : 0)) continue;
        bough_entry_fail(&w->draft, where, "airfoil %d: expected shares of the span that grow",
                         i + 1);
    }
}

// Numbers the airfoils in the order of the blade, each once, and writes them.
static void put_airfoils(bough_windio *w, blade_air *a) {
    int n = 0;
    fputs("polars:\n", w->draft.file[BOUGH_IMPORT_POLARS]);
    for (int i = 0; i < a->n && bough_is_ok(w->draft.status); i++) {
        for (int k = 0; k < i && a->place[i].number == 0; k++) {
            if (a->place[k].airfoil == a->place[i].airfoil) a->place[i].number = a->place[k].number;
        }
        if (a->place[i].number > 0) continue;
        a->place[i].number = ++n;
        put_airfoil(w, a->place[i].airfoil, n);
    }
    bough_draft_note(&w->draft, BOUGH_TAKEN, "%d airfoils: lift, drag, moment", n);
}

// -- blade elements -------------------------------------------------------------------------------

// The two neighbours of an element: *share of the second.
static int find_airfoils(const blade_air *a, double at, double *share) {
    double t = a->by_thickness ? bough_curve_at(&a->thickness, at) : at;
    int i = 0;
    *share = 0;
    for (; i + 1 < a->n; i++) {
        const place *p = &a->place[i];
        double from = a->by_thickness ? -p->thickness : p->share;
        double to = a->by_thickness ? -p[1].thickness : p[1].share;
        double value = a->by_thickness ? -t : t;
        if (value >= to) continue;
        if (value > from && p->airfoil != p[1].airfoil) *share = (value - from) / (to - from);
        break;
    }
    return i;
}

static double centre_of(bough_windio *w, const place *p) {
    return bough_entry_number_or(&w->draft, p->airfoil, "aerodynamic_center", 0.25);
}

static void put_element(bough_windio *w, const blade_air *a, double at) {
    FILE *file = w->draft.file[BOUGH_IMPORT_AERO];
    char name[NAME], other[NAME];
    double share, chord = bough_curve_at(&a->chord, at);
    int i = find_airfoils(a, at, &share);
    const place *p = &a->place[i], *q = share > 0 ? p + 1 : p;
    double centre = (1 - share) * centre_of(w, p) + share * centre_of(w, q);
    double line =
        w->second ? bough_curve_at(&a->offset_y, at) : bough_curve_at(&a->pitch_axis, at) * chord;
    double back = centre * chord - line, up = bough_curve_at(&a->offset_x, at);
    double twist = bough_curve_at(&a->twist, at) * w->degree, turn = twist * BOUGH_PI / 180;
    airfoil_name(p->airfoil, p->number, name);
    airfoil_name(q->airfoil, q->number, other);
    fprintf(file, "    - [%.10g, %.10g, %.10g, %.10g, %.10g, %s, %s, %.10g]\n",
            bough_curve_at(&w->axis[2], at),
            bough_curve_at(&w->axis[0], at) + back * sin(turn) + up * cos(turn),
            bough_curve_at(&w->axis[1], at) + back * cos(turn) - up * sin(turn), twist, chord, name,
            other, share);
    if (!(chord > 0)) bough_entry_fail(&w->draft, a->chord.node, "chord: expected a positive one");
}

static void put_elements(bough_windio *w, const blade_air *a) {
    int n = 0;
    double last = -1;
    fputs("stations:\n  columns: [span, ac_x, ac_y, twist deg, chord, polar, blend, share]\n"
          "  rows:\n",
          w->draft.file[BOUGH_IMPORT_AERO]);
    for (int i = 0; i < a->chord.n && bough_is_ok(w->draft.status); i++) {
        double at = a->chord.x[i];
        if (at < 0 || at > 1 || at < last + 1e-6) continue;
        put_element(w, a, at);
        last = at;
        n++;
    }
    if (n < 2) bough_entry_fail(&w->draft, a->chord.node, "chord: expected two points from 0 to 1");
    bough_draft_note(&w->draft, BOUGH_TAKEN, "%d blade elements, where the chord is given", n);
    bough_draft_note(&w->draft, BOUGH_APPROXIMATED, "polars between airfoils: mixed linearly by %s",
                     a->by_thickness ? "thickness" : "place");
}

void bough_windio_air_tables(bough_windio *w) {
    bough_draft *d = &w->draft;
    blade_air a = {.place = bough_arena_take(d->arena, MOST_AIRFOILS * sizeof *a.place)};
    if (!a.place) *d->status = bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    a.chord = bough_entry_curve(d, w->shape, "chord");
    a.twist = bough_entry_curve(d, w->shape, "twist");
    if (w->second) a.offset_y = bough_entry_curve(d, w->shape, "section_offset_y");
    if (!w->second) a.pitch_axis = bough_entry_curve(d, w->shape, "pitch_axis");
    if (bough_entry(w->shape, "section_offset_x"))
        a.offset_x = bough_entry_curve(d, w->shape, "section_offset_x");
    if (bough_entry(w->shape, "rthick")) a.thickness = bough_entry_curve(d, w->shape, "rthick");
    const bough_node *airfoils = bough_entry_need(d, w->shape, "airfoil_position|airfoils");
    if (!bough_is_ok(d->status)) return;
    if (w->second)
        read_items(w, airfoils, &a);
    else
        read_labels(w, airfoils, &a);
    if (bough_is_ok(d->status)) choose_measure(w, airfoils, &a);
    if (!bough_is_ok(d->status)) return;
    put_airfoils(w, &a);
    put_elements(w, &a);
}

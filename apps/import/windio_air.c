// Airfoils with their polars, and the blade elements, whose polars are mixtures of two airfoils.
#include "apps/import/windio.h"
#include "core/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 64 };

// -- polars ---------------------------------------------------------------------------------------

// Unique by its number, in letters that a scene's names have.
static void airfoil_name(const bough_node *airfoil, int number, char name[NAME]) {
    const bough_node *own = bough_entry(airfoil, "name");
    int n = snprintf(name, NAME, "%d-", number);
    for (const char *p = own ? own->text : ""; *p && n < NAME - 1; p++) name[n++] = bough_import_letter(*p);
    name[n] = '\0';
}

// A coefficient over the angle of attack [deg], from -180 to 180, where it is the mean of what the
// file has at its ends; nothing where the file has none.
static bough_curve read_coefficient(bough_windio *w, const bough_node *from, const char *names, bool needed) {
    if (!needed && !bough_entry(from, names)) return (bough_curve){0};
    bough_curve c = bough_entry_curve(&w->draft, from, names);
    double *x = bough_arena_doubles(w->draft.arena, (size_t)c.n + 2);
    double *y = bough_arena_doubles(w->draft.arena, (size_t)c.n + 2);
    if (!x || !y || c.n == 0) return (bough_curve){0};
    double low = c.x[0] * w->degree, high = c.x[c.n - 1] * w->degree;
    if (low < -181 || high > 181) {
        bough_entry_fail(&w->draft, c.node, "grid: expected angles from -180 to 180 deg, got %g to %g", low,
                         high);
    }
    int n = 0;
    bool whole = low < -179 && high > 179; // files often stop at 3.14
    for (int i = 0; i < c.n; i++) {
        bool end = whole && (i == 0 || i == c.n - 1);
        if (i == 0 && !whole) n++;
        x[n] = end ? (i == 0 ? -180 : 180) : c.x[i] * w->degree;
        y[n++] = c.y[i];
    }
    n += !whole;
    x[0] = -180;
    x[n - 1] = 180;
    if (fabs(c.y[0] - c.y[c.n - 1]) > 1e-6 || !whole) {
        bough_draft_note(&w->draft, BOUGH_APPROXIMATED,
                         "line %d: %g at %.3g deg but %g at %.3g deg: the mean at 180 deg", c.node->line,
                         c.y[0], low, c.y[c.n - 1], high);
    }
    y[0] = y[n - 1] = (c.y[0] + c.y[c.n - 1]) / 2;
    return bough_curve_of(&w->draft, c.node, x, y, n);
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
    if (!bough_is_ok(w->draft.status)) return;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < c[k].n; i++) angle[n++] = c[k].x[i];
    }
    qsort(angle, (size_t)n, sizeof *angle, compare);
    fprintf(file, "  - name: %s\n    table:\n      columns: [alpha deg, cl, cd, cm]\n      rows:\n", name);
    for (int i = 0; i < n; i++) {
        if (i > 0 && angle[i] - angle[i - 1] < 1e-9) continue;
        const double row[] = {angle[i], bough_curve_at(&c[0], angle[i]), bough_curve_at(&c[1], angle[i]),
                              bough_curve_at(&c[2], angle[i])};
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
    const bough_curve c[] = {read_coefficient(w, from, "c_l|cl", true),
                             read_coefficient(w, from, "c_d|cd", true),
                             read_coefficient(w, from, "c_m|cm", false)};
    put_polar(w, c, name);
    if (more) {
        bough_draft_note(&w->draft, BOUGH_APPROXIMATED,
                         "%s: the first of its polars is used for all Reynolds numbers", name);
    }
}

// -- airfoils along the blade ---------------------------------------------------------------------

// Numbers the airfoils in the order of the blade, each once, and writes them.
static void put_airfoils(bough_windio *w, bough_windio_shape *a) {
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

static double centre_of(bough_windio *w, const bough_windio_place *p) {
    return bough_entry_number_or(&w->draft, p->airfoil, "aerodynamic_center", 0.25);
}

static void put_element(bough_windio *w, const bough_windio_shape *a, double at) {
    FILE *file = w->draft.file[BOUGH_IMPORT_AERO];
    char name[NAME], other[NAME];
    double share, chord = bough_curve_at(&a->chord, at);
    int i = bough_windio_neighbours(a, at, &share);
    const bough_windio_place *p = &a->place[i], *q = share > 0 ? p + 1 : p;
    double centre = (1 - share) * centre_of(w, p) + share * centre_of(w, q);
    double back = centre * chord - bough_windio_line(a, at), up = bough_curve_at(&a->offset_x, at);
    double twist = bough_curve_at(&a->twist, at) * w->degree, turn = twist * BOUGH_PI / 180;
    airfoil_name(p->airfoil, p->number, name);
    airfoil_name(q->airfoil, q->number, other);
    fprintf(file, "    - [%.10g, %.10g, %.10g, %.10g, %.10g, %s, %s, %.10g]\n",
            bough_curve_at(&w->axis[2], at),
            bough_curve_at(&w->axis[0], at) + back * sin(turn) + up * cos(turn),
            bough_curve_at(&w->axis[1], at) + back * cos(turn) - up * sin(turn), twist, chord, name, other,
            share);
    if (!(chord > 0)) bough_entry_fail(&w->draft, a->chord.node, "chord: expected a positive value");
}

static void put_elements(bough_windio *w, const bough_windio_shape *a) {
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
    bough_draft_note(&w->draft, BOUGH_TAKEN, "%d blade elements, at the stations of the chord", n);
    bough_draft_note(&w->draft, BOUGH_APPROXIMATED, "polars between airfoils: mixed linearly by %s",
                     a->by_thickness ? "thickness" : "place");
}

void bough_windio_air_tables(bough_windio *w) {
    if (!bough_is_ok(w->draft.status)) return;
    put_airfoils(w, &w->outline);
    put_elements(w, &w->outline);
}

// Airfoils with their polars, and the blade elements, whose polars are mixtures of two airfoils.
#include "apps/bough/import/windio.h"

enum { NAME = BOUGH_AIRFOIL_NAME, POLAR = BOUGH_POLAR_COLUMNS };

// -- polars ---------------------------------------------------------------------------------------

static void airfoil_name(const bough_node *airfoil, int number, char name[NAME]) {
    const bough_node *own = bough_entry(airfoil, "name");
    bough_draft_airfoil_name(own ? own->text : "", own ? strlen(own->text) : 0, number, name);
}

// A coefficient over the angle of attack [deg]; nothing where the file has none. Files in radians often stop
// at 3.14.
static bough_curve read_coefficient(bough_windio *w, const bough_node *from, const char *names, bool needed) {
    if (!needed && !bough_entry(from, names)) return (bough_curve){0};
    bough_curve c = bough_entry_curve(w->draft, from, names);
    if (c.n == 0) return c;
    double *x = bough_arena_doubles(w->draft->arena, (size_t)c.n), low = c.x[0] * w->degree;
    double high = c.x[c.n - 1] * w->degree;
    if (low < -181 || high > 181) {
        bough_entry_fail(w->draft, c.node, "grid: expected angles from -180 to 180 deg, got %g to %g", low,
                         high);
    }
    for (int i = 0; i < c.n; i++) x[i] = c.x[i] * w->degree;
    if (low < -179 && high > 179) {
        x[0] = -180;
        x[c.n - 1] = 180;
    } else {
        bough_approximated(w, "line %d: from %g to %g deg, constant beyond", c.node->line, low, high);
    }
    c.x = x;
    return c;
}

// One row for each angle at which one of the three has a point.
static void put_polar(bough_windio *w, const bough_curve *c, const char *name) {
    const bough_curve *const all[] = {&c[0], &c[1], &c[2]};
    if (!bough_is_ok(w->draft->status)) return;
    double *angle;
    int n = bough_curve_places(w->draft, all, 3, 1e-9, &angle);
    double *row = bough_arena_doubles(w->draft->arena, POLAR * (size_t)n);
    for (int i = 0; i < n; i++) {
        row[POLAR * i] = angle[i];
        for (int k = 0; k < 3; k++) row[POLAR * i + 1 + k] = bough_curve_at(&c[k], angle[i]);
    }
    bough_draft_polar(w->draft, name, row, n, NULL);
}

static void put_airfoil(bough_windio *w, const bough_node *airfoil, int number) {
    char name[NAME];
    airfoil_name(airfoil, number, name);
    const bough_node *polars = bough_entry_need(w->draft, airfoil, "polars");
    if (!polars) return;
    if (polars->kind != BOUGH_SEQUENCE || polars->n < 1) {
        bough_entry_fail(w->draft, polars, "polars: expected a list of polars");
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
        bough_approximated(w, "%s: the first of its polars is used for all Reynolds numbers", name);
    }
}

// -- airfoils along the blade ---------------------------------------------------------------------

// Numbers the airfoils in the order of the blade, each once, and writes them.
static void put_airfoils(bough_windio *w, bough_windio_shape *a) {
    int n = 0;
    fputs("polars:\n", w->draft->file[BOUGH_IMPORT_POLARS]);
    for (int i = 0; i < a->n && bough_is_ok(w->draft->status); i++) {
        for (int k = 0; k < i && a->place[i].number == 0; k++) {
            if (a->place[k].airfoil == a->place[i].airfoil) a->place[i].number = a->place[k].number;
        }
        if (a->place[i].number > 0) continue;
        a->place[i].number = ++n;
        put_airfoil(w, a->place[i].airfoil, n);
    }
    bough_taken(w, "%d airfoils: lift, drag, moment", n);
}

// -- blade elements -------------------------------------------------------------------------------

static double centre_of(bough_windio *w, const bough_windio_place *p) {
    return bough_entry_number_or(w->draft, p->airfoil, "aerodynamic_center", 0.25);
}

static void put_element(bough_windio *w, const bough_windio_shape *a, double at) {
    FILE *file = w->draft->file[BOUGH_IMPORT_AERO];
    char name[NAME], other[NAME];
    double weight, chord = bough_curve_at(&a->chord, at);
    int i = bough_windio_neighbours(a, at, &weight);
    const bough_windio_place *p = &a->place[i], *q = weight > 0 ? p + 1 : p;
    double centre = (1 - weight) * centre_of(w, p) + weight * centre_of(w, q);
    double back = centre * chord - bough_windio_line(a, at), up = bough_curve_at(&a->offset_x, at);
    double twist = bough_curve_at(&a->twist, at) * w->degree, turn = twist * BOUGH_DEGREE;
    airfoil_name(p->airfoil, p->number, name);
    airfoil_name(q->airfoil, q->number, other);
    fprintf(file, "    - [%.10g, %.10g, %.10g, %.10g, %.10g, %s, %s, %.10g]\n",
            bough_curve_at(&w->axis[2], at),
            bough_curve_at(&w->axis[0], at) + back * sin(turn) + up * cos(turn),
            bough_curve_at(&w->axis[1], at) + back * cos(turn) - up * sin(turn), twist, chord, name, other,
            weight);
    if (!(chord > 0)) bough_entry_fail(w->draft, a->chord.node, "chord: expected a positive value");
}

// The places of elements, in increasing order: the stations of the chord, and points of other curves and of
// airfoils that are at least `close` away from these.
static int find_places(bough_windio *w, const bough_windio_shape *a, double **place) {
    static const double close = 0.02, equal = 1e-6; // of the blade
    const bough_curve *const other[] = {&a->twist, &a->thickness, &a->pitch_axis, &a->offset_x, &a->offset_y};
    double *airfoil = bough_arena_doubles(w->draft->arena, (size_t)a->n + 1), *all;
    for (int i = 0; i < a->n; i++) airfoil[i] = a->place[i].fraction;
    const bough_curve of_airfoils = {.n = a->by_thickness ? 0 : a->n, .x = airfoil, .y = airfoil};
    const bough_curve *curve[7] = {&a->chord, &of_airfoils};
    memcpy(curve + 2, other, sizeof other);
    int n_all = bough_curve_places(w->draft, curve, 7, equal, &all), n = 0;
    *place = all;
    for (int i = 0; i < n_all; i++) {
        double at = all[i], nearest = HUGE_VAL;
        for (int k = 0; k < a->chord.n; k++) nearest = fmin(nearest, fabs(a->chord.x[k] - at));
        bool far = n == 0 || at - all[n - 1] >= close;
        if (at >= 0 && at <= 1 && (nearest < equal || (nearest >= close && far))) all[n++] = at;
    }
    return n;
}

static void put_elements(bough_windio *w, const bough_windio_shape *a) {
    double *place;
    int n = find_places(w, a, &place);
    fputs("stations:\n  columns: [span, ac_x, ac_y, twist deg, chord, polar, blend, share]\n"
          "  rows:\n",
          w->draft->file[BOUGH_IMPORT_AERO]);
    for (int i = 0; i < n && bough_is_ok(w->draft->status); i++) put_element(w, a, place[i]);
    if (n < 2) bough_entry_fail(w->draft, a->chord.node, "chord: expected two points from 0 to 1");
    bough_taken(w, "%d blade elements, at the stations of chord, twist and airfoils", n);
    bough_approximated(w, "polars between airfoils: mixed linearly by %s",
                       a->by_thickness ? "thickness" : "place");
}

void bough_windio_air_tables(bough_windio *w) {
    if (!bough_is_ok(w->draft->status)) return;
    put_airfoils(w, &w->outline);
    put_elements(w, &w->outline);
}

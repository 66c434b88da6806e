// The blade's shape: chord, twist, position of the axis, airfoils.
#include "apps/bough/import/windio.h"

enum { MOST_AIRFOILS = 200 };

// -- places ---------------------------------------------------------------------------------------

static double thickness_of(bough_windio *w, const bough_node *airfoil) {
    return bough_entry_number_or(w->draft, airfoil, "relative_thickness|rthick", NAN);
}

static void read_place(bough_windio *w, const bough_node *where, const char *name, double fraction,
                       bough_windio_place *p) {
    const bough_node *list = bough_entry_need(w->draft, w->root, "airfoils");
    const bough_node *airfoil = list ? bough_entry_named(list, name) : NULL;
    if (list && !airfoil) {
        bough_entry_fail(w->draft, where, "no airfoil is named '%.60s'", name);
    }
    *p = (bough_windio_place){.airfoil = airfoil, .fraction = fraction};
    if (airfoil) p->thickness = thickness_of(w, airfoil);
}

// Version 1: {grid: [...], labels: [...]}.
static void read_labels(bough_windio *w, const bough_node *from, bough_windio_shape *a) {
    int n = 0;
    const double *grid = bough_entry_numbers(w->draft, from, "grid", &n);
    const bough_node *labels = bough_entry_need(w->draft, from, "labels");
    if (!grid || !labels) return;
    if (labels->kind != BOUGH_SEQUENCE || labels->n != n || n > MOST_AIRFOILS) {
        bough_entry_fail(w->draft, labels, "labels: expected %d names, as the grid has", n);
        return;
    }
    for (a->n = 0; a->n < n && bough_is_ok(w->draft->status); a->n++) {
        const bough_node *label = labels->value[a->n];
        const char *name = bough_entry_text(w->draft, label, "");
        read_place(w, label, name, grid[a->n], &a->place[a->n]);
    }
}

// Version 2: [{name, spanwise_position, ...}, ...].
static void read_items(bough_windio *w, const bough_node *list, bough_windio_shape *a) {
    if (list->kind != BOUGH_SEQUENCE || list->n < 1 || list->n > MOST_AIRFOILS) {
        bough_entry_fail(w->draft, list, "airfoils: expected a list of 1 to %d", (int)MOST_AIRFOILS);
        return;
    }
    bool mixed = false;
    for (a->n = 0; a->n < list->n && bough_is_ok(w->draft->status); a->n++) {
        const bough_node *item = list->value[a->n], *tags = bough_entry(item, "configuration");
        double fraction = bough_entry_number_or(w->draft, item, "spanwise_position", NAN);
        read_place(w, item, bough_entry_text(w->draft, item, "name"), fraction, &a->place[a->n]);
        mixed = mixed || (tags && tags->kind == BOUGH_SEQUENCE && tags->n > 1);
    }
    if (mixed) {
        bough_approximated(w, "airfoils: the first configuration of each is used");
    }
}

// Airfoils are found by thickness where it is given and decreases along the blade.
static void choose_measure(bough_windio *w, const bough_node *where, bough_windio_shape *a) {
    a->by_thickness = a->thickness.n > 0;
    for (int i = 0; i < a->n; i++) {
        double before = i > 0 ? a->place[i - 1].thickness : HUGE_VAL;
        a->by_thickness = a->by_thickness && a->place[i].thickness <= before;
    }
    for (int i = 0; i < a->n && !a->by_thickness; i++) {
        if (a->place[i].fraction >= (i > 0 ? a->place[i - 1].fraction : 0)) continue;
        bough_entry_fail(w->draft, where, "airfoil %d: expected increasing fractions of the span", i + 1);
    }
}

// -- shape ----------------------------------------------------------------------------------------

int bough_windio_neighbours(const bough_windio_shape *a, double at, double *weight) {
    double t = a->by_thickness ? bough_curve_at(&a->thickness, at) : at;
    int i = 0;
    *weight = 0;
    for (; i + 1 < a->n; i++) {
        const bough_windio_place *p = &a->place[i];
        double from = a->by_thickness ? -p->thickness : p->fraction;
        double to = a->by_thickness ? -p[1].thickness : p[1].fraction;
        double value = a->by_thickness ? -t : t;
        if (value >= to) continue;
        if (value > from && p->airfoil != p[1].airfoil) *weight = (value - from) / (to - from);
        break;
    }
    return i;
}

double bough_windio_line(const bough_windio_shape *a, double at) {
    if (a->pitch_axis.n == 0) return bough_curve_at(&a->offset_y, at);
    return bough_curve_at(&a->pitch_axis, at) * bough_curve_at(&a->chord, at);
}

void bough_windio_check_angles(bough_windio *w, const bough_curve *angles, const char *name) {
    const double most = 90; // [deg]
    for (int i = 0; i < angles->n && bough_is_ok(w->draft->status); i++) {
        if (fabs(angles->y[i] * w->degree) <= most) continue;
        bough_entry_fail(w->draft, angles->node,
                         "%s: expected angles up to %g %s, as version %d has them, got %g", name,
                         most / w->degree, w->second ? "deg" : "rad", w->second ? 2 : 1, angles->y[i]);
    }
}

void bough_windio_shape_read(bough_windio *w) {
    bough_draft *d = w->draft;
    bough_windio_shape *a = &w->outline;
    a->place = bough_arena_take(d->arena, MOST_AIRFOILS * sizeof *a->place);
    a->chord = bough_entry_curve(d, w->shape, "chord");
    a->twist = bough_entry_curve(d, w->shape, "twist");
    bough_windio_check_angles(w, &a->twist, "twist");
    bool by_length =
        bough_entry(w->shape, "section_offset_y") || (w->second && !bough_entry(w->shape, "pitch_axis"));
    if (by_length) a->offset_y = bough_entry_curve(d, w->shape, "section_offset_y");
    if (!by_length) a->pitch_axis = bough_entry_curve(d, w->shape, "pitch_axis");
    if (bough_entry(w->shape, "section_offset_x"))
        a->offset_x = bough_entry_curve(d, w->shape, "section_offset_x");
    if (bough_entry(w->shape, "rthick")) a->thickness = bough_entry_curve(d, w->shape, "rthick");
    const bough_node *airfoils = bough_entry_need(d, w->shape, "airfoil_position|airfoils");
    if (!bough_is_ok(d->status)) return;
    if (airfoils->kind == BOUGH_SEQUENCE)
        read_items(w, airfoils, a);
    else
        read_labels(w, airfoils, a);
    if (bough_is_ok(d->status)) choose_measure(w, airfoils, a);
}
